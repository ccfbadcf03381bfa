//! docs/add-a-method.md as a reader follows it: its files in a copy of the repository's folders, its commands in order, and
//! the table that it ends with.

mod common;

use common::{conelab, root, succeeds};
use std::path::Path;

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}

/// The page's code blocks: the language, and the paragraph before each.
fn blocks(page: &str) -> Vec<(&str, &str, &str)> {
    let parts: Vec<&str> = page.split("```").collect();
    assert!(parts.len() % 2 == 1, "a block has no end");
    let pairs = parts.chunks_exact(2);
    pairs
        .map(|pair| {
            let (language, text) = pair[1].split_once('\n').unwrap();
            let before = pair[0].trim_end().rsplit("\n\n").next().unwrap();
            (language, before, text)
        })
        .collect()
}

/// The file that a paragraph names first, or last where it ends with the name.
fn file_in(paragraph: &str) -> Option<&str> {
    let names: Vec<&str> = paragraph.split('`').skip(1).step_by(2).collect();
    let is_file = |n: &&&str| n.contains('/') && n.contains('.');
    let ends = paragraph.ends_with("`:");
    if ends {
        names.last().copied()
    } else {
        names.iter().find(is_file).copied()
    }
}

#[test]
fn the_page_leads_from_an_empty_graph_to_a_row_in_a_table() {
    let page = std::fs::read_to_string(root().join("docs/add-a-method.md")).unwrap();
    let home = tempfile::tempdir().unwrap();
    for folder in ["passes", "shaders", "configs"] {
        copy(&root().join(folder), &home.path().join(folder));
    }
    let (mut files, mut commands) = (0, 0);
    for (language, before, text) in blocks(&page) {
        if language != "text" {
            let file = home.path().join(file_in(before).unwrap());
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(file, text).unwrap();
            files += 1;
            continue;
        }
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(words[0], "conelab", "{line}");
            succeeds(conelab(home.path()).args(&words[1..]));
            commands += 1;
        }
    }
    assert_eq!((files, commands), (4, 7));
    for picture in ["empty", "sky", "ambient", "openness"] {
        let made = image::open(home.path().join(picture).with_extension("png")).unwrap();
        assert_eq!((made.width(), made.height()), (320, 180), "{picture}");
        let shown = root().join("docs/add-a-method").join(picture);
        assert!(shown.with_extension("jpg").is_file(), "{picture}");
    }
    let sweep = home.path().join("captures/sweeps/ambient");
    assert!(sweep.join("report/index.html").is_file());
    // The table of the page is what was measured.
    let mut reader = csv::Reader::from_path(sweep.join("sweep.csv")).unwrap();
    let names = reader.headers().unwrap().clone();
    let column = |name: &str| names.iter().position(|n| n == name).unwrap();
    let (experiment, setting, flip) = (
        column("experiment"),
        column("occlusion"),
        column("total flip"),
    );
    let mut rows = 0;
    for record in reader.records().map(Result::unwrap) {
        let title = match (&record[experiment], &record[setting]) {
            (name, "") => name.to_string(),
            (name, "none") => format!("{name}, no occlusion"),
            (name, radius) => format!("{name}, {radius}"),
        };
        let measured: f64 = record[flip].parse().unwrap();
        let line = page
            .lines()
            .find(|l| l.starts_with(&format!("| {title} |")))
            .unwrap_or_else(|| panic!("the page has no row '{title}': FLIP {measured:.3}"));
        let said: f64 = line.split('|').nth(2).unwrap().trim().parse().unwrap();
        assert!(
            (said - measured).abs() < 0.03 * said,
            "{line} but measured {measured:.3}"
        );
        rows += 1;
    }
    assert_eq!(rows, 5);
}
