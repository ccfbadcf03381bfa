//! Times on the picture: what the GPU spends on each stage or pass, in a corner of each side.

use super::Workbench;
use super::compare::Mode;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Vec2};

/// What the overlay lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rows {
    /// Nothing: there is no overlay.
    #[default]
    None,
    /// The graph's stages.
    Stages,
    /// Every pass.
    Passes,
}

impl Rows {
    /// What the key goes on to.
    pub fn next(self) -> Rows {
        match self {
            Rows::None => Rows::Stages,
            Rows::Stages => Rows::Passes,
            Rows::Passes => Rows::None,
        }
    }
}

/// Times to draw.
#[derive(Clone, Debug, Default)]
pub struct Timers {
    /// What they are of, a line each.
    pub title: Vec<String>,
    /// Name and time, ms, in the graph's order.
    pub rows: Vec<(String, f64)>,
    /// First to last command on the GPU, ms.
    pub total: f64,
}

const WIDTH: f32 = 226.0;
const LINE: f32 = 14.0;
const MARGIN: f32 = 6.0;

impl Timers {
    /// The longest of its times, ms: that of the longest bar.
    pub fn longest(&self) -> f64 {
        self.rows.iter().map(|r| r.1).fold(0.0, f64::max)
    }
}

/// Draws times into the upper left or right corner of a picture. Bars are to the scale of `longest` ms, so that those of two sides
/// can be compared. Rows that do not fit are left out, the shortest first, and summed in one.
pub fn draw(painter: &Painter, picture: Rect, right: bool, timers: &Timers, longest: f64) {
    let lines = timers.title.len() as f32 + 1.0;
    let room = ((picture.height() - 2.0 * MARGIN) / LINE - lines - 1.0).max(0.0) as usize;
    let rows = fitting(&timers.rows, room);
    let size = Vec2::new(WIDTH.min(picture.width()), LINE * (lines + rows.len() as f32) + 2.0 * MARGIN);
    let corner = if right { picture.right_top() - Vec2::new(size.x, 0.0) } else { picture.left_top() };
    let panel = Rect::from_min_size(corner, size);
    let painter = painter.with_clip_rect(panel.intersect(painter.clip_rect()));
    painter.rect_filled(panel, 0.0, Color32::from_black_alpha(176));
    let inner = panel.shrink(MARGIN);
    let line = |n: f32| Rect::from_min_size(inner.min + Vec2::new(0.0, n * LINE), Vec2::new(inner.width(), LINE));
    let (font, numbers) = (FontId::proportional(11.5), FontId::monospace(10.5));
    for (i, text) in timers.title.iter().enumerate() {
        painter.text(line(i as f32).left_center(), Align2::LEFT_CENTER, text, font.clone(), Color32::from_gray(210));
    }
    let number = |at: Rect, ms: f64, color: Color32| {
        painter.text(at.right_center(), Align2::RIGHT_CENTER, format!("{ms:.3}"), numbers.clone(), color);
    };
    let total = line(timers.title.len() as f32);
    painter.text(total.left_center(), Align2::LEFT_CENTER, "GPU ms", font.clone(), Color32::WHITE);
    number(total, timers.total, Color32::WHITE);
    for (i, (name, ms)) in rows.iter().enumerate() {
        let at = line(lines + i as f32);
        let part = if longest > 0.0 { (ms / longest).clamp(0.0, 1.0) as f32 } else { 0.0 };
        let bar = Rect::from_min_size(at.min + Vec2::new(0.0, 1.0), Vec2::new(at.width() * part, LINE - 2.0));
        painter.rect_filled(bar, 1.0, super::times::color(name).gamma_multiply(0.55));
        let names = Rect::from_min_max(at.min, Pos2::new(at.right() - 44.0, at.bottom()));
        painter.with_clip_rect(names.intersect(painter.clip_rect())).text(
            at.left_center() + Vec2::new(3.0, 0.0),
            Align2::LEFT_CENTER,
            name,
            font.clone(),
            Color32::from_gray(235),
        );
        number(at, *ms, Color32::from_gray(235));
    }
}

