//! Measurements of a run in the program's JSON schema (`docs/stats.md`).

use crate::graph::Evaluated;
use crate::graph::param::{OFF, Params};
use crate::graph::report::of_common_card;
use crate::graph::run::{Execution, FrameTimes};
use crate::lab::Session;
use crate::metrics::percentile;
use crate::results::table::Table;
use crate::vulkan::DeviceInfo;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the schema.
pub const SCHEMA: &str = "conelab-stats-1";

/// Minimum, median and 95th percentile (ms).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Minimum.
    pub min: f64,
    /// Median.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
}

/// Times of a pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PassStats {
    /// Name in the graph.
    pub name: String,
    /// Group in tables and charts: the graph's `stage` of the pass, or its name.
    #[serde(default)]
    pub stage: String,
    /// Time on the GPU.
    pub gpu_ms: Spread,
    /// Timed frames.
    pub frames: usize,
    /// Frames in which it was skipped; they count as 0 ms.
    #[serde(default)]
    #[serde(alias = "slept")]
    pub skipped: usize,
}

/// A device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeviceStats {
    /// Name as the driver gives it.
    pub name: String,
    /// Driver with its version.
    pub driver: String,
    /// Version of Vulkan.
    pub api: String,
    /// discrete, integrated, virtual, cpu or other.
    pub kind: String,
}

impl DeviceStats {
    /// The description of a device.
    pub fn of(device: &DeviceInfo) -> DeviceStats {
        DeviceStats {
            name: device.name.clone(),
            driver: device.driver.clone(),
            api: device.api.clone(),
            kind: device.kind.into(),
        }
    }
}

/// The content of `--json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stats {
    /// [`SCHEMA`].
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// The device.
    pub device: DeviceStats,
    /// Name of the experiment.
    pub experiment: String,
    /// Name of the graph.
    pub graph: String,
    /// Name of the scene.
    pub scene: String,
    /// Triangles of the scene.
    pub triangles: usize,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Values of all parameters.
    pub params: BTreeMap<String, serde_json::Value>,
    /// The options that `auto` stands for on this device, by parameter.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub auto: BTreeMap<String, String>,
    /// Warm-up frames.
    pub warmup: usize,
    /// Whether frames execute all passes or only changed ones.
    #[serde(default)]
    #[serde(alias = "redo")]
    pub execution: Execution,
    /// Every pass that ran, in order.
    pub passes: Vec<PassStats>,
    /// From the first to the last command on the GPU.
    pub total_gpu_ms: Spread,
    /// Recording and submitting on the CPU.
    pub cpu_ms: Spread,
    /// Size of each graph resource (bytes).
    pub bytes: BTreeMap<String, u64>,
    /// Total size of the graph's resources (bytes).
    pub total_bytes: u64,
    /// Size of the scene's geometry and textures (bytes).
    pub scene_bytes: u64,
    /// Failed checks of the graph.
    pub warnings: Vec<String>,
}

/// Minimum, median and 95th percentile (nearest rank).
pub fn spread(mut values: Vec<f64>) -> Spread {
    let [min, median, p95] = [0.0, 0.5, 0.95].map(|part| percentile(&mut values, part));
    Spread { min, median, p95 }
}

/// The measurements of a session.
pub fn collect(
    device: &DeviceInfo,
    experiment: &str,
    session: &Session,
    times: &[FrameTimes],
    warmup: usize,
    warnings: Vec<String>,
) -> Stats {
    let mut passes = Vec::new();
    for (i, (number, _)) in times
        .first()
        .map_or(&[][..], |t| &t.passes)
        .iter()
        .enumerate()
    {
        let values: Vec<f64> = times
            .iter()
            .filter_map(|t| t.passes.get(i))
            .map(|p| p.1)
            .collect();
        let frames = values.len();
        let pass = &session.graph.passes[*number].value;
        let (name, stage) = (pass.name.value.clone(), pass.stage().to_string());
        let skipped = times.iter().filter(|t| t.skipped.contains(number)).count();
        passes.push(PassStats {
            name,
            stage,
            gpu_ms: spread(values),
            frames,
            skipped,
        });
    }
    let bytes: BTreeMap<String, u64> = session.program.memory(&session.graph).into_iter().collect();
    let (width, height) = session.size();
    Stats {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        device: DeviceStats::of(device),
        experiment: experiment.into(),
        graph: session.graph.name.clone(),
        scene: session.scene.name.clone(),
        triangles: session.scene.triangle_count(),
        size: [width, height],
        auto: Evaluated::new(
            &session.graph,
            &session.params,
            session.surroundings.clone(),
        )
        .chosen(),
        params: param_values(&session.params),
        warmup,
        execution: session.execution(),
        passes,
        total_gpu_ms: spread(times.iter().map(|t| t.gpu_ms).collect()),
        cpu_ms: spread(times.iter().map(|t| t.cpu_ms).collect()),
        total_bytes: bytes.values().sum(),
        bytes,
        scene_bytes: session.scene_bytes(),
        warnings,
    }
}

fn param_values(params: &Params) -> BTreeMap<String, serde_json::Value> {
    params
        .list
        .iter()
        .zip(&params.values)
        .map(|(p, v)| {
            (
                p.name.clone(),
                serde_json::to_value(v).unwrap_or(serde_json::Value::Null),
            )
        })
        .chain((!params.off.is_empty()).then(|| (OFF.to_string(), params.off.clone().into())))
        .collect()
}

/// The measurements as a text table.
pub fn table(stats: &Stats) -> String {
    let mut rows: Vec<(String, Spread)> = Vec::new();
    for pass in &stats.passes {
        let skipped = pass.skipped == pass.frames && pass.skipped > 0;
        let title = format!("{}{}", pass.name, if skipped { " (skipped)" } else { "" });
        rows.push((title, pass.gpu_ms));
    }
    rows.push(("total".into(), stats.total_gpu_ms));
    rows.push(("CPU record and submit".into(), stats.cpu_ms));
    let auto = stats
        .auto
        .iter()
        .map(|(name, option)| format!("{name} {option}"));
    let auto = match auto.collect::<Vec<_>>() {
        list if list.is_empty() => String::new(),
        list => format!("auto: {}\n", list.join(", ")),
    };
    format!(
        "{} ({}), {}x{}\n{}{auto}memory of the graph: {:.1} MiB ({})\n",
        stats.device.name,
        stats.device.driver,
        stats.size[0],
        stats.size[1],
        spreads("GPU ms", &rows),
        stats.total_bytes as f64 / 1048576.0,
        of_common_card(stats.total_bytes)
    )
}

/// Named spreads, ms.
pub(crate) fn spreads(title: &str, rows: &[(String, Spread)]) -> String {
    let mut table = Table::new(rows);
    table.column(title, |r| r.0.clone());
    table.column("min", |r| format!("{:.3}", r.1.min));
    table.column("median", |r| format!("{:.3}", r.1.median));
    table.column("p95", |r| format!("{:.3}", r.1.p95));
    table.text()
}
