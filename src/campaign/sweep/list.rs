//! The points of a sweep.

use super::points::Sweep;
use crate::campaign::points::{DIGITS, Labels, Subject, SweepPoint};
use crate::campaign::runner::{Mistakes, Runner};
use crate::experiment::Experiment;
use crate::files::content_id;
use crate::lab::{LabError, Workspace};
use crate::measure::{Frames, Warm};
use crate::scene::SceneError;
use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

/// Number of mistakes after which checking ends.
const MOST_MISTAKES: usize = 20;

/// A point with a model that is missing or unreadable here. On other machines its identifier
/// depends on the scene's content.
fn absent(experiment: Experiment, labels: Labels, why: &SceneError) -> SweepPoint {
    let name = Path::new(&experiment.scene)
        .file_stem()
        .map_or(String::new(), |s| s.to_string_lossy().into_owned());
    let (size, time) = (experiment.size, format!("{:?}", experiment.time));
    let subject = Subject {
        scene: name,
        sha256: String::new(),
        camera: String::new(),
        size,
        time,
    };
    let values = labels.iter().map(|(name, value)| format!("{name}={value}"));
    let id = content_id(
        ["absent".to_string(), format!("{subject:?}")]
            .into_iter()
            .chain(values),
        DIGITS,
    );
    SweepPoint {
        id,
        experiment,
        scene: Arc::default(),
        absent: Some(why.to_string()),
        subject,
        labels,
    }
}

/// All points of a sweep in order without duplicates, and the number of duplicates. Points are
/// absent, not errors, if their model is missing or damaged, because suites list scenes that are
/// not in every checkout.
pub fn list(
    runner: &mut Runner,
    sweep: &Sweep,
    frames: Frames,
) -> Result<(Vec<SweepPoint>, usize), LabError> {
    let mut points: Vec<SweepPoint> = Vec::new();
    let mut known = HashSet::new();
    let mut mistakes = Mistakes::default();
    for index in 0..sweep.len() {
        let point = sweep
            .point(index)
            .map_err(LabError::Input)
            .and_then(|(experiment, labels)| {
                match runner.point(experiment.clone(), labels.clone(), frames) {
                    Err(LabError::Scene(
                        why @ (SceneError::NoModel { .. }
                        | SceneError::Model { .. }
                        | SceneError::SceneFile { .. }),
                    )) => Ok(absent(experiment, labels, &why)),
                    other => other,
                }
            });
        points.extend(mistakes.take(point)?.filter(|p| known.insert(p.id.clone())));
        if mistakes.count() >= MOST_MISTAKES {
            break;
        }
    }
    mistakes.none()?;
    let equal = sweep.len() - points.len();
    Ok((points, equal))
}

/// Checks a sweep without opening its scenes: experiments, graphs, and the parameters of every
/// point.
pub fn check(home: &Workspace, path: &Path) -> Result<(), LabError> {
    let sweep = Sweep::read(path).map_err(LabError::Input)?;
    let mut warm = Warm::default();
    let mut mistakes = Mistakes::default();
    for index in 0..sweep.len() {
        let point = sweep.point(index).map_err(LabError::Input);
        mistakes.take(point.and_then(|(experiment, _)| warm.check(home, &experiment)))?;
    }
    mistakes.none()
}
