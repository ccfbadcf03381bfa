//! Light balance of bounces, by a closed form. In a closed room of one albedo, the light of all walls
//! together is (light of the first frame) / (1 - albedo), for any shape and any place of lamps. And how soon it is there.

mod common;

use common::{assert_clean, experiment, lab, prepare, root, words};
use conelab::lab::{Lab, Session};
use half::f16;
use std::path::{Path, PathBuf};

/// Size of the room [m], its additional solids, the materials of its walls that are not "wall", and its lights.
struct Room {
    name: &'static str,
    size: (f64, f64, f64),
    solids: &'static str,
    faces: &'static str,
    lights: &'static str,
    /// Emission of "wall".
    emission: f64,
}

const COLUMNS: &str = "Box(material: \"wall\", low: (0.5, -0.1, 0.6), high: (0.92, 2.0, 1.03)),
    Box(material: \"wall\", low: (1.3, -0.1, 1.3), high: (1.75, 2.0, 1.8)),
    Box(material: \"wall\", low: (0.9, -0.1, -0.1), high: (1.5, 0.65, 0.57))";

const ROOMS: [Room; 4] = [
    Room {
        name: "columns, all walls emit",
        size: (2.1, 1.9, 2.3),
        solids: COLUMNS,
        faces: "",
        lights: "",
        emission: 1.0,
    },
    Room {
        name: "columns, one wall emits",
        size: (2.1, 1.9, 2.3),
        solids: COLUMNS,
        faces: "\"-x\": \"lit\"",
        lights: "",
        emission: 0.0,
    },
    Room {
        name: "columns, lamp",
        size: (2.1, 1.9, 2.3),
        solids: COLUMNS,
        faces: "",
        lights: "Point(name: \"lamp\", color: (3, 3, 3), position: (1.0, 1.3, 1.1), shadow: true)",
        emission: 0.0,
    },
    Room {
        name: "corridor, one end emits",
        size: (5.0, 0.9, 0.8),
        solids: "",
        faces: "\"-x\": \"lit\"",
        lights: "",
        emission: 0.0,
    },
];

fn write(folder: &Path, room: &Room, albedo: f64) -> PathBuf {
    let wall = |emission: f64| {
        format!(
            "(base_color: ({albedo:?}, {albedo:?}, {albedo:?}, 1.0), specular: 0.0, \
              emission: ({emission:?}, {emission:?}, {emission:?}))"
        )
    };
    let Room {
        size: (x, y, z),
        solids,
        faces,
        lights,
        ..
    } = room;
    let text = format!(
        "(materials: {{ \"outside\": (base_color: (0, 0, 0, 1), specular: 0.0), \"wall\": {}, \"lit\": {} }},
          meshes: {{ \"room\": [Solid([
              Box(material: \"outside\", low: (-0.2, -0.2, -0.2), high: ({:?}, {:?}, {:?})),
              Hollow(material: \"wall\", low: (0.0, 0.0, 0.0), high: ({x:?}, {y:?}, {z:?}), faces: {{{faces}}}),
              {solids}])] }},
          sky: (0, 0, 0), lights: [{lights}],
          cameras: {{ \"default\": (eye: (0.2, 0.5, 0.4), target: (1.0, 0.4, 0.0), fov_y: 70) }})",
        wall(room.emission),
        wall(1.0),
        x + 0.2,
        y + 0.2,
        z + 0.2,
    );
    let file = folder.join("room.ron");
    std::fs::write(&file, text).unwrap();
    file
}

const FINE: (&str, &str) = ("voxel_dim", "64");
const COARSE: (&str, &str) = ("voxel_dim", "32");
const ONE_FRAME: (&str, &str) = ("bounce_frames", "1");

/// Without averages, so that each round has the same directions.
fn session(lab: &Lab, folder: &Path, room: &Room, albedo: f64, set: &[(&str, &str)]) -> Session {
    let file = write(folder, room, albedo);
    let mut settings = vec![
        ("shadow_dim", "512"),
        ("cascades", "1"),
        ("accumulation_rounds", "1"),
    ];
    settings.extend(set);
    let e = experiment(&file.to_string_lossy(), (16, 12), &settings);
    prepare(lab, &e, &["radiance"])
}

/// Area of each side of each surfel, 0 without a surface [1/16 mask texel].
fn areas(session: &mut Session) -> Vec<f64> {
    let sums = words(session, "surfelSums");
    let count = words(session, "voxelCounter")[1];
    let surfels = sums.chunks_exact(23).take(count as usize);
    surfels
        .flat_map(|s| [f64::from(s[3]), f64::from(s[14])])
        .collect()
}

/// Red light on all sides, weighted by area.
fn light(session: &mut Session, name: &str, areas: &[f64]) -> f64 {
    let list = words(session, name);
    let red = list
        .chunks_exact(2)
        .map(|w| f16::from_bits(w[0] as u16).to_f64());
    red.zip(areas).map(|(light, area)| light * area).sum()
}

/// Bounds allow for the noise of 16 directions per surfel. In the corridor, ten voxels wide, 0.4 % per bounce are missing
/// with 64 directions too, or 1.5 % in all. Coarser voxels change the shape: columns of three voxels gain 0.8 % per bounce.
#[test]
fn closed_rooms_keep_all_light() {
    let dir = tempfile::tempdir().unwrap();
    let lab = lab(root());
    let mut wrong = Vec::new();
    for albedo in [0.5, 0.8] {
        for room in &ROOMS {
            let directions = ("bounce_directions", "16");
            let mut session = session(
                &lab,
                dir.path(),
                room,
                albedo,
                &[FINE, ONE_FRAME, directions],
            );
            session.run(1).unwrap();
            let areas = areas(&mut session);
            let first = light(&mut session, "sideRadiance", &areas);
            session.run(30).unwrap();
            let before = light(&mut session, "sideRadiance", &areas);
            session.run(1).unwrap();
            let all = light(&mut session, "sideRadiance", &areas);
            let gathered = light(&mut session, "sideGathered", &areas);
            let exact = first / (1.0 - albedo);
            let (energy, loss) = (all / exact, 1.0 - gathered / before);
            let line = format!(
                "albedo {albedo}, {}: energy {energy:.4}, loss per bounce {loss:.4}",
                room.name
            );
            println!("{line}");
            if (energy - 1.0).abs() > 0.018 || loss.abs() > 0.006 {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_clean(&lab);
}

/// The truth is the light after many rounds that take one frame each, with the same directions. The corridor has no case
/// of albedo 0.98: its light would depend on the random directions.
#[test]
fn bounces_converge_within_few_rounds() {
    let dir = tempfile::tempdir().unwrap();
    let lab = lab(root());
    let mut wrong = Vec::new();
    for (room, albedo, frames, bound) in [
        (&ROOMS[2], 0.8, 48, 0.02),
        (&ROOMS[2], 0.98, 128, 0.05),
        (&ROOMS[3], 0.8, 48, 0.02),
    ] {
        let mut truth = session(&lab, dir.path(), room, albedo, &[COARSE, ONE_FRAME]);
        truth.run(200).unwrap();
        let areas = areas(&mut truth);
        let exact = light(&mut truth, "sideRadiance", &areas);
        let mut spread = session(&lab, dir.path(), room, albedo, &[COARSE]);
        let mut most = 0.0f64;
        let mut reached = 0.0;
        for _ in 0..frames / 4 {
            spread.run(4).unwrap();
            reached = light(&mut spread, "sideRadiance", &areas) / exact;
            most = most.max(reached);
        }
        let line = format!(
            "albedo {albedo}, {}: {reached:.4} after {frames} frames, at most {most:.4}",
            room.name
        );
        println!("{line}");
        if (reached - 1.0).abs() > bound || most > 1.1 {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_clean(&lab);
}
