//! Where the passes of a graph are drawn: a column for each stage, passes below each other in the
//! order they run.

use crate::workbench::engine::report::GraphInfo;
use egui::{Pos2, Rect, Vec2};

/// Width of a pass, points.
pub const WIDTH: f32 = 168.0;
/// Height of a pass's name, and of each thing it writes.
pub const ROW: f32 = 15.0;
/// Height of a column's title.
pub const TITLE: f32 = 34.0;
const GAP: Vec2 = Vec2::new(64.0, 12.0);
/// Between two lines of columns.
const BREAK: f32 = 28.0;

/// A pass.
pub struct Node {
    /// Number in the graph.
    pub pass: usize,
    /// Name.
    pub name: String,
    /// Resources it reads that passes of this or the last frame have written.
    pub reads: Vec<String>,
    /// Resources it writes.
    pub writes: Vec<String>,
    /// Whether it runs; else it is off, or left out by a condition.
    pub runs: bool,
    /// Where.
    pub rect: Rect,
}

/// The resource that a pass reads, from the pass that wrote it last.
pub struct Edge {
    /// The writer: index in the list of nodes, and among its outputs.
    pub from: (usize, usize),
    /// Who reads.
    pub to: usize,
    /// Whether the read is of the last frame.
    pub of_last_frame: bool,
}

/// A stage: its name, its column, its passes by their numbers.
pub struct Column {
    /// Name.
    pub stage: String,
    /// The column.
    pub rect: Rect,
    /// Numbers of passes in the graph.
    pub passes: Vec<usize>,
}

/// A graph, laid out.
#[derive(Default)]
pub struct Layout {
    /// Passes in the graph's order.
    pub nodes: Vec<Node>,
    /// The edges between them.
    pub edges: Vec<Edge>,
    /// Stages.
    pub columns: Vec<Column>,
}

impl Layout {
    /// Lays out the passes that run and those that are off, to fill an area of that size.
    pub fn new(info: &GraphInfo, area: Vec2) -> Layout {
        let mut layout = Layout::default();
        for (number, pass) in info.graph.passes.iter().enumerate() {
            let name = &pass.value.name.value;
            let used = info.uses.iter().find(|u| u.pass == number);
            if used.is_none() && !info.params.off.contains(name) {
                continue;
            }
            let stage = pass.value.stage();
            let column = match layout.columns.iter().position(|c| c.stage == stage) {
                Some(column) => column,
                None => {
                    let left = layout.columns.len() as f32 * (WIDTH + GAP.x);
                    let rect = Rect::from_min_size(Pos2::new(left, 0.0), Vec2::new(WIDTH, TITLE));
                    layout.columns.push(Column {
                        stage: stage.into(),
                        rect,
                        passes: Vec::new(),
                    });
                    layout.columns.len() - 1
                }
            };
            let column = &mut layout.columns[column];
            column.passes.push(number);
            let (reads, writes) =
                used.map_or_else(Default::default, |u| (u.reads.clone(), u.writes.clone()));
            let size = Vec2::new(WIDTH, ROW * (1.5 + writes.len() as f32));
            let rect = Rect::from_min_size(column.rect.left_bottom() + Vec2::new(0.0, GAP.y), size);
            column.rect.max.y = rect.max.y;
            layout.nodes.push(Node {
                pass: number,
                name: name.clone(),
                reads,
                writes,
                runs: used.is_some(),
                rect,
            });
        }
        layout.edges = edges(&layout.nodes);
        layout.wrap(area);
        layout
    }

    /// Breaks the line of columns into as many as let it be drawn largest.
    fn wrap(&mut self, area: Vec2) {
        let heights: Vec<f32> = self.columns.iter().map(|c| c.rect.height()).collect();
        let pitch = WIDTH + GAP.x;
        let size = |across: usize| {
            let rows = heights
                .chunks(across)
                .map(|row| row.iter().copied().fold(0.0, f32::max) + BREAK);
            Vec2::new(across as f32 * pitch, rows.sum())
        };
        let zoom = |across: usize| (area / size(across)).min_elem();
        let Some(across) = (1..=heights.len()).max_by(|a, b| zoom(*a).total_cmp(&zoom(*b))) else {
            return;
        };
        let mut top = 0.0;
        for (row, columns) in self.columns.chunks_mut(across).enumerate() {
            let left = (row * across) as f32 * pitch;
            for column in columns.iter_mut() {
                let by = Vec2::new(-left, top);
                column.rect = column.rect.translate(by);
                for node in self
                    .nodes
                    .iter_mut()
                    .filter(|n| column.passes.contains(&n.pass))
                {
                    node.rect = node.rect.translate(by);
                }
            }
            top += columns.iter().map(|c| c.rect.height()).fold(0.0, f32::max) + BREAK;
        }
    }

