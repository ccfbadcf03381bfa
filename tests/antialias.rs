//! Anti-aliasing: a pixel's value against the area that a shining square covers of it.

mod common;

use common::{assert_clean, experiment, floats, home, lab};
use conelab::experiment::{CameraChoice, PlacedCamera};
use conelab::lab::{Lab, Session};
use conelab::scene::{
    Instance, Keyframe, Material, Mesh, Mover, Scene, Submesh, Texture, TextureFormat, Track,
    Vertex,
};
use glam::{Mat4, Quat, Vec3, Vec4};
use std::sync::Arc;

const SIZE: (u32, u32) = (64, 48);

/// A black square of a metre that shines with 1, level, around the origin.
fn shining_square() -> Scene {
    let corner = |x: f32, z: f32| Vertex {
        position: [x - 0.5, 0.0, z - 0.5],
        normal: [0.0, 1.0, 0.0],
        tangent: [1.0, 0.0, 0.0, 1.0],
        uv: [x, z],
        ..Vertex::default()
    };
    Scene {
        name: "square".into(),
        meshes: vec![Mesh {
            name: "square".into(),
            vertices: vec![
                corner(0.0, 0.0),
                corner(0.0, 1.0),
                corner(1.0, 1.0),
                corner(1.0, 0.0),
            ],
            indices: vec![0, 1, 2, 0, 2, 3],
            submeshes: vec![Submesh {
                first_index: 0,
                index_count: 6,
                material: 0,
            }],
        }],
        materials: vec![Material {
            emission: Vec3::ONE,
            base_color: Vec3::ZERO.extend(1.0),
            specular: 0.0,
            ..Material::default()
        }],
        instances: vec![Instance {
            name: "square".into(),
            mesh: 0,
            transform: Mat4::IDENTITY,
            mover: None,
        }],
        ..Scene::default()
    }
}

/// Looks straight down from here, with its upper edge towards (3, 1): edges are oblique in the picture.
fn camera(x: f32, z: f32) -> PlacedCamera {
    PlacedCamera {
        up: (3.0, 0.0, 1.0),
        ..PlacedCamera::new((x, 1.6, z), (x, 0.0, z), 50.0)
    }
}

/// Share of each pixel that the square covers, by 32x32 rays.
fn coverage(camera: &PlacedCamera) -> Vec<f32> {
    const N: u32 = 32;
    let eye = Vec3::from(camera.eye);
    let forwards = (Vec3::from(camera.target) - eye).normalize();
    let right = forwards.cross(Vec3::from(camera.up)).normalize();
    let up = right.cross(forwards);
    let scale = (0.5 * camera.fov_y.to_radians()).tan();
    let (width, height) = (SIZE.0 as f32, SIZE.1 as f32);
    let covered = |x: f32, y: f32| {
        let across = (2.0 * x / width - 1.0) * scale * width / height;
        let down = (2.0 * y / height - 1.0) * scale;
        let ray = forwards + across * right - down * up;
        let hit = eye - ray * (eye.y / ray.y);
        hit.x.abs() < 0.5 && hit.z.abs() < 0.5
    };
    (0..SIZE.0 * SIZE.1)
        .map(|i| {
            let (x, y) = ((i % SIZE.0) as f32, (i / SIZE.0) as f32);
            let at = |j: u32| (j as f32 + 0.5) / N as f32;
            let hits = (0..N * N).filter(|j| covered(x + at(j % N), y + at(j / N)));
            hits.count() as f32 / (N * N) as f32
        })
        .collect()
}

/// The square with every other column of 64 texels cut out, two texels a pixel. Its smaller mips cut out everything.
fn striped_square() -> Scene {
    let mut scene = shining_square();
    let level = |edge: usize| {
        let alpha = |i: usize| {
            if edge == 64 && i.is_multiple_of(2) {
                255
            } else {
                0
            }
        };
        (0..edge * edge)
            .flat_map(|i| [255, 255, 255, alpha(i)])
            .collect()
    };
    scene.textures.push(Texture {
        name: "stripes".into(),
        width: 64,
        height: 64,
        format: TextureFormat::Rgba8Srgb,
        mips: (0..7).map(|l| level(64 >> l)).collect(),
    });
    scene.materials[0].base_color = Vec4::ONE;
    scene.materials[0].base_color_texture = Some(0);
    scene.materials[0].alpha_cutoff = 0.5;
    scene
}

fn session(lab: &Lab, pixel: &str, rasteriser: &str) -> Session {
    session_in(lab, shining_square(), pixel, rasteriser)
}

fn session_in(lab: &Lab, scene: Scene, pixel: &str, rasteriser: &str) -> Session {
    let set = [
        ("pixel", pixel),
        ("gbuffer", rasteriser),
        ("voxel_dim", "32"),
    ];
    let mut look = experiment("square", SIZE, &set);
    look.camera = CameraChoice::Placed(camera(0.0, 0.0));
    let wanted = vec!["radiance".to_owned()];
    lab.prepare(&look, Arc::new(scene), |_| Ok(wanted))
        .unwrap()
        .0
}

/// The picture less the exact one.
fn errors(session: &mut Session, exact: &[f32]) -> Vec<f32> {
    let picture = floats(session, "radiance", 0);
    picture.iter().zip(exact).map(|(p, e)| p[0] - e).collect()
}

fn squares(values: &[f32]) -> f32 {
    values.iter().map(|v| v * v).sum()
}

