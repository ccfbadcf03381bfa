//! A graph that runs in a scene: frames, changes between them, and reading results.

use super::{
    FrameCounters, Lab, LabError, ReusableParts, Session, Texels, Viewpoint, no_texture, view,
};
use crate::experiment::PlacedCamera;
use crate::graph::link::{Layouts, runs, table};
use crate::graph::param::Params;
use crate::graph::plan::plan;
use crate::graph::run::{Execution, FrameTimes, Update};
use crate::graph::table::Table;
use crate::graph::{Debug, Evaluated, signed};
use crate::scene::{Camera, Light};
use crate::vulkan::DeviceInfo;
use glam::Vec3;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

impl Session {
    /// Frames from a fresh start until the picture has converged; 1 if no pass gathers over frames.
    pub fn converging_frames(&self) -> usize {
        self.program.plan.convergence.fresh as usize
    }

    /// Frames after which the picture has converged once something but the camera changed, at most.
    pub fn frames_after_change(&self) -> usize {
        self.program.plan.convergence.changed as usize
    }

    /// Forgets what frames left: the next frame is like the first one of a new session. Returns the
    /// times of the frames that finished meanwhile.
    ///
    /// # Errors
    /// The device was lost.
    pub fn restart(&mut self) -> Result<Vec<FrameTimes>, LabError> {
        let finished = self.program.restart()?;
        self.viewpoint = Viewpoint::new(&self.viewpoint.camera);
        (self.counters, self.sent_params) = (FrameCounters::default(), false);
        Ok(finished)
    }

    /// Parts for the session that will replace this one; this one runs on until then.
    pub fn reusable_parts(&self) -> ReusableParts {
        ReusableParts {
            parts: self.program.parts(&self.graph),
            scene: self.scene.clone(),
            max_edge: self.program.plan.max_edge,
            scene_gpu: self.scene_gpu.clone(),
            shared: false,
        }
    }

    /// Parts for a session that renders at the same time: pipelines, geometry and textures of the
    /// scene.
    pub fn share(&self) -> ReusableParts {
        let all = self.reusable_parts();
        ReusableParts {
            parts: all.parts.pipelines_only(),
            shared: true,
            ..all
        }
    }

    /// Takes the place of the session that this one was made from, at a frame's border: textures
    /// keep their content, time and camera go on.
    ///
    /// # Errors
    /// The device was lost.
    pub fn swap_in(&mut self, old: &mut Session) -> Result<(), LabError> {
        self.program.swap_in(&mut old.program)?;
        if self.scene_gpu.shares_buffers(&old.scene_gpu) {
            // Poses and lights were sent since this one was made.
            self.scene_gpu = old.scene_gpu.clone();
            self.light_updates.append(&mut old.light_updates);
        }
        self.viewpoint = old.viewpoint.clone();
        self.time = old.time;
        self.counters.frame = old.counters.frame;
        Ok(())
    }

    /// Sets parameters if that needs no other textures, passes, shaders or pipelines: then it is a
    /// buffer write, and `true`.
    ///
    /// # Errors
    /// Values that the graph cannot be planned with.
    pub fn set_params(&mut self, lab: &Lab, params: &Params) -> Result<bool, LabError> {
        if params.constants() != self.params.constants() {
            return Ok(false);
        }
        let set = Evaluated::new(&self.graph, params, self.surroundings.clone());
        if !runs(&set).are_linked(&self.graph, &self.linked) {
            return Ok(false);
        }
        let mut plan =
            plan(&set, &self.linked, &self.wanted, &lab.gpu.info).map_err(LabError::Input)?;
        // No resource or pipeline depends on when passes rest or converge.
        let settling = std::mem::replace(&mut plan.settling, self.program.plan.settling.clone());
        let convergence = std::mem::replace(&mut plan.convergence, self.program.plan.convergence);
        if plan != self.program.plan {
            return Ok(false);
        }
        (self.program.plan.settling, self.program.plan.convergence) = (settling, convergence);
        self.values = signed(&set, &self.linked, &self.program.plan);
        self.params = params.clone();
        self.sent_params = false;
        Ok(true)
    }

    /// Looks through a camera from the next frame on.
    pub fn set_camera(&mut self, camera: &Camera) {
        self.viewpoint.camera = *camera;
    }

    /// The camera of the next frame.
    pub fn camera(&self) -> &Camera {
        &self.viewpoint.camera
    }

    /// The time of the next frame, s.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// Sets which passes frames run, from the next one on.
    pub fn set_execution(&mut self, execution: Execution) {
        self.program.set_execution(execution);
    }

    /// What frames do.
    pub fn execution(&self) -> Execution {
        self.program.execution()
    }

    /// Copies this texture to the CPU with every frame ([`FrameTimes::picture`]).
    pub fn show(&mut self, texture: &str) {
        self.program.show(self.graph.texture(texture));
    }

