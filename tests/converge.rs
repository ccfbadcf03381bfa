//! Converged means converged: every command and the window stop at the same state, whatever gathers the light.

mod common;

use common::{assert_clean, floats, lab, root, scene};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::Experiment;
use conelab::graph::run::Execution;
use conelab::lab::load;
use conelab::lab::{Lab, Session, Workspace};
use conelab::measure::reference::{Goal, gather};
use conelab::measure::{Frames, Scored, Warm, measure};
use conelab::metrics::METRICS;
use conelab::vulkan::GpuOptions;
use conelab::workbench::desired::request::{LightState, RenderRequest, SideRequest};
use conelab::workbench::engine::error_worker::ErrorQuery;
use conelab::workbench::engine::report::{PictureReport, Report};
use conelab::workbench::engine::{Engine, Order};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Mean absolute difference between converged light and three times as many frames, relative to its mean.
const BOUND: f64 = 0.005;

/// Parameters that change how light is gathered, each with one or two values.
const OPTIONS: [(&str, &[&str]); 8] = [
    ("trace", &["cone_rays", "lobe_rays"]),
    ("bounces", &["one"]),
    ("bounce_frames", &["1", "5", "64"]),
    ("bounce_emitter_rays", &["0"]),
    ("gather_frames", &["1", "32"]),
    ("emitter_rays", &["0"]),
    ("temporal_factor", &["0.5"]),
    ("mips", &["isotropic"]),
];

fn with(mut experiment: Experiment, set: &[(&str, &str)]) -> Experiment {
    for (name, value) in set {
        let name = Loc {
            value: (*name).to_string(),
            at: At::default(),
        };
        experiment.params.push((name, (*value).to_string()));
    }
    experiment
}

/// The experiment with those settings that its graph has.
fn with_known(home: &Workspace, experiment: Experiment, settings: &[(&str, &str)]) -> Experiment {
    let graph = load(&home.graph_path(&experiment.graph), &home.folders()).unwrap();
    let known = |s: &&(&str, &str)| graph.params.index(s.0).is_some();
    let known: Vec<_> = settings.iter().filter(known).copied().collect();
    with(experiment, &known)
}

/// The shipped presets, small.
fn presets(home: &Workspace) -> Vec<Experiment> {
    let files = std::fs::read_dir(root().join("configs"))
        .unwrap()
        .map(|f| f.unwrap().path());
    let mut files: Vec<_> = files
        .filter(|f| f.extension().is_some_and(|e| e == "ron"))
        .collect();
    files.sort();
    let small = |file: &std::path::PathBuf| {
        let experiment = Experiment::read(file).unwrap();
        let experiment = Experiment {
            scene: "cornell".into(),
            size: (32, 24),
            ..experiment
        };
        let small = [("voxel_dim", "16"), ("shadow_dim", "256")];
        let mut experiment = with_known(home, experiment, &small);
        experiment.name = file.file_stem().unwrap().to_string_lossy().into_owned();
        experiment
    };
    files.iter().map(small).collect()
}

/// Each preset alone, and the graphs under the options that they have; the graph with a temporal filter under those that
/// pass through it. `warps.ron` gathers with the passes of `cones.ron`.
fn cases() -> Vec<Experiment> {
    let home = Workspace::with(root().to_path_buf(), None);
    // Rounds that are averaged go on for longer than these frames.
    let one_round = |e: Experiment| with_known(&home, e, &[("accumulation_rounds", "1")]);
    // Probes weigh new random rays by the same share for ever, so that their noise does not fall.
    let converges = |e: &Experiment| e.graph != "ddgi.ron";
    let presets = presets(&home).into_iter().filter(converges);
    let presets: Vec<_> = presets.map(one_round).collect();
    let (mut cases, mut graphs) = (presets.clone(), Vec::new());
    for preset in presets {
        if preset.graph == "warps.ron" || graphs.contains(&preset.graph) {
            continue;
        }
        graphs.push(preset.graph.clone());
        let graph = load(&home.graph_path(&preset.graph), &home.folders()).unwrap();
        let filtered = graph.params.index("temporal_factor").is_some();
        let matters = |name: &str| !filtered || ["temporal_factor"].contains(&name);
        let has = |name: &str| graph.params.index(name).is_some() && matters(name);
        for (name, values) in OPTIONS.iter().filter(|(name, _)| has(name)) {
            for value in *values {
                let mut case = with(preset.clone(), &[(name, value)]);
                case.name = format!("{}, {name} {value}", preset.graph);
                if *value == "cone_rays" || *value == "lobe_rays" {
                    case = with(case, &[("exact_rays", "4")]);
                }
                cases.push(case);
            }
        }
    }
    cases
}

