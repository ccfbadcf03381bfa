//! Tables of a graph with their bytes, and the cells that these become.

use std::fmt;

/// A table with its bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Index of the 32-bit word that holds the number of rows.
    pub rows: u32,
    /// Byte where the first row begins.
    pub start: u32,
    /// Bytes from one row to the next.
    pub stride: u32,
    /// Columns in the order shown.
    pub columns: Vec<Column>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Heading, unique in the table.
    pub name: String,
    /// Byte of the row where it begins.
    pub at: u32,
    /// Type of its values.
    pub kind: CellKind,
    /// Unit, for people.
    pub unit: String,
}

/// Type of a column's values: 32-bit numbers, one or several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "named after GLSL's types")]
pub enum CellKind {
    Uint,
    Int,
    Float,
    Vec2,
    Vec3,
    Vec4,
}

impl CellKind {
    /// Size in bytes.
    pub fn bytes(self) -> usize {
        match self {
            CellKind::Uint | CellKind::Int | CellKind::Float => 4,
            CellKind::Vec2 => 8,
            CellKind::Vec3 => 12,
            CellKind::Vec4 => 16,
        }
    }
}

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Value of a `uint` column.
    Uint(u32),
    /// Value of an `int` column.
    Int(i32),
    /// Value of a `float` column.
    Float(f32),
    /// Value of a `vec2`, `vec3` or `vec4` column.
    Vector(Vec<f32>),
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cell::Uint(v) => write!(f, "{v}"),
            Cell::Int(v) => write!(f, "{v}"),
            Cell::Float(v) => write!(f, "{v:.4}"),
            Cell::Vector(v) => {
                let parts: Vec<String> = v.iter().map(|x| format!("{x:.4}")).collect();
                write!(f, "{}", parts.join(" "))
            }
        }
    }
}

/// Most rows of a table; further rows are not shown.
pub const MAX_ROWS: usize = 100_000;

/// The rows that `bytes`, the content of the table's buffer, hold: as many as the row word says,
/// and at most as fit.
pub fn decode(table: &Table, bytes: &[u8]) -> Vec<Vec<Cell>> {
    let count = word(bytes, table.rows as usize * 4)
        .map_or(0, |n| n as usize)
        .min(MAX_ROWS);
    let stride = table.stride as usize;
    let rows = bytes.get(table.start as usize..).unwrap_or_default();
    let whole = rows.len().checked_div(stride).unwrap_or(0);
    (0..count.min(whole))
        .map(|row| decode_row(table, &rows[row * stride..(row + 1) * stride]))
        .collect()
}

fn decode_row(table: &Table, row: &[u8]) -> Vec<Cell> {
    let column = |c: &Column| {
        let (kind, at) = (c.kind, c.at as usize);
        let value = |i: usize| word(row, at + 4 * i).unwrap_or(0);
        match kind {
            CellKind::Uint => Cell::Uint(value(0)),
            CellKind::Int => Cell::Int(value(0).cast_signed()),
            CellKind::Float => Cell::Float(f32::from_bits(value(0))),
            _ => Cell::Vector(
                (0..kind.bytes() / 4)
                    .map(|i| f32::from_bits(value(i)))
                    .collect(),
            ),
        }
    };
    table.columns.iter().map(column).collect()
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at.checked_add(4)?)?;
    bytes.try_into().ok().map(u32::from_ne_bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column((name, at, kind): (&str, u32, CellKind)) -> Column {
        Column {
            name: name.into(),
            at,
            kind,
            unit: String::new(),
        }
    }

    fn pairs() -> Table {
        use CellKind::{Float, Int, Uint, Vec3};
        let columns = [
            ("n", 0, Int),
            ("k", 0, Uint),
            ("x", 4, Float),
            ("v", 4, Vec3),
        ];
        Table {
            rows: 1,
            start: 8,
            stride: 16,
            columns: columns.map(column).into(),
        }
    }

    fn buffer(rows: u32, floats: &[f32]) -> Vec<u8> {
        let mut words = vec![7, rows];
        words.extend(floats.iter().map(|f| f.to_bits()));
        words.iter().flat_map(|w| w.to_ne_bytes()).collect()
    }

    #[test]
    fn rows_become_cells() {
        let minus_two = f32::from_bits((-2i32).cast_unsigned());
        let cells = decode(&pairs(), &buffer(1, &[minus_two, 1.5, 2.0, 3.0]));
        let vector = Cell::Vector(vec![1.5, 2.0, 3.0]);
        assert_eq!(
            cells,
            [[
                Cell::Int(-2),
                Cell::Uint(0xffff_fffe),
                Cell::Float(1.5),
                vector
            ]]
        );
        let text: Vec<String> = cells[0].iter().map(ToString::to_string).collect();
        assert_eq!(text, ["-2", "4294967294", "1.5000", "1.5000 2.0000 3.0000"]);
    }

    #[test]
    fn what_does_not_fit_is_not_read() {
        // The word asks for more rows than there are bytes; the last row is cut short; there is no
        // row word at all.
        assert_eq!(decode(&pairs(), &buffer(u32::MAX, &[0.0; 11])).len(), 2);
        assert_eq!(decode(&pairs(), &buffer(0, &[0.0; 8])).len(), 0);
        assert_eq!(decode(&pairs(), &[0; 4]).len(), 0);
        let dense = Table {
            rows: 0,
            start: 4,
            stride: 4,
            columns: vec![column(("n", 0, CellKind::Uint))],
        };
        let mut bytes = vec![0xff; 4];
        bytes.resize(4 * (MAX_ROWS + 10), 0);
        assert_eq!(decode(&dense, &bytes).len(), MAX_ROWS);
    }
}
