//! Buffers of the graph as tables.

use super::Tab;
use crate::graph::Debug;
use crate::graph::table::{Cell, CellKind, Column, Table, decode};
use crate::workbench::Workbench;
use crate::workbench::engine::report::Report;
use crate::workbench::read_back::{Content, ReadBack};
use egui::{Align2, FontId, TextureId, Ui};
use egui_extras::{Column as Width, TableBuilder};

/// State of this tab.
#[derive(Default)]
pub struct Tables {
    /// Number of the table shown.
    chosen: usize,
    /// Value of the first column that is shown; all when absent.
    filter: Option<String>,
    came: Option<Came>,
    /// Whether values of shaders are shown in place of a table.
    pub(super) shows_values: bool,
    /// The last values of shaders.
    pub(super) values: Option<Debug>,
    rows: Option<Rows>,
}

/// Bytes as they came, of the table of that number.
struct Came {
    number: usize,
    table: Table,
    bytes: Vec<u8>,
}

/// Decoded rows of the table of that number.
struct Rows {
    number: usize,
    table: Table,
    cells: Vec<Vec<Cell>>,
    /// Values of the first column, each once, in the order they come.
    kinds: Vec<String>,
    /// Numbers of the rows that the filter lets through.
    shown: Vec<usize>,
}

impl Tab for Tables {
    const TITLE: &'static str = "Tables";
    const ICON: &'static str = egui_phosphor::regular::TABLE;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.tables_tab(ui);
    }

    fn report(workbench: &mut Workbench, report: &Report) {
        if let Report::Content(Content::Table(number, table, bytes)) = report {
            let (table, bytes) = (table.clone(), bytes.clone());
            workbench.tabs.tables.note(*number, table, bytes);
        }
        if let Report::Content(Content::Debug(values)) = report {
            workbench.tabs.tables.values.clone_from(values);
        }
    }
}

impl Tables {
    /// Shows a table, by its number in the graph.
    pub(super) fn choose(&mut self, number: usize) {
        (self.chosen, self.filter, self.shows_values) = (number, None, false);
    }

    /// Takes in the content of a table's buffer.
    fn note(&mut self, number: usize, table: Table, bytes: Vec<u8>) {
        self.came = Some(Came {
            number,
            table,
            bytes,
        });
    }

    /// Decodes what came, when it is of the table shown.
    fn refresh(&mut self) {
        if let Some(Came {
            number,
            table,
            bytes,
        }) = self.came.take().filter(|c| c.number == self.chosen)
        {
            let cells = decode(&table, &bytes);
            self.rows = Some(Rows {
                number,
                table,
                kinds: kinds(&cells),
                shown: Vec::new(),
                cells,
            });
            self.sift();
        }
        if self.rows.as_ref().is_some_and(|r| r.number != self.chosen) {
            self.rows = None;
        }
    }

    fn sift(&mut self) {
        if let Some(rows) = &mut self.rows {
            rows.shown = sift(&rows.cells, self.filter.as_deref());
        }
    }
}

fn first(row: &[Cell]) -> Option<String> {
    row.first().map(ToString::to_string)
}

/// The values of the first column, unless there are too many to choose from.
fn kinds(cells: &[Vec<Cell>]) -> Vec<String> {
    let mut list: Vec<String> = Vec::new();
    for value in cells.iter().filter_map(|r| first(r)) {
        if list.len() > 64 {
            return Vec::new();
        }
        if !list.contains(&value) {
            list.push(value);
        }
    }
    list
}

/// Numbers of the rows with that value in the first column.
fn sift(cells: &[Vec<Cell>], filter: Option<&str>) -> Vec<usize> {
    let fits = |row: &[Cell]| filter.is_none_or(|f| first(row).as_deref() == Some(f));
    cells
        .iter()
        .enumerate()
        .filter(|(_, row)| fits(row))
        .map(|(i, _)| i)
        .collect()
}