    /// All of it.
    pub fn bounds(&self) -> Rect {
        self.columns
            .iter()
            .fold(Rect::NOTHING, |all, c| all.union(c.rect))
            .expand(16.0)
    }

    /// Indices of the passes that a pass needs in a frame: itself, and the writers of their inputs.
    pub fn needed_by(&self, node: usize) -> Vec<usize> {
        let mut needed = vec![node];
        let mut next = 0;
        while let Some(reader) = needed.get(next).copied() {
            // Every writer counts, not only the last: one adds to what another began.
            for (i, writer) in self.nodes.iter().enumerate() {
                let gives = writer
                    .writes
                    .iter()
                    .any(|w| self.nodes[reader].reads.iter().any(|r| r == w));
                let adds = writer
                    .writes
                    .iter()
                    .any(|w| i < reader && self.nodes[reader].writes.contains(w));
                if (gives || adds) && !needed.contains(&i) {
                    needed.push(i);
                }
            }
            next += 1;
        }
        needed.sort_unstable();
        needed
    }
}

fn edges(nodes: &[Node]) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (to, node) in nodes.iter().enumerate() {
        for read in &node.reads {
            let writes = |n: &Node| n.writes.iter().position(|w| w == read);
            let before = nodes[..to]
                .iter()
                .enumerate()
                .rev()
                .find_map(|(i, n)| Some((i, writes(n)?)));
            let after = || {
                nodes[to..]
                    .iter()
                    .enumerate()
                    .rev()
                    .find_map(|(i, n)| Some((to + i, writes(n)?)))
            };
            if let Some(from) = before.or_else(after).filter(|from| from.0 != to) {
                edges.push(Edge {
                    from,
                    to,
                    of_last_frame: from.0 > to,
                });
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::{Column, GAP, Layout, Node, WIDTH, edges};
    use egui::{Pos2, Rect, Vec2};

    fn node(name: &str, reads: &[&str], writes: &[&str]) -> Node {
        let texts = |list: &[&str]| list.iter().map(ToString::to_string).collect();
        Node {
            pass: 0,
            name: name.into(),
            reads: texts(reads),
            writes: texts(writes),
            runs: true,
            rect: Rect::NOTHING,
        }
    }

    #[test]
    fn columns_fill_the_area() {
        let column = |i: usize| Column {
            stage: String::new(),
            rect: Rect::from_min_size(
                Pos2::new(i as f32 * (WIDTH + GAP.x), 0.0),
                Vec2::new(WIDTH, 200.0),
            ),
            passes: vec![i],
        };
        let at = |i: usize| Node {
            pass: i,
            rect: column(i).rect,
            ..node("", &[], &[])
        };
        for (area, lines) in [
            (Vec2::new(9000.0, 300.0), 1),
            (Vec2::new(900.0, 900.0), 3),
            (Vec2::new(300.0, 900.0), 4),
        ] {
            let columns = (0..8).map(column).collect();
            let mut layout = Layout {
                nodes: (0..8).map(at).collect(),
                edges: Vec::new(),
                columns,
            };
            layout.wrap(area);
            let mut tops: Vec<f32> = layout.columns.iter().map(|c| c.rect.top()).collect();
            assert!(
                layout
                    .nodes
                    .iter()
                    .zip(&layout.columns)
                    .all(|(n, c)| n.rect == c.rect)
            );
            tops.dedup();
            assert_eq!(tops.len(), lines, "{area}");
        }
    }

    #[test]
    fn who_reads_is_joined_to_who_wrote_last() {
        let nodes = vec![
            node("clear", &[], &["list"]),
            node("fill", &[], &["list"]),
            node("light", &["list", "kept"], &["light"]),
            node("other", &[], &["other"]),
            node("keep", &["light"], &["kept"]),
        ];
        let found = edges(&nodes);
        let list: Vec<_> = found
            .iter()
            .map(|e| (e.from.0, e.to, e.of_last_frame))
            .collect();
        assert_eq!(list, [(1, 2, false), (4, 2, true), (2, 4, false)]);
        let layout = Layout {
            nodes,
            edges: found,
            columns: Vec::new(),
        };
        assert_eq!(layout.needed_by(4), [0, 1, 2, 4]);
        assert_eq!(layout.needed_by(0), [0]);
        assert_eq!(layout.needed_by(1), [0, 1]);
    }
}
