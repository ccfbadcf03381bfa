//! Moving the camera by mouse and keys.

use crate::scene::Camera;
use egui::{Event, Key, Ui};
use glam::{Quat, Vec3};
use std::collections::HashSet;

/// The keys that are held down, by their places on a US keyboard.
#[derive(Default)]
pub struct Held(HashSet<Key>);

impl Held {
    /// Takes in the events of a frame.
    pub fn update(&mut self, events: &[Event]) {
        for event in events {
            match event {
                Event::Key {
                    key,
                    physical_key,
                    pressed,
                    ..
                } => {
                    let key = physical_key.unwrap_or(*key);
                    match pressed {
                        true => self.0.insert(key),
                        false => self.0.remove(&key),
                    };
                }
                // Releases are not seen without the focus.
                Event::WindowFocused(false) => self.0.clear(),
                _ => {}
            }
        }
    }

    fn has(&self, key: Key) -> f32 {
        f32::from(u8::from(self.0.contains(&key)))
    }
}

/// How the mouse moves the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Around the point it looks at.
    #[default]
    Orbit,
    /// As if held in the hand.
    Fly,
}

/// Moves the camera by what happened over the picture. `size` is the scene's diagonal, m; whether
/// it moved.
pub fn steer(
    ui: &Ui,
    response: &egui::Response,
    camera: &mut Camera,
    mode: Mode,
    size: f32,
    speed: f32,
    held: &Held,
) -> bool {
    let before = *camera;
    let delta = response.drag_delta();
    let height = response.rect.height().max(1.0);
    let angle = delta / height * std::f32::consts::PI;
    let distance = camera.eye.distance(camera.target).max(1e-3);
    if response.dragged_by(egui::PointerButton::Primary) && delta != egui::Vec2::ZERO {
        match mode {
            Mode::Orbit => orbit(camera, angle.x, angle.y),
            Mode::Fly => turn(camera, -angle.x, -angle.y),
        }
    }
    if response.dragged_by(egui::PointerButton::Secondary) && delta != egui::Vec2::ZERO {
        turn(camera, -angle.x, -angle.y);
    }
    if response.dragged_by(egui::PointerButton::Middle) && delta != egui::Vec2::ZERO {
        let metres = 2.0 * distance * (0.5 * camera.fov_y.to_radians()).tan() / height;
        let (right, up) = axes(camera);
        shift(camera, metres * (up * delta.y - right * delta.x));
    }
    if response.hovered() {
        let wheel = ui.input(|i| i.smooth_scroll_delta.y);
        if wheel != 0.0 {
            let forward = direction(camera);
            match mode {
                Mode::Orbit => {
                    let factor = (-wheel * 0.002).exp().clamp(0.2, 5.0);
                    camera.eye = camera.target - forward * distance * factor;
                }
                Mode::Fly => shift(camera, forward * wheel * 0.0005 * size),
            }
        }
    }
    keys(ui, camera, size * speed, held);
    *camera != before
}

/// Moves by the keys that are held; `size` is that of the scene times the speed.
fn keys(ui: &Ui, camera: &mut Camera, size: f32, keys: &Held) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let (right, up) = axes(camera);
    let forward = direction(camera);
    let (go, seconds, fast) = ui.input(|i| {
        let held = |key: Key| {
            if i.modifiers.command {
                0.0
            } else {
                keys.has(key)
            }
        };
        let go = forward * (held(Key::W) - held(Key::S))
            + right * (held(Key::D) - held(Key::A))
            + up * (held(Key::E) - held(Key::Q));
        (go, i.stable_dt.min(0.1), i.modifiers.shift)
    });
    if go != Vec3::ZERO {
        // The scene is crossed in about ten seconds.
        shift(
            camera,
            go * seconds * 0.1 * size * if fast { 4.0 } else { 1.0 },
        );
        ui.ctx().request_repaint();
    }
}

fn direction(camera: &Camera) -> Vec3 {
    (camera.target - camera.eye)
        .try_normalize()
        .unwrap_or(Vec3::NEG_Z)
}

/// To the right and up on the screen.
fn axes(camera: &Camera) -> (Vec3, Vec3) {
    let forward = direction(camera);
    let right = forward.cross(camera.up).try_normalize().unwrap_or(Vec3::X);
    (right, right.cross(forward))
}

fn shift(camera: &mut Camera, by: Vec3) {
    camera.eye += by;
    camera.target += by;
}

/// Turns a direction left and up, never over the pole.
fn turned(camera: &Camera, direction: Vec3, yaw: f32, pitch: f32) -> Vec3 {
    let up = camera.up.try_normalize().unwrap_or(Vec3::Y);
    let right = direction.cross(up).try_normalize().unwrap_or(Vec3::X);
    let elevation = direction
        .normalize_or(Vec3::NEG_Z)
        .dot(up)
        .clamp(-1.0, 1.0)
        .asin();
    let limit = 1.55;
    let pitch = (elevation + pitch).clamp(-limit, limit) - elevation;
    Quat::from_axis_angle(up, yaw) * (Quat::from_axis_angle(right, pitch) * direction)
}

fn turn(camera: &mut Camera, yaw: f32, pitch: f32) {
    let offset = camera.target - camera.eye;
    camera.target = camera.eye + turned(camera, offset, yaw, pitch);
}

fn orbit(camera: &mut Camera, yaw: f32, pitch: f32) {
    let offset = camera.target - camera.eye;
    camera.eye = camera.target - turned(camera, offset, -yaw, -pitch);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            eye: Vec3::new(0.0, 1.0, 5.0),
            target: Vec3::new(0.0, 1.0, 0.0),
            up: Vec3::Y,
            fov_y: 60.0,
            near: 0.1,
            far: 100.0,
        }
    }

    #[test]
    fn orbiting_keeps_the_distance_and_never_goes_over_the_pole() {
        let mut c = camera();
        for _ in 0..100 {
            orbit(&mut c, 0.3, 0.2);
            assert!((c.eye.distance(c.target) - 5.0).abs() < 1e-3);
            assert!(direction(&c).dot(Vec3::Y).abs() < 0.99999);
        }
    }

    #[test]
    fn dragging_right_turns_the_hand_held_camera_so_that_the_picture_follows() {
        let mut c = camera();
        turn(&mut c, -0.1, 0.0);
        // A negative yaw is clockwise from above: the middle moves to the left.
        assert!(c.target.x > 0.0);
    }
}
