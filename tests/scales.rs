//! Scenes of a few millimetres, of 200 km, and 100 km from the origin, with the planes that nobody has asked for.

mod common;

use common::triangles::{meets, world};
use common::{assert_clean, experiment, floats, lab, mean, root, scene};
use conelab::experiment::Experiment;
use conelab::lab::{Lab, Session};
use conelab::reference::{Goal, gather};
use conelab::scene::{Camera, LightKind, Scene};
use glam::{DVec3, Mat4, Vec3};
use std::ops::ControlFlow;
use std::sync::Arc;

#[track_caller]
fn frame(lab: &Lab, experiment: &Experiment, scene: &Arc<Scene>, wanted: &[&str]) -> Session {
    let wanted = wanted.iter().map(|w| (*w).to_string()).collect();
    let (mut session, _) = lab.prepare(experiment, scene.clone(), |_| Ok(wanted)).unwrap();
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
        light.color *= if light.kind == LightKind::Directional { 1.0 } else { scale * scale };
    }
    for camera in scene.cameras.values_mut() {
        let (eye, target) = (place.transform_point3(camera.eye), place.transform_point3(camera.target));
        *camera = Camera { eye, target, near: camera.near * scale, ..*camera };
    }
    Arc::new(scene)
}

/// Where each pixel's ray meets the scene, along the view direction; infinite where it does not.
fn distances(scene: &Scene, (width, height): (u32, u32)) -> Vec<f64> {
    let camera = &scene.cameras["default"];
    let eye = camera.eye.as_dvec3();
    let ahead = (camera.target.as_dvec3() - eye).normalize();
    let right = ahead.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(ahead);
    let tan = (0.5 * f64::from(camera.fov_y)).to_radians().tan();
    let triangles = world(scene);
    let rays = (0..width * height).map(|i| {
        let x = (2.0 * (f64::from(i % width) + 0.5) / f64::from(width) - 1.0) * f64::from(width) / f64::from(height);
        let y = 1.0 - 2.0 * (f64::from(i / width) + 0.5) / f64::from(height);
        ahead + (right * x + up * y) * tan // 1 along the view direction
    });
    let met = |d: DVec3| triangles.iter().filter_map(|t| meets(eye, d, *t)).fold(f64::INFINITY, f64::min);
    rays.map(met).collect()
}

#[test]
fn depth_is_right_from_millimetres_to_hundreds_of_kilometres() {
    const SIZE: (u32, u32) = (96, 54);
    let lab = lab(root());
    for name in ["pocket", "plain", "far-away", "huge-ground", "cornell"] {
        let scene = scene(name);
        let near = f64::from(scene.cameras["default"].near);
        let expected = distances(&scene, SIZE);
        let mut session = frame(&lab, &experiment(name, SIZE, &[("voxel_dim", "32")]), &scene, &["depth"]);
        let found = floats(&mut session, "depth", 0).into_iter().map(|d| near / f64::from(d[0]));
        let pairs: Vec<(f64, f64)> = found.zip(expected).collect();
        // At the edges of surfaces either is right.
        let wrong = pairs.iter().filter(|(f, e)| f != e && (f / e - 1.0).abs() > 1e-3).count();
        let seen = pairs.iter().filter(|p| p.1.is_finite()).count();
        println!("{name}: {wrong} of {} pixels are off, {seen} see a surface", pairs.len());
        assert!(wrong * 200 <= pairs.len() && seen * 4 > pairs.len(), "{name}: {wrong}, {seen}");
    }
}

/// The light of two scenes that must look alike: means of its parts, and how many pixels differ.
#[track_caller]
fn assert_alike(name: &str, changed: &Arc<Scene>) {
    let lab = lab(root());
    let experiment = experiment(name, (120, 68), &[("voxel_dim", "64"), ("shadow_dim", "1024")]);
    let parts = ["direct", "diffuseIndirect", "specularIndirect", "radiance"];
    let mut sessions = [scene(name), changed.clone()].map(|scene| frame(&lab, &experiment, &scene, &parts));
    for part in parts {
        let [a, b] = sessions.each_mut().map(|s| floats(s, part, 0));
        let (one, other) = (mean(&a), mean(&b));
        let far = |p: &(&[f32; 4], &[f32; 4])| {
            let (a, b) = (p.0[1], p.1[1]);
            (a - b).abs() > 0.1 * a.max(b) + 0.01 * one as f32
        };
        let differ = a.iter().zip(&b).filter(far).count();
        println!("{name}, {part}: {one:.5} and {other:.5}, {differ} of {} pixels differ", a.len());
        assert!((one / other - 1.0).abs() < 0.02, "{name}, {part}: {one} is not {other}");
        assert!(differ * 20 < a.len(), "{name}, {part}: {differ} pixels differ");
    }
}

#[test]
fn a_room_of_millimetres_looks_as_one_of_metres() {
    assert_alike("pocket", &placed(&scene("pocket"), Vec3::ZERO, 1000.0));
}

#[test]
fn a_room_far_from_the_origin_looks_as_one_at_it() {
    assert_alike("far-away", &placed(&scene("far-away"), Vec3::new(-80_000.0, 0.0, 60_000.0), 1.0));
}

#[test]
fn paths_see_what_is_small_or_far_away_too() {
    let home = tempfile::tempdir().unwrap();
    for folder in ["passes", "shaders"] {
        common::copy(&root().join(folder), &home.path().join(folder));
    }
    let lab = lab(home.path());
    for (name, offset, scale) in
        [("pocket", Vec3::ZERO, 1000.0), ("far-away", Vec3::new(-80_000.0, 0.0, 60_000.0), 1.0)]
    {
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
