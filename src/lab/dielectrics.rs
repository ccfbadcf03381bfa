//! Reflectance of the scene's dielectrics, each kind once. Most scenes have one.

use crate::scene::Material;
use glam::Vec4;

/// As many as the G-buffer can number (`shaders/gbuffer/packing.glsl`).
const MOST: usize = 64;

/// Reflectances at normal incidence and, in w, at grazing angles. The first is the default.
pub(super) struct Dielectrics {
    pub list: Vec<Vec4>,
}

impl Dielectrics {
    pub fn of(materials: &[Material]) -> Dielectrics {
        let mut list = vec![Material::default().dielectric()];
        for found in materials.iter().map(Material::dielectric) {
            if list.len() < MOST && !list.contains(&found) {
                list.push(found);
            }
        }
        Dielectrics { list }
    }

    /// The number of the kind that is the nearest.
    pub fn number(&self, material: &Material) -> u32 {
        let wanted = material.dielectric();
        let far = |a: &Vec4| a.distance_squared(wanted);
        let nearest = (0u32..)
            .zip(&self.list)
            .min_by(|a, b| far(a.1).total_cmp(&far(b.1)));
        nearest.map_or(0, |n| n.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_numbered_once_and_the_rest_take_the_nearest() {
        let of = |ior: f32| Material {
            ior,
            ..Material::default()
        };
        let few = [of(1.5), of(2.0), of(1.5), of(2.0), of(1.33)];
        let dielectrics = Dielectrics::of(&few);
        assert_eq!(
            few.each_ref().map(|m| dielectrics.number(m)),
            [0, 1, 0, 1, 2]
        );
        let many: Vec<Material> = (0..200).map(|i| of(1.0 + 0.01 * i as f32)).collect();
        let dielectrics = Dielectrics::of(&many);
        assert_eq!(dielectrics.list.len(), MOST);
        let last = dielectrics.number(&many[199]) as usize;
        assert!(
            dielectrics
                .list
                .iter()
                .all(|d| d.x <= dielectrics.list[last].x),
            "the brightest is the nearest"
        );
    }
}
