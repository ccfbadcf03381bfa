//! Files that are whole or absent: written under a temporary name and renamed, read back only when their checksum fits.

use sha2::{Digest, Sha256};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// A file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// It cannot be written.
    #[error("cannot write '{}': {why}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why not.
        why: std::io::Error,
    },
    /// It cannot be read.
    #[error("cannot read '{}': {why}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        why: String,
    },
    /// What stands in it, or its name, is not what it should be.
    #[error("'{}': {why}", .path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Why not.
        why: String,
    },
}

impl FileError {
    /// Of a file that cannot be written.
    pub fn write(
        path: &Path,
        why: impl Into<Box<dyn std::error::Error + Send + Sync>>,
    ) -> FileError {
        FileError::Write {
            path: path.into(),
            why: std::io::Error::other(why),
        }
    }

    /// Of a file that cannot be read.
    pub fn read(path: &Path, why: impl ToString) -> FileError {
        FileError::Read {
            path: path.into(),
            why: why.to_string(),
        }
    }

    /// Of a file that holds something else.
    pub fn content(path: &Path, why: impl ToString) -> FileError {
        FileError::Content {
            path: path.into(),
            why: why.to_string(),
        }
    }

    /// Whether it could not be made because there is one.
    pub fn is_there(&self) -> bool {
        matches!(self, FileError::Write { why, .. } if why.kind() == std::io::ErrorKind::AlreadyExists)
    }
}

/// Writes `bytes` to `path`: a reader sees the old file or the new one, never a part.
///
/// # Errors
/// The folder cannot be made or written to, or the disk is full; the old file is untouched then.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_with(path, |file| file.write_all(bytes))
}

/// [`write_whole`], and the bytes are on the disk before the file has its name: a machine that loses power keeps it.
///
/// # Errors
/// As [`write_whole`].
pub fn write_lasting(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_with(path, |file| {
        file.write_all(bytes)?;
        file.sync_all()
    })
}

/// Like [`write_whole`], with a closure that does the writing.
///
/// # Errors
/// As [`write_whole`], and those of the closure.
fn write_with(
    path: &Path,
    write: impl FnOnce(&mut std::fs::File) -> std::io::Result<()>,
) -> Result<(), FileError> {
    let kept = temporary(path, write).and_then(|file| file.persist(path).map_err(|e| e.error));
    kept.map(drop).map_err(|why| FileError::Write {
        path: path.into(),
        why,
    })
}

/// Writes `bytes` to a file that must not exist, not even when another program makes it at this moment.
///
/// # Errors
/// As [`write_whole`], and `AlreadyExists`.
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let written = temporary(path, |file| file.write_all(bytes));
    let kept = written.and_then(|file| file.persist_noclobber(path).map_err(|e| e.error));
    kept.map(drop).map_err(|why| FileError::Write {
        path: path.into(),
        why,
    })
}

/// A finished file under a temporary name in the folder of `path`.
fn temporary(
    path: &Path,
    write: impl FnOnce(&mut std::fs::File) -> std::io::Result<()>,
) -> std::io::Result<tempfile::NamedTempFile> {
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    };
    std::fs::create_dir_all(folder)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".conelab-");
    // Temporary files are private to their owner; what is kept is for whom the user's umask says.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    write(file.as_file_mut())?;
    Ok(file)
}

/// Writes a cache file: SHA-256 of the content, then the content.
///
/// # Errors
/// As [`write_whole`].
pub fn write_checked(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_with(path, |file| {
        file.write_all(&Sha256::digest(bytes))?;
        file.write_all(bytes)
    })
}

/// What a file's name says that it holds: what stands behind the last dot, in small letters; empty without one.
pub fn ending(path: &Path) -> String {
    path.extension()
        .map_or(String::new(), |e| e.to_string_lossy().to_lowercase())
}

/// Character that stands for byte 0 of a path that is not UTF-8; the last plane is for private use.
#[cfg(unix)]
const BYTES: u32 = 0x10_ff00;

