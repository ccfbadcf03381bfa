//! The chart of the workbench as somebody at a desk sees it: a reference is gathered, a sweep measured beside the window,
//! and the experiment is a dot among its points.

mod common;
#[path = "common/desk.rs"]
mod desk;

use common::{conelab, succeeds};
use desk::{Desk, centre};
use serde_json::Value;
use std::time::Duration;

/// Small enough for a software device to draw several a second.
const SMALL: &str =
    r#"(graph: "vct.ron", scene: "cornell", size: (160, 120), params: { "voxel_dim": 32, "shadow_dim": 256 })"#;

/// Four points, one of them [`SMALL`].
const SWEEP: &str = r#"(experiments: ["configs/desk.ron"], warmup: 1, frames: 3,
    axes: [List(name: "voxel_dim", values: [16, 32]), List(name: "lod_offset", values: [-2, 0])])"#;

fn number(event: &Value, name: &str) -> f64 {
    event[name].as_f64().unwrap_or_else(|| panic!("no {name} in {event}"))
}

/// The error of A's picture, once it was reported after the first `since` events and `is` what was waited for.
#[track_caller]
fn error(desk: &mut Desk, since: usize, what: &str, is: impl Fn(f64) -> bool) -> f64 {
    let measured =
        desk.wait(since, what, |e| e["event"] == "error" && e["side"] == 0 && e["error"].as_f64().is_some_and(&is));
    assert!(number(&measured, "gpu_ms") > 0.0, "{measured}");
    number(&measured, "error")
}

/// Whether the picture is that of a point: one was rendered for the window, the other by another process.
fn same(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-6
}

#[test]
fn the_experiment_is_a_dot_among_those_of_a_sweep_and_a_click_on_another_goes_there() {
    let mut desk = Desk::open(SMALL, &["--size", "160x120"]);
    desk.first_picture();
    let mark = desk.now();
    desk.click("", "Chart");
    let measured = desk.event(mark, "error");
    assert!(measured["error"].is_null() && measured["why"].is_null(), "there is no reference yet: {measured}");

    // 256 samples take long on a software device: it is stopped, and what there is by then is kept.
    let mark = desk.now();
    desk.click("Button", "gather");
    desk.event(mark, "gathering");
    desk.texts_until("a reference in the making, or made", |t| t.iter().any(|t| t == "cancel" || t == "gather more"));
    if desk.texts().iter().any(|t| t == "cancel") {
        desk.click("Button", "cancel");
    }
    let gathered = desk.event(mark, "gathered");
    let samples = number(&gathered, "samples");
    assert!((32.0..=256.0).contains(&samples) && samples % 32.0 == 0.0, "{gathered}");
    let own = error(&mut desk, mark, "an error", |_| true);
    assert!(own > 0.0);

    // The sweep finds the same reference, and its points come into the chart.
    let file = desk.home.path().join("small.ron");
    std::fs::write(&file, SWEEP).unwrap();
    succeeds(conelab(desk.home.path()).arg("sweep").arg(&file));
    let mark = desk.now();
    desk.click("Button", "refresh");
    let chart =
        desk.wait(mark, "dots", |e| e["event"] == "dots" && e["dots"].as_array().is_some_and(|d| !d.is_empty()));
    let dots = chart["dots"].as_array().unwrap();
    assert_eq!(dots.len(), 4, "{chart}");
    assert_eq!(dots.iter().filter(|d| same(number(d, "error"), own)).count(), 1, "{own} in {chart}");
    assert!(dots.iter().any(|d| d["front"] == true), "{chart}");

    // The dot moves with a slider.
    desk.click("", "Tracing");
    let mark = desk.now();
    let (x, y) = centre(desk.find("Slider", "lod_offset"));
    desk.drag((x, y), (x - 20.0, y));
    error(&mut desk, mark, "another error", |e| !same(e, own));
    desk.resting(0);
    let picture = desk.events.iter().rev().find(|e| e["event"] == "picture").unwrap();
    let request = number(picture, "request");
    let last = desk.wait(mark, "the last error", |e| e["event"] == "error" && e["request"].as_f64() >= Some(request));
    let slid = number(&last, "error");
    assert!(!same(slid, own), "{slid}");

    // A click on a dot loads its experiment: the dot is there, then.
    desk.now();
    let chart = desk.events.iter().rev().find(|e| e["event"] == "dots").unwrap().clone();
    let worst =
        chart["dots"].as_array().unwrap().iter().max_by(|a, b| number(a, "error").total_cmp(&number(b, "error")));
    let worst = worst.unwrap();
    assert!(!same(number(worst, "error"), own) && !same(number(worst, "error"), slid), "{chart}");
    let at = (worst["at"][0].as_f64().unwrap(), worst["at"][1].as_f64().unwrap());
    desk.point_at(at);
    desk.texts_until("what the dot is", |texts| texts.iter().any(|t| t == "voxel_dim: 16"));
    let mark = desk.now();
    desk.click_at(at);
    let loaded = desk.event(mark, "loaded point");
    assert_eq!(loaded["id"], worst["id"], "{loaded}");
    assert_eq!(loaded["params"]["voxel_dim"], "16", "{loaded}");
    error(&mut desk, mark, "the dot's error", |e| same(e, number(worst, "error")));

    let mark = desk.now();
    desk.click("Button", "undo");
    error(&mut desk, mark, "the error before the click", |e| same(e, slid));

    // The click takes view and size along too, and one undo brings back all of it.
    desk.resting(0);
    let mark = desk.now();
    let (x, y) = centre(desk.place());
    desk.drag((x, y), (x + 60.0, y + 20.0));
    desk.wait(mark, "no reference of the view", |e| e["event"] == "error" && e["error"].is_null());
    desk.resting(0);
    let mark = desk.now();
    desk.click("Button", "as the panel");
    let large = desk.wait(mark, "a larger picture", |e| e["event"] == "picture" && e["size"][0].as_f64() > Some(160.0));
    desk.wait(mark, "no reference of it", |e| {
        e["event"] == "error" && e["error"].is_null() && e["request"].as_f64() >= large["request"].as_f64()
    });
    let before = desk.resting(0);
    std::thread::sleep(Duration::from_millis(300));
    desk.now();
    let chart = desk.events.iter().rev().find(|e| e["event"] == "dots").unwrap().clone();
    let differs = chart["differs"].as_array().unwrap();
    assert!(differs.contains(&"camera".into()) && differs.contains(&"size".into()), "{chart}");
    let dot = chart["dots"].as_array().unwrap().iter().find(|d| d["id"] == worst["id"]).unwrap();
    let mark = desk.now();
    desk.click_at((dot["at"][0].as_f64().unwrap(), dot["at"][1].as_f64().unwrap()));
    error(&mut desk, mark, "the dot's error, from its view and at its size", |e| same(e, number(worst, "error")));
    let mark = desk.now();
    desk.click("Button", "undo");
    desk.picture(mark, 0, &before);
    assert_eq!(desk.resting(0), before, "view, size and values as before");
    desk.close();
}