fn session(lab: &Lab, experiment: &Experiment) -> Session {
    let wanted = |graph: &conelab::graph::Graph| {
        let radiance = graph.hdr.iter().chain(&graph.output).next();
        Ok(radiance.cloned().into_iter().collect())
    };
    let mut session = lab.prepare(experiment, scene("cornell"), wanted).unwrap().0;
    session.set_execution(Execution::Incremental);
    session
}

fn light(session: &mut Session) -> Vec<[f32; 4]> {
    let name = session
        .graph
        .hdr
        .clone()
        .or(session.graph.output.clone())
        .unwrap();
    floats(session, &name, 0)
}

/// Mean absolute difference, relative to the mean.
fn distance(a: &[[f32; 4]], b: &[[f32; 4]]) -> f64 {
    let channels = |list: &[[f32; 4]]| {
        list.iter()
            .flat_map(|t| t[..3].to_vec())
            .map(f64::from)
            .collect::<Vec<_>>()
    };
    let (a, b) = (channels(a), channels(b));
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum::<f64>() / b.iter().sum::<f64>()
}

#[test]
fn three_times_as_many_frames_change_nothing_that_counts() {
    let lab = lab(root());
    let mut wrong = Vec::new();
    for case in cases() {
        let begun = Instant::now();
        let mut session = session(&lab, &case);
        let frames = session.converging_frames();
        session.run(frames).unwrap();
        let converged = light(&mut session);
        // Where no pass gathers over frames, none may follow the first.
        session.run(2 * frames).unwrap();
        let far = distance(&converged, &light(&mut session));
        let line = format!(
            "{}: {frames} frames, {far:.1e} from three times as many",
            case.name
        );
        println!("{line}, {:.1} s", begun.elapsed().as_secs_f64());
        if far > BOUND {
            wrong.push(line);
        }
    }
    assert!(
        wrong.is_empty(),
        "more than {BOUND} from converged:\n{}",
        wrong.join("\n")
    );
    assert_clean(&lab);
}

/// The last picture of each side once both have converged for a request.
fn converged(engine: &Engine, number: u64, sides: usize) -> Vec<PictureReport> {
    let until = Instant::now() + Duration::from_secs(600);
    let mut last: Vec<Option<PictureReport>> = vec![None; sides];
    loop {
        let left = until.saturating_duration_since(Instant::now());
        match engine
            .reports
            .recv_timeout(left)
            .expect("converged pictures")
        {
            Report::Picture(p) if !p.preview && p.request >= number => {
                let side = p.side;
                last[side] = Some(p);
            }
            Report::Restarted => last = vec![None; sides],
            Report::Failed { diagnostics, .. } => panic!("{diagnostics:?}"),
            Report::DeviceFailed(why) | Report::LoadFailed(why) | Report::Trouble(why) => {
                panic!("{why}")
            }
            _ => {}
        }
        if last.iter().all(|p| p.as_ref().is_some_and(|p| p.left == 0)) {
            return last.into_iter().flatten().collect();
        }
    }
}

