//! `conelab reference`.

use super::DeviceArgs;
use super::adapt::{self, ExperimentArgs};
use crate::lab::{Lab, LabError, Workspace};
use crate::measure::reference::{ALL_BOUNCES, Gathered, Goal, NoiseBound, Reference, gather};
use crate::metrics::{Metric, RELMSE};
use crate::results::table::Table;
use clap::Args;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// Arguments of `reference`.
#[derive(Debug, Args)]
pub struct ReferenceArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// Samples per pixel in total, or with --until at most; rounded up to a multiple of 32. Default: 256, with --until 1048576.
    #[arg(long, value_name = "N")]
    spp: Option<u64>,
    /// Continue until the error of the total against the converged reference, estimated from two halves of the samples, is at most this, for example flip=0.01 or relmse=1e-4.
    #[arg(long, value_name = "METRIC=ERROR")]
    until: Option<NoiseBound>,
    /// Maximum bounces after the first hit. 1: the single bounce that cones gather.
    #[arg(long, default_value_t = ALL_BOUNCES)]
    bounces: u32,
    /// Write the mean of a part to this file too (.exr).
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Part for --output.
    #[arg(long, default_value = "total")]
    part: String,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Gathers a reference.
pub fn run(args: &ReferenceArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    if args.spp.is_some_and(|n| !(1..=1 << 24).contains(&n)) {
        return Err(LabError::Request("--spp must be 1 to 16777216".into()));
    }
    let goal = match args.until {
        Some(bound) => Goal::Noise(NoiseBound {
            most: args.spp.unwrap_or(bound.most),
            ..bound
        }),
        None => Goal::Samples(args.spp.unwrap_or(Goal::DEFAULT_SAMPLES)),
    };
    let home = Workspace::find()?;
    let scene = Arc::new(adapt::open_scene(&experiment)?);
    let lab = Lab::open(home, args.device.options())?;
    let reference = with_bar(&lab, &experiment, &scene, args.bounces, goal)?;
    say!(
        "{} samples a pixel, {} bounces, {}x{}",
        reference.samples,
        args.bounces,
        reference.size.0,
        reference.size.1
    );
    let parts: Vec<_> = reference.parts.iter().collect();
    let mut table = Table::new(&parts);
    table.column("part", |p| p.0.clone());
    table.column("mean", |p| format!("{:.6}", p.1.mean.mean()));
    table.column("relMSE of the halves", |p| {
        format!("{:.3e}", p.1.noise.relmse)
    });
    table.column("FLIP of noise", |p| format!("{:.4}", p.1.noise.flip));
    table.column("structure of noise", |p| {
        format!("{:.3e}", p.1.noise.structure)
    });
    say_part!("{}", table.text());
    if let Goal::Noise(bound) = goal {
        say!("{}", reached(&reference, bound));
    }
    say!("kept in {}", super::shown(&reference.folder).display());
    if let Some(path) = &args.output {
        let part = reference.parts.get(&args.part).ok_or_else(|| {
            let all: Vec<&str> = reference.parts.keys().map(String::as_str).collect();
            LabError::Request(format!(
                "no part '{}'; there are {}",
                args.part,
                all.join(", ")
            ))
        })?;
        crate::results::picture::write_linear(path, &part.mean)?;
        say!("wrote {}", path.display());
    }
    super::validated(&lab)
}

/// Estimated error of the total, and whether it is within the bound.
fn reached(reference: &Reference, bound: NoiseBound) -> String {
    let noise = reference.parts.get("total").map(|p| p.noise);
    let error = noise.and_then(|n| bound.metric.of_noise(n));
    let error = error.unwrap_or(f64::NAN);
    let title = bound.metric.title;
    if error <= bound.error {
        format!("{title} of the total: {error:.3e}, at most {}", bound.error)
    } else {
        format!(
            "{title} of the total: {error:.3e}, above {}: raise --spp",
            bound.error
        )
    }
}

/// Gathers with a progress bar and the time left.
pub fn with_bar(
    lab: &Lab,
    experiment: &crate::experiment::Experiment,
    scene: &Arc<crate::scene::Scene>,
    bounces: u32,
    goal: Goal,
) -> Result<Reference, LabError> {
    let style =
        indicatif::ProgressStyle::with_template("{bar:30} {pos}/{len} samples, {msg}, {eta} left");
    let bar = indicatif::ProgressBar::new(1)
        .with_style(style.unwrap_or_else(|_| indicatif::ProgressStyle::default_bar()));
    let title = match goal {
        Goal::Noise(bound) => bound.metric.title,
        Goal::Samples(_) => Metric::of(RELMSE).map_or("", |m| m.title),
    };
    let mut first = true;
    let result = gather(
        lab,
        experiment,
        scene,
        bounces,
        goal,
        &mut |now: Gathered| {
            // The bar is drawn whenever its position changes: all else must be said before.
            bar.set_length(now.goal);
            bar.set_message(
                now.noise
                    .map_or(String::new(), |n| format!("{title} {n:.2e}")),
            );
            if first {
                // Samples of an earlier run do not count for the speed.
                bar.set_position(now.samples);
                bar.reset_eta();
                first = false;
            }
            bar.set_position(now.samples);
            ControlFlow::Continue(())
        },
    );
    bar.finish_and_clear();
    result
}
