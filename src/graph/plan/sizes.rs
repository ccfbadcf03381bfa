//! Sizes of textures and buffers.

use super::data::{BufferPlan, TexturePlan};
use super::numbers::Numbers;
use crate::graph::expr::Ex;
use crate::graph::file::BufferSize;
use crate::graph::link::Layouts;
use crate::graph::param::{Params, Value};
use crate::vulkan::{DeviceInfo, Format, vk};

/// A format, or the one that a choice parameter is set to.
pub(super) fn format(params: &Params, name: &str) -> Option<Format> {
    Format::named(name).or_else(|| match params.get(name) {
        Some(Value::Choice(option)) => Format::named(option),
        _ => None,
    })
}

pub(super) fn textures(
    numbers: &mut Numbers<'_>,
    wanted: &[String],
    device: &DeviceInfo,
) -> Vec<TexturePlan> {
    let (limits, allows) = (&device.limits, &device.name);
    let mut list = Vec::new();
    for (name, texture) in &numbers.set.graph.textures {
        let t = &texture.value;
        let mut extent = [1; 3];
        for (slot, ex) in extent.iter_mut().zip(&t.size.0) {
            *slot = numbers.count(ex, 1, "size");
        }
        let mut count =
            |ex: &Option<Ex>, what| ex.as_ref().map_or(1, |ex| numbers.count(ex, 1, what));
        let mips = count(&t.mips, "mip count");
        let layers = count(&t.layers, "layer count");
        let most = 32 - extent.iter().max().unwrap_or(&1).leading_zeros();
        if mips > most {
            let message = format!("'{name}' has {mips} mips; {extent:?} texels allow {most}");
            numbers.error(texture.at, message);
        }
        let side = if t.is_volume() {
            limits.max_image_dimension3_d
        } else {
            limits.max_image_dimension2_d
        };
        for (n, ex) in extent.iter().zip(&t.size.0).filter(|(n, _)| **n > side) {
            numbers.error(
                ex.at,
                format!("'{name}' is {n} texels long; {allows} allows {side}"),
            );
        }
        let most_layers = limits.max_image_array_layers;
        if layers > most_layers {
            numbers.error(
                texture.at,
                format!("'{name}' has {layers} layers; {allows} allows {most_layers}"),
            );
        }
        let Some(format) = format(numbers.set.params, &t.format.value) else {
            numbers.error(t.format.at, format!("'{}' is no format", t.format.value));
            continue;
        };
        list.push(TexturePlan {
            extent,
            volume: t.is_volume(),
            layers,
            mips: mips.min(most),
            format,
            usage: vk::ImageUsageFlags::empty(),
            history: t.history,
            transient: t.transient && !wanted.contains(name),
        });
    }
    list
}

pub(super) fn buffers(
    numbers: &mut Numbers<'_>,
    layouts: &Layouts<'_>,
    wanted: &[String],
    device: &DeviceInfo,
) -> Vec<BufferPlan> {
    let limit = device.limits.max_storage_buffer_range;
    let mut list = Vec::new();
    for (name, buffer) in &numbers.set.graph.buffers {
        let (before, buffer) = (numbers.errors.len(), &buffer.value);
        let bytes = match &buffer.size.value {
            BufferSize::Bytes(ex) => numbers.value(ex),
            BufferSize::Struct(count) => {
                // Linking reported mistakes. A block that no shader declares is not read.
                let size = layouts.struct_size(name, count.is_some()).ok().flatten();
                let elements = count.as_ref().map_or(0, |ex| numbers.count(ex, 1, "count"));
                size.map_or(4.0, |(bytes, stride)| {
                    f64::from(bytes) + f64::from(stride) * f64::from(elements)
                })
                .max(4.0)
            }
        };
        if numbers.errors.len() == before && !(4.0..=f64::from(limit)).contains(&bytes) {
            let message = format!(
                "buffer '{name}' is {bytes} bytes; {} allows 4 to {limit}",
                device.name
            );
            numbers.error(buffer.size.at, message);
        }
        // A buffer with a reported size counts as unlimited.
        let size = if numbers.errors.len() == before {
            bytes as u64
        } else {
            u64::MAX
        };
        let transient = buffer.transient && !wanted.contains(name);
        list.push(BufferPlan {
            size,
            used: false,
            history: buffer.history,
            transient,
        });
    }
    list
}
