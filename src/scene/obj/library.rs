//! Material libraries (MTL): the checked statements of each material.

use std::collections::{BTreeMap, HashSet};
use std::io::ErrorKind;
use std::path::PathBuf;

use indexmap::IndexSet;

use crate::files::read_input;

use super::lines::{decode, lines, shown, without_comment, words};
use crate::scene::phong::{Finder, Found};
use crate::scene::progress::Progress;
use crate::scene::warnings::Warnings;

/// Libraries larger than this are refused.
const MAX_BYTES: u64 = 64 << 20;
/// Maximum number of libraries per model.
const MAX_LIBRARIES: usize = 256;
/// Largest colour value: far above any lamp, and products stay finite.
const MAX_COLOR: f32 = 1e12;

const COLORS: [&str; 6] = ["ka", "kd", "ks", "ke", "tf", "specular_color"];
const NUMBERS: [&str; 13] = [
    "ns",
    "ni",
    "d",
    "tr",
    "pm",
    "pr",
    "ior",
    "illum",
    "sharpness",
    "specular",
    "alpha_cutoff",
    "two_sided",
    "normal_scale",
];
/// Maps with their names in messages.
const MAPS: [(&str, &str); 9] = [
    ("map_kd", "map_Kd"),
    ("map_d", "map_d"),
    ("map_ke", "map_Ke"),
    ("map_pr", "map_Pr"),
    ("map_pm", "map_Pm"),
    ("norm", "norm"),
    ("map_kn", "map_Kn"),
    ("map_bump", "map_Bump"),
    ("bump", "bump"),
];
/// Unsupported maps.
const OTHER_MAPS: [(&str, &str); 12] = [
    ("map_ka", "map_Ka"),
    ("map_ks", "map_Ks"),
    ("map_ns", "map_Ns"),
    ("map_ni", "map_Ni"),
    ("map_tr", "map_Tr"),
    ("map_tf", "map_Tf"),
    ("map_ps", "map_Ps"),
    ("map_disp", "map_Disp"),
    ("disp", "disp"),
    ("decal", "decal"),
    ("refl", "refl"),
    ("map_refl", "map_Refl"),
];

/// A material library, with warnings about unsupported content.
#[derive(Debug)]
pub(super) struct Library {
    pub path: PathBuf,
    pub materials: Vec<Definition>,
    pub warnings: Warnings,
}

/// The statements of a material by lower-case keyword; the last one wins.
#[derive(Debug, Default)]
pub(super) struct Definition {
    pub name: String,
    /// The name including a trailing comment, which may be a part of the name.
    pub whole: String,
    pub values: BTreeMap<String, String>,
}

/// Loads the libraries of all `mtllib` lines, each once. Missing files give warnings.
pub(super) fn load(
    entries: &IndexSet<String>,
    finder: &mut Finder,
    warnings: &mut Warnings,
    progress: Progress,
) -> Vec<Library> {
    let mut libraries = Vec::new();
    let mut seen = HashSet::new();
    for path in entries
        .iter()
        .flat_map(|entry| paths(entry, finder, warnings))
        .take(MAX_LIBRARIES)
        .collect::<Vec<_>>()
    {
        if !seen.insert(path.clone()) {
            continue;
        }
        progress.reads(&path);
        match read_input(&path, MAX_BYTES) {
            Ok(bytes) => libraries.push(read(path, &decode(bytes))),
            Err(problem) => {
                let problem = match problem.kind() {
                    ErrorKind::NotFound => "no such file".to_owned(),
                    _ => problem.to_string(),
                };
                let what = format!(
                    "material libraries cannot be read ({problem}): their materials are replaced by grey"
                );
                warnings.add(what, shown(&path.display().to_string()));
            }
        }
    }
    if entries.len() > MAX_LIBRARIES {
        warnings.add(
            format!(
                "more than {MAX_LIBRARIES} lines name material libraries: the rest is left out"
            ),
            "",
        );
    }
    libraries
}

/// The files of one `mtllib`: a name with blanks, or several names.
fn paths(entry: &str, finder: &mut Finder, warnings: &mut Warnings) -> Vec<PathBuf> {
    let names = names(entry);
    if names.len() < 2 || finder.look(entry).1 == Found::Exact {
        return vec![finder.find(entry, warnings)];
    }
    // If none exists, the argument is treated as one name.
    if names.iter().all(|name| finder.look(name).1 == Found::No) {
        return vec![finder.find(entry, warnings)];
    }
    names
        .iter()
        .map(|name| finder.find(name, warnings))
        .collect()
}

/// Words, or quoted texts.
fn names(entry: &str) -> Vec<&str> {
    let mut rest = without_comment(entry);
    let mut names = Vec::new();
    while !rest.is_empty() {
        let quoted = rest.strip_prefix('"').and_then(|text| text.split_once('"'));
        let (name, after) = quoted
            .or_else(|| rest.split_once(char::is_whitespace))
            .unwrap_or((rest, ""));
        names.push(name);
        rest = after.trim_start();
    }
    names
}

