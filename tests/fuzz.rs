//! Mutated files of every kind that the program reads: each opens or is refused, without a panic, within ten seconds and
//! two gigabytes. A scene that opens can be rendered, and some are exported and read back.
//!
//! A short run by default. CONELAB_FUZZ is another number of inputs and CONELAB_FUZZ_SEED another place to begin; an input
//! that fails is kept under `target/tmp/fuzz`, and its number is its seed.

mod common;
#[macro_use]
#[path = "fbx_files/text.rs"]
#[allow(dead_code, reason = "the fuzz test uses a part")]
mod text;
#[path = "fuzz/fbx.rs"]
mod fbx;
#[path = "fuzz/holds.rs"]
mod holds;
#[path = "fuzz/mutate.rs"]
mod mutate;
#[path = "fuzz/seeds.rs"]
mod seeds;

use common::{number, root};
use conelab::camera_path::CameraPath;
use conelab::campaign::bench;
use conelab::campaign::stability::Suite;
use conelab::campaign::sweep::{self, Sweep};
use conelab::experiment::Experiment;
use conelab::graph::Graph;
use conelab::graph::load::Folders;
use conelab::lab::load;
use conelab::measure::reference;
use conelab::results::capture;
use conelab::scene::Scene;
use conelab::shader::{check_sizes, read_module, strip_outputs};
use conelab::vulkan::Stage;
use mutate::{Random, mutated};
use seeds::{Kind, Seed};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Inputs where nobody says how many.
const INPUTS: usize = 20_000;
/// Where nobody says how many: no longer than this.
const SHORT: Duration = Duration::from_secs(45);
/// One accepted scene of so many is exported and read back.
const EXPORTED: usize = 8;
const LONGEST: Duration = Duration::from_secs(10);
const MAX_MEMORY: u64 = 2 << 30;

/// Begins the message about an accepted file that holds what it must not.
const HOLDS: &str = "accepted, but ";

/// The graphs that experiments and references are of.
struct Graphs {
    method: Arc<Graph>,
    reference: Arc<Graph>,
}

/// Reads a file as the program would; what it says where it refuses it. `thorough`: an accepted scene is exported too.
fn read(kind: Kind, path: &Path, graphs: &Graphs, thorough: bool) -> Result<(), String> {
    let told = |errors: Vec<conelab::diagnostics::Diagnostic>| {
        errors.iter().map(ToString::to_string).collect::<String>()
    };
    match kind {
        Kind::Scene => {
            let scene = Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(()))
                .map_err(|e| e.to_string())?;
            drop(scene.summary());
            let warnings = scene.warnings.join("\n");
            if warnings.contains("gave up") {
                return Err(warnings);
            }
            let folder = path.parent().unwrap();
            let model = path.extension().is_some_and(|e| e != "ron");
            let exported = || thorough.then(|| holds::loss(&scene, folder)).flatten();
            let wrong = holds::mistake(&scene, bytes_of(folder), model).or_else(exported);
            wrong.map_or(Ok(()), |wrong| Err(format!("{HOLDS}{wrong}")))
        }
        Kind::Graph => {
            let folders = Folders {
                passes: root().join("passes"),
                shaders: root().join("shaders"),
            };
            load(path, &folders).map(drop).map_err(told)
        }
        Kind::Experiment => {
            let experiment = Experiment::read(path).map_err(told)?;
            experiment
                .params_over(&graphs.method.params)
                .map(drop)
                .map_err(|e| e.to_string())
        }
        Kind::Sweep => {
            let sweep = Sweep::read(path).map_err(told)?;
            (0..sweep.len().min(8))
                .try_for_each(|i| sweep.point(i).map(drop))
                .map_err(told)
        }
        Kind::Suite => Suite::read(path).map(drop).map_err(told),
        Kind::Path => {
            let path = CameraPath::read(path).map_err(told)?;
            [-1.0, 0.0, 0.5, 1e9]
                .iter()
                .for_each(|time| assert!(path.at(*time).fov_y > 0.0));
            Ok(())
        }
        Kind::Capture => {
            let folder = path.parent().unwrap();
            let manifest = capture::Manifest::read(folder).map_err(|e| e.to_string())?;
            assert!(capture::changes(folder, &manifest).len() <= manifest.files.len() + 2);
            assert!(
                capture::list(folder.parent().unwrap())
                    .iter()
                    .any(|s| s.folder == folder)
            );
            Experiment::read(&folder.join("experiment.ron")).map_err(told)?;
            let folders = Folders {
                passes: folder.join("graph/passes"),
                shaders: folder.join("graph/shaders"),
            };
            load(&folders.passes.join("graph.ron"), &folders)
                .map(drop)
                .map_err(told)
        }
        Kind::Reference => {
            let read = reference::read(path.parent().unwrap(), seeds::REFERENCE, &graphs.reference);
            let Some(reference) = read.map_err(|e| e.to_string())? else {
                return Err("no sums".into());
            };
            let size = reference.parts.values().all(|p| p.mean.rgb.len() == 12);
            if size && reference.samples == 32 {
                Ok(())
            } else {
                Err(format!("{HOLDS}it has other samples"))
            }
        }
        Kind::Module => match read_module(&std::fs::read(path).unwrap(), Stage::Fragment) {
            Some((words, _)) if check_sizes(&words, &[]).is_err() => {
                Err(format!("{HOLDS}it is too large"))
            }
            Some((words, _)) => {
                drop(strip_outputs(&words, &[0]));
                Ok(())
            }
            None => Err("no module".into()),
        },
        Kind::Points => sweep::collect(&[path.parent().unwrap().into()])
            .map(drop)
            .map_err(|e| e.to_string()),
        Kind::Times => bench::Record::read(path)
            .map(drop)
            .map_err(|e| e.to_string()),
        Kind::Picture => conelab::results::picture::read_linear(path)
            .map(drop)
            .map_err(|e| e.to_string()),
    }
}

