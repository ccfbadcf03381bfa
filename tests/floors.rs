//! Knowledge flows one way: every module of `src/` stands on a floor, and names nothing of a floor above.

mod common;

use std::collections::BTreeSet;
use std::path::Path;

/// From the ground up; those of one floor that are named together may know each other.
const FLOORS: [&[&str]; 11] = [
    &["files", "diagnostics", "metrics"],
    &["vulkan"],
    &["scene"],
    &["shader"],
    &["graph"],
    &["experiment", "camera_path"],
    &["lab"],
    &["results"],
    &["measure"],
    &["campaign"],
    &["workbench"],
];

/// The rooms of `src/graph`, likewise: what a graph is, how it is read, linked, planned, run.
const GRAPH: [&[&str]; 9] = [
    &["expr", "interface"],
    &["param"],
    &["file"],
    &["table", "definition", "debug"],
    &["load", "evaluated"],
    &["link"],
    &["plan"],
    &["effect", "report", "outline", "signature", "debug_record"],
    &["run"],
];

/// On top of all.
const TOP: [&str; 3] = ["commands", "main", "lib"];

/// Neighbours that know nothing of each other although one floor is above the other's.
const STRANGERS: [(&str, &str); 1] = [("scene", "vulkan")];

/// Who draws with the window's library: the window, what paints it, and texts on pictures.
const DRAWS: [&str; 3] = ["workbench", "vulkan/painter.rs", "results/timers.rs"];

fn floor(room: &str) -> usize {
    let found = FLOORS.iter().position(|rooms| rooms.contains(&room));
    found.unwrap_or_else(|| {
        assert!(
            TOP.contains(&room),
            "src/{room} has no floor: add it to the table, and to docs/architecture.md"
        );
        FLOORS.len()
    })
}

/// Source files, by their path under `src/`.
fn sources(folder: &Path, under: &str, list: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = format!("{under}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            sources(&entry.path(), &format!("{name}/"), list);
        } else if name.ends_with(".rs") {
            let text = std::fs::read_to_string(entry.path()).unwrap();
            // Tests of a file may look at anything.
            let text = text
                .split("#[cfg(test)]\nmod ")
                .next()
                .unwrap_or_default()
                .to_string();
            list.push((name, text));
        }
    }
}

