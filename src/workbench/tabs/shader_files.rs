//! The shader files of a pass, each of which opens in the editor.

use crate::diagnostics::Place;
use crate::workbench::Workbench;
use crate::workbench::engine::report::GraphInfo;
use egui::Ui;

/// Files of a pass in the shader folder: those that the graph names, then their includes.
/// Generated includes are left out.
fn files(info: &GraphInfo, pass: usize) -> Vec<String> {
    let named = info.graph.passes[pass].value.shaders.0.iter();
    let mut files: Vec<String> = named.map(|s| s.value.clone()).collect();
    let generated = crate::graph::link::generated(&info.graph, &info.params);
    let stages = info.linked.get(pass).into_iter().flat_map(|l| &l.stages);
    for file in stages.flat_map(|s| s.texts.keys()) {
        if !files.contains(file) && !generated.contains_key(file) {
            files.push(file.clone());
        }
    }
    files
}

impl Workbench {
    /// The list, with a link for each file.
    pub(super) fn shader_files(&mut self, ui: &mut Ui, info: &GraphInfo, pass: usize) {
        let files = files(info, pass);
        if files.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.label("shader files");
        for file in files {
            self.editor_link(ui, &file, 1);
        }
    }

    /// A link that opens a shader file at a line in the editor; the line is not shown if it is 1.
    pub(super) fn editor_link(&mut self, ui: &mut Ui, file: &str, line: u32) {
        let text = match line {
            0 | 1 => file.to_string(),
            _ => format!("{file}:{line}"),
        };
        if ui.link(text).on_hover_text("Opens the editor").clicked() {
            let file = self.setup.home.folders().shaders.join(file);
            let place = Place {
                file,
                line,
                ..Place::default()
            };
            self.open_editor(&place);
        }
    }
}
