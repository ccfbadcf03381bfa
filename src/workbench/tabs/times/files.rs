//! Exports as files in `captures/`.

use super::{export, trace};
use crate::files::FileError;
use crate::workbench::Workbench;
use std::path::{Path, PathBuf};

impl Workbench {
    /// Writes an export into `captures/`, with a message.
    pub(crate) fn export(&mut self, name: &str, ending: &str, bytes: std::io::Result<Vec<u8>>) {
        let written = bytes.map_err(|e| FileError::content(name.as_ref(), e));
        let written = written.and_then(|b| write_free(&self.setup.home.captures, name, ending, &b));
        let ok = written.is_ok();
        let text = match written {
            Ok(path) => format!("wrote {}", path.display()),
            Err(e) => format!("not written: {e}"),
        };
        self.event("exported", serde_json::json!({ "ok": ok, "text": text }));
        self.messages.status = text;
    }

    /// Exports the shown frames as a table.
    pub(super) fn export_csv(&mut self) {
        let bytes = export::csv(self.tabs.times.shown());
        self.export(&format!("times-{}", self.experiment.name), "csv", bytes);
    }

    /// Exports the shown frames as a trace.
    pub(super) fn export_trace(&mut self) {
        let bytes = trace::trace(self.tabs.times.shown());
        let name = format!("times-{}", self.experiment.name);
        self.export(&name, "json", Ok(bytes));
    }
}

/// Writes `NAME.ENDING` in `captures`, or with a number behind the name when that exists.
fn write_free(
    captures: &Path,
    name: &str,
    ending: &str,
    bytes: &[u8],
) -> Result<PathBuf, FileError> {
    let plain = |c: char| c.is_alphanumeric() || "-_".contains(c);
    let letters = name.chars().map(|c| if plain(c) { c } else { '_' });
    let stem: String = letters.collect();
    for n in 1..10_000 {
        let number = if n == 1 {
            String::new()
        } else {
            format!("-{n}")
        };
        let path = captures.join(format!("{stem}{number}.{ending}"));
        match crate::files::write_new(&path, bytes) {
            Err(e) if e.is_there() => {}
            other => return other.map(|()| path),
        }
    }
    Err(FileError::write(
        &captures.join(stem),
        "too many files of that name",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_never_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let first = write_free(folder.path(), "times-a b/c", "csv", b"1").unwrap();
        let second = write_free(folder.path(), "times-a b/c", "csv", b"2").unwrap();
        assert_eq!(first, folder.path().join("times-a_b_c.csv"));
        assert_eq!(second, folder.path().join("times-a_b_c-2.csv"));
        assert_eq!(
            (
                std::fs::read(first).unwrap(),
                std::fs::read(second).unwrap()
            ),
            (b"1".to_vec(), b"2".to_vec())
        );
    }
}
