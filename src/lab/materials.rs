//! Material textures as a few 2D arrays, one for each size and format: works without descriptor
//! indexing.

use super::interface::MATERIAL_TEXTURES;
use crate::scene::{
    Lookup, MAX_TEXTURE_KINDS, SHARED_EDGE, Scene, Texture, TextureFormat, TextureKind, Wrap,
    keep_their_size,
};
use crate::vulkan::{Gpu, Image, ImageDesc, Result, Upload, View, ViewDesc, vk};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A handle as shaders see it, of no texture.
const NO_TEXTURE: u32 = u32::MAX;

/// There is an array for each kind that a scene keeps.
const _: () = assert!(MAX_TEXTURE_KINDS == MATERIAL_TEXTURES.len());

/// The arrays, the handle of each texture, and bytes on the device.
pub(super) struct MaterialTextures {
    pub views: Vec<Arc<View>>,
    /// slot << 16 | layer.
    handles: Vec<u32>,
    /// Whether the sampler filters anisotropically.
    anisotropic: bool,
    pub bytes: u64,
}

impl MaterialTextures {
    /// A texture and how it is looked up, as `materials/materials.glsl` unpacks it.
    pub fn handle(&self, texture: Option<u32>, lookup: Lookup) -> u32 {
        let Some(handle) = texture.and_then(|t| self.handles.get(t as usize)) else {
            return NO_TEXTURE;
        };
        let [u, v] = lookup.wrap.map(|wrap| match wrap {
            Wrap::Repeat => 0,
            Wrap::Clamp => 1,
            Wrap::Mirror => 2,
        });
        let flags = [lookup.nearest, lookup.second_set, self.anisotropic].map(u32::from);
        handle | u << 20 | v << 22 | flags[0] << 24 | flags[1] << 25 | flags[2] << 26
    }
}

pub(super) fn upload(
    gpu: &Arc<Gpu>,
    scene: &Scene,
    upload: &mut Upload,
) -> Result<MaterialTextures> {
    let textures = fit(scene, gpu.info.features.bc);
    let mut classes: BTreeMap<TextureKind, Vec<usize>> = BTreeMap::new();
    for (i, texture) in textures.iter().enumerate() {
        classes.entry(texture.kind()).or_default().push(i);
    }
    let mut out = MaterialTextures {
        views: Vec::new(),
        handles: vec![NO_TEXTURE; textures.len()],
        anisotropic: gpu.info.features.anisotropy,
        bytes: 0,
    };
    for (slot, ((width, height, mips, format), members)) in (0u32..).zip(&classes) {
        let parts: Vec<Vec<&[u8]>> = members
            .iter()
            .map(|m| textures[*m].mips.iter().map(Vec::as_slice).collect())
            .collect();
        for (layer, member) in (0u32..).zip(members) {
            out.handles[*member] = slot << 16 | layer;
        }
        add(
            gpu,
            upload,
            &mut out,
            [*width, *height],
            *mips,
            vulkan_format(*format),
            &parts,
        )?;
    }
    while out.views.len() < MATERIAL_TEXTURES.len() {
        add(
            gpu,
            upload,
            &mut out,
            [1, 1],
            1,
            vk::Format::R8G8B8A8_UNORM,
            &[vec![&[255; 4]]],
        )?;
    }
    Ok(out)
}

fn add(
    gpu: &Arc<Gpu>,
    upload: &mut Upload,
    out: &mut MaterialTextures,
    [width, height]: [u32; 2],
    mips: u32,
    format: vk::Format,
    parts: &[Vec<&[u8]>],
) -> Result<()> {
    let layers = u32::try_from(parts.len()).unwrap_or(u32::MAX);
    let desc = ImageDesc {
        name: format!("materialTexture{}", out.views.len()),
        extent: [width, height, 1],
        volume: false,
        layers,
        mips,
        format,
        views: vec![],
        usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
    };
    let image = Arc::new(Image::new(gpu, desc)?);
    upload.image(&image, parts)?;
    out.bytes += image.bytes;
    let desc = ViewDesc {
        kind: vk::ImageViewType::TYPE_2D_ARRAY,
        format,
        aspect: vk::ImageAspectFlags::COLOR,
        mips: (0, mips),
        layers: (0, layers),
        usage: vk::ImageUsageFlags::SAMPLED,
    };
    out.views.push(Arc::new(View::new(&image, &desc)?));
    Ok(())
}

/// Textures of at most as many kinds as there are arrays: the rarest are resampled to one common
/// size.
fn fit(scene: &Scene, bc: bool) -> Vec<Cow<'_, Texture>> {
    let mut list: Vec<Cow<'_, Texture>> = scene
        .textures
        .iter()
        .map(|t| {
            if t.format.is_compressed() && !bc {
                Cow::Owned(t.resampled(t.width, t.height))
            } else {
                Cow::Borrowed(t)
            }
        })
        .collect();
    let kinds: Vec<TextureKind> = list.iter().map(|t| t.kind()).collect();
    for (texture, keeps) in list.iter_mut().zip(keep_their_size(&kinds)) {
        if !keeps {
            *texture = Cow::Owned(texture.resampled(SHARED_EDGE, SHARED_EDGE));
        }
    }
    list
}

fn vulkan_format(format: TextureFormat) -> vk::Format {
    match format {
        TextureFormat::Rgba8Srgb => vk::Format::R8G8B8A8_SRGB,
        TextureFormat::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
        TextureFormat::Bc1Srgb => vk::Format::BC1_RGBA_SRGB_BLOCK,
        TextureFormat::Bc1Unorm => vk::Format::BC1_RGBA_UNORM_BLOCK,
        TextureFormat::Bc2Srgb => vk::Format::BC2_SRGB_BLOCK,
        TextureFormat::Bc2Unorm => vk::Format::BC2_UNORM_BLOCK,
        TextureFormat::Bc3Srgb => vk::Format::BC3_SRGB_BLOCK,
        TextureFormat::Bc3Unorm => vk::Format::BC3_UNORM_BLOCK,
        TextureFormat::Bc4Unorm => vk::Format::BC4_UNORM_BLOCK,
        TextureFormat::Bc5Unorm => vk::Format::BC5_UNORM_BLOCK,
        TextureFormat::Bc7Srgb => vk::Format::BC7_SRGB_BLOCK,
        TextureFormat::Bc7Unorm => vk::Format::BC7_UNORM_BLOCK,
    }
}