/// The modules of the crate that a text names, by `crate::` and its groups.
fn named(text: &str) -> BTreeSet<String> {
    let word = |s: &str| {
        s.chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect::<String>()
    };
    let code = text
        .lines()
        .filter(|l| !l.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n");
    let mut found = BTreeSet::new();
    for rest in code.split("crate::").skip(1) {
        match rest.strip_prefix('{') {
            None => drop(found.insert(word(rest))),
            Some(group) => {
                let group = group.split(';').next().unwrap_or_default();
                let mut depth = 0;
                for part in group.split_inclusive(['{', '}', ',']) {
                    if depth == 0 {
                        found.insert(word(part.trim_start()));
                    }
                    depth += part.matches('{').count() as i32 - part.matches('}').count() as i32;
                }
            }
        }
    }
    found.retain(|w| !w.is_empty());
    found
}

#[test]
fn no_module_knows_what_stands_above_it() {
    let mut list = Vec::new();
    sources(&common::root().join("src"), "", &mut list);
    assert!(list.len() > 200, "{} files", list.len());
    let mut wrong = Vec::new();
    for (file, text) in &list {
        let room = file.split('/').next().unwrap().trim_end_matches(".rs");
        for other in named(text).iter().filter(|o| o.as_str() != room) {
            // A macro or a function of the crate's root is no room.
            if !FLOORS.concat().contains(&other.as_str()) && !TOP.contains(&other.as_str()) {
                continue;
            }
            let strangers = STRANGERS
                .iter()
                .any(|(a, b)| (room, other.as_str()) == (a, b));
            if floor(other) > floor(room) || strangers {
                wrong.push(format!("src/{file} names {other}"));
            }
        }
        // Every module has a floor, also one that names no other.
        floor(room);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_room_of_the_graph_knows_what_stands_above_it() {
    let mut list = Vec::new();
    sources(&common::root().join("src/graph"), "", &mut list);
    let floor = |room: &str| GRAPH.iter().position(|rooms| rooms.contains(&room));
    let mut wrong = Vec::new();
    for (file, text) in list.iter().filter(|(file, _)| file != "mod.rs") {
        let room = file.split('/').next().unwrap().trim_end_matches(".rs");
        let own = floor(room).unwrap_or_else(|| panic!("src/graph/{room} has no floor"));
        // Of a file that stands in no folder, its parent is the graph.
        let text = if file.contains('/') {
            text.clone()
        } else {
            text.replace("super::", "crate::graph::")
        };
        for other in named(&text.replace("crate::graph::", "crate::"))
            .iter()
            .filter(|o| o.as_str() != room)
        {
            wrong.extend(
                floor(other)
                    .filter(|f| *f > own)
                    .map(|_| format!("src/graph/{file} names {other}")),
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_method_is_known_to_graphs_and_shaders_alone() {
    let mut list = Vec::new();
    for room in ["graph", "shader", "vulkan"] {
        sources(
            &common::root().join("src").join(room),
            &format!("{room}/"),
            &mut list,
        );
    }
    let lines = list
        .iter()
        .flat_map(|(file, text)| text.lines().map(move |line| (file, line.to_lowercase())));
    let code = lines.filter(|(_, line)| !line.trim_start().starts_with("//"));
    let wrong: Vec<_> = code
        .filter(|(_, line)| line.contains("voxel") || line.replace("conelab", "").contains("cone"))
        .collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Words of the methods that conelab compares with voxels, by their graphs in `passes`.
#[test]
fn no_family_of_methods_is_known_to_the_program() {
    let mut list = Vec::new();
    sources(&common::root().join("src"), "", &mut list);
    let lines = list
        .iter()
        .flat_map(|(file, text)| text.lines().map(move |line| (file, line.to_lowercase())));
    const WORDS: [&str; 11] = [
        "reflective shadow",
        "rsm",
        "propagation volume",
        "lpv",
        "spherical harmonic",
        "ddgi",
        "irradiance probe",
        "probe_r",
        "ssgi",
        "screen space",
        "bitmask",
    ];
    let is_word = |line: &str, word: &str| {
        line.match_indices(word).any(|(at, _)| {
            let before = line[..at].chars().next_back();
            !before.is_some_and(char::is_alphanumeric)
        })
    };
    let wrong: Vec<_> = lines
        .filter(|(_, line)| WORDS.iter().any(|word| is_word(line, word)))
        .collect();
    assert!(wrong.is_empty(), "{wrong:?}");
    // The graphs exist, or the test would say nothing.
    for graph in ["rsm", "lpv", "ddgi", "ssgi", "ssgi_rays"] {
        let path = common::root()
            .join("passes")
            .join(graph)
            .with_extension("ron");
        assert!(path.is_file(), "{graph}");
    }
}

#[test]
fn only_what_is_drawn_knows_the_windows_library() {
    let mut list = Vec::new();
    sources(&common::root().join("src"), "", &mut list);
    let allowed = |file: &str| DRAWS.iter().any(|d| file.starts_with(d));
    let wrong: Vec<_> = list
        .iter()
        .filter(|(f, t)| t.contains("egui") && !allowed(f))
        .map(|(f, _)| f)
        .collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// A heading as links name it: letters, digits, hyphens and underscores, in lower case, and hyphens for spaces.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase().replace(' ', "-");
    kept.chars()
        .filter(|c| c.is_alphanumeric() || ['-', '_'].contains(c))
        .collect()
}

#[test]
fn every_link_of_the_documents_leads_somewhere() {
    let root = common::root();
    let docs = std::fs::read_dir(root.join("docs"))
        .unwrap()
        .map(|e| e.unwrap().path());
    let pages: Vec<_> = docs
        .chain(
            [
                "README.md",
                "CONTRIBUTING.md",
                "CHANGELOG.md",
                "SECURITY.md",
            ]
            .map(|name| root.join(name)),
        )
        .collect();
    let (mut wrong, mut links) = (Vec::new(), 0);
    for page in pages
        .iter()
        // The site's contents name pages that are made of CONTRIBUTING.md and CHANGELOG.md.
        .filter(|p| p.extension().is_some_and(|e| e == "md") && !p.ends_with("SUMMARY.md"))
    {
        let text = std::fs::read_to_string(page).unwrap();
        for link in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split_once(')'))
            .map(|parts| parts.0)
        {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            if file.contains("://") || link.contains(' ') {
                continue;
            }
            links += 1;
            let target = if file.is_empty() {
                page.clone()
            } else {
                page.parent().unwrap().join(file)
            };
            let found = match (target.exists(), heading) {
                (there, "") => there,
                (false, _) => false,
                (true, _) => {
                    let text = std::fs::read_to_string(&target).unwrap();
                    text.lines().any(|l| {
                        l.starts_with('#') && anchor(l.trim_start_matches('#').trim()) == heading
                    })
                }
            };
            if !found {
                wrong.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(links > 100, "{links} links");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_check_sees_groups_and_paths() {
    let text =
        "use crate::{graph::{plan, run}, lab};\n// crate::window\nlet a = crate::files::read();";
    assert_eq!(
        named(text).into_iter().collect::<Vec<_>>(),
        ["files", "graph", "lab"]
    );
}
