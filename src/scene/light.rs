//! Lights: the kinds that there are and, in one table, the fields of each. Scene files,
//! experiments, the window, summaries and hashes follow from them.

use std::fmt;

use glam::{Mat4, Vec3};
use serde::Deserialize;
use serde::de::{Deserializer, EnumAccess, Error, MapAccess, VariantAccess, Visitor};

use super::MAX_COORDINATE;

/// Emission pattern of a light, with the numbers that only this kind has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel rays, for example of the sun.
    Directional,
    /// Uniform in all directions.
    Point,
    /// Half-angles of the cone in radians: full intensity inside `inner`, none outside `outer`.
    Spot {
        /// Radians.
        inner: f32,
        /// Radians, above `inner`.
        outer: f32,
    },
    /// A rectangle around the position that emits to one side, by the cosine law.
    Rectangle {
        /// Extent across `up` (m).
        width: f32,
        /// Extent along `up` (m).
        height: f32,
    },
    /// A disc around the position that emits to one side, by the cosine law.
    Disc {
        /// m.
        radius: f32,
    },
}

/// A light. Emissive surfaces are materials instead.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name that experiments use to change the light.
    pub name: String,
    /// Emission pattern.
    pub kind: LightKind,
    /// Irradiance on a facing surface (W/m²) of a directional light, radiant intensity (W/sr) of a
    /// point or spot light, radiance (W/(m² sr)) of a rectangle or disc.
    pub color: Vec3,
    /// World (m); ignored for a directional light.
    pub position: Vec3,
    /// Unit length, the way the light travels.
    pub direction: Vec3,
    /// Direction of a rectangle's height; need not be orthogonal to `direction`.
    pub up: Vec3,
    /// Whether it has a shadow map.
    pub shadow: bool,
}

impl Default for Light {
    /// A white directional light from above.
    fn default() -> Self {
        Light {
            name: String::new(),
            kind: LightKind::Directional,
            color: Vec3::ONE,
            position: Vec3::ZERO,
            direction: Vec3::NEG_Y,
            up: Vec3::Y,
            shadow: true,
        }
    }
}

/// Views of a light's shadow maps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Views {
    /// One orthographic view.
    Parallel,
    /// One perspective view over the outer cone.
    Cone,
    /// Six perspective views, one for each face of a cube.
    Cube,
}

/// A kind of light. Its number in shaders is its place in [`KINDS`].
#[derive(Debug)]
pub(crate) struct Kind {
    /// Name in scene files; in lower case everywhere else.
    pub name: &'static str,
    /// Numbers that files replace.
    template: LightKind,
    /// Quantity of the colour.
    pub color: &'static str,
    pub views: Views,
}

const fn kind(name: &'static str, template: LightKind, color: &'static str, views: Views) -> Kind {
    Kind {
        name,
        template,
        color,
        views,
    }
}

pub(crate) const KINDS: [Kind; 5] = [
    kind(
        "Directional",
        LightKind::Directional,
        "irradiance",
        Views::Parallel,
    ),
    kind("Point", LightKind::Point, "intensity", Views::Cube),
    kind(
        "Spot",
        LightKind::Spot {
            inner: 0.0,
            outer: 0.0,
        },
        "intensity",
        Views::Cone,
    ),
    kind(
        "Rectangle",
        LightKind::Rectangle {
            width: 0.0,
            height: 0.0,
        },
        "radiance",
        Views::Cube,
    ),
    kind(
        "Disc",
        LightKind::Disc { radius: 0.0 },
        "radiance",
        Views::Cube,
    ),
];

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

/// Quantity of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Quantity {
    /// Linear RGB in the unit of the kind.
    Color,
    /// A point in the world (m).
    Position,
    /// A direction; files need not have it at unit length.
    Direction,
    /// Half an angle: degrees in files and on screen, radians in [`LightKind`].
    Angle,
    /// m.
    Length,
}

/// A field of lights.
#[derive(Debug, PartialEq)]
pub(crate) struct Field {
    pub name: &'static str,
    /// Name in scene files.
    file: &'static str,
    pub quantity: Quantity,
    /// Allowed numbers in files and on screen.
    range: (f64, f64),
}

const fn vector(name: &'static str, quantity: Quantity) -> Field {
    number(name, name, quantity, (0.0, 0.0))
}

const fn number(
    name: &'static str,
    file: &'static str,
    quantity: Quantity,
    range: (f64, f64),
) -> Field {
    Field {
        name,
        file,
        quantity,
        range,
    }
}

