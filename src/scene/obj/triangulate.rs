//! Triangulation of polygons by ear clipping in the polygon's plane.
//!
//! A reflex corner inside an ear blocks it. Reflex corners are in a k-d tree, and a blocked ear is
//! retried when its blocker changes, so that polygons of a million corners take a bounded number of
//! tests.

mod plane;
mod tree;

use std::collections::VecDeque;

use plane::{Inside, Point, cross, enters, inside};
use tree::Tree;

/// Maximum tests per corner. Combs, spirals and stars of 100,000 corners need 36 to 300.
const TESTS: usize = 400;
/// Corners up to which [`TESTS`] applies; larger polygons have fewer tests per corner, which bounds
/// the time.
const LARGE: usize = 100_000;
const LARGE_TESTS: usize = 100;

/// Outcome of a triangulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cut {
    /// Whether triangles may overlap because edges cross or touch.
    pub rough: bool,
    /// Corners and tree nodes visited.
    pub tests: usize,
}

/// Appends the triangles of a polygon as corner indices with the polygon's winding.
pub(super) fn triangulate(polygon: &[[f32; 3]], out: &mut Vec<[u32; 3]>) -> Cut {
    let count = polygon.len() as u32;
    let fan = |out: &mut Vec<[u32; 3]>| out.extend((2..count).map(|i| [0, i - 1, i]));
    if count <= 3 {
        fan(out);
        return Cut::default();
    }
    let Some(planes) = plane::project(polygon) else {
        fan(out);
        return Cut {
            rough: plane::has_area(polygon),
            tests: 0,
        };
    };
    let mut all = Cut::default();
    let begin = out.len();
    for points in planes {
        out.truncate(begin);
        if plane::is_convex(&points) {
            fan(out);
            return Cut {
                rough: false,
                ..all
            };
        }
        let mut clipper = Clipper::new(&points);
        clipper.run(out);
        all = Cut {
            rough: clipper.rough,
            tests: all.tests + clipper.tests,
        };
        if !all.rough || clipper.is_exhausted() {
            break;
        }
    }
    all
}

struct Clipper<'a> {
    points: &'a [Point],
    next: Vec<u32>,
    previous: Vec<u32>,
    gone: Vec<bool>,
    left: usize,
    reflex: Tree,
    /// Corners that enclose no area. They are removed first, because an ear at a returning edge may
    /// be outside.
    nothing: Vec<u32>,
    /// Candidate ears.
    queue: VecDeque<u32>,
    queued: Vec<bool>,
    /// For each corner, the last ear that it blocks, as an index into `blocked`.
    blocks: Vec<u32>,
    /// Blocked ears, linked to the previous one with the same blocker.
    blocked: Vec<(u32, u32)>,
    /// Whether corners on the boundary of an ear are ignored.
    relaxed: bool,
    rough: bool,
    /// Twice the area below which a triangle is negligible: rounding folds straight edges.
    negligible: f64,
    tests: usize,
}

/// Negligible area relative to the polygon's.
const NEGLIGIBLE: f64 = 1e-5;
const END: u32 = u32::MAX;

