//! Tables of measured figures in pages of the documentation, each row measured again by a test. A row that misses what is
//! wanted says so there, and by how much it may ever miss it; it fails only when it no longer says what is measured.

use super::{device, root};
use std::fmt::Write;

/// No bound.
pub const ANY: f64 = f64::INFINITY;

/// A measured figure.
pub struct Row {
    pub setting: String,
    pub figure: &'static str,
    pub value: f64,
    /// Least and greatest that is wanted.
    pub wanted: (f64, f64),
}

/// A row.
pub fn row(
    setting: impl Into<String>,
    figure: &'static str,
    value: f64,
    wanted: (f64, f64),
) -> Row {
    Row {
        setting: setting.into(),
        figure,
        value,
        wanted,
    }
}

impl Row {
    fn is_wanted(&self) -> bool {
        self.value >= self.wanted.0 && self.value <= self.wanted.1
    }

    /// How far the figure lies beyond what is wanted, 0 where it does not.
    fn beyond(&self) -> f64 {
        (self.value - self.wanted.1)
            .max(self.wanted.0 - self.value)
            .max(0.0)
    }
}

/// A row of the table. `limit` is how far its figure may ever be from what is wanted: kept when the table is written anew, so that
/// nothing gets worse bit by bit.
fn line(trial: &str, r: &Row, limit: f64) -> String {
    let (low, high) = r.wanted;
    let wanted = match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{low} to {high}"),
        (true, false) => format!("at least {low}"),
        _ => format!("at most {high}"),
    };
    let verdict = if r.is_wanted() {
        "yes".into()
    } else {
        format!("**no**, by at most {limit:.3}")
    };
    format!(
        "| {trial} | {} | {} | {:.4} | {wanted} | {verdict} |",
        r.setting, r.figure, r.value
    )
}

/// The limit that a row of the table states: none for one that says yes; a new row's is a tenth more than what is measured.
fn limit(documented: Option<&&str>, r: &Row) -> f64 {
    if documented.is_some_and(|l| l.ends_with("| yes |")) {
        return 0.0;
    }
    let stated = documented.and_then(|l| {
        l.split_once("by at most ")?
            .1
            .trim_end_matches([' ', '|'])
            .parse()
            .ok()
    });
    stated.unwrap_or(1.1 * r.beyond() + 0.001)
}

/// Compares rows with the table of a page in docs, or writes them there with CONELAB_BLESS. On a GPU they are printed alone.
#[track_caller]
pub fn check(page: &str, trial: &str, rows: &[Row]) {
    let path = root().join("docs").join(page);
    let text = std::fs::read_to_string(&path).unwrap();
    let mine = |l: &&str| l.starts_with(&format!("| {trial} |"));
    let same = |r: &Row| {
        text.lines()
            .filter(mine)
            .find(|l| l.contains(&format!("| {} | {} |", r.setting, r.figure)))
    };
    let limits: Vec<f64> = rows.iter().map(|r| limit(same(r).as_ref(), r)).collect();
    let lines: Vec<String> = rows
        .iter()
        .zip(&limits)
        .map(|(r, limit)| line(trial, r, *limit))
        .collect();
    println!("{}", lines.join("\n"));
    if device() != "llvmpipe" {
        return;
    }
    for (r, limit) in rows.iter().zip(&limits) {
        let (setting, figure) = (&r.setting, r.figure);
        assert!(
            r.beyond() <= *limit,
            "{trial}, {setting}, {figure}: {} misses what is wanted by more than {limit}",
            r.value
        );
    }
    if std::env::var_os("CONELAB_BLESS").is_some() {
        let at = text
            .lines()
            .position(|l| mine(&l))
            .unwrap_or(text.lines().count());
        let mut out: Vec<&str> = text.lines().filter(|l| !mine(l)).collect();
        for (i, l) in lines.iter().enumerate() {
            out.insert(at + i, l);
        }
        std::fs::write(&path, out.join("\n") + "\n").unwrap();
        return;
    }
    let documented: Vec<&str> = text.lines().filter(mine).collect();
    assert_eq!(
        documented.len(),
        rows.len(),
        "{trial}: docs/{page} has other rows"
    );
    let mut wrong = String::new();
    for ((documented, line), r) in documented.iter().zip(&lines).zip(rows) {
        let (a, b): (Vec<&str>, Vec<&str>) =
            (documented.split('|').collect(), line.split('|').collect());
        let number: f64 = a[4].trim().parse().unwrap();
        let near = (number - r.value).abs() <= 0.03 * number.abs().max(0.02);
        if !near || [1, 2, 3, 5, 6].iter().any(|i| a[*i] != b[*i]) {
            let _ = writeln!(wrong, "documented     {documented}\nmeasured {line}");
        }
    }
    assert!(
        wrong.is_empty(),
        "docs/{page} no longer says what is measured:\n{wrong}"
    );
}
