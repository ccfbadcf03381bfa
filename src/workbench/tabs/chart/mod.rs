//! Error against time while one works: the points of a sweep, and the workbench as a dot among
//! them.

mod choice;
mod folder;
mod gather;
mod live;
mod plot;
mod rows;
mod thumbnail;

use super::Tab;
use crate::campaign::report::{Data, Dot};
use crate::experiment::Experiment;
use crate::graph::param::Params;
use crate::lab::parts_of;
use crate::metrics::Metric;
use crate::workbench::Workbench;
use crate::workbench::background::Wake;
use crate::workbench::engine::report::Report;
use crate::workbench::panel::control::named;
use choice::{Choice, Chosen};
use egui::{TextureId, Ui};
use folder::Folder;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Most dots that are logged for scripts.
const MAX_LOGGED: usize = 2000;
/// Least time between two tellings.
const LOG_AGE: Duration = Duration::from_millis(100);

/// State of this tab.
#[derive(Default)]
pub struct Chart {
    /// Folders with sweeps, once they were looked for.
    folders: Option<Vec<PathBuf>>,
    folder: Option<Folder>,
    choice: Choice,
    /// Whether the subject was chosen by hand.
    by_hand: bool,
    chosen: Chosen,
    live: live::State,
    thumbnail: thumbnail::Thumbnail,
    /// The dots as logged last.
    logged: Value,
    logged_at: Option<Instant>,
}

impl Tab for Chart {
    const TITLE: &'static str = "Chart";
    const ICON: &'static str = egui_phosphor::regular::CHART_SCATTER;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.chart_tab(ui);
    }

    fn report(workbench: &mut Workbench, report: &Report) {
        match report {
            Report::Device(_) => workbench.tabs.chart.restarted(),
            Report::Picture(picture) => workbench.tabs.chart.note(picture),
            Report::Error(result) => workbench.error_came(result.clone()),
            _ => {}
        }
    }

    fn poll(workbench: &mut Workbench) {
        let chart = &mut workbench.tabs.chart;
        if chart.folder.as_mut().is_some_and(Folder::take) {
            chart.chosen.forget();
        }
        workbench.poll_gather();
    }

    fn end_frame(workbench: &mut Workbench, ui: &Ui) {
        workbench.request_errors(ui);
    }

    fn awaits(workbench: &Workbench) -> bool {
        let chart = &workbench.tabs.chart;
        let reading = chart.folder.as_ref().is_some_and(|f| f.data.is_none());
        workbench.dock.shows_tab::<Chart>()
            && (reading || chart.live.awaits() || workbench.error_pending())
    }
}

impl Workbench {
    fn chart_tab(&mut self, ui: &mut Ui) {
        ui.weak("Error against time, from the path-traced reference: points of a sweep, and the shown picture.");
        self.folder_row(ui);
        let chart = &mut self.tabs.chart;
        let data = chart.chosen.refresh(chart.folder.as_ref(), &chart.choice);
        self.choice_row(ui, data.as_deref());
        let differences = self.differences(data.as_deref());
        let title = self.tabs.chart.choice.metric.axis();
        let lives = [0, 1].map(|side| self.tabs.chart.live.dot(side, self.sent.number));
        let height = (ui.available_height() - 195.0).clamp(120.0, 520.0);
        let shown = plot::Shown {
            chosen: &self.tabs.chart.chosen,
            fits: differences.is_empty(),
            live: lives.each_ref().map(Option::as_ref),
            title: &title,
        };
        let name = format!(
            "{:?} {:?}",
            self.tabs.chart.folder.as_ref().map(|f| &f.path),
            self.tabs.chart.choice
        );
        if data.is_none() && lives.iter().all(Option::is_none) {
            // Axes without a point mean nothing.
            return self.live_rows(ui, &title, &lives);
        }
        let drawn = plot::show(ui, &name, height, &shown);
        if !differences.is_empty() {
            let text = format!("the sweep differs: {}", differences.join(", "));
            ui.weak(text).on_hover_text(
                "Errors of different pictures cannot be compared. A click on a dot loads its settings.",
            );
        }
        ui.weak(
            "Lower is better. Red: Pareto front; hollow: below the noise floor; diamonds: A, B.",
        );
        self.live_rows(ui, &title, &lives);
        let Some(data) = data else { return };
        let scored = drawn.hovered.map(|i| &self.tabs.chart.chosen.dots[i]);
        if let Some((dot, error)) = scored.and_then(|s| Some((data.dots.get(s.index)?, s.error))) {
            self.tabs
                .chart
                .thumbnail
                .show(&drawn.response, dot, &title, error, &self.setup.wake);
            if drawn.response.clicked() {
                self.load_point(dot);
            }
        }
        self.log_dots(ui, &data, &drawn.places, &differences);
    }

