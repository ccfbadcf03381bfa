//! A command of this program as a process of its own, and its progress.

use crate::lab::Workspace;
use crate::vulkan::GpuOptions;
use crate::workbench::background::Wake;
use crossbeam_channel::{Receiver, Sender, TryRecvError, unbounded};
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Lines that are kept.
const LINES: usize = 12;
/// Longest line that is kept, bytes.
const LINE: u64 = 4096;

/// A running command. It is killed with the value.
pub(super) struct Process {
    child: Child,
    lines: Receiver<String>,
    /// The last lines.
    pub log: Vec<String>,
    /// Finished points, and all.
    pub progress: Option<(usize, usize)>,
    started: Instant,
}

impl Process {
    /// Starts a command of this program.
    pub fn start(
        words: &[String],
        home: &Workspace,
        gpu: &GpuOptions,
        wake: &Wake,
    ) -> std::io::Result<Process> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(words).env("CONELAB_HOME", &home.root);
        command.env("CONELAB_CAPTURES", &home.captures);
        if words.first().is_some_and(|w| w != "report") {
            if let Some(device) = &gpu.device {
                command.args(["--device", device]);
            }
            if gpu.validation {
                command.arg("--validate");
            }
        }
        let pipes = command.stdin(Stdio::null()).stdout(Stdio::piped());
        let mut child = pipes.stderr(Stdio::piped()).spawn()?;
        let (out, lines) = unbounded();
        if let Some(pipe) = child.stdout.take() {
            read(pipe, out.clone(), wake.clone());
        }
        if let Some(pipe) = child.stderr.take() {
            read(pipe, out, wake.clone());
        }
        Ok(Process {
            child,
            lines,
            log: Vec::new(),
            progress: None,
            started: Instant::now(),
        })
    }

    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// Takes in new lines. Returns whether it succeeded, once it has ended.
    pub fn take(&mut self) -> Option<bool> {
        loop {
            match self.lines.try_recv() {
                Ok(line) => self.line(line),
                Err(TryRecvError::Empty) => return None,
                // Both pipes are closed: it ends now.
                Err(TryRecvError::Disconnected) => {
                    return Some(self.child.wait().is_ok_and(|status| status.success()));
                }
            }
        }
    }

    fn line(&mut self, line: String) {
        self.progress = progress(&line).or(self.progress);
        if !line.trim().is_empty() {
            self.log.push(line);
        }
        let surplus = self.log.len().saturating_sub(LINES);
        self.log.drain(..surplus);
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends the lines of a pipe from a thread.
fn read(pipe: impl Read + Send + 'static, out: Sender<String>, wake: Wake) {
    std::thread::spawn(move || {
        let mut pipe = BufReader::new(pipe);
        let mut bytes = Vec::new();
        while pipe
            .by_ref()
            .take(LINE)
            .read_until(b'\n', &mut bytes)
            .is_ok_and(|n| n > 0)
        {
            let line = String::from_utf8_lossy(&bytes).trim_end().to_string();
            bytes.clear();
            if out.send(line).is_err() {
                return;
            }
            wake();
        }
        drop(out);
        wake();
    });
}

/// The numbers of `2 of 5 finished, ...`.
fn progress(line: &str) -> Option<(usize, usize)> {
    let (counts, _) = line.split_once(" finished, ")?;
    let (done, of) = counts.split_once(" of ")?;
    Some((done.parse().ok()?, of.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::progress;

    #[test]
    fn progress_is_read_from_lines_of_campaigns() {
        assert_eq!(progress("2 of 5 finished, 12 s: a title"), Some((2, 5)));
        assert_eq!(progress("2 points already done, 3 remaining"), None);
    }
}
