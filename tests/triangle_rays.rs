//! Rays of pixels that hit triangles: a mirror shows an object thinner than a voxel where its image is in closed form.

mod common;

use common::{assert_clean, experiment, floats, lab, prepare, root};
use std::fmt::Write;

/// Picture size.
const SIZE: (u32, u32) = (96, 72);
const EYE: [f64; 3] = [0.0, 0.6, 2.0];
/// Vertical angle of view [deg].
const FOV: f64 = 5.0;
/// The strip glows in the plane z = -1, between these x and y.
const STRIP: [[f64; 2]; 2] = [[0.3, 0.312], [0.2, 1.2]];
/// The point in the middle of the picture: the image of a point of the strip in the floor, y = 0.
const MIDDLE: [f64; 3] = [0.306, -0.7, -1.0];

/// A mirror as a floor, and a strip of 1.2 cm over it. Voxels of 16^3 are 25 cm.
fn scene() -> String {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("triangle_rays");
    std::fs::create_dir_all(&folder).unwrap();
    let [[left, right], [low, high]] = STRIP;
    let corners = [
        [-2.0, 0.0, 2.0],
        [2.0, 0.0, 2.0],
        [2.0, 0.0, -2.0],
        [-2.0, 0.0, -2.0],
        [left, low, -1.0],
        [right, low, -1.0],
        [right, high, -1.0],
        [left, high, -1.0],
    ];
    let mut obj = "mtllib mirror.mtl\n".to_string();
    for [x, y, z] in corners {
        writeln!(obj, "v {x} {y} {z}").unwrap();
    }
    obj += "usemtl mirror\nf 1 2 3 4\nusemtl strip\nf 5 6 7 8\n";
    std::fs::write(folder.join("mirror.obj"), obj).unwrap();
    let materials = "newmtl mirror\nKd 1 1 1\nPr 0\nPm 1\nnewmtl strip\nKd 0 0 0\nKe 4 4 4\nPr 1\n";
    std::fs::write(folder.join("mirror.mtl"), materials).unwrap();
    let text = format!(
        "(models: [(file: \"mirror.obj\")], sky: (0, 0, 0), \
         cameras: {{ \"default\": (eye: {}, target: {}, fov_y: {FOV:?}) }})",
        triple(EYE),
        triple(MIDDLE)
    );
    let file = folder.join("mirror.ron");
    std::fs::write(&file, text).unwrap();
    file.to_string_lossy().into_owned()
}

fn triple([x, y, z]: [f64; 3]) -> String {
    format!("({x:?}, {y:?}, {z:?})")
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| x / dot(a, a).sqrt())
}

/// Column at which a pinhole camera sees a point in the picture's middle row [pixels from the left edge].
fn column(point: [f64; 3]) -> f64 {
    let from_eye = |p: [f64; 3]| [p[0] - EYE[0], p[1] - EYE[1], p[2] - EYE[2]];
    let forward = unit(from_eye(MIDDLE));
    let right = unit(cross(forward, [0.0, 1.0, 0.0]));
    let to = from_eye(point);
    let tangent = dot(to, right) / dot(to, forward);
    let scale = 0.5 * f64::from(SIZE.1) / (0.5 * FOV).to_radians().tan();
    0.5 * f64::from(SIZE.0) + scale * tangent
}

/// Columns of the middle row in which the mirror shows at least half of the strip's radiance.
fn bright(triangle_rays: &str) -> Vec<f64> {
    let lab = lab(root());
    let params = [
        ("voxel_dim", "16"),
        ("shadow_dim", "256"),
        ("triangle_rays", triangle_rays),
        ("gather_frames", "1"),
    ];
    let mut session = prepare(
        &lab,
        &experiment(&scene(), SIZE, &params),
        &["specularIndirect"],
    );
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    let texels = floats(&mut session, "specularIndirect", 0);
    assert_clean(&lab);
    let row = (SIZE.1 / 2 * SIZE.0) as usize;
    (0..SIZE.0 as usize)
        .filter(|x| texels[row + x][0] > 2.0)
        .map(|x| x as f64 + 0.5)
        .collect()
}

#[test]
fn a_mirror_shows_a_thin_strip_at_its_image() {
    let edges = STRIP[0].map(|x| column([x, MIDDLE[1], MIDDLE[2]]));
    let width = edges[1] - edges[0];
    assert!((2.0..5.0).contains(&width), "{width} pixels");
    let shows = |columns: &[f64]| {
        let near = |x: &f64| *x > edges[0] - 0.75 && *x < edges[1] + 0.75;
        let count = columns.len() as f64;
        columns.iter().all(near) && (count - width).abs() <= 1.0
    };
    for rays in ["mirrors", "all"] {
        let columns = bright(rays);
        assert!(shows(&columns), "{rays}: {columns:?}, expected {edges:?}");
    }
    let columns = bright("none");
    assert!(!shows(&columns), "voxels of 25 cm show it: {columns:?}");
}
