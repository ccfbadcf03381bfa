//! The binary container (GLB, glTF 2.0 specification, section 4).

/// The JSON of a file, and the binary chunk of a container.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<Vec<u8>>), String> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let (version, length) = (word(bytes, 4)?, word(bytes, 8)? as usize);
    if version != 2 {
        return Err(format!(
            "it is a binary file of version {version}, and 2 is read"
        ));
    }
    // Trailing bytes are not part of the container.
    let whole = bytes
        .get(..length)
        .ok_or_else(|| format!("it has {} bytes of {length}: it is cut short", bytes.len()))?;
    let (mut text, mut blob) = (None, None);
    let mut at = 12;
    while at < whole.len() {
        let (size, kind) = (word(whole, at)? as usize, word(whole, at + 4)?);
        let chunk = (at + 8)
            .checked_add(size)
            .and_then(|end| whole.get(at + 8..end));
        let chunk = chunk.ok_or("a chunk reaches past its end: it is damaged")?;
        match &kind.to_le_bytes() {
            b"JSON" if text.is_none() => text = Some(chunk),
            b"BIN\0" if blob.is_none() => blob = Some(chunk.to_vec()),
            _ => {}
        }
        at += 8 + size;
    }
    Ok((text.ok_or("it has no JSON chunk")?, blob))
}

/// A little-endian number.
fn word(bytes: &[u8], at: usize) -> Result<u32, String> {
    let word = bytes
        .get(at..at + 4)
        .and_then(|w| <[u8; 4]>::try_from(w).ok());
    word.map(u32::from_le_bytes)
        .ok_or_else(|| "it ends inside of a header: it is cut short".into())
}
