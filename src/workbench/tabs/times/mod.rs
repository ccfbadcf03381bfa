//! The profiler: GPU and CPU time per frame, stage and pass, memory per resource, and exports.

mod chart;
mod details;
mod export;
mod files;
mod history;
mod table;
mod trace;
mod view;

use super::Tab;
use crate::graph::run::{Execution, PassExecutables};
use crate::results::timers;
use crate::workbench::Workbench;
use crate::workbench::engine::report::{GraphInfo, PictureReport, Report};
use chart::{Chart, Look};
use details::Wish;
use egui::{TextureId, Ui};
use history::{Frame, History};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};
pub(crate) use table::BETWEEN;
use table::{Row, Sort, Table};
use view::{Grid, Kind, Line};

/// Interval between updates of a table.
const TABLE_AGE: Duration = Duration::from_millis(250);
/// Height of the chart of one side and of each of two, points.
const CHART: [f32; 2] = [96.0, 76.0];

/// State of this tab.
#[derive(Default)]
pub struct Times {
    sides: [History; 2],
    /// The histories as they were when the user stopped taking in frames.
    frozen: Option<Box<[History; 2]>>,
    held: Option<Held>,
    charts: [Chart; 2],
    table: Table,
    /// When the table was made, and from which changes.
    made: Option<(Instant, [u64; 2])>,
    sort: Sort,
    /// Names of folded stages.
    folded: BTreeSet<String>,
    /// Name of the pass with details.
    selected: Option<String>,
    /// Name and bytes of A's resources, the largest first.
    memory: Vec<(String, u64)>,
    scene_bytes: u64,
    /// Name of the pass under the pointer.
    hovered: Option<String>,
    /// The change count of a side's history, and its time.
    means: [Option<(u64, Instant, Arc<Means>)>; 2],
    statistics: [Asked; 2],
}

/// A frame that the table shows instead of means.
struct Held {
    /// Number of the frame since the histories began.
    number: u64,
    frames: [Option<Frame>; 2],
}

/// Statistics of a side's pipelines.
#[derive(Default)]
enum Asked {
    #[default]
    No,
    Waiting,
    Answered(Result<Vec<PassExecutables>, String>),
}

/// Mean times of a side's last frames on the GPU.
#[derive(Default)]
pub struct Means {
    /// (number, ms) of its passes, in order; none without frames.
    pub passes: Vec<(usize, f64)>,
    /// Numbers of the passes that the last frame skipped.
    pub skipped: Vec<usize>,
    /// Time of no pass, ms.
    pub between: f64,
    /// From the first command to the last, ms.
    pub total: f64,
}

impl Tab for Times {
    const TITLE: &'static str = "Profiler";
    const ICON: &'static str = egui_phosphor::regular::GAUGE;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.times_tab(ui);
    }

    fn report(workbench: &mut Workbench, report: &Report) {
        let times = &mut workbench.tabs.times;
        match report {
            Report::Built(built) => times.built(built.side, &built.info),
            Report::Restarted => times.restarted(),
            Report::Picture(picture) => times.note(picture),
            Report::Statistics(side, result) => {
                times.statistics[*side] = Asked::Answered(result.clone());
            }
            _ => {}
        }
    }
}

impl Times {
    /// Takes in the times of a frame.
    fn note(&mut self, picture: &PictureReport) {
        // The passes of a preview are those of another graph.
        let side = self.sides.get_mut(picture.side);
        if let Some(side) = side.filter(|_| !picture.preview) {
            side.push(Frame::of(picture));
        }
    }

    /// A side runs a new session. Frames of A and B count from the same moment, so both histories
    /// begin again.
    fn built(&mut self, side: usize, info: &GraphInfo) {
        self.sides[side] = History::of(info);
        self.statistics[side] = Asked::No;
        // Every pass gets its colour in the graph's order, however the tables are sorted later.
        for pass in &self.sides[side].passes {
            timers::color(&pass.name);
        }
        self.restarted();
        if side == 0 {
            self.memory.clone_from(&info.memory);
            self.memory
                .sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
            self.scene_bytes = info.scene_bytes;
        }
    }

