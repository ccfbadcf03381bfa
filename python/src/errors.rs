//! Errors of the lab as exceptions of `conelab.errors`.

use conelab::diagnostics::{Diagnostic, Severity};
use conelab::lab::LabError;
use conelab::vulkan::VulkanError;
use pyo3::prelude::{PyAnyMethods, PyDictMethods, PyResult, Python};
use pyo3::types::{IntoPyDict, PyDict};
use pyo3::{Bound, PyErr};

/// An exception of `conelab.errors` by the name of its class.
pub fn raised(class: &str, message: impl Into<String>) -> PyErr {
    let message = message.into();
    Python::attach(|py| {
        let made = py
            .import("conelab.errors")
            .and_then(|module| module.getattr(class))
            .and_then(|class| class.call1((message,)));
        made.map_or_else(|error| error, PyErr::from_value)
    })
}

/// The exception of an error.
pub fn exception(error: LabError) -> PyErr {
    let message = error.to_string();
    let class = match &error {
        LabError::Input(findings) => return input(findings),
        LabError::Scene(_) => "SceneError",
        LabError::Vulkan(VulkanError::Lost(_) | VulkanError::Hung(_)) => "DeviceLost",
        LabError::Vulkan(_) => "DeviceError",
        LabError::Metric(_) => "MetricError",
        LabError::File(_) => "FileError",
        LabError::Validation(_) => "ValidationError",
        LabError::Stopped => "Stopped",
        LabError::Make { .. } | LabError::Request(_) => "RequestError",
    };
    raised(class, message)
}

/// Findings as a `ShaderError`, if the first error is in a shader, else as an `InputError`.
fn input(findings: &[Diagnostic]) -> PyErr {
    Python::attach(|py| input_of(py, findings).unwrap_or_else(|error| error))
}

fn input_of(py: Python<'_>, findings: &[Diagnostic]) -> PyResult<PyErr> {
    let first = findings.iter().find(|f| f.severity == Severity::Error);
    let file = first.map(|f| f.place.file.as_path());
    let is_shader = file.and_then(|f| f.extension()).is_some_and(|e| {
        ["glsl", "comp", "vert", "frag", "geom", "tesc", "tese"].contains(&&*e.to_string_lossy())
    });
    let class = if is_shader {
        "ShaderError"
    } else {
        "InputError"
    };
    let list = findings
        .iter()
        .map(|f| finding(py, f))
        .collect::<PyResult<Vec<_>>>()?;
    let class = py.import("conelab.errors")?.getattr(class)?;
    let made = class.call1((Diagnostic::joined(findings), list))?;
    Ok(PyErr::from_value(made))
}

/// A finding as a dictionary.
pub fn finding<'py>(py: Python<'py>, f: &Diagnostic) -> PyResult<Bound<'py, PyDict>> {
    let dict = [
        ("file", Some(f.place.file.to_string_lossy().into_owned())),
        ("message", Some(f.message.clone())),
        ("help", f.help.clone()),
        ("source", f.source.clone()),
    ]
    .into_py_dict(py)?;
    dict.set_item("line", f.place.line)?;
    dict.set_item("column", f.place.column)?;
    dict.set_item(
        "severity",
        if f.severity == Severity::Error {
            "error"
        } else {
            "warning"
        },
    )?;
    Ok(dict)
}
