//! Wavefront OBJ with MTL, and the keys that other programs add for metallic-roughness materials.

mod library;

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::io::{BufRead, Cursor, Read};
use std::path::{Path, PathBuf};

use glam::{Mat4, Vec3};

use crate::files::read_input;

use super::mesh::{RawMesh, prepare_all};
use super::progress::Progress;
use super::texture::{Recipe, Requests, Source};
use super::{Instance, Material, Mesh, Scene, SceneError, Submesh, Vertex};

/// Files larger than this are refused.
const MAX_BYTES: u64 = 4 << 30;

/// Geometry, materials and textures of an OBJ file; no lights, cameras or sky.
pub(super) fn load(path: &Path, progress: Progress) -> Result<Scene, SceneError> {
    let fail = |message: String| SceneError::Model { path: path.into(), message };
    progress.step("reading", 0.0)?;
    let text = read_text(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let warnings = RefCell::new(Vec::new());
    let lines_read = Cell::new(0);
    let used = RefCell::new(BTreeSet::new());
    let mut reader = CountLines { inner: Cursor::new(text.as_bytes()), lines: &lines_read, used: &used, progress };
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    let load_mtl = |names: &Path| Ok(library::load(folder, names, &warnings));
    let (models, materials) = tobj::load_obj_buf(&mut reader, &options, load_mtl)
        .map_err(|error| fail(format!("{error} at or before line {}. Export it again", lines_read.get())))?;
    let mut warnings = warnings.into_inner();
    warnings.extend(undefined(&used.into_inner(), materials.as_deref().unwrap_or_default(), path));

    progress.step("materials", 0.4)?;
    let mut requests = Requests::default();
    let mut materials: Vec<Material> =
        materials.unwrap_or_default().iter().map(|m| material(m, folder, &mut requests, &mut warnings)).collect();
    if models.iter().any(|model| model.mesh.material_id.is_none()) {
        materials.push(Material { two_sided: true, ..Material::default() });
    }
    progress.step("meshes", 0.5)?;
    let raw = merge_objects(models, &materials, progress).map_err(fail)?;
    let (meshes, dropped) = prepare_all(raw, &materials, progress).map_err(fail)?;
    warnings.extend(dropped.warning(&path.display().to_string()));
    progress.step("textures", 0.7)?;
    let (textures, texture_warnings) = requests.load(progress)?;
    warnings.extend(texture_warnings);

    let meshes: Vec<Mesh> = meshes.into_iter().filter(|mesh| !mesh.submeshes.is_empty()).collect();
    let instances = meshes.iter().enumerate().map(|(i, mesh)| Instance {
        name: mesh.name.clone(),
        mesh: i as u32,
        transform: Mat4::IDENTITY,
        animation: None,
    });
    Ok(Scene { instances: instances.collect(), meshes, materials, textures, warnings, ..Scene::default() })
}

/// Text with anything that is not UTF-8 replaced: comments and names of old files often are not.
fn read_text(path: &Path) -> Result<String, SceneError> {
    let bytes = read_input(path, MAX_BYTES).map_err(|source| SceneError::Read {
        path: path.into(),
        hint: "Check the path and its permissions".into(),
        source,
    })?;
    Ok(match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => String::from_utf8_lossy(error.as_bytes()).into_owned(),
    })
}

/// Joins the pieces that tobj cuts at each `usemtl` into one mesh per object.
fn merge_objects(models: Vec<tobj::Model>, materials: &[Material], progress: Progress) -> Result<Vec<RawMesh>, String> {
    let default_material = materials.len().saturating_sub(1) as u32;
    let mut meshes: Vec<RawMesh> = Vec::new();
    for tobj::Model { mesh: piece, name } in models {
        if progress.stopped() {
            return Err(String::new());
        }
        let material = piece.material_id.map_or(default_material, |id| id as u32);
        if materials.get(material as usize).is_some_and(Material::is_left_out) {
            continue;
        }
        let has_normals = !piece.normals.is_empty();
        let fits = |raw: &RawMesh| raw.mesh.name == name && raw.has_normals == has_normals;
        if !meshes.last().is_some_and(fits) {
            let mesh = Mesh { name, ..Mesh::default() };
            meshes.push(RawMesh { mesh, has_normals, has_tangents: false });
        }
        let Some(RawMesh { mesh, .. }) = meshes.last_mut() else {
            continue;
        };
        let base = u32::try_from(mesh.vertices.len()).map_err(|_| "it has more than 2^32 vertices".to_string())?;
        let first_index = mesh.indices.len() as u32;
        mesh.indices.extend(piece.indices.iter().map(|i| i.saturating_add(base)));
        for (i, position) in piece.positions.as_chunks::<3>().0.iter().enumerate() {
            let normal = piece.normals.as_chunks::<3>().0.get(i).copied().unwrap_or_default();
            // The origin of OBJ texture coordinates is the lower left, ours the upper left.
            let uv = piece.texcoords.as_chunks::<2>().0.get(i).map_or([0.0; 2], |&[u, v]| [u, 1.0 - v]);
            mesh.vertices.push(Vertex { position: *position, normal, uv, ..Vertex::default() });
        }
        let index_count = (piece.indices.len() / 3 * 3) as u32;
        mesh.submeshes.push(Submesh { first_index, index_count, material });
    }
    Ok(meshes)
}

