//! Timing overlay: GPU time of each stage or pass, drawn into a corner of the picture in the window
//! and in files.

use crate::graph::Graph;
use crate::graph::param::Params;
use crate::lab::Texels;
use crate::metrics::colour::srgb_to_linear;
use crate::results::picture;
use crate::vulkan::{Format, Gpu, Painter as GpuPainter, PixelSource, Pixels, Result};
use egui::{Align2, Color32, FontId, Painter, Pos2, RawInput, Rect, Vec2};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Rows of the overlay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Rows {
    /// No overlay.
    #[default]
    #[value(skip)]
    None,
    Stages,
    Passes,
}

impl Rows {
    /// The next mode of the key.
    pub fn next(self) -> Rows {
        match self {
            Rows::None => Rows::Stages,
            Rows::Stages => Rows::Passes,
            Rows::Passes => Rows::None,
        }
    }
}

#[derive(Clone, Debug, Default)]
pub struct Timers {
    /// Title lines.
    pub title: Vec<String>,
    /// Name and time (ms) in graph order.
    pub rows: Vec<(String, f64)>,
    /// From the first to the last command on the GPU (ms).
    pub total: f64,
    /// Statistic of the times over several frames.
    pub statistic: &'static str,
}

/// Suffix of skipped passes.
const SKIPPED: &str = " (skipped)";
const WIDTH: f32 = 236.0;
const LINE: f32 = 15.0;
const MARGIN: f32 = 6.0;

impl Timers {
    /// Times of a graph's passes by index, with the graph's title.
    pub fn new(
        rows: Rows,
        graph: &Graph,
        params: &Params,
        device: &str,
        size: [u32; 2],
        passes: &[(usize, f64)],
    ) -> Timers {
        let passes = passes
            .iter()
            .filter_map(|(n, ms)| Some((&graph.passes.get(*n)?.value, *ms)));
        let rows = match rows {
            Rows::Passes => passes
                .map(|(pass, ms)| (pass.name.value.clone(), ms))
                .collect(),
            Rows::Stages | Rows::None => by_stage(passes.map(|(pass, ms)| (pass.stage(), ms))),
        };
        let mut title = vec![device.to_string(), format!("{}x{}", size[0], size[1])];
        if let Some(caption) = graph.caption(params) {
            title[1] += &format!(", {caption}");
        }
        if !params.off.is_empty() {
            title.push(format!("off: {}", params.off.join(", ")));
        }
        let total = rows.iter().map(|r: &(String, f64)| r.1).sum();
        Timers {
            title,
            rows,
            total,
            statistic: "median",
        }
    }

    /// Marks skipped passes by index.
    pub fn mark_skipped(&mut self, graph: &Graph, numbers: &[usize]) {
        let name = |number: &usize| {
            graph
                .passes
                .get(*number)
                .map(|p| p.value.name.value.as_str())
        };
        let skipped: Vec<&str> = numbers.iter().filter_map(name).collect();
        for row in self
            .rows
            .iter_mut()
            .filter(|row| skipped.contains(&row.0.as_str()))
        {
            row.0.push_str(SKIPPED);
        }
    }

    /// The longest time (ms), which scales the bars.
    pub fn longest(&self) -> f64 {
        self.rows.iter().map(|r| r.1).fold(0.0, f64::max)
    }
}