/// At most so many rows: the longest in their order, and the sum of the others.
fn fitting(rows: &[(String, f64)], room: usize) -> Vec<(String, f64)> {
    if rows.len() <= room {
        return rows.to_vec();
    }
    let Some(kept) = room.checked_sub(1) else { return Vec::new() };
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|a, b| rows[*b].1.total_cmp(&rows[*a].1));
    let (mut first, rest) = (order[..kept].to_vec(), &order[kept..]);
    first.sort_unstable();
    let others = (format!("{} others", rest.len()), rest.iter().map(|i| rows[*i].1).sum());
    first.into_iter().map(|i| rows[i].clone()).chain([others]).collect()
}

/// Times of passes, in order, as those of stages.
pub fn by_stage<'p>(passes: impl Iterator<Item = (&'p str, f64)>) -> Vec<(String, f64)> {
    let mut stages: Vec<(String, f64)> = Vec::new();
    for (stage, ms) in passes {
        match stages.iter_mut().find(|s| s.0 == stage) {
            Some(known) => known.1 += ms,
            None => stages.push((stage.into(), ms)),
        }
    }
    stages
}

impl Workbench {
    /// Draws the times of what is shown: the whole picture, and the part where B is.
    pub(super) fn timers(&self, painter: &Painter, a: Rect, b: Option<Rect>) {
        if self.view.timers == Rows::None {
            return;
        }
        let sides: Vec<Timers> = (0..2).map(|side| self.timers_of(side)).collect();
        let longest = sides[0].longest().max(if b.is_some() { sides[1].longest() } else { 0.0 });
        let flipped = self.view.mode == Mode::Flip && self.view.flipped && b.is_some();
        draw(painter, a, false, &sides[usize::from(flipped)], longest);
        if let Some(b) = b.filter(|_| self.view.mode != Mode::Flip) {
            draw(painter, b, self.view.mode != Mode::Side, &sides[1], longest);
        }
    }

    fn timers_of(&self, side: usize) -> Timers {
        let (Some(info), Some(picture)) = (&self.sides[side].info, &self.sides[side].picture) else {
            return Timers::default();
        };
        let medians = self.times.medians(side);
        let passes = medians.iter().filter_map(|(n, ms)| Some((&info.graph.passes.get(*n)?.value, *ms)));
        let rows = match self.view.timers {
            Rows::Passes => passes.map(|(pass, ms)| (pass.name.value.clone(), ms)).collect(),
            _ => by_stage(passes.map(|(pass, ms)| (pass.stage(), ms))),
        };
        let device = self.device.as_ref().map_or("", |d| d.name.as_str());
        let side_name = if self.desired.sides[1].is_some() { ["A: ", "B: "][side.min(1)] } else { "" };
        let mut title = vec![format!("{side_name}{device}"), format!("{}x{}", picture.size[0], picture.size[1])];
        if let Some(caption) = info.graph.caption(&info.params) {
            title[1] += &format!(", {caption}");
        }
        if let Some((metric, error)) = self.chart.known_error(side, self.sent.number) {
            title.push(format!("{metric} {error:.3e}"));
        }
        if !info.params.off.is_empty() {
            title.push(format!("off: {}", info.params.off.join(", ")));
        }
        Timers { title, rows, total: self.times.median_total(side) }
    }
}

#[cfg(test)]
mod tests {
    use super::{by_stage, fitting};

    #[test]
    fn what_does_not_fit_is_summed() {
        let rows: Vec<(String, f64)> =
            [("a", 1.0), ("b", 3.0), ("c", 0.5), ("d", 2.0)].map(|(n, ms)| (n.to_string(), ms)).to_vec();
        assert_eq!(fitting(&rows, 4), rows);
        let some = fitting(&rows, 3);
        assert_eq!(some, [("b".into(), 3.0), ("d".into(), 2.0), ("2 others".to_string(), 1.5)]);
        assert!(fitting(&rows, 0).is_empty());
    }

    #[test]
    fn passes_of_a_stage_are_one_row() {
        let stages = by_stage([("x", 1.0), ("y", 2.0), ("x", 3.0)].into_iter());
        assert_eq!(stages, [("x".to_string(), 4.0), ("y".to_string(), 2.0)]);
    }
}
