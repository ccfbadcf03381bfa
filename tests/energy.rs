//! Light balance of bounces, by a closed form. In a closed room of one albedo, the light of all walls
//! together is (light of the first frame) / (1 - albedo), for any shape and any place of lamps.

mod common;

use common::{assert_clean, experiment, lab, prepare, root, scene, words};
use conelab::graph::run::Execution;
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

/// A session on a scene file, with small voxels and shadow maps.
fn session(lab: &Lab, file: &Path, bounce_frames: &str) -> Session {
    let settings = [
        ("voxel_dim", "64"),
        ("shadow_dim", "512"),
        ("bounce_frames", bounce_frames),
        ("cascades", "1"),
    ];
    let e = experiment(&file.to_string_lossy(), (16, 12), &settings);
    let mut session = prepare(lab, &e, &["radiance"]);
    session.set_execution(Execution::Incremental);
    session
}

/// Gathered light after a bounce that all sides do in one frame, relative to the light before it. Frames before it converge.
fn kept(session: &mut Session, areas: &[f64], frames: usize) -> f64 {
    session.run(frames).unwrap();
    let before = light(session, "sideRadiance", areas);
    session.run(1).unwrap();
    light(session, "sideGathered", areas) / before
}

/// Bounds allow for the noise of eight directions per surfel. The corridor is ten voxels wide. Coarser voxels change the
/// shape: columns of three voxels gain 0.8 % per bounce.
#[test]
fn closed_rooms_keep_all_light() {
    let dir = tempfile::tempdir().unwrap();
    let lab = lab(root());
    let mut wrong = Vec::new();
    for (albedo, bounces) in [(0.5, 12), (0.8, 24)] {
        for room in &ROOMS {
            let file = write(dir.path(), room, albedo);
            let mut session = session(&lab, &file, "1");
            session.run(1).unwrap();
            let areas = areas(&mut session);
            let first = light(&mut session, "sideRadiance", &areas);
            let kept = kept(&mut session, &areas, bounces - 1);
            let all = light(&mut session, "sideRadiance", &areas);
            let (energy, loss) = (all * (1.0 - albedo) / first, 1.0 - kept);
            let line = format!(
                "albedo {albedo}, {}: energy {energy:.4}, loss per bounce {loss:.4}",
                room.name
            );
            println!("{line}");
            if (energy - 1.0).abs() > 0.015 || loss.abs() > 0.004 {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_clean(&lab);
}

/// With a loss per bounce of l, the exact light is (light of the first frame) / (1 - albedo (1 - l)). l is measured by
/// a bounce that all sides do at once; at albedo 0.98 a loss of 0.1 % is 5 % of the light.
#[test]
fn bounces_converge_and_never_overshoot() {
    let dir = tempfile::tempdir().unwrap();
    let lab = lab(root());
    let mut wrong = Vec::new();
    for (albedo, frames, converged) in [(0.8, 48, 32), (0.95, 128, 64), (0.98, 128, 96)] {
        for room in &ROOMS[2..] {
            let file = write(dir.path(), room, albedo);
            let mut at_once = session(&lab, &file, "1");
            at_once.run(1).unwrap();
            let areas = areas(&mut at_once);
            let first = light(&mut at_once, "sideRadiance", &areas);
            let exact = first / (1.0 - albedo * kept(&mut at_once, &areas, converged));
            let mut session = session(&lab, &file, "16");
            let energy: Vec<f64> = (0..frames)
                .map(|_| {
                    session.run(1).unwrap();
                    light(&mut session, "sideRadiance", &areas) / exact
                })
                .collect();
            let (last, most) = (
                energy[frames - 1],
                energy.iter().copied().fold(0.0, f64::max),
            );
            let line = format!(
                "albedo {albedo}, {}: energy {:.4} after 9 frames, {:.4} after 21, {:.4} after 33, {last:.4} after {frames}, most {most:.4}",
                room.name, energy[8], energy[20], energy[32]
            );
            println!("{line}");
            if last < 0.98 || most > 1.02 {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_clean(&lab);
}

/// A street under a sky, with a closed room that a door connects to it: light converges at different rates.
const STREET: &str = "(materials: { \"wall\": (base_color: (0.9, 0.9, 0.9, 1.0), specular: 0.0) },
    meshes: { \"street\": [Solid([
        Box(material: \"wall\", low: (0.0, -0.2, 0.0), high: (4.0, 0.0, 3.0)),
        Box(material: \"wall\", low: (0.0, -0.1, 0.0), high: (2.0, 1.4, 3.0)),
        Hollow(material: \"wall\", low: (0.2, 0.0, 0.2), high: (1.8, 1.2, 2.8)),
        Hollow(material: \"wall\", low: (1.7, 0.0, 1.2), high: (2.1, 0.9, 1.8)),
        Box(material: \"wall\", low: (3.6, -0.1, 0.0), high: (4.0, 1.6, 3.0))])] },
    sky: (1, 1, 1), lights: [Point(name: \"lamp\", color: (3, 3, 3), position: (1.0, 0.8, 0.8), shadow: true)],
    cameras: { \"default\": (eye: (2.8, 0.5, 0.4), target: (2.8, 0.4, 2.0), fov_y: 70) })";

#[test]
fn light_of_an_open_scene_and_of_a_dimmed_lamp_never_overshoots() {
    let dir = tempfile::tempdir().unwrap();
    let lab = lab(root());
    let file = dir.path().join("street.ron");
    std::fs::write(&file, STREET).unwrap();
    let mut session_at_once = session(&lab, &file, "1");
    session_at_once.run(1).unwrap();
    let areas = areas(&mut session_at_once);
    let mut limit = |dimmed: f32| {
        let mut lights = scene(&file.to_string_lossy()).lights.clone();
        lights[0].color *= dimmed;
        let sky = scene(&file.to_string_lossy()).sky;
        assert!(session_at_once.set_lights(&lights, sky));
        session_at_once.run(150).unwrap();
        (
            light(&mut session_at_once, "sideRadiance", &areas),
            lights,
            sky,
        )
    };
    let (bright, ..) = limit(1.0);
    let (dim, lights, sky) = limit(0.1);
    let mut wrong = Vec::new();
    // The lamp is dimmed within the short rounds, or after them.
    for switched in [10, 48] {
        let mut session = session(&lab, &file, "16");
        let mut energy = Vec::new();
        for frame in 0..switched + 80 {
            if frame == switched {
                assert!(session.set_lights(&lights, sky));
            }
            session.run(1).unwrap();
            energy.push(light(&mut session, "sideRadiance", &areas));
        }
        let (before, after) = energy.split_at(switched);
        println!(
            "dimmed in frame {switched}, before: {:.3?}",
            before.iter().map(|e| e / bright).collect::<Vec<_>>()
        );
        println!(
            "    after: {:.3?}",
            after.iter().map(|e| e / dim).collect::<Vec<_>>()
        );
        let rises = after.windows(2).any(|e| e[1] > 1.005 * e[0].max(dim));
        let too_bright = before.iter().any(|e| *e > 1.02 * bright);
        let least = after.iter().copied().fold(f64::MAX, f64::min) / dim;
        // Rounds of 16 frames: more than half of the surplus is gone after five of them.
        let slow = after[79] - dim > 0.5 * (after[0] - dim);
        let dark = switched == 48 && before[47] < 0.95 * bright;
        if too_bright || rises || slow || dark || least < 0.98 {
            wrong.push(format!(
                "dimmed in frame {switched}: too bright {too_bright}, rises {rises}, slow {slow}, dark {dark}, least {least:.4}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_clean(&lab);
}
