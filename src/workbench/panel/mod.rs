//! The panel of parameters, made from the graph's declarations alone.

pub(crate) mod control;
pub(crate) mod effects;

use crate::graph::Graph;
use crate::graph::effect::Reason;
use crate::graph::param::Param;
use crate::workbench::desired::edit;
use crate::workbench::desired::request::SideRequest;
use control::{Look, control, label, label_width, named, reset_button, small_button};
use effects::Found;
use egui::{Button, RichText, Ui, WidgetType};
use std::cell::RefCell;

/// What of the panel is not part of the experiment.
#[derive(Default)]
pub struct Panel {
    /// The side shown: 0 is A, 1 is B.
    pub side: usize,
    /// Text that names, groups or help must hold.
    pub search: String,
    /// Whether only changed parameters are shown.
    pub only_changed: bool,
    /// The parameter that a sweep was asked of.
    pub sweep: Option<String>,
    /// Whether it had them when it was shown last: Esc has taken them by then.
    pub typing: bool,
}

/// The inputs of a side's rows.
struct Shown<'a> {
    graph: &'a Graph,
    found: Option<&'a Found>,
    /// Whether that is of other values.
    old: bool,
    /// Name and values of the side that it is compared with.
    other: Option<(&'static str, &'a SideRequest)>,
    /// Takes the parameter that a sweep is asked of.
    sweep: RefCell<&'a mut Option<String>>,
}

/// The parameters that a search finds.
struct Wanted {
    needle: String,
    only_changed: bool,
}

impl Wanted {
    fn is_search(&self) -> bool {
        !self.needle.is_empty() || self.only_changed
    }

    fn has(&self, graph: &Graph, param: &Param, side: &SideRequest) -> bool {
        matches(graph, param, &self.needle)
            && (!self.only_changed || is_changed(graph, side, param))
    }
}

/// The search field.
fn search_id() -> egui::Id {
    egui::Id::new("search parameters")
}

impl Panel {
    /// Gives the search the keys, those of this frame too.
    pub fn find(ui: &Ui) {
        ui.memory_mut(|m| m.request_focus(search_id()));
    }

    /// Shows the parameters of a side; edits go into it. `other` is the side it is compared with,
    /// `file` the parameters of the opened file.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        graph: &Graph,
        side: &mut SideRequest,
        other: Option<(&'static str, &SideRequest)>,
        (found, old): (Option<&Found>, bool),
        file: Option<&SideRequest>,
    ) {
        self.top(ui, graph, side, file);
        let wanted = Wanted {
            needle: folded(&self.search),
            only_changed: self.only_changed,
        };
        let shown = Shown {
            graph,
            found,
            old,
            other,
            sweep: RefCell::new(&mut self.sweep),
        };
        // Wide rows scroll: they must not make the panel wider.
        egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            if !wanted.is_search() && !graph.pinned.is_empty() {
                egui::CollapsingHeader::new("Pinned")
                    .default_open(true)
                    .show(ui, |ui| shown.pinned(ui, side));
            }
            let mut any = false;
            for (number, group) in groups(graph).into_iter().enumerate() {
                any |= shown.group(ui, number, group, &wanted, side);
            }
            any |= shown.retired(ui, &wanted, side);
            if !any {
                ui.weak(match self.only_changed && wanted.needle.is_empty() {
                    true => "Nothing is changed",
                    false => "Nothing matches",
                });
            }
        });
    }

    fn top(
        &mut self,
        ui: &mut Ui,
        graph: &Graph,
        side: &mut SideRequest,
        file: Option<&SideRequest>,
    ) {
        let top = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(
            top,
            egui::Layout::right_to_left(egui::Align::Center),
            |ui| {
                ui.menu_button("Reset", |ui| reset_menu(ui, graph, side, file))
                    .response
                    .on_hover_text("Resets all parameters");
                ui.checkbox(&mut self.only_changed, "changed")
                    .on_hover_text("Only parameters that are not at their default");
                let clear = ui.add_enabled(
                    !self.search.is_empty(),
                    egui::Button::new("×").small().frame(false),
                );
                named(&clear, WidgetType::Button, "clear the search");
                let hint = egui::TextEdit::singleline(&mut self.search)
                    .id(search_id())
                    .hint_text("search");
                let field = ui
                    .add(hint.desired_width(f32::INFINITY))
                    .on_hover_text("Ctrl F; Esc clears");
                named(&field, WidgetType::TextEdit, "search parameters");
                self.typing = field.has_focus();
                if clear.clicked() {
                    self.search.clear();
                }
            },
        );
    }
}

