//! The window as somebody at a screen sees it: a virtual screen, a mouse, keys, files that are edited; checked are
//! pixels of the screen and the log of events. The validation layer watches; any message of it fails the program.

mod common;
#[path = "common/window_driver.rs"]
mod window_driver;

use common::{conelab, succeeds};
use conelab::workbench::events::fingerprint;
use serde_json::Value;
use std::sync::{PoisonError, RwLock};
use std::time::{Duration, Instant};
use window_driver::{CONTROL, F1, PATIENCE, SHIFT, WINDOW, WindowDriver, centre, with};

/// Small enough for a software device to draw several a second.
const SMALL: &str = r#"(graph: "rays.ron", scene: "cornell", size: (160, 120), params: { "voxel_dim": 32, "shadow_dim": 256, "bounces": one, "gather_frames": 1, "accumulation_rounds": 1, "pixel_rays": 2 })"#;

/// A line of `shaders/gather/interleaved.glsl`, which every picture of [`SMALL`] depends on.
const GATHERED: &str = "vec4 hemisphere = vec4(0.0);";

/// The test that measures how fast the program is runs without the others, which share the cores.
static ALONE: RwLock<()> = RwLock::new(());

fn small() -> WindowDriver {
    WindowDriver::open(SMALL, &["--size", "160x120"])
}

fn number(event: &Value, name: &str) -> f64 {
    event[name]
        .as_f64()
        .unwrap_or_else(|| panic!("no {name} in {event}"))
}

fn median(list: &mut [f64]) -> f64 {
    list.sort_by(f64::total_cmp);
    list[list.len() / 2]
}

/// Drags a slider from where its handle is in the middle of its range.
fn slide(driver: &mut WindowDriver, name: &str, by: f64) {
    let rect = driver.find("Slider", name);
    let (x, y) = centre(rect);
    driver.drag((x, y), (x + by * (rect[2] - rect[0]), y));
}

#[test]
fn a_window_takes_the_changes_that_render_takes() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let changes = [
        "--size",
        "160x120",
        "--set",
        "exposure=1.5",
        "--camera",
        "(eye: (2, 3, -6), target: (2.8, 2, 2), fov_y: 50)",
    ];
    let mut driver = WindowDriver::open(SMALL, &changes);
    let first = driver.first_picture();
    let path = driver.home.path().join("changed.png");
    let mut render = conelab(driver.home.path());
    render.args(["render", "configs/opened.ron"]).args(changes);
    succeeds(render.arg("-o").arg(&path));
    let rendered = image::open(path).unwrap().to_rgba8();
    assert_eq!(fingerprint(&rendered), first);
}

#[test]
fn a_slider_changes_the_picture_and_undo_brings_it_back() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    let shot = driver.shows(&first);

    // It is the picture that the command line makes.
    let path = driver.home.path().join("first.png");
    succeeds(
        conelab(driver.home.path())
            .args(["render", "configs/opened.ron", "-o"])
            .arg(&path),
    );
    let rendered = image::open(path).unwrap().to_rgba8();
    assert_eq!(fingerprint(&rendered), first);
    assert_eq!(fingerprint(&shot.rgba), first, "texel for texel");

    driver.click("", "Display");
    let mark = driver.now();
    slide(&mut driver, "exposure", 0.15);
    driver.other_picture(mark, 0, &first);
    let brighter = driver.resting(0);
    assert_ne!(brighter, first);
    driver.shows(&brighter);

    // One drag is one edit.
    let mark = driver.now();
    driver.click("Button", "undo");
    driver.picture(mark, 0, &first);
    driver.shows(&first);
    let mark = driver.now();
    driver.keys(&[CONTROL, SHIFT, u32::from(b'z')]);
    driver.picture(mark, 0, &brighter);
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'z')]);
    driver.picture(mark, 0, &first);
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'y')]);
    driver.picture(mark, 0, &brighter);
    driver.shows(&brighter);

    let mark = driver.now();
    driver.click("", "reset exposure");
    driver.picture(mark, 0, &first);
    driver.shows(&first);

    // The search looks into names, groups and help, and opens what it finds.
    let rect = driver.find("", "changed");
    driver.click_at((rect[0] - 60.0, centre(rect).1));
    driver.text("shadow_dim");
    driver.texts_until("only what was searched for", |texts| {
        let has = |name: &str| texts.iter().any(|t| t == name);
        has("shadow_dim") && !has("exposure") && !has("voxel_dim")
    });
    // What is typed there is no key for anything else.
    assert_eq!(driver.resting(0), first);
    for _ in 0.."shadow_dim".len() {
        driver.keys(&[0xff08]);
    }
    driver.texts_until("everything", |texts| texts.iter().any(|t| t == "exposure"));

    // Another scene, and back.
    let mark = driver.now();
    driver.click("", "scene: cornell");
    driver.click("", "triangles");
    driver.wait(mark, "another scene", |e| {
        e["event"] == "loaded" && e["scene"] == "triangles"
    });
    driver.other_picture(mark, 0, &first);
    let mark = driver.now();
    driver.click("Button", "undo");
    driver.wait(mark, "the first scene", |e| {
        e["event"] == "loaded" && e["scene"] == "cornell"
    });
    driver.close();
}

