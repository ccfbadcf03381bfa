//! Reconciles a side with the desired state: sets values, or swaps in a build.

use super::builder::{Done, Job, Key};
use super::converge::Need;
use super::report::{BuiltReport, GraphInfo, PassUses, Report};
use super::{Run, Side};
use crate::diagnostics::{Diagnostic, Place};
use crate::lab::{LabError, Loaded, Session, light_counts, params_of};
use crate::scene::{Light, Scene};
use crate::vulkan::VulkanError;
use crate::workbench::desired::request::SideRequest;
use crate::workbench::desired::save;
use std::sync::Arc;
use std::time::Instant;

impl Run<'_> {
    pub(super) fn key(&self, side: &SideRequest, number: usize) -> Key {
        let graph = self.sides[number].loaded.as_ref().map(|l| &*l.graph);
        let asked = self.desired.read_back.iter();
        let asked = asked.filter(|asked| asked.side() == number);
        let wanted = asked.filter_map(|asked| asked.resource(graph)).collect();
        Key {
            side: side.clone(),
            size: self.desired.size,
            revision: self.desired.revision,
            scene: self.scene_number,
            lights: light_counts(&self.lights()),
            wanted,
        }
    }

    /// The lights that the picture should have.
    fn lights(&self) -> Vec<Light> {
        // While a scene loads, the requested lights may be those of the next one.
        let requested = self.desired.lights.as_ref();
        match (requested.filter(|_| self.loading.is_none()), &self.scene) {
            (Some(state), _) => state.lights.clone(),
            (None, Some(scene)) => scene.lights.clone(),
            (None, None) => Vec::new(),
        }
    }

    /// The scene with as many lights of each kind as requested. The copy is kept until the numbers
    /// change again.
    fn lit_scene(&mut self, scene: Arc<Scene>, counts: [u32; 4]) -> Arc<Scene> {
        if light_counts(&scene.lights) == counts {
            return scene;
        }
        let known = self.lit.take().filter(|(number, lit)| {
            *number == self.scene_number && light_counts(&lit.lights) == counts
        });
        let (number, lit) = known.unwrap_or_else(|| {
            let lights = self.lights();
            let lit = Scene {
                lights,
                ..Scene::clone(&scene)
            };
            (self.scene_number, Arc::new(lit))
        });
        self.lit = Some((number, lit.clone()));
        lit
    }

    /// Reconciles a side with the desired state: sets values, or starts a build.
    pub(super) fn reconcile(&mut self, number: usize) -> Result<(), LabError> {
        let Some(desired) = self.desired.sides[number].clone() else {
            return Ok(());
        };
        let Some(scene) = self.scene.clone() else {
            return Ok(());
        };
        if self.desired.size.0 == 0 || self.desired.size.1 == 0 {
            return Ok(());
        }
        let key = self.key(&desired, number);
        let side = &mut self.sides[number];
        if side.key.as_ref() == Some(&key) {
            // What failed meanwhile is taken back.
            side.failed = None;
            if std::mem::replace(&mut side.answered, self.number) != self.number {
                // A request that changes nothing visible is answered by a picture too.
                self.request_frames_of(number, Need::Frames(1));
            }
            return Ok(());
        }
        if side.failed.as_ref() == Some(&key) {
            side.answered = self.number;
            return Ok(());
        }
        match self.set_values(number, &key) {
            Ok(true) => {
                let side = &mut self.sides[number];
                let need = match &side.key {
                    Some(old) if side.differ_by_cursors(old, &key) => Need::Frames(1),
                    _ => Need::Light,
                };
                (side.key, side.failed, side.answered) = (Some(key), None, self.number);
                self.out.send(Report::Set { side: number });
                self.request_frames_of(1 - number, Need::Frames(1));
                self.request_frames_of(number, need);
                Ok(())
            }
            Ok(false) => {
                // The first picture of all comes from a graph of two small shaders.
                let file = self.lab.home.folders().passes.join("preview.ron");
                let is_first = self.sides[number].session.is_none() && number == 0;
                self.build(number, key, scene, is_first && file.is_file());
                Ok(())
            }
            Err(error) => self.fail(number, key, error),
        }
    }

    /// Sets the values of a side in its session. False if that takes a build.
    fn set_values(&mut self, number: usize, key: &Key) -> Result<bool, LabError> {
        let side = &mut self.sides[number];
        let (Some(session), Some(old), Some(loaded)) = (&mut side.session, &side.key, &side.loaded)
        else {
            return Ok(false);
        };
        let set = Key {
            side: key.side.clone(),
            ..old.clone()
        };
        if side.preview || set != *key || old.side.graph != key.side.graph {
            return Ok(false);
        }
        let mut params = loaded.graph.params.clone();
        if !key.side.apply(&mut params) {
            // The experiment has the places of wrong values.
            params = params_of(&loaded.graph, &self.desired.experiment(&key.side))?;
        }
        session.set_params(&self.lab, &params)
    }

    /// Starts the build of a session, unless one is in work.
    fn build(&mut self, number: usize, key: Key, scene: Arc<Scene>, preview: bool) {
        if self.sides[number].building.is_some() {
            return;
        }
        let scene = self.lit_scene(scene, key.lights);
        let side = &self.sides[number];
        // B starts with objects that it can share with A, and vice versa.
        let other = self.sides[1 - number].session.as_ref();
        let reuse = match &side.session {
            Some(session) => Some(session.reusable_parts()),
            None => other.map(|s| s.share()),
        };
        let same_files = |k: &Key| k.side.graph == key.side.graph && k.revision == key.revision;
        let has_files = !side.preview && side.key.as_ref().is_some_and(same_files);
        let loaded = side.loaded.clone().filter(|_| has_files);
        let mut experiment = self.desired.experiment(&key.side);
        if preview {
            experiment.graph = "preview.ron".into();
            experiment.params.clear();
        }
        self.sides[number].building = Some(Instant::now());
        let _ = self.jobs.send(Job {
            side: number,
            key,
            experiment,
            scene,
            reuse,
            loaded,
            preview,
            lab: self.lab.clone(),
        });
    }

    pub(super) fn built(&mut self, done: Done) -> Result<(), LabError> {
        let number = done.side;
        self.sides[number].building = None;
        let Some(desired) = self.desired.sides[number].clone() else {
            return Ok(());
        };
        match done.result {
            Ok((session, loaded)) => {
                let key = (!done.preview).then_some(&done.key);
                let side = &self.sides[number];
                let old = side.key.as_ref();
                let need = old.map_or(Need::Light, |old| side.need_of(old, &done.key));
                self.swap_in(number, session, loaded, key, done.start)?;
                self.request_frames_of(1 - number, Need::Frames(1));
                self.request_frames_of(number, need);
            }
            Err(error) if done.preview => {
                // Whatever is wrong will be said by the graph itself; here is none to fall back to.
                self.out
                    .send(Report::Trouble(format!("no preview: {error}")));
                self.sides[number].failed = None;
                if let Some(scene) = self.scene.clone() {
                    let key = self.key(&desired, number);
                    self.build(number, key, scene, false);
                }
                return Ok(());
            }
            Err(error) => self.fail(number, done.key, error)?,
        }
        self.reconcile(number)
    }

    /// Swaps in the session of a build that began at `start`; of the preview without a key.
    fn swap_in(
        &mut self,
        number: usize,
        mut session: Box<Session>,
        loaded: Loaded,
        key: Option<&Key>,
        start: Instant,
    ) -> Result<(), LabError> {
        let side = &mut self.sides[number];
        side.fresh = side.fresh || side.session.is_none() || side.preview;
        if let Some(mut old) = side.session.take() {
            let finished = old.finish()?;
            self.report_frames(number, finished);
            session.swap_in(&mut old)?;
        }
        if let Some(key) = key {
            self.out.send(Report::Built(BuiltReport {
                side: number,
                info: Arc::new(info(&session, &loaded)),
                change: session.program.change,
                ms: start.elapsed().as_secs_f64() * 1e3,
                revision: key.revision,
                objects: Arc::strong_count(&self.lab.gpu),
            }));
        }
        let side = &mut self.sides[number];
        side.key = key.cloned();
        (side.preview, side.lights, side.failed) = (key.is_none(), true, None);
        (side.session, side.loaded) = (Some(session), Some(loaded));
        Ok(())
    }

    /// Reports mistakes, and the old session runs on. Only a lost device is an error of the engine.
    fn fail(&mut self, number: usize, key: Key, error: LabError) -> Result<(), LabError> {
        if let LabError::Vulkan(VulkanError::Lost(_) | VulkanError::Hung(_)) = error {
            return Err(error);
        }
        let revision = key.revision;
        self.sides[number].failed = Some(key);
        let diagnostics = match error {
            LabError::Input(list) => list,
            other => vec![Diagnostic::error(Place::default(), other.to_string())],
        };
        self.out.send(Report::Failed {
            side: number,
            diagnostics,
            revision,
        });
        Ok(())
    }
}

