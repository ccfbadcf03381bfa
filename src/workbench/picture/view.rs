//! The picture in the viewport: A, B, or both, and its mouse controls.

use super::compare::{MODES, Mode};
use super::gizmo::Drag;
use super::motion;
use super::zoom::{Zoom, foot, pixel_at, pixel_text};
use crate::results::timers::Rows;
use crate::workbench::panel::control::spin;
use crate::workbench::{COMPARISON, Workbench, theme};
use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, TextureId, Ui, Vec2};

/// State of the viewport.
pub struct View {
    /// How A and B are shown.
    pub mode: Mode,
    /// Where the line between A and B stands, 0 to 1.
    pub split: f32,
    /// Whether B is shown when flipping.
    pub flipped: bool,
    /// The times that are on the picture.
    pub timers: Rows,
    /// Multiplies the absolute difference.
    pub gain: u32,
    dragging_split: bool,
    /// Zoom and pan on the screen.
    pub zoom: Zoom,
    /// Keys that move the camera.
    held: motion::Held,
    /// Where picture A is, in points.
    pub place: Option<Rect>,
    /// The drag of a light's handle.
    pub(super) drag: Option<Drag>,
}

impl Default for View {
    fn default() -> Self {
        View {
            mode: Mode::Split,
            split: 0.5,
            flipped: false,
            timers: Rows::None,
            gain: 8,
            dragging_split: false,
            zoom: Zoom::default(),
            place: None,
            held: motion::Held::default(),
            drag: None,
        }
    }
}

const WHOLE: Rect = Rect {
    min: Pos2::ZERO,
    max: Pos2 { x: 1.0, y: 1.0 },
};

/// The largest rectangle of the picture's shape, never enlarged by less than whole pixels when it
/// is small.
pub fn fit(area: Rect, size: [u32; 2], scale: f32) -> Rect {
    let size = Vec2::new(size[0].max(1) as f32, size[1].max(1) as f32) / scale;
    let factor = (area.width() / size.x).min(area.height() / size.y);
    let factor = if factor >= 1.0 {
        factor.floor().min(16.0)
    } else {
        factor
    };
    let place = Rect::from_center_size(area.center(), size * factor);
    // On whole pixels of the screen: texels of the picture must not fall between them.
    let whole = (place.min.to_vec2() * scale).round() / scale;
    Rect::from_min_size(whole.to_pos2(), place.size())
}

impl Workbench {
    /// The mode of comparison and its controls.
    pub(crate) fn compare_bar(&mut self, ui: &mut Ui) {
        for (mode, name) in MODES {
            ui.selectable_value(&mut self.view.mode, mode, name);
        }
        match self.view.mode {
            Mode::Flip => {
                let name = if self.view.flipped {
                    "showing B (press X)"
                } else {
                    "showing A (press X)"
                };
                if ui.button(name).clicked() {
                    self.view.flipped = !self.view.flipped;
                }
            }
            Mode::Difference => {
                spin(
                    ui,
                    egui::DragValue::new(&mut self.view.gain)
                        .range(1..=255)
                        .prefix("x "),
                    "gain",
                );
            }
            _ => {}
        }
        let about = "Saves the compared pictures in captures/";
        if ui
            .small_button("save picture")
            .on_hover_text(about)
            .clicked()
        {
            self.save_comparison();
        }
    }

