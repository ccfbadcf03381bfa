//! Lights on the picture: an icon each, and handles of the selected one.

mod handles;
mod screen;

use crate::scene::{Camera, Light, LightKind};
use crate::workbench::Workbench;
use crate::workbench::desired::request::LightState;
use crate::workbench::panel::control::named;
use egui::{Align2, Color32, CursorIcon, FontId, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2};
use egui_phosphor::regular;
use glam::Vec3;
use handles::{AXES, Handle, centre, handles, outline};
use screen::Screen;

/// A drag of a handle.
pub(crate) struct Drag {
    handle: Handle,
    /// The light when the drag began.
    start: Light,
    /// Where the mouse was pressed.
    from: Pos2,
}

/// Size of a handle that the mouse can take, points.
const GRIP: f32 = 16.0;
const COLORS: [Color32; 3] = [
    Color32::from_rgb(255, 110, 100),
    Color32::from_rgb(120, 220, 110),
    Color32::from_rgb(120, 170, 255),
];

fn icon(light: &Light) -> &'static str {
    match light.kind {
        LightKind::Directional => regular::SUN,
        LightKind::Point => regular::LIGHTBULB,
        LightKind::Spot { .. } => regular::FLASHLIGHT,
        LightKind::Rectangle { .. } => regular::RECTANGLE,
        LightKind::Disc { .. } => regular::CIRCLE,
    }
}

impl Workbench {
    /// Icons of all lights and the handles of the selected one, if one is selected.
    pub(super) fn gizmo(&mut self, ui: &Ui, painter: &Painter, shown: Rect) {
        let Some(selected) = self.tabs.surroundings.selected.clone() else {
            return;
        };
        let (Some(camera), Some(scene)) = (self.shown_camera(), self.scene.loaded.clone()) else {
            return;
        };
        let own = LightState::of(&scene);
        let mut now = self.desired.lights.clone().unwrap_or_else(|| own.clone());
        if now.lights.iter().all(|light| light.name != selected) {
            return;
        }
        let screen = Screen::new(&camera, shown);
        let painter = painter.with_clip_rect(shown.intersect(painter.clip_rect()));
        let mut sun = camera.target;
        for light in &mut now.lights {
            let at = centre(light, sun);
            // Icons of lights without a position are in a row.
            if light.kind == LightKind::Directional {
                sun += 30.0 * screen.metres(sun) * screen.right;
            }
            if light.name == selected {
                outlines(&painter, &screen, light, at);
                self.handles(ui, &painter, (&screen, at), light);
            } else if let Some(place) = screen.project(at) {
                let grip = Rect::from_center_size(place, Vec2::splat(GRIP));
                let id = ui.id().with(("light icon", light.name.as_str()));
                let response = ui.interact(grip, id, Sense::click());
                named(
                    &response,
                    egui::WidgetType::Button,
                    &format!("light {}", light.name),
                );
                badge(&painter, place, icon(light), Color32::WHITE);
                if response.on_hover_text(&light.name).clicked() {
                    self.tabs.surroundings.selected = Some(light.name.clone());
                }
            }
        }
        self.desired.lights = (now != own).then_some(now);
    }

    /// The camera of the picture.
    fn shown_camera(&self) -> Option<Camera> {
        let camera = self.desired.camera?;
        let Some(path) = &self.desired.path else {
            return Some(camera);
        };
        let placed = path.at(self.shown_time());
        Some(Camera {
            eye: placed.eye.into(),
            target: placed.target.into(),
            up: placed.up.into(),
            fov_y: placed.fov_y,
            ..camera
        })
    }

    fn handles(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        (screen, at): (&Screen, Vec3),
        light: &mut Light,
    ) {
        let shown = light.clone();
        for handle in handles(&shown) {
            let Some(place) = screen.project(handle.place(&shown, screen, at)) else {
                continue;
            };
            let name = format!("{} {}", handle.name(), light.name);
            let grip = Rect::from_center_size(place, Vec2::splat(GRIP));
            let response = ui.interact(grip, ui.id().with(&name), Sense::drag());
            named(&response, egui::WidgetType::Other, &name);
            let color = match handle {
                Handle::Axis(i) => COLORS[i],
                _ => Color32::from_rgb(255, 214, 90),
            };
            match handle {
                Handle::Centre => badge(painter, place, icon(light), color),
                _ => _ = painter.circle_filled(place, 5.0, color),
            }
            if response.drag_started() {
                let from = ui.input(|i| i.pointer.press_origin()).unwrap_or(place);
                let start = shown.clone();
                self.view.drag = Some(Drag {
                    handle,
                    start,
                    from,
                });
            }
            let drag = self.view.drag.as_ref().filter(|d| d.handle == handle);
            if let (Some(drag), Some(to)) = (drag, response.interact_pointer_pos())
                && (response.dragged() || response.drag_stopped())
                && let Some(moved) = handle.dragged(&drag.start, screen, at, (drag.from, to))
            {
                *light = moved;
            }
            if response.drag_stopped() {
                self.view.drag = None;
            }
            response
                .on_hover_cursor(CursorIcon::Grab)
                .on_hover_text(name);
        }
    }
}

/// Axes, the arrow of the direction, and the edge of a light.
fn outlines(painter: &Painter, screen: &Screen, light: &Light, at: Vec3) {
    let line = |from: Vec3, to: Vec3, color: Color32| {
        if let (Some(from), Some(to)) = (screen.project(from), screen.project(to)) {
            painter.line_segment([from, to], Stroke::new(4.0, Color32::from_black_alpha(160)));
            painter.line_segment([from, to], Stroke::new(2.0, color));
        }
    };
    let yellow = Color32::from_rgb(255, 214, 90);
    for handle in handles(light) {
        let end = handle.place(light, screen, at);
        match handle {
            Handle::Axis(i) => line(at, end, COLORS[i % AXES.len()]),
            Handle::Direction => line(at, end, yellow),
            Handle::Centre | Handle::Extent(..) => {}
        }
    }
    for edge in outline(light, screen, at).windows(2) {
        line(edge[0], edge[1], yellow);
    }
}

/// An icon on a dark disc, which stands out on any picture.
fn badge(painter: &Painter, at: Pos2, icon: &str, color: Color32) {
    painter.circle_filled(at, 12.0, Color32::from_black_alpha(200));
    painter.text(
        at,
        Align2::CENTER_CENTER,
        icon,
        FontId::proportional(16.0),
        color,
    );
}
