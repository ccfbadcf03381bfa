//! Reconciles a side with the desired state: sets values, or swaps in a build.

use super::Run;
use super::builder::{Done, Job, Key};
use super::converge::Need;
use super::report::{GraphInfo, PassUses, Report};
use crate::diagnostics::{Diagnostic, Place};
use crate::lab::{LabError, Loaded, Session, params_of};
use crate::vulkan::VulkanError;
use crate::workbench::desired::request::SideRequest;
use std::sync::Arc;
use std::time::Instant;

impl Run<'_> {
    pub(super) fn key(&self, side: &SideRequest, number: usize) -> Key {
        let asked = self.desired.read_back.as_ref();
        let graph = self.sides[number].loaded.as_ref().map(|l| &*l.graph);
        let wanted = asked
            .filter(|asked| asked.side() == number)
            .and_then(|asked| asked.resource(graph));
        Key {
            side: side.clone(),
            size: self.desired.size,
            revision: self.desired.revision,
            scene: self.scene_number,
            wanted,
        }
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
        let experiment = self.desired.experiment(&desired);
        let side = &mut self.sides[number];
        if side.key.as_ref() == Some(&key) {
            // What failed meanwhile is taken back.
            side.failed = None;
            side.answered = self.number;
            return Ok(());
        }
        if side.failed.as_ref() == Some(&key) {
            side.answered = self.number;
            return Ok(());
        }
        let same_files = |k: &Key| k.side.graph == key.side.graph && k.revision == key.revision;
        if let (Some(session), Some(old), Some(loaded)) =
            (&mut side.session, &side.key, &side.loaded)
            && !side.preview
            && same_files(old)
            && (old.size, old.scene, &old.wanted) == (key.size, key.scene, &key.wanted)
        {
            let mut params = loaded.graph.params.clone();
            let params = match desired.apply(&mut params) {
                true => Ok(params),
                // The experiment has the places of wrong values.
                false => params_of(&loaded.graph, &experiment),
            };
            let set = params.and_then(|params| session.set_params(&self.lab, &params));
            match set {
                Ok(true) => {
                    side.key = Some(key);
                    side.failed = None;
                    side.answered = self.number;
                    self.out.send(Report::Set { side: number });
                    self.request_frames_of(1 - number, Need::Frames(1));
                    self.request_frames_of(number, Need::Light);
                    return Ok(());
                }
                Ok(false) => {}
                Err(error) => {
                    self.fail(number, key, error)?;
                    return Ok(());
                }
            }
        }
        // B starts with objects that it can share with A, and vice versa.
        let other = self.sides[1 - number]
            .session
            .as_ref()
            .filter(|_| self.sides[number].session.is_none());
        let shared = other.map(|s| s.share());
        let preview_exists = self.lab.home.folders().passes.join("preview.ron").is_file();
        let side = &mut self.sides[number];
        if side.building.is_some() {
            return Ok(());
        }
        // The first picture of all comes from a graph of two small shaders.
        let preview = side.session.is_none() && number == 0 && preview_exists;
        let mut experiment = experiment;
        if preview {
            experiment.graph = "preview.ron".into();
            experiment.params.clear();
        }
        let loaded = side
            .loaded
            .clone()
            .filter(|_| !side.preview && side.key.as_ref().is_some_and(same_files));
        let reuse = side.session.as_ref().map(|s| s.reusable_parts()).or(shared);
        side.building = Some(Instant::now());
        let lab = self.lab.clone();
        let _ = self.jobs.send(Job {
            side: number,
            key,
            experiment,
            scene,
            reuse,
            loaded,
            preview,
            lab,
        });
        Ok(())
    }

    pub(super) fn built(&mut self, done: Done) -> Result<(), LabError> {
        let number = done.side;
        self.sides[number].building = None;
        if self.desired.sides[number].is_none() {
            return Ok(());
        }
        match done.result {
            Ok((mut session, loaded)) => {
                let side = &mut self.sides[number];
                side.fresh = side.fresh || side.session.is_none() || side.preview;
                let need = side
                    .key
                    .as_ref()
                    .map_or(Need::Light, |key| need(key, &done.key));
                if let Some(mut old) = side.session.take() {
                    let finished = old.finish()?;
                    self.report_frames(number, finished);
                    session.swap_in(&mut old)?;
                }
                let side = &mut self.sides[number];
                side.preview = done.preview;
                side.lights = true;
                side.failed = None;
                let info = info(&session, &loaded);
                let change = session.program.change;
                side.session = Some(session);
                side.loaded = Some(loaded);
                if done.preview {
                    side.key = None;
                } else {
                    side.key = Some(done.key.clone());
                    let ms = done.start.elapsed().as_secs_f64() * 1e3;
                    let revision = done.key.revision;
                    let objects = Arc::strong_count(&self.lab.gpu);
                    let info = Arc::new(info);
                    self.out.send(Report::Built {
                        side: number,
                        info,
                        change,
                        ms,
                        revision,
                        objects,
                    });
                }
                self.request_frames_of(1 - number, Need::Frames(1));
                self.request_frames_of(number, need);
            }
            Err(error) if done.preview => {
                // Whatever is wrong will be said by the graph itself; here is none to fall back to.
                self.out
                    .send(Report::Trouble(format!("no preview: {error}")));
                let key = self.desired.sides[number]
                    .clone()
                    .map(|w| self.key(&w, number));
                self.sides[number].failed = None;
                if let (Some(key), Some(scene), Some(desired)) =
                    (key, self.scene.clone(), &self.desired.sides[number])
                {
                    let experiment = self.desired.experiment(desired);
                    self.sides[number].building = Some(Instant::now());
                    let (reuse, loaded, lab) = (None, None, self.lab.clone());
                    let job = Job {
                        side: number,
                        key,
                        experiment,
                        scene,
                        reuse,
                        loaded,
                        preview: false,
                        lab,
                    };
                    let _ = self.jobs.send(job);
                }
                return Ok(());
            }
            Err(error) => self.fail(number, done.key, error)?,
        }
        self.reconcile(number)
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

/// The frames that a build needs if it replaces another one.
fn need(old: &Key, new: &Key) -> Need {
    let same = Key {
        size: new.size,
        wanted: new.wanted.clone(),
        ..old.clone()
    };
    if same == *new {
        Need::View
    } else {
        Need::Light
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
        warnings: loaded.warnings.clone(),
    }
}
