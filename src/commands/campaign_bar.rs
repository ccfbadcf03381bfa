//! Progress of campaigns on the terminal.

use crate::campaign::record::first_line;
use crate::campaign::runner::Progress;
use indicatif::{ProgressBar, ProgressStyle};

/// Shows progress; `points` is the noun for the points.
pub fn bar(points: &str) -> impl FnMut(Progress) {
    let bar = ProgressBar::new(0).with_style(
        ProgressStyle::with_template("{pos}/{len} {bar:30} {elapsed} so far, {eta} left {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let mut doing = String::new();
    move |progress| match progress {
        Progress::Begins { todo, before } => {
            if before > 0 {
                bar.suspend(|| say!("{before} {points}are finished already, {todo} to go"));
            }
            bar.reset();
            bar.set_length(todo as u64);
        }
        Progress::Note(text) => bar.suspend(|| warn!("{text}")),
        Progress::Runs(what) => {
            bar.set_message(what.clone());
            doing = what;
        }
        Progress::Gathers(now) => {
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
        }
        Progress::Ends => bar.finish_and_clear(),
    }
}