const EXTENT: (f64, f64) = (1e-4, 1e6);

/// All fields but name and shadow; [`Light::vector`] and [`LightKind::number`] tell which kind has
/// which.
pub(crate) static FIELDS: [Field; 9] = [
    vector("color", Quantity::Color),
    vector("direction", Quantity::Direction),
    vector("position", Quantity::Position),
    vector("up", Quantity::Direction),
    number("inner", "inner_deg", Quantity::Angle, (0.0, 89.0)),
    number("outer", "outer_deg", Quantity::Angle, (1e-3, 89.0)),
    number("width", "width", Quantity::Length, EXTENT),
    number("height", "height", Quantity::Length, EXTENT),
    number("radius", "radius", Quantity::Length, EXTENT),
];

impl Field {
    /// Allowed numbers, in the unit of files.
    pub(crate) fn range(&self) -> std::ops::RangeInclusive<f64> {
        self.range.0..=self.range.1
    }

    /// Whether a number is allowed. Ends of the range stay allowed when they are rounded to 32 bits.
    fn allows(&self, x: f64) -> bool {
        (self.range.0 as f32..=self.range.1 as f32).contains(&(x as f32))
    }
}

impl Quantity {
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Angle => "deg",
            _ => "m",
        }
    }

    /// From the unit of files to that of [`LightKind`].
    fn stored(self, value: f64) -> f32 {
        match self {
            Quantity::Angle => value.to_radians() as f32,
            _ => value as f32,
        }
    }

    /// From the unit of [`LightKind`] to that of files.
    fn shown(self, value: f32) -> f64 {
        match self {
            Quantity::Angle => f64::from(value).to_degrees(),
            _ => f64::from(value),
        }
    }
}

impl LightKind {
    /// Its number in shaders.
    pub(crate) const fn index(self) -> usize {
        match self {
            LightKind::Directional => 0,
            LightKind::Point => 1,
            LightKind::Spot { .. } => 2,
            LightKind::Rectangle { .. } => 3,
            LightKind::Disc { .. } => 4,
        }
    }

    pub(crate) fn row(self) -> &'static Kind {
        &KINDS[self.index()]
    }

    /// The number of that name, if the kind has it.
    fn number(&mut self, name: &str) -> Option<&mut f32> {
        match (self, name) {
            (LightKind::Spot { inner, .. }, "inner") => Some(inner),
            (LightKind::Spot { outer, .. }, "outer") => Some(outer),
            (LightKind::Rectangle { width, .. }, "width") => Some(width),
            (LightKind::Rectangle { height, .. }, "height") => Some(height),
            (LightKind::Disc { radius }, "radius") => Some(radius),
            _ => None,
        }
    }

    /// Its numbers as they are stored; 0 for those it does not have.
    pub(crate) fn numbers(mut self) -> [f32; 2] {
        let mut own = FIELDS.iter().filter_map(|f| self.number(f.name).copied());
        [own.next().unwrap_or(0.0), own.next().unwrap_or(0.0)]
    }
}

impl Light {
    /// The vector of that name, if this kind of light has it.
    pub(crate) fn vector(&mut self, name: &str) -> Option<&mut Vec3> {
        match name {
            "color" => Some(&mut self.color),
            "position" if self.kind != LightKind::Directional => Some(&mut self.position),
            "direction" if self.kind != LightKind::Point => Some(&mut self.direction),
            "up" if matches!(self.kind, LightKind::Rectangle { .. }) => Some(&mut self.up),
            _ => None,
        }
    }

    /// Sets a number in the unit of files; false if this kind of light does not have it.
    pub(crate) fn set_number(&mut self, field: &Field, value: f64) -> bool {
        let number = self.kind.number(field.name);
        number.map(|n| *n = field.quantity.stored(value)).is_some()
    }

    /// Makes a spot's inner cone fit into its outer one.
    pub(crate) fn keep_in_order(&mut self) {
        if let LightKind::Spot { inner, outer } = &mut self.kind {
            *inner = inner.min(outer.next_down());
        }
    }

    /// All fields that this kind of light has.
    pub(crate) fn fields(&self) -> LightFields {
        let mut light = self.clone();
        let vectors = FIELDS
            .iter()
            .filter_map(|f| Some((f, *light.vector(f.name)?)))
            .collect();
        let numbers = FIELDS
            .iter()
            .filter_map(|f| Some((f, f.quantity.shown(*light.kind.number(f.name)?))))
            .collect();
        LightFields { vectors, numbers }
    }

