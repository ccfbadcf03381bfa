//! Incremental execution: after any edits, incremental frames are equal to full ones to the bit, and unchanged passes are
//! skipped.

mod common;

use common::{assert_clean, experiment, floats, lab, mean, number, root, scene};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::{Experiment, PlacedCamera};
use conelab::graph::run::{Execution, FrameTimes};
use conelab::lab::{Lab, Session};
use conelab::scene::Scene;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

const SIZE: (u32, u32) = (48, 36);
const WANTED: [&str; 3] = ["display", "radiance", "direct"];

/// Numbers that look random and are the same in every run (xorshift; Marsaglia 2003).
struct Numbers(u32);

impl Numbers {
    fn below(&mut self, most: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 % most
    }

    fn unit(&mut self) -> f32 {
        self.below(1 << 16) as f32 / 65536.0
    }
}

/// One experiment in frames that do all, and in frames that do what changes.
struct Pair {
    experiment: Experiment,
    scene: Arc<Scene>,
    sides: [Session; 2],
}

fn build(lab: &Lab, e: &Experiment, scene: &Arc<Scene>, old: Option<&Session>) -> Session {
    let loaded = lab.home.load_for(e, scene, &lab.gpu.info).unwrap();
    let wanted = WANTED.map(String::from).to_vec();
    lab.build(
        e,
        &loaded,
        scene.clone(),
        wanted,
        old.map(Session::reusable_parts).as_ref(),
    )
    .unwrap()
}

impl Pair {
    fn new(lab: &Lab, scene_name: &str, settings: &[(&str, &str)]) -> Pair {
        let base = [("voxel_dim", "24"), ("shadow_dim", "256")];
        let (experiment, scene) = (
            experiment(scene_name, SIZE, &[&base[..], settings].concat()),
            scene(scene_name),
        );
        let mut sides = [(); 2].map(|()| build(lab, &experiment, &scene, None));
        sides[1].set_execution(Execution::Incremental);
        Pair {
            experiment,
            scene,
            sides,
        }
    }

    fn set(&mut self, lab: &Lab, name: &str, value: &str) {
        self.experiment.params.push((
            Loc {
                value: name.into(),
                at: At::default(),
            },
            value.into(),
        ));
        for side in &mut self.sides {
            let mut params = side.params.clone();
            params.set(name, value).unwrap();
            assert!(side.set_params(lab, &params).unwrap(), "{name} is a number");
        }
    }

    /// Programs made anew, of what did not change and of what did.
    fn rebuild(&mut self, lab: &Lab) {
        for side in &mut self.sides {
            let mut next = build(lab, &self.experiment, &self.scene, Some(side));
            next.swap_in(side).unwrap();
            *side = next;
        }
        assert_eq!(
            self.sides[1].execution(),
            Execution::Incremental,
            "the program that follows does what this one did"
        );
    }

