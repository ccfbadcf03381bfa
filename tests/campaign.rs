//! What campaigns decide without a device: searches, verdicts, fronts, plain values, samples, warming up.

use conelab::campaign::ablation::{Change, changes};
use conelab::campaign::bench::{Verdict, judge};
use conelab::campaign::fit::{Limits, Stop, Trial, search};
use conelab::campaign::report::pareto;
use conelab::campaign::sweep::Sweep;
use conelab::graph::param::{Decl, Params, Value};
use conelab::measure::WarmUp;
use conelab::vulkan::{DeviceInfo, Features};
use proptest::prelude::*;

/// Costs and errors as renderers have them: more of each axis costs more and helps less and less, and two axes help
/// only together.
fn renderer(place: &[usize]) -> Trial {
    let n: Vec<f64> = place.iter().map(|i| *i as f64).collect();
    let cost = 1.0 + 2f64.powf(n[0]) * 0.3 + (1.0 + n[1]) * (1.0 + 0.5 * n[2]) + 0.2 * n[3];
    let together = 1.0 / (1.0 + n[1].min(2.0 * n[2]));
    Trial {
        cost,
        bounded: 0.02 + 0.5 * 0.5f64.powf(n[0]) + 0.3 * together + 0.05 / (1.0 + n[3]),
    }
}

const SIZES: [usize; 4] = [6, 7, 5, 4];

fn all() -> Vec<Trial> {
    let count: usize = SIZES.iter().product();
    let place = |mut i: usize| {
        SIZES.map(|n| {
            let at = i % n;
            i /= n;
            at
        })
    };
    (0..count).map(|i| renderer(&place(i))).collect()
}

#[test]
fn is_within_a_twentieth_of_the_whole_grid() {
    let grid = all();
    for bound in [0.095, 0.11, 0.15, 0.2, 0.3, 0.5] {
        let best = grid
            .iter()
            .filter(|t| t.bounded <= bound)
            .map(|t| t.cost)
            .fold(f64::INFINITY, f64::min);
        for start in [[0, 0, 0, 0], [5, 6, 4, 3], [2, 3, 2, 1]] {
            let limits = Limits {
                bound,
                evaluations: 250,
                least_gain: 0.005,
            };
            let found = search::<()>(&SIZES, &start, limits, &mut |p| Ok(Some(renderer(p))))
                .unwrap()
                .unwrap();
            assert!(found.trial.bounded <= bound, "{bound} {start:?}: {found:?}");
            assert!(
                found.trial.cost <= 1.05 * best,
                "{bound} {start:?}: {} against {best}",
                found.trial.cost
            );
            assert!(
                found.tried.len() < grid.len() / 4,
                "{} evaluations",
                found.tried.len()
            );
            assert_eq!(found.stop, Stop::Local);
        }
    }
}

/// Passes and parts of a renderer on a grid of twelve thousand: shadows whose finest map costs more than all the rest,
/// voxels, their coverage, cones and steps. Three axes must change together to leave the nearest optimum.
fn passes(place: &[usize]) -> Trial {
    let dim = [64.0, 96.0, 128.0, 160.0, 192.0, 256.0][place[1]];
    let cones = [4.0, 5.0, 6.0, 7.0, 9.0][place[3]];
    let step = [2.0, 1.5, 1.0, 0.7][place[4]];
    let exact = place[2] == 1;
    let shadows = [(0.2, 0.020), (0.65, 0.0105), (2.25, 0.0045), (12.9, 0.0025)][place[0]];
    let cost = 0.9
        + shadows.0
        + 0.3
        + dim / 256.0 * if exact { 1.9 } else { 0.7 }
        + 0.02 * cones / step
        + [0.0, 0.05, 0.1][place[5]];
    let voxels = 0.012 * (64.0f64 / dim).powf(0.6) * if exact || dim > 150.0 { 1.0 } else { 1.4 };
    let cone = 0.05 / cones * (0.8 + 0.2 * step) * [1.0, 0.9, 0.97][place[5]];
    Trial {
        cost,
        bounded: 0.02 + shadows.1 + voxels + cone,
    }
}

