//! State that is restored after a restart or a kill: layout, theme, size, recent files, and the experiment
//! with its unsaved changes. It is kept in `captures/.session`, and written
//! at most every two seconds, when something has changed.

use super::Workbench;
use super::dock::Pane;
use crate::experiment::Experiment;
use crate::results::timers::Rows;
use crate::workbench::desired::request::SideRequest;
use crate::workbench::desired::save;
use egui::{ThemePreference, Ui};
use egui_tiles::Tree;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Longest time that a kill can lose.
const INTERVAL: Duration = Duration::from_secs(2);

/// How much of the last session comes back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restore {
    /// Nothing, and nothing is written.
    Nothing,
    /// Layout, theme, size and recent files, with a requested experiment.
    Layout,
    /// The experiment, too.
    Experiment,
}

/// The state of the window.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Window {
    layout: Option<Tree<Pane>>,
    theme: ThemePreference,
    /// Factor of the size of text and controls.
    zoom: Option<f32>,
    /// Width and height of the window, points at a zoom of 1.
    pub size: Option<(u32, u32)>,
    /// Size of pictures that do not follow the viewport.
    picture: Option<(u32, u32)>,
    hidden: bool,
    timers: bool,
    recent: Vec<PathBuf>,
    /// Name and file of the experiment.
    name: String,
    file: PathBuf,
    /// Whether it had unsaved changes.
    modified: bool,
    compares: bool,
}

/// The session that is kept.
pub(crate) struct Session {
    folder: Option<PathBuf>,
    /// Texts and paths last written.
    written: Vec<(PathBuf, String)>,
    looked: Instant,
    /// The state to restore in the first frame of the interface.
    pending: Option<Window>,
    pub file: PathBuf,
}

fn folder(captures: &Path) -> PathBuf {
    captures.join(".session")
}

/// The last session's window; the default if there is none that can be read.
pub(crate) fn window(captures: &Path) -> Window {
    let text = std::fs::read_to_string(folder(captures).join("window.ron"));
    let read = text.ok().and_then(|text| ron::from_str(&text).ok());
    read.unwrap_or_default()
}

/// The experiments of the last session: A and, if it was compared, B.
fn experiments(captures: &Path, window: &Window) -> [Option<Experiment>; 2] {
    let read = |name: &str| Experiment::read(&folder(captures).join(name)).ok();
    let a = read("a.ron").map(|a| Experiment {
        name: window.name.clone(),
        ..a
    });
    let b = if window.compares { read("b.ron") } else { None };
    [a, b]
}

/// The session to start with, and the experiments that come back.
pub(crate) fn start(
    captures: &Path,
    restore: Restore,
    file: PathBuf,
) -> (Session, [Option<Experiment>; 2]) {
    let mut session = Session {
        folder: (restore != Restore::Nothing).then(|| folder(captures)),
        written: Vec::new(),
        looked: Instant::now(),
        pending: None,
        file,
    };
    if session.folder.is_none() {
        return (session, [None, None]);
    }
    let mut last = window(captures);
    let found = match restore {
        Restore::Experiment => experiments(captures, &last),
        _ => [None, None],
    };
    if found[0].is_none() {
        (last.modified, last.compares) = (false, false);
    } else if last.file.is_file() {
        session.file.clone_from(&last.file);
    }
    session.pending = Some(last);
    (session, found)
}

impl Workbench {
    /// Restores the window in its first frame, and keeps the session while it is used.
    pub(super) fn keep_session(&mut self, ui: &Ui) {
        if let Some(window) = self.session.pending.take() {
            self.restore_window(ui, window);
        }
        if self.session.folder.is_none() {
            return;
        }
        let age = self.session.looked.elapsed();
        if age < INTERVAL {
            // The frame after the last edit of a burst writes it.
            if ui.input(|i| !i.events.is_empty()) {
                ui.ctx().request_repaint_after(INTERVAL - age);
            }
            return;
        }
        self.session.looked = Instant::now();
        self.write_session(ui.ctx());
    }

    fn restore_window(&mut self, ui: &Ui, window: Window) {
        ui.ctx().set_theme(window.theme);
        if let Some(zoom) = window.zoom.filter(|zoom| (0.4..=4.0).contains(zoom)) {
            ui.ctx().set_zoom_factor(zoom);
        }
        if let Some(tree) = window.layout {
            self.dock.restore(tree);
        }
        self.layout.hidden = window.hidden;
        self.layout.fixed_size = self.layout.fixed_size.or(window.picture);
        if window.timers {
            self.view.timers = Rows::Stages;
        }
        self.experiment.recent = window.recent;
        if window.modified {
            self.experiment.baseline = Some(super::opening::Edited::default());
        }
    }