#[test]
fn a_saved_shader_is_shown_and_a_broken_one_leaves_the_last_picture() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    let good = driver.shows(&first);
    let display = driver.file("shaders/display/display.comp");
    let gather = driver.file("shaders/gather/interleaved.glsl");

    // Saved in two ways: a new file renamed over the old one, and the old file written.
    let line = "toneMap(c * exp2(params.exposure))";
    let dimmed = with(&display, line, &format!("0.5 * {line}"));
    let mark = driver.now();
    driver.rename_into("shaders/display/display.comp", &dimmed);
    let dim = driver.other_picture(mark, 0, &first);
    driver.shows(&dim);
    let built = driver.event(mark, "built");
    assert_eq!(
        number(&built, "rebuilt"),
        1.0,
        "only the pass that shows: {built}"
    );
    assert!(number(&built, "kept") > 5.0, "{built}");
    let mark = driver.now();
    driver.write("shaders/display/display.comp", &display);
    driver.picture(mark, 0, &first);
    driver.shows(&first);
    let mark = driver.now();
    driver.write("shaders/display/display.comp", &dimmed);
    driver.picture(mark, 0, &dim);
    let mark = driver.now();
    driver.rename_into("shaders/display/display.comp", &display);
    driver.picture(mark, 0, &first);
    driver.shows(&first);

    // An include builds what includes it.
    let mark = driver.now();
    driver.rename_into(
        "shaders/gather/interleaved.glsl",
        &with(&gather, GATHERED, "vec4 hemisphere = vec4(0.1);"),
    );
    let glowing = driver.other_picture(mark, 0, &first);
    let built = driver.event(mark, "built");
    assert_eq!(
        number(&built, "rebuilt"),
        1.0,
        "only one pass gathers: {built}"
    );
    assert!(number(&built, "kept") > 5.0, "{built}");
    driver.shows(&glowing);
    let mark = driver.now();
    driver.rename_into("shaders/gather/interleaved.glsl", &gather);
    driver.picture(mark, 0, &first);
    driver.shows(&first);

    // Four ways to break it: file, text, and the place and words that the window must show.
    let graph = driver.file("passes/parts/display.ron");
    let at = |text: &str, part: &str| 1 + text.lines().position(|l| l.contains(part)).unwrap();
    let source = "(of: \"radiance\"),";
    let cases = [
        (
            "shaders/display/display.comp",
            with(
                &display,
                "uniform sampler2D source;",
                "uniform sampler2D source",
            ),
            None,
            "syntax",
        ),
        (
            "shaders/display/display.comp",
            with(
                &display,
                "#include \"params.glsl\"",
                "#include \"params.glsl\"\n#include \"parms.glsl\"",
            ),
            Some(at(&display, "#include \"params.glsl\"") + 1),
            "parms.glsl",
        ),
        (
            "shaders/display/display.comp",
            display
                .replace("sampler2D source", "sampler2D sourze")
                .replace("texelFetch(source", "texelFetch(sourze"),
            Some(at(&display, "sampler2D source")),
            "sourze",
        ),
        (
            "passes/parts/display.ron",
            with(
                &graph,
                source,
                &source.replace("\"radiance\"", "\"radiant\""),
            ),
            Some(at(&graph, source)),
            "radiant",
        ),
    ];
    for (file, text, line, words) in cases {
        let right = if file.ends_with("ron") {
            &graph
        } else {
            &display
        };
        let mark = driver.now();
        driver.rename_into(file, &text);
        let failed = driver.event(mark, "failed");
        let errors: Vec<&str> = failed["errors"]
            .as_array()
            .unwrap()
            .iter()
            .map(|e| e.as_str().unwrap())
            .collect();
        let said = errors.join("\n");
        println!("{said}\n");
        assert!(said.contains(words), "{said}");
        let name = line.map_or(format!("{file}:"), |line| format!("{file}:{line}"));
        assert!(said.contains(&name), "no {name} in: {said}");
        driver.texts_until("the error", |texts| {
            texts.iter().any(|t| t.contains(&name) && t.contains(words))
        });
        // The picture stays; a thin frame says that it is an old one.
        driver.screenshot_until("the last good picture", |shot| {
            shot.inner() == good.inner() && *shot != good
        });
        driver.rename_into(file, right);
        driver.event(mark, "mended");
        driver.picture(mark, 0, &first);
        driver.texts_until("no error", |texts| !texts.iter().any(|t| t.contains(&name)));
        driver.shows(&first);
    }
    driver.close();
}

