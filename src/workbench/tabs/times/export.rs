//! The times as a table for other programs.

use super::history::History;
use super::table::BETWEEN;

/// A row per frame of A, then of B. The columns after the fixed ones are passes by name, ms, empty
/// for a side without the pass. They and the time between passes add up to the GPU time.
///
/// # Errors
/// Writing to memory gives none.
pub fn csv(sides: &[History; 2]) -> std::io::Result<Vec<u8>> {
    let mut names: Vec<&str> = Vec::new();
    for pass in sides.iter().flat_map(|s| &s.passes) {
        if !names.contains(&pass.name.as_str()) {
            names.push(&pass.name);
        }
    }
    let mut out = csv::Writer::from_writer(Vec::new());
    let fixed = ["side", "frame", "time", "cpu_ms", "gpu_ms", BETWEEN];
    out.write_record(fixed.iter().chain(&names))?;
    for (side, history) in ["A", "B"].iter().zip(sides) {
        for f in &history.frames {
            let mut row = vec![(*side).to_string(), f.frame.to_string()];
            row.extend(
                [f.time, f.times.cpu_ms, f.times.gpu_ms, f.between()].map(|v| v.to_string()),
            );
            row.extend(names.iter().map(|name| {
                let pass = history.passes.iter().find(|p| p.name == *name);
                pass.map_or(String::new(), |p| f.pass(p.number).to_string())
            }));
            out.write_record(&row)?;
        }
    }
    out.into_inner().map_err(|e| e.into_error())
}

#[cfg(test)]
mod tests {
    use super::super::history::Frame;
    use super::super::history::tests::pass;
    use super::*;
    use crate::graph::run::FrameTimes;

    fn sides() -> [History; 2] {
        let mut a = History::new(vec![pass(0, "draw, all", ""), pass(2, "tone", "")]);
        let mut b = History::new(vec![pass(1, "tone", ""), pass(3, "only \"B\"", "")]);
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
            a.push(frame(vec![(0, 1.5 + t), (2, 1.5)]));
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
                BETWEEN,
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
        assert_eq!((sum("A", 4), sum("A", 5)), (20.0, 2.5));
        assert_eq!(sum("A", 6) + sum("A", 7), 17.5);
        assert_eq!((sum("B", 6), sum("B", 7), sum("B", 8)), (0.0, 2.5, 3.125));
        assert_eq!(&rows[0][8], "");
    }
}
