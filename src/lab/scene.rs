//! A scene on the device, as the fixed named resources that shaders read
//! (`shaders/common/scene.glsl`).

use super::attributes::{self, Attributes};
use super::bvh;
use super::dielectrics::Dielectrics;
use super::emitters::Emitters;
use super::interface::MATERIAL_TEXTURES;
use super::interface::blocks::{CameraBlock, InstanceBlock, MaterialBlock, SceneInfoBlock};
use super::lighting::Lighting;
use super::materials::{self, MaterialTextures};
use super::shape::{Shape, count};
use super::sky;
use crate::graph::run::{Geometry, SceneResources, Update};
use crate::scene::{Instance, Light, Lookup, Material, Scene, Vertex, in_world};
use crate::vulkan::{Buffer, Gpu, Result, Sampler, SamplerDesc, Upload, VulkanError, vk};
use glam::{Mat4, Vec3};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// A scene's resources on the device.
#[derive(Clone)]
pub struct SceneGpu {
    /// Resources by name, and the draws.
    pub resources: SceneResources,
    /// Bytes of geometry and textures.
    pub bytes: u64,
    /// Where the shaders' world begins in the scene's.
    pub origin: Vec3,
    /// Bounds of the scene. Computing them walks through all vertices.
    bounds: (Vec3, Vec3),
    own: Own,
    /// The uploaded scene, with split triangles if they were split.
    scene: Arc<Scene>,
    emitters: Arc<Emitters>,
}

/// Content that changes from frame to frame, which each program has of its own.
#[derive(Clone)]
struct Own {
    buffers: Buffers,
    info: SceneInfoBlock,
    lighting: Lighting,
    sent: Vec<InstanceBlock>,
    /// Time of the vertices that were sent last [s].
    posed_at: f32,
}

impl Own {
    /// Uploads it. `info` has the counts of the scene; `shape` is needed for rays and for meshes
    /// that deform.
    fn new(
        upload: &mut Upload,
        (scene, origin, bounds): (&Scene, Vec3, (Vec3, Vec3)),
        info: SceneInfoBlock,
        shape: Option<&Shape>,
        emitters: &Emitters,
        rays: bool,
    ) -> Result<Own> {
        let lighting = Lighting::of(scene);
        let (info, lit) = lighting.contents(info, bounds, origin);
        let sent = instances(scene, origin, 0.0, None, false);
        let mut buffers = Buffers::new();
        let mut add = |name, bytes: &[u8], usage| -> Result<()> {
            buffers.insert(name, upload.buffer(name, bytes, usage)?);
            Ok(())
        };
        add("camera", &[0; size_of::<CameraBlock>()], UNIFORM)?;
        add("sceneInfo", bytemuck::bytes_of(&info), UNIFORM)?;
        for (name, bytes) in &lit {
            add(name, bytes, STORAGE)?;
        }
        add("instances", bytemuck::cast_slice(&sent), STORAGE)?;
        add("emitters", &emitters.buffer(&sent, None), STORAGE)?;
        if let Some(shape) = shape.filter(|_| !scene.deformers.is_empty()) {
            add("positions", bytemuck::cast_slice(&shape.positions), STORAGE)?;
            add(
                "attributes",
                bytemuck::cast_slice(&shape.attributes),
                STORAGE,
            )?;
        }
        if let Some(shape) = shape.filter(|_| rays) {
            let mut found = hierarchy(shape, emitters, &sent);
            // With room for the hierarchy of any other pose.
            let (nodes, triangles) = bvh::capacity(info.triangle_count as usize);
            found.nodes.resize(found.nodes.len().max(nodes), 0);
            found
                .triangles
                .resize(found.triangles.len().max(triangles), 0);
            add("bvhNodes", &found.nodes, STORAGE)?;
            add("bvhTriangles", &found.triangles, STORAGE)?;
        }
        Ok(Own {
            buffers,
            info,
            lighting,
            sent,
            posed_at: 0.0,
        })
    }
}

