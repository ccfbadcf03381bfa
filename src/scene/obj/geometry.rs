//! Statements of an OBJ file: vertices, faces, objects, materials and smoothing groups.

use std::collections::HashMap;

use indexmap::IndexSet;

use super::faces::{self, Corner, Counts, NONE};
use super::lines::{lines, shown, without_comment, words};
use crate::scene::progress::Progress;
use crate::scene::warnings::Warnings;

/// Name of an unnamed object.
const UNNAMED: &str = "unnamed_object";
/// Lines between two checks for cancellation.
const LOOK: usize = 4096;

/// Normal generation if the file gives no normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Smoothing {
    /// Crease angle: the file has no groups.
    Angle,
    /// Flat faces.
    Off,
    /// Index of a smoothing group.
    Group(u32),
}

/// A face: its corners end at `end` and start at the end of the previous face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub end: u32,
    pub line: u32,
    pub smoothing: Smoothing,
}

/// Consecutive faces with one object and one material.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub object: String,
    /// Index into [`Geometry::used`].
    pub material: Option<u32>,
    pub first_face: usize,
}

/// The content of an OBJ file before references are resolved.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub positions: Vec<[f32; 3]>,
    /// sRGB colours of the first positions; the others are white.
    pub colors: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    pub normals: Vec<[f32; 3]>,
    pub corners: Vec<Corner>,
    pub faces: Vec<Face>,
    pub pieces: Vec<Piece>,
    /// Names of materials used by faces.
    pub used: IndexSet<String>,
    /// Arguments of `mtllib`.
    pub libraries: IndexSet<String>,
}

impl Geometry {
    /// The corners of a face.
    pub fn corners_of(&self, face: usize) -> &[Corner] {
        let begin = face
            .checked_sub(1)
            .map_or(0, |before| self.faces[before].end as usize);
        &self.corners[begin..self.faces[face].end as usize]
    }
}

/// Parses a file's text. Errors begin with the line number.
pub(super) fn read(
    text: &str,
    warnings: &mut Warnings,
    progress: Progress,
) -> Result<Geometry, String> {
    let mut reader = Reader::new(warnings);
    for (count, line) in lines(text).enumerate() {
        if count % LOOK == 0 && progress.stopped() {
            return Err(String::new());
        }
        let (key, rest) = line.split();
        reader.number = line.number;
        reader.statement(&key, rest).map_err(|problem| {
            format!(
                "line {}: {problem}. Export it again, or correct the line",
                line.number
            )
        })?;
    }
    reader.finish()
}

struct Reader<'a> {
    all: Geometry,
    number: usize,
    object: String,
    material: Option<u32>,
    smoothing: Smoothing,
    /// Whether the next face starts a new piece.
    changed: bool,
    groups: HashMap<String, u32>,
    /// Counts of known and unknown statements.
    known: usize,
    unknown: usize,
    warnings: &'a mut Warnings,
}

