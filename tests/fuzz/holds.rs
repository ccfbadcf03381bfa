//! What an accepted scene must hold: numbers that can be rendered, no more than its files have, and what an export keeps.

use conelab::scene::{Camera, Light, LightKind, Material, Mesh, Scene};
use glam::Vec3;
use std::ops::ControlFlow;
use std::path::Path;

/// Elements of meshes per byte of all files: an OBJ face of many corners takes two bytes for three indices.
const PER_BYTE: usize = 4;

/// What is wrong with a scene that was read from files of so many bytes; `model`: from a model file, whose counts its
/// bytes limit.
pub fn mistake(scene: &Scene, bytes: usize, model: bool) -> Option<String> {
    let (low, high) = scene.bounds();
    if !low.is_finite() || !high.is_finite() || low.cmpgt(high).any() {
        return Some(format!("its bounds are {low} to {high}"));
    }
    let elements: usize = scene
        .meshes
        .iter()
        .map(|m| m.vertices.len() + m.indices.len())
        .sum();
    if model && elements > PER_BYTE * bytes {
        return Some(format!("{elements} vertices and indices of {bytes} bytes"));
    }
    if scene.cameras.is_empty() || scene.lights.is_empty() && model {
        return Some("it has no camera or no light".into());
    }
    let materials = scene.materials.len();
    let of = |what: &str, name: &str, wrong: Option<&str>| {
        wrong.map(|wrong| format!("{what} '{name}': {wrong}"))
    };
    let cameras = scene
        .cameras
        .iter()
        .find_map(|(name, c)| of("camera", name, camera(c)));
    let lights = scene
        .lights
        .iter()
        .find_map(|l| of("light", &l.name, light(l)));
    let meshes = scene
        .meshes
        .iter()
        .find_map(|m| of("mesh", &m.name, mesh(m, materials)));
    let surfaces = scene
        .materials
        .iter()
        .find_map(|m| of("material", &m.name, material(m, scene.textures.len())));
    let textures = scene.textures.iter().find_map(|t| {
        let full = |i: usize| {
            t.format
                .level_bytes((t.width >> i).max(1), (t.height >> i).max(1))
        };
        let whole = t
            .mips
            .iter()
            .enumerate()
            .all(|(i, mip)| mip.len() == full(i));
        of(
            "texture",
            &t.name,
            (!whole || t.mips.is_empty()).then_some("its levels have other sizes"),
        )
    });
    let instances = scene.instances.iter().find_map(|i| {
        let wrong = match () {
            () if i.mesh as usize >= scene.meshes.len() => Some("it has no mesh"),
            () if !i.transform.is_finite() => Some("its transform is not finite"),
            () if i.mover.is_some_and(|m| m as usize >= scene.movers.len()) => {
                Some("it moves with nothing")
            }
            () => None,
        };
        of("instance", &i.name, wrong)
    });
    let frames = [0.0, 0.4, 7.0].iter().find_map(|time| {
        let frames = scene.mover_frames(*time);
        frames
            .iter()
            .any(|f| f.is_nan())
            .then(|| format!("frames at {time} s are no numbers"))
    });
    let movers = (0u32..).zip(&scene.movers).find_map(|(i, m)| {
        (m.parent.is_some_and(|p| p >= i))
            .then(|| format!("mover {i} moves with one that comes after it"))
    });
    let deformers = scene.deformers.iter().find_map(|d| {
        let wrong = match scene.meshes.get(d.mesh as usize) {
            None => Some("there is no such mesh"),
            Some(mesh) if d.rest.len() > mesh.vertices.len() => {
                Some("it has fewer vertices than are moved")
            }
            Some(_) if !d.bounds.0.is_finite() || !d.bounds.1.is_finite() => {
                Some("its bounds are not finite")
            }
            Some(_) => None,
        };
        of("the shape of mesh", &d.mesh.to_string(), wrong)
    });
    let sky = (!scene.sky.is_finite() || scene.sky.min_element() < 0.0)
        .then(|| format!("a sky of {}", scene.sky));
    let picture = scene.environment.as_ref().and_then(|e| {
        let light = e
            .picture
            .texels()
            .iter()
            .flatten()
            .all(|v| v.is_finite() && *v >= 0.0);
        (!light || !e.rotation.is_finite()).then(|| "the picture of its sky is no light".into())
    });
    let motion = frames.or(movers).or(deformers);
    cameras
        .or(lights)
        .or(meshes)
        .or(surfaces)
        .or(textures)
        .or(instances)
        .or(motion)
        .or(sky)
        .or(picture)
}

fn camera(c: &Camera) -> Option<&'static str> {
    let direction = (c.target - c.eye).try_normalize();
    match () {
        () if !c.eye.is_finite() || direction.is_none() => Some("it looks nowhere"),
        () if c.up.try_normalize().is_none() => Some("nothing is up"),
        () if !(c.fov_y > 0.0 && c.fov_y < 180.0) => Some("its field of view is none"),
        () if !(c.near > 0.0 && c.near.is_finite() && c.far > c.near) => {
            Some("its planes are none")
        }
        () => None,
    }
}

