//! Memory of a graph against that of the device, before anything is made.

use super::LabError;
use crate::graph::param::{Kind, Params};
use crate::graph::plan::Plan;
use crate::graph::{Graph, report};
use crate::vulkan::DeviceInfo;

/// Values that are tried below a parameter's own, each a fraction of the one before.
const STEPS: u32 = 20;
const FRACTION: f64 = 0.875;

/// A change of one parameter that does not make this part of the memory less is not offered.
const LEAST_SAVED: f64 = 0.02;

/// Refuses a plan that needs more memory than the device has. `replan` gives the bytes of the
/// graph with other parameters.
///
/// # Errors
/// The plan does not fit. The message names the largest resources, and the largest value of each
/// whole-number parameter with which it would fit.
pub(super) fn check(
    (graph, params): (&Graph, &Params),
    plan: &Plan,
    device: &DeviceInfo,
    replan: &dyn Fn(&Params) -> Option<u64>,
) -> Result<(), LabError> {
    let needed = report::bytes(plan);
    if needed <= device.heap {
        return Ok(());
    }
    let gib = |bytes: u64| bytes as f64 / (1u64 << 30) as f64;
    let largest = report::largest(graph, plan, 3);
    let largest: Vec<String> = largest
        .iter()
        .map(|(name, bytes)| format!("{name} {:.2}", gib(*bytes)))
        .collect();
    let fitting = fitting(params, needed, device.heap, replan);
    let way_out = match fitting.is_empty() {
        true => "Reduce the picture or several parameters".into(),
        false => format!("It would fit with --set {}", fitting.join(" or --set ")),
    };
    Err(LabError::Request(format!(
        "graph '{}' needs {:.2} GiB, and {} has {:.2} GiB of memory. The largest: {}. {way_out}",
        graph.name,
        gib(needed),
        device.name,
        gib(device.heap),
        largest.join(", ")
    )))
}

/// "name=value" for each parameter that makes the graph fit alone.
fn fitting(
    params: &Params,
    needed: u64,
    heap: u64,
    replan: &dyn Fn(&Params) -> Option<u64>,
) -> Vec<String> {
    let with = |name: &str, value: f64| {
        let mut changed = params.clone();
        let text = value.to_string();
        changed.set(name, &text).ok().map(|()| (changed, text))
    };
    let mut found = Vec::new();
    for (param, value) in params.list.iter().zip(&params.values) {
        let (Kind::Int, Some(now)) = (&param.kind, value.number()) else {
            continue;
        };
        let step = param.step.unwrap_or(1.0).max(1.0);
        let rounded = |v: f64| (v / step).floor() * step;
        let half = with(&param.name, rounded(now / 2.0)).and_then(|(p, _)| replan(&p));
        let saves = |bytes: u64| bytes as f64 <= (1.0 - LEAST_SAVED) * needed as f64;
        if !half.is_some_and(saves) {
            continue;
        }
        let smaller = (1..=STEPS).filter_map(|i| {
            let value = rounded(now * FRACTION.powi(i as i32));
            with(&param.name, value)
        });
        let fits = smaller
            .into_iter()
            .find(|(p, _)| replan(p).is_some_and(|bytes| bytes <= heap));
        found.extend(fits.map(|(_, text)| format!("{}={text}", param.name)));
    }
    found
}