/// Draws times into the upper left or right corner of a picture. Bars are scaled to `longest` ms,
/// so that two sides are comparable. If space is short, the shortest rows are summed in one.
pub fn draw(painter: &Painter, picture: Rect, right: bool, timers: &Timers, longest: f64) {
    let lines = timers.title.len() as f32 + 1.0;
    let room = ((picture.height() - 2.0 * MARGIN) / LINE - lines - 1.0).max(0.0) as usize;
    let rows = fitting(&timers.rows, room);
    let size = Vec2::new(
        WIDTH.min(picture.width()),
        LINE * (lines + rows.len() as f32) + 2.0 * MARGIN,
    );
    let corner = if right {
        picture.right_top() - Vec2::new(size.x, 0.0)
    } else {
        picture.left_top()
    };
    let panel = Rect::from_min_size(corner, size);
    let painter = painter.with_clip_rect(panel.intersect(painter.clip_rect()));
    painter.rect_filled(panel, 0.0, Color32::from_black_alpha(225));
    let inner = panel.shrink(MARGIN);
    let line = |n: f32| {
        let size = Vec2::new(inner.width(), LINE);
        Rect::from_min_size(inner.min + Vec2::new(0.0, n * LINE), size)
    };
    let (font, numbers) = (FontId::proportional(12.0), FontId::monospace(12.0));
    let left = |painter: &Painter, at: Pos2, text: &str, color: Color32| {
        painter.text(at, Align2::LEFT_CENTER, text, font.clone(), color);
    };
    let number = |at: Rect, ms: f64, color: Color32| {
        let (at, text) = (at.right_center(), format!("{ms:.3}"));
        painter.text(at, Align2::RIGHT_CENTER, text, numbers.clone(), color);
    };
    for (i, text) in timers.title.iter().enumerate() {
        let at = line(i as f32).left_center();
        left(&painter, at, text, Color32::from_gray(210));
    }
    let total = line(timers.title.len() as f32);
    let text = format!("GPU ms, {}", timers.statistic);
    left(&painter, total.left_center(), &text, Color32::WHITE);
    number(total, timers.total, Color32::WHITE);
    for (i, (name, ms)) in rows.iter().enumerate() {
        let at = line(lines + i as f32);
        let part = match longest > 0.0 {
            true => (ms / longest).clamp(0.0, 1.0) as f32,
            false => 0.0,
        };
        let size = Vec2::new(at.width() * part, LINE - 2.0);
        let bar = Rect::from_min_size(at.min + Vec2::new(0.0, 1.0), size);
        let fill = color(name.trim_end_matches(SKIPPED)).gamma_multiply(0.45);
        painter.rect_filled(bar, 1.0, fill);
        let names = Rect::from_min_max(at.min, Pos2::new(at.right() - 50.0, at.bottom()));
        let clipped = painter.with_clip_rect(names.intersect(painter.clip_rect()));
        let start = at.left_center() + Vec2::new(3.0, 0.0);
        left(&clipped, start, name, Color32::from_gray(235));
        number(at, *ms, Color32::from_gray(235));
    }
}

/// At most `room` rows: the longest ones in order, and the sum of the others.
fn fitting(rows: &[(String, f64)], room: usize) -> Vec<(String, f64)> {
    if rows.len() <= room {
        return rows.to_vec();
    }
    let Some(kept) = room.checked_sub(1) else {
        return Vec::new();
    };
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|a, b| rows[*b].1.total_cmp(&rows[*a].1));
    let (mut first, rest) = (order[..kept].to_vec(), &order[kept..]);
    first.sort_unstable();
    let others = (
        format!("{} others", rest.len()),
        rest.iter().map(|i| rows[*i].1).sum(),
    );
    first
        .into_iter()
        .map(|i| rows[i].clone())
        .chain([others])
        .collect()
}

/// Sums times of passes, in order, by stage.
fn by_stage<'p>(passes: impl Iterator<Item = (&'p str, f64)>) -> Vec<(String, f64)> {
    let mut stages: Vec<(String, f64)> = Vec::new();
    for (stage, ms) in passes {
        match stages.iter_mut().find(|s| s.0 == stage) {
            Some(known) => known.1 += ms,
            None => stages.push((stage.into(), ms)),
        }
    }
    stages
}

/// Names of passes in the order of their first drawing.
static NAMES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// The colour of a pass: the same for one name in every graph and side, different for other names.
pub fn color(name: &str) -> Color32 {
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    let number = names.iter().position(|n| n == name).unwrap_or_else(|| {
        names.push(name.to_string());
        names.len() - 1
    });
    PALETTE[number % PALETTE.len()]
}

/// Number of colours before they repeat.
const COLORS: usize = 64;

/// Colours in an order in which each is as far as possible from all before it.
static PALETTE: LazyLock<Vec<Color32>> = LazyLock::new(palette);

fn palette() -> Vec<Color32> {
    let levels = || (0..8u8).map(|i| 32 + i * 30);
    let all = levels().flat_map(|r| {
        levels().flat_map(move |g| levels().map(move |b| Color32::from_rgb(r, g, b)))
    });
    // Readable on dark and on light grounds, and not grey: grey marks what belongs to no pass.
    let usable = |lab: &[f32; 3]| (0.5..0.85).contains(&lab[0]) && lab[1].hypot(lab[2]) > 0.06;
    let mut left: Vec<(Color32, [f32; 3], f32)> = all
        .map(|c| (c, oklab(c), f32::INFINITY))
        .filter(|c| usable(&c.1))
        .collect();
    let mut chosen = Vec::with_capacity(COLORS);
    while chosen.len() < COLORS {
        let Some(next) = (0..left.len()).max_by(|a, b| left[*a].2.total_cmp(&left[*b].2)) else {
            break;
        };
        let (color, lab, _) = left.swap_remove(next);
        for other in &mut left {
            other.2 = other.2.min(distance(lab, other.1));
        }
        chosen.push(color);
    }
    chosen
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f32>().sqrt()
}

