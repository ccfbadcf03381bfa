//! Rectangles and discs of light against integrals over their surface, which share nothing with the shaders: sums
//! over a grid of places on the light, with the formulas of Lambert and of glTF 2.0 (Appendix B).

mod common;

use common::{assert_clean, experiment, floats, home, lab, root, scene};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera};
use conelab::measure::reference::{Goal, gather};
use conelab::scene::{Light, LightKind, Scene};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

const SIZE: u32 = 32;
/// Half the edge of the floor that the picture shows (m).
const HALF: f64 = 2.0;
/// From above, and at 80 degrees from the normal.
const ABOVE: DVec3 = DVec3::new(0.0, 12.0, 0.0);
const LOW: DVec3 = DVec3::new(0.0, 1.0, 5.7);

/// A floor in the plane y = 0 of this material, and further meshes.
fn floor(material: &str, more: &str, light: Light) -> Arc<Scene> {
    let text = format!(
        "(materials: {{ \"floor\": ({material}), \"black\": (base_color: (0, 0, 0, 1), specular: 0) }}, meshes: {{
            \"floor\": [Quad(material: \"floor\", corners: ((-9, 0, 9), (9, 0, 9), (9, 0, -9), (-9, 0, -9)))], {more}
        }}, sky: (0, 0, 0))"
    );
    let folder = home();
    let file = folder.path().join("floor.ron");
    std::fs::write(&file, text).unwrap();
    let mut scene = Scene::clone(&scene(file.to_str().unwrap()));
    scene.lights = vec![light];
    Arc::new(scene)
}

fn light(kind: LightKind, position: Vec3, direction: Vec3, shadow: bool) -> Light {
    Light {
        name: "light".into(),
        kind,
        color: Vec3::new(4.0, 2.0, 1.0),
        position,
        direction: direction.normalize(),
        up: Vec3::new(0.2, 1.0, 0.1),
        on: true,
        shadow,
    }
}

fn up_of(eye: DVec3) -> DVec3 {
    if eye == ABOVE { DVec3::NEG_Z } else { DVec3::Y }
}

fn fov_of(eye: DVec3) -> f64 {
    // From below, the picture must end before the horizon.
    let half = if eye == ABOVE { HALF } else { 0.4 };
    2.0 * (half / eye.length()).atan()
}

fn viewed(eye: DVec3, settings: &[(&str, &str)]) -> Experiment {
    let mut e = experiment("cornell", (SIZE, SIZE), settings);
    let fov = fov_of(eye).to_degrees() as f32;
    let mut camera = PlacedCamera::new(eye.as_vec3().into(), (0.0, 0.0, 0.0), fov);
    camera.up = up_of(eye).as_vec3().into();
    e.camera = CameraChoice::Placed(camera);
    e
}

/// The place on the floor that a pixel shows.
fn place(eye: DVec3, pixel: usize) -> DVec3 {
    let at = DVec2::new(
        (pixel % SIZE as usize) as f64,
        (pixel / SIZE as usize) as f64,
    );
    let at = ((at + 0.5) / f64::from(SIZE) * 2.0 - 1.0) * (0.5 * fov_of(eye)).tan();
    let forward = -eye.normalize();
    let right = forward.cross(up_of(eye)).normalize();
    let d = forward + at.x * right - at.y * right.cross(forward);
    eye - d * (eye.y / d.y)
}

const SETTINGS: [(&str, &str); 3] = [
    ("voxel_dim", "32"),
    ("shadow_dim", "1024"),
    ("shading_model", "single_scattering"),
];

/// The red channel.
fn by_method(scene: &Arc<Scene>, eye: DVec3) -> Vec<f64> {
    let texels = texels(scene, eye);
    texels.iter().map(|t| f64::from(t[0])).collect()
}

fn texels(scene: &Arc<Scene>, eye: DVec3) -> Vec<[f32; 4]> {
    let lab = lab(root());
    let wanted = vec!["direct".to_string()];
    let (mut session, _) = lab
        .prepare(&viewed(eye, &SETTINGS), scene.clone(), |_| Ok(wanted))
        .unwrap();
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_clean(&lab);
    floats(&mut session, "direct", 0)
}

