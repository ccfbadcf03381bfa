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
    pub frames: usize,
    /// GPU time of all of them, at least.
    pub gpu_ms: f64,
}

impl WarmUp {
    /// So many frames. On a GPU also until it has worked for 100 ms; not on software devices, which have no clock of
    /// their own and take longer for a frame, nor where times are not known.
    pub fn of(device: &DeviceInfo, frames: usize) -> WarmUp {
        let clocks = device.kind != "cpu" && device.timestamp_ns > 0.0;
        WarmUp { frames, gpu_ms: if clocks { LEAST_GPU_MS } else { 0.0 } }
    }

    /// Runs frames until the device is warm, and says how many. `frame` runs one and gives the GPU time, ms, of what
    /// has finished meanwhile.
    ///
    /// # Errors
    /// The errors of `frame`.
    pub fn run<E>(self, frame: &mut dyn FnMut() -> Result<f64, E>) -> Result<usize, E> {
        let (mut frames, mut gpu_ms) = (0, 0.0);
        while frames < self.frames || (gpu_ms < self.gpu_ms && frames < MOST_FRAMES) {
            gpu_ms += frame()?;
            frames += 1;
        }
        Ok(frames)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::Features;

    /// A device whose clock rises threefold after 60 ms of work, and which is two frames behind.
    #[derive(Default)]
    struct Idle {
        worked: f64,
        behind: Vec<f64>,
    }

    impl Idle {
        fn frame(&mut self, work: f64) -> f64 {
            let ms = if self.worked < 60.0 { 3.0 * work } else { work };
            self.worked += ms;
            self.behind.insert(0, ms);
            self.behind.get(2).copied().unwrap_or(0.0)
        }
    }

    fn device(kind: &'static str, timestamp_ns: f64) -> DeviceInfo {
        let mut device = DeviceInfo::imaginary(Features::default());
        (device.kind, device.timestamp_ns) = (kind, timestamp_ns);
        device
    }

    #[test]
    fn frames_are_measured_at_the_clock_of_a_device_that_works() {
        for work in [0.02, 0.5, 4.0, 70.0] {
            let mut idle = Idle::default();
            let after_three = (0..4).map(|_| idle.frame(work)).last().unwrap();
            assert!(after_three > 2.0 * work || work > 10.0, "a count of frames alone finds a low clock");
            let mut idle = Idle::default();
            let warm = WarmUp::of(&device("discrete", 1.0), 3);
            let run = warm.run(&mut || Ok::<_, ()>(idle.frame(work))).unwrap();
            assert!(run >= 3 && idle.worked >= 100.0, "{run} frames, {} ms", idle.worked);
            assert!(idle.worked < 100.0 + 10.0 * work, "{run} frames, {} ms", idle.worked);
            assert_eq!(idle.frame(work).min(idle.behind[0]), work);
        }
    }

    #[test]
    fn frames_alone_count_on_software_devices_and_without_times() {
        for device in [device("cpu", 1.0), device("discrete", 0.0)] {
            assert_eq!(WarmUp::of(&device, 3).run(&mut || Ok::<_, ()>(0.0)), Ok(3));
        }
        let discrete = WarmUp::of(&device("discrete", 1.0), 20);
        assert_eq!(discrete.run(&mut || Ok::<_, ()>(50.0)), Ok(20));
        assert_eq!(discrete.run(&mut || Ok::<_, ()>(0.0)), Ok(MOST_FRAMES));
        assert_eq!(discrete.run(&mut || Err("lost")), Err("lost"));
    }
}