    /// Runs one frame. The times that come back are those of an earlier frame, which has finished
    /// meanwhile.
    ///
    /// # Errors
    /// The device was lost.
    pub fn frame(&mut self, delta: f64) -> Result<Option<FrameTimes>, LabError> {
        let mut updates = self
            .scene_gpu
            .updates(self.time, self.counters.frame == 0)?;
        updates.append(&mut self.light_updates);
        self.counters
            .count(!updates.is_empty() || !self.sent_params);
        let camera = self.viewpoint.uniform(
            self.scene_gpu.origin,
            self.size,
            self.time,
            self.counters,
            delta,
        );
        updates.extend(self.scene_gpu.camera(camera));
        if !self.sent_params {
            updates.push(Update::all(
                &self.program.params_buffer(),
                self.params.uniform_bytes(&self.values),
            ));
            // So that it is known which part of it lights change; they may have sent it already.
            if let Some(info) = self.scene_gpu.info() {
                updates.retain(|u| !Arc::ptr_eq(&u.buffer, &info.buffer));
                updates.push(info);
            }
            self.sent_params = true;
        }
        self.counters.frame += 1;
        self.time += delta;
        Ok(self.program.run(&updates)?)
    }

    /// Changes the colours, places and directions of the scene's lights, and its sky, from the next
    /// frame on. False, and nothing changes, with another number of lights or shadow maps: that
    /// needs a new session.
    pub fn set_lights(&mut self, lights: &[Light], sky: Vec3) -> bool {
        let same = light_counts(lights) == light_counts(&self.scene.lights);
        if same {
            self.light_updates = self.scene_gpu.set_lights(lights, sky);
        }
        same
    }

    /// Turns the sky's picture to that rotation about y in degrees, from the next frame on, and its
    /// sun with it.
    pub fn turn_sky(&mut self, rotation: f32) {
        self.light_updates = self.scene_gpu.turn_sky(rotation);
    }

    /// Sees the next frames from another camera. The frame before stays known to what compares
    /// frames.
    pub fn place_camera(&mut self, placed: &PlacedCamera) {
        self.viewpoint.place_camera(placed, self.bounds);
    }

    /// Runs frames whose times are not wanted, and waits for them. They skip passes whose inputs are
    /// unchanged: results are the same to the bit.
    ///
    /// # Errors
    /// The device was lost.
    pub fn run(&mut self, frames: usize) -> Result<(), LabError> {
        let execution = self.execution();
        self.set_execution(Execution::Incremental);
        let ran = (0..frames).try_for_each(|_| self.frame(0.0).map(drop));
        self.set_execution(execution);
        ran?;
        self.finish().map(drop)
    }

    /// Begins frames that precede timed ones. On a software device they skip passes whose inputs are
    /// unchanged: results are the same to the bit, several times as fast. A GPU runs all passes, so
    /// that its clocks are those of the timed frames. [`Session::set_execution`] ends it.
    pub fn begin_warm_up(&mut self, device: &DeviceInfo) {
        if device.kind == "cpu" {
            self.set_execution(Execution::Incremental);
        }
    }

    /// Waits for all frames.
    ///
    /// # Errors
    /// The device was lost.
    pub fn finish(&mut self) -> Result<Vec<FrameTimes>, LabError> {
        Ok(self.program.finish_all()?)
    }

    /// A table of the graph with its bytes; nothing where no shader that runs declares its buffer.
    pub fn table(&self, number: usize) -> Option<Table> {
        table(&Layouts::new(&self.graph, &self.linked), number)
    }

