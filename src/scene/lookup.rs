//! How a material looks a texture up.

use glam::{Vec2, Vec4};

/// Wrap mode: how coordinates continue outside the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The picture repeats.
    #[default]
    Repeat,
    /// The colour of the edge continues.
    Clamp,
    /// The picture repeats, every other one mirrored.
    Mirror,
}

/// How a material samples a texture. Default: repeat, filtered, first set of coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Lookup {
    /// Wrap modes along u and v.
    pub wrap: [Wrap; 2],
    /// Nearest-neighbour magnification. Minification uses one filter for all textures.
    pub nearest: bool,
    /// Uses `uv_second` of the vertices instead of `uv`.
    pub second_set: bool,
}

/// Lookups of a material's textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lookups {
    /// Lookup of the base colour.
    pub base_color: Lookup,
    /// Lookup of roughness and metallic.
    pub metallic_roughness: Lookup,
    /// Lookup of the normal map.
    pub normal: Lookup,
    /// Lookup of the emission.
    pub emission: Lookup,
}

impl Lookup {
    /// Selects one of two sets of texture coordinates.
    pub fn set(&self, sets: Vec4) -> Vec2 {
        if self.second_set {
            Vec2::new(sets.z, sets.w)
        } else {
            Vec2::new(sets.x, sets.y)
        }
    }

    /// [`Lookup::set`], limited to 0..1 along axes that do not repeat.
    pub fn place(&self, sets: Vec4) -> Vec2 {
        let uv = self.set(sets);
        Vec2::new(self.wrap[0].fold(uv.x), self.wrap[1].fold(uv.y))
    }
}

impl Wrap {
    /// A mirrored or clamped coordinate, below 1 so that a repeating sampler does not start over.
    fn fold(self, t: f32) -> f32 {
        let inside = match self {
            Wrap::Repeat => return t,
            Wrap::Clamp => t,
            Wrap::Mirror => 1.0 - (1.0 - t.rem_euclid(2.0)).abs(),
        };
        inside.clamp(0.0, 1.0f32.next_down())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_fold_by_axis_and_set() {
        let lookup = Lookup {
            wrap: [Wrap::Clamp, Wrap::Mirror],
            second_set: true,
            nearest: false,
        };
        let near = |place: Vec2, u: f32, v: f32| {
            assert!(place.distance(Vec2::new(u, v)) < 1e-6, "{place}")
        };
        near(lookup.place(Vec4::new(9.0, 9.0, -0.5, 1.25)), 0.0, 0.75);
        near(lookup.place(Vec4::new(9.0, 9.0, 1.5, -0.25)), 1.0, 0.25);
        assert!(lookup.place(Vec4::new(0.0, 0.0, 3.0, 3.0)).max_element() < 1.0);
        assert_eq!(
            Lookup::default().place(Vec4::new(-1.5, 2.5, 0.0, 0.0)),
            Vec2::new(-1.5, 2.5)
        );
    }
}