#[test]
fn a_and_b_are_told_apart_on_the_screen_and_in_numbers() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    let a = driver.shows(&first);
    let (width, middle) = (a.size.0, a.size.0 / 2);

    // B is a copy at first: nothing differs.
    let mark = driver.now();
    driver.click("", "A | B");
    driver.picture(mark, 1, &first);
    for mode in ["difference", "FLIP error"] {
        let mark = driver.now();
        driver.click("", mode);
        let compared = driver.wait(mark, mode, |e| {
            e["event"] == "compared" && e["mode"] == mode
        });
        assert_eq!(
            (number(&compared, "max"), number(&compared, "differing")),
            (0.0, 0.0),
            "{compared}"
        );
    }

    // One parameter of B: numbers in both modes.
    driver.click("", "Display");
    let mark = driver.now();
    slide(&mut driver, "exposure", 0.15);
    driver.other_picture(mark, 1, &first);
    let other = driver.resting(1);
    driver.wait(mark, "FLIP", |e| {
        e["event"] == "compared" && number(e, "mean") > 0.01 && number(e, "max") <= 1.0
    });
    let mark = driver.now();
    driver.click("", "difference");
    driver.wait(mark, "difference", |e| {
        e["event"] == "compared"
            && e["mode"] == "difference"
            && number(e, "mean") > 1.0
            && number(e, "differing") > 9600.0
    });
    assert_eq!(driver.resting(0), first, "A stays as it is");

    // Whole pictures by flipping; halves by the line, which follows the mouse.
    driver.click("", "toggle");
    driver.keys(&[u32::from(b'x')]);
    driver.find("", "showing B (press X)");
    let b = driver.still_screenshot();
    assert!(b.inner() != a.inner());
    let badge = 24; // The letters are drawn over the picture.
    let halves = |line: usize| {
        let (a, b) = (a.clone(), b.clone());
        move |shot: &window_driver::Screenshot| {
            let (left, right) = (0..line - badge, line + badge..width);
            shot.part(left.clone(), badge) == a.part(left, badge)
                && shot.part(right.clone(), badge) == b.part(right, badge)
        }
    };
    driver.click("", "split");
    driver.screenshot_until("A left of the middle, B right of it", halves(middle));
    let place = driver.place();
    let (x, y) = centre(place);
    driver.drag((x, y), (x - 0.2 * (place[2] - place[0]), y));
    driver.screenshot_until("the line at 30 %", halves(3 * width / 10));

    let mark = driver.now();
    driver.click("", "Copy B to A");
    driver.picture(mark, 0, &other);

    // A comparison that the graph offers.
    driver.click("", "FLIP error");
    let mark = driver.now();
    driver.click("", "Compare");
    driver.click("", "raster | tessellated");
    driver.wait(mark, "B built", |e| e["event"] == "built" && e["side"] == 1);
    driver.other_picture(mark, 1, &other);
    driver.wait(mark, "FLIP", |e| {
        e["event"] == "compared" && number(e, "mean") > 0.0
    });
    driver.click("", "A | B");
    driver.texts_until("A alone", |texts| !texts.iter().any(|t| t == "FLIP error"));
    driver.shows(&other);
    driver.close();
}

