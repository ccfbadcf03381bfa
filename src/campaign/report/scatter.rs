//! Error against time, both logarithmic, with a Pareto front for each experiment.

use super::data::Scored;
use super::pareto::pareto;
use crate::campaign::charts::{Area, Axis, FONT, Failure, Plane, color, drawn, plane};
use crate::lab::LabError;
use plotters::prelude::*;

const SIZE: (u32, u32) = (900, 560);
/// Colour of the front of a single experiment.
pub const FRONT: RGBColor = RGBColor(200, 60, 40);

/// Opacity of bars; no other line has it.
pub const BAR_OPACITY: f64 = 0.4;

/// Experiments of dots in the order of their colours.
pub fn groups(dots: &[Scored]) -> Vec<&str> {
    let mut names: Vec<&str> = dots.iter().map(|d| d.experiment.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Index and noise of each dot with a bar.
pub fn bars(dots: &[Scored]) -> impl Iterator<Item = (usize, f64)> {
    let noise = |(i, d): (usize, &Scored)| d.noise.filter(|n| *n > 0.0).map(|n| (i, n));
    dots.iter().enumerate().filter_map(noise)
}

/// The chart as SVG. It has one circle per dot, in order, one colour per experiment, and before all
/// other lines of that colour a front: the points of the experiment that none of its others beats
/// in both time and error, with larger circles. The only front is red. Vertical bars show the
/// error that the noise of the reference alone causes; hollow circles are within it. Presets have
/// a square. The legend is in the corner with the fewest points.
pub fn scatter(title: &str, metric: &str, dots: &[Scored]) -> Result<String, LabError> {
    drawn(title, SIZE, |area| draw(area, title, metric, dots))
}

fn draw(area: &Area, title: &str, metric: &str, dots: &[Scored]) -> Result<(), Failure> {
    // A perfect point has no logarithm. It is drawn a tenth below the others.
    let least = dots
        .iter()
        .map(|d| d.error)
        .filter(|e| *e > 0.0)
        .fold(f64::INFINITY, f64::min)
        .min(1.0);
    let place = |d: &Scored| (d.ms, d.error.max(least / 10.0));
    let xs = around(dots.iter().map(|d| place(d).0));
    let ys = around(dots.iter().map(|d| place(d).1));
    let x = Axis::log("GPU time of a frame, ms, median", xs);
    let y = Axis::log(metric, ys);
    let title = format!("{title}, {metric} against time ({} points)", dots.len());
    let mut chart = plane(area, &title, &x, &y)?;
    let experiments = groups(dots);
    let color_of = |name: &str| color(experiments.iter().position(|e| *e == name).unwrap_or(0));
    let mut on_fronts: Vec<usize> = Vec::new();
    for name in &experiments {
        let own: Vec<usize> = (0..dots.len())
            .filter(|i| dots[*i].experiment == *name)
            .collect();
        let pairs: Vec<(f64, f64)> = own.iter().map(|i| (dots[*i].ms, dots[*i].error)).collect();
        let front = pareto(&pairs).into_iter().map(|k| own[k]);
        let mut steps: Vec<(f64, f64)> = Vec::new();
        for i in front {
            let at = place(&dots[i]);
            steps.extend(steps.last().map(|last| (at.0, last.1)));
            steps.push(at);
            on_fronts.push(i);
        }
        let color = if experiments.len() < 2 {
            FRONT
        } else {
            color_of(name)
        };
        let line = PathElement::new(steps, color.stroke_width(1));
        chart.draw_series(std::iter::once(line))?;
    }
    chart.draw_series(bars(dots).map(|(i, noise)| {
        let (x, y) = place(&dots[i]);
        let ends = vec![(x, (y - noise).max(ys.0)), (x, (y + noise).min(ys.1))];
        let color = color_of(&dots[i].experiment).mix(BAR_OPACITY);
        PathElement::new(ends, color.stroke_width(1))
    }))?;
    chart.draw_series(dots.iter().enumerate().map(|(i, d)| {
        let on_front = on_fronts.contains(&i);
        let color = if on_front && experiments.len() < 2 {
            FRONT
        } else {
            color_of(&d.experiment)
        };
        let style = if d.noisy {
            color.stroke_width(2)
        } else {
            color.mix(0.85).filled()
        };
        Circle::new(place(d), if on_front { 6 } else { 4 }, style)
    }))?;
    chart.draw_series(dots.iter().filter(|d| d.preset).map(|d| {
        let square = Rectangle::new([(-9, -9), (9, 9)], BLACK.stroke_width(1));
        let name = Text::new(d.experiment.clone(), (12, -14), (FONT, 13));
        EmptyElement::at(place(d)) + square + name
    }))?;
    if experiments.len() > 1 {
        let points: Vec<_> = dots.iter().map(place).collect();
        key(&mut chart, &experiments, &points, (xs, ys))?;
    }
    Ok(())
}

/// The colours of the experiments, in the corner with the fewest points.
fn key<'a, 'b: 'a>(
    chart: &mut Plane<'a, 'b>,
    experiments: &[&str],
    points: &[(f64, f64)],
    ranges: ((f64, f64), (f64, f64)),
) -> Result<(), Failure> {
    for (i, name) in experiments.iter().enumerate() {
        let color = color(i);
        // A rectangle, because circles are dots.
        let key = move |(x, y)| Rectangle::new([(x, y - 5), (x + 10, y + 5)], color.filled());
        chart
            .draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?
            .label(*name)
            .legend(key);
    }
    chart
        .configure_series_labels()
        .position(free_corner(points, ranges, experiments.len()))
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.2))
        .label_font((FONT, 15))
        .draw()?;
    Ok(())
}