impl Shown<'_> {
    /// The parameters that the graph pins, by their titles.
    fn pinned(&self, ui: &mut Ui, side: &mut SideRequest) {
        for (name, title) in &self.graph.pinned {
            let params = &self.graph.params;
            if let Some(param) = params.param(name) {
                self.row(ui, param, title, side);
            } else if let Some((_, instead)) = params.retired.iter().find(|r| r.0 == *name) {
                elsewhere(ui, name, title, instead, side);
            }
        }
        self.needed(ui, side);
    }

    /// The parameters of a group that are wanted. False if there are none.
    fn group(
        &self,
        ui: &mut Ui,
        number: usize,
        group: &str,
        wanted: &Wanted,
        side: &mut SideRequest,
    ) -> bool {
        let graph = self.graph;
        let of_group = || graph.params.offered().filter(|p| p.group == group);
        let list: Vec<&Param> = of_group().filter(|p| wanted.has(graph, p, side)).collect();
        if list.is_empty() {
            return false;
        }
        let title = if group.is_empty() { "Other" } else { group };
        let title = match of_group().filter(|p| is_changed(graph, side, p)).count() {
            0 => RichText::new(title),
            n => RichText::new(format!("{title} ({n})")).color(ui.visuals().warn_fg_color),
        };
        // Groups that a search opens are folded again after it.
        let searching = wanted.is_search();
        let header = egui::CollapsingHeader::new(title).id_salt((searching, "group", number));
        header.default_open(searching).show(ui, |ui| {
            for param in list {
                self.row(ui, param, &param.name, side);
            }
        });
        true
    }

    /// The parameters of other graphs that a search finds. False if there are none.
    fn retired(&self, ui: &mut Ui, wanted: &Wanted, side: &mut SideRequest) -> bool {
        let params = &self.graph.params;
        let fits = |name: &str| {
            let is_param = !name.contains('=') && params.index(name).is_none();
            is_param && folded(name).contains(&wanted.needle)
        };
        let searching = wanted.is_search() && !wanted.only_changed;
        let mut any = false;
        for (name, instead) in &params.retired {
            if searching && fits(name) {
                any = true;
                elsewhere(ui, name, name, instead, side);
            }
        }
        any
    }

    /// The choice with which most of the dimmed pinned parameters would count, a click away.
    fn needed(&self, ui: &mut Ui, side: &mut SideRequest) {
        let reasons = self
            .graph
            .pinned
            .iter()
            .filter_map(|p| self.found?.idle.get(&p.0));
        let needs: Vec<&(String, String)> = reasons.flat_map(|r| &r.needs).collect();
        let count = |need: &(String, String)| needs.iter().filter(|n| **n == need).count();
        // The first of several.
        let Some((name, option)) = needs.iter().rev().max_by_key(|n| count(n)) else {
            return;
        };
        let Some(param) = self.graph.params.param(name) else {
            return;
        };
        let Ok(value) = param.parse(option) else {
            return;
        };
        ui.horizontal(|ui| {
            if self.old {
                // A second click would go on from a choice that is on its way.
                return drop(ui.weak("Greyed-out settings have no effect in this picture"));
            }
            ui.weak("Greyed-out settings need");
            if ui
                .small_button(format!("{name} = {option}"))
                .on_hover_text(&param.help)
                .clicked()
            {
                edit::set(side, param, &value);
            }
        });
    }

    fn row(&self, ui: &mut Ui, param: &Param, title: &str, side: &mut SideRequest) {
        let before = edit::value(side, param);
        let mut value = before.clone();
        let changed = is_changed(self.graph, side, param);
        let idle = self.found.and_then(|f| f.idle.get(&param.name));
        ui.horizontal(|ui| {
            let auto = self
                .found
                .and_then(|f| f.effective.get(&param.name))
                .filter(|_| !changed)
                .copied();
            let look = Look {
                changed,
                idle: idle.is_some(),
                auto,
                chosen: self
                    .found
                    .and_then(|f| f.auto.get(&param.name))
                    .map(String::as_str),
            };
            let response = control(ui, param, title, &mut value, &look);
            row_menu(ui, &response).show(|ui| {
                if ui.button("Sweep…").clicked() {
                    **self.sweep.borrow_mut() = Some(param.name.clone());
                }
                if ui.add_enabled(changed, Button::new("Reset")).clicked() {
                    value = param.default.clone();
                }
                if ui.button("Copy name").clicked() {
                    ui.ctx().copy_text(param.name.clone());
                }
            });
            response.on_hover_ui(|ui| help(ui, param, idle));
            if reset_button(ui, changed, &param.name) {
                value = param.default.clone();
            }
        });
        if let Some((name, other)) = self.other {
            let theirs = edit::value(other, param);
            if theirs != before {
                ui.horizontal(|ui| {
                    ui.add_space(label_width(ui) + ui.spacing().item_spacing.x);
                    ui.weak(format!("{name}: {theirs}"));
                });
            }
        }
        if value != before {
            edit::set(side, param, &value);
        }
    }
}

