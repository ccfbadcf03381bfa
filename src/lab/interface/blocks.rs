//! The structs of the scene's resources as the program fills them. Shaders that declare one
//! differently are refused.

use crate::shader::Layout;
use crate::shader::layout::{Member, Scalar};
use bytemuck::{Pod, Zeroable};
use std::mem::offset_of;

/// A Rust type that stands for one of GLSL's.
trait Glsl {
    const LAYOUT: Layout;
}

macro_rules! glsl {
    ($($ty:ty: $layout:expr;)*) => {
        $(impl Glsl for $ty {
            const LAYOUT: Layout = $layout;
        })*
    };
}

glsl! {
    f32: Layout::Scalar(Scalar::Float);
    u32: Layout::Scalar(Scalar::Uint);
    i32: Layout::Scalar(Scalar::Int);
    [f32; 2]: Layout::Vector(Scalar::Float, 2);
    [f32; 3]: Layout::Vector(Scalar::Float, 3);
    [f32; 4]: Layout::Vector(Scalar::Float, 4);
    [f32; 16]: Layout::Matrix { columns: 4, rows: 4, stride: 16 };
    [u32; 2]: Layout::Vector(Scalar::Uint, 2);
}

/// Defines a struct and the layout of its fields.
macro_rules! block {
    ($(#[$about:meta])* $name:ident { $($field:ident: $ty:ty,)* }) => {
        $(#[$about])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Pod, Zeroable, PartialEq)]
        pub struct $name {
            $(pub $field: $ty,)*
        }

        impl $name {
            /// Its members and bytes.
            pub fn layout() -> (Vec<Member>, usize) {
                let member = |name: &str, offset: usize, layout: Layout| Member {
                    name: name.into(),
                    offset: u32::try_from(offset).unwrap_or(u32::MAX),
                    layout,
                };
                let members = vec![
                    $(member(stringify!($field), offset_of!($name, $field), <$ty as Glsl>::LAYOUT),)*
                ];
                (members, size_of::<$name>())
            }
        }
    };
}

block! {
    /// The uniform block `camera` (std140).
    CameraBlock {
        view: [f32; 16],
        projection: [f32; 16],
        view_projection: [f32; 16],
        inverse_view_projection: [f32; 16],
        previous_view_projection: [f32; 16],
        position: [f32; 3],
        near: f32,
        direction: [f32; 3],
        far: f32,
        up: [f32; 3],
        fov_y: f32,
        previous_position: [f32; 3],
        time: f32,
        size: [u32; 2],
        frame: u32,
        still_frames: u32,
        changing_frames: u32,
        delta_time: f32,
    }
}

block! {
    /// The uniform block `sceneInfo` (std140).
    SceneInfoBlock {
        bounds_min: [f32; 3],
        light_count: u32,
        bounds_max: [f32; 3],
        shadow_views: u32,
        sky: [f32; 3],
        triangle_count: u32,
        draw_count: u32,
        vertex_count: u32,
        instance_count: u32,
        sky_turn: f32,
        still_triangles: u32,
    }
}

block! {
    /// An element of `lights` (std430).
    LightBlock {
        position: [f32; 3],
        kind: u32,
        direction: [f32; 3],
        shadow_view: i32,
        color: [f32; 3],
        of_sky: u32,
        side: [f32; 3],
        cos_inner: f32,
        top: [f32; 3],
        cos_outer: f32,
    }
}

block! {
    /// A shadow map's view, an element of `shadowViews` (std430).
    ShadowBlock {
        view_projection: [f32; 16],
        inverse_view_projection: [f32; 16],
        texel_size_and_depth: [f32; 3],
        light: u32,
    }
}

block! {
    /// An element of `materials` (std430).
    MaterialBlock {
        base_color: [f32; 4],
        emission: [f32; 3],
        metallic: f32,
        roughness: f32,
        alpha_cutoff: f32,
        normal_scale: f32,
        flags: u32,
        base_color_texture: u32,
        metallic_roughness_texture: u32,
        normal_texture: u32,
        emission_texture: u32,
    }
}

block! {
    /// An element of `emitters`, behind its head of 16 bytes (std430).
    EmitterBlock {
        a: [f32; 3],
        chance: f32,
        to_b: [f32; 3],
        other: u32,
        to_c: [f32; 3],
        sides: u32,
        radiance: [f32; 3],
        density: f32,
    }
}

block! {
    /// An element of `instances` (std430).
    InstanceBlock {
        model: [f32; 16],
        previous_model: [f32; 16],
        normal_matrix: [f32; 16],
    }
}

block! {
    /// An element of `draws` (std430).
    DrawBlock {
        instance: u32,
        material: u32,
        first_index: u32,
        index_count: u32,
    }
}
