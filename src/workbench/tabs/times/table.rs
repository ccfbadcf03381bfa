//! The table of passes by stage: measurements, columns and order.

use super::history::{Frame, History, Pass, common};
use crate::results::stats::spread;
use std::ops::Range;

/// The row of the GPU time that belongs to no pass.
pub const BETWEEN: &str = "between passes";
/// The row of a frame's GPU time.
pub const TOTAL: &str = "GPU total";
/// The row of the CPU time, which is no part of the GPU time.
pub const CPU: &str = "CPU recording + submit";

/// Times of a row on one side, ms. Means are per frame, also for passes that run once in several
/// frames, so the means of all rows add up to the mean of the total.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    pub mean: f64,
    pub median: f64,
    pub p95: f64,
    pub min: f64,
    pub max: f64,
    /// Time in the held frame.
    pub held: Option<f64>,
    /// Frames that did not skip it.
    pub ran: usize,
    /// Whether the held frame, or else the last one, skipped it.
    pub skipped: bool,
}

/// A row of the table.
#[derive(Clone, Debug, Default)]
pub struct Row {
    pub name: String,
    /// Times of A and B; `None` for a side without the pass.
    pub sides: [Option<Measured>; 2],
}

impl Row {
    /// Whether every side that has the pass skipped it.
    pub fn is_skipped(&self) -> bool {
        let mut shown = self.sides.iter().flatten().peekable();
        shown.peek().is_some() && shown.all(|m| m.skipped)
    }

    /// The name, with a mark if the pass was skipped.
    pub fn title(&self, both: bool) -> String {
        let skipped = |side: usize| self.sides[side].as_ref().is_some_and(|m| m.skipped);
        let mark = match [skipped(0), skipped(1)] {
            [false, false] => "",
            _ if !both || self.is_skipped() => " (skipped)",
            [true, _] => " (A skipped)",
            [false, true] => " (B skipped)",
        };
        format!("{}{mark}", self.name)
    }
}

/// A stage of the graph with its passes.
#[derive(Clone, Debug, Default)]
pub struct Stage {
    /// Sums of the passes.
    pub row: Row,
    /// Empty if the stage is a single pass.
    pub passes: Vec<Row>,
}

/// The table.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// In the graph's order: those of A, then those that only B has.
    pub stages: Vec<Stage>,
    pub between: Row,
    pub total: Row,
    pub cpu: Row,
    /// Number of frames measured.
    pub frames: usize,
    /// Whether it has a side B.
    pub both: bool,
    /// Whether it shows a held frame.
    pub held: bool,
}

/// A side's frames that are measured.
struct Frames<'a> {
    history: &'a History,
    numbers: Range<u64>,
    held: Option<&'a Frame>,
}

impl Frames<'_> {
    /// Measures the passes that `is` selects; `None` without them or without frames.
    fn passes(&self, is: impl Fn(&Pass) -> bool) -> Option<Measured> {
        let chosen = self.history.passes.iter().filter(|p| is(p));
        let numbers: Vec<usize> = chosen.map(|p| p.number).collect();
        let time = |frame: &Frame| numbers.iter().map(|n| frame.pass(*n)).sum();
        let skipped = |frame: &Frame| numbers.iter().all(|n| frame.skipped(*n));
        match numbers.is_empty() {
            true => None,
            false => self.measure(time, skipped),
        }
    }

    fn measure(
        &self,
        time: impl Fn(&Frame) -> f64,
        skipped: impl Fn(&Frame) -> bool,
    ) -> Option<Measured> {
        let frames = self.history.range(self.numbers.clone());
        let times: Vec<f64> = frames.clone().map(&time).collect();
        let last = self.held.or(frames.clone().last())?;
        let max = times.iter().copied().fold(0.0, f64::max);
        let mean = times.iter().sum::<f64>() / times.len().max(1) as f64;
        let s = spread(times);
        Some(Measured {
            mean,
            median: s.median,
            p95: s.p95,
            min: s.min,
            max,
            held: self.held.map(&time),
            ran: frames.filter(|f| !skipped(f)).count(),
            skipped: skipped(last),
        })
    }
}