#[test]
fn files_are_opened_by_a_dialog_cameras_and_comparisons_are_kept() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();

    // A camera is kept by name, and is there again after a drag.
    driver.click("", "Scene");
    driver.click("TextInput", "camera name");
    driver.text("corner");
    driver.click("Button", "add bookmark");
    driver.find("Button", "corner");
    assert!(
        driver
            .file("captures/cameras/cornell/corner.ron")
            .contains("eye")
    );
    let (x, y) = centre(driver.place());
    let mark = driver.now();
    driver.drag((x, y), (x + 40.0, y));
    driver.other_picture(mark, 0, &first);
    driver.resting(0);
    let mark = driver.now();
    driver.click("Button", "corner");
    driver.picture(mark, 0, &first);

    // H hides the panels: the picture has the whole width. Again, they are back.
    let narrow = driver.place();
    driver.keys(&[u32::from(b'h')]);
    driver.wait_place("a picture in the middle of the window", |r| r != narrow);
    driver.keys(&[u32::from(b'h')]);
    driver.wait_place("the panels again", |r| r == narrow);

    // What is compared is saved as it is shown: both halves of equal pictures are the picture.
    let mark = driver.now();
    driver.click("", "A | B");
    driver.picture(mark, 1, &first);
    driver.resting(1);
    driver.click("", "save picture");
    driver.texts_until("where it was saved", |texts| {
        texts.iter().any(|t| t.contains("opened-split"))
    });
    let saved = driver.home.path().join("captures/opened-split.png");
    let saved = image::open(saved).unwrap().to_rgba8();
    assert_eq!(fingerprint(&saved), first);
    driver.click("", "A | B");

    // Ctrl O asks for a file; this one is a scene, which shows itself.
    std::fs::copy(
        common::root().join("configs/scenes/workshop.ron"),
        driver.home.path().join("bench.ron"),
    )
    .unwrap();
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'o')]);
    driver.click("", "🗋 bench.ron");
    driver.click("", "🗀  Open");
    driver.wait(mark, "the scene", |e| {
        e["event"] == "loaded" && e["scene"] == "workshop"
    });
    driver.other_picture(mark, 0, &first);
    // It is loaded once: the log of events that grows beside it is none of its files.
    let mark = driver.now();
    driver.keys(&[u32::from(b't')]);
    driver.resting(0);
    assert!(
        driver.events[mark..].iter().all(|e| e["event"] != "loaded"),
        "nothing of the scene was changed"
    );
    driver.close();
}

#[test]
fn a_window_may_become_tiny_or_vanish_for_a_while() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    driver.shows(&first);
    let dimmed = driver
        .file("shaders/display/display.comp")
        .replace("c * exp2", "0.5 * c * exp2");
    for (width, height) in [(1, 1), (3000, 2), (333, 222), (1, 700)] {
        driver.resize(width, height);
        std::thread::sleep(Duration::from_millis(150));
    }
    driver.resize(WINDOW.0, WINDOW.1);
    driver.shows(&first);

    driver.unmap();
    std::thread::sleep(Duration::from_millis(200));
    let mark = driver.now();
    driver.rename_into("shaders/display/display.comp", &dimmed);
    std::thread::sleep(Duration::from_millis(300));
    driver.map();
    let dim = driver.other_picture(mark, 0, &first);
    driver.shows(&dim);
    driver.close();

    drop(driver);

    // A picture as large as the middle follows the window.
    let mut driver = WindowDriver::open(SMALL, &[]);
    driver.first_picture();
    let before = driver.place();
    let mark = driver.now();
    driver.resize(1000, 500);
    driver.wait(mark, "smaller picture", |e| {
        e["event"] == "picture" && number(e, "gpu_ms") > 0.0 && {
            e["size"][1].as_f64().unwrap() < before[3] - before[1]
        }
    });
    // Panels may be laid out once more: the picture of the final size counts.
    let mut print = driver.resting(0);
    let until = Instant::now() + PATIENCE;
    loop {
        let place = driver.place();
        let last = driver
            .events
            .iter()
            .rev()
            .find(|e| e["event"] == "picture")
            .unwrap();
        let size = [0, 1].map(|i| last["size"][i].as_f64().unwrap());
        if size == [place[2] - place[0], place[3] - place[1]] {
            break;
        }
        assert!(
            Instant::now() < until,
            "a picture of {size:?} is shown at {place:?}"
        );
        print = driver.resting(0);
    }
    driver.shows(&print);
    driver.close();
}

