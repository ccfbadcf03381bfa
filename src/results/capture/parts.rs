//! The light components stored in a capture.

use super::{Manifest, SOURCES, failed};
use crate::graph::LightPart;
use crate::graph::load::Folders;
use crate::lab::{LabError, load, parts_of};
use crate::metrics::Linear;
use crate::results::picture;
use std::collections::BTreeMap;
use std::path::Path;

/// The pictures of a capture that are light components, by name: the linear picture, and additional
/// textures.
///
/// # Errors
/// The graph or a picture cannot be read; no picture is a component.
pub fn parts(folder: &Path, manifest: &Manifest) -> Result<BTreeMap<String, Linear>, LabError> {
    if Path::new(&manifest.graph).file_name() != Some(manifest.graph.as_ref()) {
        return Err(failed(folder, "its graph must be a bare file name"));
    }
    let sources = folder.join(SOURCES);
    let folders = Folders {
        passes: sources.join("passes"),
        shaders: sources.join("shaders"),
    };
    let graph = load(&folders.passes.join(&manifest.graph), &folders).map_err(LabError::Input)?;
    let mut parts = BTreeMap::new();
    for LightPart {
        name,
        texture,
        kind,
        ..
    } in parts_of(&graph)
    {
        let image = manifest.images.iter().find(|i| {
            i.texture == texture && (i.mip, i.layer) == (0, 0) && i.file.ends_with(".exr")
        });
        if let Some(image) = image {
            parts.insert(
                name,
                Linear {
                    kind,
                    ..picture::read_linear(&folder.join(&image.file))?
                },
            );
        }
    }
    if parts.is_empty() {
        return Err(failed(
            folder,
            "it has no picture of a part of the light; capture again with --resource",
        ));
    }
    Ok(parts)
}
