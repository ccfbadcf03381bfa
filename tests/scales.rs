//! Scenes of a few millimetres, of 200 km, and 100 km from the origin, with the planes that nobody has asked for.

mod common;

use common::closed_meshes::cube;
use common::triangles::{meets, world};
use common::{assert_clean, experiment, floats, lab, mean, root, scene};
use conelab::experiment::{Experiment, PlacedCamera};
use conelab::lab::{Lab, Session};
use conelab::measure::reference::{Goal, gather};
use conelab::scene::{Camera, Instance, LightKind, Mesh, Scene, Submesh, Vertex};
use glam::{DVec3, EulerRot, Mat4, Quat, Vec3};
use std::ops::ControlFlow;
use std::sync::Arc;

#[track_caller]
fn frame(lab: &Lab, experiment: &Experiment, scene: &Arc<Scene>, wanted: &[&str]) -> Session {
    let wanted = wanted.iter().map(|w| (*w).to_string()).collect();
    let (mut session, _) = lab
        .prepare(experiment, scene.clone(), |_| Ok(wanted))
        .unwrap();
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_clean(lab);
    session
}

/// A scene moved, then scaled. Spots keep what arrives at surfaces; there are no point lights among the scenes here.
fn placed(scene: &Scene, offset: Vec3, scale: f32) -> Arc<Scene> {
    let mut scene = scene.clone();
    let place = Mat4::from_scale(Vec3::splat(scale)) * Mat4::from_translation(offset);
    for instance in &mut scene.instances {
        instance.transform = place * instance.transform;
    }
    for light in &mut scene.lights {
        assert!(!matches!(light.kind, LightKind::Point));
        light.position = place.transform_point3(light.position);
        light.color *= if light.kind == LightKind::Directional {
            1.0
        } else {
            scale * scale
        };
    }
    for camera in scene.cameras.values_mut() {
        let (eye, target) = (
            place.transform_point3(camera.eye),
            place.transform_point3(camera.target),
        );
        *camera = Camera {
            eye,
            target,
            near: camera.near * scale,
            ..*camera
        };
    }
    Arc::new(scene)
}

/// Where each pixel's ray meets the scene, so many pixels below its middle, along the view direction; infinite where it does not.
fn distances(scene: &Scene, (width, height): (u32, u32), below: f64) -> Vec<f64> {
    let camera = &scene.cameras["default"];
    let eye = camera.eye.as_dvec3();
    let ahead = (camera.target.as_dvec3() - eye).normalize();
    let right = ahead.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(ahead);
    let tan = (0.5 * f64::from(camera.fov_y)).to_radians().tan();
    let triangles = world(scene);
    let rays = (0..width * height).map(|i| {
        let x = (2.0 * (f64::from(i % width) + 0.5) / f64::from(width) - 1.0) * f64::from(width)
            / f64::from(height);
        let y = 1.0 - 2.0 * (f64::from(i / width) + 0.5 + below) / f64::from(height);
        ahead + (right * x + up * y) * tan // 1 along the view direction
    });
    let met = |d: DVec3| {
        triangles
            .iter()
            .filter_map(|t| meets(eye, d, *t))
            .fold(f64::INFINITY, f64::min)
    };
    rays.map(met).collect()
}

#[test]
fn depth_is_right_from_millimetres_to_hundreds_of_kilometres() {
    const SIZE: (u32, u32) = (96, 54);
    let lab = lab(root());
    for name in ["pocket", "plain", "far-away", "huge-ground", "cornell"] {
        let scene = scene(name);
        let near = f64::from(scene.cameras["default"].near);
        // A rasteriser moves what it draws by up to 1/256 of a pixel, which near a horizon is far.
        let [expected, above, below] =
            [0.0, -1.0 / 128.0, 1.0 / 128.0].map(|shift| distances(&scene, SIZE, shift));
        let seen = expected.iter().filter(|e| e.is_finite()).count();
        for (drawn_by, depth) in [("raster", "depth"), ("compute", "visibleDepth")] {
            let settings = [("voxel_dim", "32"), ("gbuffer", drawn_by)];
            let mut session = frame(&lab, &experiment(name, SIZE, &settings), &scene, &[depth]);
            let found = floats(&mut session, depth, 0)
                .into_iter()
                .map(|d| near / f64::from(d[0]));
            let is_right = |i: usize, f: f64| {
                let (least, most) = (above[i].min(below[i]), above[i].max(below[i]));
                f == expected[i] || f > 0.999 * least && f < 1.001 * most
            };
            // At the edges of surfaces either is right.
            let wrong = found.enumerate().filter(|(i, f)| !is_right(*i, *f)).count();
            println!(
                "{name}, {drawn_by}: {wrong} of {} pixels are off, {seen} see a surface",
                expected.len()
            );
            assert!(
                wrong * 200 <= expected.len() && seen * 4 > expected.len(),
                "{name}, {drawn_by}: {wrong}, {seen}"
            );
        }
    }
}

