//! The window as somebody at a desk sees it: a virtual screen, a mouse, keys, files that are edited; what is looked at are
//! pixels of the screen and the log of events. The validation layer watches; any message of it fails the program.

mod common;
#[path = "common/desk.rs"]
mod desk;

use common::{conelab, succeeds};
use conelab::workbench::events::fingerprint;
use desk::{CONTROL, Desk, F1, SHIFT, WINDOW, centre, with};
use serde_json::Value;
use std::sync::{PoisonError, RwLock};
use std::time::{Duration, Instant};

/// Small enough for a software device to draw several a second.
const SMALL: &str =
    r#"(graph: "vct.ron", scene: "cornell", size: (160, 120), params: { "voxel_dim": 32, "shadow_dim": 256 })"#;

/// The test that measures how fast the program is runs without the others, which share the cores.
static ALONE: RwLock<()> = RwLock::new(());

fn small() -> Desk {
    Desk::open(SMALL, &["--size", "160x120"])
}

fn number(event: &Value, name: &str) -> f64 {
    event[name].as_f64().unwrap_or_else(|| panic!("no {name} in {event}"))
}

fn median(list: &mut [f64]) -> f64 {
    list.sort_by(f64::total_cmp);
    list[list.len() / 2]
}

/// Drags a slider from where its handle is in the middle of its range.
fn slide(desk: &mut Desk, name: &str, by: f64) {
    let rect = desk.find("Slider", name);
    let (x, y) = centre(rect);
    desk.drag((x, y), (x + by * (rect[2] - rect[0]), y));
}

#[test]
fn a_slider_changes_the_picture_and_undo_brings_it_back() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = small();
    let first = desk.first_picture();
    let seen = desk.shows(&first);

    // It is the picture that the command line makes.
    let path = desk.home.path().join("first.png");
    succeeds(conelab(desk.home.path()).args(["render", "configs/desk.ron", "-o"]).arg(&path));
    let rendered = image::open(path).unwrap().to_rgba8();
    assert_eq!(fingerprint(&rendered), first);
    assert_eq!(fingerprint(&seen.rgba), first, "texel for texel");

    desk.click("", "Display");
    let mark = desk.now();
    slide(&mut desk, "exposure", 0.15);
    desk.other_picture(mark, 0, &first);
    let brighter = desk.resting(0);
    assert_ne!(brighter, first);
    desk.shows(&brighter);

    // One drag is one edit.
    let mark = desk.now();
    desk.click("Button", "undo");
    desk.picture(mark, 0, &first);
    desk.shows(&first);
    let mark = desk.now();
    desk.keys(&[CONTROL, SHIFT, u32::from(b'z')]);
    desk.picture(mark, 0, &brighter);
    let mark = desk.now();
    desk.keys(&[CONTROL, u32::from(b'z')]);
    desk.picture(mark, 0, &first);
    let mark = desk.now();
    desk.keys(&[CONTROL, u32::from(b'y')]);
    desk.picture(mark, 0, &brighter);
    desk.shows(&brighter);

    let mark = desk.now();
    desk.click("", "reset exposure");
    desk.picture(mark, 0, &first);
    desk.shows(&first);

    // The search looks into names, groups and help, and opens what it finds.
    let rect = desk.find("", "changed");
    desk.click_at((rect[0] - 60.0, centre(rect).1));
    desk.text("shadow_dim");
    desk.texts_until("only what was searched for", |texts| {
        let has = |name: &str| texts.iter().any(|t| t == name);
        has("shadow_dim") && !has("exposure") && !has("voxel_dim")
    });
    // What is typed there is no key for anything else.
    assert_eq!(desk.resting(0), first);
    for _ in 0.."shadow_dim".len() {
        desk.keys(&[0xff08]);
    }
    desk.texts_until("everything", |texts| texts.iter().any(|t| t == "exposure"));

    // Another scene, and back.
    let mark = desk.now();
    desk.click("", "scene: cornell");
    desk.click("", "triangles");
    desk.wait(mark, "another scene", |e| e["event"] == "loaded" && e["scene"] == "triangles");
    desk.other_picture(mark, 0, &first);
    let mark = desk.now();
    desk.click("Button", "undo");
    desk.wait(mark, "the first scene", |e| e["event"] == "loaded" && e["scene"] == "cornell");
    desk.close();
}