fn material(mtl: &tobj::Material, folder: &Path, requests: &mut Requests, warnings: &mut Vec<String>) -> Material {
    let file = |value: &str| Source::File(folder.join(texture_file(value)));
    let unknown = |key: &str| mtl.unknown_param.get(key).map(String::as_str);
    let map = |key: &str| unknown(key).filter(|value| !value.is_empty()).map(file);
    let number = |key: &str| unknown(key).and_then(|v| v.parse::<f32>().ok()).filter(|v| v.is_finite());
    let name = &mtl.name;

    let cutoff = number("alpha_cutoff").unwrap_or(0.5).clamp(0.0, 1.0);
    let color = mtl.diffuse_texture.as_deref().map(file);
    let alpha = mtl.dissolve_texture.as_deref().map(file);
    // `d` is opacity, `Tr` the rest. Without a map the surface is there, or it is not.
    let opacity = mtl.dissolve.or_else(|| number("Tr").map(|t| 1.0 - t)).filter(|d| d.is_finite());
    let opacity = opacity.unwrap_or(1.0).clamp(0.0, 1.0);
    let masked = alpha.is_some() || opacity < cutoff;
    if alpha.is_none() && opacity < 1.0 && cutoff > 0.0 {
        let shown = if masked { "left out" } else { "opaque" };
        warnings.push(format!("material '{name}' has an opacity of {opacity:.2}: it is {shown}"));
    }
    let mask = (cutoff * 255.0).round() as u8;
    let base_color_texture = match (color, alpha) {
        (Some(image), None) => Some(Recipe::Color { image, mask: None }),
        (Some(image), Some(alpha)) if image == alpha => Some(Recipe::Color { image, mask: Some(mask) }),
        (color, Some(alpha)) => Some(Recipe::ColorAndMask { color, alpha, mask }),
        (None, None) => None,
    };
    let (rough_map, metal_map) = (map("map_Pr"), map("map_Pm"));
    let rough_metal = rough_map.is_some() || metal_map.is_some();
    // A factor that is not given must not switch its map off.
    let metallic = number("Pm").unwrap_or(if metal_map.is_some() { 1.0 } else { 0.0 });
    let from_exponent = |ns: f32| {
        if rough_metal { 1.0 } else { (2.0 / (ns.max(0.0) + 2.0)).sqrt() }
    };
    let roughness = number("Pr").unwrap_or_else(|| mtl.shininess.map_or(1.0, from_exponent));
    let emission_map = map("map_Ke");
    let bump = mtl.normal_texture.as_deref().filter(|value| is_normal_map(value)).map(file);
    let normal_map = map("norm").or_else(|| map("map_Kn")).or(bump);
    let dark = if emission_map.is_some() { [1.0; 3] } else { [0.0; 3] };
    let mut ask = |recipe: Recipe| requests.ask(recipe, name);
    Material {
        name: name.clone(),
        base_color: color_or(mtl.diffuse, [0.8; 3]).extend(opacity),
        metallic: metallic.clamp(0.0, 1.0),
        roughness: roughness.clamp(0.0, 1.0),
        ior: number("ior").unwrap_or(1.5).clamp(0.0, 1e6),
        specular: number("specular").unwrap_or(1.0).clamp(0.0, 1.0),
        specular_color: unknown("specular_color").and_then(three).unwrap_or(Vec3::ONE),
        emission: color_or(mtl.emissive, dark),
        alpha_cutoff: if masked { cutoff } else { 0.0 },
        // OBJ cannot say; windings of old files are unreliable, so nothing may be culled.
        two_sided: number("two_sided").is_none_or(|v| v != 0.0),
        normal_scale: number("normal_scale").unwrap_or(1.0),
        base_color_texture: base_color_texture.map(&mut ask),
        metallic_roughness_texture: rough_metal
            .then(|| ask(Recipe::RoughnessAndMetallic { roughness: rough_map, metallic: metal_map })),
        normal_texture: normal_map.map(|image| ask(Recipe::Normal { image })),
        emission_texture: emission_map.map(|image| ask(Recipe::Color { image, mask: None })),
        ..Material::default()
    }
}

/// Three numbers at or above 0.
fn three(value: &str) -> Option<Vec3> {
    let numbers: Vec<f32> = value.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let color = Vec3::from_array(numbers.try_into().ok()?);
    color.is_finite().then(|| color.max(Vec3::ZERO))
}

fn color_or(value: Option<[f32; 3]>, default: [f32; 3]) -> Vec3 {
    let color = Vec3::from_array(value.unwrap_or(default));
    if color.is_finite() { color.max(Vec3::ZERO) } else { Vec3::from_array(default) }
}