    /// Messages of the graph's checks that failed in the last frame.
    ///
    /// # Errors
    /// The device was lost.
    pub fn failed_checks(&mut self) -> Result<Vec<String>, LabError> {
        let layouts = Layouts::new(&self.graph, &self.linked);
        let mut failed = Vec::new();
        // Checks of one buffer share one reading of it: each waits for the device.
        let mut read = BTreeMap::new();
        for check in self.graph.checks.iter().map(|c| &c.value) {
            let Some(buffer) = self.graph.buffer(&check.field.value.buffer) else {
                continue;
            };
            // Linking reported mistakes. A block that no shader declares is not written.
            let Ok(Some(word)) = layouts.check(&check.field) else {
                continue;
            };
            let bytes = match read.entry(buffer) {
                Entry::Occupied(entry) => entry.into_mut(),
                Entry::Vacant(entry) => entry.insert(self.program.read_buffer(buffer)?),
            };
            let start = word as usize * 4;
            let value = bytes
                .get(start..start + 4)
                .map_or(0, |b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]));
            if value != 0 {
                failed.push(format!("{} ({value})", check.message));
            }
        }
        if let Some(debug) = self.debug()? {
            failed.extend(debug.failed.iter().map(ToString::to_string));
        }
        Ok(failed)
    }

    /// Values and failed checks that shaders recorded in the last frame
    /// (`shaders/common/debug.glsl`); nothing where no pass that runs records any.
    ///
    /// # Errors
    /// The device was lost.
    pub fn debug(&mut self) -> Result<Option<Debug>, LabError> {
        match Debug::buffer(&self.graph).filter(|b| self.program.plan.buffers[*b].used) {
            Some(buffer) => {
                let bytes = self.program.read_buffer(buffer)?;
                let passes = self.program.plan.passes();
                let names = Debug::names(&self.graph, &self.linked, &passes);
                Ok(Some(Debug::read(&names, &bytes)))
            }
            None => Ok(None),
        }
    }

    /// Whether a texture holds the last frame's content: whether it was wanted, or is kept between
    /// frames anyway.
    pub fn keeps(&self, texture: &str) -> bool {
        let plan = self.graph.texture(texture);
        let plan = plan.map(|i| &self.program.plan.textures[i]);
        plan.is_some_and(|p| !p.usage.is_empty() && !p.transient)
            || self.wanted.iter().any(|w| w == texture)
    }

    /// Reads a texture's mip and layer.
    ///
    /// # Errors
    /// No such texture, mip or layer; the device was lost.
    pub fn texels(&mut self, name: &str, mip: u32, layer: u32) -> Result<Texels, LabError> {
        self.texels_in(name, mip, layer, None)
    }

    /// Reads a slice of a texture's mip: for a volume the texels at `slice` along `axis`, for
    /// others all of them. The result is 2D: y z for a cut across x, x z across y, x y across z.
    ///
    /// # Errors
    /// As [`Session::texels`].
    pub fn slice(
        &mut self,
        name: &str,
        mip: u32,
        layer: u32,
        axis: usize,
        slice: u32,
    ) -> Result<Texels, LabError> {
        let plan = self
            .graph
            .texture(name)
            .map(|i| &self.program.plan.textures[i]);
        let Some(plan) = plan.filter(|p| p.volume) else {
            return self.texels(name, mip, layer);
        };
        let whole = plan.mip_extent(mip);
        let axis = axis.min(2);
        let (mut first, mut extent) = ([0; 3], whole);
        first[axis] = slice.min(whole[axis] - 1);
        extent[axis] = 1;
        let mut texels = self.texels_in(name, mip, layer, Some((first, extent)))?;
        let [x, y, z] = extent;
        texels.extent = match axis {
            0 => [y, z, 1],
            1 => [x, z, 1],
            _ => [x, y, 1],
        };
        Ok(texels)
    }

    fn texels_in(
        &mut self,
        name: &str,
        mip: u32,
        layer: u32,
        part: Option<([u32; 3], [u32; 3])>,
    ) -> Result<Texels, LabError> {
        let index = self
            .graph
            .texture(name)
            .ok_or_else(|| no_texture(&self.graph, name))?;
        let plan = &self.program.plan.textures[index];
        if plan.usage.is_empty() {
            return Err(LabError::Request(format!(
                "'{name}' is not made with these parameters: no pass that runs uses it"
            )));
        }
        if plan.transient {
            return Err(not_kept(name));
        }
        if mip >= plan.mips || layer >= plan.layers {
            let message = format!(
                "'{name}' has {} mips and {} layers; there is no mip {mip}, layer {layer}",
                plan.mips, plan.layers
            );
            return Err(LabError::Request(message));
        }
        let extent = part.map_or(plan.mip_extent(mip), |p| p.1);
        let format = plan.format;
        Ok(Texels {
            extent,
            format,
            bytes: self.program.read_texture(index, mip, layer, part)?,
        })
    }

    /// Content of a buffer of the graph, empty while no pass uses it.
    ///
    /// # Errors
    /// No such buffer; the device was lost.
    pub fn buffer(&mut self, name: &str) -> Result<Vec<u8>, LabError> {
        match self.graph.buffer(name) {
            Some(index) if self.program.plan.buffers[index].transient => Err(not_kept(name)),
            Some(index) => Ok(self.program.read_buffer(index)?),
            None => Err(LabError::Request(format!("no buffer '{name}'"))),
        }
    }

    /// The picture's size.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Bytes of the scene's own resources.
    pub fn scene_bytes(&self) -> u64 {
        self.scene_gpu.bytes
    }
}

/// Numbers of lights and shadow maps that a session is made for; see [`Session::set_lights`].
pub(crate) fn light_counts(lights: &[Light]) -> [u32; 4] {
    [
        u32::try_from(lights.len()).unwrap_or(u32::MAX),
        view::shadow_view_count(lights),
        view::directional_view_count(lights),
        view::area_light_count(lights),
    ]
}

fn not_kept(name: &str) -> LabError {
    LabError::Request(format!(
        "'{name}' is transient and nothing is left in it after a frame: it must be among what is wanted"
    ))
}
