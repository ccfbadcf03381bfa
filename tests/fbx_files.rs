//! FBX files: one table of files written by hand and expected values, and files of Blender.

#[macro_use]
#[path = "fbx_files/text.rs"]
mod text;
#[path = "fbx_files/cases.rs"]
mod cases;

use cases::{Case, Expect, cases};
use conelab::scene::{LightKind, Material, Scene, Vertex, Wrap};
use glam::{Mat4, Vec3};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};
use tempfile::TempDir;
use text::{Text, box_points, model, solid};

fn open(path: &Path) -> Result<Scene, String> {
    Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(()))
        .map_err(|e| e.to_string())
}

/// A folder with every picture that the cases name.
fn pictures() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("textures")).unwrap();
    let save = |name: &str, texel: &dyn Fn(u32) -> [u8; 4]| {
        image::RgbaImage::from_fn(8, 8, |x, _| image::Rgba(texel(x)))
            .save(folder.path().join(name))
            .unwrap();
    };
    save("textures/wall.png", &|_| [200, 100, 50, 255]);
    save("leaf.png", &|x| {
        if x < 4 { [0, 0, 0, 255] } else { [255; 4] }
    });
    save("lean.png", &|_| [128, 218, 218, 255]);
    save("height.png", &|x| {
        [x as u8 * 30, x as u8 * 30, x as u8 * 30, 255]
    });
    folder
}

/// A triangle in the world.
struct Face<'a> {
    corners: [Vertex; 3],
    material: &'a Material,
    mirrored: bool,
}

impl Face<'_> {
    fn points(&self) -> [Vec3; 3] {
        self.corners.map(|v| Vec3::from(v.position))
    }

    /// The normal by the winding. A mirrored transform reverses it.
    fn normal(&self) -> Vec3 {
        let [a, b, c] = self.points();
        (b - a).cross(c - a).normalize() * if self.mirrored { -1.0 } else { 1.0 }
    }
}

fn faces(scene: &Scene, time: f32) -> Vec<Face<'_>> {
    let mut all = Vec::new();
    let posed = scene.posed_meshes(time);
    for (number, instance) in scene.instances.iter().enumerate() {
        let world = scene.instance_transform(number, time);
        let mesh = &scene.meshes[instance.mesh as usize];
        for submesh in &mesh.submeshes {
            for first in (submesh.first_index..submesh.first_index + submesh.index_count).step_by(3)
            {
                let corners = [0, 1, 2].map(|k| {
                    moved(
                        posed[instance.mesh as usize][mesh.indices[first as usize + k] as usize],
                        &world,
                    )
                });
                let material = &scene.materials[submesh.material as usize];
                all.push(Face {
                    corners,
                    material,
                    mirrored: world.determinant() < 0.0,
                });
            }
        }
    }
    all
}

fn moved(vertex: Vertex, world: &Mat4) -> Vertex {
    let normal = world
        .inverse()
        .transpose()
        .transform_vector3(vertex.normal.into())
        .normalize();
    Vertex {
        position: world.transform_point3(vertex.position.into()).to_array(),
        normal: normal.to_array(),
        ..vertex
    }
}

fn near(a: impl AsRef<[f32]>, b: impl AsRef<[f32]>) -> Result<(), String> {
    let (a, b) = (a.as_ref(), b.as_ref());
    let close = a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| (a - b).abs() < 1e-4 * b.abs().max(1.0));
    if close {
        Ok(())
    } else {
        Err(format!("{a:?} instead of {b:?}"))
    }
}

fn same<T: PartialEq + std::fmt::Debug>(a: T, b: T) -> Result<(), String> {
    if a == b {
        Ok(())
    } else {
        Err(format!("{a:?} instead of {b:?}"))
    }
}

struct Opened {
    scene: Scene,
}

impl Opened {
    fn corners(&self, at: [f32; 3]) -> Vec<Vertex> {
        let all = faces(&self.scene, 0.0)
            .into_iter()
            .flat_map(|face| face.corners);
        let found: Vec<Vertex> = all.filter(|v| near(v.position, at).is_ok()).collect();
        assert!(!found.is_empty(), "no corner at {at:?}");
        found
    }

    fn material(&self, name: &str) -> &Material {
        let names = || {
            self.scene
                .materials
                .iter()
                .map(|m| &m.name)
                .collect::<Vec<_>>()
        };
        self.scene
            .materials
            .iter()
            .find(|m| m.name == name)
            .unwrap_or_else(|| panic!("no '{name}' in {:?}", names()))
    }

