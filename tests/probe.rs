//! The cone probe: what it writes down is what shading did, and without it nothing of it exists.

mod common;

use common::{assert_clean, experiment, floats, lab, prepare, root, scene};
use conelab::graph::table::{Cell, decode};
use conelab::lab::{Lab, Session};
use glam::Vec3;

const SIZE: (u32, u32) = (64, 48);

/// One frame at 64 voxels with what `wanted` names; `at` is the probed pixel.
#[track_caller]
fn frame(
    lab: &Lab,
    scene: &str,
    at: Option<[u32; 2]>,
    settings: &[(&str, &str)],
    wanted: &[&str],
) -> Session {
    let of_rays = [
        ("gather_frames", "1"),
        ("pixel_rays", "2"),
        ("lobe_share", "0"),
        ("emitter_rays", "0"),
    ]; // a single one in the lobe
    frame_of(lab, scene, at, &[&of_rays, settings].concat(), wanted)
}

#[track_caller]
fn frame_of(
    lab: &Lab,
    scene: &str,
    at: Option<[u32; 2]>,
    settings: &[(&str, &str)],
    wanted: &[&str],
) -> Session {
    let probe = at.map_or(String::from("(-1, -1)"), |[x, y]| format!("({x}.5, {y}.5)"));
    let base = [
        ("voxel_dim", "64"),
        ("shadow_dim", "512"),
        ("probe", probe.as_str()),
    ];
    let mut session = prepare(
        lab,
        &experiment(scene, SIZE, &[&base[..], settings].concat()),
        wanted,
    );
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_clean(lab);
    session
}

/// A row of the table, by its columns' names.
struct Row {
    cone: u32,
    sample: u32,
    distance: f32,
    alpha: f32,
    radiance: Vec3,
    transmittance: f32,
}

fn rows(session: &mut Session) -> Vec<Row> {
    let number = session
        .graph
        .tables
        .iter()
        .position(|t| t.value.title == "Cone samples")
        .unwrap();
    let table = session.table(number).unwrap();
    let buffer = session
        .graph
        .buffers
        .iter()
        .position(|b| b.0 == "coneSamples")
        .unwrap();
    let cells = decode(&table, &session.program.read_buffer(buffer).unwrap());
    let column = |name: &str| table.columns.iter().position(|c| c.name == name).unwrap();
    let uint = |row: &[Cell], name| match row[column(name)] {
        Cell::Uint(v) => v,
        _ => panic!("{name}"),
    };
    let float = |row: &[Cell], name| match row[column(name)] {
        Cell::Float(v) => v,
        _ => panic!("{name}"),
    };
    let read = |row: &Vec<Cell>| Row {
        cone: uint(row, "cone"),
        sample: uint(row, "sample"),
        distance: float(row, "distance"),
        alpha: float(row, "alpha"),
        radiance: match &row[column("radiance")] {
            Cell::Vector(v) => Vec3::from_slice(v),
            _ => panic!("radiance"),
        },
        transmittance: float(row, "transmittance"),
    };
    cells.iter().map(read).collect()
}

/// Radiance of a cone from its samples, as shading makes it with the default settings.
fn cone_radiance(samples: &[&Row], sky: Vec3) -> Vec3 {
    let sum: Vec3 = samples.iter().map(|r| r.radiance).sum();
    let left = samples.last().map_or(1.0, |r| r.transmittance);
    // A cone that stops is scaled to full opacity.
    if left < 0.3 {
        sum / (1.0 - left)
    } else {
        sum + left * sky
    }
}