/// The menu of a row; a right click anywhere in the row opens it.
fn row_menu<'a>(ui: &Ui, response: &'a egui::Response) -> egui::Popup<'a> {
    let row = ui.max_rect().with_max_y(response.rect.bottom());
    let clicked = ui.rect_contains_pointer(row) && ui.input(|i| i.pointer.secondary_clicked());
    let opens = clicked.then_some(egui::SetOpenCommand::Bool(true));
    egui::Popup::menu(response)
        .open_memory(opens)
        .at_pointer_fixed()
}

/// A parameter that another graph has; a button goes there, where the graph's text begins with its
/// name.
fn elsewhere(ui: &mut Ui, name: &str, title: &str, instead: &str, side: &mut SideRequest) {
    ui.horizontal(|ui| {
        let width = label_width(ui);
        label(ui, width, RichText::new(title).weak()).on_hover_text(format!("{name}: {instead}"));
        let graph = instead
            .strip_prefix("graph: \"")
            .and_then(|rest| rest.split_once('"'))
            .map(|(graph, _)| graph);
        match graph {
            Some(graph) => {
                let text = format!("use {graph}");
                if small_button(ui, &text, &format!("{text} for {title}"), instead) {
                    side.graph = graph.to_string();
                }
            }
            None => drop(ui.weak(instead)),
        }
    });
}

/// Sets all parameters back: to the opened file, or to the graph's defaults.
fn reset_menu(ui: &mut Ui, graph: &Graph, side: &mut SideRequest, file: Option<&SideRequest>) {
    let is_new = |file: &&SideRequest| (&file.params, &file.off) != (&side.params, &side.off);
    let file = file.filter(|file| file.graph == side.graph).filter(is_new);
    let button = egui::Button::new("To the opened file");
    if ui.add_enabled(file.is_some(), button).clicked() {
        if let Some(file) = file {
            side.params.clone_from(&file.params);
            side.off.clone_from(&file.off);
        }
        ui.close();
    }
    let any = graph.params.offered().any(|p| is_changed(graph, side, p));
    let button = egui::Button::new("To the graph's defaults");
    if ui.add_enabled(any, button).clicked() {
        side.params.clear();
        side.off.clear();
        ui.close();
    }
}

/// The groups of parameters, in the graph's order.
fn groups(graph: &Graph) -> Vec<&str> {
    let mut groups: Vec<&str> = Vec::new();
    for param in graph.params.offered() {
        if !groups.contains(&param.group.as_str()) {
            groups.push(&param.group);
        }
    }
    // The sort keeps the order of groups that the graph does not name.
    let place = |group: &&str| graph.groups.iter().position(|g| g == group);
    groups.sort_by_key(|group| place(group).unwrap_or(usize::MAX));
    groups
}

/// A text to be compared without regard to case, spaces and underscores.
pub(super) fn folded(text: &str) -> String {
    text.chars()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

fn matches(graph: &Graph, param: &Param, needle: &str) -> bool {
    let title = graph
        .pinned
        .iter()
        .find(|p| p.0 == param.name)
        .map_or("", |p| p.1.as_str());
    let texts = [param.name.as_str(), title, &param.group, &param.help];
    needle.is_empty() || texts.iter().any(|text| folded(text).contains(needle))
}

/// Whether a value differs from the default. The pointer's position is no setting.
fn is_changed(graph: &Graph, side: &SideRequest, param: &Param) -> bool {
    edit::value(side, param) != param.default && graph.pointer.as_ref() != Some(&param.name)
}

fn help(ui: &mut Ui, param: &Param, idle: Option<&Reason>) {
    ui.set_max_width(320.0);
    ui.strong(&param.name);
    if let Some(why) = idle {
        let why = &why.text;
        let text = if why.starts_with("if ") {
            format!("used only {why}")
        } else {
            why.clone()
        };
        ui.colored_label(ui.visuals().warn_fg_color, format!("No effect now: {text}"));
    }
    ui.label(&param.help);
    let mut facts = vec![format!("default {}", param.default)];
    if let Some((low, high)) = param.range {
        facts.push(format!("{low} to {high}"));
    }
    if !param.unit.is_empty() {
        facts.push(param.unit.clone());
    }
    if param.is_compiled() {
        facts.push("compile-time constant: changing it recompiles shaders".into());
    }
    ui.weak(facts.join(", "));
}

#[cfg(test)]
mod tests {
    use super::folded;

    #[test]
    fn names_are_found_however_they_are_written() {
        for text in ["lod_offset", "LOD offset", "lodOffset", "lod-offset"] {
            assert_eq!(folded(text), "lodoffset");
        }
    }
}
