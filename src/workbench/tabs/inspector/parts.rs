//! Volumes that share a texture: borders and names.

use crate::graph::file::Parts;
use crate::workbench::desired::request::InspectTarget;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke};

/// Names of the parts along the axes of the picture, to the right and down, and along the slices.
fn names<'p>(
    parts: &'p Parts,
    target: &InspectTarget,
) -> [&'p [crate::diagnostics::Loc<String>]; 3] {
    let (x, z) = (&parts.x.0[..], &parts.z.0[..]);
    match target.axis {
        0 => [z, &[], x],
        1 => [x, z, &[]],
        _ => [x, &[], z],
    }
}

/// Draws the borders of the parts and their names. `edge`: of a part, texels; `shown`: place of the
/// picture of `size` texels.
pub fn draw(
    painter: &Painter,
    parts: &Parts,
    target: &InspectTarget,
    edge: u32,
    (shown, size): (Rect, [u32; 2]),
) {
    let [right, down, _] = names(parts, target);
    let text = painter.ctx().global_style().visuals.text_color();
    let step = shown.width() / size[0].max(1) as f32 * edge as f32;
    let count = |axis: usize| (size[axis] / edge.max(1)) as usize;
    for (axis, names) in [(0, right), (1, down)] {
        if names.is_empty() || count(axis) < 2 {
            continue;
        }
        for (i, name) in names.iter().take(count(axis)).enumerate() {
            let offset = step * i as f32;
            let stroke = Stroke::new(1.0, Color32::YELLOW);
            let at = match axis {
                0 => {
                    let x = shown.left() + offset;
                    painter.vline(x, shown.y_range(), stroke);
                    Pos2::new(x + 4.0, shown.bottom() + 2.0)
                }
                _ => {
                    let y = shown.top() + offset;
                    painter.hline(shown.x_range(), y, stroke);
                    Pos2::new(shown.right() + 4.0, y + 2.0)
                }
            };
            let font = FontId::proportional(12.0);
            painter.text(at, Align2::LEFT_TOP, &name.value, font, text);
        }
    }
}

/// The name of the part that a slice is in.
pub fn of_slice<'p>(parts: &'p Parts, target: &InspectTarget, edge: u32) -> Option<&'p str> {
    let [_, _, along] = names(parts, target);
    let name = along.get((target.slice / edge.max(1)) as usize)?;
    Some(&name.value)
}
