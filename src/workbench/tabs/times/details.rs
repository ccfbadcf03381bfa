//! Details of a pass: its resources, frames and pipeline statistics.

use super::table::{Row, digits};
use super::{Asked, Times};
use crate::graph::run::PassExecutables;
use crate::vulkan::Statistic;
use crate::workbench::Workbench;
use crate::workbench::engine::Order;
use crate::workbench::engine::report::PassUses;
use egui::Ui;

/// An action below a pass, carried out after the tab is drawn.
pub(super) enum Wish {
    Inspect(usize, String),
    Statistics(usize),
}

impl Workbench {
    /// The outputs of a pass, and in how many frames it ran.
    pub(super) fn pass_text(&self, row: &Row) -> String {
        let mut text = row.name.clone();
        for (side, measured) in ["A", "B"].iter().zip(&row.sides) {
            let Some(m) = measured else { continue };
            let of = self.tabs.times.table.frames;
            let skipped = if m.skipped {
                ", not in the last one"
            } else {
                ""
            };
            let max = digits(m.max);
            text += &format!(
                "\n{side}: ran in {} of {of} frames{skipped}, max {max} ms",
                m.ran
            );
        }
        let writes = self.pass_writes(side_of(row), &row.name).join(", ");
        if !writes.is_empty() {
            text += &format!("\nwrites {writes}");
        }
        for line in self.tabs.times.statistics_of(side_of(row), &row.name) {
            text += &format!("\n{line}");
        }
        text + "\nClick for details"
    }

    fn pass_writes(&self, side: usize, name: &str) -> &[String] {
        let Some(info) = &self.sides[side].info else {
            return &[];
        };
        let named = |u: &&PassUses| info.graph.pass_name(u.pass) == name;
        info.uses.iter().find(named).map_or(&[], |u| &u.writes)
    }

    /// The lines below a selected pass.
    pub(super) fn pass_details(&self, ui: &mut Ui, row: &Row) -> Option<Wish> {
        let side = side_of(row);
        let mut wish = None;
        ui.indent(("details", &row.name), |ui| {
            ui.horizontal_wrapped(|ui| {
                let info = self.sides[side].info.as_ref();
                let is_texture =
                    |n: &&String| info.is_some_and(|info| info.graph.texture(n).is_some());
                for texture in self.pass_writes(side, &row.name).iter().filter(is_texture) {
                    let button = ui.button(format!("Inspect {texture}"));
                    if button.on_hover_text("Written by this pass").clicked() {
                        wish = Some(Wish::Inspect(side, texture.clone()));
                    }
                }
            });
            match &self.tabs.times.statistics[side] {
                Asked::No => {
                    let about = "Registers, spills and sizes of the pipeline as the driver reports them. \
                        Recompiles all pipelines in the background, which takes seconds";
                    if ui.button("Pipeline statistics").on_hover_text(about).clicked() {
                        wish = Some(Wish::Statistics(side));
                    }
                }
                Asked::Waiting => {
                    ui.label("compiling pipelines for their statistics");
                }
                Asked::Answered(Err(why)) => {
                    ui.label(why);
                }
                Asked::Answered(Ok(_)) => {
                    let lines = self.tabs.times.statistics_of(side, &row.name);
                    if lines.is_empty() {
                        ui.label("no statistics: the pass has no shaders, or the driver reports none");
                    }
                    for line in lines {
                        ui.label(line);
                    }
                }
            }
        });
        wish
    }

    /// Carries out an action.
    pub(super) fn carry_out(&mut self, wish: Wish) {
        match wish {
            Wish::Inspect(side, texture) => self.inspect(side, texture),
            Wish::Statistics(side) => {
                self.tabs.times.statistics[side] = Asked::Waiting;
                self.engine.order(Order::PipelineStatistics(side));
            }
        }
    }
}

/// The side of a row's pass.
fn side_of(row: &Row) -> usize {
    usize::from(row.sides[0].is_none())
}

impl Times {
    /// Statistics of a pass's pipelines, a line for each executable.
    fn statistics_of(&self, side: usize, name: &str) -> Vec<String> {
        match &self.statistics[side] {
            Asked::Answered(Ok(passes)) => lines(passes, name),
            _ => Vec::new(),
        }
    }
}

/// Drivers report numbers from here on for unknown ones: NVIDIA's "Local Memory Size" is 2^36.
const UNKNOWN: f64 = (1_u64 << 32) as f64;

fn statistic(statistic: &Statistic) -> String {
    match statistic.value {
        value if value >= UNKNOWN => format!("{} not reported", statistic.name),
        value => format!("{} {value}", statistic.name),
    }
}

fn lines(passes: &[PassExecutables], name: &str) -> Vec<String> {
    let own = passes.iter().filter(|p| p.pass == name);
    let line = |(executable, limit): &(crate::vulkan::Executable, Option<f64>)| {
        let each = executable.statistics.iter();
        let mut parts: Vec<String> = each.map(statistic).collect();
        if let Some(limit) = limit {
            let percent = 100.0 * limit;
            parts.push(format!("occupancy limit from registers {percent:.0} %"));
        }
        format!("{}: {}", executable.name, parts.join(", "))
    };
    own.flat_map(|p| p.executables.iter().map(line)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::Executable;

    #[test]
    fn a_pipeline_is_described_in_the_drivers_words() {
        let statistic = |name: &str, value: f64| Statistic {
            name: name.into(),
            description: String::new(),
            value,
        };
        let executable = Executable {
            name: "Compute Shader".into(),
            subgroup_size: 32,
            statistics: vec![
                statistic("Register Count", 40.0),
                statistic("Stack Size", 0.0),
                statistic("Local Memory Size", 68_719_476_736.0),
            ],
        };
        let passes = [PassExecutables {
            pass: "gather".into(),
            executables: vec![(executable, Some(0.75))],
        }];
        assert_eq!(
            lines(&passes, "gather"),
            [
                "Compute Shader: Register Count 40, Stack Size 0, Local Memory Size not reported, \
                 occupancy limit from registers 75 %"
            ]
        );
        assert!(lines(&passes, "other").is_empty());
    }
}
