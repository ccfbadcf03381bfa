//! Picture files: PNG for display-encoded, EXR for linear values.

use crate::diagnostics::excerpt::excerpt;
use crate::diagnostics::panics::caught;
use crate::experiment::MAX_SIZE;
use crate::files::{FileError, check_input, ending};
use crate::lab::{LabError, Texels};
use crate::metrics::colour::srgb_to_linear;
use crate::metrics::{Kind, Linear, MAX_PIXELS};
use crate::vulkan::Format;
use exr::prelude::{
    AnyChannel, AnyChannels, FlatSamples, Image as ExrImage, Layer, LayerAttributes, WritableImage,
    read_first_rgba_layer_from_file,
};
use std::io::Cursor;
use std::path::Path;

/// Files larger than this are refused.
const MAX_BYTES: u64 = 2 << 30;

/// Writes a PNG (8 bits; floats are clamped, not tone-mapped) or an EXR (32-bit floats), by the
/// path's extension. The write is atomic.
///
/// # Errors
/// Another extension; a folder that is not writable.
pub fn write(path: &Path, texels: &Texels) -> Result<(), LabError> {
    let bytes = match ending(path).as_str() {
        "png" => png(texels)?,
        "exr" => exr(texels)?,
        _ => {
            return Err(FileError::content(
                path,
                "give the output a name that ends in .png or .exr",
            )
            .into());
        }
    };
    Ok(crate::files::write_whole(path, &bytes)?)
}

/// Texels as the RGB bytes of a PNG.
pub fn rgb8(texels: &Texels) -> Vec<u8> {
    let rgba: Vec<u8> = if texels.format.name.starts_with("rgba8") {
        texels.bytes.clone()
    } else {
        texels
            .floats()
            .iter()
            .flatten()
            .map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
            .collect()
    };
    // Alpha of a picture is not transparency.
    rgba.chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect()
}

/// Texels as a PNG file (8 bits; floats are clamped, not tone-mapped).
pub fn png(texels: &Texels) -> Result<Vec<u8>, LabError> {
    let (width, height) = texels.flat_size();
    let rgb = rgb8(texels);
    let mut out = Cursor::new(Vec::new());
    image::write_buffer_with_format(
        &mut out,
        &rgb,
        width,
        height,
        image::ColorType::Rgb8,
        image::ImageFormat::Png,
    )
    .map_err(LabError::making("the PNG"))?;
    Ok(out.into_inner())
}

/// Writes a linear picture as an EXR (32-bit floats).
///
/// # Errors
/// An extension other than .exr; a folder that is not writable.
pub fn write_linear(path: &Path, picture: &Linear) -> Result<(), LabError> {
    let texels: Vec<[f32; 4]> = picture
        .rgb
        .iter()
        .map(|[r, g, b]| [*r, *g, *b, 1.0])
        .collect();
    let format =
        Format::named("rgba32f").ok_or_else(|| LabError::Request("no format rgba32f".into()))?;
    let extent = [picture.size.0, picture.size.1, 1];
    if ending(path) != "exr" {
        return Err(LabError::Request(format!(
            "'{}': give it a name that ends in .exr",
            path.display()
        )));
    }
    write(
        path,
        &Texels {
            extent,
            format,
            bytes: bytemuck::cast_slice(&texels).to_vec(),
        },
    )
}

/// Texels as an EXR file (32-bit floats).
pub fn exr(texels: &Texels) -> Result<Vec<u8>, LabError> {
    let (width, height) = texels.flat_size();
    let floats = texels.floats();
    let channel = |name: &str, i: usize| {
        AnyChannel::new(
            name,
            FlatSamples::F32(floats.iter().map(|p| p[i]).collect()),
        )
    };
    // EXR stores channels in alphabetical order.
    let channels = AnyChannels::sort(
        ["A", "B", "G", "R"]
            .iter()
            .zip([3, 2, 1, 0])
            .map(|(n, i)| channel(n, i))
            .collect(),
    );
    let size = (width as usize, height as usize);
    let layer = Layer::new(
        size,
        LayerAttributes::default(),
        exr::prelude::Encoding::SMALL_LOSSLESS,
        channels,
    );
    let mut out = Cursor::new(Vec::new());
    ExrImage::from_layer(layer)
        .write()
        .to_buffered(&mut out)
        .map_err(LabError::making("the EXR"))?;
    Ok(out.into_inner())
}

