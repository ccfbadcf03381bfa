//! Comparison of pictures with a reference, by light component and region (`docs/metrics.md`).

mod table;
mod verdict;

pub use table::table;
pub use verdict::Verdict;

use crate::metrics::maps::{MapFile, maps};
use crate::metrics::region::{Region, regions};
use crate::metrics::{Compared, Kind, Linear, MetricError, Noise, RELMSE, Scores, within_noise};
use serde::Serialize;
use std::collections::BTreeMap;

/// Version of the JSON schema.
pub const SCHEMA: &str = "conelab-compare-1";

/// Name of the region that covers the whole picture.
pub const FRAME: &str = "frame";

/// A picture split into light components.
#[derive(Clone, Debug)]
pub struct Side {
    /// Name of the picture.
    pub name: String,
    /// Light components; an unsplit picture has only `total`.
    pub parts: BTreeMap<String, Linear>,
    /// Noise of each component, if known.
    pub noise: BTreeMap<String, Noise>,
}

impl Side {
    /// Parts without noise.
    pub fn new(name: impl Into<String>, parts: BTreeMap<String, Linear>) -> Side {
        Side {
            name: name.into(),
            parts,
            noise: BTreeMap::new(),
        }
    }

    /// Whether it is display-referred.
    fn displayed(&self) -> bool {
        self.parts.values().any(|p| p.kind == Kind::Displayed)
    }
}

/// One or two pictures compared with a reference; the content of `--json`.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// [`SCHEMA`].
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Names of the pictures: A, and optionally B.
    pub pictures: Vec<String>,
    /// Name of the reference.
    pub reference: String,
    /// Whether the pictures are display-referred: all numbers then refer to the displayed range 0
    /// to 1.
    pub displayed: bool,
    /// Components that all pictures have.
    pub parts: Vec<PartComparison>,
}

/// Comparison of a light component.
#[derive(Clone, Debug, Serialize)]
pub struct PartComparison {
    /// Name of the part.
    pub part: String,
    /// relMSE between the halves of the reference's samples.
    pub noise: Option<f64>,
    /// FLIP caused by the reference's noise alone.
    pub flip_noise: Option<f64>,
    /// Structure error caused by the reference's noise alone (natural log units).
    pub structure_noise: Option<f64>,
    /// First and last exposure of HDR-FLIP, stops.
    pub exposures: [f64; 2],
    /// Number of exposures.
    pub exposure_count: u32,
    /// The whole frame, then the regions.
    pub regions: Vec<RegionComparison>,
}

/// Comparison of a region of a component.
#[derive(Clone, Debug, Serialize)]
pub struct RegionComparison {
    /// Name; [`FRAME`] is the whole picture.
    pub region: String,
    /// Fraction of the frame, 0 to 1.
    pub share: f64,
    /// Scores of each picture; `None` if the region has no finite pixel.
    pub scores: Vec<Option<Scores>>,
    /// Whether each picture's relMSE is below four times the noise, so that it is indistinguishable
    /// from the reference.
    pub within_noise: Vec<bool>,
    /// The better of two pictures by metric.
    pub better: BTreeMap<&'static str, Verdict>,
}

/// Receives the maps of a picture (0 is A) and component.
pub type TakeMaps<'a> = dyn FnMut(usize, &str, Vec<MapFile>) -> Result<(), MetricError> + 'a;

/// The options of a comparison.
pub struct Request<'a> {
    /// Components to compare; empty means all.
    pub parts: &'a [String],
    /// Regions in addition to those derived from the reference.
    pub masks: &'a [Region],
    /// Receiver of maps; `None` computes none.
    pub maps: Option<&'a mut TakeMaps<'a>>,
}

/// Pictures for a display are compared with each other, as is radiance.
fn check_kinds(pictures: &[Side], reference: &Side) -> Result<(), MetricError> {
    let differs = |p: &&Side| p.displayed() != reference.displayed();
    if let Some(other) = pictures.iter().find(differs) {
        let (shown, radiance) = match other.displayed() {
            true => (other, reference),
            false => (reference, other),
        };
        return Err(MetricError(format!(
            "'{}' was made for a display and '{}' is radiance; compare an .exr with an .exr, or a .png with a .png",
            shown.name, radiance.name
        )));
    }
    Ok(())
}

