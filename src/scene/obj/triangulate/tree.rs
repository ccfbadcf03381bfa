//! A k-d tree of corners that may block an ear.

use super::plane::{Point, cross};

/// Corners per leaf.
const LEAF: usize = 8;

pub(super) struct Tree {
    /// The children of node n are 2n and 2n + 1; the root is 1.
    nodes: Vec<Node>,
    corners: Vec<u32>,
    /// The leaf of each corner; 0 if it is not in the tree.
    leaf_of: Vec<u32>,
}

#[derive(Clone, Copy)]
struct Node {
    low: Point,
    high: Point,
    begin: u32,
    end: u32,
    /// Corners not yet removed.
    live: u32,
}

impl Tree {
    pub fn new(points: &[Point], corners: Vec<u32>) -> Tree {
        let mut levels = 0;
        while corners.len().div_ceil(1 << levels) > LEAF {
            levels += 1;
        }
        let zero = Point { x: 0.0, y: 0.0 };
        let empty = Node {
            low: zero,
            high: zero,
            begin: 0,
            end: 0,
            live: 0,
        };
        let mut tree = Tree {
            nodes: vec![empty; 2 << levels],
            corners,
            leaf_of: vec![0; points.len()],
        };
        tree.build(points, 1, 0, tree.corners.len());
        tree
    }

    fn build(&mut self, points: &[Point], node: usize, begin: usize, end: usize) {
        let at = |i: &u32| points[*i as usize];
        let corners = &mut self.corners[begin..end];
        let (mut low, mut high) = (
            Point {
                x: f64::MAX,
                y: f64::MAX,
            },
            Point {
                x: f64::MIN,
                y: f64::MIN,
            },
        );
        for p in corners.iter().map(at) {
            low = Point {
                x: low.x.min(p.x),
                y: low.y.min(p.y),
            };
            high = Point {
                x: high.x.max(p.x),
                y: high.y.max(p.y),
            };
        }
        self.nodes[node] = Node {
            low,
            high,
            begin: begin as u32,
            end: end as u32,
            live: (end - begin) as u32,
        };
        if 2 * node >= self.nodes.len() {
            corners
                .iter()
                .for_each(|i| self.leaf_of[*i as usize] = node as u32);
            return;
        }
        let middle = corners.len() / 2;
        let wide = high.x - low.x > high.y - low.y;
        let along = |i: &u32| if wide { at(i).x } else { at(i).y };
        if !corners.is_empty() {
            corners.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)));
        }
        self.build(points, 2 * node, begin, begin + middle);
        self.build(points, 2 * node + 1, begin + middle, end);
    }

    /// Removes a corner, if present.
    pub fn remove(&mut self, corner: u32) {
        let mut node = std::mem::take(&mut self.leaf_of[corner as usize]) as usize;
        while node > 0 {
            self.nodes[node].live -= 1;
            node /= 2;
        }
    }

    /// A corner in or near a triangle that satisfies `fits`, and the number of corners and nodes
    /// visited.
    pub fn find(&self, triangle: [Point; 3], fits: impl Fn(u32) -> bool) -> (Option<u32>, usize) {
        let mut tests = 0;
        let mut open = vec![1];
        while let Some(number) = open.pop() {
            tests += 1;
            let node: &Node = &self.nodes[number];
            if node.live == 0 || node.is_outside(triangle) {
                continue;
            }
            if 2 * number < self.nodes.len() {
                open.extend([2 * number, 2 * number + 1]);
                continue;
            }
            for corner in &self.corners[node.begin as usize..node.end as usize] {
                tests += 1;
                if self.leaf_of[*corner as usize] > 0 && fits(*corner) {
                    return (Some(*corner), tests);
                }
            }
        }
        (None, tests)
    }
}

impl Node {
    /// Whether an edge of the triangle or the node separates them.
    fn is_outside(&self, triangle: [Point; 3]) -> bool {
        let (low, high) = (self.low, self.high);
        let beyond = |is: fn(Point, Point) -> bool, of: Point| triangle.iter().all(|p| is(*p, of));
        if beyond(|p, q| p.x < q.x, low)
            || beyond(|p, q| p.y < q.y, low)
            || beyond(|p, q| p.x > q.x, high)
            || beyond(|p, q| p.y > q.y, high)
        {
            return true;
        }
        (0..3).any(|i| {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            // The node's corner farthest to the left of the edge.
            let x = if b.y > a.y { low.x } else { high.x };
            let y = if b.x > a.x { high.y } else { low.y };
            cross(a, b, Point { x, y }) < 0.0
        })
    }
}
