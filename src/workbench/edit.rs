//! What the user edits: two slots, the scene, the camera; with undo.

use super::wish::{SlotWish, Wish};
use crate::graph::param::{Param, Params, Value};

/// A value as RON, as experiments write it.
pub fn to_ron(value: &Value) -> String {
    match value {
        Value::Choice(name) => format!("\"{name}\""),
        other => other.to_string(),
    }
}

/// The parameters that differ from their defaults.
pub fn changed(params: &Params) -> Vec<(String, String)> {
    let pairs = params.list.iter().zip(&params.values);
    pairs.filter(|(p, v)| p.default != **v).map(|(p, v)| (p.name.clone(), to_ron(v))).collect()
}

/// A parameter's value in a slot: what is set, else the default.
pub fn value(slot: &SlotWish, param: &Param) -> Value {
    let set = slot.params.iter().rev().find(|(name, _)| *name == param.name);
    set.and_then(|(_, text)| param.parse(text).ok()).unwrap_or_else(|| param.default.clone())
}

/// Sets a parameter of a slot; values at the default are not kept.
pub fn set(slot: &mut SlotWish, param: &Param, value: &Value) {
    let place = slot.params.iter().position(|(name, _)| *name == param.name);
    let at_default = *value == param.default;
    match (place, at_default) {
        (Some(i), true) => drop(slot.params.remove(i)),
        (Some(i), false) => slot.params[i].1 = to_ron(value),
        (None, true) => {}
        (None, false) => slot.params.push((param.name.clone(), to_ron(value))),
    }
}

/// States to go back and forth between.
#[derive(Default)]
pub struct History {
    past: Vec<Wish>,
    future: Vec<Wish>,
    settled: Option<Wish>,
}

/// States that are remembered.
const MOST: usize = 200;

/// Whether two wishes are the same to somebody who presses undo: views and measurements do not count.
fn same(a: &Wish, b: &Wish) -> bool {
    a.slots == b.slots && a.scene == b.scene && a.lights == b.lights
}

impl History {
    /// Remembers the state after an edit; while `held` (a slider in the hand) it is still the same edit.
    pub fn note(&mut self, wish: &Wish, held: bool) {
        match &self.settled {
            None => self.settled = Some(wish.clone()),
            Some(settled) if !held && !same(settled, wish) => {
                let settled = self.settled.replace(wish.clone());
                self.past.extend(settled);
                if self.past.len() > MOST {
                    self.past.remove(0);
                }
                self.future.clear();
            }
            Some(_) => {}
        }
    }

    /// Whether there is something to undo and to redo.
    pub fn can(&self) -> (bool, bool) {
        (!self.past.is_empty(), !self.future.is_empty())
    }

    /// Goes back, or forth, in what counts as an edit.
    pub fn go(&mut self, wish: &mut Wish, back: bool) {
        let (from, to) = if back { (&mut self.past, &mut self.future) } else { (&mut self.future, &mut self.past) };
        let Some(state) = from.pop() else { return };
        to.push(wish.clone());
        wish.slots.clone_from(&state.slots);
        wish.scene.clone_from(&state.scene);
        wish.lights.clone_from(&state.lights);
        self.settled = Some(wish.clone());
    }
}