#[test]
fn leaves_a_local_optimum_where_several_things_must_change_at_once() {
    const SIZES: [usize; 6] = [4, 6, 2, 5, 4, 3];
    let count: usize = SIZES.iter().product();
    let place = |mut i: usize| {
        SIZES.map(|n| {
            let at = i % n;
            i /= n;
            at
        })
    };
    let grid: Vec<Trial> = (0..count).map(|i| passes(&place(i))).collect();
    for bound in [0.040, 0.042, 0.045, 0.048, 0.051, 0.055, 0.06] {
        let best = grid
            .iter()
            .filter(|t| t.bounded <= bound)
            .map(|t| t.cost)
            .fold(f64::INFINITY, f64::min);
        for start in [[2, 3, 1, 4, 2, 0], [3, 5, 1, 4, 3, 0], [0, 0, 0, 0, 0, 0]] {
            let limits = Limits {
                bound,
                evaluations: 400,
                least_gain: 0.005,
            };
            let found = search::<()>(&SIZES, &start, limits, &mut |p| Ok(Some(passes(p))))
                .unwrap()
                .unwrap();
            println!(
                "{bound} {start:?}: {:.3} for {best:.3}, {} tried",
                found.trial.cost,
                found.tried.len()
            );
            assert!(
                found.trial.bounded <= bound && found.trial.cost <= 1.05 * best,
                "{bound} {start:?}: {found:?}"
            );
        }
    }
}

/// Two dear values of the first axis stand between its ends and its middle, and there the second axis does the
/// opposite of what it does everywhere else.
fn wall(place: &[usize]) -> Trial {
    let n = place[1] as f64;
    match place[0] {
        2 => Trial {
            cost: 9.0 - n,
            bounded: 0.19 - 0.01 * n,
        },
        1 | 3 => Trial {
            cost: 50.0 + n,
            bounded: 0.05 + 0.04 * n,
        },
        _ => Trial {
            cost: 10.0 + n,
            bounded: 0.05 + 0.04 * n,
        },
    }
}

#[test]
fn walks_on_from_what_was_tried_behind_a_wall() {
    let limits = Limits {
        bound: 0.2,
        evaluations: 100,
        least_gain: 0.01,
    };
    for start in [[4, 3], [0, 0], [3, 8]] {
        let found = search::<()>(&[5, 9], &start, limits, &mut |p| Ok(Some(wall(p))))
            .unwrap()
            .unwrap();
        assert_eq!(
            (&found.place[..], found.trial),
            (&[2, 8][..], wall(&[2, 8])),
            "{start:?}"
        );
    }
}

/// Costs and errors without any order.
fn noise(place: &[usize], seed: u64) -> Trial {
    let hash = |n: u64| {
        let bits = place.iter().fold(seed + n, |h, i| {
            (h ^ *i as u64)
                .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                .rotate_left(29)
        });
        (bits >> 40) as f64 / (1u64 << 24) as f64
    };
    Trial {
        cost: 1.0 + hash(0),
        bounded: hash(1),
    }
}

#[test]
fn returns_the_best_of_what_it_tried() {
    for seed in 0..40 {
        for bound in [0.0, 0.3, 0.9] {
            let limits = Limits {
                bound,
                evaluations: 100,
                least_gain: 0.2,
            };
            let found = search::<()>(&SIZES, &[2, 3, 2, 1], limits, &mut |p| {
                Ok(Some(noise(p, seed)))
            });
            let found = found.unwrap().unwrap();
            let tried = || found.tried.iter().filter_map(|t| t.trial);
            let within = tried()
                .filter(|t| t.bounded <= bound)
                .map(|t| t.cost)
                .min_by(f64::total_cmp);
            match within {
                Some(least) => assert_eq!(
                    (found.trial.cost, found.trial.bounded <= bound),
                    (least, true)
                ),
                None => {
                    assert_eq!(
                        Some(found.trial.bounded),
                        tried().map(|t| t.bounded).min_by(f64::total_cmp)
                    );
                }
            }
        }
    }
}

#[test]
fn says_that_a_bound_cannot_be_reached() {
    let limits = Limits {
        bound: 0.01,
        evaluations: 500,
        least_gain: 0.001,
    };
    let found = search::<()>(&SIZES, &[0, 0, 0, 0], limits, &mut |p| {
        Ok(Some(renderer(p)))
    })
    .unwrap()
    .unwrap();
    assert_eq!(found.stop, Stop::Unreachable);
    let least = all()
        .iter()
        .map(|t| t.bounded)
        .fold(f64::INFINITY, f64::min);
    assert!(
        found.trial.bounded < 1.2 * least,
        "{} against {least}",
        found.trial.bounded
    );
}