/// Buffers by name.
type Buffers = HashMap<&'static str, Arc<Buffer>>;

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;
const UNIFORM: vk::BufferUsageFlags = vk::BufferUsageFlags::UNIFORM_BUFFER;

impl SceneGpu {
    /// Uploads a scene into a world that begins at `origin`; `rays`: with the hierarchy that rays
    /// need.
    ///
    /// # Errors
    /// Out of memory; a hierarchy that is too deep.
    pub fn new(gpu: &Arc<Gpu>, scene: Arc<Scene>, origin: Vec3, rays: bool) -> Result<SceneGpu> {
        let mut upload = Upload::new(gpu);
        let textures = materials::upload(gpu, &scene, &mut upload)?;
        let sky = sky::texture(gpu, scene.environment.as_ref(), &mut upload)?;
        let shape = Shape::at_rest(&scene);
        let emitters = Arc::new(Emitters::new(&scene, &shape));
        let colored = attributes::colored_materials(&scene);
        let mut buffers = shared_buffers(&mut upload, &scene, &shape, &textures, &colored)?;
        if rays {
            let texels = sky::texels(scene.environment.as_ref());
            let texels = upload.buffer("skyTexels", bytemuck::cast_slice(&texels), STORAGE)?;
            buffers.insert("skyTexels", texels);
        }
        let commands = upload.buffer(
            "draw commands",
            bytemuck::cast_slice(&shape.commands()),
            vk::BufferUsageFlags::INDIRECT_BUFFER,
        )?;
        let bounds = scene.bounds();
        let info = info_of(&scene, origin, bounds, &shape);
        let place = (&*scene, origin, bounds);
        let own = Own::new(&mut upload, place, info, Some(&shape), &emitters, rays)?;
        buffers.extend(own.buffers.clone());
        check_sizes(gpu, &buffers)?;
        upload.finish()?;
        let bytes = buffers.values().map(|b| b.size).sum::<u64>() + textures.bytes + sky.bytes;
        let textures = MATERIAL_TEXTURES.into_iter().zip(textures.views);
        let draws = shape.draws.iter().map(|d| (d.first_index, d.index_count));
        let geometry = Geometry {
            indices: buffers["indices"].clone(),
            commands,
            draws: draws.collect(),
            opaque: count(shape.opaque),
        };
        let resources = SceneResources {
            buffers,
            textures: textures.chain([("skyTexture", sky.view)]).collect(),
            sampler: Arc::new(Sampler::new(gpu, &SAMPLER)?),
            geometry,
            constants: attributes::constants(&scene, &colored),
        };
        Ok(SceneGpu {
            resources,
            bytes,
            origin,
            bounds,
            own,
            scene,
            emitters,
        })
    }

    /// The same geometry and textures with buffers of its own for content that changes from frame
    /// to frame, so that two programs can run on one upload.
    ///
    /// # Errors
    /// Out of memory.
    pub fn fork(&self, gpu: &Arc<Gpu>) -> Result<SceneGpu> {
        let mut upload = Upload::new(gpu);
        let (scene, emitters) = (self.scene.clone(), self.emitters.clone());
        let rays = self.has_rays();
        let needed = rays || !scene.deformers.is_empty();
        let shape = needed.then(|| Shape::at_rest(&scene));
        let place = (&*scene, self.origin, self.bounds);
        let info = self.own.info;
        let own = Own::new(&mut upload, place, info, shape.as_ref(), &emitters, rays)?;
        upload.finish()?;
        let mut resources = self.resources.clone();
        resources.buffers.extend(own.buffers.clone());
        Ok(SceneGpu {
            resources,
            bytes: self.bytes,
            origin: self.origin,
            bounds: self.bounds,
            own,
            scene,
            emitters,
        })
    }

