//! Progress of campaigns: a bar on a terminal, else a line for each finished point.

use crate::campaign::record::first_line;
use crate::campaign::runner::Progress;
use crate::measure::reference::Gathered;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Least time between two lines about a reference.
const LINE_AGE: Duration = Duration::from_secs(5);

/// Progress in lines on standard error, for pipes, logs and the window.
struct Lines {
    wanted: bool,
    started: Instant,
    said: Instant,
    finished: usize,
    of: usize,
}

impl Lines {
    fn new() -> Lines {
        Lines {
            wanted: !std::io::stderr().is_terminal(),
            started: Instant::now(),
            said: Instant::now(),
            finished: 0,
            of: 0,
        }
    }

    fn begins(&mut self, of: usize) {
        (self.finished, self.of, self.started) = (0, of, Instant::now());
        self.line("");
    }

    fn gathers(&mut self, now: &Gathered) {
        if self.said.elapsed() >= LINE_AGE {
            self.line(&format!(
                "reference {} of {} samples",
                now.samples, now.goal
            ));
        }
    }

    fn finished(&mut self, what: &str) {
        self.finished += 1;
        self.line(what);
    }

    fn line(&mut self, what: &str) {
        self.said = Instant::now();
        if self.wanted {
            let (finished, of) = (self.finished, self.of);
            let seconds = self.started.elapsed().as_secs();
            let colon = if what.is_empty() { "" } else { ": " };
            warn!("{finished} of {of} finished, {seconds} s{colon}{what}");
        }
    }
}

/// Shows progress; `points` is the noun for the points.
pub fn bar(points: &str) -> impl FnMut(Progress) -> ControlFlow<()> {
    let bar = ProgressBar::new(0).with_style(
        ProgressStyle::with_template("{pos}/{len} {bar:30} {elapsed} so far, {eta} left {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let mut doing = String::new();
    let mut lines = Lines::new();
    move |progress| {
        match progress {
            Progress::Begins { todo, before } => {
                if before > 0 {
                    bar.suspend(|| say!("{before} {points}already done, {todo} remaining"));
                }
                bar.reset();
                bar.set_length(todo as u64);
                lines.begins(todo);
            }
            Progress::Note(text) => bar.suspend(|| warn!("{text}")),
            Progress::Runs(what) => {
                bar.set_message(what.clone());
                doing = what;
            }
            Progress::Gathers(now) => {
                lines.gathers(&now);
                bar.set_message(format!(
                    "{doing}, reference {} of {} samples",
                    now.samples, now.goal
                ));
            }
            Progress::Tried(text) => bar.suspend(|| say!("{text}")),
            Progress::Finished(what, said) => {
                bar.suspend(|| {
                    said.iter()
                        .for_each(|text| warn!("{what}: {}", first_line(text)))
                });
                bar.inc(1);
                lines.finished(&what);
            }
            Progress::Ends => bar.finish_and_clear(),
        }
        ControlFlow::Continue(())
    }
}