#[test]
fn goes_around_settings_that_cannot_be_run_and_keeps_to_its_evaluations() {
    let mut count = 0;
    let limits = Limits {
        bound: 0.15,
        evaluations: 12,
        least_gain: 0.005,
    };
    let found = search::<()>(&SIZES, &[1, 1, 1, 1], limits, &mut |p| {
        count += 1;
        Ok((p[3] != 2).then(|| renderer(p)))
    });
    let found = found.unwrap().unwrap();
    assert_eq!((count, found.tried.len()), (12, 12));
    assert_eq!(found.stop, Stop::Evaluations);
    let nothing = search::<()>(&SIZES, &[1, 1, 1, 1], limits, &mut |_| Ok(None)).unwrap();
    assert!(nothing.is_none());
}

#[test]
fn a_stage_is_slower_when_it_is_beyond_tolerance_floor_and_scatter() {
    let cases: [(&[f64], &[f64], Verdict); 9] = [
        (&[5.0, 5.1, 5.0], &[5.4, 5.6, 5.5], Verdict::Same),
        (&[5.0, 5.1, 5.0], &[5.6, 5.7, 5.6], Verdict::Slower),
        (&[5.0, 5.1, 5.0], &[4.5, 4.6, 4.4], Verdict::Faster),
        // One good round is enough: what disturbs only adds time.
        (&[5.0, 5.1, 5.0], &[9.0, 5.2, 7.0], Verdict::Same),
        // One bad recorded round hides nothing.
        (&[5.0, 9.0, 5.1], &[6.8, 6.9, 6.8], Verdict::Slower),
        // A recording of which half was disturbed says little.
        (&[5.0, 9.0, 8.0], &[6.8, 6.9, 6.8], Verdict::Noisy),
        // Twice as long, but 10 us.
        (&[0.01, 0.01, 0.01], &[0.02, 0.02, 0.02], Verdict::Same),
        (&[0.0], &[0.01], Verdict::Same),
        (&[0.0], &[1.0], Verdict::Slower),
    ];
    for (recorded, now, verdict) in cases {
        assert_eq!(judge(recorded, now, 0.1), verdict, "{recorded:?} {now:?}");
    }
    assert_eq!(judge(&[5.0], &[5.6], 0.2), Verdict::Same);
}

proptest! {
    /// Against the definition, by comparing all pairs.
    #[test]
    fn nothing_beats_the_front_and_it_beats_or_equals_the_rest(
        points in prop::collection::vec((0u8..20, 0u8..20), 0..60),
    ) {
        let points: Vec<(f64, f64)> = points.iter().map(|p| (f64::from(p.0), f64::from(p.1))).collect();
        let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
        let front = pareto(&points);
        for (i, p) in points.iter().enumerate() {
            let beaten = points.iter().any(|q| beats(*q, *p));
            let first = points.iter().position(|q| q == p) == Some(i);
            prop_assert_eq!(front.contains(&i), !beaten && first);
        }
        prop_assert!(front.windows(2).all(|w| points[w[0]].0 < points[w[1]].0));
    }
}

fn params(decls: &[&str]) -> Params {
    let param = |d: &&str| {
        conelab::diagnostics::options()
            .from_str::<Decl>(d)
            .unwrap()
            .param
            .unwrap()
    };
    Params::new(decls.iter().map(param).collect())
}

#[test]
fn what_is_plain_already_or_plainer_is_left_out() {
    let mut params = params(&[
        r#"Int(name: "grid", default: 160, plain: 128, help: "h")"#,
        r#"Float(name: "step", default: 1.0, plain: 1.5, help: "h")"#,
        r#"Float(name: "shift", default: 0.0, plain: 0.0, help: "h")"#,
        r#"Bool(name: "turn", default: false, plain: false, help: "h")"#,
        r#"Choice(name: "filter", options: ["wide", "near"], plain: "near", help: "h")"#,
        r#"Int(name: "count", default: 3, help: "h")"#,
    ]);
    let named = |params: &_| -> Vec<String> {
        changes(params, &[])
            .unwrap()
            .iter()
            .map(Change::setting)
            .collect()
    };
    assert_eq!(named(&params), ["grid=128", "step=1.5", "filter=near"]);
    for (name, value) in [
        ("grid", "64"),
        ("step", "2.0"),
        ("shift", "-1.0"),
        ("turn", "true"),
        ("filter", "near"),
    ] {
        params.set(name, value).unwrap();
    }
    assert_eq!(named(&params), ["shift=0.0", "turn=false"]);
    // A graph whose own default is plainer than what is declared.
    let grid = params.index("grid").unwrap();
    (params.list[grid].default, params.values[grid]) = (Value::Int(32), Value::Int(32));
    assert_eq!(named(&params), ["shift=0.0", "turn=false"]);
    assert!(
        changes(&params, &["grid".into()])
            .unwrap_err()
            .to_string()
            .contains("plain value (128) already")
    );
    assert!(
        changes(&params, &["count".into()])
            .unwrap_err()
            .to_string()
            .contains("has no plain value")
    );
}

