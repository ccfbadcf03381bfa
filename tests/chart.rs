//! The chart of the workbench as somebody at a screen sees it: a reference is gathered, a sweep measured at the same
//! time, and the experiment is a dot among its points.

mod common;
#[path = "common/window_driver.rs"]
mod window_driver;

use common::{conelab, succeeds};
use serde_json::Value;
use std::time::{Duration, Instant};
use window_driver::{PATIENCE, WindowDriver, centre};

/// Small enough for a software device to draw several a second, and nothing gathers over frames: a picture is one frame.
const SMALL: &str = r#"(graph: "cones.ron", scene: "cornell", size: (160, 120), params: { "voxel_dim": 32, "shadow_dim": 256, "bounces": one, "gather_frames": 1, "accumulation_rounds": 1, "cone_count": 9, "diffuse_aperture": 60, "lod_offset": 0 })"#;

/// Four points, one of them [`SMALL`].
const SWEEP: &str = r#"(experiments: ["configs/opened.ron"], warmup: 1, frames: 3,
    axes: [List(name: "voxel_dim", values: [16, 32]), List(name: "cone_count", values: [7, 9])])"#;

fn number(event: &Value, name: &str) -> f64 {
    event[name]
        .as_f64()
        .unwrap_or_else(|| panic!("no {name} in {event}"))
}

/// The error of A's picture, once it was reported after the first `since` events and `is` what was waited for.
#[track_caller]
fn error(driver: &mut WindowDriver, since: usize, what: &str, is: impl Fn(f64) -> bool) -> f64 {
    let measured = driver.wait(since, what, |e| {
        e["event"] == "error" && e["side"] == 0 && e["error"].as_f64().is_some_and(&is)
    });
    assert!(number(&measured, "gpu_ms") > 0.0, "{measured}");
    number(&measured, "error")
}

