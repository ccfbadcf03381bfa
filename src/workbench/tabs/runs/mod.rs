//! Sweeps, stability, benchmarks and searches of the present experiment, as commands of their own.

mod form;
mod list;
mod plan;
mod process;

use super::Tab;
use super::chart::Chart;
use crate::campaign::record::write_file;
use crate::experiment::checked_name;
use crate::lab::LabError;
use crate::workbench::desired::save;
use crate::workbench::panel::control::small_button;
use crate::workbench::{Workbench, editor};
use egui::{ProgressBar, TextureId, Ui};
use list::{Rows, Run};
use plan::{EXPERIMENT, FILE, Kind, Plan};
use process::Process;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Length of the camera's steps, in diagonals of the scene.
const STEP: f32 = 0.004;

/// State of this tab.
#[derive(Default)]
pub struct Runs {
    plan: Plan,
    /// Values of the sweep as typed.
    values: String,
    running: Option<Running>,
    /// How the last run ended: whether all is well, and in words.
    said: Option<(bool, String)>,
    /// Runs on disk, once they were looked for.
    list: Option<Vec<Run>>,
    /// A table and its rows.
    table: Option<(PathBuf, Result<Rows, String>)>,
}

/// A command that runs.
struct Running {
    process: Process,
    kind: Kind,
    folder: PathBuf,
    /// A report to show when it has ended.
    report: Option<PathBuf>,
}

impl Tab for Runs {
    const TITLE: &'static str = "Runs";
    const ICON: &'static str = egui_phosphor::regular::FLASK;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| workbench.runs_tab(ui));
    }

    fn poll(workbench: &mut Workbench) {
        workbench.poll_run();
    }

    fn end_frame(workbench: &mut Workbench, _: &Ui) {
        if let Some(name) = workbench.panel.sweep.take() {
            workbench.tabs.runs.plan.kind = Kind::Sweep;
            workbench.tabs.runs.plan.size = workbench.desired.size;
            workbench.suggest_values(&name);
            workbench.dock.open_tab::<Runs>();
        }
    }

    fn awaits(workbench: &Workbench) -> bool {
        workbench.tabs.runs.running.is_some() && workbench.dock.shows_tab::<Runs>()
    }
}

impl Workbench {
    fn runs_tab(&mut self, ui: &mut Ui) {
        self.form(ui);
        self.running_rows(ui);
        ui.separator();
        ui.horizontal(|ui| {
            ui.strong("Runs on disk");
            if small_button(ui, "refresh", "refresh runs", "Reads captures again") {
                self.tabs.runs.list = None;
            }
        });
        let captures = &self.setup.home.captures;
        let list = self
            .tabs
            .runs
            .list
            .get_or_insert_with(|| list::list(captures));
        if list.is_empty() {
            ui.weak("None yet. Finished runs are saved in captures and listed here.");
        }
        for run in list.clone() {
            self.run_row(ui, &run);
        }
        if let Some((path, rows)) = &self.tabs.runs.table {
            ui.separator();
            ui.strong(super::super::short(&path.display().to_string()));
            match rows {
                Ok(rows) => show_table(ui, rows),
                Err(why) => drop(ui.colored_label(ui.visuals().error_fg_color, why)),
            }
        }
    }

    fn running_rows(&mut self, ui: &mut Ui) {
        let runs = &mut self.tabs.runs;
        let mut cancelled = false;
        if let Some(running) = &runs.running {
            let (done, of) = running.process.progress.unwrap_or_default();
            let seconds = running.process.elapsed().as_secs();
            let text = match of {
                0 => format!("starting, {seconds} s"),
                _ => format!("{done} of {of}, {seconds} s"),
            };
            ui.horizontal(|ui| {
                let part = done as f32 / of.max(1) as f32;
                let bar = ProgressBar::new(part).text(text);
                ui.add(bar.desired_width(200.0));
                let about = "Stops. Finished points are kept, and Resume continues";
                cancelled = small_button(ui, "Cancel", "cancel the run", about);
            });
            if let Some(line) = running.process.log.last() {
                ui.weak(line);
            }
            // The seconds go on.
            ui.ctx().request_repaint_after(Duration::from_secs(1));
        }
        if cancelled {
            runs.running = None;
            runs.list = None;
            runs.said = Some((
                true,
                "Cancelled. Resume continues with the next point".into(),
            ));
            self.event("run cancelled", json!({}));
        }
        match &self.tabs.runs.said {
            Some((true, text)) => drop(ui.label(text)),
            Some((false, text)) => drop(ui.colored_label(ui.visuals().error_fg_color, text)),
            None => {}
        }
    }