/// Samples of a sweep file as points of the unit cube.
fn samples(count: usize, seed: u64) -> Vec<[f64; 3]> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sample.ron");
    let of =
        r#""bias": Uniform(0, 1), "diffuse_aperture": Uniform(0, 1), "lod_offset": Uniform(0, 1)"#;
    let experiment = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/cones.ron");
    let axis = format!("Sample(count: {count}, seed: {seed}, of: {{ {of} }})");
    std::fs::write(
        &path,
        format!("(experiments: [{experiment:?}], axes: [{axis}])"),
    )
    .unwrap();
    let sweep = Sweep::read(&path).unwrap();
    let value = |labels: &[(String, String)], i: usize| labels[i].1.parse::<f64>().unwrap();
    let points = (0..sweep.len()).map(|i| sweep.point(i).unwrap().1);
    points
        .map(|labels| [0, 1, 2].map(|i| value(&labels, i)))
        .collect()
}

#[test]
fn every_interval_of_every_axis_holds_one_sample() {
    let points = samples(17, 5);
    assert_eq!(points, samples(17, 5));
    assert_ne!(points, samples(17, 6));
    for axis in 0..3 {
        let mut hit: Vec<usize> = points.iter().map(|p| (p[axis] * 17.0) as usize).collect();
        hit.sort_unstable();
        assert_eq!(hit, (0..17).collect::<Vec<_>>());
    }
}

/// A device whose clock rises threefold after 60 ms of work, and which is two frames behind.
#[derive(Default)]
struct Idle {
    worked: f64,
    behind: Vec<f64>,
}

impl Idle {
    fn frame(&mut self, work: f64) -> f64 {
        let ms = if self.worked < 60.0 { 3.0 * work } else { work };
        self.worked += ms;
        self.behind.insert(0, ms);
        self.behind.get(2).copied().unwrap_or(0.0)
    }
}

fn device(kind: &'static str, timestamp_ns: f64) -> DeviceInfo {
    let mut device = DeviceInfo::imaginary(Features::default());
    (device.kind, device.timestamp_ns) = (kind, timestamp_ns);
    device
}

#[test]
fn frames_are_measured_at_the_clock_of_a_device_that_works() {
    for work in [0.02, 0.5, 4.0, 70.0] {
        let mut idle = Idle::default();
        let after_three = (0..4).map(|_| idle.frame(work)).last().unwrap();
        assert!(
            after_three > 2.0 * work || work > 10.0,
            "a count of frames alone finds a low clock"
        );
        let mut idle = Idle::default();
        let warm = WarmUp::of(&device("discrete", 1.0), 3);
        let run = warm.run(&mut || Ok::<_, ()>(idle.frame(work))).unwrap();
        assert!(
            run >= 3 && idle.worked >= 100.0,
            "{run} frames, {} ms",
            idle.worked
        );
        assert!(
            idle.worked < 100.0 + 10.0 * work,
            "{run} frames, {} ms",
            idle.worked
        );
        assert_eq!(idle.frame(work).min(idle.behind[0]), work);
    }
}

#[test]
fn frames_alone_count_on_software_devices_and_without_times() {
    for device in [device("cpu", 1.0), device("discrete", 0.0)] {
        assert_eq!(WarmUp::of(&device, 3).run(&mut || Ok::<_, ()>(0.0)), Ok(3));
    }
    let discrete = WarmUp::of(&device("discrete", 1.0), 20);
    assert_eq!(discrete.run(&mut || Ok::<_, ()>(50.0)), Ok(20));
    assert_eq!(
        discrete.run(&mut || Ok::<_, ()>(0.0)),
        Ok(10_000),
        "it is given up"
    );
    assert_eq!(discrete.run(&mut || Err("lost")), Err("lost"));
}
