//! The engine's work in words, if it lasts longer than a moment.

use crate::workbench::Workbench;
use std::time::{Duration, Instant};

/// What lasts no longer is not worth a word.
const MOMENT: Duration = Duration::from_millis(500);

impl Workbench {
    /// The engine's work, and its duration. Loading has its own message.
    pub(super) fn pending(&self, context: &egui::Context) -> Option<String> {
        let (what, since) = self.in_hand()?;
        let lasts = since.elapsed();
        context.request_repaint_after(if lasts < MOMENT {
            MOMENT - lasts
        } else {
            Duration::from_secs(1)
        });
        (lasts >= MOMENT).then(|| format!("{what}, {} s", lasts.as_secs()))
    }

    fn in_hand(&self) -> Option<(String, Instant)> {
        self.device
            .as_ref()
            .filter(|_| self.scene.loading.is_none() && self.scene.loaded.is_some())?;
        let both = self.desired.sides[1].is_some();
        let of = |side: usize| {
            self.desired.sides[side]
                .as_ref()
                .filter(|_| self.sides[side].errors.is_empty())?;
            let name = if both {
                ["A", "B"][side]
            } else {
                "the picture"
            };
            let picture = self.sides[side].picture.as_ref();
            // While pictures come, none of them is long in the making.
            let since = picture.map_or(self.sent.at, |p| p.finished.max(self.sent.at));
            match (&self.sides[side].info, picture) {
                (Some(_), Some(p)) if !p.preview && p.request >= self.sent.number => None,
                (None, _) => Some((format!("Compiling passes of {name}"), since)),
                (_, Some(p)) if p.preview => {
                    Some((format!("Compiling passes of {name}"), self.sent.at))
                }
                _ => Some((format!("Rendering {name}"), since)),
            }
        };
        let comparing = || {
            self.comparison
                .work
                .is_working()
                .then(|| ("Comparing A and B".into(), self.sent.at))
        };
        // Light that gathers over frames goes on after the first picture.
        let pictures = || self.sides.iter().filter_map(|s| s.picture.as_ref());
        let finished = pictures()
            .map(|p| p.finished)
            .max()
            .filter(|_| self.engine.works());
        let slowest = pictures().max_by_key(|p| p.left);
        let frame = slowest.map_or((0, 0), |p| (p.asked.saturating_sub(p.left), p.asked));
        let converging = || {
            finished.map(|since| {
                let text = match frame {
                    (done, asked) if done < asked => {
                        format!("Converging, frame {done} of {asked}")
                    }
                    _ => "Refining".into(),
                };
                (text, since)
            })
        };
        of(0)
            .or_else(|| of(1))
            .or_else(comparing)
            .or_else(converging)
    }
}
