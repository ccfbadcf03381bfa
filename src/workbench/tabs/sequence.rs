//! Image sequences, rendered by the program's own command in a process of its own.

use crate::camera_path;
use crate::lab::LabError;
use crate::workbench::Workbench;
use crate::workbench::background::{Background, Wake};
use crate::workbench::desired::save;
use crate::workbench::panel::control::{named, spin};
use egui::{DragValue, ProgressBar, Ui};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// A sequence to be rendered, or in work.
pub struct Sequence {
    frames: usize,
    rate: f64,
    folder: String,
    running: Option<Running>,
    /// How the last one ended: whether all is well, and in words.
    said: Option<(bool, String)>,
}

impl Default for Sequence {
    fn default() -> Self {
        Sequence {
            frames: 60,
            rate: 30.0,
            folder: "captures/sequence".into(),
            running: None,
            said: None,
        }
    }
}

struct Running {
    child: Arc<Mutex<Child>>,
    ended: Background<(), (bool, String)>,
    folder: PathBuf,
    /// Finished frames, of `frames`.
    done: usize,
    frames: usize,
    cancelled: bool,
}

impl Running {
    /// Looks how many frames there are.
    fn count(&mut self) {
        while self.done < self.frames
            && self
                .folder
                .join(format!("frame-{:05}.png", self.done))
                .is_file()
        {
            self.done += 1;
        }
    }

    fn cancel(&mut self) {
        self.cancelled = true;
        // One that has ended meanwhile needs no end.
        let _ = self
            .child
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .kill();
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.cancel();
    }
}

impl Workbench {
    /// Takes in the end of a sequence.
    pub(super) fn poll_sequence(&mut self) {
        let sequence = &mut self.tabs.paths.sequence;
        let Some(running) = &mut sequence.running else {
            return;
        };
        running.count();
        let Some(((), ended)) = running.ended.take() else {
            return;
        };
        let (ok, text) = ended.unwrap_or_else(|panic| (false, panic));
        let text = match running.cancelled {
            true => format!(
                "cancelled after {} of {} frames; they are in {}",
                running.done, running.frames, sequence.folder
            ),
            false => text,
        };
        sequence.running = None;
        sequence.said = Some((ok, text.clone()));
        self.event("sequence", serde_json::json!({ "ok": ok, "text": text }));
        self.messages.status = text;
    }

    /// The section.
    pub(super) fn sequence_rows(&mut self, ui: &mut Ui) {
        let sequence = &mut self.tabs.paths.sequence;
        let render = sequence.settings(ui);
        sequence.state(ui);
        if render {
            let result = self.start_sequence();
            self.tabs.paths.sequence.said = result.err().map(|e| (false, e.to_string()));
        }
    }

    /// Starts the command, with files of its own.
    fn start_sequence(&mut self) -> Result<(), LabError> {
        let failed = |e: std::io::Error| {
            LabError::Request(format!("cannot write the sequence's settings: {e}"))
        };
        let folder = tempfile::Builder::new()
            .prefix("conelab-sequence-")
            .tempdir()
            .map_err(failed)?;
        let file = folder.path().join("sequence.ron");
        self.write_settings(&file, failed)?;
        let Sequence { frames, rate, .. } = self.tabs.paths.sequence;
        let root = &self.setup.home.root;
        let captures = &self.setup.home.captures;
        let beside = captures.parent().unwrap_or(root);
        let to = beside.join(&self.tabs.paths.sequence.folder);
        let mut command = Command::new(std::env::current_exe().map_err(failed)?);
        command.current_dir(root).env("CONELAB_HOME", root);
        command.env("CONELAB_CAPTURES", captures);
        command.arg("render").arg(&file).arg("--sequence").arg(&to);
        command.args(["--frames", &frames.to_string()]);
        command.args(["--step", &(1.0 / rate).to_string()]);
        if !self.tabs.paths.path.keys.is_empty() {
            let path = folder.path().join("path.ron");
            camera_path::write(&self.tabs.paths.path, &path, false)?;
            command.arg("--path").arg(path);
        }
        if let Some(device) = &self.device {
            command.arg("--device").arg(&device.name);
        }
        // Frames of another sequence are not counted: the command refuses their folder.
        let done = if has_frames(&to) { frames } else { 0 };
        let (child, ended) = start(command, folder, &self.setup.wake)?;
        self.tabs.paths.sequence.running = Some(Running {
            child,
            ended,
            folder: to,
            done,
            frames,
            cancelled: false,
        });
        self.event("sequence begun", serde_json::json!({ "frames": frames }));
        Ok(())
    }

