//! Functions without a lab: pictures, metrics, devices.

use crate::errors::{exception, raised};
use crate::memory::Memory;
use crate::reference::word;
use conelab::lab::{LabError, Texels, Workspace};
use conelab::measure::comparison::{Request, Side, compare as compared};
use conelab::metrics::colour::display;
use conelab::metrics::maps::{self, layers};
use conelab::metrics::region::Region;
use conelab::metrics::{Best, Compared, Kind, Linear, METRICS, Noise};
use conelab::results::picture;
use conelab::scene::builtin;
use conelab::vulkan::{Format, list_devices};
use pyo3::Bound;
use pyo3::prelude::{PyResult, Python, pyfunction};
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The version of the program.
#[pyfunction]
pub fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// Name, kind, driver, API, and why it cannot be used.
type Device = (String, String, String, String, Option<String>);

/// The devices.
#[pyfunction]
pub fn devices(py: Python<'_>) -> PyResult<Vec<Device>> {
    let list = py
        .detach(list_devices)
        .map_err(|error| exception(error.into()))?;
    let entry = |(info, refused): (conelab::vulkan::DeviceInfo, Option<String>)| {
        (
            info.name.clone(),
            info.kind.to_string(),
            info.driver,
            info.api,
            refused,
        )
    };
    Ok(list.into_iter().map(entry).collect())
}

/// Parameters of a graph as JSON, at their defaults. Needs no device.
#[pyfunction]
pub fn graph_params(home: PathBuf, graph: &str) -> PyResult<String> {
    let home = Workspace::at(home).map_err(exception)?;
    let graph = home
        .read(graph)
        .map_err(|list| exception(LabError::Input(list)))?;
    Ok(crate::params::json(&graph.params))
}

/// Metrics: key, title, help, best value (NaN: none).
#[pyfunction]
pub fn metrics() -> Vec<(&'static str, &'static str, &'static str, f64)> {
    let best = |b: Best| match b {
        Best::Zero => 0.0,
        Best::One => 1.0,
        Best::Nowhere => f64::NAN,
    };
    METRICS
        .iter()
        .map(|m| (m.key, m.title, m.help, best(m.best)))
        .collect()
}

/// A picture from Python: kind, width, height, bytes of 32-bit floats (R, G, B).
type Given = (String, u32, u32, PyBackedBytes);

fn linear((kind, width, height, bytes): Given) -> PyResult<Linear> {
    let kind = match &kind[..] {
        "direct" => Kind::Direct,
        "radiance" => Kind::Radiance,
        "openness" => Kind::Openness,
        "displayed" => Kind::Displayed,
        other => {
            return Err(raised(
                "RequestError",
                format!("no kind of picture '{other}'"),
            ));
        }
    };
    let rgb: Vec<[f32; 3]> = bytemuck::pod_collect_to_vec(&bytes);
    if rgb.len() as u64 != u64::from(width) * u64::from(height) || rgb.len() * 12 != bytes.len() {
        let message =
            format!("a picture of {width}x{height} must have {width} * {height} * 3 floats");
        return Err(raised("RequestError", message));
    }
    Ok(Linear {
        size: (width, height),
        rgb,
        kind,
    })
}

/// A side of a comparison: name, parts, noise of each part (relmse, flip, structure).
type GivenSide = (
    String,
    BTreeMap<String, Given>,
    BTreeMap<String, (f64, f64, f64)>,
);

fn side((name, parts, noise): GivenSide) -> PyResult<Side> {
    let parts = parts
        .into_iter()
        .map(|(part, given)| Ok((part, linear(given)?)));
    let noise = noise.into_iter().map(|(part, (relmse, flip, structure))| {
        let noise = Noise {
            relmse,
            flip,
            structure,
        };
        (part, noise)
    });
    Ok(Side {
        name,
        parts: parts.collect::<PyResult<_>>()?,
        noise: noise.collect(),
    })
}