impl Clipper<'_> {
    fn new(points: &[Point]) -> Clipper<'_> {
        let count = points.len() as u32;
        let next: Vec<u32> = (1..count).chain([0]).collect();
        let previous: Vec<u32> = [count - 1].into_iter().chain(0..count - 1).collect();
        let turn = |i: u32| {
            cross(
                points[previous[i as usize] as usize],
                points[i as usize],
                points[next[i as usize] as usize],
            )
        };
        let reflex: Vec<u32> = (0..count).filter(|i| turn(*i) <= 0.0).collect();
        let mut clipper = Clipper {
            points,
            next,
            previous,
            gone: vec![false; points.len()],
            left: points.len(),
            reflex: Tree::new(points, reflex),
            nothing: Vec::new(),
            queue: (0..count).collect(),
            queued: vec![true; points.len()],
            blocks: vec![END; points.len()],
            blocked: Vec::new(),
            relaxed: false,
            rough: false,
            negligible: NEGLIGIBLE * plane::area(points),
            tests: 0,
        };
        clipper.nothing = (0..count).filter(|i| clipper.is_nothing(*i)).collect();
        clipper
    }

    fn is_exhausted(&self) -> bool {
        let count = self.points.len();
        self.tests > TESTS * count.min(LARGE) + LARGE_TESTS * count
    }

    fn point(&self, corner: u32) -> Point {
        self.points[corner as usize]
    }

    fn around(&self, corner: u32) -> [u32; 3] {
        [
            self.previous[corner as usize],
            corner,
            self.next[corner as usize],
        ]
    }

    /// Positive at a convex corner.
    fn turn(&self, corner: u32) -> f64 {
        let [a, b, c] = self.around(corner).map(|i| self.point(i));
        cross(a, b, c)
    }

    fn run(&mut self, out: &mut Vec<[u32; 3]>) {
        let mut at = 0;
        while self.left > 3 {
            if self.is_exhausted() {
                self.rough = true;
                return self.fan(at, out);
            }
            if let Some(corner) = self.nothing.pop() {
                if !self.gone[corner as usize] && self.is_nothing(corner) {
                    self.remove(corner);
                }
                continue;
            }
            if let Some(corner) = self.queue.pop_front() {
                self.queued[corner as usize] = false;
                if !self.gone[corner as usize] {
                    self.attempt(corner, out);
                }
                continue;
            }
            while self.gone[at as usize] {
                at = self.next[at as usize];
                self.tests += 1;
            }
            if self.relaxed {
                at = self.force(at, out);
            } else {
                self.relaxed = true;
                let mut all = at;
                for _ in 0..self.left {
                    self.ask(all);
                    all = self.next[all as usize];
                }
            }
        }
        while self.gone[at as usize] {
            at = self.next[at as usize];
        }
        self.fan(at, out);
    }

    /// Clips a corner if it is an ear.
    fn attempt(&mut self, corner: u32, out: &mut Vec<[u32; 3]>) {
        if self.turn(corner) <= 0.0 {
            return;
        }
        match self.blocker(corner) {
            Some(blocker) => {
                self.blocked.push((corner, self.blocks[blocker as usize]));
                self.blocks[blocker as usize] = self.blocked.len() as u32 - 1;
            }
            None => {
                out.push(self.around(corner));
                self.remove(corner);
            }
        }
    }

    /// Whether a corner duplicates a neighbour or is the tip of a returning edge. Corners on a
    /// straight edge do not count.
    fn is_nothing(&self, corner: u32) -> bool {
        let [a, b, c] = self.around(corner).map(|i| self.point(i));
        let back = (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0.0;
        cross(a, b, c) == 0.0 && (back || a == b || b == c)
    }

    /// A corner inside the triangle at `corner`, or on its boundary.
    fn blocker(&mut self, corner: u32) -> Option<u32> {
        let [before, _, after] = self.around(corner);
        let triangle = self.around(corner).map(|i| self.point(i));
        let (found, tests) = self.reflex.find(triangle, |other| {
            if [before, corner, after].contains(&other) {
                return false;
            }
            match inside(triangle, self.point(other)) {
                Inside::No => false,
                Inside::Yes => true,
                Inside::Rim => !self.relaxed,
                Inside::Corner(i) => {
                    let [q, _, r] = self.around(other).map(|i| self.point(i));
                    enters(triangle, i, q) || enters(triangle, i, r)
                }
            }
        });
        self.tests += tests;
        found
    }

    /// Removes a corner and queues its neighbours and the ears that the three block.
    fn remove(&mut self, corner: u32) {
        let [before, _, after] = self.around(corner);
        self.next[before as usize] = after;
        self.previous[after as usize] = before;
        self.gone[corner as usize] = true;
        self.left -= 1;
        self.reflex.remove(corner);
        for neighbour in [before, after] {
            self.ask(neighbour);
            if self.is_nothing(neighbour) {
                self.nothing.push(neighbour);
            }
            if self.turn(neighbour) > 0.0 {
                self.reflex.remove(neighbour);
            }
        }
        for changed in [before, corner, after] {
            let mut at = std::mem::replace(&mut self.blocks[changed as usize], END);
            while let Some((ear, one_before)) = self.blocked.get(at as usize).copied() {
                self.ask(ear);
                self.tests += 1;
                at = one_before;
            }
        }
    }

    fn ask(&mut self, corner: u32) {
        if !self.queued[corner as usize] && !self.gone[corner as usize] {
            self.queued[corner as usize] = true;
            self.queue.push_back(corner);
        }
    }

    /// Clips a convex corner near `at`, whatever it contains. Returns where to continue.
    fn force(&mut self, at: u32, out: &mut Vec<[u32; 3]>) -> u32 {
        const STEPS: usize = 64;
        let mut corner = at;
        for _ in 0..STEPS {
            if self.turn(corner) > 0.0 {
                break;
            }
            corner = self.next[corner as usize];
            self.tests += 1;
        }
        let turn = self.turn(corner);
        if turn != 0.0 {
            self.rough |= turn.abs() > self.negligible;
            out.push(self.around(corner));
        }
        self.remove(corner);
        self.next[corner as usize]
    }

    /// Fans the remaining corners from one of them.
    fn fan(&mut self, from: u32, out: &mut Vec<[u32; 3]>) {
        let mut at = from;
        while self.gone[at as usize] {
            at = self.next[at as usize];
        }
        let first = at;
        let mut second = self.next[first as usize];
        for _ in 2..self.left {
            let third = self.next[second as usize];
            let turn = cross(self.point(first), self.point(second), self.point(third));
            self.rough |= turn < -self.negligible;
            if turn != 0.0 {
                out.push([first, second, third]);
            }
            second = third;
        }
    }
}

#[cfg(test)]
mod tests;
