//! Times on the picture: in a corner of each side.

use super::compare::Mode;
use crate::results::timers::{Rows, Timers, draw};
use crate::workbench::Workbench;
use crate::workbench::tabs::times::BETWEEN;
use egui::{Painter, Rect};

impl Workbench {
    /// Draws the times of the shown pictures: of A, and of B in its part.
    pub(crate) fn timers(&mut self, painter: &Painter, a: Rect, b: Option<Rect>) {
        if self.view.timers == Rows::None {
            return;
        }
        let sides: Vec<Timers> = (0..2)
            .map(|side| self.timers_of(painter.ctx(), side))
            .collect();
        let longest = sides[0]
            .longest()
            .max(if b.is_some() { sides[1].longest() } else { 0.0 });
        let flipped = self.view.mode == Mode::Flip && self.view.flipped && b.is_some();
        draw(painter, a, false, &sides[usize::from(flipped)], longest);
        if let Some(b) = b.filter(|_| self.view.mode != Mode::Flip) {
            draw(painter, b, self.view.mode != Mode::Side, &sides[1], longest);
        }
    }

    fn timers_of(&mut self, context: &egui::Context, side: usize) -> Timers {
        let both = self.desired.sides[1].is_some();
        let means = self.tabs.times.means(context, side, both);
        let (Some(info), Some(picture)) = (&self.sides[side].info, &self.sides[side].picture)
        else {
            return Timers::default();
        };
        let device = self.device.as_ref().map_or("", |d| d.name.as_str());
        let mut timers = Timers::new(
            self.view.timers,
            &info.graph,
            &info.params,
            device,
            picture.size,
            &means.passes,
        );
        timers.mark_skipped(&info.graph, &means.skipped);
        timers.rows.push((BETWEEN.into(), means.between));
        if self.desired.sides[1].is_some() {
            timers.title[0].insert_str(0, ["A: ", "B: "][side.min(1)]);
        }
        if let Some(error) = self.tabs.chart.known_error(side, self.sent.number) {
            timers.title.push(error);
        }
        (timers.total, timers.statistic) = (means.total, "mean");
        timers
    }
}
