//! Which parameters have an effect now, worked out on a thread once nothing changes for a moment.

use crate::graph::Evaluated;
use crate::graph::effect::{Reason, Running, effective, idle, resting};
use crate::shader::ShaderCompiler;
use crate::workbench::Workbench;
use crate::workbench::background::Background;
use crate::workbench::desired::request::SideRequest;
use crate::workbench::engine::report::GraphInfo;
use egui::Ui;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Details of parameters for the panel.
#[derive(Default)]
pub struct Found {
    /// Parameters that change nothing, and why.
    pub idle: BTreeMap<String, Reason>,
    /// What shaders take in place of a value.
    pub effective: BTreeMap<String, f64>,
    /// The options that `auto` stands for, by choice.
    pub auto: BTreeMap<String, String>,
    /// Passes that a condition leaves out, and the choices with which it would hold.
    pub resting: BTreeMap<String, Vec<(String, String)>>,
}

/// Their inputs: the running graph, and the set parameters.
type Of = (Arc<GraphInfo>, SideRequest);

/// Details of sides A and B.
#[derive(Default)]
pub struct Effects {
    known: [Option<(Of, Found)>; 2],
    /// A side that waits, for what, and since when that has not changed.
    waiting: Option<(usize, Of, Instant)>,
    old: [bool; 2],
    work: Background<(usize, Of), Found>,
}

/// How long nothing must change: it must not keep a frame waiting.
const QUIET: Duration = Duration::from_millis(400);

impl Effects {
    /// The details of a side, possibly of earlier values.
    pub fn of(&self, side: usize) -> Option<&Found> {
        self.known[side].as_ref().map(|k| &k.1)
    }

    /// Whether the details of a side are of earlier values.
    pub fn is_old(&self, side: usize) -> bool {
        self.old[side]
    }

    /// Whether something is about to come.
    pub fn awaits(&self) -> bool {
        self.work.is_working() || self.waiting.is_some()
    }
}

impl Workbench {
    /// Begins with the side that is out of date.
    pub(crate) fn find_effects(&mut self, ui: &Ui) {
        while let Some(((side, of), found)) = self.effects.work.take() {
            self.effects.known[side] = Some((of, found.unwrap_or_default()));
            // The panel may be painted already, and nothing else may ask for another frame.
            ui.ctx().request_repaint();
        }
        let same = |a: &Of, b: &Of| Arc::ptr_eq(&a.0, &b.0) && a.1 == b.1;
        let unknown = [0, 1].map(|side| {
            let of = (
                self.sides[side].info.clone()?,
                self.desired.sides[side].clone()?,
            );
            let is_known = self.effects.known[side]
                .as_ref()
                .is_some_and(|k| same(&k.0, &of));
            (!is_known).then_some((side, of))
        });
        // A request that does not run yet counts as unknown.
        let old =
            [0, 1].map(|side| unknown[side].is_some() || self.sides[side].behind(self.sent.number));
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
        if self.effects.work.is_working() || since.elapsed() < QUIET {
            ui.ctx().request_repaint_after(QUIET);
            return;
        }
        self.effects.waiting = None;
        let (folder, cache) = (
            self.setup.home.folders().shaders,
            self.setup.home.cache.clone(),
        );
        let input = of.clone();
        self.effects
            .work
            .start((side, of), &self.setup.wake, move || {
                find(&input, &ShaderCompiler::new(&folder, cache.as_deref()))
            });
    }
}

fn find((info, side): &Of, compiler: &ShaderCompiler) -> Found {
    let graph = &info.graph;
    let mut params = graph.params.clone();
    // The build reports wrong values.
    side.apply(&mut params);
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
        auto: set.chosen(),
        resting: resting(&set),
    }
}
