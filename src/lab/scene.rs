//! A scene on the device, as the fixed named resources that shaders read
//! (`shaders/common/scene.glsl`).

use super::attributes::{self, Attributes};
use super::bvh::{self, Soup};
use super::dielectrics::Dielectrics;
use super::emitters::Emitters;
use super::interface::{
    CameraBlock, DrawBlock, InstanceBlock, LightBlock, MATERIAL_TEXTURES, MaterialBlock,
    SceneInfoBlock, ShadowBlock,
};
use super::materials;
use super::sky;
use super::view::lights;
use crate::graph::run::{Geometry, SceneResources, Update};
use crate::scene::{Environment, Instance, Light, Lookup, Material, Scene, Vertex, in_world};
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
    /// The block `camera`, written every frame.
    pub camera: Arc<Buffer>,
    /// Bytes of geometry and textures.
    pub bytes: u64,
    /// Where the shaders' world begins in the scene's.
    pub origin: Vec3,
    info: SceneInfoBlock,
    lighting: Lighting,
    bounds: (Vec3, Vec3),
    instances: Arc<Buffer>,
    sent: Vec<InstanceBlock>,
    /// When vertices are as they were sent last, s.
    posed_at: f32,
    /// The uploaded scene, with split triangles if they were split.
    scene: Arc<Scene>,
    emitters: Arc<Emitters>,
}

/// The present lighting of the scene.
#[derive(Clone)]
struct Lighting {
    lights: Vec<Light>,
    /// Factor of the sky's picture, or its radiance.
    sky: Vec3,
    environment: Option<Environment>,
    /// Divisor of the picture on the device.
    sky_scale: f32,
}

impl Lighting {
    fn of(scene: &Scene) -> Lighting {
        let (lights, environment) = (scene.lights.clone(), scene.environment.clone());
        Lighting {
            lights,
            sky: scene.sky,
            sky_scale: sky::scale_of(environment.as_ref()),
            environment,
        }
    }

    /// The lights' blocks and shadow views, that of the sky's sun last.
    fn blocks(&self, bounds: (Vec3, Vec3), origin: Vec3) -> (Vec<LightBlock>, Vec<ShadowBlock>) {
        let sun = self
            .environment
            .as_ref()
            .and_then(|e| e.sun(self.sky, e.rotation));
        let all: Vec<Light> = self.lights.iter().cloned().chain(sun).collect();
        lights((&all, self.lights.len()), bounds, origin)
    }

    /// The part of `sceneInfo` that changes with it.
    fn inform(&self, info: SceneInfoBlock) -> SceneInfoBlock {
        let rotation = self.environment.as_ref().map(|e| e.rotation);
        SceneInfoBlock {
            sky: (self.sky * self.sky_scale).to_array(),
            sky_turn: sky::turn_of(rotation),
            ..info
        }
    }
}

/// Bytes of the block `camera`.
const CAMERA_BYTES: usize = size_of::<CameraBlock>();