#[test]
fn equal_settings_of_a_and_b_differ_in_no_bit() {
    let options = GpuOptions {
        device: Some(common::device()),
        validation: true,
        ..GpuOptions::default()
    };
    let home = Workspace::with(root().to_path_buf(), Some(common::cache()));
    let engine = Engine::start(home.clone(), options, Arc::new(|| {}));
    let mut lit = LightState::of(&scene("cornell"));
    lit.lights[0].color *= 0.5;
    let mut number = 0;
    // One of the other families is enough: the window does the same with each.
    let quick = |case: &Experiment| {
        ![
            "ddgi.ron",
            "lpv.ron",
            "rsm.ron",
            "ssgi_rays.ron",
            "empty.ron",
        ]
        .contains(&case.graph.as_str())
    };
    for case in
        presets(&home)
            .into_iter()
            .filter(quick)
            .chain(["cones", "cone_rays", "lobe_rays"].map(|trace| {
                let small = [
                    ("voxel_dim", "16"),
                    ("shadow_dim", "256"),
                    ("exact_rays", "4"),
                    ("trace", trace),
                ];
                let name = format!("trace {trace}");
                Experiment {
                    name,
                    ..with(
                        Experiment {
                            params: Vec::new(),
                            ..presets(&home).remove(0)
                        },
                        &small,
                    )
                }
            }))
    {
        let side = SideRequest::of(&case);
        let mut request = RenderRequest {
            sides: [Some(side.clone()), None],
            scene: "cornell".into(),
            size: (32, 24),
            bytes: true,
            execution: Execution::Incremental,
            ..RenderRequest::default()
        };
        let mut ask = |request: &RenderRequest| {
            number += 1;
            engine.request(number, request.clone());
            number
        };
        let first = ask(&request);
        let alone = converged(&engine, first, 1).remove(0).bytes;
        // A has frames of other light behind it when B comes.
        request.lights = Some(lit.clone());
        ask(&request);
        request.sides[1] = Some(side);
        let both = ask(&request);
        let pair = converged(&engine, both, 2);
        assert!(
            pair[0].bytes == pair[1].bytes,
            "{}: A and B differ",
            case.name
        );
        assert!(
            pair[0].bytes != alone,
            "{}: the light was not changed",
            case.name
        );
    }
    assert_eq!(engine.stop(Duration::from_secs(60)), Vec::<String>::new());
}

#[test]
fn a_point_of_a_sweep_lands_on_its_dot_in_the_chart() {
    let home = common::home();
    let lab = lab(home.path());
    let cornell = scene("cornell");
    let settings = [("voxel_dim", "16"), ("shadow_dim", "256")];
    let case = with(
        Experiment {
            params: Vec::new(),
            ..presets(&lab.home).remove(0)
        },
        &settings,
    );
    let go_on = &mut |_| ControlFlow::Continue(());
    let reference = Arc::new(gather(&lab, &case, &cornell, 64, Goal::Samples(32), go_on).unwrap());
    // A sweep that asks for fewer frames than light needs.
    let frames = Frames {
        warmup: 1,
        count: 3,
    };
    let references = [(64, reference)];
    let point = measure(
        &lab,
        &mut Warm::default(),
        &case,
        &cornell,
        frames,
        &references,
        Scored::All,
    )
    .unwrap()
    .point;
    let metric = METRICS.iter().find(|m| m.key == "relmse").unwrap();
    let dot = metric.distance(point.scores["total"].get(metric.key));

    let options = GpuOptions {
        device: Some(common::device()),
        validation: true,
        ..GpuOptions::default()
    };
    let home = Workspace::with(home.path().to_path_buf(), Some(common::cache()));
    let engine = Engine::start(home.clone(), options, Arc::new(|| {}));
    let request = RenderRequest {
        sides: [Some(SideRequest::of(&case)), None],
        scene: "cornell".into(),
        size: case.size,
        bytes: true,
        ..RenderRequest::default()
    };
    engine.request(1, request);
    converged(&engine, 1, 1);
    engine.order(Order::MeasureError(
        0,
        ErrorQuery {
            part: "total".into(),
            metric,
            bounces: 64,
            gathered: 0,
        },
    ));
    let shown = loop {
        if let Report::Error(result) = engine
            .reports
            .recv_timeout(Duration::from_secs(600))
            .expect("an error")
        {
            break result
                .result
                .unwrap()
                .error
                .expect("the reference is on the disk")
                .error;
        }
    };
    println!("the dot {dot:.4e}, the picture {shown:.4e}");
    assert!(
        (shown / dot - 1.0).abs() < 1e-6,
        "the dot {dot:.4e}, the picture {shown:.4e}"
    );
    assert_eq!(engine.stop(Duration::from_secs(60)), Vec::<String>::new());
}