/// A colour in Oklab (Ottosson 2020), where equal distances look equally different.
fn oklab(color: Color32) -> [f32; 3] {
    let [r, g, b] = [color.r(), color.g(), color.b()].map(|v| srgb_to_linear(f32::from(v) / 255.0));
    let l = (0.412_221_46 * r + 0.536_332_55 * g + 0.051_445_995 * b).cbrt();
    let m = (0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b).cbrt();
    let s = (0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b).cbrt();
    [
        0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
        1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
        0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
    ]
}

/// A picture with a timing overlay.
pub fn stamped(gpu: &Arc<Gpu>, texels: &Texels, timers: &Timers) -> Result<Texels> {
    let [width, height, _] = texels.extent;
    let rgba: Vec<u8> = picture::rgb8(texels)
        .chunks_exact(3)
        .flat_map(|p| [p[0], p[1], p[2], 255])
        .collect();
    let mut painter = GpuPainter::offscreen(gpu, 1)?;
    let texture = painter.picture(0);
    let area = Rect::from_min_size(Pos2::ZERO, Vec2::new(width as f32, height as f32));
    let input = RawInput {
        screen_rect: Some(area),
        ..RawInput::default()
    };
    let context = egui::Context::default();
    let output = context.run_ui(input, |ui| {
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        let onto = ui.painter().with_clip_rect(area);
        onto.image(texture, area, whole, Color32::WHITE);
        draw(&onto, area, false, timers, timers.longest());
    });
    let primitives = context.tessellate(output.shapes, 1.0);
    let pixels = [Pixels {
        picture: 0,
        size: [width, height],
        source: PixelSource::Bytes(&rgba),
    }];
    painter.paint(
        (width, height),
        1.0,
        output.textures_delta,
        &primitives,
        &pixels,
    )?;
    let (_, bytes) = painter.read()?;
    Ok(Texels {
        extent: texels.extent,
        format: Format::named("rgba8").unwrap_or(texels.format),
        bytes,
    })
}

#[cfg(test)]
mod tests {
    use super::{by_stage, color, distance, fitting, oklab};
    use egui::Color32;

    #[test]
    fn what_does_not_fit_is_summed() {
        let rows: Vec<(String, f64)> = [("a", 1.0), ("b", 3.0), ("c", 0.5), ("d", 2.0)]
            .map(|(n, ms)| (n.to_string(), ms))
            .to_vec();
        assert_eq!(fitting(&rows, 4), rows);
        let some = fitting(&rows, 3);
        assert_eq!(
            some,
            [
                ("b".into(), 3.0),
                ("d".into(), 2.0),
                ("2 others".to_string(), 1.5)
            ]
        );
        assert!(fitting(&rows, 0).is_empty());
    }

    #[test]
    fn a_name_keeps_its_colour_and_no_two_look_alike() {
        let names: Vec<String> = (0..60).map(|i| format!("pass {i}")).collect();
        let colours: Vec<Color32> = names.iter().map(|n| color(n)).collect();
        assert_eq!(names.iter().map(|n| color(n)).collect::<Vec<_>>(), colours);
        let closest = |count: usize| {
            let list: Vec<[f32; 3]> = super::palette()[..count]
                .iter()
                .map(|c| oklab(*c))
                .collect();
            let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
            let apart = pairs.map(|(i, j)| distance(list[i], list[j]));
            apart.fold(f32::INFINITY, f32::min)
        };
        // A difference of 0.02 is just noticeable.
        let found = [closest(12), closest(24), closest(48)];
        assert!(
            found[0] > 0.14 && found[1] > 0.09 && found[2] > 0.06,
            "{found:?}"
        );
    }

    #[test]
    fn passes_of_a_stage_are_one_row() {
        let stages = by_stage([("x", 1.0), ("y", 2.0), ("x", 3.0)].into_iter());
        assert_eq!(stages, [("x".to_string(), 4.0), ("y".to_string(), 2.0)]);
    }
}
