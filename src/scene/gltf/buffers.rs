//! Buffers and URIs: the binary chunk, files beside the model and data inside of it.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ::gltf::{Document, buffer};
use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;

use crate::files::read_input;
use crate::scene::progress::Progress;
use crate::scene::texture::Source;

/// Buffers larger than this are refused; a binary file cannot have more.
pub(super) const MAX_BYTES: u64 = 4 << 30;

/// What a document's numbers are read from.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    /// The bytes of each buffer, at least as many as the file says; or why there are none.
    bytes: Vec<Result<Vec<u8>, String>>,
    /// Accessors of a type that the format does not have.
    pub unreadable: HashSet<usize>,
}

impl Buffers {
    /// Reads the buffers. One that cannot be read is a mistake only where something in it is used.
    pub fn load(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        unreadable: HashSet<usize>,
        folder: &Path,
        progress: Progress,
    ) -> Buffers {
        let one = |buffer: buffer::Buffer| {
            let i = buffer.index();
            let bytes = match buffer.source() {
                buffer::Source::Bin => blob.take().ok_or(format!("buffer {i} has neither a uri nor a binary chunk"))?,
                buffer::Source::Uri(uri) => match resolve(uri, folder)? {
                    Target::Data(bytes) => bytes,
                    Target::File(path) => {
                        progress.reads(&path);
                        read_input(&path, MAX_BYTES)
                            .map_err(|error| format!("buffer {}: {error}. Copy it beside the model", path.display()))?
                    }
                },
            };
            if bytes.len() < buffer.length() {
                let (has, needs) = (bytes.len(), buffer.length());
                return Err(format!("buffer {i} has {has} bytes of {needs}: it is cut short; copy or export it again"));
            }
            Ok(bytes)
        };
        Buffers { bytes: document.buffers().map(one).collect(), unreadable }
    }

    /// Bytes of all buffers.
    pub fn len(&self) -> usize {
        self.bytes.iter().flatten().map(Vec::len).sum()
    }
}

/// The bytes of a view, or what is wrong with it.
pub(super) fn view<'a>(buffers: &'a Buffers, view: &buffer::View) -> Result<&'a [u8], String> {
    let bytes = match buffers.bytes.get(view.buffer().index()) {
        Some(Ok(bytes)) => bytes.as_slice(),
        Some(Err(problem)) => return Err(problem.clone()),
        None => &[],
    };
    let end = view.offset().checked_add(view.length());
    end.and_then(|end| bytes.get(view.offset()..end))
        .ok_or_else(|| format!("buffer view {} reaches past the end of its buffer", view.index()))
}

/// Where an image's bytes are.
pub(super) fn image(image: &::gltf::Image, document: &Document, buffers: &Buffers, folder: &Path) -> Source {
    // By its JSON: the crate's own accessor requires a media type that files leave out.
    let json = &document.as_json().images[image.index()];
    let name = image.name().map_or_else(|| format!("image {}", image.index()), str::to_owned);
    if let Some(index) = &json.buffer_view {
        return match document.views().nth(index.value()).map(|v| view(buffers, &v)) {
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
        return Err(format!("'{uri}' is not a local file; download it and export the model again"));
    }
    let decoded = String::from_utf8(percent(path)).map_err(|_| format!("'{uri}' is not UTF-8"))?;
    Ok(Target::File(folder.join(decoded)))
}

/// RFC 3986 percent decoding; a stray percent sign stays.
fn percent(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|d| std::str::from_utf8(d).ok());
        let value = digits.filter(|_| first == b'%').and_then(|d| u8::from_str_radix(d, 16).ok());
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
    let digits: Vec<u8> = text.bytes().filter(|c| !c.is_ascii_whitespace() && *c != b'=').map(standard).collect();
    STANDARD_NO_PAD.decode(digits).map_err(|error| format!("a data URI is not base64: {error}"))
}
