//! glTF files that another program compressed: gltfpack 1.3, see `tests/gltf_compressed/README.md`.

mod common;

use common::model_file::open;
use common::root;
use conelab::scene::Scene;
use glam::{Vec2, Vec3, Vec4};
use std::collections::{BTreeMap, BTreeSet};

fn sheet(name: &str) -> Scene {
    let scene = open(&root().join("tests/gltf_compressed").join(name)).unwrap();
    assert_eq!(scene.warnings, [""; 0], "{name}");
    scene
}

struct Corner {
    position: Vec3,
    normal: Vec3,
    uv: Vec2,
    color: Vec4,
}

/// Triangles by the places of their corners in the sheet of 9 by 9, the lowest first.
type Triangles = BTreeSet<[(u32, u32); 3]>;

/// Corners in the world by their place, and the triangles that they make.
fn corners(scene: &Scene) -> (BTreeMap<(u32, u32), Corner>, Triangles) {
    let instance = &scene.instances[0];
    let mesh = &scene.meshes[instance.mesh as usize];
    let place = |i: u32| {
        let [u, v] = mesh.vertices[i as usize]
            .uv
            .map(|c| (c * 8.0).round() as u32);
        (u, v)
    };
    let corner = |&i: &u32| {
        let v = &mesh.vertices[i as usize];
        let position = instance.transform.transform_point3(Vec3::from(v.position));
        let (normal, uv, color) = (Vec3::from(v.normal), Vec2::from(v.uv), Vec4::from(v.color));
        (
            place(i),
            Corner {
                position,
                normal,
                uv,
                color,
            },
        )
    };
    let triangle = |indices: &[u32]| {
        let mut places = [0, 1, 2].map(|k| place(indices[k]));
        let first = (0..3).min_by_key(|&k| places[k]).unwrap();
        places.rotate_left(first);
        places
    };
    (
        mesh.indices.iter().map(corner).collect(),
        mesh.indices.chunks(3).map(triangle).collect(),
    )
}

/// Largest distances between two scenes' corners: positions, normals, coordinates and colours.
fn distances(a: &Scene, b: &Scene) -> [f32; 4] {
    let ((a, triangles), (b, other_triangles)) = (corners(a), corners(b));
    assert_eq!((a.len(), b.len(), triangles.len()), (81, 81, 128));
    assert!(triangles == other_triangles, "not the same triangles");
    a.iter().fold([0.0; 4], |most, (place, a)| {
        let b = &b[place];
        let found = [
            a.position.distance(b.position),
            a.normal.distance(b.normal),
            a.uv.distance(b.uv),
            a.color.distance(b.color),
        ];
        std::array::from_fn(|i| f32::max(most[i], found[i]))
    })
}

/// Half a step of each quantization, times the root of the number of components, and some rounding.
#[test]
fn compressed_files_hold_the_same_as_plain_ones() {
    let plain = sheet("plain.glb");
    for (name, most) in [
        // Positions of 14 bits for 2 m, normals of 8 bits, coordinates of 12 bits, colours of 8 bits.
        ("ext.glb", [0.000_11, 0.014, 0.000_18, 0.004]),
        ("khr.glb", [0.000_11, 0.014, 0.000_18, 0.009]),
        // Floats with 14 bits before the sign.
        ("float.glb", [0.000_11, 0.000_2, 0.000_11, 0.009]),
    ] {
        let found = distances(&plain, &sheet(name));
        assert!(
            found.iter().zip(most).all(|(found, most)| *found <= most),
            "{name}: {found:?} of {most:?}"
        );
    }
}