/// A bump entry is a height map by the letter of the format, but a normal map by the name of many files.
fn is_normal_map(value: &str) -> bool {
    let file = texture_file(value).to_string_lossy().to_lowercase();
    let stem = file.rsplit_once('.').map_or(file.as_str(), |(stem, _)| stem);
    ["normal", "norm", "nrm", "ddn"].iter().any(|word| stem.contains(word)) || stem.ends_with("_n")
}

/// The file of a texture entry: options and their arguments skipped, backslashes turned.
fn texture_file(value: &str) -> PathBuf {
    let mut words = value.split_whitespace().peekable();
    let mut rest = value.trim();
    while let Some(option) = words.next_if(|word| word.starts_with('-')) {
        rest = rest[option.len()..].trim_start();
        let most = match option {
            "-o" | "-s" | "-t" => 3,
            "-mm" => 2,
            _ => 1,
        };
        for argument in 0..most {
            // `-o`, `-s` and `-t` may leave out their last numbers.
            let number = |word: &&str| argument == 0 || word.parse::<f32>().is_ok();
            let Some(word) = words.next_if(number) else {
                break;
            };
            rest = rest[word.len()..].trim_start();
        }
    }
    PathBuf::from(rest.replace('\\', "/"))
}

/// A warning about materials that the model uses and no library defines.
fn undefined(used: &BTreeSet<String>, defined: &[tobj::Material], path: &Path) -> Option<String> {
    let names: Vec<String> =
        used.iter().filter(|name| !defined.iter().any(|m| m.name == **name)).map(|n| format!("'{n}'")).collect();
    let shown = names.iter().take(MAX_NAMES).cloned().collect::<Vec<_>>().join(", ");
    let more = if names.len() > MAX_NAMES { format!(" and {} more", names.len() - MAX_NAMES) } else { String::new() };
    let path = path.display();
    (!names.is_empty()).then(|| format!("{path}: no material library defines {shown}{more}; they are grey"))
}

/// Names of materials in one warning.
const MAX_NAMES: usize = 8;

/// A reader that counts lines for error messages, collects the names of used materials, and fails once cancelled.
struct CountLines<'a, R> {
    inner: R,
    lines: &'a Cell<usize>,
    used: &'a RefCell<BTreeSet<String>>,
    progress: Progress<'a>,
}

impl<R: Read> Read for CountLines<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.inner.read(buffer)
    }
}

impl<R: BufRead> BufRead for CountLines<'_, R> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        self.inner.fill_buf()
    }
    fn consume(&mut self, amount: usize) {
        self.inner.consume(amount);
    }
    fn read_line(&mut self, line: &mut String) -> std::io::Result<usize> {
        if self.progress.stopped() {
            return Err(std::io::ErrorKind::Other.into());
        }
        let begin = line.len();
        let read = self.inner.read_line(line)?;
        without_color(line, begin);
        if let Some(name) = line[begin..].strip_prefix("usemtl ").map(str::trim).filter(|n| !n.is_empty()) {
            let mut used = self.used.borrow_mut();
            if !used.contains(name) {
                used.insert(name.into());
            }
        }
        self.lines.set(self.lines.get() + usize::from(read > 0));
        Ok(read)
    }
}

/// Takes a vertex's colour out of the line from `begin` on: it is not used, and files that give it to some vertices alone
/// would be refused.
fn without_color(line: &mut String, begin: usize) {
    let text = &line[begin..];
    if text.starts_with("v ")
        && let Some(color) = text.split_whitespace().nth(4)
    {
        let end = color.as_ptr() as usize - line.as_ptr() as usize;
        line.truncate(end);
        line.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_of_vertices_are_taken_out() {
        for (line, read) in
            [("v 1 2 3 0.5 0.5 0.5\n", "v 1 2 3 \n"), ("v 1 2 3\n", "v 1 2 3\n"), ("vt 1 2 3 4 5\n", "vt 1 2 3 4 5\n")]
        {
            let mut text = format!("before\n{line}");
            without_color(&mut text, 7);
            assert_eq!(text, format!("before\n{read}"));
        }
    }

    #[test]
    fn texture_options_are_skipped() {
        for (entry, file) in [
            ("a b.png", "a b.png"),
            ("-bm 0.5 textures\\wall.png", "textures/wall.png"),
            ("-o 1 2 -s 1 1 1 -clamp on a.png", "a.png"),
            ("  -mm 0 1 -imfchan r a.png", "a.png"),
        ] {
            assert_eq!(texture_file(entry), PathBuf::from(file), "{entry}");
        }
    }

    #[test]
    fn normal_maps_are_known_by_name() {
        assert!(is_normal_map("textures/wall_normal.png"));
        assert!(is_normal_map("-bm 1 wall_n.png"));
        assert!(!is_normal_map("wall_bump.png"));
    }
}
