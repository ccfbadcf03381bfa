//! Progress of campaigns on the terminal.

use crate::campaign::record::first_line;
use crate::campaign::runner::Progress;
use indicatif::{ProgressBar, ProgressStyle};

/// A bar for so many steps.
pub fn bar(steps: usize) -> ProgressBar {
    ProgressBar::new(steps as u64).with_style(
        ProgressStyle::with_template("{pos}/{len} {bar:30} {elapsed} so far, {eta} left {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    )
}

/// Runs a campaign with a bar; `points` is what its points are called.
pub fn with_bar<T>(points: &str, run: impl FnOnce(&mut dyn FnMut(Progress)) -> T) -> T {
    let bar = bar(0);
    let mut doing = String::new();
    let result = run(&mut |progress| match progress {
        Progress::Begins { todo, before } => {
            if before > 0 {
                bar.suspend(|| say!("{before} {points}are finished already, {todo} to go"));
            }
            bar.reset();
            bar.set_length(todo as u64);
        }
        Progress::Note(text) => bar.suspend(|| eprintln!("{text}")),
        Progress::Runs(what) => {
            bar.set_message(what.clone());
            doing = what;
        }
        Progress::Gathers(now) => {
            bar.set_message(format!("{doing}, reference {} of {} samples", now.samples, now.goal));
        }
        Progress::Finished(what, said) => {
            bar.suspend(|| said.iter().for_each(|text| eprintln!("{what}: {}", first_line(text))));
            bar.inc(1);
        }
    });
    bar.finish_and_clear();
    result
}
