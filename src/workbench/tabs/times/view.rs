//! Painting of the table: heads, rows and bars.

use super::table::{Column, Row, Sort, Table};
use crate::results::timers;
use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, Color32, FontId, Pos2, Rect, Response, Sense, TextStyle, Ui, Vec2};

/// Least width of the names, points.
const NAMES: f32 = 112.0;
/// Width of a number, in characters.
const NUMBER: f32 = 6.8;
/// Width of a digit of the monospace font, relative to its size.
const DIGIT: f32 = 0.6;
/// Indentation of a level of the tree, points.
const INDENT: f32 = 12.0;

/// The columns that fit, and where they are.
pub struct Grid {
    pub columns: Vec<Column>,
    number: f32,
    row: f32,
    text: FontId,
    mono: FontId,
}

impl Grid {
    pub fn new(ui: &Ui, table: &Table) -> Grid {
        let font = |style: TextStyle| {
            let font = style.resolve(ui.style());
            FontId::new(font.size.max(12.0), font.family)
        };
        let (text, mono) = (font(TextStyle::Body), font(TextStyle::Monospace));
        let number = mono.size * DIGIT * NUMBER;
        let fit = ((ui.available_width() - NAMES) / number).max(1.0) as usize;
        Grid {
            columns: Column::of(table, fit),
            number,
            row: (text.size * 1.4).ceil(),
            text,
            mono,
        }
    }

    /// A row of the full width.
    fn allocate(&self, ui: &mut Ui, sense: Sense) -> (Rect, Response) {
        ui.allocate_exact_size(Vec2::new(ui.available_width(), self.row), sense)
    }

    /// The cell of the n-th column.
    fn cell(&self, row: Rect, n: usize) -> Rect {
        let right = row.right() - self.number * (self.columns.len() - 1 - n) as f32;
        Rect::from_x_y_ranges(right - self.number..=right, row.y_range())
    }

    fn number(&self, ui: &Ui, cell: Rect, text: String, color: Color32) {
        let at = cell.right_center() - Vec2::new(2.0, 0.0);
        let painter = ui.painter();
        painter.text(at, Align2::RIGHT_CENTER, text, self.mono.clone(), color);
    }