    /// A and B restart together.
    fn restarted(&mut self) {
        for side in &mut self.sides {
            *side = History {
                changes: side.changes + 1,
                ..History::new(std::mem::take(&mut side.passes))
            };
        }
        (self.made, self.means) = (None, [None, None]);
        if self.frozen.is_none() {
            self.held = None;
        }
    }

    /// The histories that the tab shows.
    fn shown(&self) -> &[History; 2] {
        self.frozen.as_deref().unwrap_or(&self.sides)
    }

    /// Stops and continues to take in frames.
    fn freeze(&mut self, freezes: bool) {
        self.frozen = freezes.then(|| Box::new(self.sides.clone()));
        (self.made, self.held) = (None, None);
    }

    /// Shows a frame in the table; the same one again: the means.
    fn hold(&mut self, number: u64) {
        let frames = self.shown().each_ref().map(|side| side.at(number).cloned());
        let again = self.held.as_ref().is_some_and(|h| h.number == number);
        self.held = (!again).then_some(Held { number, frames });
        self.made = None;
    }

    /// Mean times of a side, computed as often as the table and not in every frame of the
    /// interface.
    pub fn means(&mut self, ui: &egui::Context, side: usize, both: bool) -> Arc<Means> {
        let history = &self.sides[side];
        if let Some((changes, since, known)) = &self.means[side] {
            let age = since.elapsed();
            if *changes == history.changes {
                return known.clone();
            }
            if age < TABLE_AGE {
                ui.request_repaint_after(TABLE_AGE - age);
                return known.clone();
            }
        }
        let numbers = history::common(&self.sides, both);
        let frames = history.range(numbers);
        let count = frames.clone().count();
        let mean = |time: &dyn Fn(&Frame) -> f64| {
            frames.clone().map(time).sum::<f64>() / count.max(1) as f64
        };
        let of_pass = |pass: &history::Pass| (pass.number, mean(&|f| f.pass(pass.number)));
        let shown = history.passes.iter().filter(|_| count > 0);
        let last = history.frames.back();
        let made = Arc::new(Means {
            passes: shown.map(of_pass).collect(),
            skipped: last.map_or(Vec::new(), |f| f.times.skipped.clone()),
            between: mean(&Frame::between),
            total: mean(&|f| f.times.gpu_ms),
        });
        self.means[side] = Some((history.changes, Instant::now(), made.clone()));
        made
    }

    /// Makes the table again if frames came, at most four times a second.
    fn refresh(&mut self, ui: &Ui, both: bool) {
        if !both && !self.sides[1].frames.is_empty() {
            self.sides[1] = History::default();
            self.made = None;
        }
        let changes = self.shown().each_ref().map(|side| side.changes);
        if let Some((since, of)) = self.made {
            let age = since.elapsed();
            if of == changes {
                return;
            }
            if age < TABLE_AGE {
                ui.ctx().request_repaint_after(TABLE_AGE - age);
                return;
            }
        }
        let held = self.held.as_ref().map(|held| &held.frames);
        self.table = Table::new(self.shown(), both, held);
        self.made = Some((Instant::now(), changes));
    }
}

/// Clicks of one frame of the interface.
#[derive(Default)]
struct Done {
    /// Number of the clicked frame.
    frame: Option<u64>,
    /// The clicked pass.
    pass: Option<String>,
    /// The clicked stage.
    stage: Option<String>,
    sort: Option<Sort>,
    hovered: Option<String>,
    wish: Option<Wish>,
}

