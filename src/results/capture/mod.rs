//! Captures: a picture with everything needed to reproduce it, written atomically to one folder.

mod list;
mod manifest;
mod parts;
mod replay;
mod scene_hash;
mod take;

pub(crate) use list::Summary;
pub use list::{list, sweep_partials};
pub use manifest::Manifest;
pub(crate) use manifest::{Image, SCHEMA, SceneRecord};
pub use parts::parts;
pub use replay::{changes, replay};
pub use scene_hash::scene_hash;
pub use take::{Resource, What, free_name, take};

use crate::experiment::Experiment;
use crate::files::{FileError, spec_of};
use crate::graph::Graph;
use crate::lab::{Lab, LabError, Texels, Workspace};
use crate::results::stats::{self, Stats};
use crate::scene::Scene;
use std::path::Path;
use std::sync::Arc;

/// Folder of the graph and shaders in a capture.
const SOURCES: &str = "graph";
/// The fully resolved experiment.
const EXPERIMENT: &str = "experiment.ron";
/// The description of a capture.
const MANIFEST: &str = "capture.json";

fn failed(path: &Path, error: impl std::fmt::Display) -> LabError {
    FileError::content(path, error).into()
}

/// A capture's experiment, which uses the capture's own sources.
fn experiment_of(folder: &Path, manifest_name: &str) -> Result<Experiment, LabError> {
    let mut experiment = Experiment::read(&folder.join(EXPERIMENT)).map_err(LabError::Input)?;
    if Path::new(&experiment.graph).file_name() != Some(experiment.graph.as_ref()) {
        return Err(failed(
            &folder.join(EXPERIMENT),
            "its graph must be a bare file name",
        ));
    }
    experiment.graph = spec_of(&folder.join(SOURCES).join("passes").join(&experiment.graph));
    experiment.name = manifest_name.into();
    Ok(experiment)
}

/// Result of rendering a capture.
struct Rendered {
    images: Vec<(Image, Texels)>,
    frames: usize,
    stats: Stats,
}

/// Renders a capture's experiment from its own sources; used to take and to replay captures.
fn render(
    lab: &Lab,
    folder: &Path,
    experiment: &Experiment,
    scene: Arc<Scene>,
    (frames, step): (Option<usize>, f64),
    wanted: impl FnOnce(&Graph) -> Result<Vec<Image>, LabError>,
) -> Result<Rendered, LabError> {
    let home = Workspace::with(folder.join(SOURCES), lab.home.cache.clone());
    let lab = Lab {
        home,
        gpu: lab.gpu.clone(),
    };
    let mut chosen = Vec::new();
    let (mut session, _) = lab.prepare(experiment, scene, |graph| {
        chosen = wanted(graph)?;
        Ok(chosen.iter().map(|i| i.texture.clone()).collect())
    })?;
    let frames = frames.unwrap_or(if step == 0.0 {
        session.converging_frames()
    } else {
        1
    });
    let mut times = Vec::new();
    for _ in 0..frames {
        times.extend(session.frame(step)?);
    }
    times.extend(session.finish()?);
    let warnings = session.failed_checks()?;
    let mut images = Vec::new();
    for image in chosen {
        let texels = session.texels(&image.texture, image.mip, image.layer)?;
        images.push((image, texels));
    }
    let stats = stats::collect(
        &lab.gpu.info,
        &experiment.name,
        &session,
        &times,
        0,
        warnings,
    );
    Ok(Rendered {
        images,
        frames,
        stats,
    })
}
