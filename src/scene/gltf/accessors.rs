//! Accessors as vectors of numbers. Every range is checked, because counts and offsets are
//! untrusted.

use ::gltf::Accessor;
use ::gltf::accessor::{DataType, Dimensions, sparse::IndexType};

use super::buffers::{Buffers, view};

/// Largest accessor without a buffer view; nothing else bounds its size.
const MAX_ZEROS: usize = 1 << 22;

/// Vectors of N floats; normalised integers map to -1..1 or 0..1.
pub(super) fn floats<const N: usize>(
    accessor: &Accessor,
    buffers: &Buffers,
) -> Result<Vec<[f32; N]>, String> {
    check_type(accessor, buffers)?;
    let components = components(accessor.dimensions());
    if components != N {
        return Err(format!(
            "accessor {} has {components} numbers per element, not {N}",
            accessor.index()
        ));
    }
    let (kind, normalized) = (accessor.data_type(), accessor.normalized());
    let element = |bytes: &[u8]| -> [f32; N] {
        let mut numbers = bytes
            .chunks_exact(kind.size())
            .map(|b| number(b, kind, normalized));
        std::array::from_fn(|_| numbers.next().unwrap_or_default())
    };
    read(accessor, buffers, element)
}

pub(super) fn indices(accessor: &Accessor, buffers: &Buffers) -> Result<Vec<u32>, String> {
    check_type(accessor, buffers)?;
    let kind = accessor.data_type();
    let unsigned = matches!(kind, DataType::U8 | DataType::U16 | DataType::U32);
    if accessor.dimensions() != Dimensions::Scalar || !unsigned {
        return Err(format!(
            "accessor {} does not hold indices",
            accessor.index()
        ));
    }
    read(accessor, buffers, unsigned_number)
}

fn check_type(accessor: &Accessor, buffers: &Buffers) -> Result<(), String> {
    match buffers.unreadable.contains(&accessor.index()) {
        true => Err(format!(
            "accessor {} has a type that glTF does not have",
            accessor.index()
        )),
        false => Ok(()),
    }
}

fn read<T: Clone>(
    accessor: &Accessor,
    buffers: &Buffers,
    element: impl Fn(&[u8]) -> T,
) -> Result<Vec<T>, String> {
    let size = accessor.data_type().size() * components(accessor.dimensions());
    let count = accessor.count();
    let name = format!("accessor {}", accessor.index());
    let mut values = match accessor.view() {
        Some(source) => {
            let bytes = view(buffers, &source)?;
            let stride = source.stride().unwrap_or(size);
            slices(bytes, accessor.offset(), stride, size, count, &name)?
                .map(&element)
                .collect()
        }
        None if count <= MAX_ZEROS => vec![element(&vec![0; size]); count],
        None => return Err(format!("{name} has {count} elements and no buffer view")),
    };
    let Some(sparse) = accessor.sparse() else {
        return Ok(values);
    };
    let places = sparse.indices();
    let (place_size, value_view) = (index_size(places.index_type()), sparse.values());
    let place_bytes = view(buffers, &places.view())?;
    let value_bytes = view(buffers, &value_view.view())?;
    let places = slices(
        place_bytes,
        places.offset(),
        place_size,
        place_size,
        sparse.count(),
        &name,
    )?;
    let replacements = slices(
        value_bytes,
        value_view.offset(),
        size,
        size,
        sparse.count(),
        &name,
    )?;
    for (place, replacement) in places.zip(replacements) {
        let place = unsigned_number(place) as usize;
        *values
            .get_mut(place)
            .ok_or(format!("{name} replaces element {place} of {count}"))? = element(replacement);
    }
    Ok(values)
}

fn slices<'a>(
    bytes: &'a [u8],
    offset: usize,
    stride: usize,
    size: usize,
    count: usize,
    name: &str,
) -> Result<impl Iterator<Item = &'a [u8]>, String> {
    let last = count
        .saturating_sub(1)
        .checked_mul(stride)
        .and_then(|o| o.checked_add(offset)?.checked_add(size));
    if stride < size || count > 0 && last.is_none_or(|end| end > bytes.len()) {
        return Err(format!(
            "{name} reaches past the end of its buffer view: the file is damaged"
        ));
    }
    Ok((0..count).map(move |i| &bytes[offset + i * stride..offset + i * stride + size]))
}

fn components(dimensions: Dimensions) -> usize {
    match dimensions {
        Dimensions::Scalar => 1,
        Dimensions::Vec2 => 2,
        Dimensions::Vec3 => 3,
        Dimensions::Vec4 | Dimensions::Mat2 => 4,
        Dimensions::Mat3 => 9,
        Dimensions::Mat4 => 16,
    }
}

fn index_size(kind: IndexType) -> usize {
    match kind {
        IndexType::U8 => 1,
        IndexType::U16 => 2,
        IndexType::U32 => 4,
    }
}

fn unsigned_number(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |value, &byte| value << 8 | u32::from(byte))
}

fn number(bytes: &[u8], kind: DataType, normalized: bool) -> f32 {
    let raw = unsigned_number(bytes);
    let (value, most) = match kind {
        DataType::F32 => return f32::from_bits(raw),
        DataType::U8 => (raw as f32, 255.0),
        DataType::U16 => (raw as f32, 65535.0),
        DataType::U32 => (raw as f32, u32::MAX as f32),
        DataType::I8 => (f32::from(raw as u8 as i8), 127.0),
        DataType::I16 => (f32::from(raw as u16 as i16), 32767.0),
    };
    if normalized {
        (value / most).max(-1.0)
    } else {
        value
    }
}
