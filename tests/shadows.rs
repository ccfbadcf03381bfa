//! Shadow maps against rays: bent surfaces must not shadow themselves, and no light may leak for it.

mod common;

use common::{assert_clean, experiment, floats, home, lab, root};
use conelab::measure::reference::{Goal, gather};
use conelab::scene::Scene;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Hills of ten metres by ten, 60 x 60 quads.
fn hills() -> String {
    const EDGE: usize = 60;
    // Waves along x and z, their phases and height. Not the hills that the shadow's constants were chosen on.
    let waves: [[f64; 5]; 6] = [
        [0.9, 1.7, 0.3, 1.1, 0.20],
        [1.9, 0.6, 2.3, 0.4, 0.15],
        [0.5, 0.8, 4.0, 5.1, 0.25],
        [2.1, 2.0, 1.7, 3.3, 0.10],
        [1.3, 1.1, 5.5, 2.2, 0.18],
        [0.7, 2.2, 3.1, 0.9, 0.12],
    ];
    let at = |i: usize| 10.0 * i as f64 / EDGE as f64 - 5.0;
    let mut obj = String::new();
    for (j, i) in (0..=EDGE).flat_map(|j| (0..=EDGE).map(move |i| (j, i))) {
        let (x, z) = (at(i), at(j));
        let height: f64 = waves
            .iter()
            .map(|[a, b, p, q, h]| h * (a * x + p).sin() * (b * z + q).sin())
            .sum();
        writeln!(obj, "v {x} {} {z}", 1.2 * height).unwrap();
    }
    for (j, i) in (0..EDGE).flat_map(|j| (0..EDGE).map(move |i| (j, i))) {
        let a = j * (EDGE + 1) + i + 1;
        let (right, down) = (a + 1, a + EDGE + 1);
        writeln!(obj, "f {a} {down} {right}\nf {right} {down} {}", down + 1).unwrap();
    }
    obj
}

const SUN: &str = "lights: [Directional(name: \"sun\", color: (3, 3, 3), direction: (-0.7, -0.45, 0.3), shadow: true)], sky: (0, 0, 0)";

fn hilly(folder: &Path) -> String {
    std::fs::write(folder.join("hills.obj"), hills()).unwrap();
    let camera =
        "cameras: { \"default\": (eye: (-1.5, 1.8, 5.5), target: (-1.5, 0, 0), fov_y: 45) }";
    format!("(models: [(file: \"hills.obj\")], {SUN}, {camera})")
}

/// A ball of 1,280 triangles on a floor.
fn ball(_: &Path) -> String {
    format!(
        "(materials: {{ \"m\": (base_color: (0.8, 0.8, 0.8, 1)) }}, {SUN},\n\
         meshes: {{ \"ball\": [Sphere(material: \"m\", centre: (0, 1, 0), radius: 1, level: 3)],\n\
         \"floor\": [Quad(material: \"m\", corners: ((-6, 0, 6), (6, 0, 6), (6, 0, -6), (-6, 0, -6)))] }},\n\
         cameras: {{ \"default\": (eye: (1.5, 2.5, 4.5), target: (0, 0.7, 0), fov_y: 45) }})"
    )
}

/// Pixels that are black and should not be, and that are lit and should be black, with how many should be.
struct Wrong {
    black: usize,
    leaks: usize,
    dark: usize,
}

const SIZE: (u32, u32) = (480, 270);

fn wrong(scene: &Arc<Scene>, rays: &[[f32; 3]], map: &str) -> Wrong {
    let lab = lab(root());
    let e = experiment("cornell", SIZE, &[("voxel_dim", "16"), ("shadow_map", map)]);
    let (mut session, _) = lab
        .prepare(&e, scene.clone(), |_| Ok(vec!["direct".into()]))
        .unwrap();
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    let map = floats(&mut session, "direct", 0);
    assert_clean(&lab);
    // A twentieth of what a surface that faces the sun reflects: nearer to the terminator a ray and a map may differ.
    let brightest = rays.iter().map(|r| r[0]).fold(0.0, f32::max);
    let count = |f: &dyn Fn(usize) -> bool| (0..rays.len()).filter(|i| f(*i)).count();
    // The outline of a shadow may lie a pixel off.
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let around = |i: usize| {
        let (x, y) = (i % width, i / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(move |y| {
            (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| y * width + x)
        })
    };
    Wrong {
        black: count(&|i| map[i][0] == 0.0 && around(i).all(|k| rays[k][0] > 0.05 * brightest)),
        leaks: count(&|i| map[i][0] > 0.05 * brightest && around(i).all(|k| rays[k][0] == 0.0)),
        dark: count(&|i| rays[i][0] == 0.0),
    }
}

/// Direct light by rays, one bounce.
fn traced(scene: &Arc<Scene>) -> Vec<[f32; 3]> {
    let home = home();
    let lab = lab(home.path());
    let e = experiment("cornell", SIZE, &[]);
    let found = gather(&lab, &e, scene, 1, Goal::Samples(32), &mut |_| {
        ControlFlow::Continue(())
    })
    .unwrap();
    assert_clean(&lab);
    found.parts["direct"].mean.rgb.clone()
}

#[test]
fn bent_surfaces_do_not_shadow_themselves() {
    let dir = tempfile::tempdir().unwrap();
    for (name, scene) in [("hills", hilly as fn(&Path) -> String), ("ball", ball)] {
        let path = dir.path().join(format!("{name}.ron"));
        std::fs::write(&path, scene(dir.path())).unwrap();
        let scene = Arc::new(
            Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(())).unwrap(),
        );
        let rays = traced(&scene);
        for map in ["raster", "compute"] {
            let Wrong { black, leaks, dark } = wrong(&scene, &rays, map);
            println!("{name}, {map}: {black} black pixels, {leaks} leaks, {dark} dark");
            assert!(black < 10, "{name}, {map}: {black} black pixels");
            assert!(
                leaks * 2000 < dark,
                "{name}, {map}: {leaks} leaks of {dark}"
            );
        }
    }
}