    /// The heads of the columns. Returns the order after a click.
    pub fn head(&self, ui: &mut Ui, table: &Table, sort: Sort) -> Option<Sort> {
        let (rect, _) = self.allocate(ui, Sense::hover());
        let mut clicked = None;
        for (n, column) in self.columns.iter().enumerate() {
            let cell = self.cell(rect, n);
            let id = ui.id().with(("head", n));
            let response = ui.interact(cell, id, Sense::click());
            let name = format!("sort by {}", column.title());
            response
                .widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &name));
            let order = sort.by.filter(|(c, _)| c == column).map(|by| by.1);
            let color = match response.hovered() || order.is_some() {
                true => ui.visuals().strong_text_color(),
                false => ui.visuals().text_color(),
            };
            self.number(ui, cell, column.title().into(), color);
            if let Some(descending) = order {
                let y = if descending {
                    cell.bottom()
                } else {
                    cell.top()
                };
                ui.painter()
                    .hline(cell.shrink(2.0).x_range(), y, (2.0, color));
            }
            if response.clicked() {
                clicked = Some(sort.clicked(*column));
            }
            response.on_hover_text(format!(
                "{}\nClick: sort, reverse, back to the graph's order",
                column.help(table.held)
            ));
        }
        clicked
    }

    /// A row of the table.
    pub fn line(&self, ui: &mut Ui, table: &Table, line: &Line<'_>) -> Response {
        let (rect, response) = self.allocate(ui, Sense::click());
        let name = match line.kind {
            Kind::Stage { .. } => format!("stage {}", line.row.name),
            _ => line.row.name.clone(),
        };
        let first = self.columns.first();
        let value = first.and_then(|c| c.value(line.row, table));
        response.widget_info(|| egui::WidgetInfo {
            value,
            ..egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &name)
        });
        if !ui.is_rect_visible(rect) {
            return response;
        }
        let painter = ui.painter();
        if line.selected {
            painter.rect_filled(
                rect,
                2.0,
                ui.visuals().selection.bg_fill.gamma_multiply(0.5),
            );
        } else if response.hovered() || line.highlighted {
            painter.rect_filled(rect, 2.0, ui.visuals().widgets.hovered.weak_bg_fill);
        }
        let color = match line.kind {
            _ if line.row.is_skipped() => ui.visuals().weak_text_color(),
            Kind::Stage { .. } | Kind::Sum => ui.visuals().strong_text_color(),
            Kind::Pass { .. } | Kind::Rest => ui.visuals().text_color(),
        };
        let mut left = rect.left();
        match line.kind {
            Kind::Stage { open } => {
                let at = Pos2::new(left + 5.0, rect.center().y);
                triangle(ui, at, open, color);
                left += INDENT;
            }
            Kind::Pass { inner } => left += if inner { 2.0 * INDENT } else { INDENT },
            Kind::Sum | Kind::Rest => {}
        }
        if let Some(share) = value.filter(|_| line.kind != Kind::Sum && line.most > 0.0) {
            let part = (share / line.most).clamp(0.0, 1.0) as f32;
            let mut bar = rect.shrink2(Vec2::new(0.0, 1.0));
            bar.min.x = left;
            bar.max.x = bar.min.x + bar.width() * part;
            let opacity = if line.row.is_skipped() { 0.12 } else { 0.4 };
            painter.rect_filled(bar, 1.0, line.bar(ui).gamma_multiply(opacity));
        }
        if let Kind::Pass { .. } = line.kind {
            let at = Pos2::new(left - 5.0, rect.center().y);
            let swatch = Rect::from_center_size(at, Vec2::splat(8.0));
            painter.rect_filled(swatch, 1.0, timers::color(&line.row.name));
        }
        // Names give way to numbers.
        let right = self.cell(rect, 0).left() - 2.0;
        let mut job =
            LayoutJob::simple_singleline(line.row.title(table.both), self.text.clone(), color);
        job.wrap = TextWrapping::truncate_at_width((right - left - 3.0).max(8.0));
        let galley = painter.layout_job(job);
        let at = Pos2::new(left + 3.0, rect.center().y - galley.size().y / 2.0);
        painter.galley(at, galley, color);
        for (n, column) in self.columns.iter().enumerate() {
            let text = column.text(column.value(line.row, table));
            self.number(ui, self.cell(rect, n), text, color);
        }
        response
    }

    /// A name with a text on the right and a bar.
    pub fn bar(&self, ui: &mut Ui, name: &str, text: String, part: f32) {
        let (rect, _) = self.allocate(ui, Sense::hover());
        if !ui.is_rect_visible(rect) {
            return;
        }
        let mut bar = rect.shrink2(Vec2::new(0.0, 1.0));
        bar.max.x = bar.min.x + bar.width() * part.clamp(0.002, 1.0);
        let color = ui.visuals().text_color();
        let painter = ui.painter();
        painter.rect_filled(bar, 1.0, ui.visuals().selection.bg_fill.gamma_multiply(0.5));
        let at = rect.left_center() + Vec2::new(3.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, name, self.text.clone(), color);
        self.number(ui, rect, text, color);
    }
}

/// The kinds of rows.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Stage {
        open: bool,
    },
    /// A pass, of a stage with other passes or alone.
    Pass {
        inner: bool,
    },
    /// GPU time without a pass.
    Rest,
    Sum,
}

/// How a row is drawn.
pub struct Line<'a> {
    pub row: &'a Row,
    pub kind: Kind,
    pub highlighted: bool,
    pub selected: bool,
    /// Time of the longest bar, ms.
    pub most: f64,
}

impl Line<'_> {
    fn bar(&self, ui: &Ui) -> Color32 {
        match self.kind {
            Kind::Pass { .. } => timers::color(&self.row.name),
            _ => ui.visuals().weak_text_color(),
        }
    }
}

/// The mark of a stage that is open or folded.
fn triangle(ui: &Ui, at: Pos2, open: bool, color: Color32) {
    let corner = |x: f32, y: f32| match open {
        true => at + Vec2::new(x, y),
        false => at + Vec2::new(y, x),
    };
    let corners = vec![corner(-3.5, -2.0), corner(3.5, -2.0), corner(0.0, 3.0)];
    let stroke = egui::Stroke::NONE;
    ui.painter()
        .add(egui::Shape::convex_polygon(corners, color, stroke));
}