/// Clicks on a point's dot until it is loaded: the dot may move between looking and clicking. The number of events before
/// the click, and the event of the loaded point.
#[track_caller]
fn load_point(driver: &mut WindowDriver, id: &Value) -> (usize, Value) {
    let until = Instant::now() + PATIENCE;
    loop {
        let mark = driver.now();
        let chart = driver
            .events
            .iter()
            .rev()
            .find(|e| e["event"] == "dots")
            .unwrap();
        let dot = chart["dots"]
            .as_array()
            .unwrap()
            .iter()
            .find(|d| d["id"] == *id)
            .unwrap();
        driver.click_at((
            dot["at"][0].as_f64().unwrap(),
            dot["at"][1].as_f64().unwrap(),
        ));
        let clicked = Instant::now();
        while clicked.elapsed() < Duration::from_secs(2) {
            driver.now();
            if let Some(loaded) = driver.events[mark..]
                .iter()
                .find(|e| e["event"] == "loaded point")
            {
                return (mark, loaded.clone());
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        assert!(Instant::now() < until, "the point {id} was not loaded");
    }
}

/// Whether the picture is that of a point: one was rendered for the window, the other by another process.
fn same(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-6
}

#[test]
fn the_experiment_is_a_dot_among_those_of_a_sweep_and_a_click_on_another_goes_there() {
    let mut driver = WindowDriver::open(SMALL, &["--size", "160x120"]);
    driver.first_picture();
    let mark = driver.now();
    driver.grow_lower_tabs();
    driver.click("", "Chart");
    let measured = driver.event(mark, "error");
    assert!(
        measured["error"].is_null() && measured["why"].is_null(),
        "there is no reference yet: {measured}"
    );

    // 256 samples take long on a software device: it is stopped, and the blocks of 32 that there are by then are kept.
    let mark = driver.now();
    driver.click("Button", "Render reference");
    driver.event(mark, "gathering");
    driver.wait_at_most(Duration::from_secs(300), mark, "a block", |e| {
        e["event"] == "gathers" && e["samples"].as_u64().is_some_and(|n| n >= 32)
    });
    if driver.texts().iter().any(|t| t == "cancel") {
        driver.click("Button", "cancel");
    }
    let gathered = driver.wait_at_most(Duration::from_secs(300), mark, "gathered", |e| {
        e["event"] == "gathered"
    });
    let samples = number(&gathered, "samples");
    assert!(
        (32.0..=256.0).contains(&samples) && samples % 32.0 == 0.0,
        "{gathered}"
    );
    let own = error(&mut driver, mark, "an error", |_| true);
    assert!(own > 0.0);

    // The sweep finds the same reference, and its points come into the chart.
    let file = driver.home.path().join("small.ron");
    std::fs::write(&file, SWEEP).unwrap();
    succeeds(conelab(driver.home.path()).arg("sweep").arg(&file));
    let mark = driver.now();
    driver.click("Button", "refresh");
    let chart = driver.wait(mark, "dots", |e| {
        e["event"] == "dots" && e["dots"].as_array().is_some_and(|d| !d.is_empty())
    });
    let dots = chart["dots"].as_array().unwrap();
    assert_eq!(dots.len(), 4, "{chart}");
    assert_eq!(
        dots.iter()
            .filter(|d| same(number(d, "error"), own))
            .count(),
        1,
        "{own} in {chart}"
    );
    assert!(dots.iter().any(|d| d["front"] == true), "{chart}");

    // The dot moves with a slider.
    driver.click("", "Diffuse cones (2)");
    let mark = driver.now();
    let (x, y) = centre(driver.find("Slider", "cone_count"));
    driver.drag((x, y), (x - 42.0, y));
    error(&mut driver, mark, "another error", |e| !same(e, own));
    driver.resting(0);
    let picture = driver
        .events
        .iter()
        .rev()
        .find(|e| e["event"] == "picture")
        .unwrap();
    let request = number(picture, "request");
    let last = driver.wait(mark, "the last error", |e| {
        e["event"] == "error" && e["request"].as_f64() >= Some(request)
    });
    let slid = number(&last, "error");
    assert!(!same(slid, own), "{slid}");

    // A click on a dot loads its experiment: the dot is there, then.
    driver.now();
    let chart = driver
        .events
        .iter()
        .rev()
        .find(|e| e["event"] == "dots")
        .unwrap()
        .clone();
    let best = chart["dots"]
        .as_array()
        .unwrap()
        .iter()
        .min_by(|a, b| number(a, "error").total_cmp(&number(b, "error")));
    let best = best.unwrap();
    assert!(
        !same(number(best, "error"), own) && !same(number(best, "error"), slid),
        "{chart}"
    );
    let at = (
        best["at"][0].as_f64().unwrap(),
        best["at"][1].as_f64().unwrap(),
    );
    driver.point_at(at);
    driver.texts_until("what the dot is", |texts| {
        texts.iter().any(|t| t == "voxel_dim: 16")
    });
    let (mark, loaded) = load_point(&mut driver, &best["id"]);
    assert_eq!(loaded["id"], best["id"], "{loaded}");
    assert_eq!(loaded["params"]["voxel_dim"], "16", "{loaded}");
    error(&mut driver, mark, "the dot's error", |e| {
        same(e, number(best, "error"))
    });

    let mark = driver.now();
    driver.click("Button", "undo");
    error(&mut driver, mark, "the error before the click", |e| {
        same(e, slid)
    });

    // The click takes view and size along too, and one undo brings back all of it.
    driver.resting(0);
    let mark = driver.now();
    let (x, y) = centre(driver.place());
    driver.drag((x, y), (x + 60.0, y + 20.0));
    driver.wait(mark, "no reference of the view", |e| {
        e["event"] == "error" && e["error"].is_null()
    });
    driver.resting(0);
    let mark = driver.now();
    driver.click("Button", "Fit to viewport");
    let large = driver.wait(mark, "a larger picture", |e| {
        e["event"] == "picture" && e["size"][0].as_f64() > Some(160.0)
    });
    driver.wait(mark, "no reference of it", |e| {
        e["event"] == "error"
            && e["error"].is_null()
            && e["request"].as_f64() >= large["request"].as_f64()
    });
    let before = driver.resting(0);
    std::thread::sleep(Duration::from_millis(300));
    driver.now();
    let chart = driver
        .events
        .iter()
        .rev()
        .find(|e| e["event"] == "dots")
        .unwrap()
        .clone();
    let differs = chart["differs"].as_array().unwrap();
    assert!(
        differs.contains(&"camera".into()) && differs.contains(&"size".into()),
        "{chart}"
    );
    let (mark, _) = load_point(&mut driver, &best["id"]);
    error(
        &mut driver,
        mark,
        "the dot's error, from its view and at its size",
        |e| same(e, number(best, "error")),
    );
    let mark = driver.now();
    driver.click("Button", "undo");
    driver.picture(mark, 0, &before);
    assert_eq!(driver.resting(0), before, "view, size and values as before");
    driver.close();
}
