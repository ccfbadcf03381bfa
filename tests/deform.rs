//! Skins and morph targets in the picture: what deforms must look like a mesh that was modelled in the pose.

mod common;

use common::{assert_clean, experiment, floats, home, lab, model_file};
use conelab::experiment::{CameraChoice, PlacedCamera};
use conelab::graph::run::Execution;
use conelab::lab::{Lab, Session};
use conelab::measure::oracle::triangles_of;
use conelab::measure::reference::{Goal, gather};
use conelab::scene::{Scene, Vertex};
use glam::Vec3;
use serde_json::json;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Rings of the figure, a tube of this radius from y 0 to 2 [m].
const RINGS: usize = 9;
const SIDES: usize = 12;
const RADIUS: f32 = 0.3;

/// A tube whose upper half bends by 90 degrees in a second, and whose top swells, on a floor that stands still. `shines`: it
/// is a lamp.
fn figure(shines: bool) -> Scene {
    let mut m = model_file::Model::new();
    let (mut positions, mut normals, mut weights, mut swollen) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut indices: Vec<u8> = Vec::new();
    for ring in 0..RINGS {
        let y = 2.0 * ring as f32 / (RINGS - 1) as f32;
        for side in 0..SIDES {
            let angle = std::f32::consts::TAU * side as f32 / SIDES as f32;
            let out = Vec3::new(angle.cos(), 0.0, angle.sin());
            positions.push((out * RADIUS + Vec3::Y * y).to_array());
            normals.push(out.to_array());
            let bends = (y - 0.5).clamp(0.0, 1.0);
            weights.push([1.0 - bends, bends, 0.0, 0.0]);
            swollen.push((out * (y - 1.0).max(0.0) * 0.2).to_array());
            if ring + 1 < RINGS {
                let next = (side + 1) % SIDES;
                let at = |r: usize, s: usize| (r * SIDES + s) as u8;
                indices.extend([at(ring, side), at(ring + 1, side), at(ring + 1, next)]);
                indices.extend([at(ring, side), at(ring + 1, next), at(ring, next)]);
            }
        }
    }
    let count = positions.len();
    let targets = m.floats(&swollen);
    let attributes = json!({ "POSITION": m.floats(&positions), "NORMAL": m.floats(&normals), "WEIGHTS_0": m.floats(&weights),
        "JOINTS_0": m.raw(model_file::U8, "VEC4", count, &[0u8, 1, 0, 0].repeat(count), json!({})) });
    let emission = if shines { 4.0 } else { 0.0 };
    let material = m
        .material(json!({ "doubleSided": true, "emissiveFactor": [emission / 4.0, emission / 4.0, emission / 4.0],
        "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.4, 0.2, 1.0], "metallicFactor": 0 } }));
    let index_count = indices.len();
    let primitive = json!({ "attributes": attributes, "material": material, "targets": [{ "POSITION": targets }],
        "indices": m.raw(model_file::U8, "SCALAR", index_count, &indices, json!({})) });
    let mesh = m.push("meshes", json!({ "primitives": [primitive] }));
    let upper = m.push("nodes", json!({ "translation": [0, 1, 0] }));
    let lower = m.node(json!({ "children": [upper] }));
    let down = |y: f32| {
        [
            1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., y, 0., 1f32,
        ]
    };
    let bytes: Vec<u8> = [down(0.0), down(-1.0)]
        .concat()
        .iter()
        .flat_map(|f| f.to_le_bytes())
        .collect();
    let inverse = m.raw(model_file::FLOAT, "MAT4", 2, &bytes, json!({}));
    let skin = m.push(
        "skins",
        json!({ "joints": [lower, upper], "inverseBindMatrices": inverse }),
    );
    let node = m.node(json!({ "mesh": mesh, "skin": skin }));
    let grey = m.material(json!({ "pbrMetallicRoughness": { "metallicFactor": 0 } }));
    let floor = m.square(json!({}), Some(grey));
    // The square lies in z = 0 and is turned to face upwards.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    m.node(json!({ "mesh": floor, "rotation": [-half, 0, 0, half], "scale": [3, 3, 3] }));
    let times = m.floats(&[[0.0], [1.0]]);
    let turns = m.floats(&[[0., 0., 0., 1.], [0., 0., half, half]]);
    let swells = m.floats(&[[0.0], [1.0]]);
    m.push(
        "animations",
        json!({
        "samplers": [{ "input": times, "output": turns }, { "input": times, "output": swells }],
        "channels": [{ "sampler": 0, "target": { "node": upper, "path": "rotation" } },
            { "sampler": 1, "target": { "node": node, "path": "weights" } }] }),
    );
    let folder = tempfile::tempdir().unwrap();
    let mut scene = model_file::open(&m.write(folder.path(), "figure.gltf")).unwrap();
    assert_eq!((scene.warnings.len(), scene.deformers.len()), (0, 1));
    if shines {
        // Nothing else does.
        scene.lights.clear();
        scene.sky = Vec3::ZERO;
    }
    scene
}

/// The same as a model of the pose at a time, which does not move. `place` moves a vertex by the formula of the skin.
fn modelled(scene: &Scene, time: f32) -> Scene {
    let mut still = Scene {
        deformers: Vec::new(),
        movers: Vec::new(),
        ..scene.clone()
    };
    let rest = &scene.deformers[0].rest;
    let angle = time * std::f32::consts::FRAC_PI_2;
    let (sin, cos) = angle.sin_cos();
    let mesh = &mut still.meshes[scene.deformers[0].mesh as usize];
    for (vertex, rest) in mesh.vertices.iter_mut().zip(rest) {
        *vertex = bent(rest, time, sin, cos);
    }
    still
}

/// The formula of glTF 2.0, 3.7.3.1, for two joints of which the upper one turns about (0, 1, 0).
fn bent(rest: &Vertex, time: f32, sin: f32, cos: f32) -> Vertex {
    let [x, y, z] = rest.position;
    let swell = 1.0 + (y - 1.0).max(0.0) * 0.2 * time / RADIUS;
    let (x, z) = (x * swell, z * swell);
    let weight = (y - 0.5).clamp(0.0, 1.0);
    let turned = [
        cos * x - sin * (y - 1.0),
        1.0 + sin * x + cos * (y - 1.0),
        z,
    ];
    let mix = |a: f32, b: f32| a + (b - a) * weight;
    let position = [mix(x, turned[0]), mix(y, turned[1]), z];
    // The blended turn is shrunk by its length, and turned by half-way angles.
    let (c, s) = (mix(1.0, cos), mix(0.0, sin));
    let length2 = c * c + s * s;
    let n = Vec3::from_array(rest.normal);
    let normal = Vec3::new(c * n.x - s * n.y, s * n.x + c * n.y, length2 * n.z).normalize();
    Vertex {
        position,
        normal: normal.to_array(),
        tangent: rest.tangent,
        ..*rest
    }
}

fn look(time: f64, settings: &[(&str, &str)]) -> conelab::experiment::Experiment {
    let mut look = experiment("figure", (48, 36), settings);
    look.camera = CameraChoice::Placed(PlacedCamera::new((0.5, 1.6, 4.0), (-0.3, 0.9, 0.0), 45.0));
    look.time = time;
    look
}

fn session(
    lab: &Lab,
    scene: &Arc<Scene>,
    time: f64,
    frames: usize,
    settings: &[(&str, &str)],
) -> Session {
    let wanted = vec!["radiance".to_owned()];
    let (mut session, _) = lab
        .prepare(&look(time, settings), scene.clone(), |_| Ok(wanted))
        .unwrap();
    session.run(frames).unwrap();
    session
}

fn mean_difference(a: &[[f32; 4]], b: &[[f32; 4]]) -> (f64, f64) {
    let differences = a
        .iter()
        .zip(b)
        .map(|(a, b)| f64::from((a[0] - b[0]).abs() + (a[1] - b[1]).abs()) / 2.0);
    let list: Vec<f64> = differences.collect();
    let level = a.iter().map(|c| f64::from(c[0] + c[1]) / 2.0).sum::<f64>() / a.len() as f64;
    (
        list.iter().sum::<f64>() / list.len() as f64 / level,
        list.iter().copied().fold(0.0, f64::max),
    )
}

const SMALL: [(&str, &str); 2] = [("voxel_dim", "32"), ("shadow_dim", "256")];

#[test]
fn voxels_shadows_and_pictures_follow_the_skin() {
    let lab = lab(common::root());
    let scene = Arc::new(figure(false));
    let mut pictures = Vec::new();
    for time in [0.0, 0.6] {
        let still = Arc::new(modelled(&scene, time));
        for voxelizer in ["compute", "raster"] {
            let settings = [&SMALL[..], &[("voxelizer", voxelizer)]].concat();
            let [moving, modelled] = [&scene, &still].map(|scene| {
                let mut session = session(&lab, scene, f64::from(time), 24, &settings);
                floats(&mut session, "radiance", 0)
            });
            let (mean, most) = mean_difference(&moving, &modelled);
            println!("{time} s, {voxelizer}: {mean:.2e} of the light, {most:.2e} at most");
            assert!(mean < 2e-3, "{time} s, {voxelizer}: {mean}");
            pictures.push(moving);
        }
    }
    // It is another picture than that of the pose at rest.
    assert!(mean_difference(&pictures[0], &pictures[2]).0 > 0.03);
    assert_clean(&lab);
}

#[test]
fn the_reference_follows_the_skin() {
    let home = home();
    let lab = lab(home.path());
    let keep_on = &mut |_| ControlFlow::Continue(());
    for shines in [false, true] {
        let scene = Arc::new(figure(shines));
        let mut means = Vec::new();
        for scene in [scene.clone(), Arc::new(modelled(&scene, 0.6))] {
            let found = gather(
                &lab,
                &look(0.6, &SMALL),
                &scene,
                2,
                Goal::Samples(256),
                keep_on,
            )
            .unwrap();
            means.push((
                found.parts["total"].mean.mean(),
                found.parts["total"].noise.relmse,
            ));
        }
        let [(moving, noise), (modelled, _)] = means[..] else {
            unreachable!()
        };
        println!("lamp {shines}: {moving:.6} and {modelled:.6}, noise {noise:.1e}");
        assert!(
            (moving / modelled - 1.0).abs() < 0.004,
            "{moving}, not {modelled}"
        );
    }
    assert_clean(&lab);
}

#[test]
fn incremental_frames_are_equal_to_full_ones() {
    let lab = lab(common::root());
    let scene = Arc::new(figure(false));
    let [all, changed] = [Execution::Full, Execution::Incremental].map(|execution| {
        let mut session = session(&lab, &scene, 0.0, 0, &SMALL);
        session.set_execution(execution);
        // It moves, stands, and moves on.
        let steps = [0.1, 0.1, 0.1, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0];
        steps.map(|step| {
            session.frame(step).unwrap();
            floats(&mut session, "radiance", 0)
        })
    });
    assert!(
        all == changed,
        "a picture that nothing was forgotten in differs"
    );
    assert_ne!(all[2], all[6]);
    assert_clean(&lab);
}

#[test]
fn exact_triangles_for_voxels_are_those_of_the_pose() {
    let scene = figure(false);
    let (found, expected) = (
        triangles_of(&scene, 0.6),
        triangles_of(&modelled(&scene, 0.6), 0.0),
    );
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(&expected) {
        a.corners
            .iter()
            .zip(&b.corners)
            .for_each(|(a, b)| assert!(a.distance(*b) < 1e-5, "{a} {b}"));
        a.normals
            .iter()
            .zip(&b.normals)
            .for_each(|(a, b)| assert!(a.distance(*b) < 1e-4, "{a} {b}"));
    }
    // And those of bounds hold all of them.
    let (low, high) = scene.bounds();
    let corners = (0..=20)
        .flat_map(|i| triangles_of(&scene, f64::from(i) * 0.0499))
        .flat_map(|t| t.corners);
    for corner in corners.map(|c| c.as_vec3()) {
        assert!(
            (corner - low).min_element() > -1e-4 && (high - corner).min_element() > -1e-4,
            "{corner}"
        );
    }
}

/// Midpoints of edges lie on their triangles, so that a pose has the same surface with them.
#[test]
fn triangles_that_were_split_follow_the_skin() {
    let scene = figure(false);
    let split = scene.split_triangles(0.1);
    let (deformer, mesh) = (
        &split.deformers[0],
        &split.meshes[split.deformers[0].mesh as usize],
    );
    assert_eq!(
        deformer.rest.len() + deformer.halves.len(),
        mesh.vertices.len()
    );
    assert!(
        mesh.triangle_count() > 3 * scene.meshes[scene.deformers[0].mesh as usize].triangle_count()
    );
    let area = |scene: &Scene, time: f64| -> f64 {
        let triangles = triangles_of(scene, time).into_iter();
        triangles
            .map(|t| {
                0.5 * (t.corners[1] - t.corners[0])
                    .cross(t.corners[2] - t.corners[0])
                    .length()
            })
            .sum()
    };
    for time in [0.0, 0.6, 0.9] {
        let (whole, parts) = (area(&scene, time), area(&split, time));
        println!("{time} s: {whole:.5} and {parts:.5} m^2");
        assert!(
            (parts / whole - 1.0).abs() < 1e-5,
            "{time} s: {whole} and {parts}"
        );
    }
    assert!(
        (area(&scene, 0.0) / area(&scene, 0.9) - 1.0).abs() > 1e-3,
        "the surface changes"
    );
}