#[test]
fn two_hundred_reloads_leave_nothing_behind() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = WindowDriver::open(SMALL, &["--size", "32x24"]);
    driver.first_picture();
    let display = driver.file("shaders/display/display.comp");
    let start = Instant::now();
    let (mut memory, mut objects) = (0.0, 0.0);
    for i in 0..200 {
        let mark = driver.now();
        let factor = if i % 2 == 0 {
            "0.5 * c * exp2"
        } else {
            "0.6 * c * exp2"
        };
        driver.rename_into(
            "shaders/display/display.comp",
            &display.replace("c * exp2", factor),
        );
        let built = driver.event(mark, "built");
        if i == 20 {
            (memory, objects) = (driver.memory(), number(&built, "objects"));
        }
        if i == 199 {
            let (now, count) = (driver.memory(), number(&built, "objects"));
            println!("200 reloads in {:.1} s", start.elapsed().as_secs_f64());
            println!("memory {memory:.1} to {now:.1} MiB, Vulkan objects {objects} to {count}");
            assert!(now < 1.1 * memory, "{memory:.1} MiB became {now:.1}");
            // Buffers for pictures that the window has not taken yet come and go; what stayed of each reload would be 179 and more.
            assert!(
                count < objects + 10.0,
                "{objects} Vulkan objects became {count}"
            );
        }
    }
    // How fast a reload is has a test of its own, which runs alone.
    driver.close();
}

/// Most between a save and its frame, ms, on two cores; most of it is the compiler.
const LIMIT: f64 = 400.0;

#[test]
fn a_save_is_on_the_screen_before_one_looks_up() {
    let _alone = ALONE.write().unwrap_or_else(PoisonError::into_inner);
    // Nothing is compiled yet.
    let cache = tempfile::tempdir().unwrap();
    let cache = [("CONELAB_CACHE", cache.path().to_str().unwrap())];
    let mut driver = WindowDriver::open_with(SMALL, &["--size", "160x120"], &cache);
    let mut last = driver.first_picture();
    // A slow machine needs longer for all: then the bound is a part of what building the whole graph took.
    let limit = LIMIT.max(0.6 * number(&driver.event(0, "built"), "build_ms"));
    let gather = driver.file("shaders/gather/interleaved.glsl");
    // What else the machine does only adds: the best of three rounds counts.
    let mut rounds = Vec::new();
    for round in 0..3 {
        rounds.push(saves(&mut driver, &mut last, &gather, 1 + 8 * round));
        if rounds[round as usize].0 < limit + rounds[round as usize].2 {
            break;
        }
    }
    let (whole, build, frame) = rounds
        .into_iter()
        .min_by(|a, b| (a.0 - a.2).total_cmp(&(b.0 - b.2)))
        .unwrap();
    println!(
        "from save to pixels: {whole:.0} ms (build {build:.0} ms, frame {frame:.0} ms), median of 8"
    );
    assert!(
        whole < limit + frame,
        "{whole:.0} ms, of which the frame {frame:.0}; at most {limit:.0} beside it"
    );
    driver.close();
}

/// Medians over eight saves, ms: from renaming the file to the new picture on the screen, of the build, of the frame.
fn saves(
    driver: &mut WindowDriver,
    last: &mut String,
    gather: &str,
    first: u32,
) -> (f64, f64, f64) {
    let (mut whole, mut builds, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    for i in first..first + 8 {
        let text = with(
            gather,
            GATHERED,
            &format!("vec4 hemisphere = vec4({});", 0.02 * f64::from(i)),
        );
        let mark = driver.now();
        let start = Instant::now();
        driver.rename_into("shaders/gather/interleaved.glsl", &text);
        let painted = driver.wait(mark, "new picture on the screen", |e| {
            e["event"] == "painted"
                && e["pictures"][0] == 0
                && e["fingerprints"][0] != last.as_str()
        });
        whole.push(start.elapsed().as_secs_f64() * 1e3);
        *last = painted["fingerprints"][0].as_str().unwrap().to_string();
        builds.push(number(&driver.event(mark, "built"), "build_ms"));
        frames.push(number(&driver.event(mark, "picture"), "gpu_ms"));
        driver.resting(0);
    }
    (median(&mut whole), median(&mut builds), median(&mut frames))
}

#[test]
fn the_window_answers_and_closes_while_a_slow_device_renders() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = WindowDriver::open(SMALL, &["--size", "1400x1050"]);
    let slow = driver.wait_at_most(Duration::from_secs(300), 0, "picture", |e| {
        e["event"] == "picture" && e["preview"] == false
    });
    println!("a frame takes {:.0} ms", number(&slow, "gpu_ms"));
    driver.click("", "continuous");
    let mut waits = Vec::new();
    for shown in [true, false, true, false, true] {
        std::thread::sleep(Duration::from_millis(300));
        let start = Instant::now();
        driver.keys(&[F1]);
        while driver.texts().iter().any(|t| t == "Show this help") != shown {
            assert!(start.elapsed() < PATIENCE, "{:?}", driver.texts());
            std::thread::sleep(Duration::from_millis(2));
        }
        waits.push(start.elapsed().as_secs_f64() * 1e3);
    }
    println!("from key to help window: {waits:.0?} ms");
    // What else the machine does only adds: the fastest answer counts.
    assert!(waits.iter().any(|w| *w < 300.0), "{waits:?}");
    let took = driver.close();
    println!("closed in {:.2} s", took.as_secs_f64());
    // It waits for the frames that the device has begun.
    let frames = Duration::from_secs_f64(4.0 * number(&slow, "gpu_ms") * 1e-3);
    assert!(
        took < frames.max(Duration::from_secs(5)),
        "{took:?}, four frames take {frames:?}"
    );
}