/// The rows as CSV; a vector has a column a component. Numbers are written so that they read back
/// exactly.
fn csv<'r>(table: &Table, rows: impl Iterator<Item = &'r Vec<Cell>>) -> std::io::Result<Vec<u8>> {
    let mut out = csv::Writer::from_writer(Vec::new());
    let parts = |c: &Column| match c.kind {
        CellKind::Uint | CellKind::Int | CellKind::Float => vec![heading(c)],
        kind => ["x", "y", "z", "w"]
            .iter()
            .take(kind.bytes() / 4)
            .map(|p| format!("{}.{p}{}", c.name, unit(c)))
            .collect(),
    };
    out.write_record(table.columns.iter().flat_map(parts))?;
    for row in rows {
        let exact = row.iter().flat_map(|cell| match cell {
            Cell::Uint(v) => vec![v.to_string()],
            Cell::Int(v) => vec![v.to_string()],
            Cell::Float(v) => vec![v.to_string()],
            Cell::Vector(v) => v.iter().map(ToString::to_string).collect(),
        });
        out.write_record(exact)?;
    }
    out.into_inner().map_err(|e| e.into_error())
}

fn unit(column: &Column) -> String {
    if column.unit.is_empty() {
        String::new()
    } else {
        format!(" ({})", column.unit)
    }
}

fn heading(column: &Column) -> String {
    format!("{}{}", column.name, unit(column))
}

/// Width of a column, points.
fn width(kind: CellKind) -> f32 {
    match kind {
        CellKind::Uint | CellKind::Int => 52.0,
        CellKind::Float => 68.0,
        CellKind::Vec2 => 110.0,
        CellKind::Vec3 => 165.0,
        CellKind::Vec4 => 220.0,
    }
}

const ABOUT: [(CellKind, &str); 6] = [
    (CellKind::Uint, "unsigned integer"),
    (CellKind::Int, "signed integer"),
    (CellKind::Float, "number"),
    (CellKind::Vec2, "two numbers"),
    (CellKind::Vec3, "three numbers"),
    (CellKind::Vec4, "four numbers"),
];

impl Workbench {
    fn tables_tab(&mut self, ui: &mut Ui) {
        let Some(info) = self.sides[0].info.clone() else {
            ui.weak(self.waiting_text());
            return;
        };
        if self.shader_values(ui, &info) {
            return;
        }
        let list = &info.graph.tables;
        self.tabs.tables.chosen = self.tabs.tables.chosen.min(list.len().saturating_sub(1));
        let Some(mut table) = list.get(self.tabs.tables.chosen).map(|t| &t.value) else {
            ui.weak("The graph has no tables");
            return;
        };
        egui::ComboBox::from_id_salt("table")
            .selected_text(&table.title)
            .show_ui(ui, |ui| {
                for (i, t) in list.iter().map(|t| &t.value).enumerate() {
                    if ui
                        .selectable_label(i == self.tabs.tables.chosen, &t.title)
                        .on_hover_text(&t.help)
                        .clicked()
                    {
                        (self.tabs.tables.chosen, self.tabs.tables.filter) = (i, None);
                        table = t;
                    }
                }
            });
        let table_number = self.tabs.tables.chosen;
        self.desired.read_back.push(ReadBack::Table(table_number));
        ui.weak(&table.help);
        self.tabs.tables.refresh();
        self.table_bar(ui, &table.title);
        let shown = self.tabs.tables.rows.as_ref().map_or(0, |r| r.shown.len());
        if shown == 0 {
            ui.weak(match (&info.graph.pointer, &self.tabs.tables.rows) {
                (_, None) => "…",
                (Some(_), _) => "No rows: click on the picture",
                (None, _) => "No rows",
            });
            return;
        }
        egui::ScrollArea::horizontal()
            .auto_shrink(false)
            .show(ui, |ui| self.table_body(ui, &table.help));
    }

    fn table_bar(&mut self, ui: &mut Ui, title: &str) {
        let mut export = false;
        ui.horizontal(|ui| {
            let Some(rows) = &self.tabs.tables.rows else {
                return;
            };
            let name = rows.table.columns.first().map_or("", |c| c.name.as_str());
            let mut filter = self.tabs.tables.filter.clone();
            if rows.kinds.len() > 1 || filter.is_some() {
                let text = filter
                    .as_ref()
                    .map_or(format!("every {name}"), |f| format!("{name} {f}"));
                egui::ComboBox::from_id_salt("filter")
                    .selected_text(text)
                    .width(90.0)
                    .show_ui(ui, |ui| {
                        ui.selectable_value(&mut filter, None, format!("every {name}"));
                        for kind in &rows.kinds {
                            ui.selectable_value(
                                &mut filter,
                                Some(kind.clone()),
                                format!("{name} {kind}"),
                            );
                        }
                    });
            }
            ui.label(format!("{} of {} rows", rows.shown.len(), rows.cells.len()));
            let button = egui::Button::new("CSV").small();
            let about = "The rows shown, into captures/";
            export = ui
                .add_enabled(!rows.shown.is_empty(), button)
                .on_hover_text(about)
                .clicked();
            if filter != self.tabs.tables.filter {
                self.tabs.tables.filter = filter;
                self.tabs.tables.sift();
            }
        });
        if !export {
            return;
        }
        let Some(rows) = &self.tabs.tables.rows else {
            return;
        };
        let bytes = csv(
            &rows.table,
            rows.shown.iter().filter_map(|i| rows.cells.get(*i)),
        );
        let name = format!("table-{}-{title}", self.experiment.name);
        self.export(&name, "csv", bytes);
    }

