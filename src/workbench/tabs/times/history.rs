//! The times of the last frames.

use crate::graph::run::FrameTimes;
use crate::results::stats::spread;
use crate::workbench::engine::report::{GraphInfo, PictureReport};
use std::collections::VecDeque;
use std::ops::Range;

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
            times: FrameTimes {
                picture: None,
                handed: None,
                ..p.times.clone()
            },
        }
    }

    /// GPU time between the passes, ms.
    pub fn between(&self) -> f64 {
        (self.times.gpu_ms - self.times.passes.iter().map(|p| p.1).sum::<f64>()).max(0.0)
    }

    /// Time of a pass, ms; a pass that ran several times has the sum.
    pub fn pass(&self, number: usize) -> f64 {
        let parts = self.times.passes.iter().filter(|p| p.0 == number);
        parts.map(|p| p.1).sum()
    }

    /// Whether the frame skipped a pass.
    pub fn skipped(&self, number: usize) -> bool {
        self.times.skipped.contains(&number)
    }
}

/// A pass of a history.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// Number in the graph.
    pub number: usize,
    /// Name in the graph.
    pub name: String,
    /// Stage in the graph; the name if the graph declares none.
    pub stage: String,
}

/// The last frames of a side.
#[derive(Clone, Default)]
pub struct History {
    /// The passes, in execution order.
    pub passes: Vec<Pass>,
    /// The oldest first.
    pub frames: VecDeque<Frame>,
    /// Number of the oldest frame since the history began.
    pub first: u64,
    /// Counts changes.
    pub changes: u64,
}

impl History {
    /// A history of these passes, without frames yet.
    pub fn new(passes: Vec<Pass>) -> History {
        History {
            passes,
            ..History::default()
        }
    }

    /// An empty history of the passes that a graph runs.
    pub fn of(info: &GraphInfo) -> History {
        let pass = |number: &usize| {
            let pass = &info.graph.passes.get(*number)?.value;
            Some(Pass {
                number: *number,
                name: pass.name.value.clone(),
                stage: pass.stage().to_string(),
            })
        };
        History::new(info.passes.iter().filter_map(pass).collect())
    }

    /// Adds a frame and drops the oldest.
    pub fn push(&mut self, frame: Frame) {
        if self.frames.len() == KEPT {
            self.frames.pop_front();
            self.first += 1;
        }
        self.frames.push_back(frame);
        self.changes += 1;
    }

    /// The frame of a number since the history began.
    pub fn at(&self, number: u64) -> Option<&Frame> {
        let index = usize::try_from(number.checked_sub(self.first)?).ok()?;
        self.frames.get(index)
    }

    /// The number after that of the last frame.
    pub fn end(&self) -> u64 {
        self.first + self.frames.len() as u64
    }

    /// The frames of a range of numbers.
    pub fn range(&self, numbers: Range<u64>) -> impl Iterator<Item = &Frame> + Clone {
        numbers.filter_map(|number| self.at(number))
    }

    /// GPU times of all frames: median and 95th percentile, ms.
    pub fn level(&self) -> (f64, f64) {
        let s = spread(self.frames.iter().map(|f| f.times.gpu_ms).collect());
        (s.median, s.p95)
    }
}

/// The numbers of the frames that all shown sides have.
pub fn common(sides: &[History; 2], both: bool) -> Range<u64> {
    let [a, b] = sides;
    match both {
        true => a.first.max(b.first)..a.end().min(b.end()),
        false => a.first..a.end(),
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A pass of a stage.
    pub fn pass(number: usize, name: &str, stage: &str) -> Pass {
        Pass {
            number,
            name: name.into(),
            stage: stage.into(),
        }
    }

    /// A frame with the times of passes 0, 1, ... and half a millisecond between them.
    pub fn frame(times: &[f64]) -> Frame {
        Frame {
            times: FrameTimes {
                gpu_ms: times.iter().sum::<f64>() + 0.5,
                cpu_ms: 1.0,
                passes: times.iter().copied().enumerate().collect(),
                ..FrameTimes::default()
            },
            ..Frame::default()
        }
    }

    #[test]
    fn only_the_last_frames_are_kept() {
        let mut h = History::default();
        for i in 0..KEPT as u64 + 7 {
            h.push(Frame {
                frame: i,
                ..Frame::default()
            });
        }
        assert_eq!((h.frames.len(), h.frames[0].frame), (KEPT, 7));
        assert_eq!((h.first, h.end()), (7, KEPT as u64 + 7));
        assert_eq!(h.at(9).map(|f| f.frame), Some(9));
        assert!(h.at(6).is_none() && h.at(h.end()).is_none());
    }

    #[test]
    fn both_sides_are_measured_over_the_same_frames() {
        let mut sides = [History::default(), History::default()];
        // A is a frame ahead and has dropped its first one.
        for i in 0..=KEPT as u64 {
            let frame = Frame {
                frame: i,
                ..Frame::default()
            };
            sides[0].push(frame.clone());
            if i < KEPT as u64 {
                sides[1].push(frame);
            }
        }
        let numbers = common(&sides, true);
        let frames =
            |side: &History| -> Vec<u64> { side.range(numbers.clone()).map(|f| f.frame).collect() };
        assert_eq!(frames(&sides[0]), frames(&sides[1]));
        assert_eq!(frames(&sides[0]).len(), KEPT - 1);
        assert_eq!(common(&sides, false), 1..KEPT as u64 + 1);
    }
}