impl SceneGpu {
    /// Uploads a scene into a world that begins at `origin`; `rays`: with the hierarchy that rays
    /// need.
    ///
    /// # Errors
    /// Out of memory; a hierarchy that is too deep.
    pub fn new(gpu: &Arc<Gpu>, scene: Arc<Scene>, origin: Vec3, rays: bool) -> Result<SceneGpu> {
        let whole = scene;
        let scene = &*whole;
        let mut upload = Upload::new(gpu);
        let textures = materials::upload(gpu, scene, &mut upload)?;
        let sky = sky::texture(gpu, scene.environment.as_ref(), &mut upload)?;
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let (positions, attributes, indices, first_index) =
            vertices(scene, &scene.posed_meshes(0.0));
        let draws = draws(scene, &first_index);
        let triangles = triangles(&draws, &indices, &positions, &attributes);
        let opaque = draws.iter().filter(|d| !is_masked(scene, d)).count();
        // One command (VkDrawIndexedIndirectCommand) a draw; the instance number tells the shaders
        // which.
        let commands: Vec<[u32; 5]> = (0u32..)
            .zip(&draws)
            .map(|(i, d)| [d.index_count, 1, d.first_index, 0, i])
            .collect();
        let (low, high) = scene.bounds();
        let lighting = Lighting::of(scene);
        let (light_blocks, shadow_blocks) = lighting.blocks((low, high), origin);
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let info = lighting.inform(SceneInfoBlock {
            bounds_min: (low - origin).to_array(),
            light_count: count(light_blocks.len()),
            bounds_max: (high - origin).to_array(),
            shadow_views: count(shadow_blocks.len()),
            sky: [0.0; 3],
            triangle_count: count(draws.iter().map(|d| d.index_count as usize / 3).sum()),
            draw_count: count(draws.len()),
            vertex_count: count(positions.len() / 3),
            instance_count: count(scene.instances.len()),
            sky_turn: 0.0,
        });
        let dielectrics = Dielectrics::of(&scene.materials);
        let colored = attributes::colored_materials(scene);
        let handle = |t: Option<u32>, lookup: Lookup| textures.handle(t, lookup);
        let material_blocks: Vec<MaterialBlock> = (0u32..)
            .zip(&scene.materials)
            .map(|(i, m)| material(m, dielectrics.number(m), colored.contains(&i), &handle))
            .collect();
        let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let index = vk::BufferUsageFlags::INDEX_BUFFER | storage;
        let index_buffer = upload.buffer("indices", bytemuck::cast_slice(&indices), index)?;
        let command_buffer = upload.buffer(
            "draw commands",
            bytemuck::cast_slice(&commands),
            vk::BufferUsageFlags::INDIRECT_BUFFER,
        )?;
        let instance_blocks = instances(scene, origin, 0.0, None, false);
        let instances =
            upload.buffer("instances", bytemuck::cast_slice(&instance_blocks), storage)?;
        let camera = upload.buffer("camera", &[0; CAMERA_BYTES], uniform)?;
        let masked = |d: &DrawBlock| is_masked(scene, d);
        let soup = Soup {
            positions: &positions,
            indices: &indices,
            draws: &draws,
            first_index: &first_index,
            masked: &masked,
        };
        let emitters = Arc::new(Emitters::new(scene, &soup, &attributes));
        let mut buffers = HashMap::from([
            ("camera", camera.clone()),
            ("indices", index_buffer.clone()),
            (
                "sceneInfo",
                upload.buffer("sceneInfo", bytemuck::bytes_of(&info), uniform)?,
            ),
            (
                "lights",
                upload.buffer("lights", bytemuck::cast_slice(&light_blocks), storage)?,
            ),
            (
                "shadowViews",
                upload.buffer("shadowViews", bytemuck::cast_slice(&shadow_blocks), storage)?,
            ),
            (
                "materials",
                upload.buffer("materials", bytemuck::cast_slice(&material_blocks), storage)?,
            ),
            (
                "dielectrics",
                upload.buffer(
                    "dielectrics",
                    bytemuck::cast_slice(&dielectrics.list),
                    storage,
                )?,
            ),
            ("instances", instances.clone()),
            (
                "draws",
                upload.buffer("draws", bytemuck::cast_slice(&draws), storage)?,
            ),
            (
                "triangles",
                upload.buffer("triangles", bytemuck::cast_slice(&triangles), storage)?,
            ),
            (
                "emitters",
                upload.buffer(
                    "emitters",
                    &emitters.buffer(&instance_blocks, None),
                    storage,
                )?,
            ),
            (
                "positions",
                upload.buffer("positions", bytemuck::cast_slice(&positions), storage)?,
            ),
            (
                "attributes",
                upload.buffer("attributes", bytemuck::cast_slice(&attributes), storage)?,
            ),
        ]);
        if rays {
            let found = hierarchy(&soup, &emitters, &instance_blocks);
            buffers.extend(ray_buffers(&mut upload, found, &info)?);
            let texels = sky::texels(scene.environment.as_ref());
            buffers.insert(
                "skyTexels",
                upload.buffer("skyTexels", bytemuck::cast_slice(&texels), storage)?,
            );
        }
        let limit = u64::from(gpu.info.limits.max_storage_buffer_range);
        if let Some((name, buffer)) = buffers.iter().find(|(_, b)| b.size > limit) {
            return Err(VulkanError::Limit {
                what: format!("the scene's buffer '{name}'"),
                asked: format!("{} bytes", buffer.size),
                limit: format!("{limit} bytes (fewer triangles, or less splitting, would fit)"),
                device: gpu.info.name.clone(),
            });
        }
        upload.finish()?;
        let bytes = buffers.values().map(|b| b.size).sum::<u64>() + textures.bytes + sky.bytes;
        let sampler = Arc::new(Sampler::new(
            gpu,
            &SamplerDesc {
                filter: vk::Filter::LINEAR,
                mip_filter: vk::SamplerMipmapMode::LINEAR,
                address: vk::SamplerAddressMode::REPEAT,
                border: vk::BorderColor::FLOAT_TRANSPARENT_BLACK,
                compare: None,
                anisotropic: true,
            },
        )?);
        Ok(SceneGpu {
            resources: SceneResources {
                buffers,
                textures: MATERIAL_TEXTURES
                    .into_iter()
                    .zip(textures.views)
                    .chain([("skyTexture", sky.view)])
                    .collect(),
                sampler,
                geometry: Geometry {
                    indices: index_buffer,
                    commands: command_buffer,
                    draws: draws
                        .iter()
                        .map(|d| (d.first_index, d.index_count))
                        .collect(),
                    opaque: count(opaque),
                },
                constants: attributes::constants(scene, &colored),
            },
            camera,
            bytes,
            origin,
            info,
            lighting,
            bounds: (low, high),
            instances,
            sent: instance_blocks,
            posed_at: 0.0,
            scene: whole,
            emitters,
        })
    }