#[test]
fn a_saved_shader_is_shown_and_a_broken_one_leaves_the_last_picture() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = small();
    let first = desk.first_picture();
    let good = desk.shows(&first);
    let display = desk.file("shaders/display.frag");
    let cone = desk.file("shaders/include/cone.glsl");

    // Saved in two ways: a new file renamed over the old one, and the old file written.
    let line = "toneMap(c * exp2(params.exposure))";
    let dimmed = with(&display, line, &format!("0.5 * {line}"));
    let mark = desk.now();
    desk.rename_into("shaders/display.frag", &dimmed);
    let dim = desk.other_picture(mark, 0, &first);
    desk.shows(&dim);
    let built = desk.event(mark, "built");
    assert_eq!(number(&built, "rebuilt"), 1.0, "only the pass that shows: {built}");
    assert!(number(&built, "kept") > 5.0, "{built}");
    let mark = desk.now();
    desk.write("shaders/display.frag", &display);
    desk.picture(mark, 0, &first);
    desk.shows(&first);
    let mark = desk.now();
    desk.write("shaders/display.frag", &dimmed);
    desk.picture(mark, 0, &dim);
    let mark = desk.now();
    desk.rename_into("shaders/display.frag", &display);
    desk.picture(mark, 0, &first);
    desk.shows(&first);

    // An include builds what includes it.
    let mark = desk.now();
    desk.rename_into("shaders/include/cone.glsl", &with(&cone, "vec3 color = vec3(0.0);", "vec3 color = vec3(0.1);"));
    let glowing = desk.other_picture(mark, 0, &first);
    let built = desk.event(mark, "built");
    assert_eq!(number(&built, "rebuilt"), 1.0, "only shading traces cones: {built}");
    assert!(number(&built, "kept") > 5.0, "{built}");
    desk.shows(&glowing);
    let mark = desk.now();
    desk.rename_into("shaders/include/cone.glsl", &cone);
    desk.picture(mark, 0, &first);
    desk.shows(&first);

    // Four ways to break it: file, text, and the place and words that the window must show.
    let graph = desk.file("passes/display.ron");
    let at = |text: &str, part: &str| 1 + text.lines().position(|l| l.contains(part)).unwrap();
    let source = "bind: { \"source\": (of: \"radiance\") }, color: [(to: \"display\")])";
    let cases = [
        (
            "shaders/display.frag",
            with(&display, "uniform sampler2D source;", "uniform sampler2D source"),
            None,
            "syntax",
        ),
        (
            "shaders/display.frag",
            with(&display, "#include \"params.glsl\"", "#include \"params.glsl\"\n#include \"parms.glsl\""),
            Some(at(&display, "#include \"params.glsl\"") + 1),
            "parms.glsl",
        ),
        (
            "shaders/display.frag",
            display.replace("sampler2D source", "sampler2D sourze").replace("texelFetch(source", "texelFetch(sourze"),
            Some(at(&display, "sampler2D source")),
            "sourze",
        ),
        (
            "passes/display.ron",
            with(&graph, source, &source.replace("\"radiance\"", "\"radiant\"")),
            Some(at(&graph, source)),
            "radiant",
        ),
    ];
    for (file, text, line, words) in cases {
        let right = if file.ends_with("ron") { &graph } else { &display };
        let mark = desk.now();
        desk.rename_into(file, &text);
        let failed = desk.event(mark, "failed");
        let errors: Vec<&str> = failed["errors"].as_array().unwrap().iter().map(|e| e.as_str().unwrap()).collect();
        let said = errors.join("\n");
        println!("{said}\n");
        assert!(said.contains(words), "{said}");
        let name = line.map_or(format!("{file}:"), |line| format!("{file}:{line}"));
        assert!(said.contains(&name), "no {name} in: {said}");
        desk.texts_until("the error", |texts| texts.iter().any(|t| t.contains(&name) && t.contains(words)));
        // The picture stays; a thin frame says that it is an old one.
        desk.look_until("the last good picture", |seen| seen.inner() == good.inner() && *seen != good);
        desk.rename_into(file, right);
        desk.event(mark, "mended");
        desk.picture(mark, 0, &first);
        desk.texts_until("no error", |texts| !texts.iter().any(|t| t.contains(&name)));
        desk.shows(&first);
    }
    desk.close();
}