impl Workbench {
    fn times_tab(&mut self, ui: &mut Ui) {
        let both = self.desired.sides[1].is_some();
        self.tabs.times.refresh(ui, both);
        // The scroll bar must not cover the last column.
        ui.set_max_width(ui.available_width() - 8.0);
        self.profiler_controls(ui);
        let mut done = Done::default();
        self.frame_graphs(ui, both, &mut done);
        let grid = Grid::new(ui, &self.tabs.times.table);
        let times = &self.tabs.times;
        done.sort = grid.head(ui, &times.table, times.sort);
        for row in [&times.table.total, &times.table.cpu] {
            let line = Line {
                row,
                kind: Kind::Sum,
                highlighted: false,
                selected: false,
                most: 0.0,
            };
            grid.line(ui, &times.table, &line);
        }
        ui.separator();
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| {
                ui.spacing_mut().item_spacing.y = 1.0;
                self.rows(ui, &grid, &mut done);
                ui.separator();
                self.tabs.times.memory(ui, &grid);
            });
        if let Some(wish) = done.wish.take() {
            self.carry_out(wish);
        }
        self.tabs.times.done(done);
    }

    /// Buttons for exports and for which frames are shown.
    fn profiler_controls(&mut self, ui: &mut Ui) {
        let some = self.tabs.times.shown().iter().any(|s| !s.frames.is_empty());
        let button = |ui: &mut Ui, text: &str, about: &str| {
            let response = ui.add_enabled(some, egui::Button::new(text));
            response.on_hover_text(about).clicked()
        };
        ui.horizontal_wrapped(|ui| {
            let mut frozen = self.tabs.times.frozen.is_some();
            let about = "Keeps these frames and ignores new ones. Rendering continues";
            if ui
                .toggle_value(&mut frozen, "Freeze")
                .on_hover_text(about)
                .clicked()
            {
                self.tabs.times.freeze(frozen);
            }
            let mut changed = self.desired.execution == Execution::Incremental;
            let about = "Skips passes with an unchanged result. The output is bit-identical";
            let toggle = ui.toggle_value(&mut changed, "Skip unchanged passes");
            if toggle.on_hover_text(about).clicked() {
                self.desired.execution = match changed {
                    true => Execution::Incremental,
                    false => Execution::Full,
                };
            }
            let about = "A row per frame and a column per pass, as a file in captures/";
            if button(ui, "Export CSV", about) {
                self.export_csv();
            }
            let about =
                "CPU and GPU timeline for Perfetto or chrome://tracing, as a file in captures/";
            if button(ui, "Export trace", about) {
                self.export_trace();
            }
        });
        let times = &mut self.tabs.times;
        ui.horizontal(|ui| match &times.held {
            None => {
                let of = if times.table.both { "A and B, " } else { "" };
                let last = match times.table.frames {
                    1 => "last frame".to_string(),
                    frames => format!("last {frames} frames"),
                };
                ui.label(format!("{of}{last}, ms"))
                    .on_hover_text("Click a frame in the graph to show its times");
            }
            Some(held) => {
                let number = held.number;
                ui.label(format!("frame {} is held, ms", number + 1));
                if ui.button("Show means").clicked() {
                    times.hold(number);
                }
            }
        });
    }

    fn frame_graphs(&mut self, ui: &mut Ui, both: bool, done: &mut Done) {
        let times = &mut self.tabs.times;
        let shown = times.frozen.as_deref().unwrap_or(&times.sides);
        let sides = usize::from(both);
        // One scale for both sides.
        let p95 = shown[..=sides].iter().map(|s| s.level().1);
        let top = chart::top(p95.fold(0.0, f64::max));
        for (side, history) in shown.iter().enumerate().take(sides + 1) {
            let look = Look {
                side,
                height: CHART[sides],
                top,
                held: times.held.as_ref().map(|h| h.number),
                hovered: times.hovered.as_deref(),
            };
            let (response, pointed) = times.charts[side].show(ui, history, &look);
            let Some(pointed) = pointed else {
                continue;
            };
            let frame = history.at(pointed.frame);
            let ms = frame.map_or(0.0, |f| f.times.gpu_ms);
            if response.clicked() {
                done.frame = Some(pointed.frame);
            }
            let pass = pointed.pass.as_deref().unwrap_or_default();
            response.on_hover_text_at_pointer(format!(
                "frame {}: {} ms\n{pass}\nClick to hold the frame",
                pointed.frame + 1,
                table::digits(ms)
            ));
            done.hovered = pointed.pass.or(done.hovered.take());
        }
        ui.add_space(4.0);
    }

    /// The stages and passes, in their order, with the details of the selected pass.
    fn rows(&self, ui: &mut Ui, grid: &Grid, done: &mut Done) {
        let times = &self.tabs.times;
        let (table, first) = (&times.table, grid.columns.first());
        let value = |row: &Row| first.and_then(|c| c.value(row, table)).unwrap_or(0.0);
        let rows = || table.stages.iter().map(|s| &s.row);
        let most = rows().map(value).fold(0.0, f64::max);
        let is = |name: &Option<String>, row: &Row| name.as_deref() == Some(row.name.as_str());
        let draw = |ui: &mut Ui, row: &Row, kind: Kind| {
            let pass = matches!(kind, Kind::Pass { .. });
            let line = Line {
                row,
                kind,
                highlighted: pass && is(&times.hovered, row),
                selected: pass && is(&times.selected, row),
                most,
            };
            grid.line(ui, table, &line)
        };
        let mut pass = |ui: &mut Ui, row: &Row, inner: bool| {
            let response = draw(ui, row, Kind::Pass { inner });
            if response.clicked() {
                done.pass = Some(row.name.clone());
            }
            if response.hovered() {
                done.hovered = Some(row.name.clone());
                response.on_hover_text_at_pointer(self.pass_text(row));
            }
            if is(&times.selected, row) {
                done.wish = self.pass_details(ui, row);
            }
        };
        for n in times.sort.order(rows(), table) {
            let stage = &table.stages[n];
            if stage.passes.is_empty() {
                pass(ui, &stage.row, false);
                continue;
            }
            let open = !times.folded.contains(&stage.row.name);
            if draw(ui, &stage.row, Kind::Stage { open }).clicked() {
                done.stage = Some(stage.row.name.clone());
            }
            for n in times.sort.order(stage.passes.iter(), table) {
                if open {
                    pass(ui, &stage.passes[n], true);
                }
            }
        }
        draw(ui, &table.between, Kind::Rest).on_hover_text_at_pointer(
            "GPU time outside passes. A barrier counts towards the pass after it",
        );
    }
}

impl Times {
    fn done(&mut self, done: Done) {
        self.hovered = done.hovered;
        self.sort = done.sort.unwrap_or(self.sort);
        if let Some(number) = done.frame {
            self.hold(number);
        }
        if let Some(stage) = done.stage.filter(|stage| !self.folded.remove(stage)) {
            self.folded.insert(stage);
        }
        if let Some(pass) = done.pass {
            self.selected = (self.selected.as_ref() != Some(&pass)).then_some(pass);
        }
    }

    fn memory(&self, ui: &mut Ui, grid: &Grid) {
        let mib = |b: u64| format!("{:.2} MiB", b as f64 / 1_048_576.0);
        let total: u64 = self.memory.iter().map(|m| m.1).sum();
        let title = format!(
            "Memory of A: {}, scene {}",
            mib(total),
            mib(self.scene_bytes)
        );
        egui::CollapsingHeader::new(title)
            .id_salt("memory")
            .default_open(true)
            .show(ui, |ui| {
                let most = self.memory.first().map_or(1, |m| m.1.max(1));
                for (name, bytes) in &self.memory {
                    grid.bar(ui, name, mib(*bytes), *bytes as f32 / most as f32);
                }
            });
    }
}
