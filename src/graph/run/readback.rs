//! What frames have left on the device, read back.

use super::program::Program;
use super::resources::Resources;
use super::transfer::copy_out;
use crate::graph::definition::{Graph, Res};
use crate::vulkan::{Buffer, Commands, Result, vk};
use gpu_allocator::MemoryLocation;

impl Program {
    /// Copies one mip and layer of a texture, or a (first texel, extent) box of it, to the CPU:
    /// tightly packed texels.
    ///
    /// # Errors
    /// The device was lost, out of memory.
    pub fn read_texture(
        &mut self,
        texture: usize,
        mip: u32,
        layer: u32,
        part: Option<([u32; 3], [u32; 3])>,
    ) -> Result<Vec<u8>> {
        self.finish_all()?;
        let parity = usize::try_from((self.frame + 1) % 2).unwrap_or(0);
        let plan = &self.plan.textures[texture];
        let image = self
            .resources
            .image(&self.plan, texture, false, parity)?
            .clone();
        let place = self
            .schedule
            .places
            .of(
                &self.plan,
                Res::Texture(texture, false),
                (mip, 1),
                parity == 1,
            )
            .start;
        let layout = self.resting[place];
        let extent = part.map_or(image.mip_extent(mip), |p| p.1);
        let size =
            extent.iter().map(|n| u64::from(*n)).product::<u64>() * u64::from(plan.format.bytes);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let target = Buffer::new(
            self.gpu(),
            "readback",
            size,
            usage,
            MemoryLocation::GpuToCpu,
        )?;
        Commands::once(self.gpu(), |commands| {
            copy_out(commands, &image, layout, (mip, layer), part, &target)
        })?;
        Ok(target.bytes()[..usize::try_from(size).unwrap_or(0)].to_vec())
    }

    /// Texels of the shown texture as the last frame left them; none without one.
    ///
    /// # Errors
    /// The device was lost, out of memory.
    pub fn shown_texels(&mut self) -> Result<Option<Vec<u8>>> {
        self.shown
            .map(|texture| self.read_texture(texture, 0, 0, None))
            .transpose()
    }

    /// Copies a buffer to the CPU.
    ///
    /// # Errors
    /// The device was lost, out of memory.
    pub fn read_buffer(&mut self, buffer: usize) -> Result<Vec<u8>> {
        self.finish_all()?;
        let parity = usize::try_from((self.frame + 1) % 2).unwrap_or(0);
        let from = self
            .resources
            .buffer(&self.plan, buffer, false, parity)
            .cloned();
        let Some(from) = from else {
            return Ok(Vec::new());
        };
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let target = Buffer::new(
            self.gpu(),
            "readback",
            from.size,
            usage,
            MemoryLocation::GpuToCpu,
        )?;
        Commands::once(self.gpu(), |commands| {
            commands.full_barrier();
            commands.copy_buffer(&from, &target, from.size);
            commands.full_barrier();
        })?;
        Ok(target.bytes()[..usize::try_from(self.plan.buffers[buffer].size).unwrap_or(0)].to_vec())
    }

    /// (name, bytes on the device) of every resource made; what transient ones share is one of
    /// them.
    pub fn memory(&self, graph: &Graph) -> Vec<(String, u64)> {
        let Resources {
            images,
            buffers,
            shared_bytes,
        } = &self.resources;
        let images = images
            .iter()
            .zip(&self.plan.textures)
            .map(|(copies, plan)| {
                (
                    plan.transient,
                    copies.iter().flatten().map(|i| i.bytes).sum::<u64>(),
                )
            });
        let buffers = buffers
            .iter()
            .zip(&self.plan.buffers)
            .map(|(copies, plan)| {
                (
                    plan.transient,
                    copies.iter().flatten().map(|b| b.size).sum::<u64>(),
                )
            });
        let own = graph
            .resource_names()
            .zip(images.chain(buffers))
            .filter(|(_, (transient, _))| !transient);
        let own = own.map(|(name, (_, bytes))| (name.to_string(), bytes));
        let shared = (String::from("shared by transient ones"), *shared_bytes);
        own.chain([shared])
            .filter(|(_, bytes)| *bytes > 0)
            .collect()
    }
}
