//! The times as files for other programs.

use super::history::{Frame, History};
use serde_json::{Value, json};

/// A table: a row a frame of A, then of B; the columns after the fixed ones are passes by name, ms,
/// empty where a side does not have the pass.
///
/// # Errors
/// Writing to memory gives none.
pub fn csv(sides: &[History; 2]) -> std::io::Result<Vec<u8>> {
    let mut names: Vec<&str> = Vec::new();
    for (_, name) in sides.iter().flat_map(|s| &s.passes) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let mut out = csv::Writer::from_writer(Vec::new());
    let fixed = ["side", "frame", "time", "cpu_ms", "gpu_ms"];
    out.write_record(fixed.iter().chain(&names))?;
    for (side, history) in ["A", "B"].iter().zip(sides) {
        for f in &history.frames {
            let mut row = vec![(*side).to_string(), f.frame.to_string()];
            row.extend([f.time, f.times.cpu_ms, f.times.gpu_ms].map(|v| v.to_string()));
            row.extend(names.iter().map(|name| {
                let pass = history.passes.iter().find(|p| p.1 == *name);
                pass.map_or(String::new(), |p| f.pass(p.0).to_string())
            }));
            out.write_record(&row)?;
        }
    }
    out.into_inner().map_err(|e| e.into_error())
}

const NOTE: &str = "Frames and passes are laid end to end by their GPU time, each track from 0: absolute timestamps are \
    not kept, so gaps between frames and between passes, and how tracks lie against each other, mean nothing. The CPU \
    track holds recording and submitting, each begun no sooner than its frame on the GPU track.";

/// A trace in Chrome's format, which Perfetto reads: a track for A, one for B, one for the CPU.
/// Times in µs.
pub fn trace(sides: &[History; 2]) -> Vec<u8> {
    let mut events =
        vec![json!({ "ph": "M", "name": "process_name", "pid": 1, "args": { "name": "conelab" } })];
    for (track, name) in [(1, "A, GPU"), (2, "B, GPU"), (3, "CPU")] {
        events.push(json!({ "ph": "M", "name": "thread_name", "pid": 1, "tid": track, "args": { "name": name } }));
    }
    let mut cpu: Vec<(f64, f64, String)> = Vec::new();
    for (i, (side, history)) in ["A", "B"].iter().zip(sides).enumerate() {
        let mut start = 0.0;
        for frame in &history.frames {
            cpu.push((
                start,
                frame.times.cpu_ms * 1e3,
                format!("{side} {}", frame.frame),
            ));
            start = frame_events(&mut events, i + 1, start, history, frame);
        }
    }
    cpu.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free = 0.0_f64;
    for (start, duration, name) in cpu {
        let start = start.max(free);
        free = start + duration;
        events.push(complete(&name, 3, start, duration, json!({})));
    }
    let trace =
        json!({ "traceEvents": events, "displayTimeUnit": "ms", "otherData": { "note": NOTE } });
    trace.to_string().into_bytes()
}

/// Adds the passes of a frame; when the next frame may begin, µs.
fn frame_events(
    events: &mut Vec<Value>,
    track: usize,
    start: f64,
    history: &History,
    frame: &Frame,
) -> f64 {
    let mut at = start;
    for (number, name) in &history.passes {
        let duration = frame.pass(*number) * 1e3;
        events.push(complete(
            name,
            track,
            at,
            duration,
            json!({ "frame": frame.frame, "time_s": frame.time }),
        ));
        at += duration;
    }
    at.max(start + frame.times.gpu_ms * 1e3)
}

fn complete(name: &str, track: usize, start: f64, duration: f64, args: Value) -> Value {
    json!({ "name": name, "ph": "X", "pid": 1, "tid": track, "ts": start, "dur": duration, "args": args })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::run::FrameTimes;

    fn sides() -> [History; 2] {
        let mut a = History::new(vec![(0, "draw, all".into()), (2, "tone".into())]);
        let mut b = History::new(vec![(1, "tone".into()), (3, "only \"B\"".into())]);
        for i in 0..5_u32 {
            let t = f64::from(i) * 0.25;
            let frame = |passes| Frame {
                times: FrameTimes {
                    cpu_ms: 9.0,
                    gpu_ms: 3.5 + t,
                    passes,
                    ..FrameTimes::default()
                },
                frame: u64::from(i),
                time: t,
            };
            a.push(frame(vec![(0, 1.5 + t), (2, 2.0)]));
            b.push(frame(vec![(1, 0.5), (3, 0.125 + t)]));
        }
        [a, b]
    }

    #[test]
    fn a_table_reads_back_with_the_same_sums() {
        let bytes = csv(&sides()).unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let heads: Vec<String> = reader
            .headers()
            .unwrap()
            .iter()
            .map(str::to_string)
            .collect();
        assert_eq!(
            heads,
            [
                "side",
                "frame",
                "time",
                "cpu_ms",
                "gpu_ms",
                "draw, all",
                "tone",
                "only \"B\""
            ]
        );
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 10);
        let sum = |side: &str, column: usize| -> f64 {
            let cells = rows
                .iter()
                .filter(|r| &r[0] == side)
                .map(|r| r[column].to_string());
            cells
                .filter(|c| !c.is_empty())
                .map(|c| c.parse::<f64>().unwrap())
                .sum()
        };
        assert_eq!((sum("A", 4), sum("A", 5) + sum("A", 6)), (20.0, 20.0));
        assert_eq!((sum("B", 5), sum("B", 6), sum("B", 7)), (0.0, 2.5, 3.125));
        assert_eq!(&rows[0][7], "");
    }

    #[test]
    fn events_of_a_track_do_not_overlap() {
        let trace: Value = serde_json::from_slice(&trace(&sides())).unwrap();
        assert!(
            trace["otherData"]["note"]
                .as_str()
                .unwrap()
                .contains("end to end")
        );
        for track in 1..=3 {
            let events = trace["traceEvents"].as_array().unwrap().iter();
            let mut spans: Vec<(f64, f64)> = events
                .filter(|e| e["ph"] == "X" && e["tid"] == track)
                .map(|e| (e["ts"].as_f64().unwrap(), e["dur"].as_f64().unwrap()))
                .collect();
            assert_eq!(spans.len(), 10);
            spans.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(
                spans.windows(2).all(|w| w[0].0 + w[0].1 <= w[1].0 + 1e-6),
                "{spans:?}"
            );
        }
        // 5 frames of A take 3.5 ms and more on the GPU.
        let last = trace["traceEvents"]
            .as_array()
            .unwrap()
            .iter()
            .rfind(|e| e["tid"] == 1 && e["ph"] == "X")
            .unwrap();
        assert_eq!(
            last["ts"].as_f64().unwrap() + last["dur"].as_f64().unwrap(),
            20_000.0
        );
    }
}