impl Side {
    /// The frames that a build needs if it replaces another one.
    fn need_of(&self, old: &Key, new: &Key) -> Need {
        let same = Key {
            size: new.size,
            wanted: new.wanted.clone(),
            ..old.clone()
        };
        match same == *new || self.differ_by_cursors(&same, new) {
            true => Need::View,
            false => Need::Light,
        }
    }

    /// Whether two builds have the same light and differ only by the probe or the slice.
    fn differ_by_cursors(&self, old: &Key, new: &Key) -> bool {
        let graph = self.loaded.as_ref().map(|l| &*l.graph);
        let bare = |key: &Key| Key {
            side: save::without_cursors(&key.side, graph),
            ..key.clone()
        };
        bare(old) == bare(new)
    }
}

fn info(session: &Session, loaded: &Loaded) -> GraphInfo {
    let plan = &session.program.plan;
    let mut uses: Vec<PassUses> = Vec::new();
    for step in &plan.steps {
        if uses.last().is_none_or(|last| last.pass != step.pass) {
            uses.push(PassUses {
                pass: step.pass,
                ..PassUses::default()
            });
        }
        let Some(of) = uses.last_mut() else { continue };
        for u in &step.uses {
            let name = session.graph.name_of(u.res).to_string();
            for list in [
                u.read.then_some(&mut of.reads),
                u.write.then_some(&mut of.writes),
            ]
            .into_iter()
            .flatten()
            {
                if !list.contains(&name) {
                    list.push(name.clone());
                }
            }
        }
    }
    let written = |name: &String| uses.iter().any(|u| u.writes.contains(name));
    let mut empty: Vec<String> = plan
        .missing
        .iter()
        .map(|r| session.graph.name_of(*r).to_string())
        .collect();
    empty.retain(|name| !written(name));
    empty.dedup();
    GraphInfo {
        graph: loaded.graph.clone(),
        linked: session.linked.clone(),
        variables: session.surroundings.clone(),
        params: session.params.clone(),
        textures: plan.textures.clone(),
        memory: session.program.memory(&session.graph),
        scene_bytes: session.scene_bytes(),
        passes: uses.iter().map(|u| u.pass).collect(),
        left_out: plan.dropped.clone(),
        empty,
        uses,
    }
}