impl Table {
    /// Measures both sides over the frames that they have in common, or A over all of its frames.
    pub fn new(sides: &[History; 2], both: bool, held: Option<&[Option<Frame>; 2]>) -> Table {
        let numbers = common(sides, both);
        let shown = [0, 1].map(|side| {
            (side == 0 || both).then(|| Frames {
                history: &sides[side],
                numbers: numbers.clone(),
                held: held.and_then(|frames| frames[side].as_ref()),
            })
        });
        let row = |name: &str, measured: &dyn Fn(&Frames<'_>) -> Option<Measured>| Row {
            name: name.into(),
            sides: [0, 1].map(|side| shown[side].as_ref().and_then(measured)),
        };
        let whole = |name: &str, time: &dyn Fn(&Frame) -> f64| {
            row(name, &|frames| frames.measure(time, |_| false))
        };
        let stage = |(name, passes): (&str, Vec<&str>)| Stage {
            row: row(name, &|frames| frames.passes(|p| p.stage == name)),
            passes: match passes[..] {
                [only] if only == name => Vec::new(),
                _ => passes
                    .iter()
                    .map(|name| row(name, &|frames| frames.passes(|p| p.name == *name)))
                    .collect(),
            },
        };
        Table {
            stages: by_stage(sides, both).into_iter().map(stage).collect(),
            between: whole(BETWEEN, &Frame::between),
            total: whole(TOTAL, &|f| f.times.gpu_ms),
            cpu: whole(CPU, &|f| f.times.cpu_ms),
            frames: usize::try_from(numbers.end.saturating_sub(numbers.start)).unwrap_or(0),
            both,
            held: held.is_some(),
        }
    }
}

/// Names of the stages and of their passes.
fn by_stage(sides: &[History; 2], both: bool) -> Vec<(&str, Vec<&str>)> {
    let mut stages: Vec<(&str, Vec<&str>)> = Vec::new();
    let shown = sides.iter().take(if both { 2 } else { 1 });
    for pass in shown.flat_map(|side| &side.passes) {
        let (stage, name) = (pass.stage.as_str(), pass.name.as_str());
        match stages.iter_mut().find(|s| s.0 == stage) {
            Some((_, names)) if names.contains(&name) => {}
            Some((_, names)) => names.push(name),
            None => stages.push((stage, vec![name])),
        }
    }
    stages
}

/// A column of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    Held,
    Mean,
    Median,
    P95,
    Min,
    Share,
    A,
    B,
    Difference,
    Ratio,
}

impl Column {
    /// The columns of a table, as many as fit.
    pub fn of(table: &Table, fit: usize) -> Vec<Column> {
        use Column::{A, B, Difference, Held, Mean, Median, Min, P95, Ratio, Share};
        // The columns, and the order in which they give way.
        let (all, drops) = match (table.both, table.held) {
            (true, _) => ([A, B, Difference, Ratio, Share], [Share, Difference, Ratio]),
            (false, true) => ([Held, Mean, Median, P95, Min], [Min, Median, P95]),
            (false, false) => ([Mean, Median, P95, Min, Share], [Min, Median, P95]),
        };
        let dropped = &drops[..all.len().saturating_sub(fit).min(drops.len())];
        let stays = |c: &Column| !dropped.contains(c);
        all.into_iter().filter(stays).collect()
    }

