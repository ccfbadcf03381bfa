//! How many frames each side needs until its picture has converged.

use super::report::Report;
use super::{Run, Side};
use crate::lab::LabError;
use crate::workbench::desired::request::RenderRequest;

/// Frames that a change needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Need {
    /// This number of frames, even if the picture stays the same.
    Frames(u32),
    /// The frames of a fresh start: voxels keep their light, and pixels restart.
    View,
    /// The frames that replace all accumulated light.
    Light,
}

impl Need {
    /// The frames that a new request needs; none if both are equal.
    pub(super) fn between(old: &RenderRequest, new: &RenderRequest) -> Option<Need> {
        if old == new {
            return None;
        }
        let lit = |r: &RenderRequest| {
            (
                r.lights.clone(),
                r.clock,
                r.environment.clone(),
                r.scene.clone(),
            )
        };
        Some(match () {
            () if lit(old) != lit(new) => Need::Light,
            () if (&old.camera, &old.path) != (&new.camera, &new.path) => Need::View,
            () => Need::Frames(1),
        })
    }
}

impl Run<'_> {
    /// Asks both sides for frames.
    pub(super) fn request_frames(&mut self, need: Need) {
        (0..2).for_each(|number| self.request_frames_of(number, need));
    }

    /// Asks a side for the frames that it needs.
    pub(super) fn request_frames_of(&mut self, number: usize, need: Need) {
        // A and B are compared as soon as both have converged.
        let compares = self.sides.iter().all(|s| s.session.is_some());
        let side = &mut self.sides[number];
        let session = side.session.as_ref();
        let (fresh, changed) =
            session.map_or((1, 1), |s| (s.converging_frames(), s.frames_after_change()));
        let count = |frames: usize| u32::try_from(frames).unwrap_or(u32::MAX);
        let (fresh, changed) = (count(fresh), count(changed));
        let (frames, refines) = match need {
            Need::Frames(least) if !side.fresh => (least, 0),
            Need::Light if !side.fresh => (changed, 0),
            Need::Frames(least) => (least.max(fresh), changed.saturating_sub(fresh)),
            Need::View | Need::Light => (fresh, changed.saturating_sub(fresh)),
        };
        let refines = if compares { 0 } else { refines };
        if frames >= side.converging_left() {
            side.frames_asked = frames;
            side.frames_left = side.frames_left.max(frames.saturating_add(refines));
            side.refining = side.frames_left - frames;
        }
        side.least_left = side.least_left.max(if let Need::Frames(least) = need {
            least
        } else {
            1
        });
    }

    /// Counts a frame that a side has begun. Frames after which the picture cannot change any more
    /// are left out.
    pub(super) fn count_frame(&mut self, number: usize) {
        let side = &mut self.sides[number];
        side.fresh = false;
        side.least_left = side.least_left.saturating_sub(1);
        side.frames_left = side.frames_left.saturating_sub(1);
        if side
            .session
            .as_ref()
            .is_some_and(|s| s.program.is_at_rest())
        {
            side.frames_left = side.frames_left.min(side.least_left);
        }
    }

    /// Restarts A and B together once both show the request, so that equal settings give equal
    /// pictures and both are timed over the same frames.
    pub(super) fn restart_together(&mut self) -> Result<(), LabError> {
        let shows = |number: usize| {
            let side = &self.sides[number];
            let desired = self.desired.sides[number].as_ref();
            side.session.is_some()
                && desired.is_some_and(|d| side.key.as_ref() == Some(&self.key(d, number)))
        };
        if !(self.restarts && shows(0) && shows(1)) {
            return Ok(());
        }
        self.restarts = false;
        for number in 0..2 {
            let Some(session) = &mut self.sides[number].session else {
                continue;
            };
            let finished = session.restart()?;
            self.report_frames(number, finished);
            let side = &mut self.sides[number];
            (side.fresh, side.lights) = (true, true);
            // An earlier count started from histories that are now cleared.
            (side.frames_left, side.refining, side.least_left) = (0, 0, 0);
        }
        self.out.send(Report::Restarted);
        self.request_frames(Need::Light);
        let most = self.sides[0].frames_left.max(self.sides[1].frames_left);
        for side in &mut self.sides {
            (side.frames_left, side.frames_asked, side.least_left) = (most, most, most);
        }
        Ok(())
    }
}

impl Side {
    /// Frames until the picture has converged. It may be refined for more frames.
    pub(super) fn converging_left(&self) -> u32 {
        self.frames_left.saturating_sub(self.refining)
    }

    /// Whether the picture is to be measured: it has just converged, or does not change any more.
    pub(super) fn is_complete(&self) -> bool {
        self.frames_left == 0 || self.frames_left == self.refining
    }
}