/// A path as text. Bytes that are not UTF-8 become characters for private use, from which [`path_of`] restores them.
pub fn spec_of(path: &Path) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        let chunks = path.as_os_str().as_bytes().utf8_chunks();
        let stand_in = |byte: &u8| {
            char::from_u32(BYTES + u32::from(*byte)).unwrap_or(char::REPLACEMENT_CHARACTER)
        };
        chunks.fold(String::new(), |mut text, chunk| {
            text.push_str(chunk.valid());
            text.extend(chunk.invalid().iter().map(stand_in));
            text
        })
    }
    #[cfg(not(unix))]
    path.to_string_lossy().into_owned()
}

/// The path of a text from [`spec_of`]; of any other text, the text itself.
pub fn path_of(spec: &str) -> PathBuf {
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStringExt;
        let bytes = spec.chars().flat_map(|c| {
            match u32::from(c)
                .checked_sub(BYTES)
                .and_then(|b| u8::try_from(b).ok())
            {
                Some(byte) => vec![byte],
                None => c.encode_utf8(&mut [0; 4]).as_bytes().to_vec(),
            }
        });
        std::ffi::OsString::from_vec(bytes.collect()).into()
    }
    #[cfg(not(unix))]
    PathBuf::from(spec)
}

/// Bytes in hexadecimal.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

/// So many hexadecimal digits (at most 64) of SHA-256 over parts and their lengths: what names a result by all that it
/// depends on.
pub fn content_id<T: AsRef<[u8]>>(parts: impl IntoIterator<Item = T>, digits: usize) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.as_ref().len() as u64).to_le_bytes());
        hash.update(part.as_ref());
    }
    let mut id = hex(&hash.finalize());
    id.truncate(digits);
    id
}

/// Reads a cache file; `None` when it is absent, too large (256 MiB) or not what was written.
pub fn read_checked(path: &Path) -> Option<Vec<u8>> {
    let mut bytes = read_input(path, 256 << 20).ok()?;
    if bytes.len() < 32 {
        return None;
    }
    let content = bytes.split_off(32);
    (bytes == Sha256::digest(&content)[..]).then_some(content)
}

/// Reads a file that a user or another file names. Only a regular file is opened (or a link to one): a pipe would wait, and a
/// device such as /dev/zero has no end.
///
/// # Errors
/// No such file, another kind of file, more than `most` bytes, no permission; the texts fit after the file's name.
pub fn read_input(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let length = check_input(path, most)?;
    let mut bytes = Vec::with_capacity(length as usize);
    // It may grow meanwhile, and files of /proc say that they are empty.
    std::fs::File::open(path)?
        .take(most + 1)
        .read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(unfit(format!("it has more than the {most} bytes allowed"))),
        false => Ok(bytes),
    }
}

/// Bytes of a file that others will read, if [`read_input`] would; nothing is opened.
///
/// # Errors
/// As [`read_input`].
pub fn check_input(path: &Path, most: u64) -> std::io::Result<u64> {
    let found = std::fs::metadata(path)?;
    if found.is_dir() {
        return Err(unfit("it is a folder".into()));
    }
    if !found.is_file() {
        return Err(unfit(
            "it is a pipe, a device or a socket, and no regular file".into(),
        ));
    }
    if found.len() > most {
        return Err(unfit(format!(
            "{} bytes are more than the {most} allowed",
            found.len()
        )));
    }
    Ok(found.len())
}

fn unfit(why: String) -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::InvalidInput, why)
}

/// [`read_input`] of UTF-8 text, without the byte order mark that some editors put before it.
///
/// # Errors
/// As [`read_input`], and text that is not UTF-8.
pub fn read_input_text(path: &Path, most: u64) -> std::io::Result<String> {
    let bytes = read_input(path, most)?;
    let mut text = String::from_utf8(bytes).map_err(|_| {
        std::io::Error::new(std::io::ErrorKind::InvalidData, "it is not UTF-8 text")
    })?;
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_of_any_bytes_survive_as_text() {
        assert_eq!(spec_of(Path::new("a b/\u{e9}.ron")), "a b/\u{e9}.ron");
        #[cfg(unix)]
        {
            use std::os::unix::ffi::OsStrExt;
            let path = Path::new(std::ffi::OsStr::from_bytes(b"p\xff/\xe9\xfe.ron"));
            assert_eq!(path_of(&spec_of(path)), path);
        }
    }
}