    fn edit(&mut self, lab: &Lab, home: &Path, numbers: &mut Numbers) -> &'static str {
        let (a, b) = (numbers.unit(), numbers.unit());
        match numbers.below(12) {
            0 | 1 => {
                let placed =
                    PlacedCamera::new((1.2 * a - 0.6, 1.0 + b, 2.6), (0.0, 1.0, -0.5), 60.0);
                self.sides.iter_mut().for_each(|s| s.place_camera(&placed));
                "the camera"
            }
            2 => {
                let mut lights = self.scene.lights.clone();
                (lights[0].color, lights[0].position.x) =
                    (lights[0].color * (0.2 + a), lights[0].position.x + 0.2 * b);
                let sky = self.scene.sky;
                assert!(self.sides.iter_mut().all(|s| s.set_lights(&lights, sky)));
                "a lamp"
            }
            3 => {
                let (lights, sky) = (self.scene.lights.clone(), glam::Vec3::splat(a));
                assert!(self.sides.iter_mut().all(|s| s.set_lights(&lights, sky)));
                "the sky"
            }
            4 => {
                self.set(lab, "exposure", &format!("{a}"));
                "a number that the picture depends on"
            }
            5 => {
                self.set(lab, "light_bias", &format!("{}", 0.1 + 0.3 * a));
                "a number that voxels depend on"
            }
            6 | 7 => {
                self.sides
                    .iter_mut()
                    .for_each(|s| s.set_time(f64::from(3.0 * a)));
                "an actor"
            }
            8 => {
                let dim = if a < 0.5 { "24" } else { "32" };
                self.experiment.params.push((
                    Loc {
                        value: "voxel_dim".into(),
                        at: At::default(),
                    },
                    dim.into(),
                ));
                self.rebuild(lab);
                "the voxels"
            }
            9 => {
                let (file, layer) = (
                    home.join("shaders/voxels/packing.glsl"),
                    if a < 0.5 { "0.12" } else { "0.01" },
                );
                let text = std::fs::read_to_string(&file).unwrap();
                let (before, after) = text.split_once("LAYER = ").unwrap();
                let (_, after) = after.split_once(';').unwrap();
                std::fs::write(&file, format!("{before}LAYER = {layer};{after}")).unwrap();
                self.rebuild(lab);
                "a shader"
            }
            _ => "nothing",
        }
    }

    /// A frame of each; the skipped passes.
    fn frame(&mut self, what: &str) -> BTreeSet<String> {
        let [all, changed] = self.sides.each_mut().map(run);
        assert!(
            all.skipped.is_empty(),
            "{what}: {:?} skipped in full execution",
            all.skipped
        );
        for name in WANTED {
            let [a, b] = self
                .sides
                .each_mut()
                .map(|s| s.texels(name, 0, 0).unwrap().bytes);
            assert!(
                a == b,
                "{what}: '{name}' differs; skipped: {:?}",
                names(&self.sides[1], &changed.skipped)
            );
        }
        names(&self.sides[1], &changed.skipped)
    }
}

/// Writes another number of frames after which passes rest.
fn settles(home: &Path, part: &str, from: &str, to: &str) {
    let file = home.join(format!("passes/parts/{part}.ron"));
    let text = std::fs::read_to_string(&file).unwrap();
    let (from, to) = (format!("settles: \"{from}\""), format!("settles: \"{to}\""));
    assert!(text.contains(&from), "{part} says {from}");
    std::fs::write(&file, text.replace(&from, &to)).unwrap();
}

fn run(session: &mut Session) -> FrameTimes {
    let mut times: Vec<FrameTimes> = session.frame(0.0).unwrap().into_iter().collect();
    times.extend(session.finish().unwrap());
    times.pop().unwrap()
}

fn names(session: &Session, passes: &[usize]) -> BTreeSet<String> {
    passes
        .iter()
        .map(|p| session.graph.passes[*p].value.name.value.clone())
        .collect()
}

const BY_THREADS: [(&str, &str); 3] = [
    ("voxelizer", "compute"),
    ("shadow_map", "compute"),
    ("gbuffer", "compute"),
];
const BY_RASTER: [(&str, &str); 3] = [
    ("voxelizer", "raster"),
    ("shadow_map", "raster"),
    ("gbuffer", "raster"),
];

/// CONELAB_EDITS: edits of each of the six graphs, 16 when absent.
#[test]
fn pictures_are_the_same_whatever_is_edited() {
    let home = common::home();
    let edits = number("CONELAB_EDITS").unwrap_or(16);
    // So that what gathers rests now and then between two edits.
    let bounces = "12 * ceil(bounce_frames / 4) + 13 * (1 + filter_frames) + max(16, 1 + accumulation_rounds) * bounce_frames + filter_frames";
    settles(home.path(), "bounces", bounces, "5");
    settles(
        home.path(),
        "shade",
        "phases + 1 + accumulation_frames",
        "3",
    );
    let lab = lab(home.path());
    let mut seed = 1;
    for path in [BY_THREADS, BY_RASTER] {
        for more in [
            &[][..],
            &[("temporal_factor", "0.5")],
            &[("cascades", "2"), ("volume", "camera")],
        ] {
            let mut pair = Pair::new(&lab, "moving-box", &[&path[..], more].concat());
            let mut numbers = Numbers(0x9e37_79b9 + seed);
            seed += 1;
            let (mut count, mut converged, mut last) = (0, 0, "the start");
            for edit in 0..edits {
                for frame in 0..1 + numbers.below(4) * numbers.below(4) {
                    let what = format!("{path:?} {more:?}, edit {edit}, of {last}, frame {frame}");
                    // A full frame now and then, as timed ones follow a warm-up that skips passes.
                    if numbers.below(8) == 0 {
                        pair.sides[1].set_execution(Execution::Full);
                    }
                    let skipped = pair.frame(&what);
                    pair.sides[1].set_execution(Execution::Incremental);
                    count += skipped.len();
                    converged += usize::from(skipped.contains("gather"));
                }
                last = pair.edit(&lab, home.path(), &mut numbers);
            }
            println!("{path:?} {more:?}: {count} passes skipped, gathering {converged} times");
            // Voxels that average frames, or follow the camera, depend on their own past and never converge.
            let rests = converged > edits / 8 || !more.is_empty();
            assert!(
                count > 5 * edits && rests,
                "{count} passes skipped, gathering {converged} times: nothing was tested"
            );
        }
    }
    assert_clean(&lab);
}