/// The light of two scenes that must look alike: means of its parts, and how many pixels differ.
#[track_caller]
fn assert_alike(name: &str, changed: &Arc<Scene>) {
    let lab = lab(root());
    let experiment = experiment(
        name,
        (120, 68),
        &[("voxel_dim", "64"), ("shadow_dim", "1024")],
    );
    let parts = ["direct", "diffuseIndirect", "specularIndirect", "radiance"];
    let mut sessions =
        [scene(name), changed.clone()].map(|scene| frame(&lab, &experiment, &scene, &parts));
    for part in parts {
        let [a, b] = sessions.each_mut().map(|s| floats(s, part, 0));
        let (one, other) = (mean(&a), mean(&b));
        let far = |p: &(&[f32; 4], &[f32; 4])| {
            let (a, b) = (p.0[1], p.1[1]);
            (a - b).abs() > 0.1 * a.max(b) + 0.01 * one as f32
        };
        let differ = a.iter().zip(&b).filter(far).count();
        println!(
            "{name}, {part}: {one:.5} and {other:.5}, {differ} of {} pixels differ",
            a.len()
        );
        assert!(
            (one / other - 1.0).abs() < 0.02,
            "{name}, {part}: {one} is not {other}"
        );
        assert!(
            differ * 20 < a.len(),
            "{name}, {part}: {differ} pixels differ"
        );
    }
}

#[test]
fn a_room_of_millimetres_looks_as_one_of_metres() {
    assert_alike("pocket", &placed(&scene("pocket"), Vec3::ZERO, 1000.0));
}

#[test]
fn a_room_far_from_the_origin_looks_as_one_at_it() {
    assert_alike(
        "far-away",
        &placed(&scene("far-away"), Vec3::new(-80_000.0, 0.0, 60_000.0), 1.0),
    );
}

/// One map over 200 km has texels of 50 m, in which a house casts no shadow.
#[test]
fn what_is_small_in_a_huge_scene_casts_its_shadow() {
    let home = common::home();
    let lab = lab(home.path());
    for (name, least) in [("plain", 0.03), ("huge-ground", 0.0)] {
        let with = |maps: &str| {
            experiment(
                name,
                (120, 68),
                &[("shadow_maps", maps), ("voxel_dim", "32")],
            )
        };
        let keep_on = &mut |_| ControlFlow::Continue(());
        let truth = gather(
            &lab,
            &with("0"),
            &scene(name),
            1,
            Goal::Samples(32),
            keep_on,
        )
        .unwrap();
        let truth = &truth.parts["direct"].mean.rgb;
        let wrong = |maps: &str| {
            let found = floats(
                &mut frame(&lab, &with(maps), &scene(name), &["direct"]),
                "direct",
                0,
            );
            // Where all of a pixel is lit or in shadow, and a lamp of one direction leaves no noise.
            let differ = found
                .iter()
                .zip(truth)
                .filter(|(f, t)| (f[1] - t[1]).abs() > 0.2 * f[1].max(t[1]) + 0.02);
            differ.count() as f64 / truth.len() as f64
        };
        let (one, nested) = (wrong("1"), wrong("0"));
        println!(
            "{name}: {:.1} % of the pixels have the wrong direct light, {:.1} % with one map",
            100.0 * nested,
            100.0 * one
        );
        assert!(
            nested < 0.01 && one >= least,
            "{name}: {nested}, with one map {one}"
        );
    }
    assert_clean(&lab);
}

/// Maps around the camera move by whole texels, so that the shadows of what stands still do.
#[test]
fn shadow_maps_move_by_whole_texels() {
    let lab = lab(root());
    let scene = scene("plain");
    let dim = 512;
    let params = [("shadow_dim", "512"), ("voxel_dim", "32")];
    let mut session = frame(
        &lab,
        &experiment("plain", (64, 36), &params),
        &scene,
        &["shadowLayers"],
    );
    let camera = &scene.cameras["default"];
    let mut layers = |by: Vec3| -> Vec<Vec<f32>> {
        let (eye, target) = (
            (camera.eye + by).to_array(),
            (camera.target + by).to_array(),
        );
        session.place_camera(&PlacedCamera::new(eye.into(), target.into(), camera.fov_y));
        session.frame(0.0).unwrap();
        session.finish().unwrap();
        let words: Vec<f32> =
            bytemuck::pod_collect_to_vec(&session.buffer("shadowLayers").unwrap());
        words.chunks(24).map(<[f32]>::to_vec).collect()
    };
    let first = layers(Vec3::ZERO);
    assert_eq!(first.len(), 4, "200 km need four maps");
    let mut moved = [0; 4];
    for i in 1..20 {
        let there = layers(Vec3::new(0.07, 0.01, -0.11) * i as f32);
        for (k, (a, b)) in first.iter().zip(&there).enumerate() {
            // The matrix's last column: x and y in half widths of the map.
            for row in [12, 13] {
                let texels = (b[row] - a[row]) * 0.5 * dim as f32;
                assert!(
                    (texels - texels.round()).abs() < 0.01,
                    "map {k} moved by {texels} texels"
                );
                moved[k] += texels.round().abs() as i32;
            }
        }
    }
    println!("texels that the maps moved by, in all: {moved:?}");
    assert!(moved[0] == 0 && moved[3] > 100, "{moved:?}");
    assert_clean(&lab);
}

