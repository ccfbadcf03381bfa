//! A clear sky after the CIE standard general sky (ISO 15469:2004, CIE S 011), for scenes without a
//! file.

use super::{Environment, Level, SkyPicture, direction};
use glam::Vec3;
use serde::Deserialize;

/// Gradation and indicatrix of sky type 12, "CIE standard clear sky, low luminance turbidity".
const A: f32 = -1.0;
const B: f32 = -0.32;
const C: f32 = 10.0;
const D: f32 = -3.0;
const E: f32 = 0.45;

/// Angular radius of the sun's disc (degrees).
const SUN_RADIUS: f32 = 0.265;

/// Samples per side of a texel that the sun's edge may cross.
const SUN_SAMPLES: u32 = 16;

/// A clear sky over ground.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ClearSky {
    /// Texels per row.
    width: u32,
    /// Direction to the sun.
    sun: Vec3,
    /// Irradiance from the sun on a surface that faces it.
    irradiance: Vec3,
    /// Radiance at the zenith.
    zenith: Vec3,
    /// Radiance of the ground.
    ground: Vec3,
}

/// Renders a clear sky to an environment map.
pub(in crate::scene) fn clear_sky(sky: &ClearSky) -> Result<Environment, String> {
    let &ClearSky {
        width,
        sun,
        irradiance,
        zenith,
        ground,
    } = sky;
    let radiance = |c: Vec3| c.min_element() >= 0.0 && c.max_element() <= 1e12;
    if !(16..=4096).contains(&width)
        || sun.try_normalize().is_none()
        || ![irradiance, zenith, ground].into_iter().all(radiance)
    {
        return Err(
            "a clear_sky needs a width of 16 to 4096, a sun that is a direction, and radiances of 0 or more".into()
        );
    }
    let height = width / 2;
    let sun = sun.normalize();
    let place = |at: f32, of: u32| at / of as f32;
    let sky = |d: Vec3| {
        if d.y < 0.0 {
            return ground;
        }
        // Paler where the air mass is larger.
        let pale = (1.0 - d.y).powi(3);
        let colour = zenith.lerp(
            Vec3::splat(zenith.dot(Vec3::new(0.2126, 0.7152, 0.0722))),
            0.7 * pale,
        );
        colour * relative_luminance(d, sun)
    };
    let texel = |i: u32| {
        let (x, y) = ((i % width) as f32, (i / width) as f32);
        sky(direction(place(x + 0.5, width), place(y + 0.5, height))).to_array()
    };
    let mut level = Level {
        width,
        height,
        texels: (0..width * height).map(texel).collect(),
    };
    add_sun(&mut level, sun, irradiance);
    Ok(Environment::of(SkyPicture::new(level)))
}

/// Luminance in direction `d` relative to the zenith: gradation from zenith to horizon times the
/// indicatrix around the sun.
fn relative_luminance(d: Vec3, sun: Vec3) -> f32 {
    let gradation = |cosine: f32| 1.0 + A * (B / cosine.max(0.01)).exp();
    let indicatrix = |angle: f32| {
        1.0 + C * ((D * angle).exp() - (D * std::f32::consts::FRAC_PI_2).exp())
            + E * angle.cos().powi(2)
    };
    let to_sun = d.dot(sun).clamp(-1.0, 1.0).acos();
    indicatrix(to_sun) * gradation(d.y)
        / (indicatrix(sun.y.clamp(-1.0, 1.0).acos()) * gradation(1.0))
}

/// Adds the sun's disc: texels are weighted by coverage and scaled to the given irradiance.
fn add_sun(level: &mut Level, sun: Vec3, irradiance: Vec3) {
    let cosine = SUN_RADIUS.to_radians().cos();
    let near = (SUN_RADIUS + 360.0 / level.width as f32).to_radians().cos();
    let mut covered: Vec<(usize, f64)> = Vec::new();
    for i in 0..level.width * level.height {
        let (x, y) = (i % level.width, i / level.width);
        let at = |x: f32, y: f32| direction(x / level.width as f32, y / level.height as f32);
        if at(x as f32 + 0.5, y as f32 + 0.5).dot(sun) < near {
            continue;
        }
        let part = |n: u32| (n as f32 + 0.5) / SUN_SAMPLES as f32;
        let samples =
            (0..SUN_SAMPLES * SUN_SAMPLES).map(|n| (part(n % SUN_SAMPLES), part(n / SUN_SAMPLES)));
        let inside = samples
            .filter(|(dx, dy)| at(x as f32 + dx, y as f32 + dy).dot(sun) > cosine)
            .count();
        if inside > 0 {
            covered.push((
                i as usize,
                inside as f64 / f64::from(SUN_SAMPLES * SUN_SAMPLES),
            ));
        }
    }
    let size: f64 = covered
        .iter()
        .map(|(i, share)| share * level.solid_angle(*i as u32 / level.width))
        .sum();
    for (i, share) in covered {
        let radiance = irradiance
            .to_array()
            .map(|e| (f64::from(e) * share / size) as f32);
        level.texels[i]
            .iter_mut()
            .zip(radiance)
            .for_each(|(t, r)| *t += r);
    }
}
