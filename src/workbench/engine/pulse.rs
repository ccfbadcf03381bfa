//! Whether the engine's thread still moves. Waits for frames are bounded, so that a shader that
//! hangs is noticed by the engine itself; a driver that stands still in a call is noticed here.

use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The time of the last sign of life, and how long the next may take.
pub(super) struct Pulse(Mutex<(Option<Instant>, Duration)>);

/// Longest time for opening a device, or for a step of the engine without its frames.
const SLACK: Duration = Duration::from_secs(60);

impl Pulse {
    pub(super) fn new(patience: Option<Duration>) -> Pulse {
        Pulse(Mutex::new((Some(Instant::now()), limit(patience))))
    }

    /// How long a frame may take on the device that was opened.
    pub(super) fn frames_take(&self, patience: Option<Duration>) {
        self.state().1 = limit(patience);
    }

    /// The engine moves.
    pub(super) fn beat(&self) {
        self.state().0 = Some(Instant::now());
    }

    /// The engine waits for orders, as long as it takes.
    pub(super) fn rest(&self) {
        self.state().0 = None;
    }

    /// Whether a sign of life is to come.
    pub(super) fn beats(&self) -> bool {
        self.state().0.is_some()
    }

    /// How long the engine has been silent, if that is too long.
    pub(super) fn silent(&self) -> Option<Duration> {
        let (last, limit) = *self.state();
        last.map(|last| last.elapsed())
            .filter(|silent| *silent > limit)
    }

    fn state(&self) -> std::sync::MutexGuard<'_, (Option<Instant>, Duration)> {
        self.0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

/// A step has at most two frames in work, one a side, and each may be waited for twice.
fn limit(patience: Option<Duration>) -> Duration {
    patience.map_or(Duration::MAX, |p| p.saturating_mul(4).saturating_add(SLACK))
}

#[cfg(test)]
mod tests {
    use super::Pulse;
    use std::time::Duration;

    #[test]
    fn who_rests_is_not_silent() {
        let pulse = Pulse::new(None);
        pulse.state().1 = Duration::from_millis(5);
        std::thread::sleep(Duration::from_millis(10));
        assert!(
            pulse
                .silent()
                .is_some_and(|s| s >= Duration::from_millis(10))
        );
        pulse.rest();
        assert!(pulse.silent().is_none() && !pulse.beats());
        pulse.beat();
        assert!(pulse.silent().is_none() && pulse.beats());
    }
}
