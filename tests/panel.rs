//! What somebody at the window finds first: the panel of parameters, scenes that cannot be loaded, saving, the picture's
//! size on the screen.

mod common;
#[path = "common/window_driver.rs"]
mod window_driver;

use std::time::Duration;
use window_driver::{CONTROL, PATIENCE, WindowDriver, centre, with};

/// Cones in every pixel, so that the pinned parameters count; small enough for a software device.
const CONES: &str = r#"(graph: "cones.ron", scene: "cornell", size: (160, 120), params: { "voxel_dim": 32, "shadow_dim": 256, "bounces": one, "gather_frames": 1, "accumulation_rounds": 1, "cone_count": 3, "emitter_rays": 0, "lod_offset": 0 })"#;

const ESCAPE: u32 = 0xff1b;
const F12: u32 = 0xffc9;
const HOME: u32 = 0xff50;
const RETURN: u32 = 0xff0d;

fn small() -> WindowDriver {
    WindowDriver::open(CONES, &["--size", "160x120"])
}

fn has(texts: &[String], text: &str) -> bool {
    texts.iter().any(|t| t == text)
}

#[test]
fn the_panel_begins_with_what_the_graph_pins_and_finds_names_however_they_are_written() {
    let mut driver = small();
    let first = driver.first_picture();
    let titles = [
        "Cone count",
        "Aperture",
        "Steps",
        "Bias",
        "LOD offset",
        "Warp",
        "Warp alpha",
    ];
    let tops: Vec<f64> = titles
        .iter()
        .map(|title| driver.find("Label", title)[1])
        .collect();
    assert!(tops.is_sorted(), "{tops:?}");
    driver.texts_until("the aperture that the graph chooses", |texts| {
        has(texts, "Aperture, auto (6 deg)")
    });
    let group = driver.find("", "Tracing (4)");

    for typed in ["lod offset", "lodoffset"] {
        driver.keys(&[CONTROL, u32::from(b'f')]);
        driver.text(typed);
        driver.texts_until("what was searched for", |texts| {
            has(texts, "lod_offset") && !has(texts, "exposure")
        });
        driver.keys(&[ESCAPE]);
        driver.texts_until("the groups as they were", |texts| {
            has(texts, "Cone count") && !has(texts, "lod_offset")
        });
    }
    assert_eq!(
        driver.find("", "Tracing (4)"),
        group,
        "the panel is as wide as it was, its groups folded"
    );

    // A drag takes the keys from the search: undo is of the parameter.
    driver.keys(&[CONTROL, u32::from(b'f')]);
    driver.text("lod");
    let rect = driver.find("Slider", "lod_offset");
    let (x, y) = centre(rect);
    let mark = driver.now();
    driver.drag((x, y), (x - 0.3 * (rect[2] - rect[0]), y));
    driver.other_picture(mark, 0, &first);
    driver.resting(0);
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'z')]);
    driver.picture(mark, 0, &first);
    driver.keys(&[CONTROL, u32::from(b'f')]);
    driver.text("zzz");
    driver.texts_until("that nothing matches", |texts| {
        has(texts, "Nothing matches")
    });
    driver.click("Button", "clear the search");
    driver.texts_until("everything", |texts| has(texts, "Cone count"));

    // What another graph has is a click away.
    let mark = driver.now();
    driver.keys(&[CONTROL, u32::from(b'f')]);
    driver.text("volume_turn");
    driver.click("Button", "use warps.ron for volume_turn");
    driver.wait(mark, "the other graph", |e| {
        e["event"] == "built" && e["side"] == 0
    });
    driver.texts_until("its parameters", |texts| {
        !has(texts, "use warps.ron for volume_turn")
    });
    driver.close();
}