fn by_reference(scene: &Arc<Scene>, eye: DVec3) -> Vec<f64> {
    let home = home();
    let lab = lab(home.path());
    let e = viewed(eye, &[("shading_model", "single_scattering")]);
    let goal = Goal::Samples(128);
    let found = gather(&lab, &e, scene, 1, goal, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_clean(&lab);
    let texels = &found.parts["direct"].mean.rgb;
    texels.iter().map(|t| f64::from(t[0])).collect()
}

/// Places on a light, each for the same area, and that area.
fn places(light: &Light, edge: usize) -> (Vec<DVec3>, f64) {
    let direction = light.direction.as_dvec3();
    let side = direction.cross(light.up.as_dvec3()).normalize();
    let top = side.cross(direction);
    let at = |i: usize| {
        let u = (DVec2::new((i % edge) as f64, (i / edge) as f64) + 0.5) / edge as f64;
        let q = match light.kind {
            LightKind::Rectangle { width, height } => {
                (u - 0.5) * DVec2::new(f64::from(width), f64::from(height))
            }
            LightKind::Disc { radius } => {
                f64::from(radius) * u.x.sqrt() * DVec2::from_angle(2.0 * PI * u.y)
            }
            _ => unreachable!(),
        };
        light.position.as_dvec3() + q.x * side + q.y * top
    };
    let area = match light.kind {
        LightKind::Rectangle { width, height } => f64::from(width * height),
        LightKind::Disc { radius } => PI * f64::from(radius).powi(2),
        _ => unreachable!(),
    };
    (
        (0..edge * edge).map(at).collect(),
        area / (edge * edge) as f64,
    )
}

/// Red radiance of every pixel: the sum over places of `brdf(p, direction)`, where `open(p, place)`.
fn integrated(
    light: &Light,
    eye: DVec3,
    edge: usize,
    brdf: impl Fn(DVec3, DVec3) -> f64,
    open: impl Fn(DVec3, DVec3) -> bool,
) -> Vec<f64> {
    let (places, area) = places(light, edge);
    let radiance = |pixel| {
        let p = place(eye, pixel);
        let one = |x: &DVec3| {
            let to = *x - p;
            let d = to.normalize();
            let (cosine, emitted) = (d.y, -d.dot(light.direction.as_dvec3()));
            if cosine <= 0.0 || emitted <= 0.0 || !open(p, *x) {
                return 0.0;
            }
            brdf(p, d) * cosine * emitted / to.length_squared()
        };
        f64::from(light.color.x) * area * places.iter().map(one).sum::<f64>()
    };
    (0..(SIZE * SIZE) as usize).map(radiance).collect()
}

/// Mean difference from the expected picture, as a share of its mean.
fn error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let difference = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    difference.sum::<f64>() / expected.iter().sum::<f64>()
}

/// Difference of the sums in standard errors, if the noise of pixels is independent.
fn bias(found: &[f64], expected: &[f64]) -> f64 {
    let differences = found.iter().zip(expected).map(|(a, b)| a - b);
    let square: f64 = differences.clone().map(|d| d * d).sum();
    differences.sum::<f64>().abs() / square.sqrt()
}

/// A reference is noisy, but not wrong on average.
fn assert_unbiased(what: &str, reference: &[f64], expected: &[f64]) {
    let bias = bias(reference, expected);
    assert!(
        bias < 4.0,
        "{what}: the reference's sum is off by {bias} standard errors"
    );
}

const PANEL: LightKind = LightKind::Rectangle {
    width: 1.6,
    height: 0.7,
};
const DISC: LightKind = LightKind::Disc { radius: 0.6 };