    fn texel(&self, index: Option<u32>) -> Option<[u8; 4]> {
        index.map(|i| {
            self.scene.textures[i as usize].mips[0][..4]
                .try_into()
                .unwrap()
        })
    }

    fn check(&self, expect: &Expect) -> Result<(), String> {
        let scene = &self.scene;
        match *expect {
            Expect::Triangles(count) => same(scene.triangle_count(), count),
            Expect::Meshes(count) => same(scene.meshes.len(), count),
            Expect::Instances(count) => same(scene.instances.len(), count),
            Expect::Box(columns) => {
                let [x, y, z, o] = columns.map(Vec3::from);
                let points = box_points();
                let place = |p: &[f64]| x * p[0] as f32 + y * p[1] as f32 + z * p[2] as f32 + o;
                points.chunks(3).try_for_each(|p| {
                    let count = self.corners(place(p).to_array()).len();
                    // Three sides meet in each corner, one or two triangles of each.
                    if (3..=6).contains(&count) {
                        Ok(())
                    } else {
                        Err(format!("{count} corners at {:?}", place(p)))
                    }
                })
            }
            Expect::Bounds(time, low, high) => {
                let points: Vec<Vec3> = faces(scene, time).iter().flat_map(Face::points).collect();
                let found = points
                    .iter()
                    .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| {
                        (l.min(*p), h.max(*p))
                    });
                // Motion is in straight lines between thirty poses a second.
                let close =
                    found.0.distance(low.into()) < 2e-2 && found.1.distance(high.into()) < 2e-2;
                if close {
                    Ok(())
                } else {
                    Err(format!(
                        "bounds {found:?} instead of {:?} at {time}",
                        (low, high)
                    ))
                }
            }
            Expect::Outward => {
                let all = faces(scene, 0.0);
                let middle =
                    all.iter().flat_map(Face::points).sum::<Vec3>() / (3 * all.len()) as f32;
                all.iter().try_for_each(|face| {
                    let normal = face.normal();
                    let away = normal.dot(face.points()[0] - middle);
                    if away < -1e-6 {
                        return Err(format!("a face looks inward: {:?}", face.points()));
                    }
                    face.corners
                        .iter()
                        .try_for_each(|corner| near(corner.normal, normal.to_array()))
                })
            }
            Expect::Normals(at, count) => {
                let round = |v: &Vertex| v.normal.map(|c| (c * 1000.0).round() as i32);
                same(
                    self.corners(at)
                        .iter()
                        .map(round)
                        .collect::<BTreeSet<_>>()
                        .len(),
                    count,
                )
            }
            Expect::Normal(at, normal) => self
                .corners(at)
                .iter()
                .try_for_each(|v| near(v.normal, normal)),
            Expect::Uv(at, [u, v]) => {
                let found = self.corners(at);
                // The box has other coordinates at each corner of a side.
                let any = found
                    .iter()
                    .any(|corner| near(corner.uv, [u, 1.0 - v]).is_ok());
                if any {
                    Ok(())
                } else {
                    near(found[0].uv, [u, 1.0 - v])
                }
            }
            Expect::SecondUv(at, [u, v]) => self
                .corners(at)
                .iter()
                .try_for_each(|corner| near(corner.uv_second, [u, 1.0 - v])),
            Expect::Faces(at, colors) => {
                let here =
                    |face: &&Face| face.points().iter().any(|p| near(p.to_array(), at).is_ok());
                let found: BTreeSet<[i32; 3]> = faces(scene, 0.0)
                    .iter()
                    .filter(here)
                    .map(|f| {
                        f.material
                            .base_color
                            .truncate()
                            .to_array()
                            .map(|c| (c * 1000.0) as i32)
                    })
                    .collect();
                same(
                    found,
                    colors
                        .iter()
                        .map(|c| c.map(|c| (c * 1000.0) as i32))
                        .collect(),
                )
            }
            Expect::Painted(at, color) => self
                .corners(at)
                .iter()
                .try_for_each(|v| near(&v.color[..3], color)),
            Expect::Base(name, color) => {
                near(self.material(name).base_color.truncate().to_array(), color)
            }
            Expect::Emission(name, color) => near(self.material(name).emission.to_array(), color),
            Expect::Roughness(name, value) => near([self.material(name).roughness], [value]),
            Expect::Metallic(name, value) => near([self.material(name).metallic], [value]),
            Expect::Ior(name, value) => near([self.material(name).ior], [value]),
            Expect::LeftOut(name, expected) => same(self.material(name).is_left_out(), expected),
            Expect::Cutoff(name, value) => near([self.material(name).alpha_cutoff], [value]),
            Expect::Clamped(name, clamped) => {
                let wrap = if clamped { Wrap::Clamp } else { Wrap::Repeat };
                same(self.material(name).lookups.base_color.wrap, [wrap; 2])
            }
            Expect::BaseMap(name, second, texel) => {
                same(self.material(name).lookups.base_color.second_set, second)?;
                same(
                    self.texel(self.material(name).base_color_texture),
                    Some(texel),
                )
            }
            Expect::NormalMap(name, texel) => {
                same(self.texel(self.material(name).normal_texture), texel)
            }
            Expect::Light(name, kind, color, position, direction) => {
                let names: Vec<&String> = scene.lights.iter().map(|l| &l.name).collect();
                let light = scene
                    .lights
                    .iter()
                    .find(|l| l.name == name)
                    .ok_or(format!("lights are {names:?}"))?;
                let found = match light.kind {
                    LightKind::Directional => "directional".into(),
                    LightKind::Point => "point".into(),
                    LightKind::Spot { inner, outer } => {
                        format!("spot {:.0} {:.0}", inner.to_degrees(), outer.to_degrees())
                    }
                    other => format!("{other:?}"),
                };
                same(found.as_str(), kind)?;
                near(light.color.to_array(), color)?;
                near(light.position.to_array(), position)?;
                near(light.direction.to_array(), direction)
            }
            Expect::Dark(name) => same(scene.lights.iter().any(|l| l.name == name), false),
            Expect::Camera(name, eye, direction, up, fov_y, plane) => {
                let camera = scene
                    .cameras
                    .get(name)
                    .ok_or(format!("cameras are {:?}", scene.cameras.keys()))?;
                near(camera.eye.to_array(), eye)?;
                near(
                    (camera.target - camera.eye).normalize().to_array(),
                    direction,
                )?;
                near(camera.up.to_array(), up)?;
                near([camera.fov_y, camera.near], [fov_y, plane])
            }
            Expect::Warns(text) => {
                let found = scene.warnings.iter().any(|w| w.contains(text));
                if found {
                    Ok(())
                } else {
                    Err(format!("no warning '{text}' in {:#?}", scene.warnings))
                }
            }
            Expect::Warnings(count) => {
                if scene.warnings.len() == count {
                    Ok(())
                } else {
                    Err(format!("not {count}: {:#?}", scene.warnings))
                }
            }
            Expect::Error(text) => Err(format!("it opened instead of '{text}'")),
        }
    }
}

