//! Memory layout of buffer blocks from a shader's SPIR-V: names, offsets, strides.

use spirq::prelude::Type;
use spirq::ty::ScalarType;
use std::fmt;

/// Scalar types of 32 bits, and others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    Float,
    Int,
    Uint,
    /// Another width (bits).
    Other(u32),
}

/// A type with its layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Layout {
    Scalar(Scalar),
    /// Vector of 2 to 4 scalars.
    Vector(Scalar, u32),
    /// Column-major matrix.
    Matrix {
        columns: u32,
        /// Rows per column.
        rows: u32,
        /// Bytes between columns.
        stride: u32,
    },
    /// Array; no count if the length depends on the buffer.
    Array {
        of: Box<Layout>,
        count: Option<u32>,
        /// Bytes between elements.
        stride: u32,
    },
    /// A struct, or the block of a buffer.
    Struct(Vec<Member>),
}

/// A member of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Name in GLSL.
    pub name: String,
    /// Offset in the struct (bytes).
    pub offset: u32,
    pub layout: Layout,
}

/// An unknown name in a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// The path before it.
    pub of: String,
    pub name: String,
    /// The known names at this place.
    pub known: Vec<String>,
}

impl Layout {
    /// The layout of a reflected type; `None` without a layout.
    pub(super) fn of(ty: &Type) -> Option<Layout> {
        let narrow = |n: usize| u32::try_from(n).ok();
        Some(match ty {
            Type::Scalar(s) => Layout::Scalar(scalar(s)),
            Type::Vector(v) => Layout::Vector(scalar(&v.scalar_ty), v.nscalar),
            Type::Matrix(m) => Layout::Matrix {
                columns: m.nvector,
                rows: m.vector_ty.nscalar,
                stride: narrow(m.stride?)?,
            },
            Type::Array(a) => Layout::Array {
                of: Box::new(Layout::of(&a.element_ty)?),
                count: a.nelement,
                stride: narrow(a.stride?)?,
            },
            Type::Struct(s) => {
                let member = |m: &spirq::ty::StructMember| {
                    Some(Member {
                        name: m.name.clone().unwrap_or_default(),
                        offset: narrow(m.offset?)?,
                        layout: Layout::of(&m.ty)?,
                    })
                };
                Layout::Struct(s.members.iter().map(member).collect::<Option<_>>()?)
            }
            _ => return None,
        })
    }

    /// The members of a struct.
    pub fn members(&self) -> &[Member] {
        match self {
            Layout::Struct(members) => members,
            _ => &[],
        }
    }

    /// Merged (first byte, end) of members by index; `None` if one is missing.
    pub(super) fn bytes_of(
        &self,
        members: &std::collections::BTreeSet<u32>,
    ) -> Option<Vec<(u32, u32)>> {
        let all = self.members();
        members
            .iter()
            .map(|m| {
                let member = all.get(*m as usize)?;
                Some((
                    member.offset,
                    member.offset.checked_add(member.layout.bytes())?,
                ))
            })
            .collect()
    }

    /// Size of the fixed part (bytes): everything except a runtime array at the end.
    pub fn bytes(&self) -> u32 {
        match self {
            Layout::Scalar(s) => s.bytes(),
            Layout::Vector(s, n) => s.bytes() * n,
            Layout::Matrix {
                columns,
                rows,
                stride,
            } => stride
                .saturating_mul(columns.saturating_sub(1))
                .saturating_add(4 * rows),
            Layout::Array { count, stride, .. } => stride.saturating_mul(count.unwrap_or(0)),
            Layout::Struct(members) => members
                .iter()
                .map(|m| m.offset.saturating_add(m.layout.bytes()))
                .max()
                .unwrap_or(0),
        }
    }

    /// The runtime array at the end of a block, with its offset.
    pub fn endless(&self) -> Option<(&Member, u32)> {
        let last = self.members().last()?;
        match &last.layout {
            Layout::Array {
                count: None,
                stride,
                ..
            } => Some((last, *stride)),
            _ => None,
        }
    }

    /// Resolves a path to an offset and layout: members by name, vector components by x y z w,
    /// elements by `[number]`.
    pub fn find(&self, path: &str) -> Result<(u32, Layout), Missing> {
        let mut at = (0, self.clone());
        let mut walked = String::new();
        for part in path.split('.') {
            let (name, indices) = part
                .split_once('[')
                .map_or((part, ""), |(name, rest)| (name, rest));
            at = step(&at, name).map_err(|known| Missing {
                of: walked.clone(),
                name: name.into(),
                known,
            })?;
            for index in indices.split('[').filter(|i| !i.is_empty()) {
                let missing = |known: String| Missing {
                    of: walked.clone(),
                    name: part.into(),
                    known: vec![known],
                };
                let number: u32 = index
                    .trim_end_matches(']')
                    .parse()
                    .map_err(|_| missing(format!("{name}[0]")))?;
                at = match &at.1 {
                    Layout::Array { of, count, stride } if count.is_none_or(|n| number < n) => (
                        at.0.saturating_add(stride.saturating_mul(number)),
                        (**of).clone(),
                    ),
                    Layout::Array { count, .. } => {
                        return Err(missing(format!(
                            "{name}[{}]",
                            count.unwrap_or(1).saturating_sub(1)
                        )));
                    }
                    _ => return Err(missing(name.into())),
                };
            }
            if !walked.is_empty() {
                walked.push('.');
            }
            walked.push_str(part);
        }
        Ok(at)
    }

