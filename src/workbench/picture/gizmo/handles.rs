//! The handles of a light: their places, and the effect of a drag.

use super::screen::Screen;
use crate::scene::Light;
use crate::scene::LightKind;
use crate::scene::light::FIELDS;
use egui::Pos2;
use glam::Vec3;

/// Length of the axes on the screen, points.
const AXIS: f32 = 70.0;
/// Length of the arrow of a direction, points.
const ARROW: f32 = 110.0;

/// A handle, by the property that it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Handle {
    /// The position, parallel to the screen.
    Centre,
    /// The position along an axis of the world.
    Axis(usize),
    Direction,
    /// A length of the kind: its name, 0 for the light's side or 1 for its top, and its ratio to the
    /// distance of the handle from the centre.
    Extent(&'static str, usize, f32),
}

pub(super) const AXES: [(&str, Vec3); 3] = [("x", Vec3::X), ("y", Vec3::Y), ("z", Vec3::Z)];

/// The place of a light: `middle` for one without a position.
pub(super) fn centre(light: &Light, middle: Vec3) -> Vec3 {
    match light.clone().vector("position") {
        Some(position) => *position,
        None => middle,
    }
}

/// The handles of a light.
pub(super) fn handles(light: &Light) -> Vec<Handle> {
    let mut list = Vec::new();
    if light.clone().vector("position").is_some() {
        list.extend((0..AXES.len()).map(Handle::Axis));
    }
    if light.clone().vector("direction").is_some() {
        list.push(Handle::Direction);
    }
    match light.kind {
        LightKind::Rectangle { .. } => list.extend([
            Handle::Extent("width", 0, 2.0),
            Handle::Extent("height", 1, 2.0),
        ]),
        LightKind::Disc { .. } => list.push(Handle::Extent("radius", 0, 1.0)),
        _ => {}
    }
    list.push(Handle::Centre);
    list
}

impl Handle {
    pub fn name(self) -> String {
        match self {
            Handle::Centre => "move".into(),
            Handle::Axis(i) => format!("move along {}", AXES[i].0),
            Handle::Direction => "turn".into(),
            Handle::Extent(name, ..) => name.into(),
        }
    }

    /// Where it is in the world.
    pub fn place(self, light: &Light, screen: &Screen, centre: Vec3) -> Vec3 {
        let scale = screen.metres(centre);
        match self {
            Handle::Centre => centre,
            Handle::Axis(i) => centre + AXIS * scale * AXES[i].1,
            Handle::Direction => centre + ARROW * scale * light.direction,
            Handle::Extent(_, i, _) => centre + extent(light, i),
        }
    }

    /// The light after a drag from one point of the screen to another.
    pub fn dragged(
        self,
        start: &Light,
        screen: &Screen,
        middle: Vec3,
        (from, to): (Pos2, Pos2),
    ) -> Option<Light> {
        let (mut light, centre) = (start.clone(), centre(start, middle));
        match self {
            Handle::Centre => {
                let way = screen.in_plane(to, centre) - screen.in_plane(from, centre);
                *light.vector("position")? += way;
            }
            Handle::Axis(i) => {
                let axis = AXES[i].1;
                let way = screen.along(to, centre, axis)? - screen.along(from, centre, axis)?;
                light.position += way * axis;
            }
            Handle::Direction => {
                let radius = ARROW * screen.metres(centre);
                let behind = start.direction.dot(centre - screen.eye) > 0.0;
                light.direction = screen.on_sphere(to, centre, radius, behind);
            }
            Handle::Extent(name, i, times) => {
                let axis = extent(start, i).normalize();
                let field = FIELDS.iter().find(|f| f.name == name)?;
                let number = f64::from((times * screen.along(to, centre, axis)?).abs());
                let (least, most) = field.range().into_inner();
                light.set_number(field, number.clamp(least, most));
            }
        }
        Some(light)
    }
}

/// Half the extent of an area light, towards its side or its top.
fn extent(light: &Light, i: usize) -> Vec3 {
    let (side, top) = light.half_extents();
    [side, top][i]
}

/// Outline of a light in the world: the edge of an area, the rim of a cone.
pub(super) fn outline(light: &Light, screen: &Screen, centre: Vec3) -> Vec<Vec3> {
    let (side, top) = light.half_extents();
    let circle = |centre: Vec3, side: Vec3, top: Vec3| {
        let angles = (0..=32_u8).map(|i| std::f32::consts::TAU * f32::from(i) / 32.0);
        angles
            .map(|a| centre + a.cos() * side + a.sin() * top)
            .collect()
    };
    match light.kind {
        LightKind::Rectangle { .. } => [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
            .into_iter()
            .chain([(1.0, 1.0)])
            .map(|(a, b)| centre + a * side + b * top)
            .collect(),
        LightKind::Disc { .. } => circle(centre, side, top),
        LightKind::Spot { outer, .. } => {
            let length = ARROW * screen.metres(centre);
            let side = light.direction.any_orthonormal_vector();
            let (along, across) = (length * outer.cos(), length * outer.sin());
            let top = side.cross(light.direction);
            circle(
                centre + along * light.direction,
                across * side,
                across * top,
            )
        }
        _ => Vec::new(),
    }
}