#[test]
fn a_scene_that_cannot_be_loaded_leaves_everything_as_it_was() {
    let mut driver = small();
    let first = driver.first_picture();
    driver.write(
        "configs/scenes/broken.ron",
        "(models: [(file: \"broken.obj\")])",
    );
    driver.write("configs/scenes/broken.obj", "f 1 2 3\n");
    let mark = driver.now();
    driver.click("", "scene: cornell");
    driver.click("", "broken");
    driver.event(mark, "load failed");
    driver.texts_until("the scene that is shown", |texts| {
        has(texts, "scene: cornell")
    });
    assert!(
        !has(&driver.texts(), "Restart device"),
        "no device is at fault"
    );
    assert_eq!(driver.resting(0), first);

    // A capture and an experiment name the scene that they show.
    let mark = driver.now();
    driver.keys(&[F12]);
    let captured = driver.wait_at_most(PATIENCE, mark, "a capture", |e| e["event"] == "captured");
    assert_eq!(captured["ok"], true, "{captured}");
    assert!(
        driver
            .file("captures/opened/experiment.ron")
            .contains("\"cornell\"")
    );

    // Undo does not lead to the scene that failed.
    driver.click("", "Display");
    let rect = driver.find("Slider", "exposure");
    let (x, y) = centre(rect);
    let mark = driver.now();
    driver.drag((x, y), (x + 0.15 * (rect[2] - rect[0]), y));
    driver.other_picture(mark, 0, &first);
    driver.resting(0);
    let mark = driver.now();
    for _ in 0..3 {
        driver.keys(&[CONTROL, u32::from(b'z')]);
        std::thread::sleep(Duration::from_millis(100));
    }
    driver.picture(mark, 0, &first);
    std::thread::sleep(Duration::from_millis(300));
    driver.now();
    assert!(
        driver.events[mark..]
            .iter()
            .all(|e| e["event"] != "load failed" && e["event"] != "loaded")
    );
    driver.close();
}

#[test]
fn the_window_says_what_is_wrong_with_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("one.obj");
    std::fs::write(
        &model,
        "mtllib one.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    std::fs::write(folder.path().join("one.mtl"), "newmtl a\nmap_Kd gone.png\n").unwrap();
    let mut driver = WindowDriver::open(
        CONES,
        &["--size", "160x120", "--scene", model.to_str().unwrap()],
    );
    let loaded = driver.event(0, "loaded");
    assert!(
        loaded["warnings"].to_string().contains("gone.png"),
        "{loaded}"
    );
    driver.texts_until("the warning", |texts| {
        texts
            .iter()
            .any(|t| t.starts_with("scene: ") && t.contains("gone.png"))
            && has(texts, "Warnings (1)")
    });
    // Beside the scene's name on every tab; a click shows the list.
    driver.click("", "Graph");
    driver.texts_until("another tab", |texts| !has(texts, "Warnings (1)"));
    driver.click("Button", "warnings: 1");
    driver.texts_until("the list", |texts| has(texts, "Warnings (1)"));
    driver.close();
    drop(driver);

    let mut driver = WindowDriver::open(CONES, &["--size", "160x120", "--scene", "gone.obj"]);
    driver.event(0, "load failed");
    driver.texts_until("that there is no scene", |texts| {
        has(texts, "No scene") && has(texts, "scene: none")
    });
    let mark = driver.now();
    driver.click("", "scene: none");
    driver.click("", "cornell");
    driver.event(mark, "loaded");
    driver.first_picture();
    driver.close();
}

