//! Panics as errors, from third-party readers and in general.

use crate::diagnostics::excerpt::excerpt;
use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether panics of this thread are caught and reported.
    static CAUGHT: Cell<bool> = const { Cell::new(false) };
    static PLACE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs a third-party reader that may panic on unexpected input; its intermediate state is lost.
pub fn caught<T>(read: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !CAUGHT.get() {
                return usual(panic);
            }
            let place = panic
                .location()
                .map_or(String::new(), |l| format!("{}:{}", l.file(), l.line()));
            // For a dependency: its name and version, and the file in it.
            let crates = place
                .find("/registry/src/")
                .and_then(|i| place[i + 14..].find('/').map(|j| i + 15 + j));
            PLACE.set(place[crates.unwrap_or(0)..].to_owned());
        }));
    });
    let before = CAUGHT.replace(true);
    let result = catch_unwind(AssertUnwindSafe(read));
    CAUGHT.set(before);
    result.map_err(|panic| message(&*panic))
}

/// The message of a panic.
pub fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}

fn message(panic: &(dyn Any + Send)) -> String {
    let first = said(panic).lines().next().unwrap_or_default();
    format!(
        "its reader gave up ({} at {})",
        excerpt(first, 200),
        PLACE.take()
    )
}

#[cfg(test)]
mod tests {
    use super::caught;

    #[test]
    fn a_panic_is_its_message() {
        assert_eq!(caught(|| 3), Ok(3));
        let told = caught(|| panic!("no {}", "such thing")).unwrap_err();
        assert!(
            told.starts_with("its reader gave up (no such thing at src/diagnostics/panics.rs:"),
            "{told}"
        );
    }
}
