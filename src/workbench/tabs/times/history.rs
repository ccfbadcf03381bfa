//! The times of the last frames, and the table made from them.

use crate::graph::run::FrameTimes;
use crate::results::stats::spread;
use crate::workbench::engine::report::PictureReport;
use std::collections::VecDeque;

/// Frames that are kept.
pub const KEPT: usize = 240;

/// The times of a frame.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Counts the side's frames.
    pub frame: u64,
    /// Time of the scene, s.
    pub time: f64,
    /// Times, without the picture.
    pub times: FrameTimes,
}

impl Frame {
    /// The times of a picture's frame.
    pub fn of(p: &PictureReport) -> Frame {
        Frame {
            frame: p.frame,
            time: p.time,
            times: p.times.clone(),
        }
    }

    /// GPU time between the passes, ms.
    pub fn outside(&self) -> f64 {
        (self.times.gpu_ms - self.times.passes.iter().map(|p| p.1).sum::<f64>()).max(0.0)
    }

    /// Time of a pass, ms; a pass that ran several times has the sum.
    pub fn pass(&self, number: usize) -> f64 {
        self.times
            .passes
            .iter()
            .filter(|p| p.0 == number)
            .map(|p| p.1)
            .sum()
    }
}

/// The last frames of a side.
#[derive(Default)]
pub struct History {
    /// (number, name) of the passes, in the order they run.
    pub passes: Vec<(usize, String)>,
    /// The oldest first.
    pub frames: VecDeque<Frame>,
    /// Counts changes.
    pub changes: u64,
}

impl History {
    /// A history of these passes, without frames yet.
    pub fn new(passes: Vec<(usize, String)>) -> History {
        History {
            passes,
            ..History::default()
        }
    }

    /// Adds a frame and forgets the oldest.
    pub fn push(&mut self, frame: Frame) {
        if self.frames.len() == KEPT {
            self.frames.pop_front();
        }
        self.frames.push_back(frame);
        self.changes += 1;
    }

    /// The last `count` frames.
    fn last(&self, count: usize) -> impl Iterator<Item = &Frame> {
        self.frames
            .iter()
            .skip(self.frames.len().saturating_sub(count))
    }

    /// Mean time of the last `count` frames, ms; none without frames.
    pub fn mean(&self, count: usize, time: &dyn Fn(&Frame) -> f64) -> Option<f64> {
        let count = count.min(self.frames.len());
        (count > 0).then(|| self.last(count).map(time).sum::<f64>() / count as f64)
    }

    /// The time that a chart should reach, ms: the 95th percentile and a bit, so that one slow
    /// frame flattens nothing.
    pub fn top(&self) -> f64 {
        let s = spread(self.frames.iter().map(|f| f.times.gpu_ms).collect());
        s.p95.max(1e-3) * 1.15
    }
}

/// A row of the table.
pub struct Row {
    /// Name.
    pub name: String,
    /// Whether it is a pass; else a total.
    pub is_pass: bool,
    /// Mean times of A and B, ms.
    pub mean: [Option<f64>; 2],
    /// Whether the last frame of A, and that of B, skipped it.
    pub skipped: [bool; 2],
    /// Texts of the columns.
    pub cells: [String; 4],
}

impl Row {
    /// The name, with a mark if the last frame skipped the pass.
    pub fn title(&self, both: bool) -> String {
        let skipped = match self.skipped {
            [true, true] => " (skipped)",
            [true, false] if both => " (A skipped)",
            [true, false] => " (skipped)",
            [false, true] => " (B skipped)",
            [false, false] => "",
        };
        format!("{}{skipped}", self.name)
    }
}

/// The time of a row in a frame [ms].
type Time<'a> = &'a dyn Fn(&Frame) -> f64;