/// The corner where a key of this number of lines covers the fewest points. Both axes are
/// logarithmic.
fn free_corner(
    points: &[(f64, f64)],
    (xs, ys): ((f64, f64), (f64, f64)),
    lines: usize,
) -> SeriesLabelPosition {
    use SeriesLabelPosition::{LowerLeft, LowerRight, UpperLeft, UpperRight};
    // Size as shares of the axes: about 130 pixels, and 24 per line.
    let (width, height) = (0.18, 0.06 + 0.055 * lines as f64);
    let share = |v: f64, (low, high): (f64, f64)| (v / low).ln() / (high / low).ln();
    let covered = |right: bool, upper: bool| {
        let is_within = |(x, y): &&(f64, f64)| {
            let (x, y) = (share(*x, xs), share(*y, ys));
            (if right { x > 1.0 - width } else { x < width })
                && (if upper { y > 1.0 - height } else { y < height })
        };
        points.iter().filter(is_within).count()
    };
    let corners = [
        (LowerLeft, covered(false, false)),
        (UpperLeft, covered(false, true)),
        (UpperRight, covered(true, true)),
        (LowerRight, covered(true, false)),
    ];
    corners
        .into_iter()
        .min_by_key(|c| c.1)
        .map_or(LowerLeft, |c| c.0)
}

/// Range of positive numbers with margins, at least a factor of 2.
fn around(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
    let room = (high / low)
        .powf(0.05)
        .max(1.5 / (high / low).sqrt())
        .max(1.05);
    (low / room, high * room)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::report::data::dot;

    #[test]
    fn experiments_have_colours_and_a_key() {
        let dots = [
            dot(1.0, 0.2, "threads"),
            dot(2.0, 0.1, "threads"),
            dot(3.0, 0.3, "raster"),
        ];
        let svg = scatter("Sponza", "relMSE", &dots).unwrap();
        assert_eq!(svg.matches("<circle").count(), dots.len());
        let fills = |svg: &str| -> Vec<String> {
            let circles = svg.lines().filter(|l| l.starts_with("<circle"));
            circles
                .filter_map(|l| Some(l.split("fill=\"").nth(1)?.split('"').next()?.to_string()))
                .collect()
        };
        let colours = fills(&svg);
        assert!(
            colours[0] == colours[1] && colours[1] != colours[2],
            "{colours:?}"
        );
        assert!(["threads", "raster"].iter().all(|name| svg.contains(name)));
        assert_eq!(svg.matches("threads").count(), 1, "in the key alone");
        // Each experiment has a front of its own, also where another one is better.
        let fronts = |svg: &str| -> Vec<(String, usize)> {
            let lines = svg.lines().filter(|l| l.starts_with("<polyline"));
            let ink =
                |l: &str, name: &str| Some(l.split(name).nth(1)?.split('"').next()?.to_string());
            lines
                .filter_map(|l| {
                    let points = ink(l, " points=\"")?.split_whitespace().count();
                    Some((ink(l, "stroke=\"")?, points))
                })
                .filter(|(stroke, _)| colours.contains(stroke))
                .collect()
        };
        assert_eq!(
            fronts(&svg),
            [(colours[2].clone(), 1), (colours[0].clone(), 3)]
        );
        // Noise is a bar about the point.
        let barred = [Scored {
            noise: Some(0.05),
            ..dot(1.0, 0.2, "threads")
        }];
        let lines = |dots: &[Scored]| {
            let svg = scatter("Sponza", "relMSE", dots).unwrap();
            svg.matches("<polyline").count()
        };
        assert_eq!(lines(&barred), lines(&dots[..1]) + 1);
        let marked = [
            Scored {
                preset: true,
                ..dot(1.0, 0.2, "threads")
            },
            dot(2.0, 0.1, "raster"),
        ];
        assert_eq!(
            scatter("Sponza", "relMSE", &marked)
                .unwrap()
                .matches("threads")
                .count(),
            2
        );
        // The front is red where there is one experiment, and there is no key.
        let one = scatter("Sponza", "relMSE", &dots[..2]).unwrap();
        assert!(fills(&one).iter().all(|c| *c != colours[0]) && !one.contains("threads"));
    }
}
