//! Undo: states to go back and forth between.

use super::request::RenderRequest;
use crate::workbench::Workbench;

/// The state that undo restores.
#[derive(Clone)]
pub struct State {
    desired: RenderRequest,
    name: String,
    fixed_size: Option<(u32, u32)>,
    /// The scene's time, s.
    time: f64,
}

/// A state, and whether the way to or from it was the opening of an experiment: then view, size and
/// time are part of it.
type Step = (State, bool);

/// The states of a session.
#[derive(Default)]
pub struct History {
    past: Vec<Step>,
    future: Vec<Step>,
    settled: Option<State>,
    opened: bool,
}

/// States that are remembered.
const MOST: usize = 200;

impl State {
    /// Whether undo has nothing to do between two states: views and measurements do not count,
    /// unless an experiment was opened.
    fn same(&self, other: &State, opened: bool) -> bool {
        let (a, b) = (&self.desired, &other.desired);
        let edit = a.sides == b.sides && (a.source(), &a.lights) == (b.source(), &b.lights);
        let view =
            a.camera == b.camera && self.fixed_size == other.fixed_size && self.name == other.name;
        edit && (view || !opened)
    }
}

impl History {
    /// The edit in work opens an experiment.
    pub fn opens(&mut self) {
        self.opened = true;
    }

    /// Remembers the state after an edit; while `held` (a slider in the hand) it is still the same
    /// edit.
    fn note(&mut self, state: State, held: bool) {
        let opened = self.opened;
        match &mut self.settled {
            Some(settled) if !settled.same(&state, opened) => {
                if !held {
                    self.past.push((std::mem::replace(settled, state), opened));
                    if self.past.len() > MOST {
                        self.past.remove(0);
                    }
                    self.future.clear();
                    self.opened = false;
                }
            }
            // A view that moves without an edit is where the next edit begins.
            _ => {
                self.settled = Some(state);
                self.opened = false;
            }
        }
    }

    /// Whether there is something to undo and to redo.
    pub fn can(&self) -> (bool, bool) {
        (!self.past.is_empty(), !self.future.is_empty())
    }

    /// The state to go to from this one.
    fn step(&mut self, now: State, back: bool) -> Option<Step> {
        let (from, to) = if back {
            (&mut self.past, &mut self.future)
        } else {
            (&mut self.future, &mut self.past)
        };
        let (state, opened) = from.pop()?;
        to.push((now, opened));
        Some((state, opened))
    }
}

impl History {
    /// Forgets a scene that could not be loaded: its states take the scene of `before`, to which
    /// the session returns.
    fn forget_scene(&mut self, failed: &RenderRequest, before: &State) {
        let steps = self.past.iter_mut().chain(&mut self.future);
        for state in steps.map(|s| &mut s.0).chain(&mut self.settled) {
            let desired = &mut state.desired;
            if desired.source() == failed.source() {
                let before = &before.desired;
                desired.scene.clone_from(&before.scene);
                desired.environment.clone_from(&before.environment);
                desired.lights.clone_from(&before.lights);
                desired.camera = before.camera;
            }
        }
        self.settled = Some(before.clone());
        while self
            .past
            .pop_if(|(last, opened)| last.same(before, *opened))
            .is_some()
        {}
        self.opened = false;
    }
}

impl Workbench {
    /// Returns to the shown scene and to the state before the request of another scene, which could
    /// not be loaded.
    pub(crate) fn return_to_scene(&mut self) {
        let Some(before) = self.scene.before.take() else {
            return;
        };
        let now = std::mem::take(&mut self.desired);
        self.desired = RenderRequest {
            revision: now.revision,
            scene_revision: now.scene_revision,
            clock: now.clock,
            continuous: now.continuous,
            execution: now.execution,
            ..before.desired.clone()
        };
        self.experiment.name.clone_from(&before.name);
        self.layout.fixed_size = before.fixed_size;
        (self.experiment.file, self.undo.returning) = (None, false);
        self.undo.history.forget_scene(&now, &before);
    }

    pub(crate) fn state(&self) -> State {
        State {
            desired: self.desired.clone(),
            name: self.experiment.name.clone(),
            fixed_size: self.layout.fixed_size,
            time: self.shown_time(),
        }
    }

    /// The scene's time in the shown picture, s.
    pub(crate) fn shown_time(&self) -> f64 {
        let picture = self.sides[0].picture.as_ref();
        picture.map_or(self.desired.clock.at, |p| p.time)
    }

    /// Remembers what there is now; see [`History::note`].
    pub(crate) fn remember(&mut self, held: bool) {
        let state = self.state();
        self.undo.history.note(state, held);
    }

    /// Goes back, or forth, by one edit.
    pub(crate) fn go(&mut self, back: bool) {
        let now = self.state();
        let Some((state, opened)) = self.undo.history.step(now, back) else {
            return;
        };
        let desired = state.desired;
        if self.desired.source() != desired.source() {
            self.open_scene(&desired.scene);
            self.desired.environment = desired.environment;
            // It is seen as it was, not as an experiment would have it.
            self.undo.returning = desired.camera.is_some();
            self.desired.camera = desired.camera;
        }
        self.desired.sides = desired.sides;
        self.desired.lights = desired.lights;
        if opened {
            self.desired.camera = desired.camera;
            self.desired.size = desired.size;
            self.desired.clock.at = state.time;
            self.desired.clock.jumps += 1;
            self.experiment.name = state.name;
            (self.layout.fixed_size, self.layout.resize_since) = (state.fixed_size, None);
            self.experiment.file = None;
        }
        self.undo.history.settled = Some(self.state());
    }
}
