//! Textures of materials: external files or embedded content.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DAffine2;
use ufbx::{Texture, TextureType, WrapMode};

use super::numbers::affine;
use crate::scene::obj::shown;
use crate::scene::phong::{Finder, Found};
use crate::scene::texture::{MAX_FILE_BYTES, Requests, Source};
use crate::scene::warnings::Warnings;
use crate::scene::{Lookup, Wrap};

/// Finds and requests textures.
pub(super) struct Pictures<'a> {
    /// The name of the document.
    name: &'a str,
    finder: Finder,
    pub requests: &'a mut Requests,
    /// Embedded files by address and length.
    held: HashMap<(usize, usize), Source>,
}

/// A named coordinate set (empty: the first one) and a transform.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct UvSource {
    pub set: String,
    pub transform: DAffine2,
}

/// A texture with its coordinate source.
pub(super) struct Laid {
    pub image: Source,
    pub source: UvSource,
    pub lookup: Lookup,
    /// Whether the file is missing.
    pub is_missing: bool,
}

impl<'a> Pictures<'a> {
    pub fn new(name: &'a str, finder: Finder, requests: &'a mut Requests) -> Pictures<'a> {
        Pictures {
            name,
            finder,
            requests,
            held: HashMap::new(),
        }
    }

    /// The texture; of a layered texture, the first layer.
    pub fn find(&mut self, texture: &Texture, warnings: &mut Warnings) -> Option<Laid> {
        let name = shown(&texture.element.name);
        let Some(file) = texture.file_textures.into_iter().next() else {
            warnings.add("textures without a picture are left out", name);
            return None;
        };
        if texture.type_ != TextureType::File {
            warnings.add(
                "of textures in layers and of procedural ones the first picture is used",
                name,
            );
        }
        let wrap = |mode: WrapMode| {
            if mode == WrapMode::Clamp {
                Wrap::Clamp
            } else {
                Wrap::Repeat
            }
        };
        let to_texture = affine(&file.uv_to_texture);
        let transform = DAffine2::from_mat2_translation(
            glam::DMat2::from_cols(
                to_texture.matrix3.x_axis.truncate(),
                to_texture.matrix3.y_axis.truncate(),
            ),
            to_texture.translation.truncate(),
        );
        let (image, is_missing) = self.image(file, warnings);
        Some(Laid {
            image,
            source: UvSource {
                set: file.uv_set.to_string(),
                transform,
            },
            lookup: Lookup {
                wrap: [wrap(file.wrap_u), wrap(file.wrap_v)],
                ..Lookup::default()
            },
            is_missing,
        })
    }

    /// Embedded bytes, or the file at its relative path, or at its absolute path on the author's
    /// machine.
    fn image(&mut self, file: &Texture, warnings: &mut Warnings) -> (Source, bool) {
        let texts = [
            file.relative_filename.as_ref(),
            file.absolute_filename.as_ref(),
            file.filename.as_ref(),
        ];
        let bytes: &[u8] = &file.content;
        if !bytes.is_empty() {
            let key = (bytes.as_ptr() as usize, bytes.len());
            let name = || {
                let text = texts
                    .into_iter()
                    .find(|text| !text.is_empty())
                    .unwrap_or("picture");
                format!(
                    "{}: {}",
                    self.name,
                    shown(text.rsplit(['/', '\\']).next().unwrap_or(text))
                )
            };
            let source =
                self.held
                    .entry(key)
                    .or_insert_with(|| match bytes.len() as u64 > MAX_FILE_BYTES {
                        true => Source::Missing(
                            name(),
                            format!("it has more than {MAX_FILE_BYTES} bytes"),
                        ),
                        false => Source::Bytes(name(), Arc::new(bytes.to_vec())),
                    });
            return (source.clone(), false);
        }
        let named = || texts.into_iter().filter(|text| !text.is_empty());
        let Some(first) = named().next() else {
            return (
                Source::Missing(shown(&file.element.name), "it names no file".into()),
                true,
            );
        };
        for found in [Found::Exact, Found::Elsewhere] {
            if let Some(text) = named().find(|text| self.finder.look(text).1 == found) {
                return (Source::File(self.finder.find(text, warnings)), false);
            }
        }
        (Source::File(self.finder.look(first).0), true)
    }
}