    /// Buffers that change with time: the poses of animated instances and of deforming meshes, when
    /// they moved. All threads of the CPU pose the vertices, which are sent whole. With rays, the
    /// hierarchy over all triangles is rebuilt.
    ///
    /// # Errors
    /// A pose with a hierarchy that is too deep.
    pub fn updates(&mut self, time: f64, first: bool) -> Result<Vec<Update>> {
        let scene = self.scene.clone();
        let own = &mut self.own;
        let previous = (!first).then_some(own.sent.as_slice());
        let deforms = !scene.deformers.is_empty() && time as f32 != own.posed_at;
        let now = instances(&scene, self.origin, time as f32, previous, deforms);
        if !deforms && now == own.sent || now.is_empty() {
            return Ok(Vec::new());
        }
        own.sent = now;
        if deforms {
            own.posed_at = time as f32;
        }
        let posed = scene.posed_meshes(self.own.posed_at);
        let mut list = Vec::new();
        list.extend(self.update("instances", bytemuck::cast_slice(&self.own.sent).to_vec()));
        if deforms {
            list.extend(self.deformed(&scene, &posed));
        }
        let (sent, moves) = (&self.own.sent, self.emitters.move_in(&scene));
        // Emitters of rigid bodies need no vertices: these are all of the scene's.
        let rigid = !moves || scene.deformers.is_empty();
        if rigid && !self.has_rays() {
            let emitters = moves.then(|| self.emitters.buffer(sent, None));
            list.extend(emitters.and_then(|bytes| self.update("emitters", bytes)));
            return Ok(list);
        }
        let shape = Shape::new(&scene, &posed);
        if moves {
            let vertices = (shape.positions.as_slice(), shape.indices.as_slice());
            let moved = (!scene.deformers.is_empty()).then_some(vertices);
            list.extend(self.update("emitters", self.emitters.buffer(sent, moved)));
        }
        if self.has_rays() {
            let found = hierarchy(&shape, &self.emitters, sent);
            list.extend(self.update("bvhNodes", found.nodes));
            list.extend(self.update("bvhTriangles", found.triangles));
        }
        Ok(list)
    }

    /// New bytes of a whole buffer.
    fn update(&self, name: &str, bytes: Vec<u8>) -> Option<Update> {
        Some(Update::all(self.resources.buffers.get(name)?, bytes))
    }

