//! The slice of the volume over the picture (`passes/parts/slice.ron`), against plane and box in closed form.

mod common;

use common::{floats, prepare};
use conelab::experiment::Experiment;
use glam::{DVec3, Vec3};

const CELLS: f64 = 32.0;

fn experiment(slice: &str) -> String {
    format!(
        "(graph: \"cones.ron\", scene: \"cornell\", size: (96, 72), camera: (eye: (1.5, 4.5, -6), target: (3, 2, 3), fov_y: 45), \
         params: {{ \"voxel_dim\": 32, \"shadow_dim\": 256, \"warp_alpha\": 1, \"slice\": {slice} }})"
    )
}

struct Frame {
    shown: Vec<[u8; 4]>,
    /// Distance of surfaces from the camera; 0 for the background.
    range: Vec<f64>,
    /// Corner and size of the volume.
    volume: [DVec3; 2],
}

fn frame(slice: &str) -> Frame {
    let lab = common::lab(common::root());
    let experiment = {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("slice.ron");
        std::fs::write(&file, experiment(slice)).unwrap();
        Experiment::read(&file).unwrap()
    };
    let mut session = prepare(&lab, &experiment, &["display", "gbufferDistance"]);
    session.run(2).unwrap();
    let display = session.texels("display", 0, 0).unwrap();
    let shown = display
        .bytes
        .chunks_exact(4)
        .map(|c| [c[0], c[1], c[2], c[3]]);
    let range = floats(&mut session, "gbufferDistance", 0);
    let map = session.buffer("volume").unwrap();
    let vector = |at: usize| {
        let part =
            |i: usize| f32::from_ne_bytes(map[at + 4 * i..at + 4 * i + 4].try_into().unwrap());
        Vec3::new(part(0), part(1), part(2)).as_dvec3()
    };
    Frame {
        shown: shown.collect(),
        range: range.iter().map(|v| f64::from(v[0])).collect(),
        volume: [vector(0), vector(16)],
    }
}

/// For each pixel whether the slice covers it, or nothing where rounding decides.
fn covered(frame: &Frame, axis: usize, position: f64) -> Vec<Option<bool>> {
    let eye = DVec3::new(1.5, 4.5, -6.0);
    let forward = (DVec3::new(3.0, 2.0, 3.0) - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let half = 22.5_f64.to_radians().tan();
    let [corner, size] = frame.volume;
    let in_volume = |p: DVec3| (p - corner) / size;
    let pixels = (0..72).flat_map(|y| (0..96).map(move |x| (x, y)));
    let of = |(x, y): (i32, i32)| {
        let across = half * 96.0 / 72.0 * ((f64::from(x) + 0.5) / 48.0 - 1.0);
        let above = half * (1.0 - (f64::from(y) + 0.5) / 36.0);
        let ray = (forward + across * right + above * up).normalize();
        let range = frame.range[(y * 96 + x) as usize];
        let end = eye + ray * if range > 0.0 { range } else { 1e4 };
        let (from, to) = (in_volume(eye), in_volume(end));
        let inside = |u: DVec3, axis: Option<usize>| {
            let rim = (0..3)
                .filter(|i| Some(*i) != axis)
                .map(|i| u[i].min(1.0 - u[i]));
            rim.fold(f64::INFINITY, f64::min)
        };
        // Signed: how clearly a surface is in the slice, and how clearly the ray crosses it before.
        let in_slice = (0.5 / CELLS - (to[axis] - position).abs()).min(inside(to, None));
        let part = (position - from[axis]) / (to[axis] - from[axis]);
        let crossing = from + (to - from) * part;
        let crosses = part.min(1.0 - part).min(inside(crossing, Some(axis)));
        let margin = in_slice.max(crosses);
        (margin.abs() > 2e-3).then_some(margin > 0.0)
    };
    pixels.map(of).collect()
}

#[test]
fn a_slice_covers_what_it_cuts_and_what_is_behind_it() {
    let plain = frame("(-1, -1)");
    for (axis, position) in [(0, 0.4), (1, 0.25), (2, 0.7)] {
        let cut = frame(&format!("({axis}, {position})"));
        let expected = covered(&plain, axis, position);
        let (mut on, mut off, mut wrong) = (0, 0, 0);
        for ((a, b), expected) in plain.shown.iter().zip(&cut.shown).zip(&expected) {
            match expected {
                Some(true) => on += 1,
                Some(false) => off += 1,
                None => continue,
            }
            wrong += usize::from((a != b) != expected.unwrap());
        }
        println!("axis {axis}: {on} pixels covered, {off} not, {wrong} wrong");
        assert!(on > 300 && off > 300, "{on} {off}");
        assert_eq!(wrong, 0, "axis {axis}");
    }
}