fn light(l: &Light) -> Option<&'static str> {
    let angles = match l.kind {
        LightKind::Spot { inner, outer } => {
            0.0 <= inner && inner <= outer && outer <= std::f32::consts::FRAC_PI_2
        }
        LightKind::Rectangle { width, height } => {
            [width, height].iter().all(|x| *x > 0.0 && x.is_finite())
        }
        LightKind::Disc { radius } => radius > 0.0 && radius.is_finite(),
        LightKind::Directional | LightKind::Point => true,
    };
    match () {
        () if !l.color.is_finite() || l.color.min_element() < 0.0 => Some("its colour is none"),
        () if !l.position.is_finite() || !l.direction.is_normalized() => {
            Some("its place or direction is none")
        }
        () if !angles => Some("its angles are none"),
        () => None,
    }
}

fn mesh(m: &Mesh, materials: usize) -> Option<&'static str> {
    let unit = |v: [f32; 3]| (Vec3::from(v).length() - 1.0).abs() < 1e-3;
    let vertex = |v: &conelab::scene::Vertex| {
        let [x, y, z, w] = v.tangent;
        Vec3::from(v.position).is_finite() && unit(v.normal) && unit([x, y, z]) && w.abs() == 1.0
    };
    let finite_uv = |v: &conelab::scene::Vertex| v.uv.iter().all(|t| t.is_finite());
    let used = |i: &u32| m.vertices.get(*i as usize);
    let mut next = 0;
    let runs = m.submeshes.iter().all(|s| {
        let follows = s.first_index == next
            && s.index_count.is_multiple_of(3)
            && (s.material as usize) < materials;
        next = s.first_index.saturating_add(s.index_count);
        follows
    });
    match () {
        () if !runs || next as usize != m.indices.len() => {
            Some("its runs do not cover its indices")
        }
        () if !m.indices.iter().all(|i| used(i).is_some()) => Some("an index has no vertex"),
        () if !m.indices.iter().filter_map(used).all(vertex) => {
            Some("a vertex has no place, normal or tangent")
        }
        () if !m.indices.iter().filter_map(used).all(finite_uv) => {
            Some("a texture coordinate is not finite")
        }
        () => None,
    }
}

fn material(m: &Material, textures: usize) -> Option<&'static str> {
    let share = |v: f32| (0.0..=1.0).contains(&v);
    let maps = [
        m.base_color_texture,
        m.metallic_roughness_texture,
        m.normal_texture,
        m.emission_texture,
    ];
    match () {
        () if !m.base_color.to_array().into_iter().all(share) => Some("its colour is none"),
        () if ![m.metallic, m.roughness].into_iter().all(share) => {
            Some("its roughness or metal is none")
        }
        () if !m.dielectric().to_array().into_iter().all(share) => {
            Some("it reflects what it cannot")
        }
        () if !m.emission.is_finite() || m.emission.min_element() < 0.0 => {
            Some("its emission is none")
        }
        () if !m.alpha_cutoff.is_finite() || !m.normal_scale.is_finite() => {
            Some("its cutoff or scale is not finite")
        }
        () if maps.into_iter().flatten().any(|t| t as usize >= textures) => {
            Some("a texture is missing")
        }
        () => None,
    }
}

/// What a scene's export loses, written to and read back from a folder.
pub fn loss(scene: &Scene, folder: &Path) -> Option<String> {
    let path = folder.join("export.glb");
    if let Err(error) = scene.export(&path) {
        return Some(format!("it cannot be exported: {error}"));
    }
    let again = match Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(())) {
        Ok(again) => again,
        Err(error) => return Some(format!("its export cannot be read: {error}")),
    };
    // An export holds one pose, and triangles without area in that pose are left out when it is read.
    let triangles = |s: &Scene| {
        if scene.deformers.is_empty() {
            s.triangle_count()
        } else {
            0
        }
    };
    let counts = |s: &Scene| {
        (
            triangles(s),
            s.materials.len(),
            s.textures.len(),
            s.lights.len(),
            s.cameras.len(),
        )
    };
    if counts(scene) != counts(&again) {
        return Some(format!(
            "its export holds {:?} instead of {:?}",
            counts(&again),
            counts(scene)
        ));
    }
    let ((low, high), (low2, high2)) = (scene.bounds(), again.bounds());
    let most = 1e-4
        * (high - low)
            .length()
            .max(low.abs().max(high.abs()).max_element());
    let moved = (low - low2).abs().max((high - high2).abs()).max_element();
    (moved > most && scene.deformers.is_empty())
        .then(|| format!("its export is {low2} to {high2} instead of {low} to {high}"))
}
