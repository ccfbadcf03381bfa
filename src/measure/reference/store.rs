//! Sums of samples and their files: `sums-N.exr` with a layer per component and half, and
//! `reference.json`, which names the current one.

use super::{Reference, ReferencePart};
use crate::experiment::Experiment;
use crate::files::{check_input, hex, read_input};
use crate::graph::{Graph, LightPart};
use crate::lab::LabError;
use crate::metrics::{Kind, Linear, MetricError, Noise, relmse};
use crate::vulkan::DeviceInfo;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels,
    ReadLayers, Text, WritableImage,
};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

/// Samples per block; only whole blocks are saved.
pub const BLOCK: u64 = 32;

/// Version of `reference.json`.
pub const SCHEMA: &str = "conelab-reference-2";

/// The reference graph's texture with the sums of a component, one layer per half.
pub fn sum_texture(part: &str) -> String {
    format!("{part}Sum")
}

/// The content of `reference.json`.
#[derive(Debug, Deserialize, Serialize)]
struct Record {
    schema: String,
    /// File of the sums.
    sums: String,
    /// SHA-256 of that file, hexadecimal.
    sha256: String,
    samples: u64,
    size: (u32, u32),
    /// relMSE between the halves, by part.
    noise: BTreeMap<String, f64>,
    /// FLIP of the total against the converged reference, estimated; `None` in files of older
    /// versions.
    #[serde(default)]
    flip_noise: Option<f64>,
    /// Origin of the reference, for display.
    experiment: String,
    scene: String,
    params: BTreeMap<String, String>,
    device: String,
    driver: String,
}

impl Record {
    /// Whether the file with the sums belongs to this folder.
    fn names_sums(&self) -> bool {
        self.sums.starts_with("sums-") && !self.sums.contains(['/', '\\'])
    }
}

/// Sums over the samples of both halves.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Samples per pixel of both halves together; sample 0 and other even ones belong to half 0.
    pub samples: u64,
    /// Per component and half: RGB sum and sample count of every pixel.
    parts: BTreeMap<String, [Vec<[f32; 4]>; 2]>,
}

impl Sums {
    pub fn new(size: (u32, u32), parts: &[LightPart]) -> Sums {
        let pixels = size.0 as usize * size.1 as usize;
        let empty = |p: &LightPart| {
            (
                p.name.clone(),
                [vec![[0.0; 4]; pixels], vec![[0.0; 4]; pixels]],
            )
        };
        Sums {
            size,
            samples: 0,
            parts: parts.iter().map(empty).collect(),
        }
    }

    /// Adds the sums of a frame.
    pub fn add(&mut self, part: &str, half: usize, sums: &[[f32; 4]]) {
        if let Some(halves) = self.parts.get_mut(part) {
            halves[half]
                .par_iter_mut()
                .zip(sums)
                .for_each(|(sum, more)| {
                    for (s, m) in sum.iter_mut().zip(more) {
                        *s += m;
                    }
                });
        }
    }

    /// Mean of a component over the given halves.
    fn mean(&self, part: &str, kind: Kind, halves: &[usize]) -> Linear {
        let pixels = self.size.0 as usize * self.size.1 as usize;
        let mut sum = vec![[0f64; 4]; pixels];
        for half in self
            .parts
            .get(part)
            .into_iter()
            .flat_map(|p| halves.iter().map(|h| &p[*h]))
        {
            sum.par_iter_mut()
                .zip(half)
                .for_each(|(s, h)| (0..4).for_each(|i| s[i] += f64::from(h[i])));
        }
        let rgb = sum
            .par_iter()
            .map(|s| [0, 1, 2].map(|i| (s[i] / s[3].max(1.0)) as f32))
            .collect();
        Linear {
            size: self.size,
            rgb,
            kind,
        }
    }

    /// relMSE of the even samples' mean against that of the odd ones.
    pub fn relmse(&self, part: &str) -> Result<f64, LabError> {
        let [even, odd] = [0, 1].map(|half| self.mean(part, Kind::Radiance, &[half]));
        relmse(&even, &odd).map_err(|e| wrong(part, &e))
    }

    /// [`Self::relmse`] of all components.
    fn relmse_by_part(&self) -> Result<BTreeMap<String, f64>, LabError> {
        let names = self.parts.keys();
        names.map(|p| Ok((p.clone(), self.relmse(p)?))).collect()
    }

    /// The noise of the total. Takes seconds for large pictures, because of FLIP and structure.
    pub fn noise(&self) -> Result<Noise, LabError> {
        self.part("total", Kind::Radiance, false).map(|p| p.noise)
    }

