//! Cameras and shadow views as the shaders see them.

use super::interface::blocks::{CameraBlock, LightBlock, ShadowBlock};
use crate::experiment::PlacedCamera;
use crate::scene::light::Views;
use crate::scene::{Camera, Light, LightKind, Scene, defaults};
use glam::{Mat4, Vec3, camera::rh::proj::vulkan};

/// A camera with its view of the last frame.
#[derive(Clone, Debug)]
pub struct Viewpoint {
    /// The camera.
    pub camera: Camera,
    previous: Option<(Mat4, Vec3)>,
}

/// Counts frames of a session.
#[derive(Clone, Copy, Default)]
pub(super) struct FrameCounters {
    /// Frames before this one.
    pub frame: u32,
    /// Frames since anything but the camera changed.
    pub still: u32,
    /// Length of the last run of frames that each changed something but the camera.
    pub changing: u32,
}

impl FrameCounters {
    pub fn count(&mut self, changes: bool) {
        let goes_on = changes && self.still == 0;
        self.changing = match (changes, goes_on) {
            (true, true) => self.changing.saturating_add(1),
            (true, false) => 1,
            (false, _) => self.changing,
        };
        self.still = if changes {
            0
        } else {
            self.still.saturating_add(1)
        };
    }
}

impl Viewpoint {
    /// A camera of a scene.
    pub fn new(camera: &Camera) -> Viewpoint {
        Viewpoint {
            camera: *camera,
            previous: None,
        }
    }

    /// A camera written out in an experiment; a near plane that it leaves out is from the scene's
    /// size.
    pub fn placed(placed: &PlacedCamera, scene: &Scene) -> Viewpoint {
        Viewpoint::new(&camera(placed, scene.bounds()))
    }

    /// Another camera, in a scene of these bounds. The view of the last frame is kept.
    pub fn place_camera(&mut self, placed: &PlacedCamera, bounds: (Vec3, Vec3)) {
        self.camera = camera(placed, bounds);
    }

    /// A camera that sees the whole of a scene that has none.
    pub fn around(scene: &Scene) -> Viewpoint {
        let (low, high) = scene.bounds();
        let size = (high - low).length();
        let (centre, size) = ((low + high) * 0.5, if size > 0.0 { size } else { 1.0 });
        let eye = centre + Vec3::new(0.6, 0.4, 0.8) * size;
        Viewpoint::placed(&PlacedCamera::new(eye.into(), centre.into(), 50.0), scene)
    }

    /// The content of the block `camera` in a world that begins at `origin`, and on to the next
    /// frame.
    pub(super) fn uniform(
        &mut self,
        origin: Vec3,
        size: (u32, u32),
        time: f64,
        counters: FrameCounters,
        delta: f64,
    ) -> Vec<u8> {
        let c = &self.camera;
        let eye = c.eye - origin;
        let direction = (c.target - c.eye).try_normalize().unwrap_or(Vec3::NEG_Z);
        let side = direction.cross(c.up);
        let up = if side.length() < 1e-4 {
            direction.any_orthonormal_vector()
        } else {
            side.cross(direction).normalize()
        };
        let view = glam::camera::rh::view::look_to_mat4(eye, direction, up);
        let aspect = size.0 as f32 / size.1 as f32;
        let fov_y = c.fov_y.clamp(1.0, 170.0).to_radians();
        // Reversed depth: 1 at the near plane, 0 infinitely far away. Floats are as precise near 0
        // as it takes.
        let projection = vulkan::perspective_infinite_reverse(fov_y, aspect, c.near);
        let view_projection = projection * view;
        let previous = self
            .previous
            .replace((view_projection, eye))
            .unwrap_or((view_projection, eye));
        bytemuck::bytes_of(&CameraBlock {
            view: view.to_cols_array(),
            projection: projection.to_cols_array(),
            view_projection: view_projection.to_cols_array(),
            inverse_view_projection: (view.inverse() * projection.inverse()).to_cols_array(),
            previous_view_projection: previous.0.to_cols_array(),
            position: eye.to_array(),
            near: c.near,
            direction: direction.to_array(),
            far: c.far,
            up: up.to_array(),
            fov_y,
            previous_position: previous.1.to_array(),
            time: time as f32,
            size: [size.0, size.1],
            frame: counters.frame,
            still_frames: counters.still,
            changing_frames: counters.changing,
            delta_time: delta as f32,
        })
        .to_vec()
    }
}

/// A written-out camera in a scene of these bounds.
fn camera(placed: &PlacedCamera, (low, high): (Vec3, Vec3)) -> Camera {
    Camera {
        eye: placed.eye.into(),
        target: placed.target.into(),
        up: placed.up.into(),
        fov_y: placed.fov_y,
        near: placed
            .near
            .unwrap_or(defaults::near_plane((high - low).length())),
        far: placed.far.unwrap_or(f32::INFINITY),
    }
}