    fn run_row(&mut self, ui: &mut Ui, run: &Run) {
        let name = run.name();
        let idle = self.tabs.runs.running.is_none();
        ui.horizontal_wrapped(|ui| {
            ui.label(&name);
            let state = match (run.finished, run.failed) {
                (false, _) => ", unfinished".into(),
                (true, 0) => String::new(),
                (true, n) => format!(", {n} failed"),
            };
            ui.weak(format!("{}{state}", run.kind.title()));
            let button = |ui: &mut Ui, text: &str, about: &str| {
                small_button(ui, text, &format!("{text} {name}"), about)
            };
            let plan = run.plan.clone().filter(|_| idle && !run.finished);
            if let Some(plan) = plan
                && button(ui, "Resume", "Measures the missing points")
            {
                let words = plan.command(&run.folder, &name);
                self.run_command(&words, run.kind, &run.folder, None);
            }
            let plan = run.plan.as_ref().filter(|_| idle && run.failed > 0);
            if let Some(plan) = plan
                && button(ui, "Retry failed", "Measures the failed points again")
            {
                let mut words = plan.command(&run.folder, &name);
                words.push("--again".into());
                self.run_command(&words, run.kind, &run.folder, None);
            }
            if run.kind == Kind::Sweep && button(ui, "Chart", "Error against time") {
                self.tabs.chart.follow(&run.folder, &self.setup.wake);
                self.dock.open_tab::<Chart>();
            }
            let path = run.kind.table(&run.folder);
            if path.is_file() && button(ui, "Table", "Shows the numbers below") {
                let rows = list::table(&path);
                self.tabs.runs.table = Some((path, rows));
            }
            let reports = run.kind.report_command(&run.folder);
            let page = run.kind.report(&run.folder);
            let about = "Opens the report in the browser";
            if (page.is_file() || (reports.is_some() && idle)) && button(ui, "Report", about) {
                match reports.filter(|_| idle) {
                    Some(words) => self.run_command(&words, run.kind, &run.folder, Some(page)),
                    None => self.opened(editor::show(&page)),
                }
            }
        });
    }

    /// Writes the files of the planned run, and starts it.
    fn start_run(&mut self) {
        let started = self.prepare_run().map(|(folder, name)| {
            let plan = &self.tabs.runs.plan;
            let (words, kind) = (plan.command(&folder, &name), plan.kind);
            self.run_command(&words, kind, &folder, None);
        });
        if let Err(why) = started {
            self.tabs.runs.said = Some((false, why.to_string()));
            self.event("run failed", json!({ "text": why.to_string() }));
        }
    }