    pub fn title(self) -> &'static str {
        match self {
            Column::Held => "frame",
            Column::Mean => "mean",
            Column::Median => "median",
            Column::P95 => "p95",
            Column::Min => "min",
            Column::Share => "share",
            Column::A => "A",
            Column::B => "B",
            Column::Difference => "B-A",
            Column::Ratio => "B/A",
        }
    }

    pub fn help(self, held: bool) -> &'static str {
        match self {
            Column::Held => "Time in the held frame, ms",
            Column::Mean => "Mean per frame, ms. Means of all rows add up to the GPU total",
            Column::Median => "Median over the frames, ms",
            Column::P95 => "95th percentile over the frames, ms",
            Column::Min => "Minimum over the frames, ms",
            Column::Share => "Share of A's mean GPU total",
            Column::A if held => "A in the held frame, ms",
            Column::B if held => "B in the held frame, ms",
            Column::A => "Mean of A per frame, ms, over the frames that both sides have rendered",
            Column::B => "Mean of B per frame, ms, over the frames that both sides have rendered",
            Column::Difference => "B minus A, ms",
            Column::Ratio => "B divided by A. Above 1: B is slower",
        }
    }

    /// The number of a row; `None` leaves the cell empty.
    pub fn value(self, row: &Row, table: &Table) -> Option<f64> {
        let time = |row: &Row, side: usize| {
            let measured = row.sides[side].as_ref()?;
            match table.held && table.both {
                true => measured.held,
                false => Some(measured.mean),
            }
        };
        let [a, b] = [time(row, 0), time(row, 1)];
        let own = row.sides[0].as_ref();
        match self {
            Column::Held => own.and_then(|m| m.held),
            Column::Mean => own.map(|m| m.mean),
            Column::Median => own.map(|m| m.median),
            Column::P95 => own.map(|m| m.p95),
            Column::Min => own.map(|m| m.min),
            Column::Share => {
                let total = time(&table.total, 0).filter(|t| *t > 0.0)?;
                a.filter(|_| row.name != CPU).map(|a| a / total)
            }
            Column::A => a,
            Column::B => b,
            Column::Difference => Some(b? - a?),
            Column::Ratio => a.filter(|a| *a > 0.0).and_then(|a| Some(b? / a)),
        }
    }

    /// The text of a cell.
    pub fn text(self, value: Option<f64>) -> String {
        match (self, value) {
            (_, None) => String::new(),
            (Column::Share, Some(v)) if v >= 0.9995 => "100%".into(),
            (Column::Share, Some(v)) => format!("{:.1}%", 100.0 * v),
            (Column::Ratio, Some(v)) if v < 99.995 => format!("{v:.2}"),
            (Column::Ratio, Some(v)) => format!("{v:.0}"),
            (Column::Difference, Some(v)) if v < 0.0 => format!("-{}", digits(-v)),
            (Column::Difference, Some(v)) => format!("+{}", digits(v)),
            (_, Some(v)) => digits(v),
        }
    }
}

/// A time with four digits, ms.
pub fn digits(ms: f64) -> String {
    match ms {
        _ if ms >= 999.95 => format!("{ms:.0}"),
        _ if ms >= 99.995 => format!("{ms:.1}"),
        _ if ms >= 9.9995 => format!("{ms:.2}"),
        _ => format!("{ms:.3}"),
    }
}

/// The order of rows: by a column, or that of the graph.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sort {
    /// The column, and whether the largest is first.
    pub by: Option<(Column, bool)>,
}

impl Sort {
    /// The order after a click on a column's head: descending, ascending, the graph's.
    pub fn clicked(self, column: Column) -> Sort {
        let by = match self.by {
            Some((c, true)) if c == column => Some((column, false)),
            Some((c, false)) if c == column => None,
            _ => Some((column, true)),
        };
        Sort { by }
    }

