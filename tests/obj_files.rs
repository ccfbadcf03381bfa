//! OBJ and MTL files as other programs write them: one table of inputs and expected values.

#[path = "obj_files/cases.rs"]
mod cases;
mod common;

use cases::{CASES, Case, Expect};
use conelab::scene::{Material, Mesh, Scene, Vertex, Wrap};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;
use tempfile::TempDir;

fn open(path: &Path) -> Result<Scene, String> {
    Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(()))
        .map_err(|e| e.to_string())
}

/// A folder with every picture that the cases name.
fn pictures() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("textures")).unwrap();
    let save = |name: &str, texel: &dyn Fn(u32, u32) -> [u8; 4]| {
        image::RgbaImage::from_fn(8, 8, |x, y| image::Rgba(texel(x, y)))
            .save(folder.path().join(name))
            .unwrap();
    };
    for name in ["checker.png", "textures/wall.png", "my wall.png"] {
        save(name, &|x, y| {
            if (x + y) % 2 == 0 {
                [200, 100, 50, 255]
            } else {
                [20, 40, 60, 255]
            }
        });
    }
    for name in ["brick_nor_gl_1k.png", "lean.png"] {
        save(name, &|_, _| [128, 218, 218, 255]);
    }
    save("wall_normal_height.png", &|x, _| {
        [x as u8 * 30, x as u8 * 30, x as u8 * 30, 255]
    });
    save("leaf.png", &|x, _| {
        [50, 200, 50, if x < 4 { 255 } else { 0 }]
    });
    save("clear.png", &|_, _| [50, 200, 50, 0]);
    folder
}

struct Opened {
    scene: Scene,
}

impl Opened {
    /// Every triangle with its material.
    fn triangles(&self) -> impl Iterator<Item = ([Vertex; 3], &Material)> {
        let of = |mesh: &Mesh, first: u32| {
            [0, 1, 2].map(|k| mesh.vertices[mesh.indices[first as usize + k] as usize])
        };
        self.scene.meshes.iter().flat_map(move |mesh| {
            mesh.submeshes.iter().flat_map(move |submesh| {
                let firsts =
                    (submesh.first_index..submesh.first_index + submesh.index_count).step_by(3);
                firsts.map(move |first| {
                    (
                        of(mesh, first),
                        &self.scene.materials[submesh.material as usize],
                    )
                })
            })
        })
    }

