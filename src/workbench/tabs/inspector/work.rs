//! The work on texels, on a thread of its own and one piece at a time: megapixels must not hold up
//! the window.

use super::image::{Decoded, Tone, upright};
use super::statistics::{self, BINS, Values};
use crate::lab::Texels;
use crate::workbench::background::{Background, Wake};
use crate::workbench::desired::request::InspectTarget;
use std::sync::Arc;

/// What to work on.
pub enum Source {
    /// Texels that came, and whether they are of a volume.
    New(InspectTarget, Arc<Texels>, bool),
    /// The decoded texels of before, with another tone.
    Again(Arc<Decoded>, Arc<Vec<Values>>),
}

/// Picture, values and histogram of the texels.
pub struct Done {
    /// The texels.
    pub decoded: Arc<Decoded>,
    /// Statistics of each channel.
    pub values: Arc<Vec<Values>>,
    /// Histogram of each channel.
    pub histogram: Vec<[u32; BINS]>,
    /// First and last value of the histogram: all finite values that are shown, and the range.
    pub span: [f32; 2],
    /// Texels below zero and above white.
    pub marked: [usize; 2],
    /// The tone of the picture.
    pub tone: Tone,
    /// Whether the range was made to fit.
    pub fitted: bool,
    /// RGBA.
    pub image: Arc<Vec<u8>>,
}

type Job = (Source, Tone, bool);

/// The work in progress.
#[derive(Default)]
pub struct Work {
    next: Option<Job>,
    work: Background<(), Done>,
}

impl Work {
    /// Starts a piece of work, or keeps it until the one in progress is done; only the latest is
    /// kept. With `fit` the range becomes that of the values.
    pub fn start(&mut self, source: Source, tone: Tone, fit: bool, wake: &Wake) {
        if self.work.is_working() {
            // New texels that wait must not be lost to a change of the range.
            self.next = Some(match (self.next.take(), source) {
                (Some((new @ Source::New(..), _, fitted)), Source::Again(..)) => {
                    (new, tone, fit || fitted)
                }
                (Some((.., fitted)), source) => (source, tone, fit || fitted),
                (None, source) => (source, tone, fit),
            });
            return;
        }
        self.work.start((), wake, move || run(source, tone, fit));
    }

    /// The finished work, if any.
    pub fn take(&mut self, wake: &Wake) -> Option<Done> {
        let ((), done) = self.work.take()?;
        if let Some((source, tone, fit)) = self.next.take() {
            self.start(source, tone, fit, wake);
        }
        done.ok()
    }
}

fn run(source: Source, tone: Tone, fit: bool) -> Done {
    let (decoded, values) = match source {
        Source::New(target, texels, volume) => {
            let mut texels = Arc::unwrap_or_clone(texels);
            if volume {
                texels = upright(texels, target.axis);
            }
            let decoded = Decoded::new(target, texels);
            let values = statistics::values(&decoded);
            (Arc::new(decoded), Arc::new(values))
        }
        Source::Again(decoded, values) => (decoded, values),
    };
    let tone = if fit {
        statistics::fit(&tone, &values)
    } else {
        tone
    };
    let span = statistics::span(&tone, &values);
    let histogram = statistics::histogram(&decoded, span[0], span[1]);
    let marked = decoded.marked(&tone);
    let image = Arc::new(decoded.image(&tone));
    Done {
        decoded,
        values,
        histogram,
        span,
        marked,
        tone,
        fitted: fit,
        image,
    }
}
