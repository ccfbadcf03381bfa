//! The sky: its radiance or HDRI.

use super::colour::colour;
use crate::scene::Environment;
use crate::workbench::Workbench;
use crate::workbench::desired::request::LightState;
use crate::workbench::panel::control::named;
use egui::{Ui, WidgetType};

/// Colour, intensity and rotation of the sky.
pub(super) fn light(ui: &mut Ui, now: &mut LightState, environment: Option<&Environment>) {
    match environment {
        None => colour(ui, &mut now.sky, "sky", "sky radiance", "W/(m² sr)"),
        Some(environment) => {
            ui.label(format!("HDRI: {}", environment.name()));
            colour(ui, &mut now.sky, "sky", "sky tint", "factor of the HDRI");
            let rotation = egui::Slider::new(&mut now.rotation, 0.0..=360.0);
            ui.add(rotation.suffix(" deg").text("rotation"));
        }
    }
}

impl Workbench {
    /// A field and a dialog for another HDRI. Returns true if one was requested; the light must not
    /// be edited then.
    pub(super) fn sky_file(&mut self, ui: &mut Ui) -> bool {
        // A path that could not be loaded stays in the field.
        let loaded = self.scene.source.clone().unwrap_or_default();
        let (text, of) = &mut self.tabs.surroundings.picture;
        if *of != loaded {
            text.clone_from(&loaded.1);
            *of = loaded;
        }
        let asked = ui.horizontal(|ui| {
            let field = egui::TextEdit::singleline(text).hint_text("path to .hdr or .exr");
            let field = ui.add(field.desired_width(150.0));
            named(&field, WidgetType::TextEdit, "picture of the sky");
            let done = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let load = ui
                .button("load")
                .on_hover_text("Load an HDRI as the sky. Empty: the scene's own");
            if ui.button("browse...").clicked() {
                self.scene.models.ask_sky();
            }
            (load.clicked() || done).then(|| text.trim().to_string())
        });
        let picked = self.scene.models.picked_sky(ui);
        let picked = picked.map(|path| path.to_string_lossy().into_owned());
        let asked = picked.or(asked.inner);
        let Some(file) = asked.filter(|file| *file != self.desired.environment) else {
            return false;
        };
        self.tabs.surroundings.picture.0.clone_from(&file);
        if self.missing_scene().is_none() {
            self.scene.before = Some(self.state());
        }
        self.desired.environment = file;
        self.desired.lights = None;
        true
    }
}