    /// Writes side A as an experiment.
    fn write_settings(
        &self,
        file: &Path,
        failed: impl Fn(std::io::Error) -> LabError,
    ) -> Result<(), LabError> {
        if let Some(missing) = self.missing_scene() {
            return Err(LabError::Request(missing));
        }
        let (Some(side), Some(info)) = (&self.desired.sides[0], &self.sides[0].info) else {
            return Err(LabError::Request("no graph has been built yet".into()));
        };
        let side = save::without_cursors(side, Some(&info.graph));
        let scene = self.scene.loaded.as_deref();
        let mut experiment = save::experiment(&self.desired, &side, "sequence", 0.0, scene);
        let scene = PathBuf::from(&experiment.scene);
        if scene.is_file() {
            let path = scene.canonicalize().map_err(failed)?;
            experiment.scene = path.to_string_lossy().into_owned();
        }
        crate::experiment::write(&experiment, &info.graph.params, file, false)?;
        Ok(())
    }
}

impl Sequence {
    /// The settings of the next sequence. Returns whether it is to be rendered.
    fn settings(&mut self, ui: &mut Ui) -> bool {
        let mut render = false;
        ui.add_enabled_ui(self.running.is_none(), |ui| {
            ui.horizontal(|ui| {
                let frames = DragValue::new(&mut self.frames).range(1..=100_000);
                spin(ui, frames.suffix(" frames"), "frames of the sequence");
                let rate = DragValue::new(&mut self.rate).range(1.0..=240.0);
                spin(ui, rate.suffix(" fps"), "frame rate");
            });
            ui.horizontal(|ui| {
                let field = egui::TextEdit::singleline(&mut self.folder).desired_width(160.0);
                let field = ui.add(field);
                named(&field, egui::WidgetType::TextEdit, "folder of the sequence");
                field.on_hover_text("Folder for frame-00000.png and so on");
                render = ui.button("render").clicked();
            });
        });
        render
    }

    /// The sequence in work, or how the last one ended.
    fn state(&mut self, ui: &mut Ui) {
        if let Some(running) = &mut self.running {
            ui.horizontal(|ui| {
                let part = running.done as f32 / running.frames.max(1) as f32;
                let text = format!("{} of {} frames", running.done, running.frames);
                ui.add(ProgressBar::new(part).desired_width(180.0).text(text));
                let name = match running.cancelled {
                    true => "stopping",
                    false => "cancel",
                };
                let cancel = egui::Button::new(name).small();
                let cancel = ui.add_enabled(!running.cancelled, cancel);
                if cancel.on_hover_text("Finished frames are kept").clicked() {
                    running.cancel();
                }
            });
            ui.ctx().request_repaint_after(Duration::from_millis(250));
        } else if let Some((ok, text)) = &self.said {
            match ok {
                true => ui.weak(text),
                false if text.starts_with("cancelled") => {
                    ui.colored_label(ui.visuals().warn_fg_color, text)
                }
                false => ui.colored_label(ui.visuals().error_fg_color, text),
            };
        }
    }
}

fn has_frames(folder: &Path) -> bool {
    folder.join("frame-00000.png").is_file()
}

type Started = (Arc<Mutex<Child>>, Background<(), (bool, String)>);

/// Starts the command; its last line comes when it has ended, and `folder` is removed.
fn start(
    mut command: Command,
    folder: tempfile::TempDir,
    wake: &Wake,
) -> Result<Started, LabError> {
    let cannot = |e: std::io::Error| LabError::Request(format!("cannot render the sequence: {e}"));
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(cannot)?;
    let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
    let child = Arc::new(Mutex::new(child));
    let mut ended = Background::default();
    let waited = child.clone();
    ended.start((), wake, move || {
        let errors = std::thread::spawn(move || all_of(stderr));
        let said = all_of(stdout);
        let errors = errors.join().unwrap_or_default();
        // Both ends are closed: it has ended or is about to.
        let status = waited.lock().unwrap_or_else(PoisonError::into_inner).wait();
        drop(folder);
        let ok = status.is_ok_and(|s| s.success());
        let text = if ok { said } else { errors };
        let last = text.trim().lines().last().unwrap_or_default();
        (ok, last.to_string())
    });
    Ok((child, ended))
}

fn all_of(pipe: Option<impl Read>) -> String {
    let mut bytes = Vec::new();
    // What cannot be read is not there.
    let _ = pipe.map(|mut p| p.read_to_end(&mut bytes));
    String::from_utf8_lossy(&bytes).into_owned()
}
