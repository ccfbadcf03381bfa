//! Events of the file system, without those that change nothing.

use crate::workbench::background::Wake;
use crossbeam_channel::Sender;
use notify::{Event, EventKind};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The content of an event.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Seen {
    /// This file was written, made, renamed or removed.
    Path(PathBuf),
    /// Events were lost.
    Lost,
}

/// Forwards events and wakes the window.
pub(super) fn handler(
    send: Sender<(Instant, Seen)>,
    wake: Wake,
) -> impl FnMut(notify::Result<Event>) + Send + 'static {
    move |event| {
        let Ok(event) = event else { return };
        let now = Instant::now();
        let mut any = false;
        for seen in seen(event) {
            any |= send.send((now, seen)).is_ok();
        }
        if any {
            wake();
        }
    }
}

fn seen(event: Event) -> Vec<Seen> {
    if event.need_rescan() {
        return vec![Seen::Lost];
    }
    if matches!(event.kind, EventKind::Access(_)) {
        return Vec::new();
    }
    event
        .paths
        .into_iter()
        .filter(|p| is_source(p))
        .map(Seen::Path)
        .collect()
}

/// Not an editor's own file: hidden, or a backup, or a swap.
fn is_source(path: &Path) -> bool {
    let name = path
        .file_name()
        .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    !(name.is_empty()
        || name.starts_with('.')
        || name.ends_with('~')
        || name.ends_with(".swp")
        || name.ends_with(".tmp")
        || name.bytes().all(|b| b.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use notify::event::{CreateKind, Flag};

    #[test]
    fn a_full_queue_is_a_change_of_everything() {
        assert_eq!(
            seen(Event::new(EventKind::Other).set_flag(Flag::Rescan)),
            [Seen::Lost]
        );
    }

    #[test]
    fn files_that_editors_leave_beside_are_no_change() {
        let event =
            |name: &str| Event::new(EventKind::Create(CreateKind::File)).add_path(name.into());
        for name in [".a.frag.swp", "a.frag~", "4913", "a.tmp"] {
            assert_eq!(seen(event(name)), [], "{name}");
        }
        assert_eq!(seen(event("a.frag")), [Seen::Path("a.frag".into())]);
    }
}