/// Compares one or two pictures with a reference.
///
/// # Errors
/// Display-referred pictures mixed with radiance; missing components; different sizes.
pub fn compare(
    pictures: &[Side],
    reference: &Side,
    mut request: Request,
) -> Result<Comparison, MetricError> {
    check_kinds(pictures, reference)?;
    let names = part_names(pictures, reference, request.parts)?;
    let mut areas = regions(&reference.parts);
    areas.extend_from_slice(request.masks);
    let mut parts = Vec::new();
    let mut size = (0, 0);
    for part in names {
        let Some(expected) = reference.parts.get(&part) else {
            continue;
        };
        let pixels = expected.rgb.len();
        if let Some(area) = areas.iter().find(|a| a.mask.len() != pixels) {
            let (w, h) = expected.size;
            return Err(MetricError(format!(
                "the mask '{}' does not have the pictures' size of {w}x{h}",
                area.name
            )));
        }
        size = expected.size;
        let mut compared = Vec::new();
        for (i, picture) in pictures.iter().enumerate() {
            let Some(test) = picture.parts.get(&part) else {
                continue;
            };
            let with = Compared::new(test, expected).map_err(|e| {
                MetricError(format!("'{}' and '{}': {e}", picture.name, reference.name))
            })?;
            if let Some(take) = &mut request.maps {
                take(i, &part, maps(&with)?)?;
            }
            compared.push(with);
        }
        let noise = reference.noise.get(&part).copied();
        parts.push(compare_part(&part, &compared, noise, &areas));
    }
    Ok(Comparison {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        size: size.into(),
        pictures: pictures.iter().map(|p| p.name.clone()).collect(),
        reference: reference.name.clone(),
        displayed: reference.displayed(),
        parts,
    })
}

/// The components to compare: the total, then by kind and name.
fn part_names(
    pictures: &[Side],
    reference: &Side,
    wanted: &[String],
) -> Result<Vec<String>, MetricError> {
    let everywhere = |part: &&String| pictures.iter().all(|p| p.parts.contains_key(*part));
    let mut common: Vec<String> = reference.parts.keys().filter(everywhere).cloned().collect();
    common.sort_by_key(|part| (part != "total", reference.parts.get(part).map(|p| p.kind)));
    if let Some(missing) = wanted.iter().find(|w| !common.contains(w)) {
        return Err(MetricError(format!(
            "there is no part '{missing}' in all pictures; they have: {}",
            common.join(", ")
        )));
    }
    if common.is_empty() {
        return Err(MetricError("the pictures have no part in common".into()));
    }
    common.retain(|part| wanted.is_empty() || wanted.contains(part));
    Ok(common)
}

fn compare_part(
    part: &str,
    compared: &[Compared],
    noise: Option<Noise>,
    areas: &[Region],
) -> PartComparison {
    let region = |name: &str, share: f64, mask: Option<&[bool]>| {
        let scores: Vec<Option<Scores>> = compared.iter().map(|c| c.scores(mask)).collect();
        let better = match &scores[..] {
            [Some(a), Some(b)] => verdict::better(a, b, noise),
            _ => BTreeMap::new(),
        };
        let within = |s: &Option<Scores>| {
            s.as_ref()
                .is_some_and(|s| within_noise(s.get(RELMSE), noise.map(|n| n.relmse)))
        };
        let within_noise = scores.iter().map(within).collect();
        RegionComparison {
            region: name.into(),
            share,
            scores,
            within_noise,
            better,
        }
    };
    let mut list = vec![region(FRAME, 1.0, None)];
    list.extend(
        areas
            .iter()
            .map(|a| region(&a.name, a.share(), Some(&a.mask))),
    );
    let exposures = compared.first().map(Compared::exposures);
    PartComparison {
        part: part.into(),
        noise: noise.map(|n| n.relmse),
        flip_noise: noise.map(|n| n.flip),
        structure_noise: noise.map(|n| n.structure),
        exposures: exposures.map_or([0.0; 2], |e| [e.start, e.stop]),
        exposure_count: exposures.map_or(0, |e| e.count),
        regions: list,
    }
}
