//! Every command of the README works as written: each line of its `sh` blocks is run from the repository's root, on the
//! software device.

mod common;

use common::{cache, device, root};
use std::process::Command;

/// Commands that build, install or test the whole program: `make test` is what runs this, and they take minutes.
const BUILDS: [&str; 3] = ["make demo", "make test", "make dist"];

#[test]
fn every_command_of_the_readme_works() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    let mut commands = Vec::new();
    let mut inside = false;
    for line in readme.lines() {
        match line.trim() {
            "```sh" => inside = true,
            "```" => inside = false,
            command if inside && !command.is_empty() && !command.starts_with('#') => commands.push(command),
            _ => {}
        }
    }
    assert!(commands.len() >= 10, "the README has lost its tour: {commands:?}");
    for build in ["make demo", "make test"] {
        assert!(commands.contains(&build), "the README does not say `{build}`");
    }
    let makefile = std::fs::read_to_string(root().join("Makefile")).unwrap();
    for command in commands {
        if let Some(target) = BUILDS.iter().find(|b| command.starts_with(*b)).and_then(|b| b.split(' ').nth(1)) {
            assert!(makefile.lines().any(|l| l.starts_with(&format!("{target}:"))), "no `{command}` in the Makefile");
            continue;
        }
        // The README speaks of the release build; tests have their own.
        let command = command.replace("target/release/conelab", env!("CARGO_BIN_EXE_conelab"));
        let output = Command::new("sh")
            .args(["-c", &command])
            .current_dir(root())
            .env("CONELAB_CACHE", cache())
            .env("CONELAB_DEVICE", device())
            .env("CONELAB_VALIDATION", "true")
            .output()
            .unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        assert!(output.status.success(), "{command}\n{}{}", text(&output.stdout), text(&output.stderr));
    }
}
