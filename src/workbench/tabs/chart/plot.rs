//! Error against time, both logarithmic: dots of a sweep, their Pareto front, and where the
//! workbench is.

use super::choice::Chosen;
use crate::campaign::charts::ticks;
use crate::results::table::short;
use egui::{Color32, Pos2, Ui};
use egui_plot::{GridInput, GridMark, Line, MarkerShape, Plot, PlotPoint, PlotUi, Points};

const DOT: Color32 = Color32::from_rgb(120, 160, 215);
const FRONT: Color32 = Color32::from_rgb(235, 100, 80);
/// Colours of A and B.
pub const LIVE: [Color32; 2] = [
    Color32::from_rgb(255, 215, 90),
    Color32::from_rgb(120, 225, 140),
];
/// How near to a dot the pointer must be, points.
const REACH: f32 = 8.0;
/// Least distance of grid lines, points.
const LEAST: f32 = 12.0;

/// The workbench's own dot.
#[derive(Clone, Debug, Default)]
pub struct Live {
    /// GPU time of a frame, ms.
    pub ms: f64,
    /// Its error, as last known.
    pub error: f64,
    /// Whether the error is of the shown picture.
    pub fresh: bool,
    /// Where it was: (ms, error), the oldest first.
    pub trail: Vec<(f64, f64)>,
}

/// Contents of the chart.
pub struct Shown<'a> {
    /// The dots.
    pub chosen: &'a Chosen,
    /// Whether they belong to the present picture's subject; dimmed if not.
    pub fits: bool,
    /// A and B.
    pub live: [Option<&'a Live>; 2],
    /// Title of the error's axis.
    pub title: &'a str,
}

/// The chart as it was drawn.
pub struct Drawn {
    /// Where the dots are on the screen, points.
    pub places: Vec<Pos2>,
    /// Number in `dots` of the dot under the pointer.
    pub hovered: Option<usize>,
    /// The chart.
    pub response: egui::Response,
}

impl Shown<'_> {
    /// The error that is drawn at the bottom, a tenth below the others: a perfect point has no
    /// logarithm.
    fn bottom(&self) -> f64 {
        let dots = self.chosen.dots.iter().map(|d| d.error);
        let lives = self.live.iter().flatten().map(|l| l.error);
        let errors = dots.chain(lives).filter(|e| *e > 0.0);
        errors.fold(f64::INFINITY, f64::min).min(1.0) / 10.0
    }

    fn color(&self, color: Color32) -> Color32 {
        match self.fits {
            true => color,
            false => color.gamma_multiply(0.4),
        }
    }
}

/// Draws the chart. `name` tells charts apart: each keeps its own view.
pub fn show(ui: &mut Ui, name: &str, height: f32, shown: &Shown<'_>) -> Drawn {
    let bottom = shown.bottom();
    let place = |ms: f64, error: f64| [ms.log10(), error.max(bottom).log10()];
    let scored = &shown.chosen.dots;
    let dots: Vec<[f64; 2]> = scored.iter().map(|d| place(d.ms, d.error)).collect();
    let plot = Plot::new(("error against time", name))
        .height(height)
        .set_margin_fraction(egui::vec2(0.08, 0.1))
        .x_axis_label("GPU time of a frame, ms (log)")
        .y_axis_label(format!("{} (log)", shown.title))
        .x_grid_spacer(|input| marks(input, 36.0))
        .y_grid_spacer(|input| marks(input, 14.0))
        .x_axis_formatter(|mark, _| short(10f64.powf(mark.value)))
        .y_axis_formatter(|mark, _| short(10f64.powf(mark.value)))
        .label_formatter(|_| None)
        .show_crosshair(false)
        .grid_color(ui.visuals().weak_text_color().gamma_multiply(0.35))
        .grid_spacing(LEAST..=60.0);
    let response = plot.show(ui, |plot| {
        draw_dots(plot, shown, &dots);
        for (live, color) in shown.live.iter().zip(LIVE) {
            if let Some(live) = live {
                let trail = live.trail.iter().map(|p| place(p.0, p.1)).collect();
                draw_live(plot, trail, place(live.ms, live.error), color, live.fresh);
            }
        }
    });
    let transform = response.transform;
    let places: Vec<Pos2> = dots
        .iter()
        .map(|d| transform.position_from_point(&PlotPoint::new(d[0], d[1])))
        .collect();
    let hovered = response.response.hover_pos().and_then(|at| {
        let near = places
            .iter()
            .enumerate()
            .map(|(i, p)| (p.distance(at), i))
            .filter(|d| d.0 <= REACH);
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|d| d.1)
    });
    Drawn {
        places,
        hovered,
        response: response.response,
    }
}

/// Draws the Pareto front, and the dots: those on it over the others, noisy ones hollow.
fn draw_dots(plot: &mut PlotUi<'_>, shown: &Shown<'_>, dots: &[[f64; 2]]) {
    let chosen = shown.chosen;
    let mut steps: Vec<[f64; 2]> = Vec::new();
    for i in &chosen.front {
        let at = dots[*i];
        steps.extend(steps.last().map(|last| [at[0], last[1]]));
        steps.push(at);
    }
    let front = Line::new("Pareto front", steps).color(shown.color(FRONT));
    plot.line(front.width(1.0).allow_hover(false));
    for (on_front, color, radius) in [(false, DOT, 3.0), (true, FRONT, 4.0)] {
        for noisy in [false, true] {
            let fits =
                |i: &usize| chosen.on_front[*i] == on_front && chosen.dots[*i].noisy == noisy;
            let part: Vec<[f64; 2]> = (0..dots.len()).filter(fits).map(|i| dots[i]).collect();
            let points = Points::new("points", part).color(shown.color(color));
            plot.points(points.radius(radius).filled(!noisy).allow_hover(false));
        }
    }
}

/// Draws the dot of the workbench with its trail; hollow if its error is of another picture.
fn draw_live(
    plot: &mut PlotUi<'_>,
    mut trail: Vec<[f64; 2]>,
    at: [f64; 2],
    color: Color32,
    fresh: bool,
) {
    trail.push(at);
    let faint = color.gamma_multiply(0.45);
    let points = Points::new("trail", trail.clone()).color(faint);
    plot.points(points.radius(2.0).allow_hover(false));
    let line = Line::new("trail", trail).color(faint);
    plot.line(line.width(1.0).allow_hover(false));
    let marker = Points::new("live", vec![at]).shape(MarkerShape::Diamond);
    let marker = marker.color(color).radius(8.0).filled(fresh);
    plot.points(marker.allow_hover(false));
}

/// Round numbers in a range of logarithms. Numbers with enough room have labels.
fn marks(input: GridInput, room: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    // Far zoomed out, or before there is anything to show.
    let far =
        !(low.is_finite() && high.is_finite()) || high - low > 16.0 || low < -200.0 || high > 200.0;
    if far || high <= low {
        return Vec::new();
    }
    // The plot labels numbers with a large step.
    let (unlabelled, labelled) = (input.base_step_size, 1e3 * input.base_step_size);
    let gap = room / f64::from(LEAST) * input.base_step_size;
    let mut last = f64::NEG_INFINITY;
    let values = ticks((10f64.powf(low), 10f64.powf(high)))
        .into_iter()
        .map(f64::log10);
    values
        .map(|value| {
            let step_size = if value - last < gap {
                unlabelled
            } else {
                labelled
            };
            last = if step_size == labelled { value } else { last };
            GridMark { value, step_size }
        })
        .collect()
}