    /// Mean and noise of a component; `halves` adds the means of the even and the odd samples.
    fn part(&self, name: &str, kind: Kind, halves: bool) -> Result<ReferencePart, LabError> {
        let [even, odd] = [0, 1].map(|half| self.mean(name, kind, &[half]));
        let mean = self.mean(name, kind, &[0, 1]);
        let noise = Noise::of_halves([&even, &odd], &mean).map_err(|e| wrong(name, &e))?;
        Ok(ReferencePart {
            mean,
            noise,
            halves: halves.then_some([even, odd]),
        })
    }

    /// Means and noise of all components; `halves` adds the means of the even and the odd samples.
    pub fn reference(
        &self,
        graph: &Graph,
        folder: &Path,
        halves: bool,
    ) -> Result<Reference, LabError> {
        let part = |LightPart { name, kind, .. }: &LightPart| {
            Ok((name.clone(), self.part(name, *kind, halves)?))
        };
        let parts = graph
            .parts
            .iter()
            .map(part)
            .collect::<Result<_, LabError>>()?;
        Ok(Reference {
            size: self.size,
            samples: self.samples,
            parts,
            folder: folder.to_path_buf(),
        })
    }
}

fn wrong(part: &str, why: &MetricError) -> LabError {
    LabError::Request(format!("the reference's '{part}': {why}"))
}

fn failed(path: &Path, why: impl std::fmt::Display) -> LabError {
    LabError::Request(format!("reference '{}': {why}", path.display()))
}

/// Writes sums into a folder and replaces those that `reference.json` names.
pub(super) fn write(
    folder: &Path,
    sums: &Sums,
    traced: &Experiment,
    device: &DeviceInfo,
) -> Result<(), LabError> {
    let name = format!("sums-{}.exr", sums.samples);
    let file = folder.join(&name);
    let bytes = encode(sums).map_err(|e| failed(&file, e))?;
    crate::files::write_whole(&file, &bytes)?;
    let record = Record {
        schema: SCHEMA.into(),
        sums: name,
        sha256: hex(&Sha256::digest(&bytes)),
        samples: sums.samples,
        size: sums.size,
        noise: sums.relmse_by_part()?,
        flip_noise: Some(sums.noise()?.flip),
        experiment: traced.name.clone(),
        scene: traced.scene.clone(),
        params: traced
            .params
            .iter()
            .map(|(n, v)| (n.value.clone(), v.clone()))
            .collect(),
        device: device.name.clone(),
        driver: device.driver.clone(),
    };
    let json = folder.join("reference.json");
    let text = serde_json::to_vec_pretty(&record).map_err(|e| failed(&json, e))?;
    let replaced = read_record(&json).ok().flatten();
    crate::files::write_whole(&json, &text)?;
    // Other sums may belong to a process that has not written its reference.json yet. A file that
    // cannot be deleted only costs space.
    if let Some(old) = replaced.filter(|old| old.names_sums() && old.sums != record.sums) {
        let _ = std::fs::remove_file(folder.join(old.sums));
    }
    Ok(())
}

fn encode(sums: &Sums) -> Result<Vec<u8>, exr::error::Error> {
    let size = (sums.size.0 as usize, sums.size.1 as usize);
    let mut layers = exr::prelude::SmallVec::new();
    for (part, halves) in &sums.parts {
        for (half, texels) in halves.iter().enumerate() {
            let channel = |name: &str, i: usize| {
                AnyChannel::new(
                    name,
                    FlatSamples::F32(texels.iter().map(|t| t[i]).collect()),
                )
            };
            let list = [("R", 0), ("G", 1), ("B", 2), ("A", 3)].map(|(name, i)| channel(name, i));
            let attributes = LayerAttributes::named(format!("{part}.{half}").as_str());
            layers.push(Layer::new(
                size,
                attributes,
                Encoding::FAST_LOSSLESS,
                AnyChannels::sort(list.into_iter().collect()),
            ));
        }
    }
    let mut out = Cursor::new(Vec::new());
    let window = exr::meta::header::ImageAttributes::with_size(size);
    // Parallel compression would write chunks in varying order; equal sums must give equal files.
    Image::from_layers(window, layers)
        .write()
        .non_parallel()
        .to_buffered(&mut out)?;
    Ok(out.into_inner())
}

/// `reference.json` of a folder; `None` without one.
fn read_record(json: &Path) -> Result<Option<Record>, LabError> {
    let Ok(text) = read_input(json, MAX_JSON) else {
        return Ok(None);
    };
    serde_json::from_slice(&text)
        .map(Some)
        .map_err(|e| failed(json, format!("{e}; delete the folder")))
}