/// The rows: the passes of A in order, those that only B has, the rest of the GPU's time, and the
/// totals. Means are used because they add up, and because passes that run once in several frames
/// have a median of zero. With B the columns are the means of A and B over equally many frames,
/// B/A, and the share of A; else mean, 95th percentile, share and maximum.
pub fn rows(a: &History, b: Option<&History>) -> Vec<Row> {
    let mut names: Vec<&str> = a.passes.iter().map(|p| p.1.as_str()).collect();
    for (_, name) in b.iter().flat_map(|b| &b.passes) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let both = b.is_some();
    let none = History::default();
    let sides = [a, b.unwrap_or(&none)];
    let count = b.map_or(KEPT, |b| a.frames.len().min(b.frames.len()));
    let total = a.mean(count, &|f| f.times.gpu_ms).unwrap_or(0.0);
    let row = |name: &str, is_pass: bool, times: [Option<Time<'_>>; 2]| {
        let mean = [0, 1].map(|i| sides[i].mean(count, times[i]?));
        let last = times[0].iter().flat_map(|time| a.last(count).map(time));
        let share = mean[0].filter(|_| total > 0.0 && name != CPU);
        Row {
            name: name.into(),
            is_pass,
            mean,
            skipped: [false; 2],
            cells: cells(mean, last.collect(), share.map(|ms| ms / total), both),
        }
    };
    let mut list: Vec<Row> = Vec::with_capacity(names.len() + 3);
    for name in names {
        let number = sides.map(|h| h.passes.iter().find(|p| p.1 == name).map(|p| p.0));
        let pass = number.map(|n| n.map(|n| move |frame: &Frame| frame.pass(n)));
        let times = [0, 1].map(|i| pass[i].as_ref().map(|time| time as Time<'_>));
        let was_skipped = |i: usize| {
            let last = sides[i].frames.back().zip(number[i]);
            last.is_some_and(|(frame, number)| frame.times.skipped.contains(&number))
        };
        list.push(Row {
            skipped: [0, 1].map(was_skipped),
            ..row(name, true, times)
        });
    }
    let all = |time: &'static dyn Fn(&Frame) -> f64| [Some(time), both.then_some(time)];
    list.push(row(OUTSIDE, false, all(&Frame::outside)));
    list.push(row("GPU, first to last", false, all(&|f| f.times.gpu_ms)));
    list.push(row(CPU, false, all(&|f| f.times.cpu_ms)));
    list
}

/// The columns of a row. `times` are those of A [ms], `share` that of A in the GPU's total.
fn cells(mean: [Option<f64>; 2], times: Vec<f64>, share: Option<f64>, both: bool) -> [String; 4] {
    let ms = |v: Option<f64>| v.map_or(String::new(), digits);
    let share = share.map_or(String::new(), |share| format!("{:.1}%", 100.0 * share));
    if both {
        let ratio = match mean {
            [Some(a), Some(b)] if a > 0.0 => format!("{:.2}", b / a),
            _ => String::new(),
        };
        return [ms(mean[0]), ms(mean[1]), ratio, share];
    }
    let most = times.iter().copied().fold(0.0, f64::max);
    let p95 = mean[0].map(|_| spread(times).p95);
    [ms(mean[0]), ms(p95), share, ms(mean[0].map(|_| most))]
}

/// A time with four digits, ms.
fn digits(ms: f64) -> String {
    match ms {
        _ if ms >= 999.95 => format!("{ms:.0}"),
        _ if ms >= 99.995 => format!("{ms:.1}"),
        _ if ms >= 9.9995 => format!("{ms:.2}"),
        _ => format!("{ms:.3}"),
    }
}

/// The row of the GPU's time that no pass takes.
pub const OUTSIDE: &str = "not in any pass";

/// The row that is no part of the GPU's time.
const CPU: &str = "CPU record, submit";

#[cfg(test)]
mod tests {
    use super::*;

    fn history(names: &[&str], times: &[&[f64]]) -> History {
        let mut h = History::new(
            names
                .iter()
                .enumerate()
                .map(|(i, n)| (i, (*n).to_string()))
                .collect(),
        );
        for t in times {
            let passes: Vec<(usize, f64)> = t.iter().copied().enumerate().collect();
            h.push(Frame {
                times: FrameTimes {
                    gpu_ms: t.iter().sum(),
                    cpu_ms: 1.0,
                    passes,
                    ..FrameTimes::default()
                },
                ..Frame::default()
            });
        }
        h
    }

    #[test]
    fn only_the_last_frames_are_kept() {
        let mut h = history(&["a"], &[]);
        for i in 0..KEPT as u64 + 7 {
            h.push(Frame {
                frame: i,
                ..Frame::default()
            });
        }
        assert_eq!((h.frames.len(), h.frames[0].frame), (KEPT, 7));
    }

    #[test]
    fn passes_of_a_and_b_are_paired_by_name() {
        let a = history(&["x", "y"], &[&[1.0, 3.0], &[1.0, 3.0], &[1.0, 5.0]]);
        let b = history(&["y", "z"], &[&[6.0, 2.0]]);
        let rows = rows(&a, Some(&b));
        let names: Vec<&str> = rows.iter().map(|r| r.name.as_str()).collect();
        assert_eq!(names, ["x", "y", "z", OUTSIDE, "GPU, first to last", CPU]);
        // B has one frame: it is compared with the last one of A.
        assert_eq!(rows[0].cells, ["1.000", "", "", "16.7%"]);
        assert_eq!(rows[1].cells, ["5.000", "6.000", "1.20", "83.3%"]);
        assert_eq!(rows[2].cells, ["", "2.000", "", ""]);
        assert_eq!(rows[5].cells, ["1.000", "1.000", "1.00", ""]);
    }

    #[test]
    fn rows_add_up_to_the_total_though_passes_run_in_turns() {
        let mut h = history(&["always", "once in four"], &[]);
        for i in 0..8 {
            let passes = vec![(0, 1.0), (1, if i % 4 == 0 { 40.0 } else { 0.0 })];
            h.push(Frame {
                times: FrameTimes {
                    gpu_ms: passes.iter().map(|p| p.1).sum::<f64>() + 0.5,
                    passes,
                    ..FrameTimes::default()
                },
                ..Frame::default()
            });
        }
        let rows = rows(&h, None);
        let means: Vec<f64> = rows.iter().map(|r| r.mean[0].unwrap()).collect();
        assert_eq!(means[..4], [1.0, 10.0, 0.5, 11.5], "{}", rows[2].name);
        assert_eq!(means[..3].iter().sum::<f64>(), means[3]);
    }

    #[test]
    fn a_pass_is_skipped_in_the_last_frame_or_not() {
        let mut h = history(&["x", "y"], &[&[1.0, 2.0]]);
        h.push(Frame {
            times: FrameTimes {
                passes: vec![(0, 0.0), (1, 2.0)],
                skipped: vec![0],
                ..FrameTimes::default()
            },
            ..Frame::default()
        });
        assert_eq!(
            rows(&h, None)
                .iter()
                .map(|r| r.skipped[0])
                .collect::<Vec<_>>(),
            [true, false, false, false, false]
        );
        h.push(Frame {
            times: FrameTimes {
                passes: vec![(0, 1.0), (1, 2.0)],
                ..FrameTimes::default()
            },
            ..Frame::default()
        });
        assert!(rows(&h, None).iter().all(|r| !r.skipped[0]));
    }

    #[test]
    fn times_have_four_digits() {
        let list = [0.0123, 9.9996, 52.944, 511.644, 21212.28].map(digits);
        assert_eq!(list, ["0.012", "10.00", "52.94", "511.6", "21212"]);
    }

    #[test]
    fn alone_it_says_how_times_spread() {
        let rows = rows(&history(&["x"], &[&[1.0], &[2.0], &[9.0]]), None);
        assert_eq!(rows[0].cells, ["4.000", "9.000", "100.0%", "9.000"]);
        assert!(
            super::rows(&History::default(), None)
                .iter()
                .all(|r| r.cells.iter().all(String::is_empty))
        );
    }
}
