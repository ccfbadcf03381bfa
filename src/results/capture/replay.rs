//! Renders a capture again and compares its pictures.

use super::manifest::{files_below, hash_file};
use super::{Image, Manifest, SOURCES, experiment_of, failed, render, scene_hash};
use crate::lab::{Lab, LabError, Texels};
use crate::results::picture;
use crate::scene::Scene;
use std::path::Path;
use std::sync::Arc;

/// A picture that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Path in the capture.
    pub file: String,
    /// Number of differing texels.
    pub texels: usize,
    /// Number of compared texels.
    pub of: usize,
    /// Largest difference of a channel: 0 to 255 in a PNG, linear in an EXR; infinite for NaN.
    pub largest: f64,
    /// Reason why it could not be compared.
    pub broken: Option<String>,
}

/// Differences between a capture and its replay.
#[derive(Clone, Debug, Default)]
pub struct Replay {
    pub images: usize,
    /// Number of compared texels.
    pub texels: usize,
    pub differences: Vec<Difference>,
    /// Other changes: program, device, driver, scene.
    pub changes: Vec<String>,
}

/// Files of a capture that were modified after it was taken.
pub fn changes(folder: &Path, manifest: &Manifest) -> Vec<String> {
    let mut list = Vec::new();
    for (file, hash) in &manifest.files {
        match hash_file(&folder.join(file)) {
            Ok(found) if found == *hash => {}
            Ok(_) => list.push(format!("{file} has changed since the capture")),
            Err(e) => list.push(format!("{file} cannot be read: {e}")),
        }
    }
    for file in files_below(&folder.join(SOURCES)).unwrap_or_default() {
        let file = format!("{SOURCES}/{file}");
        if !manifest.files.contains_key(&file) {
            list.push(format!("{file} has been added since the capture"));
        }
    }
    list
}

/// Renders a capture from the graph and shaders in its folder and compares every picture texel by
/// texel. `open` opens a scene by name or path. The new pictures are written below `output`, if
/// given.
///
/// # Errors
/// A capture that cannot be rendered.
pub fn replay(
    lab: &Lab,
    folder: &Path,
    manifest: &Manifest,
    open: impl FnOnce(&str) -> Result<Scene, LabError>,
    output: Option<&Path>,
) -> Result<Replay, LabError> {
    let experiment = experiment_of(folder, &manifest.experiment)?;
    let scene = experiment.adapted(Arc::new(open(&experiment.scene)?))?;
    let mut result = Replay::default();
    let info = &lab.gpu.info;
    for (what, was, is) in [
        ("program", &manifest.version, env!("CARGO_PKG_VERSION")),
        ("device", &manifest.device, info.name.as_str()),
        ("driver", &manifest.driver, info.driver.as_str()),
        ("scene", &manifest.scene.sha256, scene_hash(&scene).as_str()),
    ] {
        if was != is {
            result.changes.push(format!("{what}: was {was}, is {is}"));
        }
    }
    let frames = (Some(manifest.frames), manifest.step);
    let images = render(lab, folder, &experiment, scene, frames, |_| {
        Ok(manifest.images.clone())
    })?
    .images;
    for (image, texels) in &images {
        result.images += 1;
        result.texels += texels.extent.iter().product::<u32>() as usize;
        result.differences.extend(compare(folder, image, texels));
        if let Some(output) = output {
            picture::write(&output.join(&image.file), texels)?;
        }
    }
    Ok(result)
}

fn compare(folder: &Path, image: &Image, texels: &Texels) -> Option<Difference> {
    let path = folder.join(&image.file);
    let [width, height, depth] = texels.extent;
    let of = texels.extent.iter().product::<u32>() as usize;
    let (new, channels) = match image.file.ends_with(".png") {
        true => (
            picture::rgb8(texels)
                .into_iter()
                .map(f32::from)
                .collect::<Vec<f32>>(),
            3,
        ),
        false => (texels.floats().into_flattened(), 4),
    };
    let mut difference = Difference {
        file: image.file.clone(),
        texels: 0,
        of,
        largest: 0.0,
        broken: None,
    };
    let old = match picture::read(&path, (width, height * depth)) {
        Ok(old) => old,
        Err(e) => {
            difference.broken = Some(failed(&path, e).to_string());
            return Some(difference);
        }
    };
    for (a, b) in old.chunks_exact(channels).zip(new.chunks_exact(channels)) {
        let mut differs = false;
        for (a, b) in a.iter().zip(b).filter(|(a, b)| a.to_bits() != b.to_bits()) {
            differs = true;
            let distance = (f64::from(*a) - f64::from(*b)).abs();
            difference.largest = difference.largest.max(if distance.is_nan() {
                f64::INFINITY
            } else {
                distance
            });
        }
        difference.texels += usize::from(differs);
    }
    (difference.texels > 0).then_some(difference)
}