#[test]
fn a_and_b_are_told_apart_on_the_screen_and_in_numbers() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = small();
    let first = desk.first_picture();
    let a = desk.shows(&first);
    let (width, middle) = (a.size.0, a.size.0 / 2);

    // B is a copy at first: nothing differs.
    let mark = desk.now();
    desk.click("", "A | B");
    desk.picture(mark, 1, &first);
    for mode in ["difference", "FLIP"] {
        let mark = desk.now();
        desk.click("", mode);
        let compared = desk.wait(mark, mode, |e| e["event"] == "compared" && e["mode"] == mode);
        assert_eq!((number(&compared, "max"), number(&compared, "differing")), (0.0, 0.0), "{compared}");
    }

    // One parameter of B: numbers in both modes.
    desk.click("", "Display");
    let mark = desk.now();
    slide(&mut desk, "exposure", 0.15);
    desk.other_picture(mark, 1, &first);
    let other = desk.resting(1);
    desk.wait(mark, "FLIP", |e| e["event"] == "compared" && number(e, "mean") > 0.01 && number(e, "max") <= 1.0);
    let mark = desk.now();
    desk.click("", "difference");
    desk.wait(mark, "difference", |e| {
        e["event"] == "compared"
            && e["mode"] == "difference"
            && number(e, "mean") > 1.0
            && number(e, "differing") > 9600.0
    });
    assert_eq!(desk.resting(0), first, "A stays as it is");

    // Whole pictures by flipping; halves by the line, which follows the mouse.
    desk.click("", "flip");
    desk.keys(&[u32::from(b'x')]);
    desk.find("", "showing B (press X)");
    let b = desk.look_still();
    assert!(b.inner() != a.inner());
    let badge = 24; // The letters are drawn over the picture.
    let halves = |line: usize| {
        let (a, b) = (a.clone(), b.clone());
        move |seen: &desk::Seen| {
            let (left, right) = (0..line - badge, line + badge..width);
            seen.part(left.clone(), badge) == a.part(left, badge)
                && seen.part(right.clone(), badge) == b.part(right, badge)
        }
    };
    desk.click("", "split");
    desk.look_until("A left of the middle, B right of it", halves(middle));
    let place = desk.place();
    let (x, y) = centre(place);
    desk.drag((x, y), (x - 0.2 * (place[2] - place[0]), y));
    desk.look_until("the line at 30 %", halves(3 * width / 10));

    let mark = desk.now();
    desk.click("", "B to A");
    desk.picture(mark, 0, &other);

    // A comparison that the graph offers.
    desk.click("", "FLIP");
    let mark = desk.now();
    desk.click("", "raster | tessellated");
    desk.wait(mark, "B built", |e| e["event"] == "built" && e["side"] == 1);
    desk.other_picture(mark, 1, &other);
    desk.wait(mark, "FLIP", |e| e["event"] == "compared" && number(e, "mean") > 0.0);
    desk.click("", "A | B");
    desk.texts_until("A alone", |texts| !texts.iter().any(|t| t == "FLIP"));
    desk.shows(&other);
    desk.close();
}

#[test]
fn a_window_may_become_tiny_or_vanish_for_a_while() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = small();
    let first = desk.first_picture();
    desk.shows(&first);
    let dimmed = desk.file("shaders/display.frag").replace("c * exp2", "0.5 * c * exp2");
    for (width, height) in [(1, 1), (3000, 2), (333, 222), (1, 700)] {
        desk.resize(width, height);
        std::thread::sleep(Duration::from_millis(150));
    }
    desk.resize(WINDOW.0, WINDOW.1);
    desk.shows(&first);

    desk.unmap();
    std::thread::sleep(Duration::from_millis(200));
    let mark = desk.now();
    desk.rename_into("shaders/display.frag", &dimmed);
    std::thread::sleep(Duration::from_millis(300));
    desk.map();
    let dim = desk.other_picture(mark, 0, &first);
    desk.shows(&dim);
    desk.close();

    drop(desk);

    // A picture as large as the middle follows the window.
    let mut desk = Desk::open(SMALL, &[]);
    desk.first_picture();
    let before = desk.place();
    let mark = desk.now();
    desk.resize(1000, 500);
    let size = desk.wait(mark, "smaller picture", |e| {
        e["event"] == "picture" && number(e, "gpu_ms") > 0.0 && {
            e["size"][1].as_f64().unwrap() < before[3] - before[1]
        }
    });
    let print = desk.resting(0);
    let place = desk.place();
    assert_eq!(
        (place[2] - place[0], place[3] - place[1]),
        (size["size"][0].as_f64().unwrap(), size["size"][1].as_f64().unwrap())
    );
    desk.shows(&print);
    desk.close();
}

