//! The bar at the top: experiments, scenes, undo, comparisons; and the line at the foot.

use crate::experiment::Experiment;
use crate::graph::file::CompareDecl;
use crate::results::timers::Rows;
use crate::scene::missing_model;
use crate::workbench::desired::edit;
use crate::workbench::desired::request::SideRequest;
use crate::workbench::engine::Order;
use crate::workbench::engine::report::{GraphInfo, PictureReport};
use crate::workbench::panel::control::named;
use crate::workbench::tabs::gallery::Gallery;
use crate::workbench::tabs::surroundings::Surroundings;
use crate::workbench::tabs::tables::Tables;
use crate::workbench::{Workbench, ron_files, short, theme};
use egui::Ui;
use egui::scroll_area::ScrollBarVisibility;
use egui_phosphor::regular as icons;

impl Workbench {
    /// The row at the top. It never wraps: a narrow window scrolls its left part.
    pub(super) fn bar(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let left = (ui.available_width() - RIGHT).max(120.0);
            let scroll = egui::ScrollArea::horizontal().max_width(left);
            let scroll = scroll.scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
            scroll.show(ui, |ui| ui.horizontal(|ui| self.bar_left(ui)));
            let right = egui::Layout::right_to_left(egui::Align::Center);
            ui.with_layout(right, |ui| self.bar_right(ui));
        });
    }

    /// Files, undo, comparisons.
    fn bar_left(&mut self, ui: &mut Ui) {
        self.file_menu(ui);
        self.experiments_menu(ui);
        self.scenes_menu(ui);
        self.warning_count(ui);
        ui.separator();
        let (undo, redo) = self.undo.history.can();
        for (can, back, icon, name, about) in [
            (undo, true, icons::ARROW_U_UP_LEFT, "undo", "Undo (Ctrl Z)"),
            (
                redo,
                false,
                icons::ARROW_U_UP_RIGHT,
                "redo",
                "Redo (Ctrl Shift Z)",
            ),
        ] {
            ui.add_enabled_ui(can, |ui| {
                if icon_button(ui, icon, name, about, false) {
                    self.go(back);
                }
            });
        }
        ui.separator();
        let compares = self.desired.sides[1].is_some();
        let toggle = ui.selectable_label(compares, "A | B").on_hover_text(
            "Compares with a second experiment (B). Switching it off restores A's earlier values unless A was edited",
        );
        if toggle.clicked() {
            self.toggle_comparison();
        }
        self.comparisons(ui);
        if self.desired.sides[1].is_some() {
            self.compare_bar(ui);
        }
    }

    /// Starts a comparison with a copy of A, or ends it.
    pub(super) fn toggle_comparison(&mut self) {
        match self.desired.sides[1].is_some() {
            false => {
                let a = &self.desired.sides[0];
                self.compare_sides([a.clone(), a.clone()]);
            }
            true => self.end_comparison(),
        }
    }

    /// Icons of views and settings, from right to left.
    fn bar_right(&mut self, ui: &mut Ui) {
        if icon_button(ui, icons::QUESTION, "help", "Help (F1)", self.layout.help) {
            self.layout.help = !self.layout.help;
        }
        self.settings_menu(ui);
        let shown = !self.layout.hidden;
        if icon_button(
            ui,
            icons::SIDEBAR_SIMPLE,
            "panels",
            "Show the panels (H)",
            shown,
        ) {
            self.layout.hidden = shown;
        }
        let about = "Capture the experiment and its picture (F12)";
        if icon_button(ui, icons::CAMERA, "capture now", about, false) {
            self.capture();
        }
        let about = "GPU times over the picture: stages, passes, none (T)";
        let timers = self.view.timers != Rows::None;
        if icon_button(ui, icons::TIMER, "timers", about, timers) {
            self.view.timers = self.view.timers.next();
        }
        let about = "Continuous: render without pause, to measure; otherwise only when something changes (C)";
        let continuous = self.desired.continuous;
        if icon_button(ui, icons::INFINITY, "continuous", about, continuous) {
            self.desired.continuous = !continuous;
        }
        let playing = self.desired.clock.playing;
        let icon = if playing { icons::PAUSE } else { icons::PLAY };
        if icon_button(ui, icon, "play time", "Play or pause time (Space)", playing) {
            self.desired.clock.playing = !playing;
        }
    }

    fn file_menu(&mut self, ui: &mut Ui) {
        let menu = ui.menu_button("File", |ui| {
            let row = |ui: &mut Ui, text: &str, keys: &str| {
                let button = egui::Button::new(text).right_text(keys);
                ui.add(button).clicked()
            };
            if row(ui, "Open…", "Ctrl O") {
                self.scene.models.ask();
            }
            ui.menu_button("Recent", |ui| self.recent_files(ui));
            if row(ui, "Save", "Ctrl S") {
                self.save(false);
            }
            if row(ui, "Save as…", "") {
                self.dock.open_tab::<Gallery>();
            }
            if row(ui, "Capture", "F12") {
                self.capture();
            }
        });
        menu.response.on_hover_text("Open, save, capture");
    }

    fn recent_files(&mut self, ui: &mut Ui) {
        let mut chosen = None;
        for path in &self.experiment.recent {
            let name = short(&path.to_string_lossy());
            let row = ui.button(name).on_hover_text(path.display().to_string());
            if row.clicked() {
                chosen = Some(path.clone());
                ui.close();
            }
        }
        if self.experiment.recent.is_empty() {
            ui.weak("No file was opened yet");
        }
        if let Some(path) = chosen {
            self.dropped(&path);
        }
    }

    /// Theme, size of text, and the layout.
    fn settings_menu(&mut self, ui: &mut Ui) {
        let icon = egui::RichText::new(icons::GEAR).size(16.0);
        let menu = ui.menu_button(icon, |ui| {
            ui.label(theme::title("Theme"));
            let mut theme = ui.ctx().options(|o| o.theme_preference);
            ui.horizontal(|ui| {
                for (choice, name) in [
                    (egui::ThemePreference::System, "System"),
                    (egui::ThemePreference::Dark, "Dark"),
                    (egui::ThemePreference::Light, "Light"),
                ] {
                    ui.selectable_value(&mut theme, choice, name);
                }
            });
            ui.ctx().set_theme(theme);
            ui.label(theme::title("Size"));
            ui.horizontal(|ui| {
                for percent in [80_u8, 100, 125, 150, 200] {
                    let size = f32::from(percent) / 100.0;
                    let is_it = (ui.ctx().zoom_factor() - size).abs() < 1e-3;
                    if ui.selectable_label(is_it, format!("{percent} %")).clicked() {
                        ui.ctx().set_zoom_factor(size);
                    }
                }
            });
            ui.weak("Also Ctrl + and Ctrl -");
            ui.separator();
            if ui.button("Reset the layout").clicked() {
                self.dock.reset();
                ui.close();
            }
        });
        let about = "Theme, size, layout";
        let response = menu.response.on_hover_text(about);
        named(&response, egui::WidgetType::Button, "settings");
    }

    /// Comparisons that the graph offers.
    fn comparisons(&mut self, ui: &mut Ui) {
        let Some(info) = self.sides[0].info.clone() else {
            return;
        };
        if info.graph.compare.is_empty() {
            return;
        }
        let mut chosen = None;
        let menu = ui.menu_button("Compare", |ui| {
            for compare in &info.graph.compare {
                let last = self.layout.compared.as_ref();
                let is_it = last.is_some_and(|(title, sides)| {
                    *title == compare.value.title && self.desired.sides == *sides
                });
                let row = ui
                    .selectable_label(is_it, &compare.value.title)
                    .on_hover_text(&compare.value.help);
                if row.clicked() {
                    chosen = Some(&compare.value);
                    ui.close();
                }
            }
        });
        menu.response
            .on_hover_text("Comparisons that the graph offers");
        if let Some(compare) = chosen {
            let sides = self.comparison_sides(&info, compare);
            self.layout.compared = Some((compare.title.clone(), sides.clone()));
            self.compare_sides(sides);
        }
    }

    /// A and B of a comparison that the graph offers.
    fn comparison_sides(
        &self,
        info: &GraphInfo,
        compare: &CompareDecl,
    ) -> [Option<SideRequest>; 2] {
        let base = self.desired.sides[0].clone().unwrap_or_default();
        [&compare.a, &compare.b].map(|values| {
            if let Some(graph) = CompareDecl::graph(values) {
                return Some(self.with_graph(&base, &graph));
            }
            let mut side = base.clone();
            for (name, text) in &values.0 {
                if let Some(param) = info.graph.params.param(&name.value)
                    && let Ok(value) = param.parse(&text.value.0)
                {
                    edit::set(&mut side, param, &value);
                }
            }
            Some(side)
        })
    }

    fn experiments_menu(&mut self, ui: &mut Ui) {
        let mut chosen = None;
        let mark = if self.experiment.modified { "● " } else { "" };
        let title = format!("{mark}experiment: {}", self.experiment.name);
        let response = ui.menu_button(title, |ui| {
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
        response.response.on_hover_text(match mark.is_empty() {
            true => "Presets: configs/*.ron",
            false => "Modified since it was opened or saved. Presets: configs/*.ron",
        });
        let Some((path, side)) = chosen else { return };
        match Experiment::read(&path) {
            Ok(experiment) if side == 0 => {
                self.opened_file(&path);
                self.session.file.clone_from(&path);
                self.open(&experiment);
            }
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
        let menu = ui.menu_button(format!("scene: {name}"), |ui| {
            for (name, about) in crate::scene::builtin::list() {
                if ui.button(name).on_hover_text(about).clicked() {
                    chosen = Some(name.to_string());
                    ui.close();
                }
            }
            ui.separator();
            let folder = self.setup.home.root.join("configs/scenes");
            let files = self.scene.files.get_or_insert_with(|| {
                let files = ron_files(&folder).into_iter();
                files.map(|f| (missing_model(&f), f)).collect()
            });
            for (missing, path) in files {
                let button = egui::Button::new(short(&path.to_string_lossy()));
                let button = ui.add_enabled(missing.is_none(), button);
                if button.clicked() {
                    chosen = Some(path.to_string_lossy().into_owned());
                    ui.close();
                }
                if let Some(missing) = missing {
                    button.on_disabled_hover_text(missing.as_str());
                }
            }
            ui.separator();
            if let Some(spec) = self.scene.models.menu(ui) {
                chosen = Some(spec);
                ui.close();
            }
        });
        if menu.inner.is_none() {
            self.scene.files = None;
        }
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
        let text =
            egui::RichText::new(format!("warnings: {count}")).color(ui.visuals().warn_fg_color);
        if ui
            .small_button(text)
            .on_hover_text("Show them on the Scene tab")
            .clicked()
        {
            self.dock.open_tab::<Surroundings>();
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
                ui.label(&device.name).on_hover_text(&device.driver);
            }
            ui.label(&self.messages.status);
            ui.weak(format!("watching {} folders", self.watch.folder_count()))
                .on_hover_ui(|ui| drop(ui.label(self.watch.summary())));
            if let Some(what) = self.pending(ui.ctx()) {
                ui.colored_label(ui.visuals().warn_fg_color, what);
            }
        });
    }

    /// The state of the picture, in the row of its tab; from right to left.
    pub(super) fn picture_state(&mut self, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.x = 12.0;
        ui.add_space(4.0);
        let roles = theme::roles(ui);
        for (side, name) in [(1, "B"), (0, "A")] {
            let both = self.desired.sides[1].is_some();
            let Some(picture) = &self.sides[side].picture else {
                continue;
            };
            if let Some(error) = self.tabs.chart.known_error(side, self.sent.number) {
                ui.label(error).on_hover_text("Error against the reference");
            }
            let time = format!("{:.2} ms", picture.times.gpu_ms);
            ui.label(time)
                .on_hover_text("GPU time of the last frame, from its first command to its last");
            let (text, done) = self.convergence(side, picture);
            let color = if done { roles.good } else { roles.modified };
            ui.colored_label(color, text).on_hover_text(
                "Some settings gather light over several frames. The picture is final once it has converged",
            );
            if both {
                ui.strong(name);
            }
        }
        if let Some(picture) = &self.sides[0].picture {
            ui.label(format!("{}x{}", picture.size[0], picture.size[1]))
                .on_hover_text("Size of the picture, pixels");
        }
        if let Some(text) = self.comparison_text() {
            ui.label(text);
        }
        if self.is_pointed() && self.click_fills_tables() && ui.link("Probe: show tables").clicked()
        {
            self.dock.open_tab::<Tables>();
        }
    }

    /// How far a side's picture has converged, and whether it has.
    fn convergence(&self, side: usize, picture: &PictureReport) -> (String, bool) {
        if !self.sides[side].errors.is_empty() {
            return ("last good build".into(), false);
        }
        if picture.preview || picture.request < self.sent.number {
            return ("rendering".into(), false);
        }
        match picture.left {
            _ if self.desired.continuous || self.desired.clock.playing => ("running".into(), false),
            0 => ("converged".into(), true),
            left => {
                let frame = picture.asked.saturating_sub(left);
                (format!("frame {frame} of {}", picture.asked), false)
            }
        }
    }
}

/// Width of the icons at the right of the bar, points.
const RIGHT: f32 = 232.0;

/// A button with an icon, its name for screen readers and scripts, and a tooltip.
fn icon_button(ui: &mut Ui, icon: &str, name: &str, about: &str, on: bool) -> bool {
    let button = egui::Button::selectable(on, egui::RichText::new(icon).size(16.0));
    let button = ui.add(button);
    named(&button, egui::WidgetType::Button, name);
    button.on_hover_text(about).clicked()
}
