//! The device's clock on the CPU's time line (`VK_KHR_calibrated_timestamps` or its EXT version).

use super::{DeviceInfo, Gpu, vk};
use ash::{ext, khr};
use std::time::{Duration, Instant};

/// The extension that reads the device's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClockExtension {
    /// None: GPU times have no place on the CPU's time line.
    #[default]
    None,
    Ext,
    Khr,
}

impl ClockExtension {
    pub(super) fn of(extensions: &[vk::ExtensionProperties]) -> ClockExtension {
        // Validation layers from before 2023 warn of the KHR name. The functions are the same.
        if super::has(extensions, ext::calibrated_timestamps::NAME) {
            ClockExtension::Ext
        } else if super::has(extensions, khr::calibrated_timestamps::NAME) {
            ClockExtension::Khr
        } else {
            ClockExtension::None
        }
    }

    pub(super) fn name(self) -> Option<&'static std::ffi::CStr> {
        match self {
            ClockExtension::None => None,
            ClockExtension::Ext => Some(ext::calibrated_timestamps::NAME),
            ClockExtension::Khr => Some(khr::calibrated_timestamps::NAME),
        }
    }
}

/// Functions that read the device's clock.
pub(super) enum Clock {
    Ext(ext::calibrated_timestamps::Device),
    Khr(khr::calibrated_timestamps::Device),
}

impl Clock {
    /// The clock of a device that was created with the extension; `None` if it cannot be read.
    pub(super) fn new(
        entry: &ash::Entry,
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        device: &ash::Device,
        extension: ClockExtension,
    ) -> Option<Clock> {
        // SAFETY: the physical device and the device come from this instance, and the device has
        // the extension.
        let domains = unsafe {
            match extension {
                ClockExtension::None => return None,
                ClockExtension::Ext => ext::calibrated_timestamps::Instance::new(entry, instance)
                    .get_physical_device_calibrateable_time_domains(physical),
                ClockExtension::Khr => khr::calibrated_timestamps::Instance::new(entry, instance)
                    .get_physical_device_calibrateable_time_domains(physical),
            }
        };
        if !domains.ok()?.contains(&vk::TimeDomainKHR::DEVICE) {
            return None;
        }
        Some(match extension {
            ClockExtension::Khr => {
                Clock::Khr(khr::calibrated_timestamps::Device::new(instance, device))
            }
            _ => Clock::Ext(ext::calibrated_timestamps::Device::new(instance, device)),
        })
    }

    fn ticks(&self) -> Option<u64> {
        let info =
            [vk::CalibratedTimestampInfoKHR::default().time_domain(vk::TimeDomainKHR::DEVICE)];
        // SAFETY: the device is alive and supports the time domain.
        let read = unsafe {
            match self {
                Clock::Ext(clock) => clock.get_calibrated_timestamps(&info),
                Clock::Khr(clock) => clock.get_calibrated_timestamps(&info),
            }
        };
        read.ok()?.0.first().copied()
    }
}

/// A reading of the device's clock.
#[derive(Clone, Copy, Debug)]
pub struct ClockReading {
    ticks: u64,
    /// Time of the reading.
    pub at: Instant,
    /// Largest error of that time.
    pub uncertainty: Duration,
}

/// Readings of which the most exact one is taken.
const READINGS: usize = 3;

impl Gpu {
    /// Reads the device's clock between two readings of the CPU's; `None` without the extension.
    pub fn read_clock(&self) -> Option<ClockReading> {
        let clock = self.clock.as_ref()?;
        let reading = |_| {
            let before = Instant::now();
            let ticks = clock.ticks()?;
            let half = before.elapsed() / 2;
            Some(ClockReading {
                ticks,
                at: before + half,
                uncertainty: half,
            })
        };
        (0..READINGS)
            .filter_map(reading)
            .min_by_key(|r| r.uncertainty)
    }
}

impl DeviceInfo {
    /// The CPU's time of a timestamp within half a period of the counter around a reading.
    pub(crate) fn instant(&self, reading: &ClockReading, ticks: u64) -> Option<Instant> {
        let time = |ticks: u64| Duration::from_secs_f64(ticks as f64 * self.timestamp_ns * 1e-9);
        let after = ticks.wrapping_sub(reading.ticks) & self.timestamp_mask;
        match after > self.timestamp_mask / 2 {
            true => {
                let before = reading.ticks.wrapping_sub(ticks) & self.timestamp_mask;
                reading.at.checked_sub(time(before))
            }
            false => reading.at.checked_add(time(after)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::Features;

    #[test]
    fn timestamps_have_their_place_around_a_reading() {
        let mut info = DeviceInfo::imaginary(Features::default());
        (info.timestamp_ns, info.timestamp_mask) = (50.0, (1 << 36) - 1);
        let at = Instant::now();
        let reading = ClockReading {
            ticks: 10,
            at,
            uncertainty: Duration::ZERO,
        };
        let ms = Duration::from_millis(1);
        assert_eq!(info.instant(&reading, 20_010), Some(at + ms));
        // Before the reading, and before the counter started over.
        assert_eq!(
            info.instant(&reading, (1 << 36) - 19_990),
            at.checked_sub(ms)
        );
    }
}
