//! Changes to lights: fields to set, lights to add and to remove.

use glam::Vec3;

use super::{Field, Kind, Light, LightKind, Quantity};
use crate::scene::MAX_COORDINATE;

/// Fields of a light as files have them. In an experiment, those that are left out keep the scene's
/// value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightFields {
    pub(super) edit: Option<Edit>,
    pub(super) vectors: Vec<(&'static Field, Vec3)>,
    /// Angles in degrees, lengths in metres.
    pub(super) numbers: Vec<(&'static Field, f64)>,
    /// Switches, by their names in [`FLAGS`](super::FLAGS).
    pub(super) flags: Vec<(&'static str, bool)>,
}

/// A change to the list of lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Edit {
    /// A light that the scene lacks.
    Add(&'static Kind),
    Remove,
}

impl LightFields {
    /// The change that removes a light.
    pub(crate) fn removal() -> LightFields {
        LightFields {
            edit: Some(Edit::Remove),
            ..LightFields::default()
        }
    }

    /// Whether it removes the light.
    pub(crate) fn removes(&self) -> bool {
        self.edit == Some(Edit::Remove)
    }

    /// The light that it adds, with its fields still to be applied.
    pub(crate) fn added(&self, name: &str) -> Option<Light> {
        match self.edit {
            Some(Edit::Add(kind)) => Some(Light::new(kind, name)),
            _ => None,
        }
    }

    /// Direction of the height, of a kind that has one.
    pub(crate) fn up(&self) -> Option<Vec3> {
        self.vectors.iter().find(|v| v.0.name == "up").map(|v| v.1)
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &'static Field> {
        let numbers = self.numbers.iter().map(|n| n.0);
        self.vectors.iter().map(|v| v.0).chain(numbers)
    }

    /// The vectors.
    pub(crate) fn vectors(&self) -> &[(&'static Field, Vec3)] {
        &self.vectors
    }

    /// The numbers, in the unit of files.
    pub(crate) fn numbers(&self) -> &[(&'static Field, f64)] {
        &self.numbers
    }

    /// The fields that differ from those of another light.
    pub(crate) fn changed(mut self, other: &LightFields) -> LightFields {
        self.vectors.retain(|field| !other.vectors.contains(field));
        self.numbers.retain(|field| !other.numbers.contains(field));
        self.flags.retain(|flag| !other.flags.contains(flag));
        self
    }

    /// Whether all values are allowed, for any kind of light.
    pub(crate) fn check(&self) -> Result<(), String> {
        let fields = self.vectors.len() + self.numbers.len() + self.flags.len();
        if self.removes() && fields > 0 {
            return Err("a removed light has no fields".into());
        }
        for (field, v) in &self.vectors {
            let rule = match field.quantity {
                Quantity::Color if !v.is_finite() || v.min_element() < 0.0 => {
                    "finite and not negative".into()
                }
                Quantity::Direction if v.try_normalize().is_none() => "finite and not zero".into(),
                Quantity::Position if !v.is_finite() || v.abs().max_element() > MAX_COORDINATE => {
                    format!("within {MAX_COORDINATE:e} m of the origin")
                }
                _ => continue,
            };
            return Err(format!("its {} must be {rule}", field.name));
        }
        for (field, x) in &self.numbers {
            if !field.allows(*x) {
                let ((least, most), unit) = (field.range, field.quantity.unit());
                return Err(format!(
                    "its {} must be {least} to {most} {unit}",
                    field.name
                ));
            }
        }
        Ok(())
    }

    /// Changes a light.
    ///
    /// # Errors
    /// Fields of other kinds of lights; a spot with an inner cone that is not inside its outer one.
    pub(crate) fn apply(&self, light: &mut Light) -> Result<(), String> {
        let lacks = |light: &Light, field: &Field| {
            let kind = light.kind.row().name.to_lowercase();
            Err(format!("is a {kind} light, which has no `{}`", field.name))
        };
        for (field, value) in &self.vectors {
            let Some(vector) = light.vector(field.name) else {
                return lacks(light, field);
            };
            // Unit vectors keep their bits, so that a written direction is read back unchanged.
            *vector = match field.quantity {
                Quantity::Direction if !value.is_normalized() => value.normalize_or(Vec3::NEG_Y),
                _ => *value,
            };
        }
        for (field, value) in &self.numbers {
            if !light.set_number(field, *value) {
                return lacks(light, field);
            }
        }
        for (name, value) in &self.flags {
            if let Some(flag) = light.flag(name) {
                *flag = *value;
            }
        }
        match light.kind {
            LightKind::Spot { inner, outer } if inner >= outer => {
                Err("needs an inner angle that is less than its outer one".into())
            }
            _ => Ok(()),
        }
    }

    /// The fields as text of an experiment.
    pub(crate) fn to_text(&self) -> String {
        let vector =
            |(f, v): &(&Field, Vec3)| format!("{}: ({:?}, {:?}, {:?})", f.name, v.x, v.y, v.z);
        let number = |(f, x): &(&Field, f64)| format!("{}: {x:?}", f.name);
        let edit = self.edit.iter().map(|edit| match edit {
            Edit::Add(kind) => format!("add: {:?}", kind.name),
            Edit::Remove => "remove: true".into(),
        });
        let fields: Vec<String> = edit
            .chain(self.vectors.iter().map(vector))
            .chain(self.numbers.iter().map(number))
            .chain(self.flags.iter().map(|(name, on)| format!("{name}: {on}")))
            .collect();
        format!("({})", fields.join(", "))
    }
}
