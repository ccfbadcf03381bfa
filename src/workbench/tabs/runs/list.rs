//! Runs on disk, also of earlier sessions, and their tables.

use super::plan::{FILE, Kind, Plan};
use crate::files::read_input;
use std::path::{Path, PathBuf};

/// Largest plan and table, bytes.
const MOST: [u64; 2] = [64 << 10, 4 << 20];
/// Most rows and columns of a shown table.
const SHOWN: [usize; 2] = [200, 24];

/// A run on disk.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub kind: Kind,
    pub folder: PathBuf,
    /// The plan, if it was started in the window: then it can be resumed.
    pub plan: Option<Plan>,
    pub finished: bool,
    /// Failed points of a sweep.
    pub failed: usize,
}

impl Run {
    pub fn name(&self) -> String {
        self.folder
            .file_name()
            .map_or(String::new(), |n| n.to_string_lossy().into_owned())
    }
}

/// The runs in `captures`, the latest first.
pub(super) fn list(captures: &Path) -> Vec<Run> {
    let mut list = Vec::new();
    for kind in Kind::ALL {
        let folder = captures.join(kind.folder());
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        for entry in entries.filter(|e| e.path().is_dir()) {
            let age = entry.metadata().and_then(|m| m.modified()).ok();
            list.push((age, run(kind, entry.path())));
        }
    }
    list.sort_by_key(|(age, _)| std::cmp::Reverse(*age));
    list.into_iter().map(|(_, run)| run).collect()
}

fn run(kind: Kind, folder: PathBuf) -> Run {
    let plan = read_input(&folder.join(FILE), MOST[0]).ok();
    let plan = plan.and_then(|bytes| ron::de::from_bytes::<Plan>(&bytes).ok());
    let finished = match kind {
        Kind::Fit => folder.join("trials.ron").is_file() || folder.with_extension("ron").is_file(),
        _ => kind.table(&folder).is_file(),
    };
    let failed = match kind {
        Kind::Sweep if finished => failed(&kind.table(&folder)),
        _ => 0,
    };
    Run {
        kind,
        failed,
        plan: plan.filter(|p| p.kind == kind),
        folder,
        finished,
    }
}

/// Number of failed points in the table of a sweep. 0 if it cannot be read.
fn failed(path: &Path) -> usize {
    let bytes = read_input(path, MOST[1]).unwrap_or_default();
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let outcome = reader
        .headers()
        .ok()
        .and_then(|head| head.iter().position(|name| name == "outcome"));
    let records = reader.records().flatten();
    records
        .filter(|row| outcome.and_then(|i| row.get(i)) == Some("failed"))
        .count()
}

/// Rows of a table, the head first.
pub(super) type Rows = Vec<Vec<String>>;

/// Reads a table.
pub(super) fn table(path: &Path) -> Result<Rows, String> {
    let bytes = read_input(path, MOST[1]).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut reader = csv::ReaderBuilder::new();
    let mut reader = reader
        .has_headers(false)
        .flexible(true)
        .from_reader(bytes.as_slice());
    let rows = reader.records().take(SHOWN[0]).map(|row| {
        let row = row.map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(row.iter().take(SHOWN[1]).map(String::from).collect())
    });
    rows.collect()
}