/// What of a case is not as expected.
fn wrong(case: &Case, folder: &Path) -> Vec<String> {
    std::fs::write(folder.join("a.fbx"), &*case.fbx).unwrap();
    match open(&folder.join("a.fbx")) {
        Ok(scene) => {
            let opened = Opened { scene };
            case.expect
                .iter()
                .filter_map(|expect| {
                    opened
                        .check(expect)
                        .err()
                        .map(|e| format!("{expect:?}: {e}"))
                })
                .collect()
        }
        Err(message) => match case.expect[..] {
            [Expect::Error(text)] if message.contains("a.fbx") && message.contains(text) => {
                Vec::new()
            }
            _ => vec![format!("it does not open: {message}")],
        },
    }
}

#[test]
fn files_are_read_right() {
    let folder = pictures();
    let all = cases();
    let check = |case: &Case| {
        let caught = std::panic::catch_unwind(|| wrong(case, folder.path()));
        let wrong =
            caught.unwrap_or_else(|panic| vec![format!("{:?}", panic.downcast_ref::<String>())]);
        (!wrong.is_empty()).then(|| format!("{}\n    {}", case.name, wrong.join("\n    ")))
    };
    let failed: Vec<String> = all.iter().filter_map(check).collect();
    println!("{} cases", all.len());
    assert!(
        failed.is_empty(),
        "{} of {} cases:\n{}",
        failed.len(),
        all.len(),
        failed.join("\n")
    );
}

/// Each corner of one scene has a corner of the other with its place, normal and texture coordinates.
fn matches(one: &[Face], other: &[Face]) -> Result<(), String> {
    let corners = |faces: &[Face]| {
        faces
            .iter()
            .flat_map(|f| f.corners)
            .collect::<Vec<Vertex>>()
    };
    let (ours, theirs) = (corners(one), corners(other));
    let close = |a: &Vertex, b: &Vertex| {
        let apart = |a: &[f32], b: &[f32]| {
            a.iter()
                .zip(b)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f32::max)
        };
        apart(&a.position, &b.position) < 1e-4
            && apart(&a.normal, &b.normal) < 1e-3
            && apart(&a.uv, &b.uv) < 1e-4
    };
    match ours.iter().find(|a| !theirs.iter().any(|b| close(a, b))) {
        None => Ok(()),
        Some(corner) => Err(format!("{corner:?} has no equal")),
    }
}