    /// Writes the files of the session that changed.
    pub(crate) fn write_session(&mut self, context: &egui::Context) {
        let Some(folder) = self.session.folder.clone() else {
            return;
        };
        let area = context.content_rect().size() * context.zoom_factor();
        let window = Window {
            layout: Some(self.dock.tree().clone()),
            theme: context.options(|o| o.theme_preference),
            zoom: Some(context.zoom_factor()),
            size: Some((area.x as u32, area.y as u32)),
            picture: self.layout.fixed_size,
            hidden: self.layout.hidden,
            timers: self.view.timers != Rows::None,
            recent: self.experiment.recent.clone(),
            name: self.experiment.name.clone(),
            file: self.session.file.clone(),
            modified: self.experiment.modified,
            compares: self.desired.sides[1].is_some(),
        };
        let Ok(text) = ron::ser::to_string_pretty(&window, ron::ser::PrettyConfig::default())
        else {
            return;
        };
        let mut failed = self.put_session(&folder.join("window.ron"), text).err();
        for (number, name) in ["a.ron", "b.ron"].into_iter().enumerate() {
            let Some(side) = self.desired.sides[number].clone() else {
                continue;
            };
            failed = failed.or(self.put_side(number, &side, &folder.join(name)).err());
        }
        if let Some(why) = failed {
            // Once: a folder that cannot be written to stays so.
            self.messages.status = format!("the session cannot be saved: {why}");
            self.session.folder = None;
        }
    }

    fn put_session(&mut self, path: &Path, text: String) -> Result<(), crate::files::FileError> {
        if self.is_written(path, &text) {
            return Ok(());
        }
        crate::files::write_whole(path, text.as_bytes())
    }

    /// Whether this was written last; notes it if not.
    fn is_written(&mut self, path: &Path, text: &str) -> bool {
        let written = &mut self.session.written;
        if written.iter().any(|(p, t)| p == path && t == text) {
            return true;
        }
        written.retain(|(p, _)| p != path);
        written.push((path.to_path_buf(), text.to_string()));
        false
    }

    /// Writes a side as an experiment, once its graph and its scene are there.
    fn put_side(
        &mut self,
        number: usize,
        side: &SideRequest,
        path: &Path,
    ) -> Result<(), crate::files::FileError> {
        let info = self.sides[number].info.clone();
        let Some(info) = info.filter(|_| self.missing_scene().is_none()) else {
            return Ok(());
        };
        let side = save::without_cursors(side, Some(&info.graph));
        let scene = self.scene.loaded.as_deref();
        let time = self.desired.clock.at;
        let experiment = save::experiment(&self.desired, &side, "session", time, scene);
        if self.is_written(path, &format!("{experiment:?}")) {
            return Ok(());
        }
        let written = crate::experiment::write(&experiment, &info.graph.params, path, true);
        // Values that the graph does not take are errors on screen; the last good state stays.
        match written {
            Err(crate::experiment::ExperimentError::File(e)) => Err(e),
            _ => Ok(()),
        }
    }

    /// Whether the window may close. Unsaved changes are asked about once.
    pub(crate) fn may_close(&mut self) -> bool {
        if self.layout.asks_close || !self.experiment.modified {
            return true;
        }
        self.layout.asks_close = true;
        false
    }

    /// The question about unsaved changes.
    pub(super) fn close_question(&mut self, ui: &Ui) {
        if !self.layout.asks_close {
            return;
        }
        let name = self.experiment.name.clone();
        let modal = egui::Modal::new("close".into()).show(ui.ctx(), |ui| {
            ui.label(super::theme::title(format!(
                "Save the changes to '{name}'?"
            )));
            ui.label(
                "Unsaved changes come back at the next start, until another experiment is opened.",
            );
            ui.horizontal(|ui| {
                let close = |ui: &Ui| ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
                let save = ui.button("Save and close");
                if ui.ctx().memory(|m| m.focused().is_none()) {
                    save.request_focus();
                }
                if save.clicked() {
                    self.save(true);
                    if !self.experiment.modified {
                        close(ui);
                    }
                    self.layout.asks_close = false;
                }
                if ui.button("Close without saving").clicked() {
                    close(ui);
                }
                if ui.button("Cancel").clicked() {
                    self.layout.asks_close = false;
                }
            });
        });
        if modal.should_close() {
            self.layout.asks_close = false;
        }
    }

    /// The window's title: the modified sign, experiment and scene.
    pub(super) fn set_title(&mut self, context: &egui::Context) {
        let mark = if self.experiment.modified { "● " } else { "" };
        let scene = super::short(&self.desired.scene);
        let title = format!("{mark}{} - {scene} - conelab", self.experiment.name);
        if title != self.layout.title {
            self.layout.title.clone_from(&title);
            context.send_viewport_cmd(egui::ViewportCommand::Title(title));
        }
    }
}