#[test]
fn matte_floors_reflect_the_form_factor() {
    // Above the floor, tilted, near, and cut by its plane.
    let cases = [
        (PANEL, Vec3::new(0.3, 1.2, 0.2), Vec3::NEG_Y),
        (PANEL, Vec3::new(-0.5, 0.8, 0.4), Vec3::new(0.6, -0.5, -0.3)),
        (PANEL, Vec3::new(-1.0, 0.1, 0.0), Vec3::new(1.0, 0.1, 0.2)),
        (DISC, Vec3::new(0.3, 0.5, 0.2), Vec3::NEG_Y),
        (DISC, Vec3::new(1.0, 0.2, 0.3), Vec3::new(-1.0, 0.05, 0.1)),
    ];
    for (kind, position, direction) in cases {
        let light = light(kind, position, direction, false);
        let scene = floor(
            "base_color: (0.5, 0.5, 0.5, 1), specular: 0",
            "",
            light.clone(),
        );
        let expected = integrated(&light, ABOVE, 200, |_, _| 0.5 / PI, |_, _| true);
        let (method, reference) = (by_method(&scene, ABOVE), by_reference(&scene, ABOVE));
        let (a, b) = (error(&method, &expected), error(&reference, &expected));
        let what = format!("{kind:?} at {position}");
        println!("{what}: method {a:.4}, reference {b:.4}");
        // The 16 edges of a disc show where the floor cuts it.
        let most = if kind == DISC { 0.01 } else { 0.001 };
        assert!(a < most, "{what}: the method is off by {a}");
        assert!(b < 0.25, "{what}: the reference is off by {b}");
        assert_unbiased(&what, &reference, &expected);
    }
}

/// Glass of refractive index 1.5 at this roughness: one scattering of glTF's lobe.
fn gloss(eye: DVec3, roughness: f64) -> impl Fn(DVec3, DVec3) -> f64 {
    move |p, l| {
        let v = (eye - p).normalize();
        let h = (v + l).normalize();
        let a2 = roughness.powi(4);
        let d = a2 / (PI * (h.y * h.y * (a2 - 1.0) + 1.0).powi(2));
        let lambda = |c: f64| (a2 + (1.0 - a2) * c * c).sqrt();
        let visibility = 0.5 / (l.y * lambda(v.y) + v.y * lambda(l.y));
        d * visibility * (0.04 + 0.96 * (1.0 - v.dot(h)).powi(5))
    }
}

#[test]
fn lobes_reflect_lights_as_integrals_of_the_brdf_do() {
    // The error of the method is that of linearly transformed cosines: least where the lobe is narrow, most
    // where it is cut by the horizon.
    let cases = [
        (PANEL, ABOVE, 0.15, 0.01),
        (PANEL, ABOVE, 0.4, 0.03),
        (PANEL, ABOVE, 0.9, 0.03),
        (DISC, ABOVE, 0.15, 0.02),
        (DISC, ABOVE, 0.4, 0.03),
        (PANEL, LOW, 0.2, 0.08),
        (PANEL, LOW, 0.5, 0.05),
    ];
    for (kind, eye, roughness, most) in cases {
        let (position, direction) = if eye == ABOVE {
            (Vec3::new(0.3, 1.2, 0.2), Vec3::new(0.1, -1.0, 0.2))
        } else {
            (Vec3::new(0.2, 0.8, -3.0), Vec3::new(0.1, -0.3, 1.0))
        };
        let light = light(kind, position, direction, false);
        let material = format!("base_color: (0, 0, 0, 1), roughness: {roughness:?}");
        let scene = floor(&material, "", light.clone());
        let expected = integrated(&light, eye, 300, gloss(eye, roughness), |_, _| true);
        let (method, reference) = (by_method(&scene, eye), by_reference(&scene, eye));
        let (a, b) = (error(&method, &expected), error(&reference, &expected));
        let what = format!("{kind:?} from {eye} at roughness {roughness}");
        println!("{what}: method {a:.4}, reference {b:.4}");
        assert!(a < most, "{what}: the method is off by {a}");
        assert!(b < 0.1, "{what}: the reference is off by {b}");
        assert_unbiased(&what, &reference, &expected);
    }
}