fn area(faces: &[Face]) -> f32 {
    let of = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).length();
    faces.iter().map(|face| of(face.points())).sum()
}

/// A scene that Blender wrote as binary FBX and as glTF (`blender.py`).
#[test]
fn blender_writes_one_scene_in_two_formats() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fbx_files");
    let (fbx, gltf) = (
        open(&folder.join("blender.fbx")).unwrap(),
        open(&folder.join("blender.glb")).unwrap(),
    );
    assert_eq!(fbx.warnings, [""; 0]);
    assert_eq!(
        fbx.instances.iter().filter(|i| i.mover.is_some()).count(),
        1
    );
    // Blender's first frame is 1, of 24 a second; motion of an FBX file begins at 0.
    for (time, other) in [(0.0, 1.0 / 24.0), (0.5, 0.5 + 1.0 / 24.0)] {
        let (a, b) = (faces(&fbx, time), faces(&gltf, other));
        assert_eq!(a.len(), b.len());
        assert!(
            (area(&a) - area(&b)).abs() < 1e-3,
            "{} and {}",
            area(&a),
            area(&b)
        );
        matches(&a, &b).unwrap();
        matches(&b, &a).unwrap();
    }
    for theirs in &gltf.materials {
        let ours = fbx
            .materials
            .iter()
            .find(|m| m.name == theirs.name)
            .unwrap();
        near(ours.base_color.to_array(), theirs.base_color.to_array()).unwrap();
        near(ours.emission.to_array(), theirs.emission.to_array()).unwrap();
        near(
            [ours.roughness, ours.metallic],
            [theirs.roughness, theirs.metallic],
        )
        .unwrap();
        let texels = |scene: &Scene, index: Option<u32>| {
            index.map(|i| scene.textures[i as usize].mips[0].clone())
        };
        assert_eq!(
            texels(&fbx, ours.base_color_texture),
            texels(&gltf, theirs.base_color_texture),
            "{}",
            ours.name
        );
    }
    assert_eq!(fbx.lights.len(), 3);
    for theirs in &gltf.lights {
        let ours = fbx.lights.iter().find(|l| l.name == theirs.name).unwrap();
        // glTF has lumens: 683 a watt.
        near((ours.color * 683.0).to_array(), theirs.color.to_array()).unwrap();
        near(ours.position.to_array(), theirs.position.to_array()).unwrap();
        near(ours.direction.to_array(), theirs.direction.to_array()).unwrap();
        assert_eq!(
            std::mem::discriminant(&ours.kind),
            std::mem::discriminant(&theirs.kind)
        );
        if let (LightKind::Spot { inner: a, outer: b }, LightKind::Spot { inner, outer }) =
            (ours.kind, theirs.kind)
        {
            near([a, b], [inner, outer]).unwrap();
        }
    }
    let (ours, theirs) = (fbx.cameras["default"], gltf.cameras["default"]);
    near(ours.eye.to_array(), theirs.eye.to_array()).unwrap();
    near(ours.target.to_array(), theirs.target.to_array()).unwrap();
    near(ours.up.to_array(), theirs.up.to_array()).unwrap();
    near([ours.fov_y, ours.near], [theirs.fov_y, theirs.near]).unwrap();
}

/// Opens bytes as a file. Work without bounds takes minutes; a busy machine takes seconds.
fn open_bytes(bytes: &[u8]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.fbx");
    std::fs::write(&path, bytes).unwrap();
    let begun = Instant::now();
    let opened = open(&path);
    assert!(
        begun.elapsed() < Duration::from_secs(30),
        "{:?}",
        begun.elapsed()
    );
    opened
}

#[test]
fn files_that_end_early_are_read_or_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fbx_files");
    let whole = std::fs::read(folder.join("blender.fbx")).unwrap();
    // A binary file ends with a mark: without the last nodes it is damaged.
    for part in 1..64 {
        let told = match open_bytes(&whole[..whole.len() * part / 64]) {
            Ok(scene) => panic!("{part}: {}", scene.summary()),
            Err(told) => told,
        };
        assert!(
            told.contains("a.fbx: it cannot be read ("),
            "part {part}: {told}"
        );
    }
    let text = solid(1) + model(2, "box", "Mesh", "");
    let text = text::document(text::Y_UP, &text, &(text::below(2, 0) + text::below(1, 2)));
    assert_eq!(open_bytes(text.as_bytes()).unwrap().triangle_count(), 12);
    for end in 0..text.len() {
        if let Ok(scene) = open_bytes(&text.as_bytes()[..end]) {
            assert!(scene.triangle_count() <= 12);
        }
    }
}