    /// The same geometry and textures with buffers of its own for what changes from frame to frame,
    /// so that two programs can run on one upload.
    ///
    /// # Errors
    /// Out of memory.
    pub fn fork(&self, gpu: &Arc<Gpu>) -> Result<SceneGpu> {
        let scene = &*self.scene;
        let (origin, bounds) = (self.origin, self.bounds);
        let mut upload = Upload::new(gpu);
        let mut resources = self.resources.clone();
        let sent = instances(scene, origin, 0.0, None, false);
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let instances = upload.buffer("instances", bytemuck::cast_slice(&sent), storage)?;
        let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let camera = upload.buffer("camera", &[0; CAMERA_BYTES], uniform)?;
        let lighting = Lighting::of(scene);
        let info = lighting.inform(self.info);
        let (light_blocks, shadow_blocks) = lighting.blocks(bounds, origin);
        // Vertices that move are the other program's own too.
        let posed =
            (!scene.deformers.is_empty()).then(|| vertices(scene, &scene.posed_meshes(0.0)));
        if let Some((positions, attributes, ..)) = &posed {
            let shape = [
                (
                    "positions",
                    upload.buffer("positions", bytemuck::cast_slice(positions), storage)?,
                ),
                (
                    "attributes",
                    upload.buffer("attributes", bytemuck::cast_slice(attributes), storage)?,
                ),
            ];
            resources.buffers.extend(shape);
        }
        let own = [
            ("instances", instances.clone()),
            ("camera", camera.clone()),
            (
                "sceneInfo",
                upload.buffer("sceneInfo", bytemuck::bytes_of(&info), uniform)?,
            ),
            (
                "lights",
                upload.buffer("lights", bytemuck::cast_slice(&light_blocks), storage)?,
            ),
            (
                "shadowViews",
                upload.buffer("shadowViews", bytemuck::cast_slice(&shadow_blocks), storage)?,
            ),
            (
                "emitters",
                upload.buffer("emitters", &self.emitters.buffer(&sent, None), storage)?,
            ),
        ];
        resources.buffers.extend(own);
        if self.has_rays() {
            // The other program moves its own instances, and the hierarchy with them.
            let found = scene_hierarchy(scene, &self.emitters, &sent);
            resources
                .buffers
                .extend(ray_buffers(&mut upload, found, &info)?);
        }
        upload.finish()?;
        let (emitters, scene) = (self.emitters.clone(), self.scene.clone());
        let posed_at = 0.0;
        Ok(SceneGpu {
            resources,
            camera,
            bytes: self.bytes,
            origin,
            info,
            lighting,
            bounds,
            instances,
            sent,
            posed_at,
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
        let previous = (!first).then_some(self.sent.as_slice());
        let deforms = !scene.deformers.is_empty() && time as f32 != self.posed_at;
        let now = instances(&scene, self.origin, time as f32, previous, deforms);
        if !deforms && now == self.sent || now.is_empty() {
            return Ok(Vec::new());
        }
        self.sent = now;
        let mut list = vec![Update::all(
            &self.instances,
            bytemuck::cast_slice(&self.sent).to_vec(),
        )];
        if deforms {
            self.posed_at = time as f32;
        }
        let posed = scene.posed_meshes(self.posed_at);
        if deforms {
            list.extend(self.deformed(&scene, &posed));
        }
        let rays = [
            self.resources.buffers.get("bvhNodes"),
            self.resources.buffers.get("bvhTriangles"),
        ];
        let emitters = self
            .resources
            .buffers
            .get("emitters")
            .filter(|_| self.emitters.move_in(&scene));
        // Emitters of rigid bodies need no vertices: these are all of the scene's.
        if rays[0].is_none() && (emitters.is_none() || scene.deformers.is_empty()) {
            list.extend(
                emitters.map(|buffer| Update::all(buffer, self.emitters.buffer(&self.sent, None))),
            );
            return Ok(list);
        }
        let (positions, _, indices, first_index) = vertices(&scene, &posed);
        if let Some(buffer) = emitters {
            let moved =
                (!scene.deformers.is_empty()).then_some((positions.as_slice(), indices.as_slice()));
            list.push(Update::all(buffer, self.emitters.buffer(&self.sent, moved)));
        }
        if let [Some(nodes), Some(triangles)] = rays {
            let draws = draws(&scene, &first_index);
            let masked = |d: &DrawBlock| is_masked(&scene, d);
            let soup = Soup {
                positions: &positions,
                indices: &indices,
                draws: &draws,
                first_index: &first_index,
                masked: &masked,
            };
            let found = hierarchy(&soup, &self.emitters, &self.sent);
            list.push(Update::all(nodes, found.nodes));
            list.push(Update::all(triangles, found.triangles));
        }
        Ok(list)
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
        self.lighting.lights = list.to_vec();
        self.lighting.sky = sky;
        self.relit()
    }

    /// Buffers that change with the rotation of the sky's picture, degrees about y.
    pub fn turn_sky(&mut self, rotation: f32) -> Vec<Update> {
        if let Some(environment) = &mut self.lighting.environment {
            environment.rotation = rotation;
        }
        self.relit()
    }

    fn relit(&mut self) -> Vec<Update> {
        let (light_blocks, shadow_blocks) = self.lighting.blocks(self.bounds, self.origin);
        self.info = self.lighting.inform(self.info);
        let contents: [(&str, &[u8]); 3] = [
            ("lights", bytemuck::cast_slice(&light_blocks)),
            ("shadowViews", bytemuck::cast_slice(&shadow_blocks)),
            ("sceneInfo", bytemuck::bytes_of(&self.info)),
        ];
        let buffer = |name: &str| self.resources.buffers.get(name).cloned();
        contents
            .iter()
            .filter_map(|(name, bytes)| Some(Update::all(&buffer(name)?, bytes.to_vec())))
            .collect()
    }

    /// The block `sceneInfo` as it is.
    pub fn info(&self) -> Option<Update> {
        let buffer = self.resources.buffers.get("sceneInfo")?;
        Some(Update::all(buffer, bytemuck::bytes_of(&self.info).to_vec()))
    }
}

/// The hierarchy over triangles in the pose of these instances.
fn hierarchy(soup: &Soup<'_>, emitters: &Emitters, instances: &[InstanceBlock]) -> bvh::Hierarchy {
    let model = |i: u32| {
        instances
            .get(i as usize)
            .map_or(Mat4::IDENTITY, |b| Mat4::from_cols_array(&b.model))
    };
    bvh::build(soup, emitters, &model)
}

/// [`hierarchy`] over all triangles of a scene that was uploaded before, at 0 s.
fn scene_hierarchy(
    scene: &Scene,
    emitters: &Emitters,
    instances: &[InstanceBlock],
) -> bvh::Hierarchy {
    let (positions, _, indices, first_index) = vertices(scene, &scene.posed_meshes(0.0));
    let draws = draws(scene, &first_index);
    let masked = |d: &DrawBlock| is_masked(scene, d);
    let soup = Soup {
        positions: &positions,
        indices: &indices,
        draws: &draws,
        first_index: &first_index,
        masked: &masked,
    };
    hierarchy(&soup, emitters, instances)
}

/// The buffers of a hierarchy, with room for that of any other pose.
fn ray_buffers(
    upload: &mut Upload,
    found: bvh::Hierarchy,
    info: &SceneInfoBlock,
) -> Result<[(&'static str, Arc<Buffer>); 2]> {
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let bvh::Hierarchy {
        mut nodes,
        mut triangles,
    } = found;
    let (most_nodes, most_triangles) = bvh::capacity(info.triangle_count as usize);
    nodes.resize(nodes.len().max(most_nodes), 0);
    triangles.resize(triangles.len().max(most_triangles), 0);
    Ok([
        ("bvhNodes", upload.buffer("bvhNodes", &nodes, storage)?),
        (
            "bvhTriangles",
            upload.buffer("bvhTriangles", &triangles, storage)?,
        ),
    ])
}

fn is_masked(scene: &Scene, draw: &DrawBlock) -> bool {
    scene
        .materials
        .get(draw.material as usize)
        .is_some_and(|m| m.alpha_cutoff > 0.0)
}

/// Positions (3 floats), attributes (3 vec4), indices of all meshes one after another with these
/// vertices, and each mesh's first index.
fn vertices(
    scene: &Scene,
    posed: &[Cow<'_, [Vertex]>],
) -> (Vec<f32>, Vec<Attributes>, Vec<u32>, Vec<u32>) {
    let (mut positions, mut attributes, mut indices, mut first) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (mesh, vertices) in scene.meshes.iter().zip(posed) {
        let base = u32::try_from(positions.len() / 3).unwrap_or(u32::MAX);
        first.push(u32::try_from(indices.len()).unwrap_or(u32::MAX));
        positions.extend(vertices.iter().flat_map(|v| v.position));
        attributes.extend(vertices.iter().map(attributes::of));
        indices.extend(mesh.indices.iter().map(|i| base + i));
    }
    (positions, attributes, indices, first)
}

/// One draw for each part of each instance, opaque ones first.
fn draws(scene: &Scene, first_index: &[u32]) -> Vec<DrawBlock> {
    let mut list = Vec::new();
    for (i, instance) in (0u32..).zip(&scene.instances) {
        let Some(mesh) = scene.meshes.get(instance.mesh as usize) else {
            continue;
        };
        for submesh in mesh.submeshes.iter().filter(|p| p.index_count > 0) {
            list.push(DrawBlock {
                instance: i,
                material: submesh.material,
                first_index: first_index[instance.mesh as usize] + submesh.first_index,
                index_count: submesh.index_count,
            });
        }
    }
    list.sort_by_key(|d| is_masked(scene, d));
    list
}

/// (draw, first of its indices) of every triangle, draw by draw. Neighbours in space are neighbours
/// in the list. The order depends on the content of triangles alone, because it decides which of
/// two coincident ones is visible.
fn triangles(
    draws: &[DrawBlock],
    indices: &[u32],
    positions: &[f32],
    attributes: &[Attributes],
) -> Vec<[u32; 2]> {
    let position = |i: u32| -> [f32; 3] {
        std::array::from_fn(|k| positions[3 * indices[i as usize] as usize + k])
    };
    let content = |first: u32| -> [[u32; 15]; 3] {
        std::array::from_fn(|k| {
            let vertex = indices[first as usize + k] as usize;
            let numbers = positions[3 * vertex..3 * vertex + 3]
                .iter()
                .chain(&attributes[vertex]);
            let mut words = [0; 15];
            words
                .iter_mut()
                .zip(numbers)
                .for_each(|(w, n)| *w = n.to_bits());
            words
        })
    };
    // Instances of one mesh have the same triangles.
    let mut sorted: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
    let mut list = Vec::new();
    for (number, draw) in (0u32..).zip(draws) {
        let order = sorted
            .entry((draw.first_index, draw.index_count))
            .or_insert_with(|| {
                let firsts = (draw.first_index..draw.first_index + draw.index_count).step_by(3);
                let middle = |first: u32| {
                    let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(position(first + k)));
                    (a + b + c) / 3.0
                };
                let (low, high) = firsts.clone().map(middle).fold(
                    (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN)),
                    |(low, high), p| (low.min(p), high.max(p)),
                );
                let scale = 1023.0 / (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
                let mut keyed: Vec<(u32, u32)> = firsts
                    .map(|f| (morton((middle(f) - low) * scale), f))
                    .collect();
                keyed.sort_by(|a, b| a.0.cmp(&b.0).then_with(|| content(a.1).cmp(&content(b.1))));
                keyed.into_iter().map(|(_, first)| first).collect()
            });
        list.extend(order.iter().map(|first| [number, *first]));
    }
    list
}

/// Interleaves the bits of three numbers below 1024: neighbours in space have neighbouring codes
/// (Morton 1966).
fn morton(p: Vec3) -> u32 {
    let spread = |v: f32| (0..10).fold(0, |word, bit| word | (v as u32 >> bit & 1) << (3 * bit));
    spread(p.x) | spread(p.y) << 1 | spread(p.z) << 2
}

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