#[test]
fn unchanged_passes_are_skipped() {
    let lab = lab(root());
    for (path, shadow, seen) in [
        (
            BY_THREADS,
            &[
                "shadow clear",
                "shadow triangles",
                "shadow bins",
                "shadow tiles",
            ][..],
            "visibility tiles",
        ),
        (BY_RASTER, &["shadow map"][..], "G-buffer"),
    ] {
        let voxels = [
            "volume",
            "surfel sums clear",
            "surfel scan",
            "surfel assign",
            "voxel merge",
            "surfel planes",
        ];
        // A lamp of one shadow map: layers are drawn one by one, and a clear of one leaves the others.
        let mut pair = Pair::new(&lab, "cornell", &path);
        let skipped = pair.frame("the first");
        assert!(skipped.is_empty(), "{skipped:?}");
        // What the frame before left is kept beside it: both are filled first.
        pair.frame("the second");
        let skipped = pair.frame("the third");
        assert!(
            shadow.iter().chain([&seen]).all(|p| skipped.contains(*p)),
            "{skipped:?}"
        );
        // The camera moves: what is seen is drawn, what the lamp sees is not.
        for number in 0..3 {
            let placed =
                PlacedCamera::new((2.5 + 0.1 * number as f32, 2.5, 9.0), (2.5, 2.5, 0.0), 40.0);
            pair.sides.iter_mut().for_each(|s| s.place_camera(&placed));
            let skipped = pair.frame("the camera moves");
            assert!(
                shadow.iter().chain(&voxels).all(|p| skipped.contains(*p))
                    && !skipped.contains(seen),
                "{skipped:?}"
            );
        }
        // The lamp moves.
        let mut lights = pair.scene.lights.clone();
        lights[0].position.x += 0.1;
        let sky = pair.scene.sky;
        assert!(pair.sides.iter_mut().all(|s| s.set_lights(&lights, sky)));
        let skipped = pair.frame("the lamp moves");
        assert!(shadow.iter().all(|p| !skipped.contains(*p)), "{skipped:?}");
        assert!(voxels.iter().all(|p| skipped.contains(*p)), "{skipped:?}");
        // The exposure is of the picture alone.
        pair.frame("the camera rests");
        pair.frame("and still rests");
        pair.set(&lab, "exposure", "1");
        let skipped = pair.frame("the exposure");
        assert!(
            shadow.iter().chain([&seen]).all(|p| skipped.contains(*p)),
            "{skipped:?}"
        );
    }
    assert_clean(&lab);
}