#[test]
fn unchanged_passes_are_skipped_at_a_click() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    driver.click("", "continuous");
    driver.click("", "Profiler");
    let mark = driver.now();
    driver.event(mark, "picture");
    assert!(
        driver
            .events
            .iter()
            .all(|e| e["event"] != "picture" || e["skipped"] == 0),
        "all is done"
    );
    driver.click("", "Skip unchanged passes");
    let skipped =
        |e: &Value| e["event"] == "picture" && e["skipped"].as_u64().is_some_and(|n| n > 20);
    let still = driver.wait(mark, "most passes are skipped", skipped);
    assert_eq!(still["fingerprint"], first, "the same picture");
    let mark = driver.now();
    driver.click("", "Skip unchanged passes");
    let all = driver.wait(mark, "all passes run", |e| {
        e["event"] == "picture" && e["skipped"] == 0
    });
    assert_eq!(all["fingerprint"], first);
}

#[test]
fn what_was_saved_is_there_after_a_restart_and_captures_replay() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    driver.click("", "Display");
    let mark = driver.now();
    slide(&mut driver, "exposure", 0.15);
    driver.other_picture(mark, 0, &first);
    let brighter = driver.resting(0);

    // A file that exists is not replaced by the first click.
    driver.grow_lower_tabs();
    driver.click("", "Save");
    let before = driver.file("configs/opened.ron");
    let mark = driver.now();
    driver.click("Button", "save");
    driver.event(mark, "not saved");
    assert_eq!(driver.file("configs/opened.ron"), before);
    let mark = driver.now();
    driver.click("Button", "Overwrite");
    driver.event(mark, "saved");
    let saved = driver.file("configs/opened.ron");
    assert!(
        saved.contains("exposure")
            && saved.contains("\"voxel_dim\": 32")
            && !saved.contains("bias"),
        "{saved}"
    );

    // A capture holds the picture that was on the screen, and makes it again.
    let mark = driver.now();
    driver.click("Button", "capture");
    let captured = driver.event(mark, "captured");
    assert_eq!(captured["ok"], true, "{captured}");
    let picture = image::open(driver.home.path().join("captures/opened/picture.png"))
        .unwrap()
        .to_rgba8();
    assert_eq!(fingerprint(&picture), brighter);
    let said = succeeds(conelab(driver.home.path()).args(["replay", "captures/opened"]));
    assert!(said.starts_with("identical"), "{said}");

    // From the gallery too; and its settings can be loaded.
    let mark = driver.now();
    driver.click("", "replay opened");
    let replayed = driver.wait_at_most(Duration::from_secs(120), mark, "a replay", |e| {
        e["event"] == "replayed"
    });
    assert!(
        replayed["text"].as_str().unwrap().contains("identical"),
        "{replayed}"
    );
    let mark = driver.now();
    driver.click("", "reset exposure");
    driver.picture(mark, 0, &first);
    let mark = driver.now();
    driver.click("", "load opened");
    driver.picture(mark, 0, &brighter);
    driver.close();
    drop(driver);

    let mut again = WindowDriver::open(&saved, &["--size", "160x120"]);
    assert_eq!(
        again.first_picture(),
        brighter,
        "the same picture after a restart"
    );
    again.close();
}

