//! Pictures from files, experiments and captures.

use super::super::{DeviceArgs, shown, validated};
use crate::commands::adapt::{Changes, open_unlit};
use crate::experiment::{Experiment, FIELDS};
use crate::lab::{Lab, LabError, Session, Workspace, parts_of};
use crate::measure::comparison::Side;
use crate::measure::reference;
use crate::metrics::Linear;
use crate::results::capture::{self, Manifest};
use crate::results::picture;
use crate::scene::Scene;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// What pictures are made from; the device is opened for the first experiment.
pub(super) struct Sources<'a> {
    changes: &'a Changes,
    device: &'a DeviceArgs,
    frames: Option<usize>,
    lab: Option<Lab>,
    scenes: BTreeMap<String, Arc<Scene>>,
    /// The experiments that were rendered, with their scenes.
    rendered: Vec<(Experiment, Arc<Scene>)>,
}

impl<'a> Sources<'a> {
    pub(super) fn new(
        changes: &'a Changes,
        device: &'a DeviceArgs,
        frames: Option<usize>,
    ) -> Sources<'a> {
        Sources {
            changes,
            device,
            frames,
            lab: None,
            scenes: BTreeMap::new(),
            rendered: Vec::new(),
        }
    }

    /// A picture by its path. `set` says whether `--set` is for it: a reference has other
    /// parameters.
    pub(super) fn side(&mut self, path: &Path, set: bool) -> Result<Side, LabError> {
        let name = shown(path).display().to_string();
        if path.is_dir() {
            return Ok(Side::new(
                name,
                capture::parts(path, &Manifest::read(path)?)?,
            ));
        }
        if path.extension().is_some_and(|e| e == "ron") {
            return Ok(Side::new(name, self.render(path, set)?));
        }
        let parts = BTreeMap::from([("total".into(), picture::read_linear(path)?)]);
        Ok(Side::new(name, parts))
    }

    /// The cached reference of the first experiment, if there are both.
    pub(super) fn cached(&self, bounces: u32) -> Result<Option<Side>, LabError> {
        let Some((experiment, scene)) = self.rendered.first() else {
            return Ok(None);
        };
        if let Some((other, _)) = self
            .rendered
            .iter()
            .find(|(other, _)| !same_view(experiment, other))
        {
            warn!(
                "warning: '{}' and '{}' differ in scene, camera, time or light, and are compared all the same",
                experiment.name, other.name
            );
        }
        let found = reference::find(&Workspace::find()?, experiment, scene, bounces)?;
        Ok(found.map(|r| Side {
            name: format!(
                "path traced, {} samples a pixel, bounces {bounces}",
                r.samples
            ),
            noise: r
                .parts
                .iter()
                .map(|(part, p)| (part.clone(), p.noise))
                .collect(),
            parts: r
                .parts
                .into_iter()
                .map(|(part, p)| (part, p.mean))
                .collect(),
        }))
    }

    /// Every message of the validation layer is an error.
    pub(super) fn validated(&self) -> Result<(), LabError> {
        self.lab.as_ref().map_or(Ok(()), validated)
    }

    fn render(&mut self, path: &Path, set: bool) -> Result<BTreeMap<String, Linear>, LabError> {
        let (mut session, experiment, scene) = self.session(path, set)?;
        session.run(self.frames.unwrap_or(session.converging_frames()))?;
        for message in session.failed_checks()? {
            warn!("warning: {}: {message}", path.display());
        }
        self.rendered.push((experiment, scene));
        session.parts()
    }

    /// A session of an experiment that computes all parts of the light.
    pub(super) fn session(
        &mut self,
        path: &Path,
        set: bool,
    ) -> Result<(Session, Experiment, Arc<Scene>), LabError> {
        let mut changes = self.changes.clone();
        if !set {
            changes.set.clear();
        }
        let experiment = changes.read(path)?;
        let scene = match self.scenes.get(&experiment.scene) {
            Some(scene) => scene.clone(),
            None => Arc::new(open_unlit(&experiment)?),
        };
        self.scenes.insert(experiment.scene.clone(), scene.clone());
        let scene = experiment.adapted(scene)?;
        let lab = match &self.lab {
            Some(lab) => lab.clone(),
            None => Lab::open(Workspace::find()?, self.device.options())?,
        };
        self.lab = Some(lab.clone());
        let (session, warnings) = lab.prepare(&experiment, scene.clone(), |graph| {
            let parts = parts_of(graph);
            if parts.is_empty() {
                let message = format!(
                    "graph '{}' has neither `parts` nor `hdr`: there is nothing to compare",
                    graph.name
                );
                return Err(LabError::Request(message));
            }
            Ok(parts.into_iter().map(|p| p.texture).collect())
        })?;
        for warning in warnings {
            warn!("{warning}");
        }
        Ok((session, experiment, scene))
    }
}

/// Whether two experiments look at the same: only then can one reference be for both.
fn same_view(a: &Experiment, b: &Experiment) -> bool {
    let lights = |e: &Experiment| {
        e.lights
            .iter()
            .map(|(name, l)| (name.value.clone(), l.clone()))
            .collect::<Vec<_>>()
    };
    let mut seen = FIELDS
        .iter()
        .filter(|f| !["graph", "size"].contains(&f.name));
    seen.all(|f| (f.same)(a, b)) && lights(a) == lights(b)
}