/// Lights of a scene with these bounds, and the views of their shadow maps. Lights after the first
/// `own` represent a part of the sky's picture. Lights and bounds are in the scene's world, results
/// in the world with the origin `origin`.
pub(super) fn lights(
    (lights, own): (&[Light], usize),
    (low, high): (Vec3, Vec3),
    origin: Vec3,
) -> (Vec<LightBlock>, Vec<ShadowBlock>) {
    let bounds = (low - origin, high - origin);
    let (mut blocks, mut views) = (Vec::new(), Vec::new());
    for (number, light) in (0u32..).zip(lights) {
        let light = &Light {
            position: light.position - origin,
            ..light.clone()
        };
        let first = i32::try_from(views.len()).unwrap_or(i32::MAX);
        let (inner, outer) = match light.kind {
            LightKind::Spot { inner, outer } => (inner, outer),
            _ => (0.0, 0.0),
        };
        let (side, top) = light.half_extents();
        if light.shadow {
            views.extend(shadow_views(light, bounds, number));
        }
        blocks.push(LightBlock {
            position: light.position.to_array(),
            kind: u32::try_from(light.kind.index()).unwrap_or(u32::MAX),
            direction: light.direction.to_array(),
            shadow_view: if light.shadow { first } else { -1 },
            color: light.emitted().to_array(),
            of_sky: u32::from(number as usize >= own),
            side: side.to_array(),
            cos_inner: inner.cos(),
            top: top.to_array(),
            cos_outer: outer.cos(),
        });
    }
    (blocks, views)
}

fn shadow_views(light: &Light, (low, high): (Vec3, Vec3), number: u32) -> Vec<ShadowBlock> {
    let corners: [Vec3; 8] = std::array::from_fn(|i| {
        Vec3::new(
            if i & 1 == 0 { low.x } else { high.x },
            if i & 2 == 0 { low.y } else { high.y },
            if i & 4 == 0 { low.z } else { high.z },
        )
    });
    let block = |matrix: Mat4, texel: [f32; 3]| ShadowBlock {
        view_projection: matrix.to_cols_array(),
        inverse_view_projection: matrix.inverse().to_cols_array(),
        texel_size_and_depth: texel,
        light: number,
    };
    let look = |eye: Vec3, direction: Vec3| {
        let direction = direction.try_normalize().unwrap_or(Vec3::NEG_Y);
        let up = if direction.y.abs() > 0.99 {
            Vec3::Z
        } else {
            Vec3::Y
        };
        glam::camera::rh::view::look_to_mat4(eye, direction, up)
    };
    // Two centimetres, less in scenes below four metres. Smaller ones would cost maps of 16 bits
    // their last digits.
    let near = (0.005 * (high - low).length()).clamp(1e-6, 0.02);
    let far = corners
        .iter()
        .map(|c| c.distance(light.position))
        .fold(2.0 * near, f32::max)
        * 1.01;
    match light.kind.row().views {
        Views::Parallel => {
            // Orthographic, fitted to the scene's bounds, so depth is linear and no texel is wasted
            // on the outside.
            let view = look((low + high) * 0.5, light.direction);
            let (mut least, mut most) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
            for corner in corners {
                let p = view.transform_point3(corner);
                (least, most) = (least.min(p), most.max(p));
            }
            let margin = 0.005 * (most - least).max_element().max(0.01);
            let (least, most) = (least - margin, most + margin);
            let projection =
                vulkan::orthographic(least.x, most.x, least.y, most.y, -most.z, -least.z);
            let size = most - least;
            vec![block(projection * view, [size.x.max(size.y), size.z, 0.0])]
        }
        Views::Cone => {
            let outer = light.kind.numbers()[1];
            let angle = (2.0 * outer).clamp(0.02, 2.9);
            let projection = vulkan::perspective(angle, 1.0, near, far);
            vec![block(
                projection * look(light.position, light.direction),
                [2.0 * (angle * 0.5).tan(), far, 1.0],
            )]
        }
        Views::Cube => [
            Vec3::X,
            Vec3::NEG_X,
            Vec3::Y,
            Vec3::NEG_Y,
            Vec3::Z,
            Vec3::NEG_Z,
        ]
        .into_iter()
        .map(|direction| {
            // A little more than 90 degrees, so that filtered lookups at the seams stay inside a
            // face.
            let angle = std::f32::consts::FRAC_PI_2 + 0.01;
            let matrix =
                vulkan::perspective(angle, 1.0, near, far) * look(light.position, direction);
            block(matrix, [2.0 * (angle * 0.5).tan(), far, 1.0])
        })
        .collect(),
    }
}

/// How many directional lights cast shadows.
pub fn directional_view_count(lights: &[Light]) -> u32 {
    let directional = |l: &&Light| l.shadow && l.kind == LightKind::Directional;
    lights.iter().filter(directional).map(|_| 1).sum()
}

/// How many shadow maps a scene needs: one a directional or spot light, six any other.
pub fn shadow_view_count(lights: &[Light]) -> u32 {
    let views = |l: &Light| match l.kind.row().views {
        Views::Parallel | Views::Cone => 1,
        Views::Cube => 6,
    };
    lights.iter().filter(|l| l.shadow).map(views).sum()
}

/// How many lights have an extent.
pub fn area_light_count(lights: &[Light]) -> u32 {
    let is_area = |l: &&Light| l.half_extents().0 != Vec3::ZERO;
    lights.iter().filter(is_area).map(|_| 1).sum()
}
