//! Camera, lights, sky and time.

mod colour;
mod light;
mod lights;
mod sky;

use super::Tab;
use super::bookmarks::Bookmarks;
use crate::lab::Viewpoint;
use crate::workbench::panel::control::spin;
use crate::workbench::picture::motion;
use crate::workbench::{Workbench, theme};
use egui::{DragValue, RichText, TextureId, Ui};
use glam::Vec3;

/// State of this tab.
pub(crate) struct Surroundings {
    /// The effect of the mouse on the camera.
    pub(crate) steering: motion::Mode,
    /// Speed of keys, 1 crosses the scene in ten seconds.
    pub(crate) speed: f32,
    /// Text of the field for the HDRI, and the scene and the HDRI that it was set from.
    picture: (String, (String, String)),
    /// Name of the light with handles on the picture.
    pub(crate) selected: Option<String>,
    pub(super) bookmarks: Bookmarks,
}

impl Default for Surroundings {
    fn default() -> Self {
        Surroundings {
            steering: motion::Mode::Orbit,
            speed: 1.0,
            picture: Default::default(),
            selected: None,
            bookmarks: Bookmarks::default(),
        }
    }
}

impl Tab for Surroundings {
    const TITLE: &'static str = "Scene";
    const ICON: &'static str = egui_phosphor::regular::SUN;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.surroundings(ui);
    }
}

fn metres(ui: &mut Ui, label: &str, v: &mut Vec3) {
    ui.horizontal(|ui| {
        for (x, axis) in [&mut v.x, &mut v.y, &mut v.z]
            .into_iter()
            .zip(["x", "y", "z"])
        {
            spin(
                ui,
                DragValue::new(x).speed(0.02).max_decimals(3),
                &format!("{label} {axis}"),
            );
        }
        ui.label(label);
    });
}

impl Workbench {
    fn surroundings(&mut self, ui: &mut Ui) {
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| {
                let warnings = self.scene_warnings();
                if !warnings.is_empty() {
                    let title = RichText::new(format!("Warnings ({})", warnings.len()))
                        .color(ui.visuals().warn_fg_color);
                    egui::CollapsingHeader::new(title)
                        .id_salt("warnings")
                        .default_open(true)
                        .show(ui, |ui| {
                            for warning in &warnings {
                                ui.label(warning);
                            }
                        });
                    ui.separator();
                }
                ui.label(theme::title("Camera"));
                self.camera(ui);
                ui.separator();
                ui.label(theme::title("Time"));
                self.time(ui);
                ui.separator();
                ui.label(theme::title("Lights and sky"));
                self.lights(ui);
            });
    }

    fn camera(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.selectable_value(
                &mut self.tabs.surroundings.steering,
                motion::Mode::Orbit,
                "orbit",
            )
            .on_hover_text("Drag to orbit the target; use the wheel to zoom");
            ui.selectable_value(
                &mut self.tabs.surroundings.steering,
                motion::Mode::Fly,
                "fly",
            )
            .on_hover_text("Drag to look around; W A S D Q E move");
            let speed = DragValue::new(&mut self.tabs.surroundings.speed)
                .range(0.01..=100.0)
                .speed(0.05)
                .prefix("speed x ");
            spin(ui, speed, "speed");
        });
        let names: Vec<String> = self
            .scene
            .loaded
            .as_ref()
            .map_or(Vec::new(), |s| s.cameras.keys().cloned().collect());
        if let Some(scene) = self.scene.loaded.clone() {
            ui.horizontal_wrapped(|ui| {
                ui.label("cameras:");
                for name in &names {
                    if ui.small_button(name).clicked() {
                        self.desired.camera = scene.cameras.get(name).copied();
                    }
                }
                if ui.small_button("frame all").clicked() {
                    self.desired.camera = Some(Viewpoint::around(&scene).camera);
                }
            });
        }
        self.bookmark_rows(ui);
        if let Some(camera) = &mut self.desired.camera {
            metres(ui, "eye, m", &mut camera.eye);
            metres(ui, "target, m", &mut camera.target);
            ui.add(
                egui::Slider::new(&mut camera.fov_y, 5.0..=150.0)
                    .suffix(" deg")
                    .text("field of view"),
            );
        }
    }

    fn time(&mut self, ui: &mut Ui) {
        let clock = &mut self.desired.clock;
        ui.horizontal(|ui| {
            let name = if clock.playing { "pause" } else { "play" };
            if ui.button(name).on_hover_text("Space").clicked() {
                clock.playing = !clock.playing;
            }
            if ui.button("step").on_hover_text("One frame (.)").clicked() {
                clock.playing = false;
                clock.steps += 1;
            }
            if ui.button("rewind").clicked() {
                clock.at = 0.0;
                clock.jumps += 1;
            }
            ui.label(format!(
                "{:.3} s",
                self.sides[0].picture.as_ref().map_or(0.0, |p| p.time)
            ));
        });
        ui.horizontal(|ui| {
            let mut fixed = clock.step.is_some();
            ui.checkbox(&mut fixed, "fixed step").on_hover_text(
                "Advances the time by this step in every frame, however long a frame takes",
            );
            clock.step = match (fixed, clock.step) {
                (true, step) => Some(step.unwrap_or(1.0 / 60.0)),
                (false, _) => None,
            };
            if let Some(step) = &mut clock.step {
                spin(
                    ui,
                    DragValue::new(step)
                        .range(0.0001..=10.0)
                        .speed(0.001)
                        .suffix(" s"),
                    "step",
                );
            }
        });
    }
}
