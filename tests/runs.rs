//! Experiments from the window: a sweep from a parameter's menu, cancelled and resumed, and a benchmark.

mod common;
#[path = "common/window_driver.rs"]
mod window_driver;

use common::{conelab, fails, table};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::time::Duration;
use window_driver::WindowDriver;

/// Small enough for a software device.
const SMALL: &str = r#"(graph: "cones.ron", scene: "cornell", size: (32, 24), params: { "voxel_dim": 32, "shadow_dim": 256, "bounces": one, "gather_frames": 1, "cone_count": 9 })"#;

/// A run takes as long as its command, on a machine that may be busy.
const LONG: Duration = Duration::from_secs(300);

fn open() -> WindowDriver {
    let mut driver = WindowDriver::open(SMALL, &["--size", "32x24"]);
    driver.first_picture();
    driver.grow_lower_tabs();
    driver
}

/// Puts a text in place of a field's.
fn fill(driver: &mut WindowDriver, role: &str, label: &str, text: &str) {
    driver.click(role, label);
    std::thread::sleep(Duration::from_millis(200));
    driver.keys(&[window_driver::CONTROL, u32::from(b'a')]);
    driver.text(text);
    // Enter.
    driver.keys(&[0xff0d]);
}

fn ended(driver: &mut WindowDriver, since: usize) -> Value {
    let ended = driver.wait_at_most(LONG, since, "the run's end", |e| e["event"] == "run ended");
    assert_eq!(ended["ok"], true, "{ended}");
    ended
}

/// The folder of the run that started.
fn folder(driver: &mut WindowDriver, since: usize) -> PathBuf {
    let started = driver.event(since, "run started");
    PathBuf::from(started["folder"].as_str().unwrap())
}

fn points(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder.join("points"))
        .into_iter()
        .flatten();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn a_sweep_from_a_parameters_menu_is_that_of_the_command_line_and_resumes_after_a_cancel() {
    let mut driver = open();
    driver.click("", "search parameters");
    driver.text("cone_count");
    driver.right_click("", "cone_count");
    driver.click("Button", "Sweep…");
    fill(&mut driver, "", "values of the sweep", "7, 9");
    fill(&mut driver, "", "frames of the run", "2");
    fill(&mut driver, "", "reference samples of the run", "32");
    let mark = driver.now();
    driver.click("Button", "Start");
    let folder = folder(&mut driver, mark);
    driver.wait_at_most(LONG, mark, "a finished point", |e| {
        e["event"] == "run progress" && e["done"] == 1
    });
    driver.click("Button", "cancel the run");
    driver.event(mark, "run cancelled");
    assert_eq!(points(&folder).len(), 1);
    assert!(!folder.join("sweep.csv").exists());

    let mark = driver.now();
    let name = folder.file_name().unwrap().to_string_lossy().into_owned();
    driver.click("Button", &format!("Resume {name}"));
    ended(&mut driver, mark);
    let mine = table(&folder.join("sweep.csv"));
    assert_eq!(mine.len(), 2);

    // The chart has them without being asked to.
    let mark = driver.now();
    driver.click("", "Chart");
    driver.wait(mark, "both dots", |e| {
        e["event"] == "dots" && e["dots"].as_array().is_some_and(|d| d.len() == 2)
    });

    // A failed point is measured again on request.
    let failed = folder.join("points").join(&points(&folder)[0]);
    let mut record: Value = serde_json::from_slice(&std::fs::read(&failed).unwrap()).unwrap();
    record["outcome"] = serde_json::json!({ "failed": "the device was lost" });
    std::fs::write(&failed, record.to_string()).unwrap();
    let file = folder.join(format!("{name}.ron"));
    let mut command = conelab(driver.home.path());
    let said = fails(command.arg("sweep").arg(&file).arg("-o").arg(&folder));
    assert!(
        said.contains("1 points failed") && said.contains("--again"),
        "{said}"
    );
    driver.click("", "Runs");
    driver.click("Button", "refresh runs");
    let mark = driver.now();
    driver.click("Button", &format!("Retry failed {name}"));
    ended(&mut driver, mark);
    let outcomes = table(&folder.join("sweep.csv"));
    assert!(
        outcomes.iter().all(|row| row["outcome"] == "done"),
        "{outcomes:?}"
    );
    let mine = outcomes;

    // The same file on the command line measures the same points, and says how far it is.
    let again = driver.home.path().join("again");
    let mut command = conelab(driver.home.path());
    command.arg("sweep").arg(folder.join(format!("{name}.ron")));
    let output = command.arg("-o").arg(&again).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("1 of 2 finished, ") && said.contains("2 of 2 finished, "),
        "{said}"
    );
    assert_eq!(points(&again), points(&folder));
    assert_eq!(table(&again.join("sweep.csv")), mine);
}

#[test]
fn a_benchmark_runs_from_the_window() {
    let mut driver = open();
    driver.click("", "Runs");
    driver.click("", "Benchmark");
    fill(&mut driver, "", "frames of the run", "2");
    fill(&mut driver, "", "rounds of the run", "1");
    let mark = driver.now();
    driver.click("Button", "Start");
    let folder = folder(&mut driver, mark);
    ended(&mut driver, mark);
    assert!(folder.join("bench.json").is_file() && folder.join("stages.svg").is_file());
    driver.texts_until("the table", |texts| texts.iter().any(|t| t == "bench"));
}
