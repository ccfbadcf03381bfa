//! `conelab ablate --steps`: the steps from an ideal to the method that a graph names.

use super::super::{adapt, reference, validated, writable, write_json};
use super::AblateArgs;
use crate::lab::{Lab, LabError, Workspace, parts_of};
use crate::measure::reference::{Goal, Reference};
use crate::metrics::{Linear, MetricError, relative_distance, relmse};
use crate::results::table::Table;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Version of what `--json` writes.
const SCHEMA: &str = "conelab-ablation-1";

/// A step of the ablation.
#[derive(Serialize)]
struct Step {
    title: String,
    /// relMSE against the reference by part, and the error that the step adds: mean (x - y)^2 /
    /// (r^2 + 0.01), y the previous step.
    parts: BTreeMap<String, [f64; 2]>,
}

/// What `--json` writes.
#[derive(Serialize)]
struct Ablation {
    schema: &'static str,
    version: &'static str,
    experiment: String,
    scene: String,
    device: String,
    reference_samples: u64,
    /// relMSE of the halves of the reference, by part.
    noise: BTreeMap<String, f64>,
    steps: Vec<Step>,
}

/// Prints the error that each step of the graph's ablation adds.
pub fn run(args: &AblateArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    adapt::check_frames(args.frames.unwrap_or(1), 0, 0.0)?;
    if let Some(path) = &args.json {
        writable(path, &["json"])?;
    }
    let home = Workspace::find()?;
    let loaded = home.load_of(&experiment).map_err(LabError::Input)?;
    if loaded.graph.ablation.is_empty() {
        let name = &loaded.graph.name;
        let message =
            format!("graph '{name}' has no `ablation`: steps from an ideal to the method");
        return Err(LabError::Request(message));
    }
    let scene = Arc::new(adapt::open_scene(&experiment)?);
    let lab = Lab::open(home, args.device.options())?;
    let (bounces, goal) = (args.bounces, Goal::Samples(args.spp));
    let reference = reference::with_bar(&lab, &experiment, &scene, bounces, goal)?;

    let names = parts_of(&loaded.graph);
    let (mut steps, mut before) = (Vec::new(), BTreeMap::new());
    for step in loaded.graph.ablation.iter().map(|s| &s.value) {
        let mut set = experiment.clone();
        for (name, value) in &step.set.0 {
            set.set(&name.value, &value.value.0);
        }
        let wanted = names.iter().map(|n| n.texture.clone()).collect();
        let mut session = lab.build(&set, &loaded, scene.clone(), wanted, None)?;
        session.run(args.frames.unwrap_or(session.converging_frames()))?;
        let parts = session.parts()?;
        if let Some(folder) = &args.pictures {
            for (part, light) in &parts {
                let file = folder.join(format!("{}-{part}.exr", step.title));
                crate::results::picture::write_linear(&file, light)?;
            }
        }
        steps.push(Step {
            title: step.title.clone(),
            parts: errors(&parts, &before, &reference)?,
        });
        before = parts;
    }
    print(&reference, &steps);
    if let Some(path) = &args.json {
        let noise = reference.parts.iter();
        let noise = noise.map(|(n, p)| (n.clone(), p.noise.relmse));
        let ablation = Ablation {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            experiment: experiment.name.clone(),
            scene: scene.name.clone(),
            device: lab.gpu.info.name.clone(),
            reference_samples: reference.samples,
            noise: noise.collect(),
            steps,
        };
        write_json(path, &ablation)?;
    }
    validated(&lab)
}

/// relMSE of each part, and its distance from the step before.
fn errors(
    parts: &BTreeMap<String, Linear>,
    before: &BTreeMap<String, Linear>,
    reference: &Reference,
) -> Result<BTreeMap<String, [f64; 2]>, LabError> {
    let mut errors = BTreeMap::new();
    for (part, light) in parts {
        let Some(expected) = reference.parts.get(part) else {
            continue;
        };
        let fail = |e: MetricError| LabError::Request(format!("part '{part}': {e}"));
        let expected = &expected.mean;
        let before = before.get(part).unwrap_or(expected);
        let adds = relative_distance(light, before, expected).map_err(fail)?;
        let error = relmse(light, expected).map_err(fail)?;
        errors.insert(part.clone(), [error, adds]);
    }
    Ok(errors)
}

fn print(reference: &Reference, steps: &[Step]) {
    say!(
        "relMSE against {} samples a pixel; in brackets the error that the step adds",
        reference.samples
    );
    let parts: Vec<_> = reference.parts.iter().collect();
    let mut table = Table::new(&parts);
    table.column("part", |p| p.0.clone());
    for step in steps {
        table.column(&step.title, |p| match step.parts.get(p.0) {
            Some([error, adds]) => format!("{error:.3e} ({adds:.2e})"),
            None => "-".into(),
        });
    }
    table.column("noise floor", |p| format!("{:.2e}", p.1.noise.relmse));
    say_part!("{}", table.text());
}
