//! Modes 1 and 2: indices of triangles and other indices (appendix A of the extension).

use super::{Stream, header};

/// Indices as little-endian numbers of two or four bytes.
pub(super) fn bytes(indices: &[u32], stride: usize) -> Vec<u8> {
    match stride {
        2 => indices
            .iter()
            .flat_map(|&i| (i as u16).to_le_bytes())
            .collect(),
        _ => indices.iter().flat_map(|i| i.to_le_bytes()).collect(),
    }
}

/// Mode 2: deltas to one of two previous indices.
pub(super) fn sequence(data: &[u8], count: usize) -> Result<Vec<u32>, String> {
    header(data, &[0xd1])?;
    let mut stream = Stream::body(data, 4)?;
    // An index takes at least one byte.
    let mut out = Vec::with_capacity(count.min(stream.0.len()));
    let mut last = [0u32; 2];
    for _ in 0..count {
        let value = stream.number()?;
        let baseline = &mut last[(value & 1) as usize];
        *baseline = baseline.wrapping_add(unzigzag(value >> 1));
        out.push(*baseline);
    }
    stream.end()?;
    Ok(out)
}

/// Mode 1: triangles from recent edges and vertices.
pub(super) fn triangles(data: &[u8], count: usize) -> Result<Vec<u32>, String> {
    header(data, &[0xe1])?;
    let mut stream = Stream::body(data, 16)?;
    let table = &data[data.len() - 16..];
    let codes = stream.take(count / 3)?;
    let mut out = Vec::with_capacity(count);
    let mut state = State {
        stream,
        next: 0,
        last: 0,
        edges: Recent::new((0, 0)),
        vertices: Recent::new(0),
    };
    for &code in codes {
        out.extend(state.triangle(code, table)?);
    }
    state.stream.end()?;
    Ok(out)
}

fn unzigzag(value: u32) -> u32 {
    (value >> 1) ^ (value & 1).wrapping_neg()
}

/// The last sixteen items.
struct Recent<T> {
    items: [T; 16],
    count: usize,
}

impl<T: Copy> Recent<T> {
    fn new(zero: T) -> Recent<T> {
        Recent {
            items: [zero; 16],
            count: 0,
        }
    }

    fn push(&mut self, item: T) {
        self.items[self.count % 16] = item;
        self.count += 1;
    }

    /// The item at `index`, counted back from the latest.
    fn get(&self, index: u8) -> Result<T, String> {
        let place = self
            .count
            .checked_sub(1 + usize::from(index))
            .filter(|_| index < 16);
        place.map(|p| self.items[p % 16]).ok_or_else(|| {
            "its compressed triangles refer to an edge or a vertex that does not exist: it is damaged".into()
        })
    }
}

struct State<'a> {
    stream: Stream<'a>,
    /// The next new index.
    next: u32,
    /// The last index that was stored as a delta.
    last: u32,
    edges: Recent<(u32, u32)>,
    vertices: Recent<u32>,
}

impl State<'_> {
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3], String> {
        let (high, low) = (code >> 4, code & 15);
        if high < 15 {
            return self.beside_edge(high, low);
        }
        match low {
            0..14 => {
                let pair = table[usize::from(low)];
                self.free([0, pair >> 4, pair & 15])
            }
            _ => {
                let pair = self.stream.byte()?;
                if pair == 0 {
                    self.next = 0;
                }
                self.free([if low == 14 { 0 } else { 15 }, pair >> 4, pair & 15])
            }
        }
    }

    /// A triangle that shares a recent edge.
    fn beside_edge(&mut self, edge: u8, third: u8) -> Result<[u32; 3], String> {
        let (a, b) = self.edges.get(edge)?;
        let c = match third {
            0 => self.fresh(),
            1..13 => self.vertices.get(third)?,
            13 | 14 => {
                let step = if third == 13 { u32::MAX } else { 1 };
                self.last = self.last.wrapping_add(step);
                self.last
            }
            _ => self.stored()?,
        };
        self.edges.push((c, b));
        self.edges.push((a, c));
        if third == 0 || third > 12 {
            self.vertices.push(c);
        }
        Ok([a, b, c])
    }

    /// A triangle from the source of each corner: the next index (0), a recent one (1 to 14) or a
    /// stored one (15).
    fn free(&mut self, corners: [u8; 3]) -> Result<[u32; 3], String> {
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(corners) {
            *index = match corner {
                0 => self.fresh(),
                15 => self.stored()?,
                recent => self.vertices.get(recent - 1)?,
            };
        }
        let [a, b, c] = triangle;
        [(b, a), (c, b), (a, c)]
            .into_iter()
            .for_each(|edge| self.edges.push(edge));
        for (index, corner) in triangle.iter().zip(corners) {
            if corner == 0 || corner == 15 {
                self.vertices.push(*index);
            }
        }
        Ok(triangle)
    }

    fn fresh(&mut self) -> u32 {
        let index = self.next;
        self.next = index.wrapping_add(1);
        index
    }

    fn stored(&mut self) -> Result<u32, String> {
        self.last = self.last.wrapping_add(unzigzag(self.stream.number()?));
        Ok(self.last)
    }
}
