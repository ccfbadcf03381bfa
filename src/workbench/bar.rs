//! The bar at the top: experiments, scenes, undo, comparisons; and the line at the foot.

use crate::diagnostics::{Entries, RawText};
use crate::experiment::Experiment;
use crate::graph::file::CompareDecl;
use crate::results::timers::Rows;
use crate::workbench::desired::edit;
use crate::workbench::desired::request::SideRequest;
use crate::workbench::engine::Order;
use crate::workbench::messages::AMBER;
use crate::workbench::panel::control::CHANGED;
use crate::workbench::tabs::surroundings::Surroundings;
use crate::workbench::{Workbench, ron_files, short};
use egui::Ui;

impl Workbench {
    pub(super) fn bar(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.strong("conelab");
            self.experiments_menu(ui);
            self.scenes_menu(ui);
            self.warning_count(ui);
            ui.separator();
            let (undo, redo) = self.undo.history.can();
            if ui.add_enabled(undo, egui::Button::new("undo")).on_hover_text("Ctrl Z").clicked() {
                self.go(true);
            }
            if ui.add_enabled(redo, egui::Button::new("redo")).on_hover_text("Ctrl Shift Z").clicked() {
                self.go(false);
            }
            ui.separator();
            let mut compare = self.desired.sides[1].is_some();
            if ui
                .toggle_value(&mut compare, "A | B")
                .on_hover_text(
                    "A second experiment beside the first; off, A is again what it was, unless it was edited",
                )
                .clicked()
            {
                match compare {
                    true => self.compare_sides([self.desired.sides[0].clone(), self.desired.sides[0].clone()]),
                    false => self.end_comparison(),
                }
            }
            self.comparisons(ui);
            if self.desired.sides[1].is_some() {
                self.compare_bar(ui);
            }
            ui.separator();
            ui.toggle_value(&mut self.desired.continuous, "keep rendering").on_hover_text(
                "Frames are rendered when something changes; with this also when nothing does, to measure",
            );
            let mut timers = self.view.timers != Rows::None;
            if ui.toggle_value(&mut timers, "timers").on_hover_text("T: GPU times on the picture").clicked() {
                self.view.timers = if timers { Rows::Stages } else { Rows::None };
            }
            if timers {
                ui.selectable_value(&mut self.view.timers, Rows::Stages, "stages");
                ui.selectable_value(&mut self.view.timers, Rows::Passes, "passes");
            }
            let mut panels = !self.layout.hidden;
            if ui.toggle_value(&mut panels, "panels").on_hover_text("H").clicked() {
                self.layout.hidden = !panels;
            }
            if ui.button("help").on_hover_text("F1").clicked() {
                self.layout.help = !self.layout.help;
            }
        });
    }

    /// Comparisons that the graph offers: each is one click.
    fn comparisons(&mut self, ui: &mut Ui) {
        let Some(info) = self.sides[0].info.clone() else {
            return;
        };
        for compare in &info.graph.compare {
            let button = ui
                .button(&compare.value.title)
                .on_hover_text(&compare.value.help);
            if button.clicked() {
                let base = self.desired.sides[0].clone().unwrap_or_default();
                let make = |values: &Entries<RawText>| {
                    if let Some(graph) = CompareDecl::graph(values) {
                        return self.with_graph(&base, &graph);
                    }
                    let mut side = base.clone();
                    for (name, text) in &values.0 {
                        if let Some(param) = info.graph.params.param(&name.value)
                            && let Ok(value) = param.parse(&text.value.0)
                        {
                            edit::set(&mut side, param, &value);
                        }
                    }
                    side
                };
                self.compare_sides([Some(make(&compare.value.a)), Some(make(&compare.value.b))]);
            }
        }
    }

    fn experiments_menu(&mut self, ui: &mut Ui) {
        let mut chosen = None;
        let response = ui.menu_button(format!("experiment: {}", self.experiment.name), |ui| {
            for path in ron_files(&self.setup.home.root.join("configs")) {
                let name = path
                    .file_stem()
                    .map_or(String::new(), |s| s.to_string_lossy().into_owned());
                ui.horizontal(|ui| {
                    if ui.button(&name).clicked() {
                        chosen = Some((path.clone(), 0));
                        ui.close();
                    }
                    if ui.small_button("as B").clicked() {
                        chosen = Some((path.clone(), 1));
                        ui.close();
                    }
                });
            }
        });
        response.response.on_hover_text("Presets: configs/*.ron");
        let Some((path, side)) = chosen else { return };
        match Experiment::read(&path) {
            Ok(experiment) if side == 0 => self.open(&experiment),
            Ok(experiment) => self.compare_sides([
                self.desired.sides[0].clone(),
                Some(SideRequest::of(&experiment)),
            ]),
            Err(errors) => self.sides[side].errors = errors,
        }
    }

    fn scenes_menu(&mut self, ui: &mut Ui) {
        let mut chosen = None;
        let name = if self.scene.missing {
            "none".into()
        } else {
            short(&self.desired.scene)
        };
        ui.menu_button(format!("scene: {name}"), |ui| {
            for (name, about) in crate::scene::builtin::list() {
                if ui.button(name).on_hover_text(about).clicked() {
                    chosen = Some(name.to_string());
                    ui.close();
                }
            }
            ui.separator();
            for path in ron_files(&self.setup.home.root.join("configs/scenes")) {
                if ui.button(short(&path.to_string_lossy())).clicked() {
                    chosen = Some(path.to_string_lossy().into_owned());
                    ui.close();
                }
            }
            ui.separator();
            if let Some(spec) = self.scene.models.menu(ui) {
                chosen = Some(spec);
                ui.close();
            }
        });
        if let Some(spec) = chosen {
            self.open_scene(&spec);
        }
    }

    /// The number of the scene's warnings, which lead to the list.
    fn warning_count(&mut self, ui: &mut Ui) {
        let count = self.scene_warning_count();
        if count == 0 {
            return;
        }
        let text = egui::RichText::new(format!("warnings: {count}")).color(AMBER);
        if ui
            .small_button(text)
            .on_hover_text("Show them on the Scene tab")
            .clicked()
        {
            self.tabs.open::<Surroundings>();
        }
    }

    pub(super) fn status_line(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            if let Some((what, part)) = self.scene.loading.clone() {
                let lasts = self.sent.at.elapsed().as_secs();
                ui.add(
                    egui::ProgressBar::new(part)
                        .desired_width(200.0)
                        .text(format!("{what}, {lasts} s")),
                );
                ui.ctx()
                    .request_repaint_after(std::time::Duration::from_secs(1));
                if ui.small_button("cancel").clicked() {
                    self.engine.order(Order::CancelLoading);
                }
            }
            if let Some(device) = &self.device {
                ui.weak(&device.name).on_hover_text(&device.driver);
            }
            if let Some(p) = &self.sides[0].picture {
                ui.weak(format!("{}x{}", p.size[0], p.size[1]));
                ui.weak(format!("last frame {:.2} ms", p.times.gpu_ms))
                    .on_hover_text("On the GPU, from first to last command");
                if p.preview {
                    ui.weak("preview, while the passes are built");
                }
            }
            ui.weak(format!("watching {} folders", self.watch.folder_count()))
                .on_hover_ui(|ui| drop(ui.label(self.watch.summary())));
            if let Some(what) = self.pending(ui.ctx()) {
                ui.colored_label(CHANGED, what);
            }
            ui.label(&self.messages.status);
        });
    }
}
