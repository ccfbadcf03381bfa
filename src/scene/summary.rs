//! A scene as text and as JSON.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::light::Quantity;
use super::{Camera, Light, Material, Scene, Texture};

impl Scene {
    /// Counts, bounds, materials, textures, lights, cameras and warnings as text.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        // Writing into a string cannot fail.
        let _ = self.write_summary(&mut text);
        text
    }

    /// The summary as JSON, without texels and vertices. Lengths are in metres, angles in degrees,
    /// and light in the units of the scene file: W/(m² sr), W/sr or W/m².
    pub(crate) fn description(&self) -> Value {
        let (low, high) = self.bounds();
        let texture = |number: Option<u32>| {
            number
                .and_then(|n| self.textures.get(n as usize))
                .map(|t| &t.name)
        };
        let material = |m: &Material| {
            json!({
                "name": m.name, "base_color": m.base_color.to_array(), "roughness": m.roughness, "metallic": m.metallic,
                "emission": m.emission.to_array(), "alpha_cutoff": m.alpha_cutoff, "left_out": m.is_left_out(),
                "base_color_texture": texture(m.base_color_texture), "normal_texture": texture(m.normal_texture),
                "metallic_roughness_texture": texture(m.metallic_roughness_texture),
                "emission_texture": texture(m.emission_texture),
            })
        };
        let light = |l: &Light| {
            let name = l.kind.row().name.to_lowercase();
            let numbers: Map<_, _> = l
                .fields()
                .numbers()
                .iter()
                .map(|(f, x)| (f.name.into(), json!(x)))
                .collect();
            let kind = if numbers.is_empty() {
                json!(name)
            } else {
                json!({ name: numbers })
            };
            json!({
                "name": l.name, "kind": kind, "color": l.color.to_array(), "position": l.position.to_array(),
                "direction": l.direction.to_array(), "shadow": l.shadow,
            })
        };
        let camera = |c: &Camera| json!({ "eye": c.eye.to_array(), "target": c.target.to_array(), "fov_y": c.fov_y });
        json!({
            "name": self.name,
            "triangles": self.triangle_count(),
            "vertices": self.meshes.iter().map(|mesh| mesh.vertices.len()).sum::<usize>(),
            "meshes": self.meshes.len(),
            "instances": self.instances.len(),
            "animated": self.animated().count(),
            "bounds": [low.to_array(), high.to_array()],
            "sky": self.sky.to_array(),
            "environment": self.environment.as_ref().map(|e| e.name().to_string()),
            "materials": self.materials.iter().map(material).collect::<Vec<_>>(),
            "textures": self.textures.iter().map(|t| json!({
                "name": t.name, "size": [t.width, t.height], "mips": t.mips.len(),
            })).collect::<Vec<_>>(),
            "lights": self.all_lights().iter().map(light).collect::<Vec<_>>(),
            "cameras": self.cameras.iter().map(|(name, c)| (name.clone(), camera(c))).collect::<Map<_, _>>(),
            "warnings": self.warnings,
        })
    }

    fn write_summary(&self, out: &mut String) -> std::fmt::Result {
        let vertices: usize = self.meshes.iter().map(|mesh| mesh.vertices.len()).sum();
        let (low, high) = self.bounds();
        let size = high - low;
        let moving = self.animated().count();
        writeln!(out, "scene      {}", self.name)?;
        writeln!(out, "triangles  {}", self.triangle_count())?;
        writeln!(out, "vertices   {vertices} in {} meshes", self.meshes.len())?;
        writeln!(
            out,
            "instances  {} ({moving} animated)",
            self.instances.len()
        )?;
        writeln!(
            out,
            "bounds     {low:.3} to {high:.3}, {:.2} x {:.2} x {:.2} m",
            size.x, size.y, size.z
        )?;
        writeln!(out, "sky        radiance {:.3}", self.sky)?;
        if let Some(environment) = &self.environment {
            let ((width, height), turned) = (environment.picture.size(), environment.rotation);
            writeln!(
                out,
                "           times a picture of {width}x{height}, {}, turned by {turned} deg",
                environment.name()
            )?;
        }

        self.write_materials(out)?;
        self.write_textures(out)?;
        self.write_lights(out)?;
        writeln!(out, "\ncameras    {}", self.cameras.len())?;
        for (name, camera) in &self.cameras {
            writeln!(
                out,
                "  {name}  eye {:.2} toward {:.2}, {} deg",
                camera.eye, camera.target, camera.fov_y
            )?;
        }
        if !self.warnings.is_empty() {
            writeln!(out, "\nwarnings   {}", self.warnings.len())?;
            for warning in &self.warnings {
                writeln!(out, "  {warning}")?;
            }
        }
        Ok(())
    }

    fn write_materials(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "\nmaterials  {}", self.materials.len())?;
        let width = self
            .materials
            .iter()
            .map(|m| m.name.chars().count())
            .max()
            .unwrap_or(0)
            .clamp(4, 32);
        if !self.materials.is_empty() {
            writeln!(
                out,
                "  {:width$}  base color         rough metal  notes",
                "name"
            )?;
        }
        for material in &self.materials {
            let [r, g, b, _] = material.base_color.to_array();
            let Material {
                name,
                roughness,
                metallic,
                ..
            } = material;
            let notes = notes(material);
            writeln!(
                out,
                "  {name:width$}  {r:.3} {g:.3} {b:.3}  {roughness:.2}  {metallic:.2}  {notes}"
            )?;
        }
        Ok(())
    }

    fn write_textures(&self, out: &mut String) -> std::fmt::Result {
        let bytes = |texture: &Texture| texture.mips.iter().map(Vec::len).sum::<usize>();
        let total = self.textures.iter().map(bytes).sum::<usize>() as f64 / f64::from(1 << 20);
        writeln!(out, "\ntextures   {} ({total:.1} MiB)", self.textures.len())?;
        for texture in &self.textures {
            let Texture {
                name,
                width,
                height,
                format,
                mips,
            } = texture;
            writeln!(
                out,
                "  {name}  {width}x{height} {format:?}, {} mips",
                mips.len()
            )?;
        }
        Ok(())
    }

    fn write_lights(&self, out: &mut String) -> std::fmt::Result {
        let lights = self.all_lights();
        writeln!(out, "\nlights     {}", lights.len())?;
        for light in &lights {
            let shadow = if light.shadow { "shadow" } else { "no shadow" };
            let kind = light.kind.row();
            write!(
                out,
                "  {}  {}, {} {:.2}",
                light.name,
                kind.name.to_lowercase(),
                kind.color,
                light.color
            )?;
            let fields = light.fields();
            for (field, v) in fields.vectors() {
                match field.quantity {
                    Quantity::Color => {}
                    Quantity::Position => write!(out, ", at {v:.2}")?,
                    _ => write!(out, ", {} {v:.3}", field.name)?,
                }
            }
            for (field, x) in fields.numbers() {
                write!(out, ", {} {x:.2} {}", field.name, field.quantity.unit())?;
            }
            writeln!(out, ", {shadow}")?;
        }
        Ok(())
    }
}

fn notes(material: &Material) -> String {
    let mut notes = Vec::new();
    for (texture, what) in [
        (material.base_color_texture, "color map"),
        (material.metallic_roughness_texture, "metal-rough map"),
        (material.normal_texture, "normal map"),
        (material.emission_texture, "emission map"),
    ] {
        notes.extend(texture.map(|_| what.to_owned()));
    }
    if material.is_left_out() {
        notes.push("left out".to_owned());
    } else if material.alpha_cutoff > 0.0 {
        notes.push(format!("mask at {:.2}", material.alpha_cutoff));
    }
    let reflects = material.dielectric();
    if reflects != Material::default().dielectric() {
        notes.push(format!("reflects {:.3}", reflects.truncate()));
    }
    if material.emission != glam::Vec3::ZERO {
        notes.push(format!("emits {:.2}", material.emission));
    }
    if material.two_sided {
        notes.push("two-sided".into());
    }
    notes.join(", ")
}
