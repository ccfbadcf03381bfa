//! Export to other programs. Re-opening an exported file gives the same triangles and materials.

mod gltf;
mod images;
mod motion;
mod obj;
mod textures;
mod writer;

use std::path::Path;

use super::warnings::Warnings;
use super::{Lookups, Scene, SceneError};
use crate::files;

impl Scene {
    /// Writes an .obj (with an .mtl and PNG textures), a .glb, or a .gltf (with a .bin).
    ///
    /// OBJ holds the pose at time 0 without lights and cameras. glTF omits the sky, shadow flags,
    /// skins and morph targets; deformed meshes have their pose at time 0. An environment map is
    /// written to .sky.exr, scaled by the sky's radiance and without its rotation. Each file is
    /// written atomically. Returns warnings about content that the format cannot hold.
    pub fn export(&self, path: &Path) -> Result<Vec<String>, SceneError> {
        let extension = crate::files::ending(path);
        match extension.as_str() {
            "obj" => {
                obj::write(self, path)?;
                Ok(self.left_out_of_obj().lines(path.display()))
            }
            "glb" | "gltf" => {
                gltf::write(self, path, extension == "glb")?;
                if let Some(environment) = &self.environment {
                    let sky = path.with_extension("sky.exr");
                    write_file(&sky, &images::sky_exr(environment, self.sky, &sky)?)?;
                }
                Ok(self.left_out_of_gltf().lines(path.display()))
            }
            _ => Err(SceneError::ExportFormat { path: path.into() }),
        }
    }
}

impl Scene {
    fn left_out_of_obj(&self) -> Warnings {
        let mut warnings = Warnings::default();
        for mesh in self.meshes.iter().filter(|mesh| mesh.has_colors()) {
            warnings.add(
                "colours of vertices are left out of .obj files. Export as .glb to keep them",
                &mesh.name,
            );
        }
        for material in self
            .materials
            .iter()
            .filter(|m| m.lookups != Lookups::default())
        {
            let what = "wrap modes, filters and second sets of texture coordinates are left out of .obj files. Export as \
                        .glb to keep them";
            warnings.add(what, &material.name);
        }
        self.animated().for_each(|i| {
            warnings.add(
                "motion is left out of .obj files, which hold the pose at 0 s",
                &i.name,
            )
        });
        warnings
    }

    fn left_out_of_gltf(&self) -> Warnings {
        let mut warnings = Warnings::default();
        for mesh in self
            .deformers
            .iter()
            .filter_map(|d| self.meshes.get(d.mesh as usize))
        {
            warnings.add(
                "skins and morph targets are written in their pose at 0 s",
                &mesh.name,
            );
        }
        warnings
    }
}

fn write_file(path: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    Ok(files::write_whole(path, bytes)?)
}

/// Makes names unique by numbering repetitions.
fn unique_names<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = std::collections::HashSet::new();
    let mut unique = Vec::new();
    for name in names {
        let name: String = name
            .trim()
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let base = if name.is_empty() {
            "unnamed".to_owned()
        } else {
            name
        };
        let mut candidate = base.clone();
        let mut number = 2;
        while !taken.insert(candidate.clone()) {
            candidate = format!("{base} {number}");
            number += 1;
        }
        unique.push(candidate);
    }
    unique
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_become_unique() {
        let names = super::unique_names(["a", "a", "", "a 2"].into_iter());
        assert_eq!(names, ["a", "a 2", "unnamed", "a 2 2"]);
    }
}
