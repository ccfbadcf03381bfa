//! Which parameters have an effect now, worked out on a thread once nothing changes for a moment.

use crate::graph::Evaluated;
use crate::graph::effect::{Reason, Running, effective, idle, resting};
use crate::shader::ShaderCompiler;
use crate::workbench::Workbench;
use crate::workbench::engine::report::GraphInfo;
use crossbeam_channel::{Receiver, Sender, unbounded};
use egui::Ui;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What the panel shows of parameters beside their values.
#[derive(Default)]
pub struct Found {
    /// Parameters that change nothing, and why.
    pub idle: BTreeMap<String, Reason>,
    /// What shaders take in place of a value.
    pub effective: BTreeMap<String, f64>,
    /// Passes that a condition leaves out, and the choices with which it would hold.
    pub resting: BTreeMap<String, Vec<(String, String)>>,
}

/// What they were found for: the graph as it runs, and the parameters that are set.
type Of = (Arc<GraphInfo>, Vec<(String, String)>);

/// What was found: side, what for, what.
type Made = (usize, Of, Found);

/// What is known of sides A and B.
pub struct Effects {
    known: [Option<(Of, Found)>; 2],
    /// A side that waits, for what, and since when that has not changed.
    waiting: Option<(usize, Of, Instant)>,
    working: bool,
    old: [bool; 2],
    made: (Sender<Made>, Receiver<Made>),
}

impl Default for Effects {
    fn default() -> Effects {
        Effects {
            known: [None, None],
            waiting: None,
            working: false,
            old: [false; 2],
            made: unbounded(),
        }
    }
}

/// How long nothing must change: it must not keep a frame waiting.
const QUIET: Duration = Duration::from_millis(400);

impl Effects {
    /// What is known of a side, be it of the values before.
    pub fn of(&self, side: usize) -> Option<&Found> {
        self.known[side].as_ref().map(|k| &k.1)
    }

    /// Whether what is known of a side is of other values than the present ones.
    pub fn is_old(&self, side: usize) -> bool {
        self.old[side]
    }

    /// Whether something is about to come.
    pub fn awaits(&self) -> bool {
        self.working || self.waiting.is_some()
    }
}

impl Workbench {
    /// Begins with the side that is out of date.
    pub(crate) fn find_effects(&mut self, ui: &Ui) {
        while let Ok((side, of, found)) = self.effects.made.1.try_recv() {
            self.effects.working = false;
            self.effects.known[side] = Some((of, found));
            // The panel may be painted already, and nothing else may ask for another frame.
            ui.ctx().request_repaint();
        }
        let same = |a: &Of, b: &Of| Arc::ptr_eq(&a.0, &b.0) && a.1 == b.1;
        let unknown = [0, 1].map(|side| {
            let of = (
                self.sides[side].info.clone()?,
                self.desired.sides[side].as_ref()?.params.clone(),
            );
            let is_known = self.effects.known[side]
                .as_ref()
                .is_some_and(|k| same(&k.0, &of));
            (!is_known).then_some((side, of))
        });
        // What is asked for and does not run yet counts as unknown too.
        let old =
            [0, 1].map(|side| unknown[side].is_some() || self.sides[side].behind(self.sent_number));
        if std::mem::replace(&mut self.effects.old, old) != old {
            ui.ctx().request_repaint();
        }
        let outdated = unknown.into_iter().flatten().next();
        let Some((side, of)) = outdated else {
            self.effects.waiting = None;
            return;
        };
        let waiting = self
            .effects
            .waiting
            .take()
            .filter(|w| w.0 == side && same(&w.1, &of));
        let (.., since) =
            *self
                .effects
                .waiting
                .insert(waiting.unwrap_or((side, of.clone(), Instant::now())));
        if self.effects.working || since.elapsed() < QUIET {
            ui.ctx().request_repaint_after(QUIET);
            return;
        }
        (self.effects.working, self.effects.waiting) = (true, None);
        let (out, wake) = (self.effects.made.0.clone(), self.wake.clone());
        let (folder, cache) = (self.home.folders().shaders, self.home.cache.clone());
        std::thread::spawn(move || {
            let found = find(&of, &ShaderCompiler::new(&folder, cache.as_deref()));
            let _ = out.send((side, of, found));
            wake();
        });
    }
}

fn find((info, set): &Of, compiler: &ShaderCompiler) -> Found {
    let graph = &info.graph;
    let mut params = graph.params.clone();
    for (name, text) in set {
        // What is wrong with a value is told where it is built.
        let _ = params.set(name, text);
    }
    let set = Evaluated::new(graph, &params, info.variables.clone());
    let running = Running {
        set: &set,
        linked: &info.linked,
        passes: &info.passes,
        written: info
            .uses
            .iter()
            .flat_map(|u| &u.writes)
            .map(String::as_str)
            .collect(),
    };
    let taken = |name: &str| effective(&set, params.param(name)?);
    let effective = params
        .list
        .iter()
        .filter_map(|p| Some((p.name.clone(), taken(&p.name)?)))
        .collect();
    Found {
        idle: idle(&running, compiler),
        effective,
        resting: resting(&set),
    }
}
