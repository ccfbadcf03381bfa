//! Light of emitting surfaces: what the reference finds of it against formulas, and what the method does against the reference.

mod common;

use common::{assert_clean, experiment, floats, home, lab, mean, prepare, root, scene};
use conelab::experiment::{CameraChoice, PlacedCamera};
use conelab::measure::reference::{Goal, gather};
use conelab::scene::{
    Instance, Keyframe, Material, Mesh, Mover, Scene, Submesh, Texture, TextureFormat, Track,
    Vertex,
};
use glam::{Mat4, Quat, Vec3, Vec4};
use std::ops::ControlFlow;
use std::sync::Arc;

const ALBEDO: f64 = 0.5;
const RADIANCE: f64 = 7.0;

/// A level square around the origin, by its edge.
fn square(edge: f32, material: u32) -> Mesh {
    let at = |x: f32, z: f32| Vertex {
        position: [(x - 0.5) * edge, 0.0, (z - 0.5) * edge],
        normal: [0.0, 1.0, 0.0],
        tangent: [1.0, 0.0, 0.0, 1.0],
        uv: [x, z],
        ..Vertex::default()
    };
    Mesh {
        name: "square".into(),
        vertices: vec![at(0.0, 0.0), at(0.0, 1.0), at(1.0, 1.0), at(1.0, 0.0)],
        indices: vec![0, 1, 2, 0, 2, 3],
        submeshes: vec![Submesh {
            first_index: 0,
            index_count: 6,
            material,
        }],
    }
}

/// A floor, and a square lamp of this edge a metre above its middle.
fn under_a_lamp(edge: f32) -> Scene {
    // Without a lobe, which would take its share of the light.
    let floor = Material {
        base_color: Vec4::new(0.5, 0.5, 0.5, 1.0),
        specular: 0.0,
        ..Material::default()
    };
    let lamp = Material {
        emission: Vec3::splat(RADIANCE as f32),
        base_color: Vec4::W,
        ..Material::default()
    };
    let place = |mesh: u32, height: f32| Instance {
        name: format!("square {mesh}"),
        mesh,
        transform: Mat4::from_translation(Vec3::Y * height),
        mover: None,
    };
    Scene {
        name: "lamp".into(),
        meshes: vec![square(200.0, 0), square(edge, 1)],
        materials: vec![floor, lamp],
        instances: vec![place(0, 0.0), place(1, 1.0)],
        ..Scene::default()
    }
}

/// The share of the cosine-weighted hemisphere over a point that a square a metre above it fills (Siegel and Howell, C-11).
fn form_factor(edge: f64) -> f64 {
    let half = edge / 2.0;
    let root = (1.0 + half * half).sqrt();
    4.0 / std::f64::consts::PI * half / root * (half / root).atan()
}

/// Mean diffuse light of the floor's middle after one turn, and the noise of its total, by so many samples.
fn floor_light(scene: Scene, samples: u64, time: f64) -> (f64, f64) {
    let home = home();
    let lab = lab(home.path());
    let mut look = experiment("lamp", (16, 12), &[]);
    look.camera = CameraChoice::Placed(PlacedCamera::new((0.0, 0.3, 0.3), (0.0, 0.0, 0.0), 1.0));
    look.time = time;
    let keep_on = &mut |_| ControlFlow::Continue(());
    let found = gather(
        &lab,
        &look,
        &Arc::new(scene),
        1,
        Goal::Samples(samples),
        keep_on,
    )
    .unwrap();
    assert_clean(&lab);
    (
        found.parts["diffuse"].mean.mean(),
        found.parts["diffuse"].noise.relmse,
    )
}

#[test]
fn lamps_from_two_centimetres_to_thirty_metres_light_the_floor_by_their_form_factor() {
    for edge in [0.02, 0.3, 1.0, 5.0, 30.0] {
        let expected = ALBEDO * RADIANCE * form_factor(edge);
        let (found, noise) = floor_light(under_a_lamp(edge as f32), 64, 0.0);
        println!(
            "a lamp of {edge} m: {found:.6}, by its form factor {expected:.6}, noise {noise:.1e}"
        );
        assert!(
            (found / expected - 1.0).abs() < 0.01,
            "{edge} m: {found}, not {expected}"
        );
    }
}