#[test]
fn two_hundred_reloads_leave_nothing_behind() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = Desk::open(SMALL, &["--size", "32x24"]);
    desk.first_picture();
    let display = desk.file("shaders/display.frag");
    let start = Instant::now();
    let (mut memory, mut objects) = (0.0, 0.0);
    for i in 0..200 {
        let mark = desk.now();
        let factor = if i % 2 == 0 { "0.5 * c * exp2" } else { "0.6 * c * exp2" };
        desk.rename_into("shaders/display.frag", &display.replace("c * exp2", factor));
        let built = desk.event(mark, "built");
        if i == 20 {
            (memory, objects) = (desk.memory(), number(&built, "objects"));
        }
        if i == 199 {
            let (now, count) = (desk.memory(), number(&built, "objects"));
            println!("200 reloads in {:.1} s", start.elapsed().as_secs_f64());
            println!("memory {memory:.1} to {now:.1} MiB, Vulkan objects {objects} to {count}");
            assert!(now < 1.1 * memory, "{memory:.1} MiB became {now:.1}");
            assert_eq!(count, objects, "Vulkan objects");
        }
    }
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
    desk.close();
}

/// Most between a save and its frame, ms, on two cores; most of it is the compiler.
const LIMIT: f64 = 400.0;

#[test]
fn a_save_is_on_the_screen_before_one_looks_up() {
    let _alone = ALONE.write().unwrap_or_else(PoisonError::into_inner);
    let mut desk = small();
    let mut last = desk.first_picture();
    let cone = desk.file("shaders/include/cone.glsl");
    // What else the machine does only adds: the best of three rounds counts.
    let mut rounds = Vec::new();
    for round in 0..3 {
        rounds.push(saves(&mut desk, &mut last, &cone, 1 + 8 * round));
        if rounds[round as usize].0 < LIMIT + rounds[round as usize].2 {
            break;
        }
    }
    let (whole, build, frame) = rounds.into_iter().min_by(|a, b| (a.0 - a.2).total_cmp(&(b.0 - b.2))).unwrap();
    println!("from save to pixels: {whole:.0} ms (build {build:.0} ms, frame {frame:.0} ms), median of 8");
    assert!(whole < LIMIT + frame, "{whole:.0} ms, of which the frame {frame:.0}");
    desk.close();
}

/// Medians over eight saves, ms: from renaming the file to the new picture on the screen, of the build, of the frame.
fn saves(desk: &mut Desk, last: &mut String, cone: &str, first: u32) -> (f64, f64, f64) {
    let (mut whole, mut builds, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    for i in first..first + 8 {
        let text = with(cone, "vec3 color = vec3(0.0);", &format!("vec3 color = vec3({});", 0.02 * f64::from(i)));
        let mark = desk.now();
        let start = Instant::now();
        desk.rename_into("shaders/include/cone.glsl", &text);
        let painted = desk.wait(mark, "new picture on the screen", |e| {
            e["event"] == "painted" && e["pictures"][0] == 0 && e["fingerprints"][0] != last.as_str()
        });
        whole.push(start.elapsed().as_secs_f64() * 1e3);
        *last = painted["fingerprints"][0].as_str().unwrap().to_string();
        builds.push(number(&desk.event(mark, "built"), "build_ms"));
        frames.push(number(&desk.event(mark, "picture"), "gpu_ms"));
        desk.resting(0);
    }
    (median(&mut whole), median(&mut builds), median(&mut frames))
}

#[test]
fn the_window_answers_and_closes_while_a_slow_device_renders() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = Desk::open(SMALL, &["--size", "1400x1050"]);
    let slow =
        desk.wait_at_most(Duration::from_secs(60), 0, "picture", |e| e["event"] == "picture" && e["preview"] == false);
    println!("a frame takes {:.0} ms", number(&slow, "gpu_ms"));
    desk.click("", "keep rendering");
    let mut waits = Vec::new();
    for shown in [true, false, true, false, true] {
        std::thread::sleep(Duration::from_millis(300));
        let start = Instant::now();
        desk.keys(&[F1]);
        while desk.texts().iter().any(|t| t == "these keys") != shown {
            assert!(start.elapsed() < Duration::from_secs(5), "{:?}", desk.texts());
            std::thread::sleep(Duration::from_millis(2));
        }
        waits.push(start.elapsed().as_secs_f64() * 1e3);
    }
    println!("from key to help window: {waits:.0?} ms");
    assert!(waits.iter().all(|w| *w < 300.0), "{waits:?}");
    let took = desk.close();
    println!("closed in {:.2} s", took.as_secs_f64());
    assert!(took < Duration::from_secs(5), "{took:?}");
}