#[test]
fn a_still_picture_is_filtered_by_a_box() {
    let home = home();
    let lab = lab(home.path());
    let exact = coverage(&camera(0.0, 0.0));
    let area: f32 = exact.iter().sum();
    let edges = exact.iter().filter(|e| **e > 0.0 && **e < 1.0).count();
    assert!(edges > 80, "{edges} pixels of edges");
    for rasteriser in ["compute", "raster"] {
        let summary = |pixel: &str, frames: usize| {
            let mut session = session(&lab, pixel, rasteriser);
            session.run(frames).unwrap();
            let errors = errors(&mut session, &exact);
            let worst = errors.iter().map(|e| e.abs()).fold(0.0, f32::max);
            let rms = (squares(&errors) / edges as f32).sqrt();
            let missing = errors.iter().sum::<f32>() / area;
            println!(
                "{rasteriser}, {pixel}: at most {worst:.3}, edges {rms:.3}, area {missing:+.4}"
            );
            (worst, rms, missing)
        };
        let (worst, rms, _) = summary("centre", 4);
        assert!(worst > 0.4 && rms > 0.2, "the scene has no edges");
        let (worst, rms, missing) = summary("box", 96);
        assert!(worst < 0.06 && rms < 0.03 && missing.abs() < 0.001);
    }
    assert_clean(&lab);
}

/// Steps of the square or the camera in 40 frames: 0.6 pixels each.
fn step(frame: usize) -> (f32, f32) {
    let steps = frame as f32 - 20.0;
    (0.011 * steps, 0.012 * steps)
}

/// A square that moves by a step a second, against the camera that would see the same.
#[test]
fn a_moving_square_keeps_edges_steady() {
    let home = home();
    let lab = lab(home.path());
    let key = |time: f32, (x, z): (f32, f32)| Keyframe {
        time,
        translation: Vec3::new(-x, 0.0, -z),
        rotation: Quat::IDENTITY,
    };
    let mut scene = shining_square();
    scene.movers = vec![Mover {
        parent: None,
        placed: Mat4::IDENTITY,
        track: Track::rigid(&[key(0.0, step(0)), key(40.0, step(40))], false).into(),
    }];
    scene.instances[0].mover = Some(0);
    for rasteriser in ["compute", "raster"] {
        let [mut jagged, mut smooth] =
            ["centre", "box"].map(|p| session_in(&lab, scene.clone(), p, rasteriser));
        let mut off = [0.0; 2];
        for i in 0..40 {
            let (x, z) = step(i);
            let exact = coverage(&camera(x, z));
            for (which, session) in [&mut jagged, &mut smooth].into_iter().enumerate() {
                session.frame(1.0).unwrap();
                if i > 20 {
                    off[which] += squares(&errors(session, &exact));
                }
            }
        }
        let off = (off[1] / off[0]).sqrt();
        println!("{rasteriser}: of the jagged picture's, errors {off:.3}");
        assert!(off < 0.75, "{off}");
    }
    assert_clean(&lab);
}

#[test]
fn masks_finer_than_a_pixel_keep_their_share() {
    let home = home();
    let lab = lab(home.path());
    let area: f32 = coverage(&camera(0.0, 0.0)).iter().sum();
    for rasteriser in ["compute", "raster"] {
        let mut session = session_in(&lab, striped_square(), "box", rasteriser);
        session.run(96).unwrap();
        let shining = floats(&mut session, "radiance", 0).into_iter();
        let share = shining.map(|p| p[0]).sum::<f32>() / area;
        println!("{rasteriser}: {share:.4} of the square is left");
        assert!((share - 0.5).abs() < 0.01);
    }
    assert_clean(&lab);
}

#[test]
fn a_moving_camera_keeps_edges_steady_and_leaves_nothing_behind() {
    let home = home();
    let lab = lab(home.path());
    let [mut jagged, mut smooth] = ["centre", "box"].map(|p| session(&lab, p, "compute"));
    // Sums of squares: of errors, and of what changed from frame to frame but should not, or the reverse.
    let (mut off, mut jumps) = ([0.0; 2], [0.0; 2]);
    let mut last: [Vec<f32>; 2] = Default::default();
    for i in 0..40 {
        let (x, z) = step(i);
        let there = camera(x, z);
        let exact = coverage(&there);
        for (which, session) in [&mut jagged, &mut smooth].into_iter().enumerate() {
            session.place_camera(&there);
            session.run(1).unwrap();
            let errors = errors(session, &exact);
            if i > 20 {
                off[which] += squares(&errors);
                let turned = errors.iter().zip(&last[which]).map(|(e, l)| e - l);
                jumps[which] += squares(&turned.collect::<Vec<f32>>());
            }
            last[which] = errors;
        }
    }
    let (off, jumps) = ((off[1] / off[0]).sqrt(), (jumps[1] / jumps[0]).sqrt());
    println!("of the jagged picture's, errors {off:.3}, jumps {jumps:.3}");
    // Lookups between pixels blur an edge of one pixel in every frame.
    assert!(off < 0.75 && jumps < 0.5);

    let there = camera(0.4, -0.3);
    smooth.place_camera(&there);
    smooth.run(1).unwrap();
    let exact = coverage(&there);
    let ghosts = errors(&mut smooth, &exact).into_iter().zip(&exact);
    let ghosts = ghosts.filter(|(off, e)| off.abs() > 0.5 && (**e == 0.0 || **e == 1.0));
    let ghosts = ghosts.count();
    println!("{ghosts} pixels of the old view after a cut");
    assert!(ghosts == 0);
    assert_clean(&lab);
}
