//! A and B compared, on a thread.

use super::compare::{self, MODES, Map, Mode, Shown};
use crate::workbench::background::Background;
use crate::workbench::{Side, Workbench};
use std::sync::Arc;

/// The inputs of a comparison: mode, gain, pixels of A, pixels of B.
type Inputs = (Mode, u32, Arc<Vec<u8>>, Arc<Vec<u8>>);

/// The comparison of A and B.
#[derive(Default)]
pub(crate) struct Comparison {
    pub(crate) shown: Option<(Mode, Map)>,
    /// The inputs of the last one.
    pub(crate) of: Option<Inputs>,
    /// Maps by mode; no map if the pictures cannot be compared.
    pub(crate) work: Background<Mode, Option<Map>>,
}

impl Workbench {
    /// Works out the map of differences on a thread, one at a time.
    pub(crate) fn compare(&mut self) {
        let mode = self.view.mode;
        if !matches!(mode, Mode::Difference | Mode::Perceived) || self.comparison.work.is_working()
        {
            return;
        }
        let (Some(a), Some(b)) = (shown(&self.sides[0]), shown(&self.sides[1])) else {
            return;
        };
        let of = (mode, self.view.gain, a.bytes.clone(), b.bytes.clone());
        let same = |o: &Inputs| {
            (o.0, o.1) == (of.0, of.1) && Arc::ptr_eq(&o.2, &of.2) && Arc::ptr_eq(&o.3, &of.3)
        };
        if self.comparison.of.as_ref().is_some_and(same) {
            return;
        }
        self.comparison.of = Some(of);
        let gain = self.view.gain;
        self.comparison
            .work
            .start(mode, &self.setup.wake, move || match mode {
                Mode::Difference => compare::difference(&a, &b, gain),
                _ => compare::flip(&a, &b),
            });
    }

    /// Writes the shown comparison pixel for pixel: the map, or A and B as they are combined.
    pub(crate) fn save_comparison(&mut self) {
        let (Some(a), Some(b)) = (shown(&self.sides[0]), shown(&self.sides[1])) else {
            self.messages.status =
                "the pictures are still changing: save them once they have converged".into();
            return;
        };
        let map = self
            .comparison
            .shown
            .as_ref()
            .filter(|(mode, _)| *mode == self.view.mode)
            .map(|(_, map)| map);
        let picture = match (self.view.mode, map) {
            (Mode::Difference | Mode::Perceived, None) => {
                self.messages.status = "the comparison is still being computed".into();
                return;
            }
            (_, Some(map)) => Shown {
                size: map.size,
                bytes: map.bytes.clone(),
            },
            (mode, None) => compare::joined(&a, &b, mode, self.view.split, self.view.flipped),
        };
        let mode = MODES
            .iter()
            .find(|m| m.0 == self.view.mode)
            .map_or("", |m| m.1);
        let mut bytes = std::io::Cursor::new(Vec::new());
        let [width, height] = picture.size;
        let written = image::RgbaImage::from_raw(width, height, picture.bytes.to_vec())
            .ok_or_else(|| std::io::Error::other("the picture's size does not fit"))
            .and_then(|i| {
                i.write_to(&mut bytes, image::ImageFormat::Png)
                    .map_err(std::io::Error::other)
            })
            .map(|()| bytes.into_inner());
        self.export(
            &format!("{}-{}", self.experiment.name, mode),
            "png",
            written,
        );
    }

    pub(crate) fn comparison_text(&self) -> Option<String> {
        let (mode, map) = self
            .comparison
            .shown
            .as_ref()
            .filter(|(mode, _)| *mode == self.view.mode)?;
        let share = 100.0 * map.differing as f64 / f64::from((map.size[0] * map.size[1]).max(1));
        Some(match mode {
            Mode::Perceived => format!("mean FLIP {:.4}, max {:.3}", map.mean, map.max),
            _ => format!(
                "mean {:.2}, max {} (of 255), {share:.1} % of pixels differ",
                map.mean, map.max
            ),
        })
    }
}

/// The picture of a side, where it is in main memory.
fn shown(side: &Side) -> Option<Shown> {
    side.picture.as_ref().and_then(|p| {
        Some(Shown {
            size: p.size,
            bytes: p.bytes.clone()?,
        })
    })
}