#[test]
fn saving_says_beside_the_field_what_became_of_it() {
    let mut driver = small();
    driver.first_picture();
    // Where somebody clicked is no part of an experiment.
    let (x, y) = centre(driver.place());
    let mark = driver.now();
    driver.click_at((x, y + 40.0));
    driver.event(mark, "picture");
    driver.click("", "Save");
    let name = |driver: &mut WindowDriver, typed: &str| {
        driver.click("", "experiment name");
        driver.keys(&[CONTROL, u32::from(b'a')]);
        driver.text(typed);
    };
    name(&mut driver, "../x");
    let mark = driver.now();
    driver.click("Button", "save");
    let why = driver.event(mark, "not saved")["why"]
        .as_str()
        .unwrap()
        .to_string();
    let field = driver.find("", "experiment name");
    let said = driver
        .widget(|w| w["label"] == why.as_str() && w["rect"][0].as_f64() > Some(field[0] - 20.0));
    assert!(said[1] - field[3] < 30.0, "{said:?} stands below {field:?}");

    name(&mut driver, "con fig");
    let mark = driver.now();
    driver.click("Button", "save");
    driver.event(mark, "saved");
    let saved = driver.file("configs/con-fig.ron");
    assert!(
        saved.contains("\"bounces\"") && !saved.contains("probe"),
        "{saved}"
    );
    driver.texts_until("the corrected name", |texts| {
        has(texts, "experiment: con-fig")
            && texts
                .iter()
                .any(|t| t.starts_with("saved ") && t.ends_with("con-fig.ron"))
    });
    driver.close();
}

#[test]
fn a_sequence_says_how_far_it_is_and_can_be_stopped() {
    let mut driver = small();
    driver.first_picture();
    driver.click("", "Motion");
    let mark = driver.now();
    driver.click("Button", "render");
    driver.event(mark, "sequence begun");
    driver.texts_until("progress", |texts| has(texts, "cancel"));
    let first = driver.home.path().join("captures/sequence/frame-00000.png");
    let until = std::time::Instant::now() + PATIENCE;
    while !first.is_file() && std::time::Instant::now() < until {
        std::thread::sleep(Duration::from_millis(50));
    }
    driver.click("Button", "cancel");
    let ended = driver.event(mark, "sequence");
    assert!(
        ended["text"]
            .as_str()
            .unwrap()
            .starts_with("cancelled after "),
        "{ended}"
    );

    // Its folder has frames now: that is said beside the button.
    let mark = driver.now();
    driver.click("Button", "render");
    let ended = driver.event(mark, "sequence");
    assert_eq!(ended["ok"], false, "{ended}");
    driver.close();
}