#[test]
fn absurd_files_are_refused_or_bounded() {
    let one = |objects: &Text, connections: &Text| {
        let text = text::document(text::Y_UP, objects, connections);
        open_bytes(text.as_bytes())
    };
    let joined = || text::below(2, 0) + text::below(1, 2);
    // More numbers than there are, and as many as memory has not.
    for count in ["99", "4000000000", "18446744073709551615", "-1", "x"] {
        let objects =
            Text(solid(1).replace("*24 {", &format!("*{count} {{"))) + model(2, "box", "Mesh", "");
        if let Ok(scene) = one(&objects, &joined()) {
            assert!(scene.triangle_count() <= 12, "{count}");
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fbx_files");
    let mut binary = std::fs::read(folder.join("blender.fbx")).unwrap();
    let at = binary
        .windows(10)
        .position(|bytes| bytes == b"\x08Verticesd")
        .unwrap()
        + 10;
    binary[at..at + 4].copy_from_slice(&0xffff_fff0_u32.to_le_bytes());
    let told = open_bytes(&binary).unwrap_err();
    assert!(
        told.contains("it needs more than 268435456 bytes of memory"),
        "{told}"
    );
    // Vertices that do not exist, texture coordinates that do not, and places that are too far.
    let polygons = text::SIDES.map(|index| if index == 7 { 70_000 } else { index });
    let broken = text::mesh(1, &box_points(), &polygons, "", &[]) + model(2, "box", "Mesh", "");
    let told = one(&broken, &joined()).unwrap_err();
    assert!(told.contains("a.fbx: it cannot be read ("), "{told}");
    let uvs = text::array("UV", &[0.5; 8]) + text::array("UVIndex", &[9_000; 24]);
    let uvs = text::layer("UV", 0, "", "ByPolygonVertex", "IndexToDirect", &uvs);
    let clamped = text::mesh(1, &box_points(), &text::SIDES, &uvs, &[("UV", 0)])
        + model(2, "box", "Mesh", "");
    let warnings = one(&clamped, &joined()).unwrap().warnings.join("\n");
    assert!(
        warnings.contains("the file has mistakes that were corrected (clamped index)"),
        "{warnings}"
    );
    let far = solid(1) + model(2, "box", "Mesh", &text::move_to(1e39, 0.0, 0.0));
    let told = one(&far, &joined()).unwrap_err();
    assert!(
        told.contains("'box' has a transform that is not finite"),
        "{told}"
    );
    // Nodes that are nested too deeply.
    let nodes: Text = (2..1000).map(|id| model(id, "n", "Null", "")).sum();
    let chain: Text = (2..1000)
        .map(|id| text::below(id, if id == 2 { 0 } else { id - 1 }))
        .sum();
    let told = one(&(solid(1) + nodes), &chain).unwrap_err();
    assert!(told.contains("nested more than 512 deep"), "{told}");
    // A node that is its own ancestor.
    let loops = solid(1) + model(2, "a", "Mesh", "") + model(3, "b", "Null", "");
    let circle = text::below(2, 3) + text::below(3, 2) + text::below(1, 2);
    let told = one(&loops, &circle).unwrap_err();
    assert!(
        told.contains("a.fbx: it cannot be read (cyclic node hierarchy)"),
        "{told}"
    );
    // Lists of materials that differ make a mesh of their own each, and 2^24 corners is what small files may have.
    let side = 300u32;
    let points: Vec<f64> = (0..side * side)
        .flat_map(|i| [f64::from(i % side), f64::from(i / side), 0.0])
        .collect();
    let square = |i: u32| {
        [i, i + 1, i + 1 + side]
            .map(|i| i as i32)
            .into_iter()
            .chain([-(i as i32 + side as i32) - 1])
    };
    let polygons: Vec<i32> = (0..side * (side - 1))
        .filter(|i| i % side < side - 1)
        .flat_map(square)
        .collect();
    let mut objects = text::mesh(1, &points, &polygons, "", &[]);
    let mut connections = Text::default();
    for id in 10..60 {
        objects = objects + model(id, "n", "Mesh", "") + text::material(id + 100, "m", "phong", "");
        connections =
            connections + text::below(id, 0) + text::below(1, id) + text::below(id + 100, id);
    }
    let told = one(&objects, &connections).unwrap_err();
    assert!(
        told.contains("many more corners than the file holds bytes"),
        "{told}"
    );
}