    /// The differences of the picture from the subject of the sweep.
    fn differences(&self, data: Option<&Data>) -> Vec<String> {
        let Chart { live, choice, .. } = &self.tabs.chart;
        let device = self.device.as_ref().map_or("", |d| d.name.as_str());
        let subject = data.and_then(|d| d.keys.get(choice.subject));
        let mut list: Vec<String> = match (live.subject(), subject) {
            (Some(now), Some(subject)) => folder::differences(now, device, subject)
                .into_iter()
                .map(String::from)
                .collect(),
            _ => Vec::new(),
        };
        let swept = data.and_then(|d| d.samples.get(choice.subject));
        list.extend(swept.and_then(|swept| live.reference_differs(swept)));
        list
    }

    fn folder_row(&mut self, ui: &mut Ui) {
        let chart = &mut self.tabs.chart;
        let captures = &self.setup.home.captures;
        let folders = chart.folders.get_or_insert_with(|| folder::list(captures));
        let folders = folders.clone();
        let shown = chart.folder.as_ref().map(|f| f.path.clone());
        let mut chosen = None;
        ui.horizontal(|ui| {
            let name = shown.as_deref().map_or("no sweep".into(), folder::name);
            egui::ComboBox::from_id_salt("sweep")
                .selected_text(format!("sweep: {name}"))
                .show_ui(ui, |ui| {
                    for path in &folders {
                        let other = folder::name(path);
                        if ui.selectable_label(other == name, other).clicked() {
                            chosen = Some(path.clone());
                        }
                    }
                });
            let about = "Reads captures/sweeps and the sweep again";
            let refresh = ui.small_button("refresh").on_hover_text(about);
            if refresh.clicked() {
                chart.folders = None;
                chosen.clone_from(&shown);
            }
        });
        if shown.is_none() && chosen.is_none() {
            chosen = folders.first().cloned();
        }
        if let Some(path) = chosen {
            chart.folder = Some(Folder::open(path, &self.setup.wake));
            chart.chosen.forget();
            (chart.choice.subject, chart.by_hand) = (0, false);
        }
        match chart.folder.as_ref().map(|f| &f.data) {
            None => drop(ui.weak(
                "Right click a parameter and choose Sweep… to measure several of its values; the points appear here.",
            )),
            Some(None) => drop(ui.weak("reading")),
            Some(Some(Err(why))) => drop(ui.colored_label(ui.visuals().error_fg_color, why)),
            Some(Some(Ok(_))) => {}
        }
    }

    fn choice_row(&mut self, ui: &mut Ui, data: Option<&Data>) {
        let chart = &mut self.tabs.chart;
        let choice = &mut chart.choice;
        // The subject of the chart: the chosen one, else the picture's.
        if let (Some(data), Some(now), false) = (data, chart.live.subject(), chart.by_hand) {
            let device = self.device.as_ref().map_or("", |d| d.name.as_str());
            let fits = |key: &_| folder::differences(now, device, key).is_empty();
            let place = data.keys.iter().position(fits);
            choice.subject = place.unwrap_or(choice.subject);
        }
        let graph = self.sides[0].info.as_ref().map(|info| &info.graph);
        let own = graph.map_or(Vec::new(), |graph| {
            parts_of(graph).into_iter().map(|p| p.name).collect()
        });
        let parts = data.map(|d| &d.parts).filter(|p| !p.is_empty());
        ui.horizontal_wrapped(|ui| {
            egui::ComboBox::from_id_salt("part")
                .selected_text(format!("part: {}", choice.part))
                .show_ui(ui, |ui| {
                    for part in parts.unwrap_or(&own) {
                        ui.selectable_value(&mut choice.part, part.clone(), part);
                    }
                });
            egui::ComboBox::from_id_salt("metric")
                .selected_text(format!("error: {}", choice.metric.axis()))
                .show_ui(ui, |ui| {
                    for metric in Metric::ranking() {
                        ui.selectable_value(&mut choice.metric, metric, metric.axis());
                    }
                });
        });
        let Some(data) = data.filter(|d| d.subjects.len() > 1) else {
            return;
        };
        let name = |i: usize| data.subjects.get(i).map_or("", String::as_str);
        let menu = egui::ComboBox::from_id_salt("subject").selected_text(name(choice.subject));
        let menu = menu.width(280.0).show_ui(ui, |ui| {
            for i in 0..data.subjects.len() {
                let row = ui.selectable_value(&mut choice.subject, i, name(i));
                chart.by_hand |= row.clicked();
            }
        });
        named(
            &menu.response,
            egui::WidgetType::ComboBox,
            "scene, camera and size",
        );
    }