    fn table_body(&mut self, ui: &mut Ui, help: &str) {
        let Some(rows) = &self.tabs.tables.rows else {
            return;
        };
        let mut builder = TableBuilder::new(ui).striped(true).auto_shrink(false);
        for c in &rows.table.columns {
            let heading = 8.0 * heading(c).len() as f32 + 4.0;
            builder = builder.column(
                Width::initial(width(c.kind).max(heading))
                    .resizable(true)
                    .clip(true),
            );
        }
        let head = |mut row: egui_extras::TableRow<'_, '_>| {
            for c in &rows.table.columns {
                let kind = ABOUT.iter().find(|a| a.0 == c.kind).map_or("", |a| a.1);
                row.col(|ui| {
                    let about = format!("{}: {kind}{}\n{help}", c.name, unit(c));
                    ui.strong(heading(c)).on_hover_text(about);
                });
            }
        };
        builder.header(20.0, head).body(|body| {
            body.rows(18.0, rows.shown.len(), |mut row| {
                let Some(cells) = rows.shown.get(row.index()).and_then(|i| rows.cells.get(*i))
                else {
                    return;
                };
                for cell in cells {
                    row.col(|ui| {
                        let rect = ui.max_rect();
                        // Painted, not a label: a widget for each of hundreds of cells would take
                        // milliseconds.
                        if ui.is_rect_visible(rect) {
                            let color = ui.visuals().text_color();
                            let text = cell.to_string();
                            ui.painter().text(
                                rect.left_center(),
                                Align2::LEFT_CENTER,
                                text,
                                FontId::monospace(12.0),
                                color,
                            );
                        }
                    });
                }
            });
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> (Table, Vec<Vec<Cell>>) {
        let column = |name: &str, at, kind, unit: &str| Column {
            name: name.into(),
            at,
            kind,
            unit: unit.into(),
        };
        let columns = vec![
            column("cone", 0, CellKind::Uint, ""),
            column("at", 4, CellKind::Vec3, "m"),
        ];
        let table = Table {
            rows: 0,
            start: 4,
            stride: 16,
            columns,
        };
        let rows: [(u32, [f32; 3]); 3] = [
            (2, [0.1, 1.0, 2.0]),
            (0, [3.0, 1e-7, -4.0]),
            (2, [f32::NAN, 0.0, 7.0]),
        ];
        let mut bytes = 3_u32.to_ne_bytes().to_vec();
        for (cone, at) in rows {
            bytes.extend(cone.to_ne_bytes());
            bytes.extend(at.iter().flat_map(|v| v.to_ne_bytes()));
        }
        let cells = decode(&table, &bytes);
        (table, cells)
    }

    #[test]
    fn a_filter_keeps_the_rows_of_a_cone() {
        let (table, cells) = table();
        assert_eq!(kinds(&cells), ["2", "0"]);
        assert_eq!(
            (sift(&cells, None), sift(&cells, Some("2"))),
            (vec![0, 1, 2], vec![0, 2])
        );
        assert!(sift(&cells, Some("9")).is_empty());
        let mut tables = Tables {
            filter: Some("2".into()),
            ..Tables::default()
        };
        // Bytes of a table that is not shown are dropped.
        tables.note(4, table, vec![0; 4]);
        tables.refresh();
        assert!(tables.rows.is_none());
    }

    #[test]
    fn csv_reads_back_exactly() {
        let (table, cells) = table();
        let bytes = csv(&table, cells.iter()).unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        assert_eq!(
            reader.headers().unwrap(),
            vec!["cone", "at.x (m)", "at.y (m)", "at.z (m)"]
        );
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows[1][2].parse::<f32>().unwrap(), 1e-7);
        assert_eq!(
            (&rows[0][0], rows[0][1].parse::<f32>().unwrap(), &rows[2][1]),
            ("2", 0.1, "NaN")
        );
    }
}
