//! `conelab save`.

use super::adapt::ExperimentArgs;
use crate::experiment::{checked_name, write};
use crate::lab::load;
use crate::lab::{LabError, Workspace};
use clap::Args;

/// Arguments of `save`.
#[derive(Debug, Args)]
pub struct SaveArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// Name of the new experiment: configs/NAME.ron is written.
    #[arg(long)]
    name: String,
    /// Overwrite the experiment of that name. Its comments are kept.
    #[arg(long)]
    overwrite: bool,
}

/// Saves an experiment with the changes of the command line.
pub fn run(args: &SaveArgs) -> Result<(), LabError> {
    let name = checked_name(&args.name)?;
    let experiment = args.experiment.read()?;
    let home = Workspace::find()?;
    let graph =
        load(&home.graph_path(&experiment.graph), &home.folders()).map_err(LabError::Input)?;
    let path = home.root.join("configs").join(format!("{name}.ron"));
    write(&experiment, &graph.params, &path, args.overwrite)?;
    say!("wrote {}", super::shown(&path).display());
    Ok(())
}
