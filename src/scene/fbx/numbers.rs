//! Conversion of ufbx vectors and transforms.

use glam::{DAffine3, DMat3, DQuat, DVec3, Mat4, Vec3};
use ufbx::{Matrix, Transform};

/// A 3x4 matrix.
pub(super) fn affine(m: &Matrix) -> DAffine3 {
    DAffine3 {
        matrix3: DMat3::from_cols(
            DVec3::new(m.m00, m.m10, m.m20),
            DVec3::new(m.m01, m.m11, m.m21),
            DVec3::new(m.m02, m.m12, m.m22),
        ),
        translation: DVec3::new(m.m03, m.m13, m.m23),
    }
}

/// Scale, then rotation, then translation.
pub(super) fn placed(translation: ufbx::Vec3, rotation: ufbx::Quat, scale: ufbx::Vec3) -> DAffine3 {
    let rotation = DQuat::from_xyzw(rotation.x, rotation.y, rotation.z, rotation.w);
    DAffine3::from_scale_rotation_translation(
        vector(scale),
        // A quaternion of zero length becomes the identity.
        if rotation.is_finite() && rotation.length_squared() > 0.0 {
            rotation.normalize()
        } else {
            DQuat::IDENTITY
        },
        vector(translation),
    )
}

/// The local transform of a node.
pub(super) fn frame(t: &Transform) -> DAffine3 {
    placed(t.translation, t.rotation, t.scale)
}

pub(super) fn vector(v: ufbx::Vec3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// A transform in single precision.
pub(super) fn placement(m: &DAffine3) -> Mat4 {
    glam::DMat4::from(*m).as_mat4()
}

/// A finite, non-negative colour.
pub(super) fn color(v: DVec3) -> Option<Vec3> {
    Some(v.as_vec3())
        .filter(|v| v.is_finite())
        .map(|v| v.max(Vec3::ZERO))
}
