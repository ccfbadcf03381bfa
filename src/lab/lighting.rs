//! The present lighting of a scene on the device.

use super::interface::blocks::SceneInfoBlock;
use super::shape::count;
use super::sky;
use super::view::lights;
use crate::scene::{Environment, Light, Scene};
use glam::Vec3;

/// The present lighting of the scene.
#[derive(Clone)]
pub(super) struct Lighting {
    pub lights: Vec<Light>,
    /// Factor of the sky's picture, or its radiance.
    pub sky: Vec3,
    pub environment: Option<Environment>,
    /// Divisor of the picture on the device.
    sky_scale: f32,
}

impl Lighting {
    pub fn of(scene: &Scene) -> Lighting {
        let (lights, environment) = (scene.lights.clone(), scene.environment.clone());
        Lighting {
            lights,
            sky: scene.sky,
            sky_scale: sky::scale_of(environment.as_ref()),
            environment,
        }
    }

    /// Content of every buffer that depends on the lighting, by name, with the sky's sun as the
    /// last light; and `sceneInfo` with the members that depend on it.
    pub fn contents(
        &self,
        info: SceneInfoBlock,
        bounds: (Vec3, Vec3),
        origin: Vec3,
    ) -> (SceneInfoBlock, [(&'static str, Vec<u8>); 2]) {
        let sun = self
            .environment
            .as_ref()
            .and_then(|e| e.sun(self.sky, e.rotation));
        let all: Vec<Light> = self.lights.iter().cloned().chain(sun).collect();
        let (lights, shadows) = lights((&all, self.lights.len()), bounds, origin);
        let rotation = self.environment.as_ref().map(|e| e.rotation);
        let info = SceneInfoBlock {
            light_count: count(lights.len()),
            shadow_views: count(shadows.len()),
            sky: (self.sky * self.sky_scale).to_array(),
            sky_turn: sky::turn_of(rotation),
            ..info
        };
        let buffers = [
            ("lights", bytemuck::cast_slice(&lights).to_vec()),
            ("shadowViews", bytemuck::cast_slice(&shadows).to_vec()),
        ];
        (info, buffers)
    }
}
