//! A and B compared, on a thread.

use super::compare::{self, MODES, Mode, Shown};
use crate::workbench::engine::guard::guarded;
use crate::workbench::{ComparisonOf, Side, Workbench};
use std::sync::Arc;

impl Workbench {
    /// Works out the map of differences on a thread, one at a time.
    pub(crate) fn compare(&mut self) {
        let mode = self.view.mode;
        if !matches!(mode, Mode::Difference | Mode::Perceived) || self.comparing {
            return;
        }
        let (Some(a), Some(b)) = (shown(&self.sides[0]), shown(&self.sides[1])) else {
            return;
        };
        let of = (mode, self.view.gain, a.bytes.clone(), b.bytes.clone());
        let same = |o: &ComparisonOf| {
            (o.0, o.1) == (of.0, of.1) && Arc::ptr_eq(&o.2, &of.2) && Arc::ptr_eq(&o.3, &of.3)
        };
        if self.comparison_of.as_ref().is_some_and(same) {
            return;
        }
        self.comparison_of = Some(of);
        self.comparing = true;
        let (out, wake, gain) = (self.compared.0.clone(), self.wake.clone(), self.view.gain);
        std::thread::spawn(move || {
            let map = || match mode {
                Mode::Difference => compare::difference(&a, &b, gain),
                _ => compare::flip(&a, &b),
            };
            let _ = out.send((mode, guarded(map).ok().flatten()));
            wake();
        });
    }

    /// Writes what the comparison shows, pixel for pixel: the map, or A and B as they are put together.
    pub(crate) fn save_comparison(&mut self) {
        let (Some(a), Some(b)) = (shown(&self.sides[0]), shown(&self.sides[1])) else {
            self.status = "the pictures move: they are saved when they rest".into();
            return;
        };
        let map = self
            .comparison
            .as_ref()
            .filter(|(mode, _)| *mode == self.view.mode)
            .map(|(_, map)| map);
        let picture = match (self.view.mode, map) {
            (Mode::Difference | Mode::Perceived, None) => {
                self.status = "the comparison is still being worked out".into();
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
        self.export(&format!("{}-{}", self.name, mode), "png", written);
    }

    pub(crate) fn comparison_text(&self) -> Option<String> {
        let (mode, map) = self
            .comparison
            .as_ref()
            .filter(|(mode, _)| *mode == self.view.mode)?;
        let share = 100.0 * map.differing as f64 / f64::from((map.size[0] * map.size[1]).max(1));
        Some(match mode {
            Mode::Perceived => format!("mean FLIP {:.4}, largest {:.3}", map.mean, map.max),
            _ => format!(
                "mean {:.3}/255, largest {}, {share:.1} % of pixels",
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
