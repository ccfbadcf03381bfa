//! What commands print. An error of standard output is an error of the command, unless its reader
//! has gone away.

use crate::diagnostics::excerpt::harmless;
use crate::lab::LabError;
use std::fmt::Arguments;
use std::io::{Error, ErrorKind, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// The first error of standard output.
static FAILED: Mutex<Option<Error>> = Mutex::new(None);

/// Whether standard output has JSON only, and messages go to standard error.
static JSON_ALONE: AtomicBool = AtomicBool::new(false);

/// Prints for people. Names in a scene's file may hold escape sequences, which a terminal must not
/// obey.
pub fn put(text: Arguments) {
    let text = harmless(&text.to_string());
    match JSON_ALONE.load(Relaxed) {
        true => eprint!("{text}"),
        false => keep(write!(std::io::stdout(), "{text}")),
    }
}

fn keep(result: Result<(), Error>) {
    if let Err(error) = result {
        FAILED
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get_or_insert(error);
    }
}

/// Whether everything has reached standard output.
pub fn written() -> Result<(), LabError> {
    keep(std::io::stdout().flush());
    match FAILED.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => Err(LabError::Request(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Whether `--json` asks for standard output; from then on nothing else is printed there.
pub fn is_json_output(path: &Path) -> bool {
    let asked = path == Path::new("-");
    if asked {
        JSON_ALONE.store(true, Relaxed);
    }
    asked
}

/// Writes what `--json` asks for, to a file or to standard output.
pub fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<(), LabError> {
    let text = serde_json::to_string_pretty(value).map_err(LabError::making("JSON"))?;
    if is_json_output(path) {
        keep(writeln!(std::io::stdout(), "{text}"));
        return Ok(());
    }
    crate::files::write_whole(path, text.as_bytes())?;
    say!("wrote {}", path.display());
    Ok(())
}
