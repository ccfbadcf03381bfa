//! Camera paths: cameras at times, and a smooth way between them.

use crate::diagnostics::{Diagnostic, Items, Severity, Sources};
use crate::experiment::ExperimentError;
use crate::experiment::PlacedCamera;
use crate::files::FileError;
use glam::Vec3;
use serde::Deserialize;
use std::path::Path;

/// Most keys of a path.
pub const MAX_KEYS: usize = 100_000;

/// A camera at a time.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Key {
    /// Seconds.
    pub time: f64,
    /// Position, m.
    pub eye: (f32, f32, f32),
    /// The point it looks at, m.
    pub target: (f32, f32, f32),
    /// What is up in the picture.
    #[serde(default = "y_up")]
    pub up: (f32, f32, f32),
    /// Vertical field of view, 1 to 170 degrees.
    pub fov_y: f32,
}

fn y_up() -> (f32, f32, f32) {
    (0.0, 1.0, 0.0)
}

/// A path: keys in order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CameraPath {
    /// Start over at the last key, which then stands for the first; otherwise stay there.
    pub repeat: bool,
    /// At least one, times strictly rising.
    pub keys: Vec<Key>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PathFile {
    #[serde(default)]
    repeat: bool,
    keys: Items<Key>,
}

impl Key {
    /// A camera at a time.
    pub fn new(time: f64, camera: &PlacedCamera) -> Key {
        Key {
            time,
            eye: camera.eye,
            target: camera.target,
            up: camera.up,
            fov_y: camera.fov_y,
        }
    }

    fn check(&self) -> Result<(), String> {
        let vectors = [self.eye, self.target, self.up].map(Vec3::from);
        if !self.time.is_finite() || vectors.iter().any(|v| !v.is_finite()) {
            return Err("a key's numbers must be finite".into());
        }
        if self.eye == self.target || vectors[2] == Vec3::ZERO {
            return Err("a key's camera must look somewhere, and its up must not be zero".into());
        }
        if !(1.0..=170.0).contains(&self.fov_y) {
            return Err("a key's fov_y must be 1 to 170 degrees".into());
        }
        Ok(())
    }

    fn camera(&self) -> PlacedCamera {
        PlacedCamera {
            up: self.up,
            ..PlacedCamera::new(self.eye, self.target, self.fov_y)
        }
    }

    /// Everything that is interpolated.
    fn numbers(&self) -> [f64; 10] {
        let (e, t, u) = (self.eye, self.target, self.up);
        [e.0, e.1, e.2, t.0, t.1, t.2, u.0, u.1, u.2, self.fov_y].map(f64::from)
    }
}

impl CameraPath {
    /// Reads a path.
    ///
    /// # Errors
    /// All mistakes of the file, with their places.
    pub fn read(path: &Path) -> Result<CameraPath, Vec<Diagnostic>> {
        let mut sources = Sources::default();
        let file = sources.read(path).map_err(|e| {
            vec![e.help(Some(
                "give the path of a camera path, for example configs/paths/atrium.ron".into(),
            ))]
        })?;
        parse(&sources, file)
    }

    /// The camera at a time in seconds: a Catmull-Rom curve through the keys with tangents by time. Before the first
    /// key and after the last it stands still, unless the path repeats.
    pub fn at(&self, time: f64) -> PlacedCamera {
        let keys = &self.keys;
        let (Some(first), Some(last)) = (keys.first(), keys.last()) else {
            return PlacedCamera::new((0.0, 0.0, 0.0), (0.0, 0.0, -1.0), 60.0);
        };
        let length = last.time - first.time;
        let time = match self.repeat && length > 0.0 {
            true => first.time + (time - first.time).rem_euclid(length),
            false => time.clamp(first.time, last.time),
        };
        let i = keys.partition_point(|k| k.time <= time).saturating_sub(1);
        let (a, Some(b)) = (&keys[i], keys.get(i + 1)) else {
            return last.camera();
        };
        let h = b.time - a.time;
        let s = (time - a.time) / h;
        let (s2, s3) = (s * s, s * s * s);
        let weights = [
            2.0 * s3 - 3.0 * s2 + 1.0,
            s3 - 2.0 * s2 + s,
            3.0 * s2 - 2.0 * s3,
            s3 - s2,
        ];
        let (pa, pb) = (a.numbers(), b.numbers());
        let (ma, mb) = (self.tangent(i), self.tangent(i + 1));
        let n: [f32; 10] = std::array::from_fn(|c| {
            (weights[0] * pa[c]
                + weights[1] * h * ma[c]
                + weights[2] * pb[c]
                + weights[3] * h * mb[c]) as f32
        });
        let up = if Vec3::new(n[6], n[7], n[8]).length() > 1e-3 {
            (n[6], n[7], n[8])
        } else {
            a.up
        };
        let camera = PlacedCamera::new(
            (n[0], n[1], n[2]),
            (n[3], n[4], n[5]),
            n[9].clamp(1.0, 170.0),
        );
        PlacedCamera { up, ..camera }
    }

