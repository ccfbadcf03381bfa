//! Memory of the lab that NumPy arrays share.

use conelab::lab::Texels;
use conelab::metrics::Linear;
use pyo3::Bound;
use pyo3::prelude::{PyDictMethods, PyResult, Python, pyclass, pymethods};
use pyo3::types::{PyDict, PyTuple};
use std::any::Any;

/// An array in row-major order, by NumPy's array interface protocol, version 3: `numpy.asarray` shares its memory and
/// keeps it alive. The protocol of buffers is in the stable ABI from Python 3.11 on only.
#[pyclass(frozen, module = "conelab._conelab")]
pub struct Memory {
    /// Never read here once it is shared; arrays write to it.
    _owner: Box<dyn Any + Send + Sync>,
    address: usize,
    shape: Vec<usize>,
    /// Element type, as in NumPy's `typestr`, native byte order.
    kind: &'static str,
    read_only: bool,
}

impl Memory {
    /// Takes elements. `kind` is the type of their numbers, `shape` counts those.
    pub fn new<T: bytemuck::Pod + Send + Sync>(
        mut owner: Vec<T>,
        kind: &'static str,
        shape: Vec<usize>,
    ) -> Memory {
        Memory {
            address: owner.as_mut_ptr().expose_provenance(),
            _owner: Box::new(owner),
            shape,
            kind,
            read_only: false,
        }
    }

    /// Shares a picture that `owner` keeps.
    pub fn shared(owner: impl Any + Send + Sync, picture: &Linear) -> Memory {
        Memory {
            address: picture.rgb.as_ptr().expose_provenance(),
            _owner: Box::new(owner),
            shape: vec![picture.size.1 as usize, picture.size.0 as usize, 3],
            kind: "f4",
            read_only: true,
        }
    }

    /// A picture: height, width, 3.
    pub fn of_linear(picture: Linear) -> Memory {
        let shape = vec![picture.size.1 as usize, picture.size.0 as usize, 3];
        Memory::new(picture.rgb, "f4", shape)
    }

    /// A map: height, width.
    pub fn of_map(map: Vec<f32>, size: (u32, u32)) -> Memory {
        Memory::new(map, "f4", vec![size.1 as usize, size.0 as usize])
    }

    /// Texels: depth (of volumes), height, width, channels (of more than one). Packed formats that NumPy has no type for
    /// become 32-bit floats.
    pub fn of_texels(texels: Texels) -> Memory {
        let [width, height, depth] = texels.extent.map(|n| n as usize);
        let (name, count) = (texels.format.name, texels.format.count as usize);
        let shape = |channels: usize| {
            let all = [
                (depth, depth > 1),
                (height, true),
                (width, true),
                (channels, channels > 1),
            ];
            all.into_iter().filter(|d| d.1).map(|d| d.0).collect()
        };
        match name {
            "r11g11b10f" | "rgb10a2" => {
                let floats = texels.floats();
                let kept = floats
                    .iter()
                    .flat_map(|t| t[..count].to_vec())
                    .collect::<Vec<f32>>();
                Memory::new(kept, "f4", shape(count))
            }
            _ => Memory::new(texels.bytes, kind_of(name), shape(count)),
        }
    }
}

/// NumPy's type of a format's channels. Normalised channels are whole numbers, as stored.
fn kind_of(format: &str) -> &'static str {
    let has = |part: &str| format.contains(part);
    match () {
        () if has("32ui") => "u4",
        () if has("32i") => "i4",
        () if has("32") => "f4",
        () if has("16f") => "f2",
        () if has("16") => "u2",
        () => "u1",
    }
}

#[pymethods]
impl Memory {
    /// See NumPy's documentation, "The array interface protocol".
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let order = if cfg!(target_endian = "little") {
            '<'
        } else {
            '>'
        };
        let order = if self.kind == "u1" { '|' } else { order };
        let dict = PyDict::new(py);
        dict.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        dict.set_item("typestr", format!("{order}{}", self.kind))?;
        dict.set_item("data", (self.address, self.read_only))?;
        dict.set_item("version", 3)?;
        Ok(dict)
    }

    #[getter]
    fn address(&self) -> usize {
        self.address
    }
}
