//! The CPU and GPU timeline in Chrome's trace format, which Perfetto reads.

use super::history::{Frame, History};
use crate::graph::run::Timeline;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Tracks: the GPU's work for A and for B, and the engine's thread on the CPU.
const TRACKS: [&str; 3] = ["A, GPU", "B, GPU", "engine, CPU"];
const CPU: usize = 3;

const CALIBRATED: &str =
    "Times are absolute. GPU times are on the CPU's clock by calibrated timestamps";
const ESTIMATED: &str = "CPU times are absolute. This device has no calibrated timestamps, so each GPU frame is \
    placed at its submission or at the end of the frame before it; lengths are measured, gaps are not";

/// A trace of the frames of both sides. Times are in µs from the first recorded frame.
pub fn trace(sides: &[History; 2]) -> Vec<u8> {
    let name = |kind: &str, track: usize, name: &str| json!({ "ph": "M", "name": kind, "pid": 1, "tid": track, "args": { "name": name } });
    let mut events = vec![name("process_name", 0, "conelab")];
    events.extend(
        (1..)
            .zip(TRACKS)
            .map(|(n, track)| name("thread_name", n, track)),
    );
    let frames = || {
        let all = ["A", "B"].into_iter().zip(sides).enumerate();
        all.flat_map(|(i, (side, history))| {
            history.frames.iter().filter_map(move |frame| {
                Some(Placed {
                    side,
                    track: i + 1,
                    history,
                    frame,
                    timeline: frame.times.timeline?,
                })
            })
        })
    };
    let starts = frames().flat_map(|f| [Some(f.timeline.recorded[0]), f.timeline.gpu.map(|g| g.0)]);
    let origin = starts.flatten().min().unwrap_or_else(Instant::now);
    let mut free = [0.0_f64; 2];
    let mut uncertainty = Duration::ZERO;
    let mut calibrated = true;
    for placed in frames() {
        placed.cpu(&mut events, origin);
        let start = match placed.timeline.gpu {
            Some((start, error)) => {
                uncertainty = uncertainty.max(error);
                micros(origin, start)
            }
            None => {
                calibrated = false;
                micros(origin, placed.timeline.submitted[0]).max(free[placed.track - 1])
            }
        };
        free[placed.track - 1] = placed.gpu(&mut events, start);
    }
    let trace = json!({
        "traceEvents": events,
        "displayTimeUnit": "ms",
        "otherData": {
            "calibrated": calibrated,
            "gpu_uncertainty_us": calibrated.then_some(uncertainty.as_secs_f64() * 1e6),
            "note": if calibrated { CALIBRATED } else { ESTIMATED },
        },
    });
    trace.to_string().into_bytes()
}

/// A frame with its timeline.
struct Placed<'a> {
    side: &'a str,
    /// Track of its GPU work.
    track: usize,
    history: &'a History,
    frame: &'a Frame,
    timeline: Timeline,
}

impl Placed<'_> {
    fn args(&self) -> Value {
        json!({ "side": self.side, "frame": self.frame.frame, "time_s": self.frame.time })
    }

    /// Adds the CPU's work for the frame.
    fn cpu(&self, events: &mut Vec<Value>, origin: Instant) {
        let Timeline {
            recorded,
            submitted,
            waited,
            ..
        } = self.timeline;
        for (name, [start, end]) in [
            ("record", recorded),
            ("submit", submitted),
            ("wait", waited),
        ] {
            let name = format!("{name} {} {}", self.side, self.frame.frame);
            let start = micros(origin, start);
            let duration = micros(origin, end) - start;
            events.push(complete(&name, CPU, start, duration, self.args()));
        }
    }

    /// Adds the frame and, inside it, its passes in the order they ran. Returns its end, µs.
    fn gpu(&self, events: &mut Vec<Value>, start: f64) -> f64 {
        let times = &self.frame.times;
        let whole = times.gpu_ms * 1e3;
        let name = format!("{} {}", self.side, self.frame.frame);
        events.push(complete(&name, self.track, start, whole, self.args()));
        let mut at = start;
        for (number, ms) in times.passes.iter().filter(|p| p.1 > 0.0) {
            let pass = self.history.passes.iter().find(|p| p.number == *number);
            // Sums of rounded lengths must not leave the frame.
            let end = (at + ms * 1e3).min(start + whole);
            if let Some(pass) = pass {
                let args = json!({ "stage": pass.stage });
                events.push(complete(&pass.name, self.track, at, end - at, args));
            }
            at = end;
        }
        start + whole
    }
}