/// Bytes of the files in a folder.
fn bytes_of(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).unwrap().flatten();
    entries
        .filter_map(|e| e.metadata().ok())
        .filter(|m| m.is_file())
        .map(|m| m.len() as usize)
        .sum()
}

/// Largest memory that this process has had, bytes.
fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status
        .lines()
        .find_map(|l| l.strip_prefix("VmHWM:"))
        .unwrap_or_default();
    line.trim()
        .trim_end_matches(" kB")
        .parse::<u64>()
        .unwrap_or(0)
        << 10
}

/// What all threads share.
struct Run {
    next: AtomicUsize,
    /// When each thread began its input, ms; 0 between two.
    busy: Vec<AtomicU64>,
    /// Inputs, and those that were read, by what was mutated.
    counts: Mutex<BTreeMap<String, (usize, usize)>>,
    /// Panics of other people's readers, which are told as errors, and how often.
    caught: Mutex<BTreeMap<String, usize>>,
    failures: Mutex<Vec<String>>,
}

fn one(run: &Run, seed: &Seed, folder: &Path, bytes: &[u8], number: usize, graphs: &Graphs) {
    std::fs::write(folder.join(seed.mutated), bytes).unwrap();
    let begun = Instant::now();
    let thorough = number.is_multiple_of(EXPORTED);
    let result = catch_unwind(AssertUnwindSafe(|| {
        read(seed.kind, &folder.join(seed.opened), graphs, thorough)
    }));
    let name = format!("{} in {}", seed.mutated, seed.opened);
    let mut wrong = None;
    let mut ok = false;
    match result {
        Ok(Ok(())) => ok = true,
        Ok(Err(text)) if text.starts_with(HOLDS) => wrong = Some(text),
        Ok(Err(text)) => {
            if let Some((_, rest)) = text.split_once("gave up (") {
                let what = rest.split(')').next().unwrap_or_default().to_owned();
                // In this crate it is a mistake all the same.
                wrong = what.contains("at src/").then(|| format!("a panic: {what}"));
                *run.caught.lock().unwrap().entry(what).or_default() += 1;
            }
        }
        Err(_) => wrong = Some("a panic".into()),
    }
    if begun.elapsed() > LONGEST {
        wrong = Some(format!("{:?}", begun.elapsed()));
    }
    if peak_memory() > MAX_MEMORY {
        wrong = Some(format!("{} MB of memory", peak_memory() >> 20));
    }
    let mut counts = run.counts.lock().unwrap();
    let count = counts.entry(name.clone()).or_default();
    *count = (count.0 + 1, count.1 + usize::from(ok));
    if let Some(wrong) = wrong {
        let kept = keep(seed, bytes, number);
        run.failures.lock().unwrap().push(format!(
            "input {number}, {name}: {wrong}; kept as {}",
            kept.display()
        ));
    }
}

