//! Lights in the window: added, switched off, removed; and the picture of the saved experiment is the same.

mod common;
#[path = "common/window_driver.rs"]
mod window_driver;

use common::{conelab, succeeds};
use conelab::workbench::events::fingerprint;
use window_driver::{CONTROL, WindowDriver, centre};

/// Light that does not depend on earlier frames, small enough for a software device.
const BOX: &str = r#"(graph: "cones.ron", scene: "cornell", size: (160, 120), params: { "voxel_dim": 32, "shadow_dim": 256, "bounces": one, "gather_frames": 1, "accumulation_rounds": 1, "cone_count": 3, "emitter_rays": 0 })"#;

fn open(experiment: &str) -> WindowDriver {
    let mut driver = WindowDriver::open(experiment, &["--size", "160x120"]);
    driver.first_picture();
    driver.click("", "Scene");
    // The gap between the two stacks of tabs: the Scene tab gets most of the height.
    let [left, top, ..] = driver.find("", "Chart");
    driver.drag((left, top - 2.0), (left, 600.0));
    driver.click("", "Save");
    driver
}

/// Clicks, and waits for another picture; its fingerprint.
fn click(driver: &mut WindowDriver, role: &str, label: &str) -> String {
    let before = driver.resting(0);
    let mark = driver.now();
    driver.click(role, label);
    driver.other_picture(mark, 0, &before);
    driver.resting(0)
}

/// Adds a point light by the menu; the picture's fingerprint.
fn add_point(driver: &mut WindowDriver) -> String {
    // A loaded machine can open and close a menu in one frame, and describe it late.
    let stays_open = |driver: &mut WindowDriver| {
        (0..3).all(|_| {
            std::thread::sleep(std::time::Duration::from_millis(500));
            driver.texts().iter().any(|text| text == "point")
        })
    };
    for _ in 0..10 {
        if stays_open(driver) {
            break;
        }
        driver.click("", "add light");
    }
    click(driver, "", "point")
}

/// Saves the experiment over its file, and renders the file; the fingerprint of the picture.
fn rendered(driver: &mut WindowDriver) -> String {
    fingerprint(&picture(driver))
}

fn picture(driver: &mut WindowDriver) -> image::RgbaImage {
    let mark = driver.now();
    driver.click("Button", "save");
    driver.event(mark, "not saved");
    driver.click("Button", "Overwrite");
    driver.event(mark, "saved");
    let path = driver.home.path().join("saved.png");
    let mut render = conelab(driver.home.path());
    render.args(["render", "configs/opened.ron", "-o"]);
    succeeds(render.arg(&path));
    image::open(path).unwrap().to_rgba8()
}

#[test]
fn a_light_is_added_switched_off_and_removed_and_saved_so() {
    let mut driver = open(BOX);
    let first = driver.resting(0);
    let lit = add_point(&mut driver);
    assert_eq!(rendered(&mut driver), lit, "with another light");
    let off = click(&mut driver, "", "lamp on");
    assert_eq!(rendered(&mut driver), off, "with the scene's own light off");
    assert!(
        driver
            .file("configs/opened.ron")
            .contains("\"lamp\": (on: false)")
    );

    // The session comes back as it was.
    std::thread::sleep(std::time::Duration::from_millis(2500));
    driver.kill_and_restart();
    assert_eq!(driver.first_picture(), off, "after a restart");
    driver.click("", "Scene");

    let mark = driver.now();
    driver.click("Button", "remove lamp");
    driver.event(mark, "built");
    let gone = driver.resting(0);
    assert_eq!(gone, off, "a light that is off emits nothing");
    assert_eq!(rendered(&mut driver), gone, "without the scene's own light");
    assert!(
        driver
            .file("configs/opened.ron")
            .contains("\"lamp\": (remove: true)")
    );
    let tab = centre(driver.find("", "Camera"));
    driver.scroll_down((tab.0, tab.1 + 60.0));
    assert_eq!(click(&mut driver, "Button", "reset lights"), first);
    driver.close();
}

/// A room of a floor, a wall and a ball, with no light of its own.
const DARK: &str = r#"(
    sky: (0, 0, 0),
    materials: { "white": (base_color: (0.7, 0.7, 0.7, 1.0)) },
    meshes: { "room": [
        Quad(material: "white", corners: ((-3, 0, 3), (3, 0, 3), (3, 0, -3), (-3, 0, -3))),
        Quad(material: "white", corners: ((-3, 0, -3), (3, 0, -3), (3, 3, -3), (-3, 3, -3))),
        Sphere(material: "white", centre: (0.9, 0.5, -0.6), radius: 0.5, level: 4),
    ] },
    instances: [(meshes: ["room"])],
    cameras: { "default": (eye: (0, 1.5, 4), target: (0, 1, -1), fov_y: 50) },
)"#;