/// Time from one instant to another that may be earlier, µs.
fn micros(from: Instant, to: Instant) -> f64 {
    let after = to.saturating_duration_since(from);
    let before = from.saturating_duration_since(to);
    (after.as_secs_f64() - before.as_secs_f64()) * 1e6
}

fn complete(name: &str, track: usize, start: f64, duration: f64, args: Value) -> Value {
    json!({ "name": name, "ph": "X", "pid": 1, "tid": track, "ts": start, "dur": duration, "args": args })
}

#[cfg(test)]
mod tests {
    use super::super::history::tests::{frame, pass};
    use super::*;

    /// Two frames of A, recorded 10 ms apart. The GPU starts each 2 ms after its recording.
    fn sides(calibrated: bool) -> [History; 2] {
        let mut a = History::new(vec![pass(0, "draw", "first"), pass(1, "tone", "last")]);
        let zero = Instant::now();
        for i in 0..2_u64 {
            let at = |ms: u64| zero + Duration::from_millis(10 * i + ms);
            let mut f = frame(&[12.0, 3.0]);
            f.frame = i;
            f.times.timeline = Some(Timeline {
                recorded: [at(0), at(1)],
                submitted: [at(1), at(2)],
                waited: [at(7), at(8)],
                gpu: calibrated.then(|| (at(2), Duration::from_micros(3))),
            });
            a.push(f);
        }
        [a, History::default()]
    }

    fn spans(trace: &Value, track: usize) -> Vec<(String, f64, f64)> {
        let events = trace["traceEvents"].as_array().unwrap().iter();
        let spans = events.filter(|e| e["ph"] == "X" && e["tid"] == track);
        let number = |v: &Value| v.as_f64().unwrap();
        let span = |e: &Value| {
            let start = number(&e["ts"]);
            let end = start + number(&e["dur"]);
            (e["name"].as_str().unwrap().to_string(), start, end)
        };
        spans.map(span).collect()
    }

    fn close(spans: &[(String, f64, f64)], expected: &[(&str, f64, f64)]) {
        assert_eq!(spans.len(), expected.len(), "{spans:?}");
        for (a, b) in spans.iter().zip(expected) {
            let apart = (a.1 - b.1).abs().max((a.2 - b.2).abs());
            assert!(a.0 == b.0 && apart < 1e-3, "{a:?} is not {b:?}");
        }
    }

    #[test]
    fn calibrated_times_are_absolute() {
        let read: Value = serde_json::from_slice(&trace(&sides(true))).unwrap();
        assert_eq!(read["otherData"]["calibrated"], true);
        assert!((read["otherData"]["gpu_uncertainty_us"].as_f64().unwrap() - 3.0).abs() < 1e-6);
        close(
            &spans(&read, 1),
            &[
                ("A 0", 2e3, 17.5e3),
                ("draw", 2e3, 14e3),
                ("tone", 14e3, 17e3),
                ("A 1", 12e3, 27.5e3),
                ("draw", 12e3, 24e3),
                ("tone", 24e3, 27e3),
            ],
        );
        close(
            &spans(&read, CPU)[..3],
            &[
                ("record A 0", 0.0, 1e3),
                ("submit A 0", 1e3, 2e3),
                ("wait A 0", 7e3, 8e3),
            ],
        );
    }

    #[test]
    fn without_calibration_frames_follow_their_submission_and_each_other() {
        let read: Value = serde_json::from_slice(&trace(&sides(false))).unwrap();
        let data = &read["otherData"];
        assert_eq!(data["calibrated"], false);
        assert!(data["note"].as_str().unwrap().contains("no calibrated"));
        let gpu = spans(&read, 1);
        close(&gpu[..1], &[("A 0", 1e3, 16.5e3)]);
        close(&gpu[3..4], &[("A 1", 16.5e3, 32e3)]);
    }
}
