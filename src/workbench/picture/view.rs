//! The picture in the viewport: A, B, or both, and its mouse controls.

use super::compare::{MODES, Mode};
use super::motion;
use super::zoom::{Zoom, foot, pixel_at, pixel_text};
use crate::results::timers::Rows;
use crate::workbench::panel::control::spin;
use crate::workbench::{COMPARISON, Workbench};
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
    /// Where picture A is, in points.
    pub place: Option<Rect>,
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
        }
    }
}

/// Colour around the picture.
const GROUND: Color32 = Color32::from_gray(38);

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
        if let Some(text) = self.comparison_text() {
            ui.label(text);
        }
        let about = "The pictures as they are compared here, into captures/";
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
        let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::click_and_drag());
        let area = response.rect;
        // Another ground than a picture's black: its edge is seen.
        painter.rect_filled(area, 0.0, GROUND);
        let scale = ui.ctx().pixels_per_point();
        self.layout.area = [
            (area.width() * scale) as u32,
            (area.height() * scale) as u32,
        ];
        let Some(a) = self.sides[0].picture.as_ref().map(|p| p.size) else {
            painter.text(
                area.center(),
                Align2::CENTER_CENTER,
                self.waiting_text(),
                FontId::proportional(16.0),
                Color32::GRAY,
            );
            return;
        };
        let both = self.desired.sides[1].is_some() && self.sides[1].picture.is_some();
        let zoom = self.view.zoom;
        let fit = |area: Rect| zoom.place(fit(area, a, scale), a[0], scale);
        let mut shown = fit(area);
        let draw = |number: usize, rect: Rect, clip: Rect| {
            painter.with_clip_rect(clip.intersect(area)).image(
                textures[number],
                rect,
                WHOLE,
                Color32::WHITE,
            );
        };
        let [a_differs, b_differs] = self.sides_in_words();
        let names = [format!("A  {a_differs}"), format!("B  {b_differs}")]
            .map(|n| n.trim_end().to_string());
        match self.view.mode {
            _ if !both => draw(0, shown, area),
            Mode::Split => {
                let x = shown.left() + shown.width() * self.view.split;
                draw(
                    0,
                    shown,
                    Rect::from_min_max(area.min, Pos2::new(x, area.max.y)),
                );
                draw(
                    1,
                    shown,
                    Rect::from_min_max(Pos2::new(x, area.min.y), area.max),
                );
                painter.vline(x, shown.y_range(), Stroke::new(1.5, Color32::WHITE));
                badge(
                    &painter,
                    Pos2::new(x - 4.0, shown.top() + 4.0),
                    Align2::RIGHT_TOP,
                    &names[0],
                );
                badge(
                    &painter,
                    Pos2::new(x + 4.0, shown.top() + 4.0),
                    Align2::LEFT_TOP,
                    &names[1],
                );
            }
            Mode::Flip => {
                draw(usize::from(self.view.flipped), shown, area);
                badge(
                    &painter,
                    corner(shown.intersect(area)),
                    Align2::RIGHT_BOTTOM,
                    &names[usize::from(self.view.flipped)],
                );
            }
            Mode::Side => {
                let (left, right) = area.split_left_right_at_fraction(0.5);
                shown = fit(left);
                draw(0, shown, left);
                draw(1, fit(right), right);
                badge(
                    &painter,
                    corner(shown.intersect(left)),
                    Align2::RIGHT_BOTTOM,
                    &names[0],
                );
                badge(
                    &painter,
                    corner(fit(right).intersect(right)),
                    Align2::RIGHT_BOTTOM,
                    &names[1],
                );
            }
            Mode::Difference | Mode::Perceived => {
                if self
                    .comparison
                    .shown
                    .as_ref()
                    .is_some_and(|(mode, _)| *mode == self.view.mode)
                {
                    draw(COMPARISON, shown, area);
                } else {
                    draw(0, shown, area);
                }
            }
        }
        if self.stale() {
            painter.rect_stroke(
                shown,
                0.0,
                Stroke::new(2.0, Color32::from_rgb(220, 80, 60)),
                egui::StrokeKind::Inside,
            );
        }
        if let Some(what) = self.pending(ui.ctx()) {
            let foot = area.intersect(shown).center_bottom() - Vec2::new(0.0, 6.0);
            badge(&painter, foot, Align2::CENTER_BOTTOM, &what);
        }
        let b = match self.view.mode {
            Mode::Side => fit(area.split_left_right_at_fraction(0.5).1),
            _ => shown,
        };
        self.timers(
            &painter,
            shown.intersect(area),
            both.then_some(b.intersect(area)),
        );
        self.view.place = Some(shown);
        self.read_out(&painter, &response, shown, both);
        self.mouse(ui, &response, shown, a, both);
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
            self.show_tables();
        }
        if let Some(camera) = &mut self.desired.camera {
            motion::steer(
                ui,
                response,
                camera,
                self.tabs.surroundings.steering,
                self.scene.diagonal,
                self.tabs.surroundings.speed,
            );
        }
    }
}

/// Where a picture's name is: its times are at the top.
fn corner(picture: Rect) -> Pos2 {
    picture.right_bottom() - Vec2::splat(4.0)
}

fn badge(painter: &egui::Painter, at: Pos2, anchor: Align2, text: &str) {
    let galley =
        painter.layout_no_wrap(text.to_string(), FontId::proportional(12.0), Color32::WHITE);
    let rect = anchor.anchor_size(at, galley.size() + Vec2::new(8.0, 2.0));
    painter.rect_filled(rect, 3.0, Color32::from_black_alpha(160));
    painter.galley(rect.min + Vec2::new(4.0, 1.0), galley, Color32::WHITE);
}
