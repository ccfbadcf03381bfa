//! Opens a file at a line in the user's editor.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

/// Variables that may name the editor. The first one that is set is used.
const VARIABLES: [&str; 3] = ["CONELAB_EDITOR", "VISUAL", "EDITOR"];

/// Opens a file. Returns a message, also on failure.
pub fn open(file: &Path, line: u32) -> Result<String, String> {
    let named = VARIABLES
        .iter()
        .find_map(|v| Some((*v, std::env::var(v).ok().filter(|t| !t.trim().is_empty())?)));
    let Some((variable, text)) = named else {
        return show(file);
    };
    let words = command(&text, file, line);
    match start(&words) {
        Ok(()) => Ok(format!("opened {}:{line} in {}", file.display(), words[0])),
        Err(e) => Err(format!(
            "cannot start the editor '{}' ({e}): set {variable} to another command",
            words[0]
        )),
    }
}

/// Opens a file with the system's program for it. Returns a message, also on failure.
pub fn show(file: &Path) -> Result<String, String> {
    let name = file.display();
    match open::that_detached(file) {
        Ok(()) => Ok(format!("opened {name}")),
        Err(e) => Err(format!(
            "cannot open {name} ({e}): for sources, set CONELAB_EDITOR, for example to `code -g {{file}}:{{line}}`"
        )),
    }
}

/// The words of a command with the file and the line in place of `{file}` and `{line}`. The file
/// is the last word if the command has no `{file}`. Words do not pass through a shell.
fn command(text: &str, file: &Path, line: u32) -> Vec<String> {
    let file = file.to_string_lossy();
    let mut words: Vec<String> = text.split_whitespace().map(String::from).collect();
    if !text.contains("{file}") {
        words.push("{file}".into());
    }
    // The file name is inserted last, because it may contain a placeholder.
    words
        .iter()
        .map(|w| {
            w.replace("{line}", &line.to_string())
                .replace("{file}", &file)
        })
        .collect()
}

fn start(words: &[impl AsRef<OsStr>]) -> std::io::Result<()> {
    let mut words = words.iter();
    let program = words
        .next()
        .ok_or_else(|| std::io::Error::other("no command"))?;
    let mut child = Command::new(program)
        .args(words)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    // A finished editor must not stay as a zombie process.
    std::thread::spawn(move || child.wait());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::command;
    use std::path::Path;

    #[test]
    fn file_and_line_stand_where_the_command_says() {
        let file = Path::new("a b/{line}.glsl");
        assert_eq!(
            command("code -g {file}:{line}", file, 7),
            ["code", "-g", "a b/{line}.glsl:7"]
        );
        assert_eq!(command("gvim", file, 7), ["gvim", "a b/{line}.glsl"]);
    }
}