#[test]
fn a_lamp_whose_texture_is_half_black_gives_half_its_light() {
    let mut scene = under_a_lamp(1.0);
    let row: Vec<u8> = (0..64)
        .flat_map(|x| [if x < 32 { 255 } else { 0 }; 4])
        .collect();
    scene.textures.push(Texture {
        name: "half".into(),
        width: 64,
        height: 64,
        format: TextureFormat::Rgba8Srgb,
        mips: vec![row.repeat(64)],
    });
    scene.materials[1].emission_texture = Some(0);
    let expected = 0.5 * ALBEDO * RADIANCE * form_factor(1.0);
    let (found, noise) = floor_light(scene, 256, 0.0);
    println!("{found:.5}, expected {expected:.5}, noise {noise:.1e}");
    assert!(
        (found / expected - 1.0).abs() < 0.01,
        "{found}, not {expected}"
    );
}

/// Half of the lamp is cut out by alpha. The method draws places on it, and voxels do not know the holes.
#[test]
fn a_lamp_whose_mask_cuts_out_half_gives_half_its_light() {
    let row: Vec<u8> = (0..64)
        .flat_map(|x| [255, 255, 255, if x < 32 { 255 } else { 0 }])
        .collect();
    let mut masked = under_a_lamp(1.0);
    let (width, height, format) = (64, 64, TextureFormat::Rgba8Srgb);
    masked.textures.push(Texture {
        name: "half".into(),
        width,
        height,
        format,
        mips: vec![row.repeat(64)],
    });
    (
        masked.materials[1].base_color_texture,
        masked.materials[1].alpha_cutoff,
    ) = (Some(0), 0.5);
    let expected = 0.5 * ALBEDO * RADIANCE * form_factor(1.0);
    let (found, noise) = floor_light(masked.clone(), 256, 0.0);
    println!("reference: {found:.5}, expected {expected:.5}, noise {noise:.1e}");
    assert!(
        (found / expected - 1.0).abs() < 0.01,
        "{found}, not {expected}"
    );

    let lab = lab(root());
    let settings = [
        ("voxel_dim", "64"),
        ("volume", "box"),
        ("volume_size", "(4, 4, 4)"),
        ("gather_frames", "1"),
    ];
    let [half, whole] = [masked, under_a_lamp(1.0)].map(|scene| {
        let mut look = experiment("lamp", (16, 12), &settings);
        look.camera =
            CameraChoice::Placed(PlacedCamera::new((0.0, 0.3, 0.3), (0.0, 0.0, 0.0), 20.0));
        let wanted = vec!["diffuseIndirect".to_owned()];
        let (mut session, _) = lab.prepare(&look, Arc::new(scene), |_| Ok(wanted)).unwrap();
        session.run(4).unwrap();
        session.finish().unwrap();
        mean(&floats(&mut session, "diffuseIndirect", 0))
    });
    println!("method: {half:.5} of {whole:.5}");
    assert!((half / whole - 0.5).abs() < 0.03, "{half} of {whole}");
    assert_clean(&lab);
}

#[test]
fn a_lamp_that_moves_takes_its_light_along() {
    let key = |time: f32, height: f32| Keyframe {
        time,
        translation: Vec3::Y * (height - 1.0),
        rotation: Quat::IDENTITY,
    };
    let mut scene = under_a_lamp(0.5);
    let track = Track::rigid(&[key(0.0, 1.0), key(1.0, 2.0)], false).into();
    scene.movers = vec![Mover {
        parent: None,
        placed: Mat4::IDENTITY,
        track,
    }];
    scene.instances[1].mover = Some(0);
    for (time, height) in [(0.0, 1.0), (0.5, 1.5), (1.0, 2.0)] {
        let expected = ALBEDO * RADIANCE * form_factor(0.5 / height);
        let (found, _) = floor_light(scene.clone(), 64, time);
        println!("{height} m high: {found:.5}, expected {expected:.5}");
        assert!(
            (found / expected - 1.0).abs() < 0.01,
            "{height} m: {found}, not {expected}"
        );
    }
}

