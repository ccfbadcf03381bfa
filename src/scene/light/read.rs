//! Reading lights of scene files and changes of experiments.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, EnumAccess, Error, MapAccess, VariantAccess, Visitor};

use super::change::{Edit, LightFields};
use super::{FIELDS, FLAGS, Field, KINDS, Kind, Light, Quantity};

/// Names of [`KINDS`], in their order.
static KIND_NAMES: [&str; KINDS.len()] = {
    let mut names = [""; KINDS.len()];
    let mut i = 0;
    while i < KINDS.len() {
        assert!(KINDS[i].template.index() == i, "a row is out of order");
        names[i] = KINDS[i].name;
        i += 1;
    }
    names
};

/// Names of the fields in experiments.
static IN_EXPERIMENTS: [&str; FIELDS.len() + 4] = {
    let mut names = [
        FLAGS[0], FLAGS[1], "add", "remove", "", "", "", "", "", "", "", "", "",
    ];
    let mut i = 0;
    while i < FIELDS.len() {
        names[i + 4] = FIELDS[i].name;
        i += 1;
    }
    names
};

/// Names of the fields in scene files.
static IN_SCENES: [&str; FIELDS.len() + 3] = {
    let mut names = [
        FLAGS[0], FLAGS[1], "name", "", "", "", "", "", "", "", "", "",
    ];
    let mut i = 0;
    while i < FIELDS.len() {
        names[i + 3] = FIELDS[i].file;
        i += 1;
    }
    names
};

/// A key of a struct.
struct Key(String);

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Name;
        impl Visitor<'_> for Name {
            type Value = Key;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a field")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Key, E> {
                Ok(Key(name.to_owned()))
            }
        }
        deserializer.deserialize_identifier(Name)
    }
}

/// Reads the fields of a light; names are those of scene files or those of experiments.
struct ReadFields {
    in_scene: bool,
}

#[derive(Default)]
struct Read {
    name: String,
    fields: LightFields,
}

impl<'de> Visitor<'de> for ReadFields {
    type Value = Read;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("the fields of a light")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Read, A::Error> {
        let mut read = Read::default();
        let mut seen: Vec<String> = Vec::new();
        let names: &'static [&'static str] = if self.in_scene {
            &IN_SCENES
        } else {
            &IN_EXPERIMENTS
        };
        while let Some(Key(key)) = map.next_key()? {
            let Some(name) = names.iter().find(|name| **name == key) else {
                return Err(Error::unknown_field(&key, names));
            };
            if seen.contains(&key) {
                return Err(Error::duplicate_field(name));
            }
            seen.push(key);
            let of = |f: &&Field| *name == if self.in_scene { f.file } else { f.name };
            match (*name, FIELDS.iter().find(of)) {
                (_, Some(field)) => match field.quantity {
                    // Radians are rounded once more than in experiments, so that scenes of older
                    // versions keep their hash.
                    Quantity::Angle if self.in_scene => {
                        let degrees: f32 = map.next_value()?;
                        let exact = field.quantity.shown(degrees.to_radians());
                        read.fields.numbers.push((field, exact));
                    }
                    Quantity::Angle | Quantity::Length => {
                        read.fields.numbers.push((field, map.next_value()?));
                    }
                    _ => read.fields.vectors.push((field, map.next_value()?)),
                },
                ("add", None) => {
                    let kind: String = map.next_value()?;
                    read.fields.edit = Some(Edit::Add(row(&kind)?));
                }
                ("remove", None) if map.next_value()? => read.fields.edit = Some(Edit::Remove),
                ("remove", None) => {}
                ("name", None) => read.name = map.next_value()?,
                (flag, None) => read.fields.flags.push((flag, map.next_value()?)),
            }
        }
        // In the order of the table, whatever that of the file: equal fields are then equal.
        let place = |field: &Field| FIELDS.iter().position(|f| f == field);
        read.fields.vectors.sort_by_key(|v| place(v.0));
        read.fields.numbers.sort_by_key(|n| place(n.0));
        let place = |name: &str| FLAGS.iter().position(|f| *f == name);
        read.fields.flags.sort_by_key(|f| place(f.0));
        Ok(read)
    }
}

impl<'de> Deserialize<'de> for LightFields {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let fields = ReadFields { in_scene: false };
        let read = deserializer.deserialize_struct("Light", &IN_EXPERIMENTS, fields)?;
        Ok(read.fields)
    }
}

impl<'de> Deserialize<'de> for Light {
    /// A light of a scene file: the kind with all its fields.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OfKind;
        impl<'de> Visitor<'de> for OfKind {
            type Value = Light;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a light: {}", KIND_NAMES.join(", "))
            }

            fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<Light, A::Error> {
                let (Key(name), fields) = data.variant()?;
                let read = fields.struct_variant(&IN_SCENES, ReadFields { in_scene: true })?;
                light(row(&name)?, read)
            }
        }
        deserializer.deserialize_enum("Light", &KIND_NAMES, OfKind)
    }
}

/// The kind of a name in files.
fn row<E: Error>(name: &str) -> Result<&'static Kind, E> {
    let mut kinds = KINDS.iter();
    kinds
        .find(|kind| kind.name == name)
        .ok_or_else(|| E::unknown_variant(name, &KIND_NAMES))
}

fn light<E: Error>(kind: &Kind, read: Read) -> Result<Light, E> {
    let mut light = Light::new(kind, &read.name);
    if !read.fields.flags.iter().any(|f| f.0 == "shadow") {
        return Err(E::missing_field("shadow"));
    }
    for missing in light.fields().names().filter(|f| f.name != "up") {
        if !read.fields.names().any(|given| given == missing) {
            return Err(E::missing_field(missing.file));
        }
    }
    let named = |separator: &str, why: String| E::custom(format!("this light{separator}{why}"));
    read.fields.check().map_err(|why| named(": ", why))?;
    let placed = read.fields.apply(&mut light);
    placed.map_err(|why| named(" ", why))?;
    Ok(light)
}
