//! Warm-up before a measurement.

use crate::vulkan::DeviceInfo;

/// GPU work that raises the clock: an idle GPU drops to a low clock and needs tens of milliseconds
/// of work to leave it.
const LEAST_GPU_MS: f64 = 100.0;

/// Limit of the warm-up (frames).
const MOST_FRAMES: usize = 10_000;

/// Warm-up criterion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WarmUp {
    /// Minimum number of frames.
    pub(crate) frames: usize,
    /// Minimum GPU time of all warm-up frames (ms).
    pub gpu_ms: f64,
}

impl WarmUp {
    /// At least `frames` frames, and on a GPU at least 100 ms of work. Software devices have no
    /// clock of their own and slower frames, so their time is not considered, nor are unknown
    /// times.
    pub fn of(device: &DeviceInfo, frames: usize) -> WarmUp {
        let clocks = device.kind != "cpu" && device.timestamp_ns > 0.0;
        WarmUp {
            frames,
            gpu_ms: if clocks { LEAST_GPU_MS } else { 0.0 },
        }
    }

    /// Runs frames until the device is warm and returns their number. `frame` runs one frame and
    /// returns the GPU time (ms) of the frames finished since.
    pub fn run<E>(self, frame: &mut dyn FnMut() -> Result<f64, E>) -> Result<usize, E> {
        let (mut frames, mut gpu_ms) = (0, 0.0);
        while frames < self.frames || (gpu_ms < self.gpu_ms && frames < MOST_FRAMES) {
            gpu_ms += frame()?;
            frames += 1;
        }
        Ok(frames)
    }
}