    /// Shows the picture and steers the camera.
    pub(crate) fn picture(&mut self, ui: &mut Ui, textures: &[TextureId]) {
        ui.input(|i| self.view.held.update(&i.events));
        let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::click_and_drag());
        let area = response.rect;
        // Another ground than a picture's black: its edge is seen.
        let roles = theme::roles(ui);
        painter.rect_filled(area, 0.0, roles.ground);
        let scale = ui.ctx().pixels_per_point();
        self.layout.area = [
            (area.width() * scale) as u32,
            (area.height() * scale) as u32,
        ];
        let Some(size) = self.sides[0].picture.as_ref().map(|p| p.size) else {
            painter.text(
                area.center(),
                Align2::CENTER_CENTER,
                self.waiting_text(),
                FontId::proportional(16.0),
                roles.text,
            );
            return;
        };
        let both = self.desired.sides[1].is_some() && self.sides[1].picture.is_some();
        let canvas = Canvas {
            painter: &painter,
            textures,
            area,
            zoom: self.view.zoom,
            size,
            scale,
        };
        let [shown, b] = self.draw_pictures(&canvas, both);
        if self.stale() {
            let stroke = Stroke::new(2.0, roles.error);
            painter.rect_stroke(shown, 0.0, stroke, egui::StrokeKind::Inside);
        }
        let b = both.then_some(b.intersect(area));
        self.timers(&painter, shown.intersect(area), b);
        self.view.place = Some(shown);
        self.read_out(&painter, &response, shown, both);
        self.mouse(ui, &response, shown, size, both);
        self.gizmo(ui, &painter, shown);
    }

    /// Draws the pictures in the mode of comparison. Returns the places of A and B.
    fn draw_pictures(&self, canvas: &Canvas<'_>, both: bool) -> [Rect; 2] {
        let area = canvas.area;
        let shown = canvas.fit(area);
        if !both {
            canvas.draw(0, shown, area);
            return [shown; 2];
        }
        let [a, b] = self.sides_in_words();
        let names = [format!("A  {a}"), format!("B  {b}")].map(|n| n.trim_end().to_string());
        match self.view.mode {
            Mode::Split => {
                let x = shown.left() + shown.width() * self.view.split;
                let (left, right) = area.split_left_right_at_x(x);
                canvas.draw(0, shown, left);
                canvas.draw(1, shown, right);
                let painter = canvas.painter;
                painter.vline(x, shown.y_range(), Stroke::new(1.5, Color32::WHITE));
                let [left, right] = [x - 4.0, x + 4.0].map(|x| Pos2::new(x, shown.top() + 4.0));
                badge(painter, left, Align2::RIGHT_TOP, &names[0]);
                badge(painter, right, Align2::LEFT_TOP, &names[1]);
            }
            Mode::Flip => {
                let number = usize::from(self.view.flipped);
                canvas.draw_named(number, shown, area, &names);
            }
            Mode::Side => {
                let (left, right) = area.split_left_right_at_fraction(0.5);
                let places = [canvas.fit(left), canvas.fit(right)];
                canvas.draw_named(0, places[0], left, &names);
                canvas.draw_named(1, places[1], right, &names);
                return places;
            }
            Mode::Difference | Mode::Perceived => {
                let made = self.comparison.shown.as_ref();
                let is_made = made.is_some_and(|(mode, _)| *mode == self.view.mode);
                canvas.draw(if is_made { COMPARISON } else { 0 }, shown, area);
            }
        }
        [shown; 2]
    }

    /// The pixel under the pointer: of B where B is shown.
    fn read_out(
        &self,
        painter: &egui::Painter,
        response: &egui::Response,
        shown: Rect,
        both: bool,
    ) {
        let Some(at) = response.hover_pos().filter(|p| shown.contains(*p)) else {
            return;
        };
        let line = shown.left() + shown.width() * self.view.split;
        let second = both
            && match self.view.mode {
                Mode::Split => at.x > line,
                Mode::Flip => self.view.flipped,
                _ => false,
            };
        let Some(picture) = &self.sides[usize::from(second)].picture else {
            return;
        };
        if let Some(text) = pixel_text(picture, pixel_at(shown, picture.size, at)) {
            foot(
                painter,
                response.rect,
                format!("{} {text}", ["A", "B"][usize::from(second)]),
            );
        }
    }

    fn mouse(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        shown: Rect,
        size: [u32; 2],
        both: bool,
    ) {
        let splitting = both && self.view.mode == Mode::Split;
        let line = shown.left() + shown.width() * self.view.split;
        let pointer = response.interact_pointer_pos().or(response.hover_pos());
        let near = splitting && pointer.is_some_and(|p| (p.x - line).abs() < 6.0);
        if near || self.view.dragging_split {
            ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
        }
        if response.drag_started() {
            let from = ui.input(|i| i.pointer.press_origin());
            self.view.dragging_split = splitting && from.is_some_and(|p| (p.x - line).abs() < 8.0);
        }
        if response.drag_stopped() {
            self.view.dragging_split = false;
        }
        if self.view.dragging_split {
            if let Some(p) = pointer {
                self.view.split = ((p.x - shown.left()) / shown.width().max(1.0)).clamp(0.0, 1.0);
            }
            return;
        }
        if self.view.zoom.steer(ui, response, shown) {
            return;
        }
        if response.clicked()
            && let Some(p) = response
                .interact_pointer_pos()
                .filter(|p| shown.contains(*p))
        {
            self.point_at(Some(pixel_at(shown, size, p)));
        }
        if let Some(camera) = &mut self.desired.camera {
            motion::steer(
                ui,
                response,
                camera,
                self.tabs.surroundings.steering,
                self.scene.diagonal,
                self.tabs.surroundings.speed,
                &self.view.held,
            );
        }
    }
}

/// The viewport that pictures of a size are drawn in.
struct Canvas<'a> {
    painter: &'a egui::Painter,
    textures: &'a [TextureId],
    area: Rect,
    zoom: Zoom,
    size: [u32; 2],
    /// Pixels a point.
    scale: f32,
}

impl Canvas<'_> {
    fn fit(&self, area: Rect) -> Rect {
        let place = fit(area, self.size, self.scale);
        self.zoom.place(place, self.size[0], self.scale)
    }

    fn draw(&self, number: usize, rect: Rect, clip: Rect) {
        let painter = self.painter.with_clip_rect(clip.intersect(self.area));
        painter.image(self.textures[number], rect, WHOLE, Color32::WHITE);
    }

    /// Draws a picture with its name at the foot: its times are at the top.
    fn draw_named(&self, number: usize, rect: Rect, clip: Rect, names: &[String; 2]) {
        self.draw(number, rect, clip);
        let corner = rect.intersect(clip).right_bottom() - Vec2::splat(4.0);
        badge(self.painter, corner, Align2::RIGHT_BOTTOM, &names[number]);
    }
}

fn badge(painter: &egui::Painter, at: Pos2, anchor: Align2, text: &str) {
    let galley =
        painter.layout_no_wrap(text.to_string(), FontId::proportional(13.0), Color32::WHITE);
    let rect = anchor.anchor_size(at, galley.size() + Vec2::new(8.0, 2.0));
    painter.rect_filled(rect, 3.0, Color32::from_black_alpha(225));
    painter.galley(rect.min + Vec2::new(4.0, 1.0), galley, Color32::WHITE);
}