#[test]
fn metals_reflect_no_colour_that_they_do_not_have() {
    let kind = LightKind::Disc { radius: 0.1 };
    let mut light = light(
        kind,
        Vec3::new(0.5, 0.8, -3.0),
        Vec3::new(0.0, -0.3, 1.0),
        false,
    );
    light.color = Vec3::ONE;
    let material = "base_color: (1, 0, 0, 1), metallic: 1, roughness: 0.7";
    for eye in [ABOVE, LOW] {
        let seen = texels(&floor(material, "", light.clone()), eye);
        let [red, green] = [0, 1].map(|i| seen.iter().map(|t| f64::from(t[i])).sum::<f64>());
        // Schlick's reflectance at grazing angles alone, by the formula of glTF.
        let grazing = |p: DVec3, l: DVec3| {
            let v = (eye - p).normalize();
            let v_h = v.dot((v + l).normalize());
            gloss(eye, 0.7)(p, l) * (1.0 - v_h).powi(5) / (0.04 + 0.96 * (1.0 - v_h).powi(5))
        };
        let expected: f64 = integrated(&light, eye, 100, grazing, |_, _| true)
            .iter()
            .sum();
        println!("from {eye}: red {red:.4}, green {green:.6}, expected {expected:.6}");
        assert!(red > 1e-3 && (green - expected).abs() < 0.3 * expected + 2e-4 * red);
    }
}

/// Whether a box lies between two places.
fn hides(low: DVec3, high: DVec3, p: DVec3, x: DVec3) -> bool {
    let d = x - p;
    let (a, b) = ((low - p) / d, (high - p) / d);
    let (near, far) = (
        a.min(b).max_element().max(0.0),
        a.max(b).min_element().min(1.0),
    );
    near < far
}

#[test]
fn shadows_of_lights_are_soft() {
    let above = (Vec3::new(0.2, 1.6, 0.1), Vec3::NEG_Y);
    // Half of the light is below the floor. The wall hides the other half.
    let beside = (Vec3::new(-1.2, 0.1, 0.0), Vec3::X);
    let boxes = [
        // A slab halfway, a tower on the floor, a bar that is narrower than the light.
        ("slab", (-0.5, 0.6, -0.4), (0.5, 0.65, 0.4), above, 0.05),
        ("tower", (-0.3, 0.0, -0.3), (0.3, 0.8, 0.3), above, 0.05),
        ("bar", (-0.06, 0.9, -1.5), (0.06, 0.95, 1.5), above, 0.05),
        // The top of the disc is as high as the wall: one or two of 64 taps pass over it.
        ("wall", (-0.6, 0.0, -1.5), (-0.5, 0.7, 1.5), beside, 0.15),
    ];
    for (name, low, high, (position, direction), most) in boxes {
        let (low, high) = (DVec3::from(low), DVec3::from(high));
        for kind in [PANEL, DISC] {
            let mut light = light(kind, position, direction, true);
            light.up = Vec3::new(0.0, 1.0, 0.3);
            let more = format!(
                "\"box\": [Box(material: \"black\", low: ({}, {}, {}), high: ({}, {}, {}))]",
                low.x, low.y, low.z, high.x, high.y, high.z
            );
            let scene = floor(
                "base_color: (0.5, 0.5, 0.5, 1), specular: 0",
                &more,
                light.clone(),
            );
            let mut expected = integrated(
                &light,
                ABOVE,
                60,
                |_, _| 0.5 / PI,
                |p, x| !hides(low, high, p, x),
            );
            let (mut method, mut reference) =
                (by_method(&scene, ABOVE), by_reference(&scene, ABOVE));
            // Pixels that show the box.
            for pixel in 0..expected.len() {
                if hides(low, high, ABOVE, place(ABOVE, pixel)) {
                    (expected[pixel], method[pixel], reference[pixel]) = (0.0, 0.0, 0.0);
                }
            }
            let (a, b) = (error(&method, &expected), error(&reference, &expected));
            println!("{name} under {kind:?}: method {a:.4}, reference {b:.4}");
            assert!(a < most, "{name} under {kind:?}: the method is off by {a}");
            // The light touches the floor, where few samples have most of the sum.
            if name == "wall" {
                assert_unbiased(name, &reference, &expected);
            } else {
                assert!(
                    b < 0.05,
                    "{name} under {kind:?}: the reference is off by {b}"
                );
            }
        }
    }
}