    /// Shows a point's experiment in side A, at its size: then its error can be compared.
    fn load_point(&mut self, dot: &Dot) {
        let Some(folder) = &self.tabs.chart.folder else {
            return;
        };
        let short: String = dot.id.chars().take(8).collect();
        let name = format!("{}-{short}", folder::name(&folder.path));
        match Experiment::from_text(&folder.path.join(format!("{name}.ron")), &dot.experiment) {
            Ok(mut experiment) => {
                if let Some(info) = self.sides[0]
                    .info
                    .as_ref()
                    .filter(|o| runs(&o.graph.name, &experiment.graph))
                {
                    without_defaults(&mut experiment, &info.graph.params);
                }
                self.layout.fixed_size = Some(experiment.size);
                self.open(&experiment);
                self.messages.status = format!("loaded {name}");
                self.event(
                    "loaded point",
                    json!({ "id": dot.id, "name": name, "params": experiment_params(&experiment) }),
                );
            }
            Err(errors) => self.sides[0].errors = errors,
        }
    }

    /// Logs where the dots are, in points, for scripts.
    fn log_dots(&mut self, ui: &Ui, data: &Data, places: &[egui::Pos2], differences: &[String]) {
        if self.setup.events.is_none() {
            return;
        }
        let chosen = &self.tabs.chart.chosen;
        let dots = chosen.dots.iter().zip(places).zip(&chosen.on_front).take(MAX_LOGGED).map(|((s, at), front)| {
            json!({ "id": data.dots[s.index].id, "at": [at.x.round(), at.y.round()], "ms": s.ms, "error": s.error,
                "front": front })
        });
        let logged = json!({ "part": self.tabs.chart.choice.part, "metric": self.tabs.chart.choice.metric.key, "differs": differences,
            "dots": dots.collect::<Vec<_>>() });
        if logged == self.tabs.chart.logged {
            return;
        }
        // The dots move as long as the diamond does.
        let age = self.tabs.chart.logged_at.map_or(LOG_AGE, |t| t.elapsed());
        if age < LOG_AGE {
            ui.ctx().request_repaint_after(LOG_AGE - age);
        } else {
            self.tabs.chart.logged_at = Some(Instant::now());
            self.tabs.chart.logged = logged.clone();
            self.event("dots", logged);
        }
    }
}

/// Whether an experiment's graph is the one of this name.
fn runs(name: &str, graph: &str) -> bool {
    crate::workbench::short(graph) == crate::workbench::short(name)
}

fn without_defaults(experiment: &mut Experiment, defaults: &Params) {
    experiment.params.retain(|(name, text)| {
        let param = defaults.param(&name.value);
        param.is_none_or(|p| p.parse(text).ok().as_ref() != Some(&p.default))
    });
}

fn experiment_params(experiment: &Experiment) -> Value {
    experiment
        .params
        .iter()
        .map(|(name, text)| (name.value.clone(), Value::from(text.clone())))
        .collect()
}

/// The data of the folder that is shown.
impl Chart {
    /// Shows a sweep, and reads it again if it is shown already.
    pub(in crate::workbench) fn follow(&mut self, path: &Path, wake: &Wake) {
        match self.folder.as_mut().filter(|f| f.path == path) {
            Some(folder) => folder.read(wake),
            None => {
                self.folder = Some(Folder::open(path.into(), wake));
                self.folders = None;
                self.chosen.forget();
                (self.choice.subject, self.by_hand) = (0, false);
            }
        }
    }

    fn data(&self) -> Option<&Arc<Data>> {
        self.folder.as_ref()?.data.as_ref()?.as_ref().ok()
    }
}