#[test]
fn the_camera_follows_a_path_and_the_tabs_show_what_they_are_for() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();

    // A key here, another after a drag, and the scene's time moves between them.
    driver.click("", "Motion");
    driver.click("Button", "add key");
    let rect = driver.place();
    let (x, y) = centre(rect);
    let mark = driver.now();
    driver.drag((x, y), (x + 40.0, y));
    driver.other_picture(mark, 0, &first);
    let turned = driver.resting(0);
    driver.click("Button", "add key");
    let mark = driver.now();
    driver.click("", "follow");
    driver.picture(mark, 0, &first);
    let mark = driver.now();
    // '.' steps a sixtieth of a second.
    for _ in 0..3 {
        driver.keys(&[u32::from(b'.')]);
    }
    driver.other_picture(mark, 0, &first);
    assert_ne!(driver.resting(0), turned, "between the keys");
    driver.click("", "follow");
    driver.shows(&turned);

    // A click shows cones and their samples, Escape takes them away.
    let mark = driver.now();
    driver.click_at((x, y + 20.0));
    driver.other_picture(mark, 0, &turned);
    driver.click("", "Probe: show tables");
    driver.texts_until("the table of samples", |texts| {
        texts.iter().any(|t| t.contains("Cone samples"))
    });
    driver.texts_until("rows", |texts| {
        texts
            .iter()
            .any(|t| t.contains("rows") && !t.starts_with("0 of"))
    });
    let mark = driver.now();
    driver.keys(&[0xff1b]);
    driver.picture(mark, 0, &turned);

    driver.click("", "Profiler");
    driver.texts_until("the passes", |texts| {
        texts.iter().any(|t| t.contains("shading"))
    });
    driver.click("", "Inspect");
    driver.texts_until("statistics", |texts| texts.iter().any(|t| t == "NaN"));
    driver.close();
}

/// A menu takes Escape before the probe does, letters and digits act at once, and Enter saves.
#[test]
fn keys_open_tabs_compare_and_close_what_is_open() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    const ESCAPE: u32 = 0xff1b;
    const ENTER: u32 = 0xff0d;
    let mut driver = small();
    let first = driver.first_picture();
    let has = |text: &'static str| move |texts: &[String]| texts.iter().any(|t| t == text);
    let misses = |text: &'static str| move |texts: &[String]| texts.iter().all(|t| t != text);
    let letter = |c: char| [c as u32];

    driver.keys(&letter('5'));
    driver.texts_until("the inspector", has("NaN"));
    // The handles move while the range of an unfinished picture is fitted.
    driver.resting(0);
    let white = driver.find("Slider", "histogram white");
    let (x, y) = centre(white);
    driver.drag((x, y), (x - 80.0, y));
    driver.texts_until("texels above white", |texts| {
        let marked = texts.iter().find(|t| t.starts_with("above white ("));
        marked.is_some_and(|t| t != "above white (0)")
    });
    driver.keys(&letter('1'));
    driver.texts_until("the scene", has("add bookmark"));

    driver.keys(&letter('b'));
    driver.texts_until("modes of comparison", has("side by side"));
    driver.keys(&letter('m'));
    driver.texts_until("the next mode", has("showing A (press X)"));
    driver.keys(&letter('b'));
    driver.texts_until("no comparison", misses("side by side"));
    driver.keys(&letter('c'));
    driver.texts_until("frames without end", has("running"));
    driver.keys(&letter('c'));
    driver.texts_until("a picture that rests", has("converged"));

    let (x, y) = centre(driver.place());
    let mark = driver.now();
    driver.click_at((x, y + 20.0));
    let probed = driver.other_picture(mark, 0, &first);
    driver.click("", "File");
    driver.texts_until("the menu", has("Capture F12"));
    driver.keys(&[ESCAPE]);
    driver.texts_until("no menu", misses("Capture F12"));
    driver.shows(&probed);
    let mark = driver.now();
    driver.keys(&[ESCAPE]);
    driver.picture(mark, 0, &first);

    driver.keys(&letter('8'));
    driver.click("TextInput", "experiment name");
    driver.keys(&[CONTROL, u32::from(b'a')]);
    driver.text("entered");
    let mark = driver.now();
    driver.keys(&[ENTER]);
    driver.event(mark, "saved");
    assert!(!driver.file("configs/entered.ron").is_empty());
    driver.close();
}