/// A box lit by a lamp of 47 x 38 cm under its ceiling, seen from inside and from 7 m away: what all wide cones lost.
#[test]
fn a_small_lamp_lights_its_room() {
    let home = home();
    let lab = lab(home.path());
    for camera in ["default", "outside"] {
        let mut look = experiment(
            "small-quad",
            (48, 36),
            &[("voxel_dim", "64"), ("gather_frames", "4")],
        );
        look.camera = CameraChoice::Named(camera.into());
        let keep_on = &mut |_| ControlFlow::Continue(());
        let truth = gather(
            &lab,
            &look,
            &scene("small-quad"),
            64,
            Goal::Samples(128),
            keep_on,
        )
        .unwrap();
        let wanted = ["radiance", "diffuseIndirect"].map(String::from).to_vec();
        let (mut session, _) = lab
            .prepare(&look, scene("small-quad"), |_| Ok(wanted))
            .unwrap();
        session.run(16).unwrap();
        session.finish().unwrap();
        let energy = mean(&floats(&mut session, "radiance", 0)) / truth.parts["total"].mean.mean();
        // The floor before the boxes: the lowest rows of the picture.
        let (found, rgb) = (
            floats(&mut session, "diffuseIndirect", 0),
            &truth.parts["diffuse"].mean.rgb,
        );
        let row = |y: usize| y * 48 + 6..y * 48 + 42;
        let rows: Vec<usize> = if camera == "default" {
            row(34).chain(row(35)).collect()
        } else {
            row(30).collect()
        };
        let floor = [
            rows.iter().map(|i| f64::from(found[*i][1])).sum::<f64>(),
            rows.iter().map(|i| f64::from(rgb[*i][1])).sum::<f64>(),
        ];
        println!(
            "from {camera}: energy {energy:.3}, of the floor {:.3}",
            floor[0] / floor[1]
        );
        // Of 64 voxels an edge; 160 have all of it (docs/results.md).
        assert!(
            (0.85..1.1).contains(&energy),
            "from {camera}: energy {energy}"
        );
        assert!(
            (0.8..1.2).contains(&(floor[0] / floor[1])),
            "from {camera}: the floor has {floor:?}"
        );
        assert_clean(&lab);
    }
}

