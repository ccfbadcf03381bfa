//! `conelab graph`.

use super::check;
use crate::campaign::settings::named;
use crate::diagnostics::nearest;
use crate::experiment::Experiment;
use crate::files::path_of;
use crate::graph::outline::outline;
use crate::graph::param::Params;
use crate::graph::plan::plan;
use crate::graph::report;
use crate::graph::{Evaluated, Graph};
use crate::lab::{LabError, Workspace, any_device, environment, params_of};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `graph`.
#[derive(Debug, Args)]
pub struct GraphArgs {
    /// Graph file (passes/rays.ron) or experiment (configs/rays.ron).
    #[arg(value_parser = super::spec())]
    file: String,
    /// The scene that sets the counts of repeated passes.
    #[arg(long, value_parser = super::spec())]
    scene: Option<String>,
    /// Picture size; the experiment's, or 1280x720, when absent.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Set a parameter (repeatable).
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Further resources to compute next to the picture.
    #[arg(long, value_name = "NAME")]
    want: Vec<String>,
    /// Print the parameters with their ranges and help, and the named values as set.
    #[arg(long)]
    params: bool,
    /// Print every step with its reads, writes and barriers, all resources, and why other passes do
    /// not run.
    #[arg(long)]
    barriers: bool,
    /// Print the graph in Graphviz format.
    #[arg(long)]
    dot: bool,
    /// Write parameters, passes, textures and buffers to this JSON file; `-`: to standard output.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["params", "barriers", "dot"])]
    json: Option<PathBuf>,
}

/// Prints a graph's plan.
pub fn run(args: &GraphArgs) -> Result<(), LabError> {
    let home = Workspace::find()?;
    if let Some(path) = &args.json {
        super::writable(path, &["json"])?;
    }
    let file = super::found(&path_of(&args.file));
    let is_experiment = matches!(check::kind(&file), check::FileKind::Experiment);
    let experiment = is_experiment.then(|| Experiment::read(&file));
    let experiment = experiment.transpose().map_err(LabError::Input)?;
    let loaded = match &experiment {
        Some(experiment) => home.load_of(experiment),
        None => home.load(&args.file),
    };
    let loaded = loaded.map_err(LabError::Input)?;
    for warning in &loaded.warnings {
        warn!("{warning}");
    }
    let graph = loaded.graph;
    let params = params(args, &graph, experiment.as_ref())?;
    if args.params {
        say_part!("{}", report::params(&params));
        if graph.values.is_empty() {
            return Ok(());
        }
    }
    let size = match &args.size {
        Some(text) => super::adapt::parse_size(text)?,
        None => experiment.as_ref().map_or((1280, 720), |e| e.size),
    };
    let scene = match (&args.scene, &experiment) {
        (None, Some(experiment)) => super::adapt::open_unlit(experiment)?,
        (name, _) => super::open_scene(name.as_deref().unwrap_or("cornell"))?,
    };
    let device = any_device();
    let set = Evaluated::new(&graph, &params, environment(&scene, size, &device));
    if args.params {
        say_part!("{}", report::values(&set));
        return match set.errors.is_empty() {
            true => Ok(()),
            false => Err(LabError::Input(set.errors)),
        };
    }
    let wanted = wanted(&graph, &args.want)?;
    let linked = home.linked(&graph, &params).map_err(LabError::Input)?;
    let plan = plan(&set, &linked, &wanted, &device).map_err(LabError::Input)?;
    if let Some(path) = &args.json {
        return super::write_json(path, &outline(&graph, &params, &plan));
    }
    let text = match (args.dot, args.barriers) {
        (true, _) => report::dot(&graph, &linked, &plan),
        (_, true) => report::text(&graph, &linked, &plan),
        _ => report::summary(&set, &linked, &plan),
    };
    say_part!("{text}");
    Ok(())
}

/// The parameters of the experiment with those of the arguments.
fn params(
    args: &GraphArgs,
    graph: &Graph,
    experiment: Option<&Experiment>,
) -> Result<Params, LabError> {
    let mut params = match experiment {
        Some(e) => params_of(graph, e)?,
        None => graph.params.clone(),
    };
    for setting in &args.set {
        let (name, value) = named("--set", setting, "NAME=VALUE")?;
        params.set(name, value).map_err(LabError::Request)?;
    }
    Ok(params)
}

/// The picture and the named resources.
fn wanted(graph: &Graph, names: &[String]) -> Result<Vec<String>, LabError> {
    let results = graph.output.iter().chain(&graph.hdr);
    let mut wanted: Vec<String> = results.chain(names).cloned().collect();
    if let Some(name) = wanted.iter().find(|w| graph.resource(w).is_none()) {
        let hint = nearest(name, graph.resource_names());
        let hint = hint.map_or(String::new(), |h| format!(" ({h})"));
        return Err(LabError::Request(format!("no resource '{name}'{hint}")));
    }
    wanted.extend(graph.checked_with(&wanted));
    Ok(wanted)
}