#[test]
fn times_stand_on_the_picture_and_passes_are_inspected_and_left_out() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    let plain = driver.shows(&first);

    // T puts the times of stages on the picture, then those of passes, then nothing.
    driver.keys(&[u32::from(b't')]);
    let stages = driver.screenshot_until("times of stages", |shot| shot.rgba != plain.rgba);
    driver.keys(&[u32::from(b't')]);
    driver.screenshot_until("times of passes", |shot| {
        shot.rgba != plain.rgba && shot.rgba != stages.rgba
    });
    driver.keys(&[u32::from(b't')]);
    driver.screenshot_until("the picture alone", |shot| shot.rgba == plain.rgba);

    // A pass that is off is left out of the picture and saved as such.
    driver.click("", "Graph");
    driver.click("", "Show the nodes");
    driver.click("Button", "pass shadow map");
    let mark = driver.now();
    driver.click("", "on");
    let failed = driver.wait(mark, "an error or a picture", |e| {
        e["event"] == "built" || e["event"] == "failed"
    });
    assert_eq!(failed["event"], "built", "{failed}");
    driver.texts_until("what is off", |texts| {
        texts.iter().any(|t| t == "off: shadow map")
    });
    let dark = driver.other_picture(mark, 0, &first);
    let mark = driver.now();
    driver.click("Button", "all passes on");
    driver.picture(mark, 0, &first);
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'z')]);
    driver.picture(mark, 0, &dark);
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'z')]);
    driver.picture(mark, 0, &first);

    // A pass that does not run is found, says why, and what would make it run.
    driver.click("TextInput", "find a pass, a texture");
    driver.text("tessel");
    driver.click("Button", "find pass voxelize tessellated");
    driver.texts_until("why it does not run", |texts| {
        texts
            .iter()
            .any(|t| t == "does not run: needs tessellates == 1")
    });
    driver.find("Button", "voxelizer = tessellated");

    // What is empty because a pass is off is said, and who reads it.
    driver.click("TextInput", "find a pass, a texture");
    driver.text("inj");
    driver.click("Button", "find pass inject");
    driver.click("", "on");
    driver.texts_until("what is empty", |texts| {
        texts
            .iter()
            .any(|t| t.starts_with("sideRadiance is zero now; "))
    });
    let mark = driver.now();
    driver.click("Button", "all passes on");
    driver.picture(mark, 0, &first);

    // With and without a filter: B reads what the filter would have read.
    driver.click("TextInput", "find a pass, a texture");
    driver.text("smoo");
    driver.click("Button", "find pass smooth");
    let mark = driver.now();
    driver.click("Button", "Compare with/without");
    driver.wait(mark, "B built", |e| e["event"] == "built" && e["side"] == 1);
    let rough = driver.other_picture(mark, 1, &first);
    assert_ne!(rough, dark);
    driver.texts_until("nothing is empty", |texts| {
        !texts.iter().any(|t| t.contains("is zero now"))
    });
    driver.click("", "A | B");
    driver.texts_until("A alone", |texts| !texts.iter().any(|t| t == "FLIP error"));
    driver.click("", "Nodes");
    driver.click("Button", "Fit graph");

    // A click on a texture of a pass inspects it, once the drawing is large enough to read.
    driver.click("TextInput", "find a pass, a texture");
    driver.text("shadow map");
    driver.click("Button", "find pass shadow map");
    driver.click("Button", "shadow map writes shadowMap");
    driver.texts_until("the inspected texture", |texts| {
        texts.iter().any(|t| t == "texture shadowMap")
    });
    driver.close();
}

#[test]
fn what_was_not_saved_comes_back_after_a_kill() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = small();
    let first = driver.first_picture();
    assert!(!driver.title().contains('●'), "{}", driver.title());
    driver.click("", "Display");
    let mark = driver.now();
    slide(&mut driver, "exposure", 0.15);
    driver.other_picture(mark, 0, &first);
    let brighter = driver.resting(0);
    assert_eq!(driver.title(), "● opened - cornell - conelab");
    driver.click("", "Chart");
    // Longer than the interval of writing.
    std::thread::sleep(Duration::from_secs(3));
    let size = driver.size();
    driver.kill_and_restart();
    driver.wait(0, "the picture of the last session", |e| {
        e["event"] == "picture" && e["fingerprint"] == brighter.as_str()
    });
    assert_eq!(driver.title(), "● opened - cornell - conelab");
    assert_eq!(driver.size(), size);
    driver.texts_until("the tab that was open", |texts| {
        texts.iter().any(|t| t.starts_with("Error against time"))
    });

    // Closing asks once, and saving answers it.
    driver.ask_to_close();
    driver.click("Button", "Save and close");
    driver.end(Instant::now());
    let saved = std::fs::read_to_string(driver.home.path().join("configs/opened.ron")).unwrap();
    assert!(saved.contains("exposure"), "{saved}");
}
