//! Which files the window notices: those of the scene wherever they lie, links, and file systems without events.

mod common;
#[path = "common/window_driver.rs"]
mod window_driver;

use std::path::Path;
use tempfile::TempDir;
use window_driver::{CONTROL, WindowDriver};

const F5: u32 = 0xffc2;

/// A quad with a texture in a subfolder.
fn model(folder: &Path) {
    std::fs::create_dir_all(folder.join("pictures")).unwrap();
    let quad = "mtllib quad.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                usemtl painted\nf 1/1 2/2 3/3 4/4\n";
    std::fs::write(folder.join("quad.obj"), quad).unwrap();
    std::fs::write(
        folder.join("quad.mtl"),
        "newmtl painted\nmap_Kd pictures/paint.png\n",
    )
    .unwrap();
    paint(&folder.join("pictures/paint.png"), [200, 0, 0]);
}

fn paint(file: &Path, color: [u8; 3]) {
    image::RgbImage::from_pixel(4, 4, image::Rgb(color))
        .save(file)
        .unwrap();
}

fn experiment(scene: &str) -> String {
    format!(
        r#"(graph: "thesis.ron", scene: "{scene}", size: (160, 120), params: {{ "voxel_dim": 16, "shadow_dim": 256 }})"#
    )
}

/// Whether a change makes the window load the scene again.
#[track_caller]
fn loads(driver: &mut WindowDriver, what: &str, change: impl FnOnce()) {
    driver.resting(0);
    let mark = driver.now();
    change();
    let event = driver.wait(mark, &format!("load after {what}"), |e| {
        e["event"] == "loaded" || e["event"] == "load failed"
    });
    assert_eq!(event["event"], "loaded", "{what}: {event}");
}

/// Every file of a model in a folder of its own, which a link leads to and CONELAB_SCENES names.
fn every_file(variables: &[(&str, &str)]) {
    let scenes = TempDir::new().unwrap();
    let real = TempDir::new().unwrap();
    model(real.path());
    std::os::unix::fs::symlink(
        real.path().join("quad.obj"),
        scenes.path().join("linked.obj"),
    )
    .unwrap();
    for part in ["quad.mtl", "pictures"] {
        std::os::unix::fs::symlink(real.path().join(part), scenes.path().join(part)).unwrap();
    }
    let file = scenes.path().join("scene.ron");
    std::fs::write(&file, "(models: [(file: \"linked.obj\")])").unwrap();
    let elsewhere = TempDir::new().unwrap();
    let scene = elsewhere.path().join("scene.ron");
    std::fs::copy(&file, &scene).unwrap();
    let folders = scenes.path().to_string_lossy().into_owned();
    let variables = [&[("CONELAB_SCENES", folders.as_str())], variables].concat();
    let mut driver = WindowDriver::open_with(
        &experiment(&scene.to_string_lossy()),
        &["--size", "160x120"],
        &variables,
    );
    driver.first_picture();
    let real = real.path();
    loads(&mut driver, "a texture in a subfolder", || {
        paint(&real.join("pictures/paint.png"), [0, 200, 0])
    });
    loads(&mut driver, "the library", || {
        std::fs::write(real.join("quad.mtl"), "newmtl painted\nKd 0.1 0.2 0.3\n").unwrap();
    });
    loads(
        &mut driver,
        "the target of a link in CONELAB_SCENES",
        || {
            let text = std::fs::read_to_string(real.join("quad.obj")).unwrap();
            std::fs::write(real.join("quad.obj"), text + "v 0 0 1\nf 1 2 5\n").unwrap();
        },
    );
    // A model that cannot be read is looked at again when it is mended.
    let good = std::fs::read(real.join("quad.obj")).unwrap();
    driver.resting(0);
    let mark = driver.now();
    std::fs::write(real.join("quad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
    driver.event(mark, "load failed");
    loads(&mut driver, "a mended model", || {
        std::fs::write(real.join("quad.obj"), good).unwrap()
    });
    loads(&mut driver, "the scene file", || {
        std::fs::write(&scene, "(models: [(file: \"linked.obj\")], sky: (1, 0, 0))").unwrap();
    });
    driver.close();
}

#[test]
fn every_file_of_a_scene_is_watched() {
    every_file(&[]);
}

#[test]
fn folders_without_events_are_polled() {
    every_file(&[("CONELAB_WATCH", "poll")]);
}

#[test]
fn bare_names_links_to_shaders_and_keys_work() {
    let mut driver = WindowDriver::open(&experiment("cornell"), &["--size", "160x120"]);
    driver.first_picture();
    let home = driver.home.path().to_path_buf();

    // The target of a shader that is a link.
    let away = TempDir::new().unwrap();
    let target = away.path().join("target.comp");
    let link = home.join("shaders/display/display.comp");
    std::fs::rename(&link, &target).unwrap();
    let mark = driver.now();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    driver.event(mark, "changed");
    driver.resting(0);
    let mark = driver.now();
    let text = std::fs::read_to_string(&target).unwrap();
    std::fs::write(&target, text + "\n// edited\n").unwrap();
    driver.event(mark, "changed");

    // Keys read everything again, whatever the file system says.
    for keys in [&[F5][..], &[CONTROL, u32::from(b'r')]] {
        driver.resting(0);
        let mark = driver.now();
        driver.keys(keys);
        driver.event(mark, "changed");
        driver.event(mark, "loaded");
    }
    driver.close();
    drop(driver);

    // A scene by its bare name in the folder of the program.
    let mut driver = WindowDriver::open(&experiment("cornell"), &["--size", "160x120"]);
    driver.first_picture();
    model(driver.home.path());
    let home = driver.home.path().to_path_buf();
    let mark = driver.now();
    let bare = experiment("quad.obj");
    std::fs::write(home.join("configs/opened.ron"), bare).unwrap();
    driver.event(mark, "loaded");
    loads(&mut driver, "a file opened by its bare name", || {
        let text = std::fs::read_to_string(home.join("quad.obj")).unwrap();
        std::fs::write(home.join("quad.obj"), text + "v 0 0 1\nf 1 2 5\n").unwrap();
    });
    driver.close();
}
