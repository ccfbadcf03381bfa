//! Cameras and shadow views as the shaders see them.

use crate::experiment::PlacedCamera;
use crate::graph::host::{CameraBlock, LightBlock, ShadowBlock};
use crate::scene::{Camera, Light, LightKind, Scene};
use glam::{Mat4, Vec3};

/// A camera with what it saw in the frame before.
#[derive(Clone, Debug)]
pub struct Viewpoint {
    /// The camera.
    pub camera: Camera,
    previous: Option<(Mat4, Vec3)>,
}

impl Viewpoint {
    /// A camera of a scene.
    pub fn new(camera: &Camera) -> Viewpoint {
        Viewpoint { camera: *camera, previous: None }
    }

    /// A camera written out in an experiment; what it leaves out of near and far is from the scene's size.
    pub fn placed(placed: &PlacedCamera, scene: &Scene) -> Viewpoint {
        Viewpoint::new(&camera(placed, scene.bounds()))
    }

    /// Another camera, in a scene of these bounds; what was seen in the frame before stays known.
    pub fn place_camera(&mut self, placed: &PlacedCamera, bounds: (Vec3, Vec3)) {
        self.camera = camera(placed, bounds);
    }

    /// A camera that sees the whole of a scene that has none.
    pub fn around(scene: &Scene) -> Viewpoint {
        let (low, high) = scene.bounds();
        let (centre, size) = ((low + high) * 0.5, (high - low).length().max(1.0));
        let eye = centre + Vec3::new(0.6, 0.4, 0.8) * size;
        Viewpoint::placed(&PlacedCamera::new(eye.into(), centre.into(), 50.0), scene)
    }

    /// The content of the block `camera`, and on to the next frame.
    pub fn uniform(&mut self, size: (u32, u32), time: f64, frame: u32, delta: f64) -> Vec<u8> {
        let c = &self.camera;
        let direction = (c.target - c.eye).try_normalize().unwrap_or(Vec3::NEG_Z);
        let side = direction.cross(c.up);
        let up =
            if side.length() < 1e-4 { direction.any_orthonormal_vector() } else { side.cross(direction).normalize() };
        let view = glam::camera::rh::view::look_to_mat4(c.eye, direction, up);
        let aspect = size.0 as f32 / size.1 as f32;
        let fov_y = c.fov_y.clamp(1.0, 170.0).to_radians();
        let projection = perspective(fov_y, aspect, c.near, c.far);
        let view_projection = projection * view;
        let previous = self.previous.replace((view_projection, c.eye)).unwrap_or((view_projection, c.eye));
        bytemuck::bytes_of(&CameraBlock {
            view: view.to_cols_array(),
            projection: projection.to_cols_array(),
            view_projection: view_projection.to_cols_array(),
            inverse_view_projection: view_projection.inverse().to_cols_array(),
            previous_view_projection: previous.0.to_cols_array(),
            position: c.eye.to_array(),
            near: c.near,
            direction: direction.to_array(),
            far: c.far,
            up: up.to_array(),
            fov_y,
            previous_position: previous.1.to_array(),
            time: time as f32,
            size: [size.0, size.1],
            frame,
            delta_time: delta as f32,
        })
        .to_vec()
    }
}

/// A written-out camera in a scene of these bounds.
fn camera(placed: &PlacedCamera, (low, high): (Vec3, Vec3)) -> Camera {
    let diagonal = (high - low).length().max(1.0);
    let eye = Vec3::from(placed.eye);
    Camera {
        eye,
        target: placed.target.into(),
        up: placed.up.into(),
        fov_y: placed.fov_y,
        near: placed.near.unwrap_or((0.001 * diagonal).max(0.01)),
        far: placed.far.unwrap_or(eye.distance((low + high) * 0.5) + diagonal),
    }
}

/// Vulkan's clip space: y down, depth 0 at the near plane and 1 at the far one.
fn perspective(fov_y: f32, aspect: f32, near: f32, far: f32) -> Mat4 {
    let near = near.max(1e-4);
    glam::camera::rh::proj::vulkan::perspective(fov_y, aspect, near, far.max(near * 1.001))
}

/// Lights of a scene with these bounds, and the views of their shadow maps.
pub(super) fn lights(lights: &[Light], bounds: (Vec3, Vec3)) -> (Vec<LightBlock>, Vec<ShadowBlock>) {
    let (mut blocks, mut views) = (Vec::new(), Vec::new());
    for (number, light) in (0u32..).zip(lights) {
        let first = i32::try_from(views.len()).unwrap_or(i32::MAX);
        let (kind, inner, outer) = match light.kind {
            LightKind::Directional => (0, 0.0, 0.0),
            LightKind::Point => (1, 0.0, 0.0),
            LightKind::Spot { inner, outer } => (2, inner, outer),
        };
        if light.shadow {
            views.extend(shadow_views(light, bounds, number));
        }
        blocks.push(LightBlock {
            position: light.position.to_array(),
            kind,
            direction: light.direction.to_array(),
            shadow_view: if light.shadow { first } else { -1 },
            color: light.color.to_array(),
            range: 0.0,
            cos_inner: inner.cos(),
            cos_outer: outer.cos(),
            pad0: 0.0,
            pad1: 0.0,
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
        let up = if direction.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y };
        glam::camera::rh::view::look_to_mat4(eye, direction, up)
    };
    let far = || corners.iter().map(|c| c.distance(light.position)).fold(0.1, f32::max) * 1.01;
    match light.kind {
        LightKind::Directional => {
            // Orthographic, fitted to the scene's bounds, so depth is linear and no texel is wasted on the outside.
            let view = look((low + high) * 0.5, light.direction);
            let (mut least, mut most) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
            for corner in corners {
                let p = view.transform_point3(corner);
                (least, most) = (least.min(p), most.max(p));
            }
            let margin = 0.005 * (most - least).max_element().max(0.01);
            let (least, most) = (least - margin, most + margin);
            let projection =
                glam::camera::rh::proj::vulkan::orthographic(least.x, most.x, least.y, most.y, -most.z, -least.z);
            let size = most - least;
            vec![block(projection * view, [size.x.max(size.y), size.z, 0.0])]
        }
        LightKind::Spot { outer, .. } => {
            let angle = (2.0 * outer).clamp(0.02, 2.9);
            let projection = perspective(angle, 1.0, 0.02, far());
            vec![block(projection * look(light.position, light.direction), [2.0 * (angle * 0.5).tan(), far(), 1.0])]
        }
        LightKind::Point => [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]
            .into_iter()
            .map(|direction| {
                // A little more than 90 degrees, so that filtered lookups at the seams stay inside a face.
                let angle = std::f32::consts::FRAC_PI_2 + 0.01;
                let matrix = perspective(angle, 1.0, 0.02, far()) * look(light.position, direction);
                block(matrix, [2.0 * (angle * 0.5).tan(), far(), 1.0])
            })
            .collect(),
    }
}

/// How many shadow maps a scene needs: one a directional or spot light, six a point light.
pub fn shadow_view_count(lights: &[Light]) -> u32 {
    lights.iter().filter(|l| l.shadow).map(|l| if matches!(l.kind, LightKind::Point) { 6 } else { 1 }).sum()
}
