//! GPU and CPU time per pass, memory per resource, and their export.

mod chart;
mod export;
mod history;

use super::Tab;
use crate::files::FileError;
use crate::graph::run::Execution;
use crate::results::timers;
use crate::workbench::Workbench;
use crate::workbench::engine::report::{GraphInfo, PassUses, PictureReport, Report};
use egui::{Align2, Color32, FontId, Pos2, Rect, Response, Sense, TextureId, Ui, Vec2};
use history::{Frame, History, KEPT, OUTSIDE, Row};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Interval between updates of a table.
const TABLE_AGE: Duration = Duration::from_millis(250);
/// Height of a row of the tables, points.
const ROW: f32 = 16.0;
/// Width of a number, points.
const NUMBER: f32 = 38.0;
/// Height of a chart, points.
const CHART: f32 = 90.0;

/// State of this tab.
#[derive(Default)]
pub struct Times {
    sides: [History; 2],
    charts: [chart::Chart; 2],
    rows: Vec<Row>,
    made: Option<Instant>,
    /// Name and bytes of A's resources, the largest first.
    memory: Vec<(String, u64)>,
    scene_bytes: u64,
    /// Name of the pass under the pointer.
    hovered: Option<String>,
    /// The change count of a side's history, and its time.
    means: [Option<(u64, Instant, Arc<Means>)>; 2],
}

/// Mean times of a side's last frames on the GPU.
#[derive(Default)]
pub struct Means {
    /// (number, ms) of its passes, in order; none without frames.
    pub passes: Vec<(usize, f64)>,
    /// Numbers of the passes that the last frame skipped.
    pub rests: Vec<usize>,
    /// Name and time of what no pass takes, ms.
    pub outside: (&'static str, f64),
    /// From the first command to the last, ms.
    pub total: f64,
}

impl Tab for Times {
    const TITLE: &'static str = "Time";
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
            _ => {}
        }
    }
}

impl Times {
    /// Takes in the times of a frame.
    fn note(&mut self, picture: &PictureReport) {
        // The passes of a preview are those of another graph.
        if let Some(side) = self
            .sides
            .get_mut(picture.side)
            .filter(|_| !picture.preview)
        {
            side.push(Frame::of(picture));
        }
    }

    /// A side runs a new session, so its earlier times are dropped.
    fn built(&mut self, side: usize, info: &GraphInfo) {
        let pass = |i: &usize| {
            info.graph
                .passes
                .get(*i)
                .map(|p| (*i, p.value.name.value.clone()))
        };
        self.sides[side] = History::new(info.passes.iter().filter_map(pass).collect());
        (self.made, self.means) = (None, [None, None]);
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
            *side = History::new(std::mem::take(&mut side.passes));
        }
        (self.made, self.means) = (None, [None, None]);
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
        // Both sides are averaged over the same number of frames.
        let count = if both {
            self.sides[0].frames.len().min(self.sides[1].frames.len())
        } else {
            KEPT
        };
        let of = |time: &dyn Fn(&Frame) -> f64| history.mean(count, time);
        let passes = history
            .passes
            .iter()
            .filter_map(|p| Some((p.0, of(&|f| f.pass(p.0))?)))
            .collect();
        let rests = history
            .frames
            .back()
            .map_or(Vec::new(), |f| f.times.skipped.clone());
        let total = of(&|f: &Frame| f.times.gpu_ms).unwrap_or(0.0);
        let outside = (OUTSIDE, of(&Frame::outside).unwrap_or(0.0));
        let made = Arc::new(Means {
            passes,
            rests,
            outside,
            total,
        });
        self.means[side] = Some((history.changes, Instant::now(), made.clone()));
        made
    }

    fn refresh(&mut self, both: bool) {
        if !both && !self.sides[1].frames.is_empty() {
            self.sides[1] = History::default();
            self.made = None;
        }
        if self.made.is_none_or(|t| t.elapsed() > TABLE_AGE) {
            self.made = Some(Instant::now());
            self.rows = history::rows(&self.sides[0], both.then_some(&self.sides[1]));
        }
    }
}

