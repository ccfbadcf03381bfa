//! Blinn-Phong materials and their textures: OBJ with MTL, and FBX.

mod find;
mod parts;
mod pictures;

pub(super) use find::{Finder, Found};
pub(super) use parts::{Maps, Parts, Picture, grey};
pub(super) use pictures::{Asked, Words, decide};