/// A comparison as JSON (`conelab compare --json`). Masks: name and one byte for each pixel.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    pictures: Vec<GivenSide>,
    reference: GivenSide,
    parts: Vec<String>,
    masks: Vec<(String, Vec<u8>)>,
) -> PyResult<String> {
    let pictures = pictures
        .into_iter()
        .map(side)
        .collect::<PyResult<Vec<_>>>()?;
    let reference = side(reference)?;
    let masks: Vec<Region> = masks
        .into_iter()
        .map(|(name, mask)| Region {
            name,
            mask: mask.iter().map(|m| *m != 0).collect(),
        })
        .collect();
    py.detach(|| {
        let request = Request {
            parts: &parts,
            masks: &masks,
            maps: None,
        };
        let comparison = compared(&pictures, &reference, request)?;
        serde_json::to_string(&comparison).map_err(LabError::making("JSON"))
    })
    .map_err(exception)
}

/// Maps of the error of a picture, by name.
#[pyfunction]
pub fn error_maps(
    py: Python<'_>,
    picture: Given,
    reference: Given,
) -> PyResult<Vec<(&'static str, Memory)>> {
    let (picture, reference) = (linear(picture)?, linear(reference)?);
    let maps = py.detach(|| Ok::<_, LabError>(layers(&Compared::new(&picture, &reference)?)));
    let map =
        |(name, values): (&'static str, Vec<f32>)| (name, Memory::of_map(values, picture.size));
    Ok(maps.map_err(exception)?.into_iter().map(map).collect())
}

/// A picture file (.exr, .hdr, .png): its kind, and linear RGB.
#[pyfunction]
pub fn read_picture(py: Python<'_>, path: PathBuf) -> PyResult<(&'static str, Memory)> {
    let picture = py
        .detach(|| picture::read_linear(&path))
        .map_err(exception)?;
    Ok((word(picture.kind), Memory::of_linear(picture)))
}

/// Writes linear RGB to an .exr file.
#[pyfunction]
pub fn write_picture(py: Python<'_>, path: PathBuf, picture: Given) -> PyResult<()> {
    let picture = linear(picture)?;
    py.detach(|| picture::write_linear(&path, &picture))
        .map_err(exception)
}

/// The bytes that a display shows of a picture, sRGB, three for each pixel, at an exposure in stops.
#[pyfunction]
pub fn displayed<'py>(
    py: Python<'py>,
    picture: Given,
    exposure: f32,
) -> PyResult<Bound<'py, PyBytes>> {
    let picture = linear(picture)?;
    let bytes: Vec<u8> = py.detach(|| {
        let channels = picture.rgb.as_flattened().iter();
        // Infinity divided by infinity would be black.
        let exposed = channels.map(|c| (c * exposure.exp2()).clamp(0.0, f32::MAX));
        let exposed = exposed.map(|c| display(picture.kind, c));
        exposed.map(|v| (v * 255.0).round() as u8).collect()
    });
    Ok(PyBytes::new(py, &bytes))
}

/// Values from 0 to 1 in the colours of error maps, sRGB, three bytes for each.
#[pyfunction]
pub fn magma<'py>(py: Python<'py>, values: PyBackedBytes) -> Bound<'py, PyBytes> {
    let values: Vec<f32> = bytemuck::pod_collect_to_vec(&values);
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|v| maps::magma(f64::from(*v)))
        .collect();
    PyBytes::new(py, &bytes)
}

/// Name and description of the built-in scenes.
#[pyfunction]
pub fn scenes() -> Vec<(&'static str, &'static str)> {
    builtin::list().collect()
}

/// A PNG of 8-bit RGBA pixels; alpha is left out.
#[pyfunction]
pub fn png<'py>(
    py: Python<'py>,
    width: u32,
    height: u32,
    rgba: &[u8],
) -> PyResult<Bound<'py, PyBytes>> {
    let format = Format::named("rgba8")
        .filter(|_| rgba.len() as u64 == u64::from(width) * u64::from(height) * 4);
    let format =
        format.ok_or_else(|| raised("RequestError", "a PNG needs four bytes for each pixel"))?;
    let texels = Texels {
        extent: [width, height, 1],
        format,
        bytes: rgba.to_vec(),
    };
    let bytes = py.detach(|| picture::png(&texels)).map_err(exception)?;
    Ok(PyBytes::new(py, &bytes))
}
