//! Compressed buffer views: EXT_meshopt_compression and KHR_meshopt_compression. Both use the same
//! bit streams; the second adds version 1 of attributes and the colour filter.

mod attributes;
mod filters;
mod indices;
#[cfg(test)]
mod tests;

use ::gltf::buffer;
use serde_json::{Map, Value};

const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// A compressed buffer view.
#[derive(Debug)]
pub(super) struct Compressed {
    pub buffer: usize,
    pub offset: usize,
    pub length: usize,
    layout: Layout,
}

/// The elements of a buffer view and their encoding.
#[derive(Clone, Copy, Debug)]
struct Layout {
    count: usize,
    stride: usize,
    mode: Mode,
    filter: Filter,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Filter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Compressed {
    /// The compression of a view, if any.
    pub fn of(view: &buffer::View) -> Option<Result<Compressed, String>> {
        let fields = extension(view.extensions())?;
        Some(parse(fields).map_err(|problem| format!("buffer view {}: {problem}", view.index())))
    }

    /// Decoded size, bytes.
    pub fn size(&self) -> usize {
        self.layout.count.saturating_mul(self.layout.stride)
    }

    /// Decodes the view's bytes.
    pub fn decode(&self, stream: &[u8]) -> Result<Vec<u8>, String> {
        let Layout {
            count,
            stride,
            mode,
            filter,
        } = self.layout;
        let mut bytes = match mode {
            Mode::Attributes => attributes::decode(stream, count, stride)?,
            Mode::Triangles => indices::bytes(&indices::triangles(stream, count)?, stride),
            Mode::Indices => indices::bytes(&indices::sequence(stream, count)?, stride),
        };
        match filter {
            Filter::None => {}
            Filter::Octahedral => filters::octahedral(&mut bytes, stride),
            Filter::Quaternion => filters::quaternion(&mut bytes),
            Filter::Exponential => filters::exponential(&mut bytes),
            Filter::Color => filters::color(&mut bytes, stride),
        }
        Ok(bytes)
    }
}

/// Whether a buffer only stands for decoded data and need not be read.
pub(super) fn is_fallback(buffer: &buffer::Buffer) -> bool {
    extension(buffer.extensions()).and_then(|e| e.get("fallback")) == Some(&Value::Bool(true))
}

fn extension(extensions: Option<&Map<String, Value>>) -> Option<&Value> {
    NAMES.iter().find_map(|name| extensions?.get(*name))
}

fn parse(fields: &Value) -> Result<Compressed, String> {
    let number = |key: &str| {
        fields
            .get(key)
            .and_then(Value::as_u64)
            .and_then(|n| usize::try_from(n).ok())
    };
    let needed =
        |key: &str| number(key).ok_or_else(|| format!("its compression has no valid `{key}`"));
    let name = |key: &str| fields.get(key).map(|v| v.as_str().unwrap_or("of no name"));
    let mode = match name("mode").unwrap_or("of no name") {
        "ATTRIBUTES" => Mode::Attributes,
        "TRIANGLES" => Mode::Triangles,
        "INDICES" => Mode::Indices,
        other => return Err(format!("its compression mode {other} is not known")),
    };
    let filter = match name("filter").unwrap_or("NONE") {
        "NONE" => Filter::None,
        "OCTAHEDRAL" => Filter::Octahedral,
        "QUATERNION" => Filter::Quaternion,
        "EXPONENTIAL" => Filter::Exponential,
        "COLOR" => Filter::Color,
        other => return Err(format!("its compression filter {other} is not known")),
    };
    let layout = Layout {
        count: needed("count")?,
        stride: needed("byteStride")?,
        mode,
        filter,
    };
    if !layout.is_valid() {
        let Layout { count, stride, .. } = layout;
        return Err(format!(
            "{count} elements of {stride} bytes do not fit {mode:?} with the filter {filter:?}"
        ));
    }
    let offset = number("byteOffset").unwrap_or(0);
    Ok(Compressed {
        buffer: needed("buffer")?,
        offset,
        length: needed("byteLength")?,
        layout,
    })
}

impl Layout {
    /// The rules of the extension's section "JSON schema updates".
    fn is_valid(&self) -> bool {
        let Layout {
            count,
            stride,
            mode,
            filter,
        } = *self;
        let by_mode = match mode {
            Mode::Attributes => stride.is_multiple_of(4) && (4..=256).contains(&stride),
            Mode::Triangles => {
                count.is_multiple_of(3) && [2, 4].contains(&stride) && filter == Filter::None
            }
            Mode::Indices => [2, 4].contains(&stride) && filter == Filter::None,
        };
        let by_filter = match filter {
            Filter::None | Filter::Exponential => true,
            Filter::Octahedral | Filter::Color => [4, 8].contains(&stride),
            Filter::Quaternion => stride == 8,
        };
        by_mode && by_filter
    }
}

/// Compressed bytes, read from the front.
struct Stream<'a>(&'a [u8]);

const SHORT: &str = "its compressed data ends too early: it is damaged";
const LONG: &str = "its compressed data has bytes left over: it is damaged";

impl<'a> Stream<'a> {
    /// The bytes between the header byte and a tail of a given size.
    fn body(data: &'a [u8], tail: usize) -> Result<Stream<'a>, String> {
        let end = data.len().checked_sub(tail).ok_or(SHORT)?;
        data.get(1..end).map(Stream).ok_or_else(|| SHORT.into())
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(SHORT)?;
        self.0 = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, String> {
        let (&first, rest) = self.0.split_first().ok_or(SHORT)?;
        self.0 = rest;
        Ok(first)
    }

    /// An unsigned LEB128 number of at most five bytes.
    fn number(&mut self) -> Result<u32, String> {
        let mut value = 0;
        for i in 0..5 {
            let byte = self.byte()?;
            value |= u32::from(byte & 127) << (7 * i);
            if byte < 128 {
                return Ok(value);
            }
        }
        Err("its compressed data has a number of more than five bytes: it is damaged".into())
    }

    fn end(&self) -> Result<(), String> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(LONG.into())
        }
    }
}

/// Checks that the stream begins with one of the header bytes, and returns it.
fn header(stream: &[u8], known: &[u8]) -> Result<u8, String> {
    let first = *stream.first().ok_or(SHORT)?;
    if known.contains(&first) {
        Ok(first)
    } else {
        Err(format!(
            "its compressed data has the unknown header {first:#x}"
        ))
    }
}