#[test]
fn paths_see_what_is_small_or_far_away_too() {
    let home = common::home();
    let lab = lab(home.path());
    for (name, offset, scale) in [
        ("pocket", Vec3::ZERO, 1000.0),
        ("far-away", Vec3::new(-80_000.0, 0.0, 60_000.0), 1.0),
    ] {
        let own = scene(name);
        let other = placed(&own, offset, scale);
        let experiment = experiment(name, (48, 27), &[]);
        let [a, b] = [own, other].map(|scene| {
            let keep_on = &mut |_| ControlFlow::Continue(());
            gather(&lab, &experiment, &scene, 1, Goal::Samples(64), keep_on).unwrap()
        });
        for part in ["direct", "diffuse", "total"] {
            let [a, b] = [&a, &b].map(|r| r.parts[part].mean.mean());
            println!("{name}, {part}: {a:.5} and {b:.5}");
            assert!((a / b - 1.0).abs() < 0.03, "{name}, {part}: {a} is not {b}");
        }
    }
    assert_clean(&lab);
}

/// The room of `emitters` with lamps of one kind and size alone.
fn lamps(mesh: &Mesh, size: f32) -> Arc<Scene> {
    let mut scene = Scene::clone(&scene("emitters"));
    scene
        .instances
        .retain(|i| scene.meshes[i.mesh as usize].name == "room");
    let glowing = scene
        .materials
        .iter()
        .position(|m| m.emission != Vec3::ZERO)
        .unwrap() as u32;
    let submeshes = vec![Submesh {
        material: glowing,
        ..mesh.submeshes[0]
    }];
    scene.meshes.push(Mesh {
        submeshes,
        ..mesh.clone()
    });
    let mesh = scene.meshes.len() as u32 - 1;
    scene.instances.extend((0..24).map(|i| {
        // Spread evenly (Roberts 2018, R3), each turned another way.
        let [x, y, z] =
            [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|step: f32| (step * i as f32).fract());
        let turn = Quat::from_euler(EulerRot::XYZ, 7.0 * x, 7.0 * y, 7.0 * z);
        let place = Vec3::new(-2.0 + 4.0 * x, 0.5 + 1.8 * y, -2.0 + 3.0 * z);
        let transform = Mat4::from_scale_rotation_translation(Vec3::splat(size), turn, place);
        Instance {
            name: format!("lamp {i}"),
            mesh,
            transform,
            mover: None,
        }
    }));
    Arc::new(scene)
}

/// Lamps of a voxel or so are as bright as they are: what voxels keep of them is neither their cells nor nothing.
#[test]
fn small_lamps_shine_as_bright_as_they_are() {
    let home = common::home();
    let lab = lab(home.path());
    const CELL: f32 = 5.4 / 59.0; // of 64 across the scene, five of them beside it
    let ball = cube(3, 1.0);
    let leaf = {
        let at = |x: f32, y: f32| Vertex {
            position: [x, y, 0.0],
            normal: [0.0, 0.0, 1.0],
            ..Vertex::default()
        };
        let vertices = vec![at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)];
        Mesh {
            vertices,
            indices: vec![0, 1, 2, 0, 2, 3],
            ..ball.clone()
        }
    };
    let leaf = Mesh {
        submeshes: vec![Submesh {
            first_index: 0,
            index_count: 6,
            material: 0,
        }],
        ..leaf
    };
    for (name, mesh, across) in [("balls", &ball, 1.4), ("leaves", &leaf, 1.0)] {
        for cells in [0.7, 1.5, 3.0] {
            let scene = lamps(mesh, cells * CELL / across);
            let experiment = |voxelizer| {
                let settings = [
                    ("voxel_dim", "64"),
                    ("bounces", "one"),
                    ("gather_frames", "1"),
                    ("pixel_rays", "32"),
                ];
                experiment(
                    "emitters",
                    (64, 36),
                    &[&settings[..], &[("voxelizer", voxelizer)]].concat(),
                )
            };
            let keep_on = &mut |_| ControlFlow::Continue(());
            let truth = gather(
                &lab,
                &experiment("compute"),
                &scene,
                1,
                Goal::Samples(256),
                keep_on,
            )
            .unwrap();
            let truth = truth.parts["diffuse"].mean.mean();
            for voxelizer in ["compute", "raster"] {
                let mut frame = frame(&lab, &experiment(voxelizer), &scene, &["diffuseIndirect"]);
                let found = mean(&floats(&mut frame, "diffuseIndirect", 0));
                println!(
                    "{name} of {cells} cells, {voxelizer}: {:.3} of the light",
                    found / truth
                );
                assert!(
                    (0.9..1.1).contains(&(found / truth)),
                    "{name} of {cells} cells: {found}, not {truth}"
                );
            }
        }
    }
    assert_clean(&lab);
}