impl Workbench {
    fn times_tab(&mut self, ui: &mut Ui) {
        let both = self.desired.sides[1].is_some();
        self.tabs.times.refresh(both);
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| {
                // The scroll bar must not cover the last column.
                ui.set_max_width(ui.available_width() - 8.0);
                self.exports(ui);
                let mut hovered = None;
                let mut clicked = None;
                let top = (0..=usize::from(both))
                    .map(|i| self.tabs.times.sides[i].top())
                    .fold(0.0, f64::max);
                for i in 0..=usize::from(both) {
                    let shown = self.tabs.times.charts[i].show(
                        ui,
                        i,
                        &self.tabs.times.sides[i],
                        top,
                        self.tabs.times.hovered.as_deref(),
                    );
                    let Some((name, response)) = shown else {
                        continue;
                    };
                    if response.clicked() {
                        clicked = Some((i, name.clone()));
                    }
                    response.on_hover_text_at_pointer(self.pass_text(i, &name));
                    hovered = Some(name);
                }
                ui.add_space(4.0);
                head(ui, both);
                for n in 0..self.tabs.times.rows.len() {
                    let row = &self.tabs.times.rows[n];
                    let response = line(ui, row, both, self.tabs.times.hovered.as_deref());
                    if !row.is_pass || !response.hovered() {
                        continue;
                    }
                    let (side, name) = (usize::from(row.mean[0].is_none()), row.name.clone());
                    if response.clicked() {
                        clicked = Some((side, name.clone()));
                    }
                    response.on_hover_text_at_pointer(self.pass_text(side, &name));
                    hovered = Some(name);
                }
                self.tabs.times.hovered = hovered;
                if let Some((side, name)) = clicked {
                    self.inspect_pass(side, &name);
                }
                ui.separator();
                memory(ui, &self.tabs.times.memory, self.tabs.times.scene_bytes);
            });
    }

    fn exports(&mut self, ui: &mut Ui) {
        let mut file = None;
        ui.horizontal(|ui| {
            let sides = &self.tabs.times.sides;
            let some = sides.iter().any(|s| !s.frames.is_empty());
            let button = |ui: &mut Ui, text: &str, about: &str| {
                let button = egui::Button::new(text).small();
                ui.add_enabled(some, button).on_hover_text(about).clicked()
            };
            if button(ui, "CSV", "A row a frame, a column a pass, into captures/") {
                file = Some(("csv", export::csv(sides)));
            }
            let about = "For Perfetto or chrome://tracing, into captures/";
            if button(ui, "trace", about) {
                file = Some(("json", Ok(export::trace(sides))));
            }
            let kept = sides[0].frames.len();
            let mut changed = self.desired.execution == Execution::Incremental;
            let about =
                "Skips passes whose output would not change. The picture stays equal to the bit";
            let text = egui::RichText::new("what changes").small();
            let toggle = ui.toggle_value(&mut changed, text).on_hover_text(about);
            if toggle.clicked() {
                self.desired.execution = match changed {
                    true => Execution::Incremental,
                    false => Execution::Full,
                };
            }
            ui.weak(format!("the last {kept} frames"));
        });
        if let Some((ending, bytes)) = file {
            self.export(&format!("times-{}", self.experiment.name), ending, bytes);
        }
    }

    /// Writes an export into `captures/`, with a message.
    pub(crate) fn export(&mut self, name: &str, ending: &str, bytes: std::io::Result<Vec<u8>>) {
        let written = bytes.map_err(|e| FileError::content(name.as_ref(), e));
        let written = written.and_then(|b| write_free(&self.setup.home.root, name, ending, &b));
        let ok = written.is_ok();
        let text = match written {
            Ok(path) => format!("wrote {}", path.display()),
            Err(e) => format!("not written: {e}"),
        };
        self.event("exported", serde_json::json!({ "ok": ok, "text": text }));
        self.messages.status = text;
    }

    /// The outputs of a pass in words.
    fn pass_text(&self, side: usize, name: &str) -> String {
        let list = self.pass_writes(side, name).join(", ");
        match list.is_empty() {
            true => name.to_string(),
            false => format!("{name}\nwrites {list}\nclick to inspect it"),
        }
    }

    fn pass_writes(&self, side: usize, name: &str) -> &[String] {
        let Some(info) = &self.sides[side].info else {
            return &[];
        };
        let named = |u: &&PassUses| info.graph.pass_name(u.pass) == name;
        info.uses.iter().find(named).map_or(&[], |u| &u.writes)
    }

    /// Opens the first texture that a pass writes in the inspector.
    fn inspect_pass(&mut self, side: usize, name: &str) {
        let Some(info) = self.sides[side].info.clone() else {
            return;
        };
        let texture = |n: &&String| info.graph.texture(n).is_some();
        let Some(texture) = self.pass_writes(side, name).iter().find(texture).cloned() else {
            self.messages.status = format!("{name} writes no texture");
            return;
        };
        self.inspect(side, texture);
    }
}

/// Writes `captures/NAME.ENDING` under `root`, or with a number behind the name when that exists.
fn write_free(root: &Path, name: &str, ending: &str, bytes: &[u8]) -> Result<PathBuf, FileError> {
    let stem: String = name
        .chars()
        .map(|c| {
            if c.is_alphanumeric() || "-_".contains(c) {
                c
            } else {
                '_'
            }
        })
        .collect();
    for n in 1..10_000 {
        let number = if n == 1 {
            String::new()
        } else {
            format!("-{n}")
        };
        let path = root
            .join("captures")
            .join(format!("{stem}{number}.{ending}"));
        match crate::files::write_new(&path, bytes) {
            Err(e) if e.is_there() => {}
            other => return other.map(|()| path),
        }
    }
    Err(FileError::write(
        &root.join("captures").join(stem),
        "too many files of that name",
    ))
}