    /// Numbers of the rows, in order. Rows without a number are last.
    pub fn order<'r>(self, rows: impl Iterator<Item = &'r Row>, table: &Table) -> Vec<usize> {
        let value = |row: &Row| self.by.and_then(|(column, _)| column.value(row, table));
        let values: Vec<Option<f64>> = rows.map(value).collect();
        let mut order: Vec<usize> = (0..values.len()).collect();
        if let Some((_, descending)) = self.by {
            order.sort_by(|i, j| match (values[*i], values[*j]) {
                (Some(a), Some(b)) if descending => b.total_cmp(&a),
                (Some(a), Some(b)) => a.total_cmp(&b),
                (a, b) => b.is_some().cmp(&a.is_some()),
            });
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::super::history::tests::{frame, pass};
    use super::*;

    fn history(passes: &[(&str, &str)], frames: &[&[f64]]) -> History {
        let passes = passes.iter().enumerate();
        let mut h = History::new(passes.map(|(i, (n, s))| pass(i, n, s)).collect());
        for times in frames {
            h.push(frame(times));
        }
        h
    }

    fn cells(row: &Row, table: &Table) -> Vec<String> {
        let columns = Column::of(table, 9).into_iter();
        columns.map(|c| c.text(c.value(row, table))).collect()
    }

    #[test]
    fn passes_of_a_and_b_are_paired_by_name() {
        let a = history(&[("x", "x"), ("y", "y")], &[&[1.0, 3.0], &[1.0, 5.0]]);
        let b = history(&[("y", "y"), ("z", "z")], &[&[6.0, 2.0]]);
        let table = Table::new(&[a, b], true, None);
        let names: Vec<&str> = table.stages.iter().map(|s| s.row.name.as_str()).collect();
        assert_eq!((names, table.frames), (vec!["x", "y", "z"], 1));
        // B has one frame, so only the first one of A counts.
        let rows: Vec<_> = table.stages.iter().map(|s| cells(&s.row, &table)).collect();
        assert_eq!(rows[0], ["1.000", "", "", "", "22.2%"]);
        assert_eq!(rows[1], ["3.000", "6.000", "+3.000", "2.00", "66.7%"]);
        assert_eq!(rows[2], ["", "2.000", "", "", ""]);
        assert_eq!(
            cells(&table.cpu, &table),
            ["1.000", "1.000", "+0.000", "1.00", ""]
        );
    }

    #[test]
    fn rows_add_up_to_the_total_though_passes_run_in_phases() {
        let names = [
            ("every", "one"),
            ("once in four", "one"),
            ("other", "other"),
        ];
        let mut h = history(&names, &[]);
        for i in 0..8 {
            let mut f = frame(&[1.0, if i % 4 == 0 { 40.0 } else { 0.0 }, 2.0]);
            f.times.skipped = if i % 4 == 0 { vec![] } else { vec![1] };
            h.push(f);
        }
        let table = Table::new(&[h, History::default()], false, None);
        let mean = |row: &Row| row.sides[0].as_ref().unwrap().mean;
        let stages: f64 = table.stages.iter().map(|s| mean(&s.row)).sum();
        assert_eq!(stages + mean(&table.between), mean(&table.total));
        let stage = &table.stages[0];
        assert_eq!(stage.passes.iter().map(mean).sum::<f64>(), mean(&stage.row));
        let phased = stage.passes[1].sides[0].as_ref().unwrap();
        assert_eq!((phased.mean, phased.median, phased.p95), (10.0, 0.0, 40.0));
        assert_eq!((phased.ran, phased.max, phased.skipped), (2, 40.0, true));
        assert_eq!(stage.passes[1].title(false), "once in four (skipped)");
        // The stage ran, because another of its passes did.
        assert!(!stage.row.is_skipped() && table.stages[1].passes.is_empty());
    }

    #[test]
    fn a_held_frame_stands_beside_the_mean() {
        let h = history(&[("x", "x")], &[&[1.0], &[2.0], &[9.0]]);
        let held = [h.at(1).cloned(), None];
        let sides = [h, History::default()];
        let table = Table::new(&sides, false, Some(&held));
        assert_eq!(
            cells(&table.stages[0].row, &table),
            ["2.000", "4.000", "2.000", "9.000", "1.000"]
        );
        assert_eq!(Column::of(&table, 2), [Column::Held, Column::Mean]);
        let table = Table::new(&sides, false, None);
        assert_eq!(
            cells(&table.stages[0].row, &table),
            ["4.000", "2.000", "9.000", "1.000", "88.9%"]
        );
    }

    #[test]
    fn rows_are_sorted_by_a_column_and_back() {
        let h = history(&[("x", "x"), ("y", "y"), ("z", "z")], &[&[2.0, 3.0, 1.0]]);
        let table = Table::new(&[h, History::default()], false, None);
        let order = |s: Sort| s.order(table.stages.iter().map(|s| &s.row), &table);
        let first = Sort::default().clicked(Column::Mean);
        assert_eq!(order(first), [1, 0, 2]);
        assert_eq!(order(first.clicked(Column::Mean)), [2, 0, 1]);
        assert_eq!(
            first.clicked(Column::Mean).clicked(Column::Mean),
            Sort::default()
        );
        assert_eq!(order(Sort::default()), [0, 1, 2]);
    }

    #[test]
    fn without_frames_cells_are_empty() {
        let table = Table::new(&Default::default(), false, None);
        assert!(cells(&table.total, &table).iter().all(String::is_empty));
    }

    #[test]
    fn times_have_four_digits() {
        let list = [0.0123, 9.9996, 52.944, 511.644, 21212.28].map(digits);
        assert_eq!(list, ["0.012", "10.00", "52.94", "511.6", "21212"]);
    }
}