    /// Change a second at a key: of the parabola through it and its neighbours.
    fn tangent(&self, i: usize) -> [f64; 10] {
        let keys = &self.keys;
        let last = keys.len() - 1;
        let slope = |a: usize| {
            let (p, q, h) = (
                keys[a].numbers(),
                keys[a + 1].numbers(),
                keys[a + 1].time - keys[a].time,
            );
            (std::array::from_fn::<f64, 10, _>(|c| (q[c] - p[c]) / h), h)
        };
        // The segments before and after; a path that repeats goes on where it began.
        let before = if i > 0 {
            Some(i - 1)
        } else {
            self.repeat.then(|| last - 1)
        };
        let after = if i < last {
            Some(i)
        } else {
            self.repeat.then_some(0)
        };
        match (before.map(slope), after.map(slope)) {
            (Some((m0, h0)), Some((m1, h1))) => {
                std::array::from_fn(|c| (m0[c] * h1 + m1[c] * h0) / (h0 + h1))
            }
            (Some((m, _)), None) | (None, Some((m, _))) => m,
            (None, None) => [0.0; 10],
        }
    }
}

fn parse(sources: &Sources, file: u32) -> Result<CameraPath, Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let parsed = sources.parse::<PathFile>(file, &mut errors, &mut Vec::new());
    let Some(parsed) = parsed.filter(|_| !errors.iter().any(|e| e.severity == Severity::Error))
    else {
        return Err(errors);
    };
    let keys = parsed.keys.0;
    let start = crate::diagnostics::At { file, offset: 0 };
    if keys.is_empty() || keys.len() > MAX_KEYS {
        errors.push(sources.error(
            start,
            format!(
                "a path has 1 to {MAX_KEYS} keys, this one has {}",
                keys.len()
            ),
        ));
    }
    for (i, key) in keys.iter().enumerate() {
        if let Err(message) = key.value.check() {
            errors.push(sources.error(key.at, message));
        } else if i > 0 && keys[i - 1].value.time >= key.value.time {
            errors.push(sources.error(
                key.at,
                "a key's time must be greater than that of the key before",
            ));
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    Ok(CameraPath {
        repeat: parsed.repeat,
        keys: keys.into_iter().map(|k| k.value).collect(),
    })
}

/// Writes a path, whole or not at all, after reading its text back.
///
/// # Errors
/// A file that exists (without `overwrite`), a path that cannot be read back, no permission.
pub fn write(path: &CameraPath, file: &Path, overwrite: bool) -> Result<(), ExperimentError> {
    let text = text(path);
    let mut sources = Sources::default();
    let number = sources.add(file, text.clone());
    if parse(&sources, number).map_err(ExperimentError::Input)? != *path {
        return Err(FileError::write(file, "it would not read back as it is").into());
    }
    let written = match overwrite {
        true => crate::files::write_whole(file, text.as_bytes()),
        false => crate::files::write_new(file, text.as_bytes()),
    };
    written.map_err(|e| match e.is_there() {
        true => FileError::write(
            file,
            "it exists; choose another name, or ask to overwrite it",
        )
        .into(),
        false => e.into(),
    })
}

fn text(path: &CameraPath) -> String {
    let mut out = format!("(\n    repeat: {},\n    keys: [\n", path.repeat);
    for key in &path.keys {
        let camera = crate::experiment::placed_text(&key.camera());
        out += &format!(
            "        (time: {:?}, {},\n",
            key.time,
            camera.trim_start_matches('(')
        );
    }
    out + "    ],\n)\n"
}

/// Puts a key where its time belongs, and says where that is.
///
/// # Errors
/// There is a key at that time, the path is full, or the key's numbers are no camera.
pub fn insert(path: &mut CameraPath, key: Key) -> Result<usize, ExperimentError> {
    key.check().map_err(ExperimentError::Request)?;
    if path.keys.len() >= MAX_KEYS {
        return Err(ExperimentError::Request(format!(
            "a path has at most {MAX_KEYS} keys"
        )));
    }
    let i = path.keys.partition_point(|k| k.time < key.time);
    if path.keys.get(i).is_some_and(|k| k.time == key.time) {
        return Err(ExperimentError::Request(format!(
            "there is a key at {} s: remove it first",
            key.time
        )));
    }
    path.keys.insert(i, key);
    Ok(i)
}

/// Takes a key out; `None` when there is none of that number.
pub fn remove(path: &mut CameraPath, index: usize) -> Option<Key> {
    (index < path.keys.len()).then(|| path.keys.remove(index))
}

/// Gives a key another time, and says which number it has then.
///
/// # Errors
/// No such key, or there is one at that time; the path is as it was then.
pub fn move_key(path: &mut CameraPath, index: usize, time: f64) -> Result<usize, ExperimentError> {
    let key = remove(path, index)
        .ok_or_else(|| ExperimentError::Request(format!("the path has no key {index}")))?;
    insert(path, Key { time, ..key }).inspect_err(|_| path.keys.insert(index, key))
}
