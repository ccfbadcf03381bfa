//! Progress for Python's callbacks, and Ctrl-C.

use conelab::campaign::runner::Progress;
use pyo3::prelude::{Py, PyAny, PyResult, Python};
use pyo3::{Bound, PyErr};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Least time between two calls of a callback that only counts on.
const EVERY: Duration = Duration::from_millis(50);

/// Calls a callback with (text, done, of, note) and looks for Ctrl-C. Keeps the exception that ends the work.
pub struct Reporter {
    callback: Option<Py<PyAny>>,
    last: Option<Instant>,
    text: String,
    done: usize,
    of: usize,
    raised: Option<PyErr>,
}

impl Reporter {
    pub fn new(callback: Option<Bound<'_, PyAny>>) -> Reporter {
        Reporter {
            callback: callback.map(Bound::unbind),
            last: None,
            text: String::new(),
            done: 0,
            of: 0,
            raised: None,
        }
    }

    /// The work's result, or the exception that ended it.
    pub fn end<T>(self, result: PyResult<T>) -> PyResult<T> {
        match self.raised {
            Some(raised) => Err(raised),
            None => result,
        }
    }

    /// Counts on.
    pub fn count(&mut self, text: &str, done: usize, of: usize) -> ControlFlow<()> {
        if self.text != text {
            self.text = text.into();
        }
        (self.done, self.of) = (done, of);
        let ends = done >= of;
        let waits = self.last.is_some_and(|at| at.elapsed() < EVERY) && !ends;
        self.call(None, waits)
    }

    /// A step of a campaign.
    pub fn step(&mut self, progress: Progress) -> ControlFlow<()> {
        match progress {
            Progress::Begins { todo, before } => {
                let note = (before > 0).then(|| format!("{before} already done, {todo} remaining"));
                (self.done, self.of) = (0, todo);
                self.call(note, false)
            }
            Progress::Note(text) | Progress::Tried(text) => self.call(Some(text), false),
            Progress::Runs(what) => {
                self.text = what;
                self.call(None, false)
            }
            Progress::Gathers(now) => {
                let (text, before) = (
                    format!("reference {} of {} samples", now.samples, now.goal),
                    &mut self.text,
                );
                let text = std::mem::replace(before, text);
                let waits = self.last.is_some_and(|at| at.elapsed() < EVERY);
                let flow = self.call(None, waits);
                self.text = text;
                flow
            }
            Progress::Finished(what, said) => {
                self.done += 1;
                let note = said
                    .iter()
                    .map(|line| format!("{what}: {line}"))
                    .collect::<Vec<_>>();
                self.call((!note.is_empty()).then(|| note.join("\n")), false)
            }
            Progress::Ends => self.call(None, false),
        }
    }

    fn call(&mut self, note: Option<String>, waits: bool) -> ControlFlow<()> {
        if self.raised.is_some() {
            return ControlFlow::Break(());
        }
        let result = Python::attach(|py| {
            py.check_signals()?;
            match &self.callback {
                Some(callback) if !waits || note.is_some() => {
                    self.last = Some(Instant::now());
                    callback
                        .call1(py, (&self.text, self.done, self.of, note))
                        .map(drop)
                }
                _ => Ok(()),
            }
        });
        match result {
            Ok(()) => ControlFlow::Continue(()),
            Err(raised) => {
                self.raised = Some(raised);
                ControlFlow::Break(())
            }
        }
    }
}
