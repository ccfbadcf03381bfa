//! Work on other threads that must answer: a panic in it becomes an answer too.

use crate::diagnostics::panics::said;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The work's result, or what it said when it panicked. What it had in hand is dropped; nothing
/// shared is left half done, as workers own what they change.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .map_err(|panic| format!("a fault in the program: {}", said(panic.as_ref())))
}

#[cfg(test)]
mod tests {
    use super::guarded;

    #[test]
    fn a_panic_is_an_answer() {
        assert_eq!(guarded(|| 1), Ok(1));
        let faults = || -> u32 { panic!("no number") };
        assert_eq!(
            guarded(faults).unwrap_err(),
            "a fault in the program: no number"
        );
    }
}