/// Reads a picture of the given size: three channels (0 to 255) per texel of a PNG, four of an EXR.
///
/// # Errors
/// A missing or damaged file; another size.
pub fn read(path: &Path, size: (u32, u32)) -> Result<Vec<f32>, String> {
    check_input(path, MAX_BYTES).map_err(|e| e.to_string())?;
    caught(|| decode_of(path, size)).flatten()
}

fn decode_of(path: &Path, size: (u32, u32)) -> Result<Vec<f32>, String> {
    let other = |w: usize, h: usize| format!("its size is {w}x{h}, not {}x{}", size.0, size.1);
    if path.extension().is_some_and(|e| e == "png") {
        let open = || image::ImageReader::open(path)?.with_guessed_format();
        let (w, h) = open()
            .map_err(|e| e.to_string())?
            .into_dimensions()
            .map_err(|e| e.to_string())?;
        if (w, h) != size {
            return Err(other(w as usize, h as usize));
        }
        let image = open()
            .map_err(|e| e.to_string())?
            .decode()
            .map_err(|e| e.to_string())?;
        return Ok(image
            .to_rgb8()
            .as_raw()
            .iter()
            .map(|v| f32::from(*v))
            .collect());
    }
    let layer = exr_size(path)?;
    if layer != (size.0 as usize, size.1 as usize) {
        return Err(other(layer.0, layer.1));
    }
    Ok(read_exr(path)?.into_flattened())
}

/// Width and height of an EXR from its headers, before memory is allocated.
fn exr_size(path: &Path) -> Result<(usize, usize), String> {
    let meta = exr::meta::MetaData::read_from_file(path, false).map_err(|e| e.to_string())?;
    let size = meta
        .headers
        .first()
        .map_or(exr::math::Vec2(0, 0), |h| h.layer_size);
    let names = |h: &exr::meta::header::Header| {
        h.channels
            .list
            .iter()
            .map(|c| c.name.to_string())
            .collect::<Vec<_>>()
    };
    if !meta.headers.iter().any(|h| {
        ["R", "G", "B"]
            .iter()
            .all(|c| names(h).iter().any(|n| n == c))
    }) {
        return Err(other_channels(
            &meta.headers.iter().flat_map(names).collect::<Vec<_>>(),
        ));
    }
    // The layer with the colours is known only after reading.
    match meta.headers.iter().all(|h| h.layer_size == size) {
        true => Ok((size.width(), size.height())),
        false => Err("its layers have different sizes".into()),
    }
}

/// Channels listed in a message.
const SHOWN: usize = 8;

/// Blender's multilayer files name the colours "ViewLayer.Combined.R" and so on; grey pictures have
/// "Y".
fn other_channels(names: &[String]) -> String {
    let more = if names.len() > SHOWN {
        format!(" and {} more", names.len() - SHOWN)
    } else {
        String::new()
    };
    let list = names
        .iter()
        .take(SHOWN)
        .map(|n| excerpt(n, 60))
        .collect::<Vec<_>>()
        .join(", ");
    let red = names
        .iter()
        .find(|n| n.ends_with(".Combined.R"))
        .or(names.iter().find(|n| n.ends_with(".R")));
    let prefix = red
        .and_then(|n| n.strip_suffix('R'))
        .map(|prefix| excerpt(prefix, 60));
    let way = match (prefix, names.iter().any(|n| n == "Y")) {
        (Some(p), _) => format!("oiiotool IN.exr --ch R={p}R,G={p}G,B={p}B -o OUT.exr"),
        (None, true) => "oiiotool IN.exr --ch R=Y,G=Y,B=Y -o OUT.exr".into(),
        _ => "write it as OpenEXR with one layer".into(),
    };
    format!("it has no channels R, G and B, but {list}{more}. Convert it: {way}")
}

