//! Buffers and URIs: the binary chunk, external files and embedded data.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ::gltf::{Document, buffer};
use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use rayon::prelude::*;

use super::meshopt::{self, Compressed};
use crate::files::read_input;
use crate::scene::progress::Progress;
use crate::scene::texture::Source;

/// Largest buffer; a binary file cannot hold more.
pub(super) const MAX_BYTES: u64 = 4 << 30;

/// Decoded bytes that any file may have, and how many more for each byte of its buffers.
const DECODED: usize = 1 << 28;
const DECODED_PER_BYTE: usize = 64;

/// Buffers and decoded views of a document.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    /// The bytes of each buffer, at least as many as declared, or an error.
    bytes: Vec<Result<Vec<u8>, String>>,
    /// Decompressed views by index, or an error.
    decoded: HashMap<usize, Result<Vec<u8>, String>>,
    /// Accessors of unknown type.
    pub unreadable: HashSet<usize>,
}

impl Buffers {
    /// Reads the buffers. A missing buffer is an error only if something uses it.
    pub fn load(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        unreadable: HashSet<usize>,
        folder: &Path,
        progress: Progress,
    ) -> Buffers {
        let one = |buffer: buffer::Buffer| {
            let i = buffer.index();
            if meshopt::is_fallback(&buffer) {
                return Err(format!(
                    "buffer {i} only stands for compressed views, and something else is in it"
                ));
            }
            let bytes = match buffer.source() {
                buffer::Source::Bin => blob
                    .take()
                    .ok_or(format!("buffer {i} has neither a uri nor a binary chunk"))?,
                buffer::Source::Uri(uri) => match resolve(uri, folder)? {
                    Target::Data(bytes) => bytes,
                    Target::File(path) => {
                        progress.reads(&path);
                        read_input(&path, MAX_BYTES).map_err(|error| {
                            format!(
                                "buffer {}: {error}. Copy it next to the model",
                                path.display()
                            )
                        })?
                    }
                },
            };
            if bytes.len() < buffer.length() {
                let (has, needs) = (bytes.len(), buffer.length());
                return Err(format!(
                    "buffer {i} has {has} bytes of {needs}: it is cut short; copy or export it again"
                ));
            }
            Ok(bytes)
        };
        let bytes = document.buffers().map(one).collect();
        let mut buffers = Buffers {
            bytes,
            decoded: HashMap::new(),
            unreadable,
        };
        buffers.decoded = decode(document, &buffers);
        buffers
    }

    /// Total bytes of the buffers and the decoded views.
    pub fn len(&self) -> usize {
        self.bytes
            .iter()
            .chain(self.decoded.values())
            .flatten()
            .map(Vec::len)
            .sum()
    }
}

/// Decodes the compressed views. A damaged view is an error only if something uses it.
fn decode(document: &Document, buffers: &Buffers) -> HashMap<usize, Result<Vec<u8>, String>> {
    let compressed: Vec<_> = document
        .views()
        .filter_map(|v| Compressed::of(&v).map(|c| (v.index(), v.length(), c)))
        .collect();
    let mut room = DECODED
        .saturating_add(buffers.len().saturating_mul(DECODED_PER_BYTE))
        .min(MAX_BYTES as usize);
    // Views may share compressed bytes, so a small file could otherwise fill the memory.
    let mut fits = |size: usize| {
        let left = room.checked_sub(size);
        room = left.unwrap_or(room);
        left.is_some()
    };
    let fitting: Vec<bool> = compressed
        .iter()
        .map(|(.., c)| c.as_ref().is_ok_and(|c| fits(c.size())))
        .collect();
    let one = |((index, length, compressed), fits): (_, bool)| {
        let decode = |compressed: Compressed| {
            if !fits {
                return Err("it decodes to many more bytes than the file holds".into());
            }
            let (from, count) = (compressed.offset, compressed.length);
            let bytes = compressed.decode(range(buffers, compressed.buffer, from, count)?)?;
            let (has, needs) = (bytes.len(), length);
            if has < needs {
                Err(format!("it decodes to {has} bytes of {needs}"))
            } else {
                Ok(bytes)
            }
        };
        let decoded: Result<Compressed, String> = compressed;
        (
            index,
            decoded.and_then(|c| {
                decode(c).map_err(|problem| format!("buffer view {index}: {problem}"))
            }),
        )
    };
    compressed.into_par_iter().zip(fitting).map(one).collect()
}

