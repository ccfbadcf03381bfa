//! Masks of optional features: a device that has them is used as if it had not.

use super::clock::ClockExtension;
use super::{DeviceInfo, Result, VulkanError};

type Mask = fn(&mut DeviceInfo);

/// Names of the optional features that can be masked.
pub(super) const MASKS: [(&str, Mask); 18] = [
    ("anisotropy", |d| d.features.anisotropy = false),
    ("bc", |d| d.features.bc = false),
    ("calibrated_timestamps", |d| {
        d.features.clock = ClockExtension::None;
    }),
    ("clip_distance", |d| d.features.clip_distance = false),
    ("conservative_rasterization", |d| {
        d.features.conservative_rasterization = false;
    }),
    ("depth_clamp", |d| d.features.depth_clamp = false),
    ("fragment_stores", |d| d.features.fragment_stores = false),
    ("full_index", |d| d.features.full_index = false),
    ("geometry", |d| d.features.geometry = false),
    ("independent_blend", |d| {
        d.features.independent_blend = false;
    }),
    ("int64_atomics", |d| d.features.int64_atomics = false),
    ("multi_draw_indirect", |d| {
        d.features.multi_draw_indirect = false;
    }),
    ("pipeline_statistics", |d| {
        d.features.pipeline_statistics = false;
    }),
    ("shares_memory", |d| d.features.shares_memory = false),
    ("tessellation", |d| d.features.tessellation = false),
    ("timestamps", |d| d.timestamp_ns = 0.0),
    ("vertex_stores", |d| d.features.vertex_stores = false),
    ("write_without_format", |d| {
        d.features.write_without_format = false;
    }),
];

/// Removes the named features.
///
/// # Errors
/// A name is unknown.
pub(super) fn apply(info: &mut DeviceInfo, without: &[String]) -> Result<()> {
    for name in without {
        let (_, mask) = MASKS.iter().find(|(n, _)| n == name).ok_or_else(|| {
            let names: Vec<&str> = MASKS.iter().map(|(n, _)| *n).collect();
            VulkanError::NoFeature {
                name: name.clone(),
                names: names.join(", "),
            }
        })?;
        mask(info);
    }
    Ok(())
}