    /// About `most` leading 32-bit scalars with their offsets; runtime arrays are skipped.
    fn words(&self, start: u32, most: usize) -> Vec<(u32, Scalar)> {
        let mut list = Vec::new();
        match self {
            Layout::Scalar(s) => list.push((start, *s)),
            Layout::Vector(s, n) => list.extend((0..*n).map(|i| (start.saturating_add(4 * i), *s))),
            Layout::Matrix { .. } => {}
            Layout::Array { of, count, stride } => {
                for i in (0..count.unwrap_or(0)).take(most) {
                    if list.len() < most {
                        list.extend(of.words(start.saturating_add(stride.saturating_mul(i)), most));
                    }
                }
            }
            Layout::Struct(members) => {
                for m in members.iter().take(most) {
                    if list.len() < most {
                        list.extend(m.layout.words(start.saturating_add(m.offset), most));
                    }
                }
            }
        }
        list
    }

    /// All scalar members, including those of nested structs, with their offsets.
    fn scalars(&self, start: u32) -> Vec<(u32, Scalar)> {
        let of = |m: &Member| match &m.layout {
            Layout::Scalar(s) => vec![(start.saturating_add(m.offset), *s)],
            inner => inner.scalars(start.saturating_add(m.offset)),
        };
        self.members().iter().flat_map(of).collect()
    }

    /// Whether `count` consecutive `uint`s begin at a resolved path: a vector, array or struct of
    /// that size, or the first of that many consecutive members.
    pub fn has_uints(&self, (offset, found): &(u32, Layout), count: u32) -> bool {
        let words = match found {
            Layout::Scalar(_) => self.scalars(0),
            _ => Some(found.words(*offset, 16))
                .filter(|w| w.len() == count as usize)
                .unwrap_or_default(),
        };
        (0..count).all(|i| words.contains(&(offset.saturating_add(4 * i), Scalar::Uint)))
    }
}

/// Resolves one name; on failure returns the known names.
fn step((offset, layout): &(u32, Layout), name: &str) -> Result<(u32, Layout), Vec<String>> {
    match layout {
        Layout::Struct(members) => match members.iter().find(|m| m.name == name) {
            Some(m) => Ok((offset.saturating_add(m.offset), m.layout.clone())),
            None => Err(members.iter().map(|m| m.name.clone()).collect()),
        },
        Layout::Vector(s, n) => {
            let names: Vec<&str> = ["x", "y", "z", "w"].into_iter().take(*n as usize).collect();
            match (0..).zip(&names).find(|(_, c)| **c == name) {
                Some((i, _)) => Ok((offset.saturating_add(s.bytes() * i), Layout::Scalar(*s))),
                None => Err(names.into_iter().map(String::from).collect()),
            }
        }
        _ => Err(vec![]),
    }
}

fn scalar(ty: &ScalarType) -> Scalar {
    match ty {
        ScalarType::Float { bits: 32, .. } => Scalar::Float,
        ScalarType::Integer {
            bits: 32,
            is_signed: true,
        } => Scalar::Int,
        ScalarType::Integer {
            bits: 32,
            is_signed: false,
        } => Scalar::Uint,
        ScalarType::Float { bits, .. } | ScalarType::Integer { bits, .. } => Scalar::Other(*bits),
        _ => Scalar::Other(32),
    }
}

impl Scalar {
    fn bytes(self) -> u32 {
        match self {
            Scalar::Other(bits) => bits / 8,
            _ => 4,
        }
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Layout::Scalar(Scalar::Float) => write!(f, "float"),
            Layout::Scalar(Scalar::Int) => write!(f, "int"),
            Layout::Scalar(Scalar::Uint) => write!(f, "uint"),
            Layout::Scalar(Scalar::Other(bits)) => write!(f, "number of {bits} bits"),
            Layout::Vector(Scalar::Float, n) => write!(f, "vec{n}"),
            Layout::Vector(Scalar::Int, n) => write!(f, "ivec{n}"),
            Layout::Vector(Scalar::Uint, n) => write!(f, "uvec{n}"),
            Layout::Vector(Scalar::Other(bits), n) => {
                write!(f, "vector of {n} numbers of {bits} bits")
            }
            Layout::Matrix { columns, rows, .. } if columns == rows => write!(f, "mat{columns}"),
            Layout::Matrix { columns, rows, .. } => write!(f, "mat{columns}x{rows}"),
            Layout::Array {
                of, count: Some(n), ..
            } => write!(f, "{of}[{n}]"),
            Layout::Array {
                of, count: None, ..
            } => write!(f, "{of}[]"),
            Layout::Struct(members) => {
                let names: Vec<&str> = members.iter().map(|m| m.name.as_str()).collect();
                write!(f, "struct {{ {} }}", names.join(", "))
            }
        }
    }
}
