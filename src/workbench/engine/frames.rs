//! Frames that are left to render, and the reports about them.

use super::converge::Need;
use super::renderdoc;
use super::report::{PictureReport, Report};
use super::{LONG, Run, Side, Submitted};
use crate::graph::run::FrameTimes;
use crate::lab::LabError;
use crate::workbench::desired::request::LightState;
use crate::workbench::read_back::ReadBack;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long an engine that is ahead waits for a window that may be hidden.
const UNSEEN: Duration = Duration::from_millis(100);

/// Time between updates of the small pictures of textures while frames are rendered: all textures
/// are read for them.
const THUMBNAILS: Duration = Duration::from_secs(2);

impl Run<'_> {
    /// Renders the remaining frames of A and B alternately, so that neither always profits from
    /// clocks raised by the other.
    pub(super) fn render(&mut self) -> Result<(), LabError> {
        if self.awaits_build() {
            return Ok(());
        }
        self.restart_together()?;
        let stepping = self.tick();
        let rest = !(self.desired.continuous || stepping);
        if !rest && self.is_ahead() && self.last_rendered.elapsed() < UNSEEN {
            std::thread::sleep(Duration::from_micros(200));
            self.waited = true;
            return Ok(());
        }
        self.last_rendered = Instant::now();
        self.turn += 1;
        for i in 0..2 {
            let number = (i + self.turn) % 2;
            if self.sides[number].session.is_some() && self.sides[number].frames_left > 0 {
                self.frame(number, rest)?;
            }
        }
        self.waited = false;
        let begins_to_refine = |s: &Side| s.refining > 0 && s.frames_left == s.refining;
        match self.sides.iter().any(begins_to_refine) {
            true => self.pay_pixels(),
            false => Ok(()),
        }
    }

    /// Whether the window has not taken the last pictures yet, and none is awaited to settle:
    /// another one would be thrown away, and takes the GPU from the window that is to show them.
    fn is_ahead(&self) -> bool {
        let shown = self.sides.iter().filter(|s| s.session.is_some()).count();
        self.sides.iter().all(|s| s.frames_left <= 1) && self.out.reports.len() >= shown
    }

    /// Moves time on; whether it goes.
    fn tick(&mut self) -> bool {
        let clock = self.desired.clock;
        let real = self.clock.last.elapsed().as_secs_f64();
        self.clock.last = Instant::now();
        let mut goes = false;
        if clock.playing {
            self.clock.now += clock.step.unwrap_or(real);
            goes = true;
        }
        if clock.steps != self.clock.steps {
            self.clock.now += clock.step.unwrap_or(1.0 / 60.0)
                * clock.steps.saturating_sub(self.clock.steps) as f64;
            self.clock.steps = clock.steps;
            self.request_frames(Need::Light);
        }
        goes
    }

    fn frame(&mut self, number: usize, rest: bool) -> Result<(), LabError> {
        let software = self.lab.gpu.info.kind == "cpu";
        self.pose(number);
        let side = &mut self.sides[number];
        let Some(session) = &mut side.session else {
            return Ok(());
        };
        side.frame += 1;
        side.submitted.push_back(Submitted {
            request: side.answered,
            time: self.clock.now,
            frame: side.frame,
            size: session.size(),
        });
        let captured = std::mem::take(&mut self.renderdoc).then(renderdoc::begin);
        let delta = if self.desired.clock.playing {
            self.desired.clock.step.unwrap_or(0.0)
        } else {
            0.0
        };
        let shares = self.lab.gpu.info.features.shares_memory
            && self.desired.window == Some(self.lab.gpu.info.id);
        let bytes = session.program.shown_bytes();
        let shared = shares
            .then(|| side.ring.free(&self.lab.gpu, bytes))
            .flatten();
        session.program.read_back(self.desired.bytes || !shares);
        session.program.hand_over(shared);
        let mut finished: Vec<FrameTimes> = session.frame(delta)?.into_iter().collect();
        self.count_frame(number);
        let side = &mut self.sides[number];
        if !rest {
            side.frames_left = side.frames_left.max(1);
        }
        // Long frames gain nothing from another one ahead, and an edit would wait for it; a still
        // picture must not wait for the next change.
        let waits = side.is_complete() || captured.is_some() || self.waited;
        let ahead = u64::from(!(software || side.last_ms > LONG || waits));
        let Some(session) = &mut side.session else {
            return Ok(());
        };
        finished.extend(session.program.finish_to(ahead)?);
        if let Some(begun) = captured {
            self.out.send(Report::Trouble(renderdoc::end(begun)));
        }
        self.report_frames(number, finished);
        self.read_back(number)?;
        self.check(number)
    }

    /// Gives a session the camera, the lights and the time of its next frame.
    fn pose(&mut self, number: usize) {
        let side = &mut self.sides[number];
        let Some(session) = &mut side.session else {
            return;
        };
        if let Some(camera) = &self.desired.camera {
            session.set_camera(camera);
        }
        if let Some(path) = &self.desired.path {
            session.place_camera(&path.at(self.clock.now));
        }
        if std::mem::take(&mut side.lights) {
            let own = || self.scene.as_ref().map(|scene| LightState::of(scene));
            // A session that cannot follow is replaced soon.
            if let Some(lights) = self.desired.lights.clone().or_else(own) {
                lights.light(session);
            }
        }
        session.set_time(self.clock.now);
        session.set_execution(self.desired.execution);
    }

    pub(super) fn report_frames(&mut self, number: usize, finished: Vec<FrameTimes>) {
        let side = &mut self.sides[number];
        for mut times in finished {
            let Some(submitted) = side.submitted.pop_front() else {
                continue;
            };
            side.last_ms = times.gpu_ms;
            let (bytes, shared) = (times.picture.take().map(Arc::new), times.handed.take());
            side.owes = bytes.is_none().then_some(submitted.frame);
            self.out.send(Report::Picture(PictureReport {
                side: number,
                request: submitted.request,
                revision: side.key.as_ref().map_or(0, |k| k.revision),
                preview: side.preview,
                frame: submitted.frame,
                finished: Instant::now(),
                left: side.converging_left(),
                asked: side.frames_asked,
                time: submitted.time,
                size: submitted.size.into(),
                bytes,
                shared,
                times,
            }));
        }
    }

    /// Whether the last picture of a converged side is not in main memory yet.
    pub(super) fn owes_pixels(&self) -> bool {
        self.sides
            .iter()
            .any(|s| s.owes.is_some() && s.session.is_some())
    }

    /// Brings the last picture of sides that rest into main memory, where it is compared and read
    /// out.
    pub(super) fn pay_pixels(&mut self) -> Result<(), LabError> {
        for number in 0..2 {
            let side = &mut self.sides[number];
            let complete = side.is_complete();
            let Some(session) = side.session.as_mut().filter(|_| complete) else {
                continue;
            };
            let Some(frame) = side.owes.take() else {
                continue;
            };
            if let Some(bytes) = session.program.shown_texels()? {
                self.out.send(Report::Pixels {
                    side: number,
                    frame,
                    bytes: Arc::new(bytes),
                });
            }
        }
        Ok(())
    }

    /// Reads back the content for panes: at once if nothing changes, else several times a second.
    fn read_back(&mut self, number: usize) -> Result<(), LabError> {
        let side = &mut self.sides[number];
        let complete = side.is_complete();
        let Some(session) = side.session.as_mut().filter(|_| !side.preview) else {
            return Ok(());
        };
        let now = complete || self.last_read_back.elapsed() > Duration::from_millis(150);
        let small = complete || self.last_thumbnails.elapsed() > THUMBNAILS;
        let asked = self.desired.read_back.iter();
        for asked in asked.filter(|asked| asked.side() == number) {
            let (due, last) = match asked {
                ReadBack::Thumbnail(_) => (small, &mut self.last_thumbnails),
                _ => (now, &mut self.last_read_back),
            };
            if !due {
                continue;
            }
            *last = Instant::now();
            if let Some(content) = asked.read(session)? {
                self.out.send(Report::Content(content));
            }
        }
        Ok(())
    }

    /// Asks the graph's checks once for each build.
    fn check(&mut self, number: usize) -> Result<(), LabError> {
        let side = &mut self.sides[number];
        if !side.is_complete() || side.preview || side.checked == side.key {
            return Ok(());
        }
        side.checked.clone_from(&side.key);
        if let Some(session) = &mut side.session {
            let failed = session.failed_checks()?;
            self.out.send(Report::Checks(number, failed));
        }
        Ok(())
    }
}