impl Sums {
    /// Reads the content of an EXR with these parts, this size and number of samples.
    fn read(&mut self, bytes: &[u8]) -> Result<(), String> {
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), false);
        let headers = meta.map_err(|e| e.to_string())?.headers;
        // Before the texels, because sizes decide the memory.
        let size = (self.size.0 as usize, self.size.1 as usize);
        let fits = |h: &Header| {
            (h.layer_size.width(), h.layer_size.height()) == size && h.channels.list.len() == 4
        };
        if headers.len() != 2 * self.parts.len() || !headers.iter().all(fits) {
            return Err("its layers are not those of the reference graph".into());
        }
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .map_err(|e| e.to_string())?;
        for (part, halves) in &mut self.parts {
            for (half, texels) in halves.iter_mut().enumerate() {
                let name = format!("{part}.{half}");
                let named = |n: &Text| *n == *name.as_str();
                let mut layers = image.layer_data.iter();
                let layer = layers.find(|l| l.attributes.layer_name.as_ref().is_some_and(named));
                let layer = layer.ok_or_else(|| format!("it has no layer '{name}'"))?;
                for (channel, i) in [("R", 0), ("G", 1), ("B", 2), ("A", 3)] {
                    let found = layer.channel_data.list.iter().find(|c| c.name == *channel);
                    let Some(FlatSamples::F32(values)) = found.map(|c| &c.sample_data) else {
                        let what = "of 32-bit floats";
                        return Err(format!("layer '{name}' has no channel {channel} {what}"));
                    };
                    texels.iter_mut().zip(values).for_each(|(t, v)| t[i] = *v);
                }
            }
        }
        let count = self.samples as f64;
        let counted =
            |texels: &Vec<[f32; 4]>| texels.iter().all(|t| f64::from(t[3]) * 2.0 == count);
        match self.parts.values().flatten().all(counted) {
            true => Ok(()),
            false => Err("it does not hold as many samples as reference.json says".into()),
        }
    }
}

/// The sums in a folder; `None` without `reference.json` or without the file that it names.
pub(super) fn read(
    folder: &Path,
    size: (u32, u32),
    graph: &Graph,
) -> Result<Option<Sums>, LabError> {
    let json = folder.join("reference.json");
    let Some(record) = read_record(&json)? else {
        return Ok(None);
    };
    if record.schema != SCHEMA || record.size != size || !record.names_sums() {
        return Err(failed(
            &json,
            "it is not what this program wrote; delete the folder",
        ));
    }
    let file = folder.join(&record.sums);
    // Another process may have deleted them after replacing these sums.
    if std::fs::symlink_metadata(&file).is_err_and(|e| e.kind() == std::io::ErrorKind::NotFound) {
        return Ok(None);
    }
    let wrong = |why: &str| failed(&file, format!("{why}; delete the folder"));
    let bytes = read_bounded(&file, size, graph.parts.len()).map_err(|e| wrong(&e))?;
    if hex(&Sha256::digest(&bytes)) != record.sha256 {
        return Err(wrong("its content does not match its checksum"));
    }
    let mut sums = Sums::new(size, &graph.parts);
    sums.samples = record.samples;
    sums.read(&bytes).map_err(|e| wrong(&e))?;
    keep_noise(&json, record, &sums)?;
    Ok(Some(sums))
}

/// Updates the noise in the description, if it differs. Nothing depends on the stored value.
fn keep_noise(json: &Path, mut record: Record, sums: &Sums) -> Result<(), LabError> {
    let noise = sums.relmse_by_part()?;
    let same = |a: f64, b: f64| {
        a == b || (a - b).abs() <= 1e-9 * a.abs().max(b.abs()) || a.is_nan() && b.is_nan()
    };
    let kept = noise.iter().all(|(part, value)| {
        record
            .noise
            .get(part)
            .is_some_and(|told| same(*told, *value))
    });
    if kept && noise.len() == record.noise.len() && record.flip_noise.is_some() {
        return Ok(());
    }
    record.noise = noise;
    record.flip_noise = Some(sums.noise()?.flip);
    let text = serde_json::to_vec_pretty(&record).map_err(|e| failed(json, e))?;
    // A read-only folder keeps the old value.
    let _ = crate::files::write_whole(json, &text);
    Ok(())
}

/// Larger descriptions are invalid (bytes).
const MAX_JSON: u64 = 16 << 20;

/// Reads a file, unless it is larger than the sums of `parts` components.
fn read_bounded(file: &Path, size: (u32, u32), parts: usize) -> Result<Vec<u8>, String> {
    let texels = u64::from(size.0) * u64::from(size.1) * 2 * parts as u64;
    let length = check_input(file, u64::MAX).map_err(|e| e.to_string())?;
    // Compression may enlarge noise slightly.
    let most = texels * 32 + (1 << 20);
    if length > most {
        return Err(format!("it has {length} bytes, more than its samples take"));
    }
    read_input(file, most).map_err(|e| e.to_string())
}