/// Right edges of the columns of numbers, as shares of the width.
fn columns(both: bool) -> &'static [f32] {
    if both {
        &[0.57, 0.73, 0.86, 1.0]
    } else {
        &[0.55, 0.70, 0.85, 1.0]
    }
}

fn head(ui: &mut Ui, both: bool) {
    let names: [&str; 4] = if both {
        ["A ms", "B ms", "B/A", "A %"]
    } else {
        ["mean ms", "p95 ms", "share", "max ms"]
    };
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::hover());
    let color = ui.visuals().weak_text_color();
    for (x, name) in columns(both).iter().zip(names) {
        put(ui, rect, *x, name, color);
    }
    response.on_hover_text(if both {
        "Means over the same number of the last frames of A and of B, which alternate"
    } else {
        "Mean, 95th percentile and maximum over the last frames; the share is that of the mean in the GPU's total"
    });
}

fn put(ui: &Ui, rect: Rect, x: f32, text: &str, color: Color32) {
    let at = Pos2::new(rect.left() + rect.width() * x - 2.0, rect.center().y);
    ui.painter().text(
        at,
        Align2::RIGHT_CENTER,
        text,
        FontId::monospace(10.5),
        color,
    );
}

fn line(ui: &mut Ui, row: &Row, both: bool, hovered: Option<&str>) -> Response {
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &row.name));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    if response.hovered() || (row.is_pass && hovered == Some(row.name.as_str())) {
        ui.painter()
            .rect_filled(rect, 2.0, ui.visuals().widgets.hovered.weak_bg_fill);
    }
    // Passes skipped on both sides are grey.
    let skipped = [0, 1].map(|side| row.mean[side].is_none() || row.skipped[side]) == [true; 2]
        && row.skipped != [false; 2];
    let color = if skipped {
        ui.visuals().weak_text_color()
    } else {
        ui.visuals().text_color()
    };
    let mut left = rect.left();
    if row.is_pass {
        let swatch =
            Rect::from_center_size(Pos2::new(left + 5.0, rect.center().y), Vec2::splat(8.0));
        ui.painter()
            .rect_filled(swatch, 1.0, timers::color(&row.name));
        left += 13.0;
    }
    // Names give way to numbers.
    let right = rect.left() + rect.width() * columns(both).first().copied().unwrap_or(1.0) - NUMBER;
    let names = Rect::from_min_max(Pos2::new(left, rect.top()), Pos2::new(right, rect.bottom()));
    let mut job = egui::text::LayoutJob::simple_singleline(
        row.title(both),
        FontId::proportional(11.5),
        color,
    );
    job.wrap = egui::text::TextWrapping::truncate_at_width(names.width());
    let galley = ui.painter().layout_job(job);
    let at = Align2::LEFT_CENTER
        .anchor_size(names.left_center(), galley.size())
        .min;
    ui.painter().galley(at, galley, color);
    for (x, text) in columns(both).iter().zip(&row.cells) {
        put(ui, rect, *x, text, color);
    }
    response
}

fn memory(ui: &mut Ui, list: &[(String, u64)], scene: u64) {
    let mib = |b: u64| format!("{:.2} MiB", b as f64 / 1_048_576.0);
    let total: u64 = list.iter().map(|m| m.1).sum();
    let title = format!("Memory of A: {}, scene {}", mib(total), mib(scene));
    egui::CollapsingHeader::new(title)
        .id_salt("memory")
        .default_open(true)
        .show(ui, |ui| {
            let most = list.first().map_or(1, |m| m.1.max(1));
            for (name, bytes) in list {
                let (rect, _) =
                    ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::hover());
                if !ui.is_rect_visible(rect) {
                    continue;
                }
                let part = (*bytes as f32 / most as f32).max(0.002);
                let bar = Rect::from_min_size(rect.min, Vec2::new(rect.width() * part, ROW - 2.0));
                ui.painter().rect_filled(
                    bar,
                    1.0,
                    ui.visuals()
                        .faint_bg_color
                        .lerp_to_gamma(Color32::from_rgb(60, 90, 140), 0.6),
                );
                let color = ui.visuals().text_color();
                let font = FontId::proportional(12.0);
                ui.painter().text(
                    rect.left_center() + Vec2::new(3.0, 0.0),
                    Align2::LEFT_CENTER,
                    name,
                    font,
                    color,
                );
                put(ui, rect, 1.0, &mib(*bytes), color);
            }
        });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_never_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let first = write_free(folder.path(), "times-a b/c", "csv", b"1").unwrap();
        let second = write_free(folder.path(), "times-a b/c", "csv", b"2").unwrap();
        assert_eq!(first, folder.path().join("captures/times-a_b_c.csv"));
        assert_eq!(second, folder.path().join("captures/times-a_b_c-2.csv"));
        assert_eq!(
            (
                std::fs::read(first).unwrap(),
                std::fs::read(second).unwrap()
            ),
            (b"1".to_vec(), b"2".to_vec())
        );
    }
}
