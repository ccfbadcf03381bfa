//! A and B compared, on a thread.

use super::compare::{self, Mode, Shown};
use super::guard::guarded;
use super::{ComparisonOf, Side, Workbench};
use std::sync::Arc;

impl Workbench {
    /// Works out the map of differences on a thread, one at a time.
    pub(super) fn compare(&mut self) {
        let mode = self.view.mode;
        if !matches!(mode, Mode::Difference | Mode::Perceived) || self.comparing {
            return;
        }
        let shown = |s: &Side| s.picture.as_ref().and_then(|p| Some(Shown { size: p.size, bytes: p.bytes.clone()? }));
        let (Some(a), Some(b)) = (shown(&self.sides[0]), shown(&self.sides[1])) else { return };
        let of = (mode, self.view.gain, a.bytes.clone(), b.bytes.clone());
        let same =
            |o: &ComparisonOf| (o.0, o.1) == (of.0, of.1) && Arc::ptr_eq(&o.2, &of.2) && Arc::ptr_eq(&o.3, &of.3);
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

    pub(super) fn comparison_text(&self) -> Option<String> {
        let (mode, map) = self.comparison.as_ref().filter(|(mode, _)| *mode == self.view.mode)?;
        let share = 100.0 * map.differing as f64 / f64::from((map.size[0] * map.size[1]).max(1));
        Some(match mode {
            Mode::Perceived => format!("mean FLIP {:.4}, largest {:.3}", map.mean, map.max),
            _ => format!("mean {:.3}/255, largest {}, {share:.1} % of pixels", map.mean, map.max),
        })
    }
}