impl Reader<'_> {
    fn new(warnings: &mut Warnings) -> Reader<'_> {
        Reader {
            all: Geometry::default(),
            number: 0,
            object: UNNAMED.into(),
            material: None,
            smoothing: Smoothing::Angle,
            changed: true,
            groups: HashMap::new(),
            known: 0,
            unknown: 0,
            warnings,
        }
    }

    fn statement(&mut self, key: &str, rest: &str) -> Result<(), String> {
        self.known += 1;
        match key {
            "v" => self.vertex(rest)?,
            "vt" => self.all.uvs.push(numbers(rest, "texture coordinates", 1)?),
            "vn" => self.all.normals.push(numbers(rest, "a normal", 3)?),
            "f" | "fo" => self.face(rest)?,
            "o" | "g" => self.begin_object(without_comment(rest)),
            "usemtl" => self.use_material(rest),
            "mtllib" if rest.is_empty() => self.left_out("'mtllib' without a file is left out"),
            "mtllib" => {
                self.all.libraries.insert(rest.into());
            }
            "s" => self.smooth(words(rest).next().unwrap_or("off")),
            "l" => self.left_out("lines (l) are left out: only faces are rendered"),
            "p" => self.left_out("points (p) are left out: only faces are rendered"),
            "vp" | "curv" | "curv2" | "surf" => {
                self.left_out(
                    "curves and free-form surfaces are left out. Convert them to polygons",
                );
            }
            "call" | "csh" => self.left_out("commands and other files (call, csh) are left out"),
            "maplib" | "usemap" => {
                self.left_out("maplib and usemap are left out. Name maps in the material library")
            }
            // Free-form surface data and viewer settings.
            "cstype" | "deg" | "bmat" | "step" | "parm" | "trim" | "hole" | "scrv" | "sp"
            | "end" | "con" | "mg" | "bevel" | "c_interp" | "d_interp" | "lod" | "shadow_obj"
            | "trace_obj" | "ctech" | "stech" => {}
            _ => {
                self.known -= 1;
                self.unknown += 1;
                self.warnings
                    .add("lines with unknown keywords are left out", shown(key));
            }
        }
        Ok(())
    }

    fn left_out(&mut self, what: &str) {
        self.warnings
            .add(what, format_args!("line {}", self.number));
    }

    fn vertex(&mut self, rest: &str) -> Result<(), String> {
        self.all.positions.push(numbers(rest, "a position", 3)?);
        let others: Vec<&str> = words(rest).skip(3).take(4).collect();
        // `x y z r g b`, or the same after a weight.
        let Some(color) = others
            .len()
            .checked_sub(3)
            .map(|weights| &others[weights..])
        else {
            return Ok(());
        };
        match <[f32; 3]>::try_from(
            color
                .iter()
                .filter_map(|word| word.parse().ok())
                .collect::<Vec<_>>(),
        ) {
            Ok(color) => {
                self.all
                    .colors
                    .resize(self.all.positions.len() - 1, [1.0; 3]);
                self.all.colors.push(color);
            }
            Err(_) => self.left_out("colours of vertices that are not numbers are left out"),
        }
        Ok(())
    }

    fn begin_object(&mut self, name: &str) {
        self.object = if name.is_empty() {
            UNNAMED.into()
        } else {
            name.into()
        };
        self.changed = true;
    }

    fn use_material(&mut self, name: &str) {
        self.changed = true;
        let known = self.all.used.get_index_of(name);
        let index = known.unwrap_or_else(|| self.all.used.insert_full(name.into()).0);
        self.material = u32::try_from(index).ok();
    }

    fn smooth(&mut self, group: &str) {
        if group.eq_ignore_ascii_case("off") || group == "0" {
            self.smoothing = Smoothing::Off;
            return;
        }
        let next = self.groups.len() as u32;
        self.smoothing = Smoothing::Group(*self.groups.entry(group.into()).or_insert(next));
    }

    fn face(&mut self, rest: &str) -> Result<(), String> {
        let counts = Counts {
            positions: self.all.positions.len(),
            uvs: self.all.uvs.len(),
            normals: self.all.normals.len(),
        };
        let begin = self.all.corners.len();
        let mut wrong = [false; 2];
        for word in words(rest) {
            let (corner, missing) = faces::corner(word, counts)?;
            self.all.corners.push(corner);
            wrong = [wrong[0] | missing[0], wrong[1] | missing[1]];
        }
        if self.all.corners.len() - begin < 3 {
            self.all.corners.truncate(begin);
            self.left_out("faces of fewer than three corners are left out");
            return Ok(());
        }
        if self.changed {
            self.changed = false;
            let (object, material) = (self.object.clone(), self.material);
            self.all.pieces.push(Piece {
                object,
                material,
                first_face: self.all.faces.len(),
            });
        }
        let end = u32::try_from(self.all.corners.len())
            .map_err(|_| "the file has more than 2^32 corners")?;
        let line = u32::try_from(self.number).unwrap_or(u32::MAX);
        self.all.faces.push(Face {
            end,
            line,
            smoothing: self.smoothing,
        });
        without(&mut self.all.corners[begin..], wrong, line, self.warnings);
        Ok(())
    }

    /// Checks the indices of corners against the whole file.
    fn finish(mut self) -> Result<Geometry, String> {
        if self.all.positions.is_empty() && self.unknown > self.known {
            return Err(
                "it holds nothing of the OBJ format. Check that the file is a Wavefront OBJ".into(),
            );
        }
        let counts = [
            self.all.positions.len(),
            self.all.uvs.len(),
            self.all.normals.len(),
        ];
        let outside = |index: u32, count: usize| index != NONE && index as usize >= count;
        let mut begin = 0;
        let grouped =
            !self.groups.is_empty() || self.all.faces.iter().any(|f| f.smoothing == Smoothing::Off);
        for face in &mut self.all.faces {
            let corners = &mut self.all.corners[begin..face.end as usize];
            begin = face.end as usize;
            if let Some(bad) = corners.iter().find(|c| outside(c.position, counts[0])) {
                let problem = faces::missing(i64::from(bad.position) + 1, counts[0]);
                return Err(format!("line {}: {problem}. Export it again", face.line));
            }
            let wrong = [
                corners.iter().any(|c| outside(c.uv, counts[1])),
                corners.iter().any(|c| outside(c.normal, counts[2])),
            ];
            without(corners, wrong, face.line, self.warnings);
            // Smoothing is off until the first group.
            if grouped && face.smoothing == Smoothing::Angle {
                face.smoothing = Smoothing::Off;
            }
        }
        Ok(self.all)
    }
}

/// Removes texture coordinates or normals from a face if some of them do not exist.
fn without(corners: &mut [Corner], wrong: [bool; 2], line: u32, warnings: &mut Warnings) {
    if wrong[0] {
        corners.iter_mut().for_each(|corner| corner.uv = NONE);
        warnings.add(
            "faces name texture coordinates that the file does not hold: they have none",
            format_args!("line {line}"),
        );
    }
    if wrong[1] {
        corners.iter_mut().for_each(|corner| corner.normal = NONE);
        warnings.add(
            "faces name normals that the file does not hold: theirs are generated",
            format_args!("line {line}"),
        );
    }
}

/// The leading numbers of a line, at least `needed`.
fn numbers<const N: usize>(rest: &str, what: &str, needed: usize) -> Result<[f32; N], String> {
    let mut numbers = [0.0; N];
    let mut words = words(rest);
    for (i, number) in numbers.iter_mut().enumerate() {
        match words.next() {
            Some(word) => *number = word.parse().map_err(|_| not_a_number(word, what))?,
            None if i < needed => return Err(format!("{what} needs {needed} numbers and has {i}")),
            None => break,
        }
    }
    Ok(numbers)
}

fn not_a_number(word: &str, what: &str) -> String {
    let hint = if word.contains(',') {
        " (decimals have a point)"
    } else {
        ""
    };
    format!("'{}' of {what} is not a number{hint}", shown(word))
}
