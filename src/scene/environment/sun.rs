//! Extraction of the sun from an environment map. Sampled rays would hit its small disc only by
//! chance, which gives noise and no sharp shadows. Methods therefore get the sun as a directional
//! light and the map without it.

use super::{Level, direction};
use crate::metrics::colour::luminance;
use glam::{DVec3, Vec3};

/// Texels of a sun are brighter than this multiple of the mean over all directions,
const TIMES_MEAN: f64 = 50.0;
/// within this angle of the brightest texel (degrees),
const WITHIN: f64 = 5.0;
/// and together at least this share of all light.
const SHARE: f64 = 0.02;
/// The surroundings are averaged out to this angle (degrees).
const AROUND: f64 = 7.5;

/// A compact peak of an environment map.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sun {
    /// Unit vector to its centre, in the frame of the map.
    pub direction: Vec3,
    /// Irradiance on a surface that faces it, above the surroundings.
    pub irradiance: Vec3,
    /// Mean radiance around it.
    pub surroundings: Vec3,
    /// Its texels, in ascending order.
    pub texels: Vec<u32>,
}

impl Sun {
    /// The map without the sun.
    pub fn removed(&self, level: &Level) -> Level {
        let mut without = level.clone();
        for texel in &self.texels {
            without.texels[*texel as usize] = self.surroundings.to_array();
        }
        without
    }
}

/// The sun of a map, if it has one.
pub(super) fn find(level: &Level) -> Option<Sun> {
    let width = level.width as usize;
    let sizes = (0..level.height).map(|row| level.solid_angle(row));
    let sizes: Vec<f64> = sizes.collect();
    let bright: Vec<f64> = level.texels.iter().map(|t| luminance(*t)).collect();
    let weighted = |(i, l): (usize, &f64)| l * sizes[i / width];
    let all: f64 = bright.iter().enumerate().map(weighted).sum();
    let limit = TIMES_MEAN * all / (4.0 * std::f64::consts::PI);
    let numbered = bright.iter().enumerate();
    let (brightest, most) = numbered.max_by(|a, b| a.1.total_cmp(b.1))?;
    if *most <= limit {
        return None;
    }
    let to = |i: usize| {
        let place = |at: usize, of: u32| (at as f32 + 0.5) / of as f32;
        let (x, y) = (
            place(i % width, level.width),
            place(i / width, level.height),
        );
        direction(x, y).as_dvec3()
    };
    let axis = to(brightest);
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let (inner, outer) = (cosine(WITHIN), cosine(AROUND));
    let (mut texels, mut around, mut size_around) = (Vec::new(), DVec3::ZERO, 0.0);
    for (i, l) in bright.iter().enumerate() {
        let size = sizes[i / width];
        let near = to(i).dot(axis);
        if near >= inner && *l > limit {
            texels.push(i as u32);
        } else if near < inner && near >= outer {
            around += DVec3::from_array(level.texels[i].map(f64::from)) * size;
            size_around += size;
        }
    }
    let surroundings = match size_around > 0.0 {
        true => around / size_around,
        false => DVec3::ZERO,
    };
    let (mut irradiance, mut middle) = (DVec3::ZERO, DVec3::ZERO);
    for i in texels.iter().map(|i| *i as usize) {
        let above = (DVec3::from_array(level.texels[i].map(f64::from)) - surroundings)
            .max(DVec3::ZERO)
            * sizes[i / width];
        irradiance += above;
        middle += luminance(above.as_vec3().to_array()) * to(i);
    }
    let own = luminance(irradiance.as_vec3().to_array());
    // A peak with equally bright surroundings is a part of something large, not a disc.
    let compact = luminance(surroundings.as_vec3().to_array()) < limit;
    let sun = Sun {
        direction: middle.try_normalize()?.as_vec3(),
        irradiance: irradiance.as_vec3(),
        surroundings: surroundings.as_vec3(),
        texels,
    };
    (compact && own > SHARE * all && irradiance.is_finite()).then_some(sun)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(radiance: impl Fn(Vec3) -> f32) -> Level {
        let (width, height) = (512, 256);
        let texel = |i: u32| {
            let place = |at: u32, of: u32| (at as f32 + 0.5) / of as f32;
            [radiance(direction(place(i % width, width), place(i / width, height))); 3]
        };
        Level {
            width,
            height,
            texels: (0..width * height).map(texel).collect(),
        }
    }

    fn disc(to: Vec3, degrees: f32, radiance: f32) -> impl Fn(Vec3) -> f32 {
        move |d| {
            if d.dot(to) > degrees.to_radians().cos() {
                radiance
            } else {
                1.0
            }
        }
    }

    #[test]
    fn a_small_bright_disc_is_a_sun_and_others_are_not() {
        let to = Vec3::new(0.3, 0.6, 0.5).normalize();
        let level = picture(disc(to, 1.0, 20_000.0));
        let sun = find(&level).unwrap();
        let expected = 19_999.0 * std::f32::consts::TAU * (1.0 - 1f32.to_radians().cos());
        assert!(
            sun.direction.dot(to) > 0.25f32.to_radians().cos(),
            "{}",
            sun.direction
        );
        assert!(
            (sun.irradiance.x / expected - 1.0).abs() < 0.1,
            "{} {expected}",
            sun.irradiance
        );
        assert!(
            (sun.surroundings.x - 1.0).abs() < 1e-4,
            "{}",
            sun.surroundings
        );
        assert!(
            sun.removed(&level)
                .texels
                .iter()
                .all(|t| (t[0] - 1.0).abs() < 1e-4)
        );
        // Too weak, too small a share, and too large.
        for level in [
            picture(disc(to, 1.0, 30.0)),
            picture(disc(to, 0.5, 100.0)),
            picture(disc(to, 20.0, 1e5)),
        ] {
            assert!(find(&level).is_none());
        }
        assert!(find(&picture(|_| 0.0)).is_none());
    }
}
