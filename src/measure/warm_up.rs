//! How long a device works before it is measured.

use crate::vulkan::DeviceInfo;

/// A GPU that was idle while the CPU worked has fallen to a low clock, and takes tens of milliseconds of work to leave it.
const LEAST_GPU_MS: f64 = 100.0;

/// Frames after which that is given up.
const MOST_FRAMES: usize = 10_000;

/// When a device is warm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WarmUp {
    /// Frames, at least.
    pub(crate) frames: usize,
    /// GPU time of all of them, at least.
    pub gpu_ms: f64,
}

impl WarmUp {
    /// So many frames. On a GPU also until it has worked for 100 ms; not on software devices, which have no clock of
    /// their own and take longer for a frame, nor where times are not known.
    pub fn of(device: &DeviceInfo, frames: usize) -> WarmUp {
        let clocks = device.kind != "cpu" && device.timestamp_ns > 0.0;
        WarmUp {
            frames,
            gpu_ms: if clocks { LEAST_GPU_MS } else { 0.0 },
        }
    }

    /// Runs frames until the device is warm, and says how many. `frame` runs one and gives the GPU time, ms, of what
    /// has finished meanwhile.
    pub fn run<E>(self, frame: &mut dyn FnMut() -> Result<f64, E>) -> Result<usize, E> {
        let (mut frames, mut gpu_ms) = (0, 0.0);
        while frames < self.frames || (gpu_ms < self.gpu_ms && frames < MOST_FRAMES) {
            gpu_ms += frame()?;
            frames += 1;
        }
        Ok(frames)
    }
}
