//! Versions of parts.

use super::hashed;

/// The version of a part: of its last replacement, and of the partial stores since.
#[derive(Clone, Debug)]
pub(super) struct Version {
    /// Hash of all below. Equal numbers are equal contents.
    pub id: u64,
    /// The write that last replaced the whole part.
    base: u64,
    /// Partial stores since then, the latest last. A repeated store overwrites its earlier content,
    /// so it is listed once.
    stores: Vec<u64>,
}

/// Number of listed stores. The oldest are merged into the base, which may run a step once more
/// than necessary.
const MAX_STORES: usize = 8;

impl Version {
    /// A version that no step writes.
    pub fn unknown(id: u64) -> Version {
        Version {
            id,
            base: id,
            stores: Vec::new(),
        }
    }

    /// A write. One that `replaces` leaves nothing of the old content, or has read it, so that `id`
    /// covers it.
    pub fn write(&mut self, id: u64, replaces: bool) {
        if replaces {
            *self = Version::unknown(id);
            return;
        }
        self.stores.retain(|store| *store != id);
        self.stores.push(id);
        if self.stores.len() > MAX_STORES {
            self.base = hashed((self.base, self.stores.remove(0)));
        }
        self.id = hashed((self.base, &self.stores));
    }
}