#[test]
fn samples_add_up_to_what_shading_found() {
    let lab = lab(root());
    // The floor and the left wall of the box, a wall of the furnace, the sphere's middle.
    let cases = [
        ("cornell", [32, 44], "white"),
        ("cornell", [14, 24], "red"),
        ("furnace", [20, 20], ""),
        ("white-sky", [32, 24], ""),
    ];
    // Filtering mixes a pixel's light with its neighbours' afterwards.
    let traces = [("rays", vec![1.0 / 2.0; 2]), ("cones", vec![1.0 / 3.0; 3])];
    for ((name, at, material), (trace, weights)) in cases
        .into_iter()
        .flat_map(|c| traces.iter().map(move |t| (c, t)))
    {
        let what = format!("{name} at {at:?}, {trace}");
        let wanted = ["coneSamples", "gatheredDiffuse", "surfaceNormal"];
        // What rays to emitters bring is no radiance that they meet.
        let mut session = match *trace {
            "rays" => frame(&lab, name, Some(at), &[], &wanted),
            _ => frame_of(
                &lab,
                name,
                Some(at),
                &[
                    ("cone_count", "3"),
                    ("gather_frames", "1"),
                    ("emitter_rays", "0"),
                ],
                &wanted,
            ),
        };
        let pixel = (at[1] * SIZE.0 + at[0]) as usize;
        let normal =
            Vec3::from_slice(&floats(&mut session, "surfaceNormal", 0)[pixel][..3]) * 2.0 - 1.0;
        match material {
            "white" => assert!(normal.y > 0.99, "{what}: no floor, {normal}"),
            "red" => assert!(normal.x < -0.9, "{what}: no left wall, {normal}"),
            _ => {}
        }
        let sky = scene(name).sky;
        let cones = 0..=weights.len() as u32;

        let rows = rows(&mut session);
        let cone = |number: u32| rows.iter().filter(|r| r.cone == number).collect::<Vec<_>>();
        for number in cones.clone() {
            let samples = cone(number);
            // Around the sphere the volume is so tight that a cone may leave it at once; of a rough lobe a sampled direction
            // may lead into the surface.
            let may_lack = name == "white-sky" || number == 0 || *trace == "cones";
            assert!(
                may_lack || !samples.is_empty(),
                "{what}: cone {number} has no samples"
            );
            let mut before = 1.0;
            for (i, row) in samples.iter().enumerate() {
                assert_eq!(row.sample as usize, i, "{what}: cone {number}");
                assert!(
                    row.transmittance <= before,
                    "{what}: cone {number} clears up at sample {i}"
                );
                assert!(
                    (before - row.alpha - row.transmittance).abs() < 1e-4,
                    "{what}: cone {number}, sample {i}"
                );
                assert!(
                    i == 0 || row.distance > samples[i - 1].distance,
                    "{what}: cone {number} goes back"
                );
                before = row.transmittance;
            }
        }
        assert!(
            rows.iter().all(|r| cones.contains(&r.cone)),
            "{what}: more cones than there are"
        );

        let expected: Vec3 = (1..)
            .zip(weights)
            .map(|(n, weight)| *weight * cone_radiance(&cone(n), sky))
            .sum();
        let shaded = Vec3::from_slice(&floats(&mut session, "gatheredDiffuse", 0)[pixel][..3]);
        println!(
            "{what}: {} samples, {expected:.5} expected, {shaded:.5} shaded",
            rows.len()
        );
        // A step of a 16-bit float is at most 2^-10 of the value, and software devices cut off.
        let error = ((expected - shaded) / shaded.max(Vec3::splat(1e-3)))
            .abs()
            .max_element();
        assert!(error < 2e-3, "{what}: {expected} is not {shaded} ({error})");
    }
}

#[test]
fn without_a_pointer_there_is_no_probe() {
    let lab = lab(root());
    let probes = |session: &Session| {
        let passes = session
            .program
            .plan
            .steps
            .iter()
            .map(|s| session.graph.passes[s.pass].value.name.value.clone());
        passes
            .filter(|n| n.starts_with("probe"))
            .collect::<Vec<_>>()
    };
    let made = |session: &Session| {
        let buffer = session
            .graph
            .buffers
            .iter()
            .position(|b| b.0 == "coneSamples")
            .unwrap();
        session.program.plan.buffers[buffer].used
    };
    // Nothing is pointed at; the linear picture needs no lines.
    for (at, wanted) in [(None, "display"), (Some([32, 44]), "radiance")] {
        let session = frame(&lab, "cornell", at, &[], &[wanted]);
        assert_eq!(probes(&session), Vec::<String>::new(), "{at:?}");
        assert!(!made(&session), "{at:?}: the buffer is made");
    }
    let session = frame(
        &lab,
        "cornell",
        Some([32, 44]),
        &[],
        &["radiance", "coneSamples"],
    );
    assert_eq!(probes(&session), ["probe clear", "probe"]);
    let session = frame(&lab, "cornell", Some([32, 44]), &[], &["display"]);
    assert_eq!(probes(&session), ["probe clear", "probe", "probe lines"]);
    assert!(made(&session));
}

#[test]
fn lines_are_drawn_over_every_view_and_nothing_else_changes() {
    let lab = lab(root());
    let bytes = |session: &mut Session, name: &str| session.texels(name, 0, 0).unwrap().bytes;
    let views = [
        "shaded",
        "direct",
        "diffuse",
        "specular",
        "occlusion",
        "normal",
        "depth",
        "voxels",
    ];
    for view in views {
        let settings = [("view", view)];
        let mut without = frame(&lab, "cornell", None, &settings, &["display", "radiance"]);
        let mut with = frame(
            &lab,
            "cornell",
            Some([32, 44]),
            &settings,
            &["display", "radiance"],
        );
        assert!(
            bytes(&mut without, "radiance") == bytes(&mut with, "radiance"),
            "{view}: the probe changes shading"
        );
        let (a, b) = (bytes(&mut without, "display"), bytes(&mut with, "display"));
        let changed = a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a != b).count();
        println!("{view}: {changed} of {} pixels have lines", a.len() / 4);
        assert!(
            (20..1500).contains(&changed),
            "{view}: {changed} pixels changed"
        );
    }
    // Nothing is under the pointer.
    let mut without = frame(&lab, "white-sky", None, &[], &["display"]);
    let mut with = frame(
        &lab,
        "white-sky",
        Some([1, 1]),
        &[],
        &["display", "coneSamples"],
    );
    assert!(rows(&mut with).is_empty());
    assert!(
        bytes(&mut without, "display") == bytes(&mut with, "display"),
        "lines come from the sky"
    );
}