    fn corners(&self, at: [f32; 3]) -> Vec<(Vertex, &Material)> {
        let all = self
            .triangles()
            .flat_map(|(triangle, material)| triangle.map(|vertex| (vertex, material)));
        let found: Vec<_> = all.filter(|(vertex, _)| vertex.position == at).collect();
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
        let near = |a: &[f32], b: &[f32]| {
            let same = a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
            if same {
                Ok(())
            } else {
                Err(format!("{a:?} instead of {b:?}"))
            }
        };
        let same = |a: String, b: String| {
            if a == b {
                Ok(())
            } else {
                Err(format!("{a} instead of {b}"))
            }
        };
        let corner = |v: &Vertex| Vec3::from(v.position);
        let area = |t: &[Vertex; 3]| {
            (corner(&t[1]) - corner(&t[0]))
                .cross(corner(&t[2]) - corner(&t[0]))
                .length()
                / 2.0
        };
        match *expect {
            Expect::Triangles(count) => {
                same(self.scene.triangle_count().to_string(), count.to_string())
            }
            Expect::Meshes(names) => {
                let found: Vec<&str> = self.scene.meshes.iter().map(|m| m.name.as_str()).collect();
                same(format!("{found:?}"), format!("{names:?}"))
            }
            Expect::Area(expected) => near(
                &[self.triangles().map(|(t, _)| area(&t)).sum()],
                &[expected],
            ),
            Expect::Covers(x, y, count) => {
                let covers = |t: &[Vertex; 3]| {
                    let p = t.map(|v| Vec2::new(v.position[0], v.position[1]) - Vec2::new(x, y));
                    let sides = [
                        p[0].perp_dot(p[1]),
                        p[1].perp_dot(p[2]),
                        p[2].perp_dot(p[0]),
                    ];
                    sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
                };
                same(
                    self.triangles()
                        .filter(|(t, _)| covers(t))
                        .count()
                        .to_string(),
                    count.to_string(),
                )
            }
            Expect::Uv(at, [u, v]) => self
                .corners(at)
                .iter()
                .try_for_each(|(vertex, _)| near(&vertex.uv, &[u, 1.0 - v])),
            Expect::NoUv(at) => self
                .corners(at)
                .iter()
                .try_for_each(|(vertex, _)| near(&vertex.uv, &[0.0; 2])),
            Expect::Normal(at, normal) => self
                .corners(at)
                .iter()
                .try_for_each(|(vertex, _)| near(&vertex.normal, &normal)),
            Expect::Normals(at, count) => {
                let round = |v: &Vertex| v.normal.map(|c| (c * 1000.0).round() as i32);
                let distinct: BTreeSet<[i32; 3]> = self
                    .corners(at)
                    .iter()
                    .map(|(vertex, _)| round(vertex))
                    .collect();
                same(distinct.len().to_string(), count.to_string())
            }
            Expect::Face(at, color) => {
                let mut found = self.corners(at).into_iter();
                found.try_for_each(|(_, material)| {
                    near(&material.base_color.truncate().to_array(), &color)
                })
            }
            Expect::Painted(at, color) => self
                .corners(at)
                .iter()
                .try_for_each(|(vertex, _)| near(&vertex.color[..3], &color)),
            Expect::Wraps(name, clamped) => {
                let wrap = if clamped { Wrap::Clamp } else { Wrap::Repeat };
                same(
                    format!("{:?}", self.material(name).lookups.base_color.wrap),
                    format!("{:?}", [wrap; 2]),
                )
            }
            Expect::Base(name, color) => near(
                &self.material(name).base_color.truncate().to_array(),
                &color,
            ),
            Expect::Emission(name, color) => near(&self.material(name).emission.to_array(), &color),
            Expect::Roughness(name, value) => near(&[self.material(name).roughness], &[value]),
            Expect::Metallic(name, value) => near(&[self.material(name).metallic], &[value]),
            Expect::Cutoff(name, value) => near(&[self.material(name).alpha_cutoff], &[value]),
            Expect::NormalScale(name, value) => near(&[self.material(name).normal_scale], &[value]),
            Expect::BaseMap(name, texel) => same(
                format!("{:?}", self.texel(self.material(name).base_color_texture)),
                format!("{texel:?}"),
            ),
            Expect::EmissionMap(name, texel) => same(
                format!("{:?}", self.texel(self.material(name).emission_texture)),
                format!("{texel:?}"),
            ),
            Expect::NormalMap(name, texel) => same(
                format!("{:?}", self.texel(self.material(name).normal_texture)),
                format!("{texel:?}"),
            ),
            Expect::Textures(count) => {
                same(self.scene.textures.len().to_string(), count.to_string())
            }
            Expect::Warns(text) => {
                let found = self.scene.warnings.iter().any(|w| w.contains(text));
                if found {
                    Ok(())
                } else {
                    Err(format!("no warning '{text}' in {:#?}", self.scene.warnings))
                }
            }
            Expect::Warnings(count) => {
                let found = self.scene.warnings.len() == count;
                if found {
                    Ok(())
                } else {
                    Err(format!("not {count} warnings: {:#?}", self.scene.warnings))
                }
            }
            Expect::Error(text) => Err(format!("it opened instead of '{text}'")),
        }
    }
}

/// What of a case is not as expected.
fn wrong(case: &Case, folder: &Path) -> Vec<String> {
    std::fs::write(folder.join("a.obj"), case.obj).unwrap();
    std::fs::write(folder.join("a.mtl"), case.mtl).unwrap();
    match open(&folder.join("a.obj")) {
        Ok(scene) => {
            let opened = Opened { scene };
            case.expect
                .iter()
                .filter_map(|expect| opened.check(expect).err())
                .collect()
        }
        Err(message) => match case.expect {
            [Expect::Error(text)] if message.contains("a.obj") && message.contains(text) => {
                Vec::new()
            }
            _ => vec![format!("it does not open: {message}")],
        },
    }
}