/// A closed room with a bulb in its middle, of one voxel and of two and a half: sides of a bulb that lit each other shone with more
/// than they emit, 1.12 of the room's light in all, and rays that met them left bright blocks all over the room.
#[test]
fn a_bulb_of_a_few_voxels_lights_its_room_evenly() {
    let home = home();
    let lab = lab(home.path());
    for radius in [0.08, 0.16] {
        let file = home.path().join("bulb.ron");
        let text = format!(
            "(materials: {{ \"wall\": (base_color: (0.6, 0.6, 0.6, 1.0)), \"bulb\": (base_color: (0.8, 0.8, 0.8, 1.0), emission: (60.0, 60.0, 60.0)) }},
             meshes: {{ \"all\": [
                Solid([Box(material: \"wall\", low: (-2.0, -2.0, -2.0), high: (2.0, 2.0, 2.0)), Hollow(material: \"wall\", low: (-1.9, -1.9, -1.9), high: (1.9, 1.9, 1.9))]),
                Sphere(material: \"bulb\", centre: (0.03, 0.41, -0.02), radius: {radius}, level: 2),
             ] }},
             lights: [],
             cameras: {{ \"default\": (eye: (1.0, -0.6, 1.0), target: (1.7, -1.0, -1.9), fov_y: 70.0) }})"
        );
        std::fs::write(&file, text).unwrap();
        let name = file.to_string_lossy().into_owned();
        let look = experiment(&name, (64, 48), &[("voxel_dim", "64")]);
        let keep_on = &mut |_| ControlFlow::Continue(());
        let truth = gather(&lab, &look, &scene(&name), 64, Goal::Samples(128), keep_on).unwrap();
        let (mut session, _) = lab
            .prepare(&look, scene(&name), |_| Ok(vec!["diffuseIndirect".into()]))
            .unwrap();
        session.run(24).unwrap();
        session.finish().unwrap();
        let found = floats(&mut session, "diffuseIndirect", 0);
        let expected = &truth.parts["diffuse"].mean.rgb;
        let energy = mean(&found) / truth.parts["diffuse"].mean.mean();
        // Of blocks of 8x8 pixels, which share their rays: noise of the reference goes out.
        let block = |x: usize, y: usize| {
            let pixels = (0..64).map(|i| (8 * y + i / 8) * 64 + 8 * x + i % 8);
            pixels.fold([0.0, 0.0], |[a, b], i| {
                [a + f64::from(found[i][1]), b + f64::from(expected[i][1])]
            })
        };
        let ratios = (0..48)
            .map(|i| block(i % 8, i / 8))
            .map(|[a, b]| a / b / energy);
        let (least, most) = ratios.fold((f64::MAX, 0f64), |(least, most), r| {
            (least.min(r), most.max(r))
        });
        println!(
            "radius {radius} m: energy {energy:.3}, blocks {least:.3} to {most:.3} of their light"
        );
        assert!(
            (0.96..1.04).contains(&energy),
            "radius {radius}: energy {energy}"
        );
        assert!(
            least > 0.9 && most < 1.1,
            "radius {radius}: blocks have {least:.3} to {most:.3} of their light"
        );
        assert_clean(&lab);
    }
}

#[test]
fn no_order_of_a_files_triangles_shows_in_a_hundred_lamps() {
    let lab = lab(root());
    let own = scene("emitters");
    let look = experiment(
        "emitters",
        (48, 27),
        &[("voxel_dim", "32"), ("gather_frames", "1")],
    );
    let picture = |scene: Arc<Scene>| {
        let (mut session, _) = lab
            .prepare(&look, scene, |_| Ok(vec!["radiance".into()]))
            .unwrap();
        session.run(2).unwrap();
        session.finish().unwrap();
        assert_clean(&lab);
        session.texels("radiance", 0, 0).unwrap().bytes
    };
    let expected = picture(own.clone());
    assert!(
        picture(Arc::new(own.shuffled(4))) == expected,
        "triangles in another order give another picture"
    );
}

/// Noise that the mean of many rounds takes from a still picture of a hundred lamps, one sample a pixel.
#[test]
fn places_on_lamps_are_new_in_each_round() {
    let lab = lab(root());
    let look = experiment(
        "emitters",
        (48, 27),
        &[
            ("voxel_dim", "32"),
            ("gather_frames", "1"),
            ("pixel_rays", "32"),
            ("emitter_rays", "1"),
        ],
    );
    let mut session = prepare(&lab, &look, &["diffuseIndirect"]);
    let mut seen = 0;
    // Light has converged after 77 frames, and the mean of pixels begins.
    let [first, many] = [79, 120].map(|count| {
        while seen < count {
            session.frame(0.0).unwrap();
            seen += 1;
        }
        session.finish().unwrap();
        floats(&mut session, "diffuseIndirect", 0)
    });
    let apart = |(a, b): (&[f32; 4], &[f32; 4])| {
        let channels = a[..3].iter().zip(&b[..3]);
        channels.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>()
    };
    let noise = first.iter().zip(&many).map(apart).sum::<f64>() / (3.0 * many.len() as f64);
    let noise = noise / mean(&many);
    println!("noise of one sample: {noise:.4}");
    assert!(noise > 0.05, "{noise:.4}: all rounds take the same samples");
    assert_clean(&lab);
}