#[test]
fn what_was_saved_is_there_after_a_restart_and_captures_replay() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = small();
    let first = desk.first_picture();
    desk.click("", "Display");
    let mark = desk.now();
    slide(&mut desk, "exposure", 0.15);
    desk.other_picture(mark, 0, &first);
    let brighter = desk.resting(0);

    // A file that exists is not replaced by the first click.
    desk.click("", "Save");
    let before = desk.file("configs/desk.ron");
    let mark = desk.now();
    desk.click("Button", "save");
    desk.event(mark, "not saved");
    assert_eq!(desk.file("configs/desk.ron"), before);
    let mark = desk.now();
    desk.click("Button", "replace it");
    desk.event(mark, "saved");
    let saved = desk.file("configs/desk.ron");
    assert!(saved.contains("exposure") && saved.contains("\"voxel_dim\": 32") && !saved.contains("bias"), "{saved}");

    // A capture holds the picture that was on the screen, and makes it again.
    let mark = desk.now();
    desk.click("Button", "capture");
    let captured = desk.event(mark, "captured");
    assert_eq!(captured["ok"], true, "{captured}");
    let picture = image::open(desk.home.path().join("captures/desk/picture.png")).unwrap().to_rgba8();
    assert_eq!(fingerprint(&picture), brighter);
    let said = succeeds(conelab(desk.home.path()).args(["replay", "captures/desk"]));
    assert!(said.starts_with("identical"), "{said}");

    // From the gallery too; and its settings can be loaded.
    let mark = desk.now();
    desk.click("", "replay desk");
    let replayed = desk.wait_at_most(Duration::from_secs(30), mark, "a replay", |e| e["event"] == "replayed");
    assert!(replayed["text"].as_str().unwrap().contains("identical"), "{replayed}");
    let mark = desk.now();
    desk.click("", "reset exposure");
    desk.picture(mark, 0, &first);
    let mark = desk.now();
    desk.click("", "load desk");
    desk.picture(mark, 0, &brighter);
    desk.close();
    drop(desk);

    let mut again = Desk::open(&saved, &["--size", "160x120"]);
    assert_eq!(again.first_picture(), brighter, "the same picture after a restart");
    again.close();
}

#[test]
fn the_camera_follows_a_path_and_the_tabs_show_what_they_are_for() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut desk = small();
    let first = desk.first_picture();

    // A key here, another after a drag, and the scene's time moves between them.
    desk.click("", "Motion");
    desk.click("Button", "add key");
    let rect = desk.place();
    let (x, y) = centre(rect);
    let mark = desk.now();
    desk.drag((x, y), (x + 40.0, y));
    desk.other_picture(mark, 0, &first);
    let turned = desk.resting(0);
    desk.click("Button", "add key");
    let mark = desk.now();
    desk.click("", "follow");
    desk.picture(mark, 0, &first);
    let mark = desk.now();
    // '.' steps a sixtieth of a second.
    for _ in 0..3 {
        desk.keys(&[u32::from(b'.')]);
    }
    desk.other_picture(mark, 0, &first);
    assert_ne!(desk.resting(0), turned, "between the keys");
    desk.click("", "follow");
    desk.shows(&turned);

    // A click shows cones and their samples, Escape takes them away.
    let mark = desk.now();
    desk.click_at((x, y + 20.0));
    desk.other_picture(mark, 0, &turned);
    desk.texts_until("the table of samples", |texts| texts.iter().any(|t| t.contains("Cone samples")));
    desk.texts_until("rows", |texts| texts.iter().any(|t| t.contains("rows") && !t.starts_with("0 of")));
    let mark = desk.now();
    desk.keys(&[0xff1b]);
    desk.picture(mark, 0, &turned);

    desk.click("", "Time");
    desk.texts_until("the passes", |texts| texts.iter().any(|t| t.contains("shading")));
    desk.click("", "Inspect");
    desk.texts_until("statistics", |texts| texts.iter().any(|t| t == "NaN"));
    desk.close();
}
