//! The present lighting of a scene on the device.

use super::interface::blocks::{LightBlock, SceneInfoBlock, ShadowBlock};
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

    /// The lights' blocks and shadow views, that of the sky's sun last.
    pub fn blocks(
        &self,
        bounds: (Vec3, Vec3),
        origin: Vec3,
    ) -> (Vec<LightBlock>, Vec<ShadowBlock>) {
        let sun = self
            .environment
            .as_ref()
            .and_then(|e| e.sun(self.sky, e.rotation));
        let all: Vec<Light> = self.lights.iter().cloned().chain(sun).collect();
        lights((&all, self.lights.len()), bounds, origin)
    }

    /// The part of `sceneInfo` that changes with it.
    pub fn inform(&self, info: SceneInfoBlock) -> SceneInfoBlock {
        let rotation = self.environment.as_ref().map(|e| e.rotation);
        SceneInfoBlock {
            sky: (self.sky * self.sky_scale).to_array(),
            sky_turn: sky::turn_of(rotation),
            ..info
        }
    }
}