    /// Positions and attributes of the meshes that deform.
    fn deformed(&self, scene: &Scene, posed: &[Cow<'_, [Vertex]>]) -> Vec<Update> {
        let mut starts = vec![0usize];
        starts.extend(scene.meshes.iter().scan(0, |sum, mesh| {
            *sum += mesh.vertices.len();
            Some(*sum)
        }));
        let parts = scene.deformers.iter().flat_map(|deformer| {
            let start = starts.get(deformer.mesh as usize).copied().unwrap_or(0);
            let posed = posed
                .get(deformer.mesh as usize)
                .map(|vertices| &**vertices)
                .unwrap_or_default();
            let positions: Vec<[f32; 3]> = posed.iter().map(|v| v.position).collect();
            let attributes: Vec<Attributes> = posed.iter().map(attributes::of).collect();
            [
                (
                    "positions",
                    start * size_of::<[f32; 3]>(),
                    bytemuck::cast_slice(&positions).to_vec(),
                ),
                (
                    "attributes",
                    start * size_of::<Attributes>(),
                    bytemuck::cast_slice(&attributes).to_vec(),
                ),
            ]
        });
        let update = |(name, at, bytes): (&str, usize, Vec<u8>)| {
            let buffer = self.resources.buffers.get(name)?.clone();
            Some(Update {
                buffer,
                at: Some(at as u64),
                bytes,
            })
        };
        parts.filter_map(update).collect()
    }

    /// Whether it has what rays need.
    pub fn has_rays(&self) -> bool {
        self.resources.buffers.contains_key("bvhNodes")
    }

    /// Buffers that change with colours, directions, positions and cone angles of the lights, and
    /// with the sky. The scene has as many lights and shadow maps as the one that was uploaded, and
    /// its geometry.
    pub fn set_lights(&mut self, list: &[Light], sky: Vec3) -> Vec<Update> {
        self.own.lighting.lights = list.to_vec();
        self.own.lighting.sky = sky;
        self.relit()
    }

    /// Buffers that change with the rotation of the sky's picture, degrees about y.
    pub fn turn_sky(&mut self, rotation: f32) -> Vec<Update> {
        if let Some(environment) = &mut self.own.lighting.environment {
            environment.rotation = rotation;
        }
        self.relit()
    }

    fn relit(&mut self) -> Vec<Update> {
        let own = &mut self.own;
        let (info, lit) = own.lighting.contents(own.info, self.bounds, self.origin);
        own.info = info;
        let changed = lit
            .into_iter()
            .filter_map(|(name, bytes)| self.update(name, bytes));
        changed.chain(self.info()).collect()
    }

    /// The block `sceneInfo` as it is.
    pub fn info(&self) -> Option<Update> {
        self.update("sceneInfo", bytemuck::bytes_of(&self.own.info).to_vec())
    }

    /// The block `camera` of the next frame.
    pub fn camera(&self, block: Vec<u8>) -> Option<Update> {
        self.update("camera", block)
    }

    /// Whether another one has the same buffers for content that changes.
    pub fn shares_buffers(&self, other: &SceneGpu) -> bool {
        let [a, b] = [self, other].map(|scene| scene.own.buffers.get("camera"));
        a.zip(b).is_some_and(|(a, b)| Arc::ptr_eq(a, b))
    }
}

/// The hierarchy over triangles in the pose of these instances.
fn hierarchy(shape: &Shape, emitters: &Emitters, instances: &[InstanceBlock]) -> bvh::Hierarchy {
    let model = |i: u32| {
        instances
            .get(i as usize)
            .map_or(Mat4::IDENTITY, |b| Mat4::from_cols_array(&b.model))
    };
    bvh::build(shape, emitters, &model)
}

/// The counts and bounds of `sceneInfo`.
fn info_of(
    scene: &Scene,
    origin: Vec3,
    (low, high): (Vec3, Vec3),
    shape: &Shape,
) -> SceneInfoBlock {
    SceneInfoBlock {
        bounds_min: (low - origin).to_array(),
        light_count: 0,
        bounds_max: (high - origin).to_array(),
        shadow_views: 0,
        sky: [0.0; 3],
        triangle_count: shape.triangle_count(),
        draw_count: count(shape.draws.len()),
        vertex_count: count(shape.positions.len() / 3),
        instance_count: count(scene.instances.len()),
        sky_turn: 0.0,
        still_triangles: shape.still_triangles(),
    }
}

/// Buffers that all programs share.
fn shared_buffers(
    upload: &mut Upload,
    scene: &Scene,
    shape: &Shape,
    textures: &MaterialTextures,
    colored: &HashSet<u32>,
) -> Result<Buffers> {
    let dielectrics = Dielectrics::of(&scene.materials);
    let handle = |t: Option<u32>, lookup: Lookup| textures.handle(t, lookup);
    let block = |(i, m)| material(m, dielectrics.number(m), colored.contains(&i), &handle);
    let materials: Vec<MaterialBlock> = (0u32..).zip(&scene.materials).map(block).collect();
    let mut buffers = Buffers::new();
    let mut add = |name, bytes: &[u8], usage| -> Result<()> {
        buffers.insert(name, upload.buffer(name, bytes, usage)?);
        Ok(())
    };
    let index = vk::BufferUsageFlags::INDEX_BUFFER | STORAGE;
    add("indices", bytemuck::cast_slice(&shape.indices), index)?;
    add("materials", bytemuck::cast_slice(&materials), STORAGE)?;
    add(
        "dielectrics",
        bytemuck::cast_slice(&dielectrics.list),
        STORAGE,
    )?;
    add("draws", bytemuck::cast_slice(&shape.draws), STORAGE)?;
    add(
        "triangles",
        bytemuck::cast_slice(&shape.triangles()),
        STORAGE,
    )?;
    // Vertices that move belong to each program.
    if scene.deformers.is_empty() {
        add("positions", bytemuck::cast_slice(&shape.positions), STORAGE)?;
        add(
            "attributes",
            bytemuck::cast_slice(&shape.attributes),
            STORAGE,
        )?;
    }
    Ok(buffers)
}

fn check_sizes(gpu: &Gpu, buffers: &Buffers) -> Result<()> {
    let limit = u64::from(gpu.info.limits.max_storage_buffer_range);
    match buffers.iter().find(|(_, b)| b.size > limit) {
        Some((name, buffer)) => Err(VulkanError::Limit {
            what: format!("the scene's buffer '{name}'"),
            asked: format!("{} bytes", buffer.size),
            limit: format!("{limit} bytes (fewer triangles, or less splitting, would fit)"),
            device: gpu.info.name.clone(),
        }),
        None => Ok(()),
    }
}

/// How materials are sampled. Wrap modes are bits of a texture's handle.
const SAMPLER: SamplerDesc = SamplerDesc {
    filter: vk::Filter::LINEAR,
    mip_filter: vk::SamplerMipmapMode::LINEAR,
    address: vk::SamplerAddressMode::REPEAT,
    border: vk::BorderColor::FLOAT_TRANSPARENT_BLACK,
    compare: None,
    anisotropic: true,
};

fn material(
    m: &Material,
    dielectric: u32,
    colored: bool,
    handle: &dyn Fn(Option<u32>, Lookup) -> u32,
) -> MaterialBlock {
    let tinted = colored && m.tinted_emission;
    MaterialBlock {
        base_color: m.base_color.to_array(),
        emission: m.emission.to_array(),
        metallic: m.metallic,
        roughness: m.roughness,
        alpha_cutoff: m.alpha_cutoff,
        normal_scale: m.normal_scale,
        flags: u32::from(m.two_sided)
            | u32::from(colored) << 1
            | u32::from(tinted) << 2
            | dielectric << 8,
        base_color_texture: handle(m.base_color_texture, m.lookups.base_color),
        metallic_roughness_texture: handle(
            m.metallic_roughness_texture,
            m.lookups.metallic_roughness,
        ),
        normal_texture: handle(m.normal_texture, m.lookups.normal),
        emission_texture: handle(m.emission_texture, m.lookups.emission),
    }
}

/// `deforms`: vertices move too. Matrices do not show it, so the previous ones are zero, which
/// counts as a move.
fn instances(
    scene: &Scene,
    origin: Vec3,
    time: f32,
    previous: Option<&[InstanceBlock]>,
    deforms: bool,
) -> Vec<InstanceBlock> {
    let frames = scene.mover_frames(time);
    let deforming: HashSet<u32> = scene
        .deformers
        .iter()
        .filter(|_| deforms)
        .map(|d| d.mesh)
        .collect();
    let block = |(i, instance): (usize, &Instance)| {
        let mut model = in_world(&frames, instance.mover, instance.transform);
        model.w_axis -= origin.extend(0.0);
        let before = previous
            .and_then(|p| p.get(i))
            .map_or(model.to_cols_array(), |p| p.model);
        let normal = Mat4::from_mat3(glam::Mat3::from_mat4(model).inverse().transpose());
        InstanceBlock {
            model: model.to_cols_array(),
            previous_model: if deforming.contains(&instance.mesh) {
                [0.0; 16]
            } else {
                before
            },
            normal_matrix: normal.to_cols_array(),
        }
    };
    scene.instances.iter().enumerate().map(block).collect()
}
