//! Every command of the README and of the long tour works as written: each line of their `sh` blocks is run from the
//! a copy of what they need of the repository, on the software device, those of the README first.

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

#[test]
fn every_command_of_the_readme_and_of_the_tour_works() {
    let readme = commands_of("README.md");
    let tour = commands_of("docs/tour.md");
    assert!(
        readme.len() >= 10,
        "the README has lost its tour: {readme:?}"
    );
    assert!(
        tour.len() >= 20,
        "the long tour has lost its commands: {tour:?}"
    );
    for build in ["make demo", "make test", "make slow"] {
        assert!(
            readme.iter().any(|c| c == build),
            "the README does not say `{build}`"
        );
    }
    let makefile = std::fs::read_to_string(root().join("Makefile")).unwrap();
    let home = common::home();
    // The tour goes on with what the README's commands left.
    for command in readme.iter().chain(&tour) {
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
        // Pictures settle over 32 frames, which take a software device minutes: two tell whether the command works.
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
    }
}