#[test]
fn a_place_in_a_message_opens_the_editor() {
    let editor = [("CONELAB_EDITOR", "./editor {file} opened-{line}")];
    let mut driver = WindowDriver::open_with(CONES, &["--size", "160x120"], &editor);
    let first = driver.first_picture();
    let place = driver.place();
    let display = driver.file("shaders/display/display.comp");
    let mark = driver.now();
    driver.rename_into(
        "shaders/display/display.comp",
        &with(&display, "params.exposure", "params.exposre"),
    );
    let failed = driver.event(mark, "failed");
    assert!(
        failed["errors"]
            .to_string()
            .contains("did you mean 'exposure'?"),
        "{failed}"
    );
    let label = |t: &&String| t.contains("display.comp:") && t.contains("exposre");
    driver.texts_until("the message", |texts| texts.iter().any(|t| label(&t)));
    assert_eq!(driver.place(), place, "the picture stays where it is");
    let text = driver.texts().iter().find(label).unwrap().clone();
    assert!(text.starts_with("shaders/display/display.comp:"), "{text}");
    // A program that cannot be started is a message, not a note at the window's edge.
    let mark = driver.now();
    let rect = driver.find("", &text);
    driver.click_at((rect[0] + 40.0, rect[1] + 6.0));
    driver.event(mark, "editor");
    let warned = |t: &String| t.starts_with("cannot start the editor './editor'");
    driver.texts_until("the warning", |texts| texts.iter().any(warned));
    driver.click("Button", "dismiss");
    driver.texts_until("no warning", |texts| !texts.iter().any(warned));
    let script = driver.home.path().join("editor");
    std::os::unix::fs::symlink("/bin/cp", script).unwrap();
    let mark = driver.now();
    let rect = driver.find("", &text);
    driver.click_at((rect[0] + 40.0, rect[1] + 6.0));
    driver.event(mark, "editor");
    let line = 1 + display
        .lines()
        .position(|l| l.contains("params.exposure"))
        .unwrap();
    let until = std::time::Instant::now() + PATIENCE;
    while !driver.home.path().join(format!("opened-{line}")).is_file() {
        assert!(std::time::Instant::now() < until, "no editor was started");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(driver.pictures(0).last(), Some(&first));
    let failures = driver
        .events
        .iter()
        .filter(|e| e["event"] == "failed")
        .count();
    assert_eq!(
        failures, 1,
        "the message does not change the picture's size"
    );
    driver.close();
}

#[test]
fn the_picture_is_zoomed_into_and_the_panels_make_room_for_it() {
    let mut driver = small();
    let first = driver.first_picture();
    let whole = driver.place();
    let at = centre(whole);
    driver.point_at(at);
    driver.texts_until("a picture", |texts| has(texts, "Cone count"));
    driver.wheel(at, 3, &[CONTROL]);
    let width = |r: [f64; 4]| r[2] - r[0];
    let mark = driver.now();
    driver.wait_place("a larger picture", |place| {
        width(place) > 1.2 * width(whole)
    });
    driver.keys(&[HOME]);
    driver.wait_place("the whole picture", |place| place == whole);
    driver.keys(&[u32::from(b'h')]);
    driver.texts_until("no panels", |texts| {
        !has(texts, "Cone count") && !has(texts, "Motion")
    });
    driver.keys(&[u32::from(b'h')]);
    driver.texts_until("panels", |texts| {
        has(texts, "Cone count") && has(texts, "Motion")
    });
    assert!(
        driver.events[mark..]
            .iter()
            .all(|e| e["event"] != "picture" || e["fingerprint"] == first.as_str())
    );
    driver.close();
}

#[test]
fn a_window_of_large_points_fits_its_screen() {
    let scale = [("WINIT_X11_SCALE_FACTOR", "2")];
    let mut driver = WindowDriver::open_with(CONES, &["--size", "160x120"], &scale);
    driver.first_picture();
    let (width, height) = driver.size();
    assert!(
        width <= 1400 && height <= 900,
        "{width}x{height} on a screen of 1400x900"
    );
    driver.close();
}

/// A picture of the sky gives the light that it has, whatever was edited before it came.
#[test]
fn a_new_sky_keeps_its_own_tint() {
    let open = || {
        WindowDriver::open(
            &CONES.replace("cornell", "white-sky"),
            &["--size", "160x120"],
        )
    };
    let sky = |driver: &mut WindowDriver| {
        let texels = image::Rgb32FImage::from_pixel(8, 4, image::Rgb([0.2, 0.4, 0.6]));
        texels.save(driver.home.path().join("own.hdr")).unwrap();
        driver.click("", "Scene");
        let tab = centre(driver.find("", "Camera"));
        driver.scroll_down((tab.0, tab.1 + 60.0));
        driver.click("TextInput", "picture of the sky");
        driver.text("own.hdr");
        let mark = driver.now();
        driver.keys(&[RETURN]);
        driver.event(mark, "loaded");
        driver.texts_until("the picture's name", |texts| {
            texts.iter().any(|t| t.contains("own.hdr"))
        });
        driver.resting(0)
    };
    let expected = {
        let mut driver = open();
        driver.first_picture();
        sky(&mut driver)
    };
    let mut driver = open();
    let white = driver.first_picture();
    driver.click("", "Scene");
    let (x, y) = centre(driver.find("SpinButton", "sky intensity"));
    let mark = driver.now();
    driver.drag((x, y), (x + 60.0, y));
    driver.other_picture(mark, 0, &white);
    driver.find("Button", "reset lights");
    assert_eq!(
        sky(&mut driver),
        expected,
        "the sky is lit as if nothing had been edited"
    );
    driver.close();
}

/// Frames from before a comparison are no part of its times: both sides have rendered the same frames, of which the rows
/// of the table are means that add up to the total.
#[test]
fn a_and_b_are_timed_over_the_same_frames() {
    let mut driver = small();
    let first = driver.first_picture();
    driver.click("", "Display");
    for by in [0.1, -0.1] {
        let rect = driver.find("Slider", "exposure");
        let (x, y) = centre(rect);
        let mark = driver.now();
        driver.drag((x, y), (x + by * (rect[2] - rect[0]), y));
        driver.wait(mark, "a picture", |e| {
            e["event"] == "picture" && e["side"] == 0
        });
    }
    driver.resting(0);
    let mark = driver.now();
    driver.click("", "Compare");
    driver.click("", "raster | tessellated");
    driver.other_picture(mark, 1, &first);
    driver.resting(1);
    driver.resting(0);
    driver.click("", "Profiler");
    let rows = exported(&mut driver, "Export CSV");
    let mut reader = csv::Reader::from_reader(rows.as_bytes());
    assert_eq!(&reader.headers().unwrap()[5], "between passes");
    let mut frames: [Vec<u64>; 2] = Default::default();
    for row in reader.records().map(Result::unwrap) {
        frames[usize::from(&row[0] == "B")].push(row[1].parse().unwrap());
        let number = |i: usize| row[i].parse::<f64>().unwrap_or(0.0);
        let parts: f64 = (5..row.len()).map(number).sum();
        assert!(
            (parts - number(4)).abs() <= 1e-6 * number(4),
            "rows take {parts} ms of {} ms: {row:?}",
            number(4)
        );
    }
    assert!(!frames[0].is_empty());
    assert_eq!(frames[0].len(), frames[1].len(), "{frames:?}");
    let trace: serde_json::Value =
        serde_json::from_str(&exported(&mut driver, "Export trace")).unwrap();
    trace_is_ordered(&trace, frames[0].len());
    driver.close();
}

/// A frozen profiler keeps its frames while the picture goes on. A click on a frame holds it.
#[test]
fn frames_are_frozen_and_held() {
    let mut driver = small();
    let first = driver.first_picture();
    driver.resting(0);
    driver.click("", "Profiler");
    driver.click("", "Freeze");
    let frozen = exported(&mut driver, "Export CSV");
    driver.click("", "Display");
    let rect = driver.find("Slider", "exposure");
    let (x, y) = centre(rect);
    let mark = driver.now();
    driver.drag((x, y), (x + 0.2 * (rect[2] - rect[0]), y));
    driver.other_picture(mark, 0, &first);
    driver.resting(0);
    assert_eq!(exported(&mut driver, "Export CSV"), frozen);
    driver.click("", "Freeze");
    let all = exported(&mut driver, "Export CSV");
    assert!(all.lines().count() > frozen.lines().count(), "{all}");

    // The newest frame is at the right edge of the bars.
    let chart = driver.find("", "A, frames");
    let (_, y) = centre(chart);
    driver.click_at((chart[0] + 0.72 * (chart[2] - chart[0]), y));
    let held = |t: &String| t.starts_with("frame ") && t.ends_with(" is held, ms");
    driver.texts_until("the held frame", |texts| texts.iter().any(held));
    driver.click("", "Show means");
    driver.texts_until("means", |texts| {
        texts.iter().any(|t| t.starts_with("last "))
    });

    // The driver's statistics, or why there are none.
    driver.grow_lower_tabs();
    let mark = driver.now();
    driver.click("Button", "shadow map");
    driver.click("Button", "Pipeline statistics");
    driver.event(mark, "pipeline statistics");
    driver.close();
}

/// The text of the file that a button of the profiler writes.
fn exported(driver: &mut WindowDriver, button: &str) -> String {
    let mark = driver.now();
    driver.click("Button", button);
    let exported = driver.event(mark, "exported");
    assert_eq!(exported["ok"], true, "{exported}");
    let text = exported["text"].as_str().unwrap();
    driver.file(text.trim_start_matches("wrote "))
}

/// Passes are inside their frames. The GPU begins a frame after its recording began and ends it
/// before the CPU has waited for it, within the uncertainty of the clocks.
fn trace_is_ordered(trace: &serde_json::Value, frames: usize) {
    let data = &trace["otherData"];
    let error = data["gpu_uncertainty_us"].as_f64();
    println!(
        "calibrated {}, uncertainty {error:?} us",
        data["calibrated"]
    );
    let events = trace["traceEvents"].as_array().unwrap();
    let spans = |track: u64| {
        let of = events
            .iter()
            .filter(move |e| e["ph"] == "X" && e["tid"] == track);
        of.map(|e| {
            let (start, length) = (e["ts"].as_f64().unwrap(), e["dur"].as_f64().unwrap());
            (e["name"].as_str().unwrap(), start, start + length)
        })
    };
    let cpu = |name: &str| spans(3).find(|s| s.0 == name).unwrap();
    for (track, side) in [(1, "A "), (2, "B ")] {
        let whole: Vec<_> = spans(track).filter(|s| s.0.starts_with(side)).collect();
        assert_eq!(whole.len(), frames);
        let mut last = None;
        for (name, start, end) in spans(track) {
            if name.starts_with(side) {
                last = Some((start, end));
                let Some(error) = error else { continue };
                let (recorded, waited) =
                    (cpu(&format!("record {name}")), cpu(&format!("wait {name}")));
                // Clocks may drift by a tenth of a per mille between their readings.
                let slack = error + 20.0;
                assert!(start >= recorded.1 - slack, "{name}: {start} {recorded:?}");
                assert!(end <= waited.2 + slack, "{name}: {end} {waited:?}");
            } else {
                let frame = last.unwrap();
                assert!(
                    start >= frame.0 && end <= frame.1 + 0.01,
                    "{name} {frame:?}"
                );
            }
        }
    }
}

/// The time of a path stops at its last key, and Enter saves the path under the name that the field then shows.
#[test]
fn a_path_stops_at_its_last_key_and_is_saved_by_enter() {
    let mut driver = small();
    let first = driver.first_picture();
    driver.grow_lower_tabs();
    driver.click("", "Motion");
    driver.click("Button", "add key");
    let (x, y) = centre(driver.place());
    let mark = driver.now();
    driver.drag((x, y), (x + 40.0, y));
    driver.other_picture(mark, 0, &first);
    driver.click("Button", "add key");
    driver.click("", "follow");
    driver.resting(0);
    let mark = driver.now();
    driver.click("Button", "play path");
    driver.wait(mark, "a picture between the keys", |e| {
        let time = e["time"].as_f64().unwrap_or(0.0);
        e["event"] == "picture" && time > 0.0 && time < 1.0
    });
    driver.wait(mark, "the picture at the last key", |e| {
        e["event"] == "picture" && e["time"] == 1.0
    });
    driver.texts_until("that it stands", |texts| has(texts, "play path"));
    driver.resting(0);
    let mut times = driver.events.iter().filter(|e| e["event"] == "picture");
    assert_eq!(times.next_back().unwrap()["time"], 1.0);

    driver.click("TextInput", "path name");
    driver.text(" b");
    let mark = driver.now();
    driver.keys(&[RETURN]);
    let saved = driver.event(mark, "saved")["path"].clone();
    let saved = saved.as_str().unwrap();
    assert!(saved.contains('-') && saved.ends_with(".ron"), "{saved}");
    driver.texts_until("where it was saved", |texts| {
        has(texts, &format!("saved {saved}"))
    });
    let name = saved.rsplit('/').next().unwrap().trim_end_matches(".ron");
    driver.widget(|w| w["label"] == "path name" && w["value"] == name);
    driver.close();
}

/// A scene file without its model is greyed out in the menu, and its tooltip names the missing file.
#[test]
fn a_scene_without_its_model_cannot_be_chosen() {
    let mut driver = small();
    driver.first_picture();
    driver.write(
        "configs/scenes/absent.ron",
        "(models: [(file: \"nowhere/absent.obj\")])",
    );
    driver.click("", "scene: cornell");
    let at = centre(driver.find("Button", "absent"));
    driver.point_at(at);
    driver.texts_until("the missing file", |texts| {
        texts
            .iter()
            .any(|t| t.starts_with("model 'nowhere/absent.obj' not found; looked in: "))
    });
    let mark = driver.now();
    driver.click_at(at);
    std::thread::sleep(Duration::from_millis(500));
    driver.now();
    let reads = |e: &&serde_json::Value| e["event"] == "loaded" || e["event"] == "load failed";
    assert_eq!(driver.events[mark..].iter().find(reads), None);
    driver.close();
}

/// While a view of voxels is shown, the mip of *Inspect* is that of the view.
#[test]
fn the_inspected_mip_is_that_of_the_voxel_view() {
    let mut driver = WindowDriver::open(CONES, &["--size", "160x120", "--set", "mips=isotropic"]);
    let first = driver.first_picture();
    driver.click("", "Inspect");
    driver.click("ComboBox", "texture radiance");
    let is_volume = |w: &serde_json::Value| {
        w["role"] == "Button"
            && w["label"]
                .as_str()
                .is_some_and(|l| l.starts_with("voxelRadiance"))
    };
    let at = centre(driver.widget(is_volume));
    driver.click_at(at);
    let mark = driver.now();
    driver.click("Button", "voxels: radiance");
    driver.other_picture(mark, 0, &first);
    let finest = driver.resting(0);
    let mark = driver.now();
    let [left, top, right, bottom] = driver.find("Slider", "mip");
    driver.click_at((left + 0.3 * (right - left), (top + bottom) / 2.0));
    driver.other_picture(mark, 0, &finest);
    let coarse = driver.resting(0);
    assert_ne!(coarse, finest);
    // The other way: the parameter moves the slider.
    driver.click("", "search parameters");
    driver.text("voxel_view_mip");
    driver.click("Button", "reset voxel_view_mip");
    let slider =
        |w: &serde_json::Value| w["role"] == "Slider" && w["label"] == "mip" && w["value"] == 0.0;
    driver.widget(slider);
    assert_eq!(driver.resting(0), finest);
    driver.close();
}

/// The texts of a screenshot after clicks, in JSON. Settings without accumulation: pictures rest between the clicks.
fn texts_after(clicks: &[&str]) -> String {
    let home = common::home();
    let (shot, list) = (home.path().join("shot.png"), home.path().join("texts.json"));
    let mut command = common::conelab(home.path());
    command.args(["screenshot", "configs/thesis.ron", "--scene", "cornell"]);
    command.args(["--size", "96x72", "--window", "1000x700"]);
    command.args(["--set", "voxel_dim=32", "--set", "shadow_dim=256"]);
    for click in clicks {
        command.args(["--click", click]);
    }
    common::succeeds(command.arg("--texts").arg(&list).arg("-o").arg(&shot));
    std::fs::read_to_string(&list).unwrap()
}

/// A driven window wants each picture in main memory, where comparisons are made; a window of its own does not.
#[test]
fn pictures_at_rest_are_compared() {
    let texts = texts_after(&["A | B", "FLIP error"]);
    assert!(texts.contains("mean FLIP 0.0000"), "{texts}");
}

/// A screenshot shows what its clicks lead to: the capture is in the list, and its replay has an answer.
#[test]
fn a_capture_is_replayed_in_a_screenshot() {
    let texts = texts_after(&["capture now", "Save", "replay"]);
    assert!(texts.contains("identical"), "{texts}");
}

/// The pane *Texture* needs no visit of *Inspect* before.
#[test]
fn the_texture_pane_begins_with_the_picture() {
    let texts = texts_after(&["Texture"]);
    assert!(texts.contains("A radiance  mip 0"), "{texts}");
}
