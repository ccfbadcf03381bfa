//! The inspected texture in the viewport: nearest texels, whole steps of size, values under the
//! pointer.

use super::{INSPECTOR, Workbench, image, parts, strip};
use crate::workbench::picture::view;
use crate::workbench::theme;
use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, TextureId, Ui, Vec2};

/// Pan and zoom over the texture.
#[derive(Default)]
pub struct PanZoom {
    /// Pixels of the screen a texel; as large as fits when absent.
    zoom: Option<f32>,
    /// Texel at the centre of the viewport, from the texture's centre.
    centre: Vec2,
}

impl PanZoom {
    /// The place of a texture of this size [texels]. `fitting`: the zoom at which all is seen.
    fn place(&self, area: Rect, size: Vec2, fitting: f32, scale: f32) -> Rect {
        let texel = self.zoom.unwrap_or(fitting) / scale;
        let min = area.center() - (size / 2.0 + self.centre) * texel;
        // On whole pixels of the screen.
        let min = (min.to_vec2() * scale).round() / scale;
        Rect::from_min_size(min.to_pos2(), size * texel)
    }

    fn steer(&mut self, ui: &Ui, response: &egui::Response, size: Vec2, fitting: f32) {
        let (area, scale) = (response.rect, ui.ctx().pixels_per_point());
        if response.double_clicked() {
            *self = PanZoom::default();
        }
        let pointer = response.hover_pos();
        let wheel = match pointer {
            Some(_) => ui.input(|i| i.smooth_scroll_delta().y),
            None => 0.0,
        };
        let notch = notch(ui, wheel);
        if let Some(at) = pointer.filter(|_| notch != 0) {
            let old = self.place(area, size, fitting, scale);
            let under = (at - old.min) / old.size() * size;
            let zoom = step(self.zoom.unwrap_or(fitting), notch > 0);
            self.zoom = Some(zoom);
            // The texel under the pointer stays there.
            self.centre = under - size / 2.0 - (at - area.center()) * scale / zoom;
        }
        if response.dragged() {
            let zoom = *self.zoom.get_or_insert(fitting);
            self.centre -= response.drag_delta() * scale / zoom;
        }
        self.centre = self.centre.clamp(-size / 2.0, size / 2.0);
    }
}

/// Steps of size. Whole texels or whole pixels, so that no texel looks wider than another.
const STEPS: [f32; 14] = [
    0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 32.0, 64.0,
];

/// The next step of size up or down.
fn step(zoom: f32, up: bool) -> f32 {
    let next = if up {
        STEPS.iter().find(|s| **s > zoom * 1.001)
    } else {
        STEPS.iter().rfind(|s| **s < zoom * 0.999)
    };
    next.copied().unwrap_or(zoom)
}

impl Workbench {
    /// Shows the texels: the wheel changes the size, drags move, a double click shows all.
    pub(crate) fn inspected(&mut self, ui: &mut Ui, textures: &[TextureId]) {
        let side = self.tabs.inspector.target.side.min(1);
        let mut size = ui.available_size();
        let info = self.sides[side].info.clone();
        if let Some(info) = &info {
            self.choose_first(info);
        }
        let strip = info.filter(|_| self.tabs.inspector.strip.is_shown());
        if strip.is_some() {
            size.y -= strip::HEIGHT;
        }
        let (response, painter) = ui.allocate_painter(size, Sense::click_and_drag());
        if let Some(info) = strip {
            let corner = response.rect.left_bottom();
            let row = Rect::from_min_size(corner, Vec2::new(size.x, strip::HEIGHT));
            let builder = egui::UiBuilder::new().max_rect(row.shrink(4.0));
            ui.scope_builder(builder, |ui| self.texture_strip(ui, &info));
        }
        let area = response.rect;
        let scale = ui.ctx().pixels_per_point();
        self.read_texture();
        painter.rect_filled(area, 0.0, theme::roles(ui).ground);
        let Some(done) = &self.tabs.inspector.shown else {
            return;
        };
        let size = Vec2::new(
            done.decoded.size[0].max(1) as f32,
            done.decoded.size[1].max(1) as f32,
        );
        let fitting = view::fit(area, done.decoded.size, scale).width() * scale / size.x;
        let pan_zoom = &mut self.tabs.inspector.pan_zoom;
        pan_zoom.steer(ui, &response, size, fitting);
        let shown = pan_zoom.place(area, size, fitting, scale);
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        if let Some(texture) = textures.get(INSPECTOR) {
            painter.image(*texture, shown, whole, Color32::WHITE);
        }
        let texel = shown.width() / size.x;
        self.under_pointer(&painter, response.hover_pos(), shown, texel);
        // The shown texture, because the requested one may follow.
        let target = &done.decoded.target;
        let mut name = format!(
            "{} {}  mip {}  × {:.3}",
            ["A", "B"][target.side.min(1)],
            target.texture,
            target.mip,
            texel * scale
        );
        let info = self.sides[target.side.min(1)].info.as_ref();
        let number = info.and_then(|info| info.graph.texture(&target.texture));
        if let (Some(info), Some(number)) = (info, number)
            && let Some(plan) = info.textures.get(number).filter(|plan| plan.volume)
        {
            let names = &info.graph.textures[number].1.value.parts;
            let edge = plan.mip_extent(target.mip)[1];
            parts::draw(&painter, names, target, edge, (shown, done.decoded.size));
            if let Some(part) = parts::of_slice(names, target, edge) {
                name = format!("{name}  {part}");
            }
        }
        note(&painter, area, area.left_top() + Vec2::new(6.0, 6.0), &name);
    }