fn read(path: PathBuf, text: &str) -> Library {
    let mut library = Library {
        path,
        materials: Vec::new(),
        warnings: Warnings::default(),
    };
    let mut unnamed = Definition::default();
    for line in lines(text) {
        let (key, rest) = line.split();
        if key == "newmtl" {
            let (name, whole) = (without_comment(rest).to_owned(), rest.to_owned());
            library.materials.push(Definition {
                name,
                whole,
                values: BTreeMap::new(),
            });
            continue;
        }
        let number = line.number;
        let value = check(&key, rest, number, &mut library.warnings);
        // Statements before the first material are checked as well.
        let material = library.materials.last_mut().unwrap_or(&mut unnamed);
        if let Some(value) = value {
            material.values.insert(key.into_owned(), value);
        }
    }
    if !unnamed.values.is_empty() {
        library
            .warnings
            .add("statements before the first newmtl are left out", "");
    }
    library
}

/// The value of a statement, or `None` if it is unsupported.
fn check(key: &str, rest: &str, line: usize, warnings: &mut Warnings) -> Option<String> {
    let title = |list: &[(&str, &'static str)]| {
        list.iter()
            .find(|(k, _)| *k == key)
            .map(|(_, title)| *title)
    };
    if COLORS.contains(&key) {
        return color(key, rest, line, warnings);
    }
    if NUMBERS.contains(&key) {
        let value = words(rest)
            .find(|w| *w != "-halo")
            .and_then(|word| word.parse::<f32>().ok());
        if value.is_none_or(|value| !value.is_finite()) {
            warnings.add(
                format!("{} needs a number; the line is left out", cased(key)),
                At(line),
            );
            return None;
        }
        return value.map(|value| value.to_string());
    }
    if let Some(title) = title(&MAPS) {
        if super::maps::parse(rest).is_none() {
            warnings.add(
                format!("{title} names no file; the line is left out"),
                At(line),
            );
            return None;
        }
        return Some(rest.to_owned());
    }
    if let Some(title) = title(&OTHER_MAPS) {
        warnings.add(format!("{title} is left out"), shown(rest));
        return None;
    }
    // Most programs write 0 for sheen, clearcoat and anisotropy of the metallic-roughness
    // extension.
    let off = words(rest).all(|word| word.parse::<f32>() == Ok(0.0));
    match key {
        "pc" | "pcr" | "ps" | "aniso" | "anisor" if off => {}
        "map_aat" => {}
        _ => warnings.add(
            "lines with unknown keywords are left out",
            shown(&cased(key)),
        ),
    }
    None
}

fn color(key: &str, rest: &str, line: usize, warnings: &mut Warnings) -> Option<String> {
    let title = cased(key);
    let numbers: Option<Vec<f32>> = words(rest).take(3).map(|w| w.parse().ok()).collect();
    let list = match numbers.as_deref() {
        // A single number is a grey.
        Some([grey]) => [*grey; 3],
        Some([r, g, b]) => [*r, *g, *b],
        _ => {
            warnings.add(
                format!("{title} needs one number or three; the line is left out"),
                At(line),
            );
            return None;
        }
    };
    if !list.iter().all(|v| (0.0..=MAX_COLOR).contains(v)) {
        warnings.add(
            format!("{title} must be 0 to {MAX_COLOR:e}; the line is left out"),
            At(line),
        );
        return None;
    }
    let over = key == "kd" && list.iter().any(|v| *v > 1.0);
    if over {
        warnings.add(
            "Kd reflects more than arrives; numbers above 1 are read as 1",
            At(line),
        );
    }
    let [r, g, b] = if over { list.map(|v| v.min(1.0)) } else { list };
    Some(format!("{r} {g} {b}"))
}

/// The usual spelling of a keyword.
fn cased(key: &str) -> String {
    let capital = matches!(
        key.as_bytes(),
        [b'k' | b'n' | b'p', _, ..] | [b't', b'r' | b'f']
    ) && key.len() <= 3;
    let mut letters = key.chars();
    match letters.next() {
        Some(first) if capital => first.to_ascii_uppercase().to_string() + letters.as_str(),
        _ => key.to_owned(),
    }
}

/// A line number in a warning.
struct At(usize);

impl std::fmt::Display for At {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "line {}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_that_mean_nothing_are_left_out_with_a_warning() {
        for (line, read, kinds) in [
            ("Kd 0.5 0.25 1", Some("0.5 0.25 1"), 0),
            ("KD 0.5", Some("0.5 0.5 0.5"), 0),
            ("Ks 1 2", None, 1),
            ("Kd nan 0 0", None, 1),
            ("Ke -1 0 0", None, 1),
            ("Ke 40 40 40 # W", Some("40 40 40"), 0),
            ("Kd 1e5 0 0.5", Some("1 0 0.5"), 1),
            ("Kd spectral file.rfl", None, 1),
            ("d -halo 0.5", Some("0.5"), 0),
            ("Ns much", None, 1),
            ("map_Kd", None, 1),
            ("map_kd wall.png", Some("wall.png"), 0),
            ("map_Ks gloss.png", None, 1),
            ("Pc 0.0", None, 0),
            ("Pc 0.5", None, 1),
        ] {
            let library = super::read("a.mtl".into(), &format!("newmtl a\n\t{line}\n"));
            let values = &library.materials[0].values;
            let found = (
                values.values().next().map(String::as_str),
                library.warnings.lines("a.mtl").len(),
            );
            assert_eq!(found, (read, kinds), "{line}: {:?}", library.warnings);
        }
    }

    #[test]
    fn entries_have_several_names() {
        assert_eq!(names("a.mtl b.mtl # c"), ["a.mtl", "b.mtl"]);
        assert_eq!(names("\"a b.mtl\" c.mtl"), ["a b.mtl", "c.mtl"]);
    }
}
