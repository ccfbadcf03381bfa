//! The interface to a host (a window, a screenshot): pixels to show, and events for scripts.

use crate::workbench::{NewPixels, Workbench, events};
use serde_json::json;
use std::time::Instant;

impl Workbench {
    /// Pixels that the host has not shown yet.
    pub fn pixels(&self) -> &[NewPixels] {
        &self.pixels
    }

    /// Revision of the files that the shown picture of A was made from.
    pub fn shown_revision(&self) -> u64 {
        self.reload.shown
    }

    /// Number of A's last picture, and when it was finished.
    pub fn last_picture(&self) -> Option<(u64, Instant)> {
        self.sides[0]
            .picture
            .as_ref()
            .map(|p| (p.frame, p.finished))
    }

    /// The host has shown them.
    pub fn painted(&mut self) {
        if let Some(picture) = self.sides[0]
            .picture
            .as_ref()
            .filter(|_| self.pixels.iter().any(|p| p.picture == 0))
        {
            self.reload.shown = picture.revision;
        }
        if !self.pixels.is_empty() {
            if self.setup.events.is_none() {
                self.pixels.clear();
                return;
            }
            let list: Vec<usize> = self.pixels.iter().map(|p| p.picture).collect();
            let print = |p: &NewPixels| p.bytes.as_ref().map(|b| events::fingerprint(b));
            let prints: Vec<Option<String>> = self.pixels.iter().map(print).collect();
            let since = self
                .reload
                .changed_at
                .map(|t| t.elapsed().as_secs_f64() * 1e3);
            let request = self.sides[0].picture.as_ref().map_or(0, |p| p.request);
            self.event(
                "painted",
                json!({ "pictures": list, "fingerprints": prints, "request": request, "since_change_ms": since }),
            );
        }
        self.pixels.clear();
    }

    /// Logs where the widgets are, and that a button of the mouse was `released`, for scripts.
    /// `true` if there is more to log.
    pub fn describe(
        &mut self,
        update: Option<&egui::accesskit::TreeUpdate>,
        scale: f32,
        released: bool,
    ) -> bool {
        self.setup.events.as_mut().is_some_and(|e| {
            e.place(self.view.place, scale);
            e.widgets(update, scale, released)
        })
    }

    /// Whether the widgets are to be described.
    pub fn is_described(&self) -> bool {
        self.setup.events.is_some()
    }
}