fn keep(seed: &Seed, bytes: &[u8], number: usize) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{number}-{}", seed.mutated.replace('/', "-")));
    std::fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn mutated_files_are_read_or_refused() {
    let asked = number("CONELAB_FUZZ");
    let (inputs, first) = (
        asked.unwrap_or(INPUTS),
        number("CONELAB_FUZZ_SEED").unwrap_or(0),
    );
    let seeds = seeds::all();
    let folders = Folders {
        passes: root().join("passes"),
        shaders: root().join("shaders"),
    };
    let graph = |name: &str| Arc::new(load(&folders.passes.join(name), &folders).unwrap());
    let graphs = Graphs {
        method: graph("rays.ron"),
        reference: graph("reference.ron"),
    };
    let whole = tempfile::tempdir().unwrap();
    seeds::write(whole.path());
    for Seed {
        kind,
        opened,
        mutated,
        ..
    } in &seeds
    {
        assert_eq!(
            read(*kind, &whole.path().join(opened), &graphs, true),
            Ok(()),
            "{mutated}, as it is"
        );
    }
    let threads = std::thread::available_parallelism()
        .map_or(1, usize::from)
        .min(8);
    let run = Run {
        next: AtomicUsize::new(0),
        busy: (0..threads).map(|_| AtomicU64::new(0)).collect(),
        counts: Mutex::default(),
        caught: Mutex::default(),
        failures: Mutex::default(),
    };
    let begun = Instant::now();
    let ended = |number: usize| number >= inputs || asked.is_none() && begun.elapsed() > SHORT;
    std::thread::scope(|scope| {
        for thread in 0..threads {
            let (run, seeds, graphs, ended) = (&run, &seeds, &graphs, &ended);
            scope.spawn(move || {
                let folder = tempfile::tempdir().unwrap();
                seeds::write(folder.path());
                loop {
                    let number = run.next.fetch_add(1, Relaxed);
                    if ended(number) || run.failures.lock().unwrap().len() >= 10 {
                        break;
                    }
                    let mut random = Random::new((first + number) as u64);
                    let seed = &seeds[random.below(seeds.len())];
                    let other = &seeds[random.below(seeds.len())].bytes;
                    let bytes = mutated(&mut random, &seed.bytes, other);
                    run.busy[thread].store(begun.elapsed().as_millis() as u64 + 1, Relaxed);
                    one(run, seed, folder.path(), &bytes, first + number, graphs);
                    run.busy[thread].store(0, Relaxed);
                    std::fs::write(folder.path().join(seed.mutated), &seed.bytes).unwrap();
                }
                run.busy[thread].store(u64::MAX, Relaxed);
            });
        }
        // An input that never ends would keep the threads from being joined.
        while run.busy.iter().any(|b| b.load(Relaxed) != u64::MAX) {
            std::thread::sleep(Duration::from_millis(50));
            let now = begun.elapsed().as_millis() as u64;
            let hangs = |b: &AtomicU64| {
                (1..u64::MAX).contains(&b.load(Relaxed)) && b.load(Relaxed) + 60_000 < now
            };
            if run.busy.iter().any(hangs) {
                eprintln!(
                    "an input up to number {} takes more than a minute",
                    first + run.next.load(Relaxed)
                );
                std::process::abort();
            }
        }
    });
    let counts = run.counts.into_inner().unwrap();
    let (all, read) = counts
        .values()
        .fold((0, 0), |sum, c| (sum.0 + c.0, sum.1 + c.1));
    eprintln!(
        "{all} inputs from {first} on in {:.0?}, {read} read, peak {} MB",
        begun.elapsed(),
        peak_memory() >> 20
    );
    counts
        .iter()
        .for_each(|(name, (all, read))| eprintln!("  {name}: {read} of {all} read"));
    run.caught
        .into_inner()
        .unwrap()
        .iter()
        .for_each(|(what, n)| eprintln!("  {n} times a reader gave up: {what}"));
    let failures = run.failures.into_inner().unwrap();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(all > 100, "only {all} inputs in {:?}", begun.elapsed());
}
