//! The list of lights: add, duplicate, switch off, remove.

use super::light::fields;
use super::sky;
use crate::scene::Light;
use crate::scene::light::KINDS;
use crate::workbench::Workbench;
use crate::workbench::desired::lights as new;
use crate::workbench::desired::request::LightState;
use crate::workbench::panel::control::named;
use egui::{Ui, WidgetType};
use egui_phosphor::regular::{COPY, TRASH};

/// A change to the list.
enum Asked {
    Add(Light),
    Remove(usize),
}

impl Workbench {
    pub(super) fn lights(&mut self, ui: &mut Ui) {
        let Some(scene) = self.scene.loaded.clone() else {
            return;
        };
        let own = LightState::of(&scene);
        let mut now = self.desired.lights.clone().unwrap_or_else(|| own.clone());
        sky::light(ui, &mut now, scene.environment.as_ref());
        if self.sky_file(ui) {
            // These controls still show the light of the sky before.
            return;
        }
        let had_headlight = now.lights.iter().any(is_headlight);
        headlight(ui, &mut now.lights);
        let added = self.add_menu(ui, &now, &own);
        let selected = &mut self.tabs.surroundings.selected;
        let listed = rows(ui, &mut now.lights, &own.lights, selected);
        match added.or(listed) {
            Some(Asked::Add(light)) => {
                *selected = Some(light.name.clone());
                now.lights.push(light);
            }
            Some(Asked::Remove(i)) => {
                let removed = now.lights.remove(i);
                selected.take_if(|name| *name == removed.name);
            }
            None => {}
        }
        if had_headlight && !now.lights.iter().any(is_headlight) {
            // A headlight of the scene's own is removed like any light.
            now.without_headlight = !own.lights.iter().any(is_headlight);
        }
        let differs = now != own;
        let reset = egui::Button::new("reset lights");
        let reset = ui.add_enabled(differs, reset);
        let reset = reset.on_hover_text("Back to the scene's own lights and sky");
        self.desired.lights = (differs && !reset.clicked()).then_some(now);
    }

    fn add_menu(&self, ui: &mut Ui, now: &LightState, own: &LightState) -> Option<Asked> {
        let camera = self.desired.camera?;
        let lists = [now.lights.as_slice(), &own.lights];
        let menu = ui.menu_button("add light", |ui| {
            let mut added = None;
            for kind in &KINDS {
                if ui.button(kind.name.to_lowercase()).clicked() {
                    let light = new::new(kind, &lists, &camera, self.scene.diagonal);
                    added = Some(Asked::Add(light));
                    ui.close();
                }
            }
            added
        });
        menu.inner.flatten()
    }
}

fn is_headlight(light: &Light) -> bool {
    light.name == new::HEADLIGHT
}

/// A note about the headlight, if there is one.
fn headlight(ui: &mut Ui, lights: &mut Vec<Light>) {
    if !lights.iter().any(is_headlight) {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.label("No light reaches the first camera. A headlight was added there.");
        if ui.button("remove the headlight").clicked() {
            lights.retain(|light| !is_headlight(light));
        }
    });
}

/// A foldable row for each light.
fn rows(
    ui: &mut Ui,
    lights: &mut [Light],
    own: &[Light],
    selected: &mut Option<String>,
) -> Option<Asked> {
    let mut asked = None;
    let all = lights.to_vec();
    for (i, light) in lights.iter_mut().enumerate() {
        let id = ui.make_persistent_id(("light", light.name.as_str()));
        let few = i < 3;
        let state =
            egui::collapsing_header::CollapsingState::load_with_default_open(ui.ctx(), id, few);
        let header = state.show_header(ui, |ui| {
            let name = light.name.clone();
            let on = ui.checkbox(&mut light.on, "");
            let is_on = light.on;
            on.widget_info(|| {
                egui::WidgetInfo::selected(WidgetType::Checkbox, true, is_on, format!("{name} on"))
            });
            on.on_hover_text("Switch the light off and keep its settings");
            let is_selected = selected.as_ref() == Some(&name);
            let label = ui.selectable_label(is_selected, &name);
            if label.on_hover_text("Show handles on the picture").clicked() {
                *selected = (!is_selected).then(|| name.clone());
            }
            if icon(ui, COPY, "duplicate", &name) {
                asked = Some(Asked::Add(new::copy(light, &[&all, own])));
            }
            if icon(ui, TRASH, "remove", &name) {
                asked = Some(Asked::Remove(i));
            }
        });
        header.body(|ui| {
            ui.push_id(id, |ui| fields(ui, light));
        });
    }
    asked
}

/// A small button with an icon, named by its verb and the light.
fn icon(ui: &mut Ui, icon: &str, verb: &str, name: &str) -> bool {
    let button = ui.small_button(icon);
    let about = format!("{verb} {name}");
    named(&button, WidgetType::Button, &about);
    button.on_hover_text(about).clicked()
}