    /// Place and values of the texel under the pointer.
    fn under_pointer(
        &self,
        painter: &egui::Painter,
        pointer: Option<Pos2>,
        shown: Rect,
        texel: f32,
    ) {
        let Some(done) = &self.tabs.inspector.shown else {
            return;
        };
        let Some(at) = pointer.filter(|p| shown.contains(*p)) else {
            return;
        };
        let place = ((at - shown.min) / texel).floor();
        let [x, y] = [place.x as u32, place.y as u32];
        let values = done.decoded.values(x, y);
        if values.is_empty() {
            return;
        }
        if texel >= 3.0 {
            let cell = Rect::from_min_size(shown.min + place * texel, Vec2::splat(texel));
            painter.rect_stroke(
                cell,
                0.0,
                Stroke::new(1.0, Color32::YELLOW),
                egui::StrokeKind::Outside,
            );
        }
        let target = &done.decoded.target;
        let volume = self.is_volume(target);
        let place: Vec<String> = image::texel(target, volume, done.decoded.size[1], x, y)
            .iter()
            .map(ToString::to_string)
            .collect();
        let channels: Vec<String> = ["R", "G", "B", "A"]
            .iter()
            .zip(values)
            .map(|(n, v)| format!("{n} {v}"))
            .collect();
        let text = format!("({})\n{}", place.join(", "), channels.join("\n"));
        note(
            painter,
            painter.clip_rect(),
            at + Vec2::new(14.0, 14.0),
            &text,
        );
    }
}

/// Points that a notch of a common wheel scrolls.
const NOTCH: f32 = 50.0;

/// Whole steps of the wheel: 1 up, -1 down. Smooth scrolling comes in small parts, of which the
/// first counts.
fn notch(ui: &Ui, wheel: f32) -> i32 {
    let id = ui.id().with("notch");
    let left: f32 = ui.data(|d| d.get_temp(id)).unwrap_or(0.0);
    let sum = if wheel == 0.0 { left } else { left + wheel };
    let steps = (sum / NOTCH).trunc();
    ui.data_mut(|d| d.insert_temp(id, sum - steps * NOTCH));
    steps as i32
}

/// A text on dark ground that stays within `area`.
fn note(painter: &egui::Painter, area: Rect, at: Pos2, text: &str) {
    let galley = painter.layout_no_wrap(text.to_string(), FontId::monospace(12.0), Color32::WHITE);
    let size = galley.size() + Vec2::splat(8.0);
    let most = (area.max - size).max(area.min);
    let rect = Rect::from_min_size(at.clamp(area.min, most), size);
    painter.rect_filled(rect, 3.0, Color32::from_black_alpha(225));
    painter.galley(
        Align2::LEFT_TOP
            .anchor_size(rect.min + Vec2::splat(4.0), galley.size())
            .min,
        galley,
        Color32::WHITE,
    );
}

#[cfg(test)]
mod tests {
    use super::step;

    #[test]
    fn sizes_go_in_steps() {
        assert_eq!((step(1.0, true), step(1.0, false)), (2.0, 0.5));
        assert_eq!((step(0.37, true), step(0.37, false)), (0.5, 0.25));
        assert_eq!((step(64.0, true), step(0.0625, false)), (64.0, 0.0625));
    }
}
