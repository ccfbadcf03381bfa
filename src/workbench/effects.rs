//! Which parameters have an effect now, worked out on a thread once nothing changes for a moment.

use super::Workbench;
use super::report::GraphInfo;
use crate::graph::effect::{Reason, Running, effective, idle};
use crate::shader::ShaderCompiler;
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
}

/// What they were found for: the graph as it runs, and the parameters that are set.
type Of = (Arc<GraphInfo>, Vec<(String, String)>);

/// What was found: side, what for, what.
type Made = (usize, Of, Found);

/// What is known of sides A and B.
pub struct Effects {
    known: [Option<(Of, Found)>; 2],
    /// Since when a side waits.
    since: Option<Instant>,
    working: bool,
    made: (Sender<Made>, Receiver<Made>),
}

impl Default for Effects {
    fn default() -> Effects {
        Effects { known: [None, None], since: None, working: false, made: unbounded() }
    }
}

/// How long nothing must change: it must not keep a frame waiting.
const QUIET: Duration = Duration::from_millis(200);

impl Effects {
    /// What is known of a side, be it of the values before.
    pub fn of(&self, side: usize) -> Option<&Found> {
        self.known[side].as_ref().map(|k| &k.1)
    }

    /// Whether something is about to come.
    pub fn awaits(&self) -> bool {
        self.working || self.since.is_some()
    }
}

impl Workbench {
    /// Begins with the side that is out of date.
    pub(super) fn find_effects(&mut self, ui: &Ui) {
        while let Ok((side, of, found)) = self.effects.made.1.try_recv() {
            self.effects.working = false;
            self.effects.known[side] = Some((of, found));
        }
        let outdated = (0..2).find_map(|side| {
            let of = (self.sides[side].info.clone()?, self.desired.sides[side].as_ref()?.params.clone());
            let is_known = |k: &(Of, Found)| Arc::ptr_eq(&k.0.0, &of.0) && k.0.1 == of.1;
            (!self.effects.known[side].as_ref().is_some_and(is_known)).then_some((side, of))
        });
        let Some((side, of)) = outdated else {
            self.effects.since = None;
            return;
        };
        let since = *self.effects.since.get_or_insert_with(Instant::now);
        if self.effects.working || since.elapsed() < QUIET {
            ui.ctx().request_repaint_after(QUIET);
            return;
        }
        self.effects.working = true;
        self.effects.since = None;
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
    let running = Running {
        graph,
        linked: &info.linked,
        passes: &info.passes,
        written: info.uses.iter().flat_map(|u| &u.writes).map(String::as_str).collect(),
        variables: &info.variables,
    };
    let taken = |name: &str| effective(graph, &params.list[params.index(name)?], &params, &info.variables);
    let effective = params.list.iter().filter_map(|p| Some((p.name.clone(), taken(&p.name)?))).collect();
    Found { idle: idle(&running, &params, compiler), effective }
}