/// The bytes of a view.
pub(super) fn view<'a>(buffers: &'a Buffers, view: &buffer::View) -> Result<&'a [u8], String> {
    match buffers.decoded.get(&view.index()) {
        Some(decoded) => decoded.as_deref().map_err(String::clone),
        None => range(buffers, view.buffer().index(), view.offset(), view.length())
            .map_err(|problem| format!("buffer view {}: {problem}", view.index())),
    }
}

fn range(buffers: &Buffers, buffer: usize, offset: usize, length: usize) -> Result<&[u8], String> {
    let bytes = match buffers.bytes.get(buffer) {
        Some(Ok(bytes)) => bytes.as_slice(),
        Some(Err(problem)) => return Err(problem.clone()),
        None => &[],
    };
    let end = offset.checked_add(length);
    end.and_then(|end| bytes.get(offset..end))
        .ok_or_else(|| "it reaches past the end of its buffer".into())
}

/// The source of an image's bytes.
pub(super) fn image(
    image: &::gltf::Image,
    document: &Document,
    buffers: &Buffers,
    folder: &Path,
) -> Source {
    // From the JSON, because the crate's accessor requires a media type that files omit.
    let json = &document.as_json().images[image.index()];
    let name = image
        .name()
        .map_or_else(|| format!("image {}", image.index()), str::to_owned);
    if let Some(index) = &json.buffer_view {
        return match document
            .views()
            .nth(index.value())
            .map(|v| view(buffers, &v))
        {
            Some(Ok(bytes)) => Source::Bytes(name, Arc::new(bytes.to_vec())),
            Some(Err(problem)) => Source::Missing(name, problem),
            None => Source::Missing(name, "its buffer view does not exist".into()),
        };
    }
    match json.uri.as_deref().map(|uri| resolve(uri, folder)) {
        Some(Ok(Target::Data(bytes))) => Source::Bytes(name, Arc::new(bytes)),
        Some(Ok(Target::File(path))) => Source::File(path),
        Some(Err(problem)) => Source::Missing(name, problem),
        None => Source::Missing(name, "it has neither a uri nor a buffer view".into()),
    }
}

enum Target {
    Data(Vec<u8>),
    File(PathBuf),
}

fn resolve(uri: &str, folder: &Path) -> Result<Target, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, text) = data.split_once(',').ok_or("a data URI has no comma")?;
        return match kind.ends_with(";base64") {
            true => base64(text).map(Target::Data),
            false => Ok(Target::Data(percent(text))),
        };
    }
    let path = uri.strip_prefix("file://").unwrap_or(uri);
    if path.contains("://") {
        return Err(format!(
            "'{uri}' is not a local file; download it and export the model again"
        ));
    }
    let decoded = String::from_utf8(percent(path)).map_err(|_| format!("'{uri}' is not UTF-8"))?;
    Ok(Target::File(folder.join(decoded)))
}

/// RFC 3986 percent decoding; a stray percent sign is kept.
fn percent(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|d| std::str::from_utf8(d).ok());
        let value = digits
            .filter(|_| first == b'%')
            .and_then(|d| u8::from_str_radix(d, 16).ok());
        bytes.push(value.unwrap_or(first));
        rest = if value.is_some() { &after[2..] } else { after };
    }
    bytes
}

/// RFC 4648 base64, standard or URL alphabet, padding optional.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let standard = |c: u8| match c {
        b'-' => b'+',
        b'_' => b'/',
        other => other,
    };
    let digits: Vec<u8> = text
        .bytes()
        .filter(|c| !c.is_ascii_whitespace() && *c != b'=')
        .map(standard)
        .collect();
    STANDARD_NO_PAD
        .decode(digits)
        .map_err(|error| format!("a data URI is not base64: {error}"))
}
