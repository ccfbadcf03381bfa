//! Textures of a glTF file: pairs of an image and a sampler.

use indexmap::IndexSet;
use serde_json::{Value, json};

use crate::scene::{Lookup, Wrap};

/// The textures used by materials, each pair of image and sampler once.
#[derive(Default)]
pub(super) struct Textures {
    pairs: IndexSet<(u32, Lookup)>,
}

impl Textures {
    /// A material's reference to an image.
    pub fn reference(&mut self, image: u32, lookup: Lookup) -> Value {
        // The set of coordinates belongs to the reference, not to the texture.
        let (index, _) = self.pairs.insert_full((
            image,
            Lookup {
                second_set: false,
                ..lookup
            },
        ));
        if lookup.second_set {
            json!({ "index": index, "texCoord": 1 })
        } else {
            json!({ "index": index })
        }
    }

    /// The file's `textures`; each has its own sampler.
    pub fn list(&self) -> Vec<Value> {
        (0..)
            .zip(&self.pairs)
            .map(|(i, (image, _)): (usize, _)| json!({ "source": image, "sampler": i }))
            .collect()
    }

    /// The file's `samplers`.
    pub fn samplers(&self) -> Vec<Value> {
        self.pairs
            .iter()
            .map(|(_, lookup)| sampler(lookup))
            .collect()
    }
}

fn sampler(lookup: &Lookup) -> Value {
    let [u, v] = lookup.wrap.map(|wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Clamp => 33071,
        Wrap::Mirror => 33648,
    });
    let filter = if lookup.nearest { 9728 } else { 9729 };
    json!({ "wrapS": u, "wrapT": v, "magFilter": filter, "minFilter": 9987 })
}