    /// Moves it into another space. Its extent grows with the largest scale of the transform, as in
    /// EXT_lights_area.
    pub(crate) fn transform(&mut self, frame: &Mat4) {
        self.position = frame.transform_point3(self.position);
        for direction in [&mut self.direction, &mut self.up] {
            *direction = frame.transform_vector3(*direction).normalize_or(*direction);
        }
        let scale = scale_of(frame);
        for field in FIELDS.iter().filter(|f| f.quantity == Quantity::Length) {
            if let Some(extent) = self.kind.number(field.name) {
                *extent *= scale;
            }
        }
    }

    /// Whether files can hold its extents.
    pub(crate) fn has_sound_extents(&self) -> bool {
        let fields = self.fields();
        let mut numbers = fields.numbers().iter();
        numbers.all(|(f, x)| f.quantity != Quantity::Length || f.allows(*x))
    }

    /// Half the extents of a rectangle or disc: towards its side and its top.
    pub(crate) fn half_extents(&self) -> (Vec3, Vec3) {
        let (width, height) = match self.kind {
            LightKind::Rectangle { width, height } => (0.5 * width, 0.5 * height),
            LightKind::Disc { radius } => (radius, radius),
            _ => return (Vec3::ZERO, Vec3::ZERO),
        };
        let side = self.direction.cross(self.up);
        let side = if side.length() < 1e-4 * self.up.length() {
            self.direction.any_orthonormal_vector()
        } else {
            side.normalize()
        };
        (width * side, height * side.cross(self.direction))
    }
}

/// Largest scale of a transform.
fn scale_of(frame: &Mat4) -> f32 {
    let axes = [frame.x_axis, frame.y_axis, frame.z_axis];
    axes.map(|axis| axis.truncate().length())
        .into_iter()
        .fold(0.0, f32::max)
}

/// Fields of a light as files have them. In an experiment, those that are left out keep the scene's
/// value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightFields {
    vectors: Vec<(&'static Field, Vec3)>,
    /// Angles in degrees, lengths in metres.
    numbers: Vec<(&'static Field, f64)>,
}

impl LightFields {
    /// Direction of the height, of a kind that has one.
    pub(crate) fn up(&self) -> Option<Vec3> {
        self.vectors.iter().find(|v| v.0.name == "up").map(|v| v.1)
    }

    fn names(&self) -> impl Iterator<Item = &'static Field> {
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
        self
    }

    /// Whether all values are allowed, for any kind of light.
    pub(crate) fn check(&self) -> Result<(), String> {
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
        let vectors = self.vectors.iter().map(vector);
        let fields: Vec<String> = vectors.chain(self.numbers.iter().map(number)).collect();
        format!("({})", fields.join(", "))
    }
}

/// Names of the fields in experiments.
static IN_EXPERIMENTS: [&str; FIELDS.len()] = {
    let mut names = [""; FIELDS.len()];
    let mut i = 0;
    while i < FIELDS.len() {
        names[i] = FIELDS[i].name;
        i += 1;
    }
    names
};

/// Names of the fields in scene files, and the two of every light.
static IN_SCENES: [&str; FIELDS.len() + 2] = {
    let mut names = ["name"; FIELDS.len() + 2];
    let mut i = 0;
    while i < FIELDS.len() {
        names[i + 1] = FIELDS[i].file;
        i += 1;
    }
    names[FIELDS.len() + 1] = "shadow";
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
    shadow: Option<bool>,
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
                ("shadow", None) => read.shadow = Some(map.next_value()?),
                (_, None) => read.name = map.next_value()?,
            }
        }
        // In the order of the table, whatever that of the file: equal fields are then equal.
        let place = |field: &Field| FIELDS.iter().position(|f| f == field);
        read.fields.vectors.sort_by_key(|v| place(v.0));
        read.fields.numbers.sort_by_key(|n| place(n.0));
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
                let kind = KINDS
                    .iter()
                    .find(|kind| kind.name == name)
                    .ok_or_else(|| Error::unknown_variant(&name, &KIND_NAMES))?;
                let read = fields.struct_variant(&IN_SCENES, ReadFields { in_scene: true })?;
                light(kind, read)
            }
        }
        deserializer.deserialize_enum("Light", &KIND_NAMES, OfKind)
    }
}

fn light<E: Error>(kind: &Kind, read: Read) -> Result<Light, E> {
    let mut light = Light {
        name: read.name,
        kind: kind.template,
        shadow: read.shadow.ok_or_else(|| E::missing_field("shadow"))?,
        ..Light::default()
    };
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
