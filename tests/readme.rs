//! Every command of the README and of the tutorials works as written: each line of their `sh` blocks is run in a copy of
//! what they need of the repository, on the software device. Each page starts from a fresh copy, so that it works on its
//! own after the README's build.

mod common;

use common::{cache, device, root};
use std::process::Command;

/// Commands that build, install or test the whole program: `make test` is what runs this, and they take minutes.
const BUILDS: [&str; 4] = ["make demo", "make test", "make slow", "make dist"];

/// The lines of a page's `sh` blocks.
fn commands_of(page: &str) -> Vec<String> {
    let text = std::fs::read_to_string(root().join(page)).unwrap();
    let mut commands = Vec::new();
    let mut inside = false;
    for line in text.lines() {
        match line.trim() {
            "```sh" => inside = true,
            "```" => inside = false,
            command if inside && !command.is_empty() && !command.starts_with('#') => {
                commands.push(command.to_string())
            }
            _ => {}
        }
    }
    commands
}

/// Runs the commands of a page, of which there are at least some.
fn run(page: &str, least: usize) {
    let commands = commands_of(page);
    assert!(
        commands.len() >= least,
        "{page} has lost its commands: {commands:?}"
    );
    let makefile = std::fs::read_to_string(root().join("Makefile")).unwrap();
    let home = common::home();
    for command in &commands {
        if let Some(target) = BUILDS
            .iter()
            .find(|b| command.starts_with(*b))
            .and_then(|b| b.split(' ').nth(1))
        {
            assert!(
                makefile
                    .lines()
                    .any(|l| l.starts_with(&format!("{target}:"))),
                "no `{command}` in the Makefile"
            );
            continue;
        }
        // Pictures take a software device minutes to converge: two frames tell whether the command works.
        let settles = ["conelab render ", "conelab compare ", "conelab ablate "]
            .iter()
            .any(|c| command.contains(c));
        let frames = if settles && !command.contains("--frames") {
            " --frames 2"
        } else {
            ""
        };
        // The pages speak of the release build; tests have their own.
        let command =
            command.replace("target/release/conelab", env!("CARGO_BIN_EXE_conelab")) + frames;
        let started = std::time::Instant::now();
        let output = Command::new("sh")
            .args(["-c", &command])
            .current_dir(home.path())
            .env("CONELAB_CACHE", cache())
            .env("CONELAB_DEVICE", device())
            .env("CONELAB_VALIDATION", "true")
            .output()
            .unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        assert!(
            output.status.success(),
            "{command}\n{}{}",
            text(&output.stdout),
            text(&output.stderr)
        );
        println!("{:.1} s: {command}", started.elapsed().as_secs_f64());
    }
}

#[test]
fn the_readme() {
    let commands = commands_of("README.md");
    for build in ["make demo", "make test", "make slow"] {
        assert!(
            commands.iter().any(|c| c == build),
            "the README does not say `{build}`"
        );
    }
    run("README.md", 8);
}

#[test]
fn first_steps() {
    run("docs/first-steps.md", 5);
}

#[test]
fn compare_methods() {
    run("docs/compare-methods.md", 2);
}

#[test]
fn sweep_to_figure() {
    run("docs/sweep-to-figure.md", 3);
}

#[test]
fn own_scene() {
    run("docs/own-scene.md", 5);
}

#[test]
fn commands_by_task() {
    run("docs/how-to.md", 20);
}