fn read_exr(path: &Path) -> Result<Vec<[f32; 4]>, String> {
    let image = read_first_rgba_layer_from_file(
        path,
        |size, _| (size.width(), vec![[0.0f32; 4]; size.area()]),
        |(width, texels): &mut (usize, Vec<[f32; 4]>), at, (r, g, b, a): (f32, f32, f32, f32)| {
            texels[at.y() * *width + at.x()] = [r, g, b, a];
        },
    )
    .map_err(|e| e.to_string())?;
    Ok(image.layer_data.channel_data.pixels.1)
}

/// Reads a picture of at most `MAX_PIXELS` as linear RGB: radiance from an EXR or HDR, decoded
/// sRGB from a PNG.
///
/// # Errors
/// Another extension; a missing, damaged or too large file.
pub fn read_linear(path: &Path) -> Result<Linear, LabError> {
    let failed = |why: String| LabError::from(FileError::read(path, why));
    check_input(path, MAX_BYTES).map_err(|e| failed(e.to_string()))?;
    caught(|| decode_linear(path)).map_err(failed).flatten()
}

fn decode_linear(path: &Path) -> Result<Linear, LabError> {
    let failed = |why: String| LabError::from(FileError::read(path, why));
    let fits = |w: usize, h: usize| match w.saturating_mul(h) as u64 {
        1..=MAX_PIXELS if w <= MAX_SIZE as usize && h <= MAX_SIZE as usize => {
            Ok((w as u32, h as u32))
        }
        _ => Err(failed(format!(
            "its size is {w}x{h}; at most {MAX_SIZE} a side and {MAX_PIXELS} pixels can be read"
        ))),
    };
    let ending = ending(path);
    if ending == "exr" {
        let (w, h) = exr_size(path).map_err(failed)?;
        let size = fits(w, h)?;
        let rgb = read_exr(path)
            .map_err(failed)?
            .iter()
            .map(|t| [t[0], t[1], t[2]])
            .collect();
        return Ok(Linear::radiance(size, rgb));
    }
    if ending != "png" && ending != "hdr" {
        return Err(failed("a picture ends in .exr, .hdr or .png".into()));
    }
    let open = || image::ImageReader::open(path)?.with_guessed_format();
    let (w, h) = open()
        .map_err(|e| failed(e.to_string()))?
        .into_dimensions()
        .map_err(|e| failed(e.to_string()))?;
    let size = fits(w as usize, h as usize)?;
    let mut reader = open().map_err(|e| failed(e.to_string()))?;
    // The size has been checked; the reader's own limit would refuse large floats.
    reader.no_limits();
    let mut rgb: Vec<[f32; 3]> = reader
        .decode()
        .map_err(|e| failed(e.to_string()))?
        .to_rgb32f()
        .pixels()
        .map(|p| p.0)
        .collect();
    if ending == "hdr" {
        return Ok(Linear::radiance(size, rgb));
    }
    rgb.iter_mut().for_each(|c| *c = c.map(srgb_to_linear));
    Ok(Linear {
        size,
        rgb,
        kind: Kind::Displayed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(names: &[&str]) -> Result<Linear, LabError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![0.5; 4]));
        let channels = AnyChannels::sort(names.iter().map(channel).collect());
        let layer = Layer::new(
            (2, 2),
            LayerAttributes::default(),
            exr::prelude::Encoding::SMALL_LOSSLESS,
            channels,
        );
        ExrImage::from_layer(layer).write().to_file(&path).unwrap();
        read_linear(&path)
    }

    #[test]
    fn pictures_of_other_channels_name_them_and_a_way_on() {
        assert_eq!(
            written(&["R", "G", "B", "sampleCount.R"]).unwrap().rgb[0],
            [0.5; 3]
        );
        let blender = [
            "ViewLayer.Combined.A",
            "ViewLayer.Combined.B",
            "ViewLayer.Combined.G",
            "ViewLayer.Combined.R",
        ];
        let way = "R=ViewLayer.Combined.R,G=ViewLayer.Combined.G,B=ViewLayer.Combined.B";
        for (names, pieces) in [
            (&blender[..], ["but ViewLayer.Combined.A, ", way]),
            (&["Y"], ["but Y. ", "R=Y,G=Y,B=Y"]),
        ] {
            let message = written(names).unwrap_err().to_string();
            assert!(pieces.iter().all(|p| message.contains(p)), "{message}");
        }
    }
}
