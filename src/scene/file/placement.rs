//! Transforms and keyframe animations of models and instances in a scene file.

use std::sync::Arc;

use glam::{Mat4, Quat, Vec3};
use serde::Deserialize;

use crate::scene::{Keyframe, MAX_COORDINATE, Track};

/// Scale, then rotation about x, y and z, then translation.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct TransformFields {
    translate: Vec3,
    rotate_deg: Vec3,
    scale: Vec3,
}

impl Default for TransformFields {
    fn default() -> Self {
        TransformFields {
            translate: Vec3::ZERO,
            rotate_deg: Vec3::ZERO,
            scale: Vec3::ONE,
        }
    }
}

/// Motion of the placed model: each keyframe rotates about the world's origin, then translates.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AnimationFields {
    keyframes: Vec<KeyframeFields>,
    #[serde(default)]
    repeat: bool,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyframeFields {
    /// Seconds.
    time: f32,
    #[serde(default)]
    translate: Vec3,
    #[serde(default)]
    rotate_deg: Vec3,
}

/// The matrix of a transform.
#[derive(Debug, Default, Deserialize)]
#[serde(try_from = "TransformFields")]
pub(super) struct Placed(pub Mat4);

impl TryFrom<TransformFields> for Placed {
    type Error = String;

    fn try_from(
        TransformFields {
            translate,
            rotate_deg,
            scale,
        }: TransformFields,
    ) -> Result<Self, String> {
        let far = |v: Vec3| v.abs().max_element() > MAX_COORDINATE;
        if !translate.is_finite()
            || !rotate_deg.is_finite()
            || !scale.is_finite()
            || scale.min_element() <= 0.0
        {
            return Err("a transform's numbers must be finite and its scale above 0".into());
        }
        if far(translate) || far(scale) || scale.min_element() < 1.0 / MAX_COORDINATE {
            return Err(format!(
                "a model can be moved {MAX_COORDINATE:e} m at most, and scaled by as much"
            ));
        }
        Ok(Placed(Mat4::from_scale_rotation_translation(
            scale,
            rotation(rotate_deg),
            translate,
        )))
    }
}

/// The motion of keyframes.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "AnimationFields")]
pub(super) struct Moves(pub Arc<Track>);

impl TryFrom<AnimationFields> for Moves {
    type Error = String;

    fn try_from(fields: AnimationFields) -> Result<Self, String> {
        let keys = &fields.keyframes;
        let finite = |key: &KeyframeFields| {
            key.time.is_finite()
                && key.translate.abs().max_element() <= MAX_COORDINATE
                && key.rotate_deg.abs().max_element() < 36_000.0
        };
        if keys.is_empty()
            || !keys.iter().all(finite)
            || !keys.is_sorted_by(|a, b| a.time < b.time)
            || keys[0].time < 0.0
        {
            return Err("an animation needs keyframes with finite numbers and times that rise from 0 or more".into());
        }
        let mut keyframes = Vec::new();
        for (i, key) in keys.iter().enumerate() {
            let before = if i == 0 { key } else { &keys[i - 1] };
            // Quaternions do not represent full turns; steps of at most 90 degrees preserve them.
            let turn = (key.rotate_deg - before.rotate_deg).abs().max_element();
            let steps = (turn / 90.0).ceil().max(1.0) as u32;
            for step in (1..=steps).skip(if i == 0 { steps as usize - 1 } else { 0 }) {
                let s = step as f32 / steps as f32;
                keyframes.push(Keyframe {
                    time: before.time + (key.time - before.time) * s,
                    translation: before.translate.lerp(key.translate, s),
                    rotation: rotation(before.rotate_deg.lerp(key.rotate_deg, s)),
                });
            }
        }
        Ok(Moves(Arc::new(Track::rigid(&keyframes, fields.repeat))))
    }
}

fn rotation(degrees: Vec3) -> Quat {
    let [x, y, z] = degrees.to_array().map(f32::to_radians);
    Quat::from_rotation_z(z) * Quat::from_rotation_y(y) * Quat::from_rotation_x(x)
}