/// Movement draws what moves into the shadow maps, and nothing else; a lamp draws all.
#[test]
fn movement_leaves_the_shadows_of_what_stays() {
    let lab = lab(root());
    let still = [
        "still shadow clear",
        "still shadow triangles",
        "still shadow bins",
        "still shadow tiles",
    ];
    let moving = [
        "shadow copy",
        "shadow triangles",
        "shadow bins",
        "shadow tiles",
    ];
    let skips = |skipped: &BTreeSet<String>, list: &[&str]| {
        list.iter().filter(|p| skipped.contains(**p)).count()
    };
    for name in ["moving-box", "blade"] {
        let mut pair = Pair::new(&lab, name, &BY_THREADS);
        for number in 0..3 {
            pair.frame(&format!("{name}, frame {number}"));
        }
        for number in 1..4 {
            let time = 0.3 * f64::from(number);
            pair.sides.iter_mut().for_each(|s| s.set_time(time));
            let skipped = pair.frame(&format!("{name}, an actor at {time} s"));
            assert_eq!(
                (skips(&skipped, &still), skips(&skipped, &moving)),
                (4, 0),
                "{name}: {skipped:?}"
            );
        }
        let mut lights = pair.scene.lights.clone();
        lights[0].position.x += 0.1;
        lights[0].direction.x += 0.1;
        let sky = pair.scene.sky;
        assert!(pair.sides.iter_mut().all(|s| s.set_lights(&lights, sky)));
        let skipped = pair.frame(&format!("{name}, a lamp"));
        assert_eq!(
            (skips(&skipped, &still), skips(&skipped, &moving)),
            (0, 0),
            "{name}: {skipped:?}"
        );
    }
    assert_clean(&lab);
}

/// Light that goes round settles and rests; so do the pixels, and then everything.
#[test]
fn what_gathers_over_frames_rests() {
    let lab = lab(root());
    // Something emits in cornell.
    let (gather, rays) = ("gather from emitters", "gather pixels and emitters");
    let gathering = ["bounce queue clear", "bounce history", gather, "inject"];
    for path in [BY_THREADS, BY_RASTER] {
        // Light has gone round 12 times after 25 frames, and 16 times in 32 more.
        const RESTS: usize = 57;
        let settings = [
            ("bounce_frames", "2"),
            ("gather_frames", "4"),
            ("accumulation_rounds", "1"),
        ];
        let mut pair = Pair::new(&lab, "cornell", &[&path[..], &settings].concat());
        let mut pictures = Vec::new();
        let mut skipped = BTreeSet::new();
        for frame in 0..RESTS + 16 {
            skipped = pair.frame(&format!("frame {frame}"));
            assert!(
                frame > RESTS || !skipped.contains(gather),
                "frame {frame}: {skipped:?}"
            );
            pictures.push(mean(&floats(&mut pair.sides[0], "radiance", 0)));
        }
        let passes: BTreeSet<usize> = pair.sides[1]
            .program
            .plan
            .steps
            .iter()
            .map(|s| s.pass)
            .collect();
        assert_eq!(
            skipped,
            names(&pair.sides[1], &passes.into_iter().collect::<Vec<_>>()),
            "everything is skipped"
        );
        // Half of the frames would have done: what is missing at the end is less than that.
        let (half, end) = (pictures[RESTS / 2], pictures[RESTS + 15]);
        println!("{path:?}: light after half of the frames {half}, at the end {end}");
        assert!(
            (half / end - 1.0).abs() < 0.002,
            "light after half of the frames {half}, at the end {end}"
        );
        // The camera moves: pixels gather, voxels rest.
        let placed = PlacedCamera::new((2.4, 2.5, 9.0), (2.5, 2.5, 0.0), 40.0);
        pair.sides.iter_mut().for_each(|s| s.place_camera(&placed));
        for frame in 0..3 {
            let skipped = pair.frame(&format!("the camera moved, frame {frame}"));
            assert!(
                gathering.iter().all(|p| skipped.contains(*p)) && !skipped.contains(rays),
                "{skipped:?}"
            );
        }
        // The lamp moves: in the same frame it is injected, and all gather.
        let mut lights = pair.scene.lights.clone();
        lights[0].color *= 2.0;
        let sky = pair.scene.sky;
        assert!(pair.sides.iter_mut().all(|s| s.set_lights(&lights, sky)));
        let skipped = pair.frame("the lamp is brighter");
        assert!(
            !skipped.contains("inject") && !skipped.contains(rays),
            "{skipped:?}"
        );
        let skipped = pair.frame("the lamp was made brighter");
        assert!(
            gathering.iter().all(|p| !skipped.contains(*p)),
            "{skipped:?}"
        );
    }
    assert_clean(&lab);
}
