//! Text of the interface on its real ground: sizes in points, and contrast measured in screenshots of every tab.

mod common;

use common::{conelab, fails, succeeds};
use serde_json::Value;

/// Small enough for a software device, and converged after few frames.
const SMALL: [&str; 14] = [
    "--scene",
    "cornell",
    "--size",
    "160x120",
    "--set",
    "voxel_dim=32",
    "--set",
    "shadow_dim=256",
    "--set",
    "bounces=one",
    "--set",
    "gather_frames=1",
    "--set",
    "accumulation_rounds=1",
];

/// Relative luminance of a colour (WCAG 2.2).
fn luminance(rgb: [f64; 3]) -> f64 {
    let linear = |v: f64| match v / 255.0 {
        v if v <= 0.04045 => v / 12.92,
        v => ((v + 0.055) / 1.055).powf(2.4),
    };
    let [r, g, b] = rgb.map(linear);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The most frequent colour of a rectangle: its ground, because glyphs cover less.
fn ground(image: &image::RgbImage, [left, top, right, bottom]: [u32; 4]) -> [f64; 3] {
    let mut counts = std::collections::BTreeMap::new();
    for y in top..bottom.min(image.height()) {
        for x in left..right.min(image.width()) {
            *counts.entry(image.get_pixel(x, y).0).or_insert(0) += 1;
        }
    }
    let most = counts.into_iter().max_by_key(|(_, count)| *count);
    most.expect("a visible text").0.map(f64::from)
}

/// The texts of a screenshot that are hard to read, each with its contrast.
fn hard_to_read(image: &image::RgbImage, texts: &[Value]) -> Vec<String> {
    let numbers = |value: &Value| -> Vec<f64> {
        let list = value.as_array().unwrap().iter();
        list.map(|v| v.as_f64().unwrap()).collect()
    };
    let mut list = Vec::new();
    for text in texts {
        let (place, color) = (numbers(&text["place"]), numbers(&text["color"]));
        let place: Vec<u32> = place.iter().map(|v| v.max(0.0) as u32).collect();
        let under = ground(image, place.try_into().unwrap());
        let over = 1.0 - color[3] / 255.0;
        let seen = [0, 1, 2].map(|i| color[i] + over * under[i]);
        let (a, b) = (luminance(seen), luminance(under));
        let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
        let points = text["points"].as_f64().unwrap();
        if contrast < 4.5 || points < 12.0 {
            list.push(format!(
                "{}: {contrast:.2}:1, {points} points",
                text["text"]
            ));
        }
    }
    list
}

#[test]
fn every_text_of_every_tab_is_legible_in_both_themes() {
    let home = common::home();
    let views: [&[&str]; 6] = [
        &["Scene", "Profiler", "help"],
        &["Graph", "Chart", "Nodes"],
        &["Inspect", "All textures", "show voxelRadiance"],
        &["Tables", "Save", "timers"],
        &["Runs", "Motion"],
        &[
            "Compare",
            "raster | tessellated",
            "Graph",
            "find a pass, a texture",
        ],
    ];
    let mut count = 0;
    for theme in ["dark", "light"] {
        for clicks in views {
            let (shot, list) = (home.path().join("shot.png"), home.path().join("texts.json"));
            let mut command = conelab(home.path());
            command.args(["screenshot", "configs/cones.ron", "--window", "1600x900"]);
            command.args(SMALL).args(["--theme", theme]);
            for click in clicks {
                command.args(["--click", click]);
            }
            succeeds(command.arg("--texts").arg(&list).arg("-o").arg(&shot));
            let texts: Vec<Value> = serde_json::from_slice(&std::fs::read(&list).unwrap()).unwrap();
            count += texts.len();
            // A screenshot is taken once the picture has converged.
            let is_picture = !["Graph", "Inspect", "Runs"].contains(&clicks[0]);
            let converged = texts.iter().any(|text| text["text"] == "converged");
            assert!(converged || !is_picture, "{clicks:?}: {texts:#?}");
            let image = image::open(&shot).unwrap().to_rgb8();
            let hard = hard_to_read(&image, &texts);
            assert!(hard.is_empty(), "{theme}, {clicks:?}:\n{}", hard.join("\n"));
        }
    }
    assert!(count > 500, "only {count} texts were measured");
}

/// A picture that cannot be made is shown as the window shows it, and the command says why.
#[test]
fn errors_are_legible_and_fail_the_command() {
    let home = common::home();
    for theme in ["dark", "light"] {
        let (shot, list) = (home.path().join("shot.png"), home.path().join("texts.json"));
        let mut command = conelab(home.path());
        command
            .args(["screenshot", "configs/cones.ron"])
            .args(SMALL);
        command.args(["--set", "shadow_filter=1000", "--theme", theme, "--texts"]);
        let said = fails(command.arg(&list).arg("-o").arg(&shot));
        assert!(said.contains("'shadow_filter' has no option"), "{said}");
        let texts: Vec<Value> = serde_json::from_slice(&std::fs::read(&list).unwrap()).unwrap();
        let of_error = |text: &Value| {
            text["text"]
                .to_string()
                .contains("'shadow_filter' has no option")
        };
        assert!(texts.iter().any(of_error), "{texts:#?}");
        let image = image::open(&shot).unwrap().to_rgb8();
        assert_eq!(hard_to_read(&image, &texts), Vec::<String>::new());
    }
}

/// The measure itself: text of the ground's colour is found, whatever the theme says.
#[test]
fn grey_on_grey_is_found() {
    let image = image::RgbImage::from_pixel(40, 20, image::Rgb([40, 40, 40]));
    let text = |grey: u8, points: f32| {
        serde_json::json!({ "text": "x", "points": points, "color": [grey, grey, grey, 255],
            "place": [2.0, 2.0, 30.0, 16.0] })
    };
    assert_eq!(hard_to_read(&image, &[text(100, 14.0)]).len(), 1);
    assert_eq!(hard_to_read(&image, &[text(230, 11.0)]).len(), 1);
    assert_eq!(hard_to_read(&image, &[text(230, 14.0)]).len(), 0);
}

/// A label may name a widget below the visible part of a list: it is scrolled into view and clicked there.
#[test]
fn a_click_on_a_label_reaches_a_widget_that_is_scrolled_away() {
    let home = common::home();
    let (shot, list) = (home.path().join("shot.png"), home.path().join("texts.json"));
    let texts = |(scale, window): (&str, &str), clicks: &[&str]| -> Vec<String> {
        let mut command = conelab(home.path());
        command.args(["screenshot", "configs/cones.ron", "--window", window]);
        command.args(SMALL).args(["--scale", scale]);
        for click in clicks {
            command.args(["--click", click]);
        }
        succeeds(command.arg("--texts").arg(&list).arg("-o").arg(&shot));
        let texts: Vec<Value> = serde_json::from_slice(&std::fs::read(&list).unwrap()).unwrap();
        let text = |text: &Value| text["text"].as_str().unwrap().to_string();
        texts.iter().map(text).collect()
    };
    let group = |texts: &[String]| texts.iter().any(|t| t.starts_with("Display"));
    let inside = |texts: &[String]| texts.iter().any(|t| t == "voxel_view_cascade");
    for screen in [("1", "1600x500"), ("2", "2400x1000")] {
        let before = texts(screen, &[]);
        assert!(!group(&before) && !inside(&before), "{before:?}");
        let after = texts(screen, &["Display"]);
        assert!(group(&after) && inside(&after), "{after:?}");
    }
}