#[test]
fn files_of_other_programs_are_read_right() {
    let folder = pictures();
    let failed: Vec<String> = CASES
        .iter()
        .filter_map(|case| {
            let wrong = wrong(case, folder.path());
            (!wrong.is_empty()).then(|| format!("{}\n    {}", case.name, wrong.join("\n    ")))
        })
        .collect();
    println!("{} cases", CASES.len());
    assert!(
        failed.is_empty(),
        "{} of {} cases:\n{}",
        failed.len(),
        CASES.len(),
        failed.join("\n")
    );
}

/// A star-shaped polygon, which may be turned and moved in space, and its area.
fn star(seed: u64) -> (String, f64) {
    let mut state = seed;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    let corners = 3 + (random() * 40.0) as usize;
    let turn = glam::Quat::from_euler(
        glam::EulerRot::XYZ,
        random() * 6.0,
        random() * 6.0,
        random() * 6.0,
    );
    let away = Vec3::new(random(), random(), random()) * 20.0;
    let points: Vec<Vec3> = (0..corners)
        .map(|i| {
            let angle = i as f32 / corners as f32 * std::f32::consts::TAU;
            turn * (Vec3::new(angle.cos(), angle.sin(), 0.0) * (0.2 + random())) + away
        })
        .collect();
    let cross = |i: usize| {
        (points[i] - away)
            .cross(points[(i + 1) % corners] - away)
            .as_dvec3()
    };
    let area = (0..corners).map(cross).sum::<glam::DVec3>().length() / 2.0;
    let mut text: String = points
        .iter()
        .map(|p| format!("v {} {} {}\n", p.x, p.y, p.z))
        .collect();
    text += &format!(
        "f {}\n",
        (1..=corners)
            .map(|i| i.to_string())
            .collect::<Vec<_>>()
            .join(" ")
    );
    (text, area)
}

#[test]
fn triangles_of_random_polygons_have_their_area() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 0..200 {
        let (text, area) = star(seed);
        let path = folder.path().join("star.obj");
        std::fs::write(&path, &text).unwrap();
        let opened = Opened {
            scene: open(&path).unwrap(),
        };
        let of = |t: [Vertex; 3]| {
            let [a, b, c] = t.map(|v| Vec3::from(v.position).as_dvec3());
            (b - a).cross(c - a).length() / 2.0
        };
        let sum: f64 = opened.triangles().map(|(t, _)| of(t)).sum();
        assert!(
            (sum - area).abs() < 1e-4 * area,
            "seed {seed}: {sum} instead of {area}\n{text}"
        );
        assert_eq!(opened.scene.warnings, [""; 0], "seed {seed}");
    }
}

#[test]
fn a_thousand_of_a_kind_are_one_warning() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned();
    for i in 0..1000 {
        text += &format!("l 1 2\np 1\nusemtl m{i}\nf 1 2 3\nword{i} 1\nf 1/9 2/9 3/9\nf 1 2\n");
    }
    let path = folder.path().join("a.obj");
    std::fs::write(&path, text).unwrap();
    let warnings = open(&path).unwrap().warnings;
    assert_eq!(warnings.len(), 6, "{warnings:#?}");
    assert!(
        warnings
            .iter()
            .all(|w| w.contains("a.obj: ") && w.contains("(1000 times: '")),
        "{warnings:#?}"
    );
}

#[test]
fn many_files_that_are_not_there_are_searched_for_a_bounded_time() {
    let folder = tempfile::tempdir().unwrap();
    let mtl: String = (0..20_000)
        .map(|i| format!("newmtl m{i}\nmap_Ks C:\\a\\b\\c\\{i}.png\nmap_Ka {i}.png\n"))
        .collect();
    std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
    let mut obj = "mtllib a.mtl\n".repeat(1000);
    obj.extend((0..1000).map(|i| format!("mtllib {i}.mtl\n")));
    obj += "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(folder.path().join("a.obj"), obj).unwrap();
    let scene = open(&folder.path().join("a.obj")).unwrap();
    assert_eq!(scene.materials.len(), 20_001);
    assert_eq!(scene.warnings.len(), 4, "{:#?}", scene.warnings);
}
