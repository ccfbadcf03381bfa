//! Camera, lights, sky and time.

use super::Tab;
use super::bookmarks::Bookmarks;
use crate::lab::Viewpoint;
use crate::scene::Light;
use crate::scene::light::Quantity;
use crate::workbench::desired::request::LightState;
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
    /// Text of the field for the sky's picture, and the scene and the picture that it was set from.
    picture: (String, [String; 2]),
    pub(super) bookmarks: Bookmarks,
}

impl Default for Surroundings {
    fn default() -> Self {
        Surroundings {
            steering: motion::Mode::Orbit,
            speed: 1.0,
            picture: Default::default(),
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

const RGB: [&str; 3] = ["red", "green", "blue"];

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
            ui.checkbox(&mut fixed, "fixed step")
                .on_hover_text("The same time from frame to frame, however long it takes");
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

    fn lights(&mut self, ui: &mut Ui) {
        let Some(scene) = self.scene.loaded.clone() else {
            return;
        };
        let own = LightState::of(&scene);
        let mut now = self.desired.lights.clone().unwrap_or_else(|| own.clone());
        let LightState {
            lights,
            sky,
            rotation,
        } = &mut now;
        ui.horizontal(|ui| {
            for (x, c) in [&mut sky.x, &mut sky.y, &mut sky.z].into_iter().zip(RGB) {
                spin(
                    ui,
                    DragValue::new(x).range(0.0..=1e6).speed(0.01),
                    &format!("sky {c}"),
                );
            }
            match scene.environment {
                None => ui
                    .label("sky radiance")
                    .on_hover_text("Linear RGB, W/(m² sr)"),
                Some(_) => ui.label("sky tint").on_hover_text("Multiplies the HDRI"),
            };
        });
        if let Some(environment) = &scene.environment {
            ui.label(format!("HDRI: {}", environment.name()));
            ui.add(
                egui::Slider::new(rotation, 0.0..=360.0)
                    .suffix(" deg")
                    .text("rotation"),
            );
            intensity(ui, sky);
        }
        if self.picture_file(ui) {
            // These controls still show the light of the sky before.
            return;
        }
        for (i, light) in lights.iter_mut().enumerate() {
            let name = if light.name.is_empty() {
                format!("light {}", i + 1)
            } else {
                light.name.clone()
            };
            egui::CollapsingHeader::new(name)
                .id_salt(("light", i))
                .default_open(i < 3)
                .show(ui, |ui| one(ui, light));
        }
        let differs = now != own;
        if ui
            .add_enabled(differs, egui::Button::new("reset lights"))
            .clicked()
        {
            self.desired.lights = None;
        } else {
            self.desired.lights = differs.then_some(now);
        }
    }

    /// A field for the file of another sky. Returns true if one was requested; the light must not
    /// be edited then.
    fn picture_file(&mut self, ui: &mut Ui) -> bool {
        let shown = [&self.desired.scene, &self.desired.environment].map(String::clone);
        let (text, of) = &mut self.tabs.surroundings.picture;
        if *of != shown {
            (*text, *of) = (shown[1].clone(), shown);
        }
        let asked = ui.horizontal(|ui| {
            let field = egui::TextEdit::singleline(text).hint_text("path to .hdr or .exr");
            let field = ui.add(field.desired_width(180.0));
            crate::workbench::panel::control::named(
                &field,
                egui::WidgetType::TextEdit,
                "picture of the sky",
            );
            let done = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let load = ui
                .button("load")
                .on_hover_text("Load an HDRI as the sky. Empty: the scene's own");
            (load.clicked() || done).then(|| text.trim().to_string())
        });
        let asked = asked.inner.filter(|file| *file != self.desired.environment);
        let Some(file) = asked else { return false };
        if self.missing_scene().is_none() {
            self.scene.before = Some(self.state());
        }
        self.desired.environment = file;
        self.desired.lights = None;
        true
    }
}

/// One factor for all of the sky's colours.
fn intensity(ui: &mut Ui, sky: &mut Vec3) {
    let before = sky.max_element();
    let mut now = before;
    ui.horizontal(|ui| {
        spin(
            ui,
            DragValue::new(&mut now).range(0.0..=1e6).speed(0.01),
            "sky intensity",
        );
        ui.label("intensity");
    });
    if now != before {
        *sky = if before > 0.0 {
            *sky * (now / before)
        } else {
            Vec3::splat(now)
        };
    }
}

/// Controls of all fields of a light.
fn one(ui: &mut Ui, light: &mut Light) {
    let fields = light.fields();
    for (field, _) in fields.vectors() {
        let meaning = light.kind.row().color;
        let Some(v) = light.vector(field.name) else {
            continue;
        };
        match field.quantity {
            Quantity::Color => color(ui, v, meaning),
            Quantity::Direction => direction(ui, v, field.name),
            _ => metres(ui, "position, m", v),
        }
    }
    for &(field, mut x) in fields.numbers() {
        let before = x;
        let slider = egui::Slider::new(&mut x, field.range())
            .suffix(format!(" {}", field.quantity.unit()))
            .logarithmic(field.quantity == Quantity::Length)
            .text(match field.name {
                "inner" => "inner cone angle",
                "outer" => "outer cone angle",
                name => name,
            });
        ui.add(slider);
        if x != before {
            light.set_number(field, x);
            light.keep_in_order();
        }
    }
}

fn color(ui: &mut Ui, v: &mut Vec3, meaning: &str) {
    ui.horizontal(|ui| {
        for (x, c) in v.as_mut().iter_mut().zip(RGB) {
            let spinner = DragValue::new(x).range(0.0..=1e7).speed(0.02);
            spin(ui, spinner, &format!("light {c}"));
        }
        ui.label(meaning).on_hover_text(
            "Linear RGB; W/m² on a facing surface for a sun, W/sr for points and spots, W/(m² sr) for areas",
        );
    });
}

/// As angles: easier to set than three numbers of a unit vector.
fn direction(ui: &mut Ui, d: &mut Vec3, name: &str) {
    let of = if name == "direction" {
        String::new()
    } else {
        format!("{name}: ")
    };
    let (mut azimuth, mut elevation) = (
        d.z.atan2(d.x).to_degrees(),
        (-d.y).clamp(-1.0, 1.0).asin().to_degrees(),
    );
    let before = (azimuth, elevation);
    let slider = |x, range, name| {
        egui::Slider::new(x, range)
            .suffix(" deg")
            .text(format!("{of}{name}"))
    };
    ui.add(slider(&mut azimuth, -180.0..=180.0, "azimuth"));
    ui.add(slider(&mut elevation, -90.0..=90.0, "elevation"));
    if (azimuth, elevation) != before {
        let (a, e) = (azimuth.to_radians(), elevation.to_radians());
        *d = Vec3::new(e.cos() * a.cos(), -e.sin(), e.cos() * a.sin());
    }
}