#[test]
fn a_scene_without_light_gets_a_headlight_that_is_saved() {
    let file = tempfile::Builder::new().suffix(".ron").tempfile().unwrap();
    std::fs::write(file.path(), DARK).unwrap();
    let scene = format!("{:?}", file.path());
    let mut driver = open(&BOX.replace("\"cornell\"", &scene));
    let lit = driver.resting(0);
    assert_eq!(rendered(&mut driver), lit);
    assert!(
        driver
            .file("configs/opened.ron")
            .contains("\"headlight\": (add: \"Point\"")
    );
    let black = click(&mut driver, "Button", "remove the headlight");
    let [width, height] = [160, 120];
    assert_eq!(black, fingerprint(&vec![0; 4 * width * height]));
    // The removal is saved, and no headlight returns when the file is opened again.
    assert_eq!(rendered(&mut driver), black);
    let saved = driver.file("configs/opened.ron");
    assert!(saved.contains("\"headlight\": (remove: true)"), "{saved}");
    driver.close();
    drop(driver);
    let mut driver = open(&saved);
    assert_eq!(driver.resting(0), black);
    driver.close();
}

/// A closed room without lights is black under the sun and the sky that models get.
#[test]
fn a_closed_model_without_light_gets_a_headlight() {
    let corner = |i: usize| [0, 1, 2].map(|axis| (i >> axis & 1) as f32 * [6.0, 3.0, 5.0][axis]);
    let corners = (0..8).map(corner);
    let mut obj: String = corners
        .map(|[x, y, z]| format!("v {x} {y} {z}\n"))
        .collect();
    for side in [
        "1 3 7 5", "2 6 8 4", "1 5 6 2", "3 4 8 7", "1 2 4 3", "5 7 8 6",
    ] {
        obj += &format!("f {side}\n");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.obj");
    std::fs::write(&path, obj).unwrap();
    let mut driver = open(&BOX.replace("\"cornell\"", &format!("{path:?}")));
    let sum =
        |picture: &image::RgbaImage| -> u64 { picture.pixels().map(|p| u64::from(p.0[1])).sum() };
    let lit = picture(&mut driver);
    assert_eq!(fingerprint(&lit), driver.resting(0));
    click(&mut driver, "Button", "remove the headlight");
    // A little light leaks through the walls, which are thinner than a voxel.
    let dark = picture(&mut driver);
    assert!(sum(&lit) > 5 * sum(&dark), "{} {}", sum(&lit), sum(&dark));
    driver.close();
}

/// A drag of an axis moves the light along it, by as much as the projection says.
#[test]
fn a_handle_moves_its_light_by_what_the_projection_says() {
    let mut driver = open(BOX);
    add_point(&mut driver);
    let number = |text: &str| -> Vec<f64> {
        let inner = text.split("position: (").nth(1).unwrap();
        let inner = inner.split(')').next().unwrap();
        inner.split(", ").map(|x| x.parse().unwrap()).collect()
    };
    rendered(&mut driver);
    let before = number(&driver.file("configs/opened.ron"));

    let [left, top, right, bottom] = driver.place();
    let (x, y) = centre(driver.find("", "move along y point 1"));
    let pixels = 30.0;
    let old = driver.resting(0);
    let mark = driver.now();
    driver.drag((x, y), (x, y - pixels));
    driver.other_picture(mark, 0, &old);
    let moved = driver.resting(0);
    assert_eq!(rendered(&mut driver), moved);
    let after = number(&driver.file("configs/opened.ron"));
    assert_eq!((after[0], after[2]), (before[0], before[2]));
    // The camera of the box looks along z; its eye is at z = -8, its field of view 39.3 degrees.
    let metres = (before[2] + 8.0) * 2.0 * (0.5 * 39.3_f64).to_radians().tan() / (bottom - top);
    let expected = pixels * metres;
    let found = after[1] - before[1];
    assert!(
        (found - expected).abs() < 0.02 * expected,
        "{found} m instead of {expected} m"
    );
    assert!(right > left);
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'z')]);
    driver.picture(mark, 0, &old);

    // Escape takes the handles away.
    driver.keys(&[0xff1b]);
    driver.texts_until("no handles", |texts| {
        texts.iter().all(|text| text != "move along y point 1")
    });
    driver.close();
}

#[test]
fn a_sky_that_is_not_there_leaves_its_path_in_the_field() {
    let mut driver = open(BOX);
    let first = driver.resting(0);
    driver.click("TextInput", "picture of the sky");
    driver.text("gone.hdr");
    let mark = driver.now();
    driver.keys(&[0xff0d]);
    let failed = driver.event(mark, "load failed");
    assert_eq!(failed["why"], "Sky 'gone.hdr': file not found");
    driver.widget(|w| w["label"] == "picture of the sky" && w["value"] == "gone.hdr");
    assert_eq!(driver.resting(0), first);
    driver.close();
}
