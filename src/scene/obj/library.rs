//! Material libraries (MTL): the lines that cannot mean anything are left out before they are parsed, and told.

use std::cell::RefCell;
use std::io::Cursor;
use std::path::Path;

use crate::files::read_input;

/// Libraries larger than this are refused.
const MAX_BYTES: u64 = 64 << 20;
/// Largest part of a colour: far above what any lamp emits, and products of it are finite.
const MAX_COLOR: f32 = 1e12;
/// Lines of a library that are told one by one.
const MAX_TOLD: usize = 8;

const COLORS: [&str; 5] = ["Ka", "Kd", "Ks", "Ke", "Tf"];
const NUMBERS: [&str; 8] = ["Ns", "Ni", "d", "Tr", "Pm", "Pr", "ior", "illum"];
const MAPS: [&str; 10] =
    ["map_Ka", "map_Kd", "map_Ks", "map_Ns", "map_ns", "map_NS", "map_Bump", "map_bump", "bump", "map_d"];

type Library = (Vec<tobj::Material>, <tobj::MTLLoadResult as Parts>::Map);

/// Names the map type inside `tobj::MTLLoadResult`, which depends on that crate's features.
pub(super) trait Parts {
    type Map;
}
impl<M, T, E> Parts for Result<(Vec<T>, M), E> {
    type Map = M;
}

/// The materials of what stands after `mtllib`: one file whose name may have spaces, or several names.
pub(super) fn load(folder: &Path, names: &Path, warnings: &RefCell<Vec<String>>) -> Library {
    let names = names.to_string_lossy().replace('\\', "/");
    let mut warnings = warnings.borrow_mut();
    let words: Vec<&str> = names.split_whitespace().collect();
    if words.len() < 2 || folder.join(&names).is_file() {
        return load_one(&folder.join(&names), &mut warnings);
    }
    let mut all = Library::default();
    for word in words {
        let (materials, index) = load_one(&folder.join(word), &mut warnings);
        // A material that two libraries have is that of the first.
        for (name, i) in index {
            all.1.entry(name).or_insert(i + all.0.len());
        }
        all.0.extend(materials);
    }
    all
}

fn load_one(path: &Path, warnings: &mut Vec<String>) -> Library {
    let read = read_input(path, MAX_BYTES).map_err(|e| e.to_string()).and_then(|bytes| {
        let text = readable(&String::from_utf8_lossy(&bytes), path, warnings);
        tobj::load_mtl_buf(&mut Cursor::new(text.as_bytes())).map_err(|e| e.to_string())
    });
    read.unwrap_or_else(|problem| {
        let path = path.display();
        warnings.push(format!("material library {path}: {problem}; grey materials stand in for its own"));
        Library::default()
    })
}

/// The text with colours written out as three numbers, and without the lines that are wrong.
fn readable(text: &str, path: &Path, warnings: &mut Vec<String>) -> String {
    let mut out = String::with_capacity(text.len());
    let mut wrong = 0;
    for (number, line) in text.lines().enumerate() {
        let (line, problem) = checked(line);
        if let Some(problem) = problem {
            wrong += 1;
            if wrong <= MAX_TOLD {
                warnings.push(format!("{}:{}: {problem}", path.display(), number + 1));
            }
        }
        out.push_str(&line);
        out.push('\n');
    }
    if wrong > MAX_TOLD {
        warnings.push(format!("{}: {} more lines like these", path.display(), wrong - MAX_TOLD));
    }
    out
}

/// The line as it is to be read, and what is wrong with it.
fn checked(line: &str) -> (String, Option<String>) {
    let mut words = line.split_whitespace();
    let key = words.next().unwrap_or_default();
    let left_out = |problem: &str| (String::new(), Some(format!("{key} {problem}; the line is left out")));
    if COLORS.contains(&key) {
        let numbers: Option<Vec<f32>> = words.take(3).map(|w| w.parse().ok()).collect();
        return match numbers.as_deref() {
            None | Some([] | [_, _]) => left_out("needs one number or three"),
            Some(list) if !list.iter().all(|v| (0.0..=MAX_COLOR).contains(v)) => {
                left_out(&format!("must be 0 to {MAX_COLOR:e}"))
            }
            Some(list) if key == "Kd" && list.iter().any(|v| *v > 1.0) => {
                let color = |i: usize| list.get(i).unwrap_or(&list[0]).min(1.0);
                let problem = "Kd reflects more than arrives; what is above 1 is 1";
                (format!("{key} {} {} {}", color(0), color(1), color(2)), Some(problem.into()))
            }
            // By the format, one number is a grey.
            Some([grey]) => (format!("{key} {grey} {grey} {grey}"), None),
            Some(_) => (line.into(), None),
        };
    }
    if NUMBERS.contains(&key) {
        let value = words.find(|w| *w != "-halo").unwrap_or_default();
        return match value.parse::<f32>() {
            Ok(number) if number.is_finite() => (format!("{key} {}", if key == "illum" { "0" } else { value }), None),
            _ => left_out("needs a number"),
        };
    }
    if MAPS.contains(&key) && words.next().is_none() {
        return left_out("names no file");
    }
    (line.into(), None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_mean_nothing_are_left_out_and_told() {
        for (line, read, told) in [
            ("Kd 0.5 0.25 1", "Kd 0.5 0.25 1", false),
            ("Kd 0.5", "Kd 0.5 0.5 0.5", false),
            ("Ks 1 2", "", true),
            ("Kd nan 0 0", "", true),
            ("Ke -1 0 0", "", true),
            ("Ke 40 40 40", "Ke 40 40 40", false),
            ("Kd 1e5 0 0.5", "Kd 1 0 0.5", true),
            ("Kd spectral file.rfl", "", true),
            ("d -halo 0.5", "d 0.5", false),
            ("Ns much", "", true),
            ("map_Kd", "", true),
            ("  map_Kd wall.png", "  map_Kd wall.png", false),
            ("# Kd 1", "# Kd 1", false),
        ] {
            let (got, problem) = checked(line);
            assert_eq!((got.as_str(), problem.is_some()), (read, told), "{line}: {problem:?}");
        }
    }
}