    /// Writes the experiment as it is, and what its run reads, to a new folder.
    fn prepare_run(&mut self) -> Result<(PathBuf, String), LabError> {
        let wait = || LabError::Request("wait until the scene and the passes are loaded".into());
        let number = self.panel.side;
        let info = self.sides[number].info.clone().ok_or_else(wait)?;
        let side = self.desired.sides[number].clone().ok_or_else(wait)?;
        let scene = self.scene.loaded.clone().ok_or_else(wait)?;
        let plan = &self.tabs.runs.plan;
        let base = checked_name(&self.experiment.name).unwrap_or_else(|_| "experiment".into());
        let base = match plan.kind {
            Kind::Sweep => format!("{base}-{}", plan.param),
            _ => base,
        };
        let parent = self.setup.home.captures.clone();
        let (folder, name) = free_folder(&parent.join(plan.kind.folder()), &base);
        let side = save::without_cursors(&side, Some(&info.graph));
        let time = self.desired.clock.at;
        let experiment = save::still(&self.desired, &side, &name, time, &scene);
        let defaults = &info.graph.params;
        crate::experiment::write(&experiment, defaults, &folder.join(EXPERIMENT), true)?;
        let step = (STEP * self.scene.diagonal * 1e3).round() / 1e3;
        if let Some((file, text)) = plan.file(&name, step) {
            write_file(&folder.join(file), text.as_bytes())?;
        }
        let pretty = ron::ser::PrettyConfig::default();
        let text = ron::ser::to_string_pretty(plan, pretty).map_err(LabError::making("RON"))?;
        write_file(&folder.join(FILE), text.as_bytes())?;
        Ok((folder, name))
    }

    fn run_command(
        &mut self,
        words: &[String],
        kind: Kind,
        folder: &Path,
        report: Option<PathBuf>,
    ) {
        let setup = &self.setup;
        let process = Process::start(words, &setup.home, &setup.gpu, &setup.wake);
        self.event("run started", json!({ "command": words, "folder": folder }));
        self.tabs.runs.list = None;
        self.tabs.runs.said = None;
        match process {
            Ok(process) => {
                let folder = folder.to_path_buf();
                self.tabs.runs.running = Some(Running {
                    process,
                    kind,
                    folder,
                    report,
                });
            }
            Err(e) => {
                let text = format!("cannot start the command: {e}");
                self.tabs.runs.said = Some((false, text));
            }
        }
    }

    /// Takes in the progress of the running command, and its end.
    fn poll_run(&mut self) {
        let Some(running) = &mut self.tabs.runs.running else {
            return;
        };
        let before = running.process.progress;
        let ended = running.process.take();
        let progress = running.process.progress;
        let (kind, folder) = (running.kind, running.folder.clone());
        if let Some((done, of)) = progress.filter(|_| progress != before) {
            self.event("run progress", json!({ "done": done, "of": of }));
        }
        let grew = progress != before && progress.is_some_and(|p| p.0 > 0);
        if kind == Kind::Sweep && (grew || ended == Some(true)) {
            self.tabs.chart.follow(&folder, &self.setup.wake);
        }
        if let (Some(ok), Some(running)) = (ended, self.tabs.runs.running.as_ref()) {
            let text = match ok {
                true => running.process.log.last().cloned().unwrap_or_default(),
                false => running.process.log.join("\n"),
            };
            let report = running.report.clone().filter(|_| ok);
            self.event(
                "run ended",
                json!({ "ok": ok, "text": text, "folder": folder }),
            );
            self.tabs.runs.said = Some((ok, text));
            (self.tabs.runs.running, self.tabs.runs.list) = (None, None);
            if let Some(page) = report {
                self.opened(editor::show(&page));
            } else if ok && kind != Kind::Sweep {
                let path = kind.table(&folder);
                let rows = path.is_file().then(|| list::table(&path));
                self.tabs.runs.table = rows.map(|rows| (path, rows));
            }
        }
    }
}

/// The first folder `BASE`, `BASE-2`, ... that does not exist, and its name.
fn free_folder(parent: &Path, base: &str) -> (PathBuf, String) {
    let mut name = base.to_string();
    let mut number = 1;
    while parent.join(&name).exists() {
        number += 1;
        name = format!("{base}-{number}");
    }
    (parent.join(&name), name)
}

fn show_table(ui: &mut Ui, rows: &[Vec<String>]) {
    egui::ScrollArea::both().max_height(320.0).show(ui, |ui| {
        egui::Grid::new("table of a run")
            .striped(true)
            .show(ui, |ui| {
                for (number, row) in rows.iter().enumerate() {
                    for cell in row {
                        match number {
                            0 => ui.strong(cell),
                            _ => ui.label(cell),
                        };
                    }
                    ui.end_row();
                }
            });
    });
}
