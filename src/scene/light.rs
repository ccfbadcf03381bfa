//! Lights: the kinds that there are and, in one table, the fields of each. Scene files,
//! experiments, the window, summaries and hashes follow from them.

mod change;
mod read;

use glam::{Mat4, Vec3};

use change::Edit;
pub use change::LightFields;

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
    /// Whether it emits. A light that is off keeps its shadow map and its colour.
    pub on: bool,
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
            on: true,
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
#[derive(Debug, PartialEq)]
pub(crate) struct Kind {
    /// Name in scene files; in lower case everywhere else.
    pub name: &'static str,
    /// The kind with the numbers of a new light. Scene files replace all of them.
    pub template: LightKind,
    /// Quantity of the colour, and its unit.
    pub color: &'static str,
    pub unit: &'static str,
    pub views: Views,
}

const fn kind(
    name: &'static str,
    template: LightKind,
    (color, unit): (&'static str, &'static str),
    views: Views,
) -> Kind {
    Kind {
        name,
        template,
        color,
        unit,
        views,
    }
}

pub(crate) static KINDS: [Kind; 5] = [
    kind(
        "Directional",
        LightKind::Directional,
        ("irradiance", "W/m²"),
        Views::Parallel,
    ),
    kind(
        "Point",
        LightKind::Point,
        ("intensity", "W/sr"),
        Views::Cube,
    ),
    kind(
        "Spot",
        LightKind::Spot {
            inner: 20_f32.to_radians(),
            outer: 35_f32.to_radians(),
        },
        ("intensity", "W/sr"),
        Views::Cone,
    ),
    kind(
        "Rectangle",
        LightKind::Rectangle {
            width: 1.0,
            height: 1.0,
        },
        ("radiance", "W/(m² sr)"),
        Views::Cube,
    ),
    kind(
        "Disc",
        LightKind::Disc { radius: 0.5 },
        ("radiance", "W/(m² sr)"),
        Views::Cube,
    ),
];

/// Switches of every light.
pub(crate) const FLAGS: [&str; 2] = ["on", "shadow"];

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
    /// A new light of a kind.
    pub(crate) fn new(kind: &Kind, name: &str) -> Light {
        Light {
            name: name.into(),
            kind: kind.template,
            ..Light::default()
        }
    }

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

    /// The switch of that name, one of [`FLAGS`].
    pub(crate) fn flag(&mut self, name: &str) -> Option<&mut bool> {
        match name {
            "on" => Some(&mut self.on),
            "shadow" => Some(&mut self.shadow),
            _ => None,
        }
    }

    /// Emitted colour: black if the light is off.
    pub(crate) fn emitted(&self) -> Vec3 {
        if self.on { self.color } else { Vec3::ZERO }
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
        let flags = FLAGS
            .iter()
            .filter_map(|name| Some((*name, *light.flag(name)?)))
            .collect();
        LightFields {
            edit: None,
            vectors,
            numbers,
            flags,
        }
    }

    /// The change that adds this light to a scene without it.
    pub(crate) fn addition(&self) -> LightFields {
        LightFields {
            edit: Some(Edit::Add(self.kind.row())),
            ..self.fields()
        }
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
