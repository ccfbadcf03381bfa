//! The named bindings of a compiled shader.

use super::access::{Access, accesses, stored_by_each, uniform_members};
use super::layout::Layout;
use super::sizes::check_sizes;
use super::spirv::instructions;
use crate::vulkan::Stage;
use spirq::prelude::*;
use spirq::spirv::{Dim, ExecutionMode as Mode, ImageFormat};
use spirq::ty::ScalarType;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Dimensionality of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// `2D`
    D2,
    /// `2DArray`
    D2Array,
    /// `3D`
    D3,
}

impl Shape {
    /// GLSL's type suffix.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Shape::D2 => "2D",
            Shape::D2Array => "2DArray",
            Shape::D3 => "3D",
        }
    }
}

/// Resource type of a binding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Resource {
    /// `uniform` block.
    Uniform,
    /// `buffer` block.
    Buffer {
        /// Whether it is read.
        read: bool,
        /// Whether it is written.
        write: bool,
    },
    /// `sampler*`
    Sampled {
        /// Dimensionality.
        shape: Shape,
        /// `*Shadow`
        compare: bool,
        /// `u*` or `i*`
        integer: bool,
    },
    /// `image*`
    Storage {
        /// Dimensionality.
        shape: Shape,
        /// The format qualifier with its graph name; `None` for write-only images without one.
        format: Option<&'static str>,
        /// Whether it is read.
        read: bool,
        /// Whether it is written.
        write: bool,
        /// Whether its size is queried.
        sized: bool,
    },
}

/// A binding of a shader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Name in GLSL.
    pub name: String,
    /// Binding number.
    pub binding: u32,
    pub resource: Resource,
    /// Memory layout of a buffer or uniform block.
    pub layout: Option<Arc<Layout>>,
    /// The bytes of a uniform block that may be read, as sorted (first, end) ranges; `None` if all
    /// may be.
    pub reads: Option<Vec<(u32, u32)>>,
}

/// The interface of one shader stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interface {
    pub bindings: Vec<Binding>,
    /// Ids of specialisation constants.
    pub constants: Vec<u32>,
    /// Whether it uses `pass.index`.
    pub push: bool,
    /// Workgroup size of a compute shader.
    pub local_size: [u32; 3],
    /// Bindings of images into which every thread of a compute shader stores at its global
    /// invocation id.
    pub covers: Vec<u32>,
    /// Locations a fragment shader writes.
    pub outputs: Vec<u32>,
    /// SPIR-V capabilities (section 3.31) by number.
    pub capabilities: Vec<u32>,
}

/// Maximum resources per stage; stages use consecutive ranges of binding numbers.
pub const MAX_BINDINGS: usize = 48;

impl Interface {
    /// Adds a descriptor. `members` are the read ones of a uniform block.
    fn bind(
        &mut self,
        var: &Variable,
        access: Access,
        members: Option<&Option<BTreeSet<u32>>>,
    ) -> std::result::Result<(), String> {
        let Variable::Descriptor {
            name,
            desc_bind,
            desc_ty,
            ty,
            nbind,
        } = var
        else {
            return Ok(());
        };
        let bind = desc_bind.bind();
        let name = name.clone().filter(|n| !n.is_empty());
        let name = name.or_else(|| block_name(ty)).unwrap_or_default();
        let taken = self.bindings.iter().any(|b| b.binding == bind);
        check_binding(&name, *nbind, taken || desc_bind.set() != 0)?;
        if self.bindings.len() >= MAX_BINDINGS {
            return Err(format!("a shader binds at most {MAX_BINDINGS} resources"));
        }
        let resource = resource(desc_ty, ty, access)
            .ok_or(format!("'{name}' is of a kind that graphs cannot bind"))?;
        let layout = Layout::of(ty).map(Arc::new);
        let reads = members.zip(layout.as_ref());
        let reads = reads.and_then(|(read, layout)| layout.bytes_of(read.as_ref()?));
        self.bindings.push(Binding {
            name,
            binding: bind,
            resource,
            layout,
            reads,
        });
        Ok(())
    }
}

fn check_binding(name: &str, count: u32, is_set: bool) -> std::result::Result<(), String> {
    if count != 1 {
        let what = "is an array of resources; bind them one by one, with names of their own";
        return Err(format!("'{name}' {what}"));
    }
    if is_set {
        let what = "has a set or binding of its own; leave out layout(set, binding)";
        return Err(format!("'{name}' {what}"));
    }
    Ok(())
}

fn local_size(entry: &EntryPoint, sizes: &mut [u32; 3]) {
    for mode in &entry.exec_modes {
        if matches!(mode.exec_mode, Mode::LocalSize | Mode::LocalSizeId) {
            for (size, operand) in sizes.iter_mut().zip(&mode.operands) {
                *size = match operand.value {
                    ConstantValue::U32(v) => v,
                    ConstantValue::S32(v) => v.cast_unsigned(),
                    _ => 1,
                };
            }
        }
    }
}

/// Reflects the interface of a module.
///
/// # Errors
/// Unsupported resource types.
pub fn reflect(words: &[u32], stage: Stage) -> std::result::Result<Interface, String> {
    check_sizes(words, &[]).map_err(|e| e.to_string())?;
    let entries = ReflectConfig::new()
        .spv(without_constant_operations(words))
        // All variables: the optimiser has removed unused ones, and the reflector misses array
        // lengths.
        .ref_all_rscs(true)
        .reflect()
        .map_err(|e| format!("reflection failed: {e}"))?;
    let (accesses, members) = (accesses(words), uniform_members(words));
    let entry = entries.first().ok_or("the shader has no entry point")?;
    let mut interface = Interface {
        bindings: vec![],
        constants: vec![],
        push: false,
        local_size: [1; 3],
        covers: stored_by_each(words).into_iter().collect(),
        outputs: vec![],
        capabilities: capabilities(words),
    };
    for var in &entry.vars {
        match var {
            Variable::Descriptor { desc_bind, .. } => {
                let number = &desc_bind.bind();
                let access = accesses.get(number).copied().unwrap_or_default();
                interface.bind(var, access, members.get(number))?;
            }
            Variable::PushConstant { ty, .. } if ty.nbyte().is_some_and(|n| n > 4) => {
                return Err(String::from(
                    "the only push constant is pass.index of params.glsl",
                ));
            }
            Variable::PushConstant { .. } => interface.push = true,
            Variable::SpecConstant { spec_id, .. } => interface.constants.push(*spec_id),
            Variable::Output { location, .. } if stage == Stage::Fragment => {
                interface.outputs.push(location.loc())
            }
            _ => {}
        }
    }
    local_size(entry, &mut interface.local_size);
    interface.bindings.sort_by(|a, b| a.name.cmp(&b.name));
    interface.outputs.sort_unstable();
    interface.outputs.dedup();
    Ok(interface)
}

/// Replaces every OpSpecConstantOp by a null constant (SPIR-V 1.6, section 3.52.7). The reflector
/// does not support all operations, and no interface depends on their values.
pub(super) fn without_constant_operations(words: &[u32]) -> Vec<u32> {
    const OP_CONSTANT_NULL: u32 = 46;
    const OP_SPEC_CONSTANT_OP: u32 = 52;
    let mut out = words[..words.len().min(5)].to_vec();
    for instruction in instructions(words) {
        match instruction {
            [first, ty, id, ..] if first & 0xffff == OP_SPEC_CONSTANT_OP => {
                out.extend([3 << 16 | OP_CONSTANT_NULL, *ty, *id])
            }
            other => out.extend(other),
        }
    }
    out
}

fn capabilities(words: &[u32]) -> Vec<u32> {
    const OP_CAPABILITY: u32 = 17;
    instructions(words)
        .filter_map(|i| match i {
            [first, capability] if first & 0xffff == OP_CAPABILITY => Some(*capability),
            _ => None,
        })
        .collect()
}

fn block_name(ty: &Type) -> Option<String> {
    ty.as_struct().and_then(|s| s.name.clone())
}

fn resource(kind: &DescriptorType, ty: &Type, access: Access) -> Option<Resource> {
    let Access {
        read,
        write,
        size: sized,
    } = access;
    match kind {
        DescriptorType::UniformBuffer() => Some(Resource::Uniform),
        DescriptorType::StorageBuffer(_) => Some(Resource::Buffer { read, write }),
        DescriptorType::CombinedImageSampler() => {
            let image = &ty.as_combined_image_sampler()?.sampled_image_ty;
            Some(Resource::Sampled {
                shape: shape(image.dim, image.is_array)?,
                compare: image.is_depth == Some(true),
                integer: matches!(image.scalar_ty, ScalarType::Integer { .. }),
            })
        }
        DescriptorType::StorageImage(_) => {
            let image = ty.as_storage_image()?;
            Some(Resource::Storage {
                shape: shape(image.dim, image.is_array)?,
                format: format(image.fmt)?,
                read,
                write,
                sized,
            })
        }
        _ => None,
    }
}

fn shape(dim: Dim, array: bool) -> Option<Shape> {
    match (dim, array) {
        (Dim::Dim2D, false) => Some(Shape::D2),
        (Dim::Dim2D, true) => Some(Shape::D2Array),
        (Dim::Dim3D, false) => Some(Shape::D3),
        _ => None,
    }
}

/// The graph name of a storage format; `Some(None)` if the shader declares none.
fn format(format: ImageFormat) -> Option<Option<&'static str>> {
    Some(Some(match format {
        ImageFormat::Unknown => return Some(None),
        ImageFormat::Rgba8 => "rgba8",
        ImageFormat::Rgba16f => "rgba16f",
        ImageFormat::Rgba32f => "rgba32f",
        ImageFormat::Rgba16 => "rgba16",
        ImageFormat::Rg16f => "rg16f",
        ImageFormat::Rg32f => "rg32f",
        ImageFormat::R16f => "r16f",
        ImageFormat::R32f => "r32f",
        ImageFormat::R8 => "r8",
        ImageFormat::Rg8 => "rg8",
        ImageFormat::R11fG11fB10f => "r11g11b10f",
        ImageFormat::Rgb10A2 => "rgb10a2",
        ImageFormat::R32ui => "r32ui",
        ImageFormat::Rg32ui => "rg32ui",
        ImageFormat::Rgba32ui => "rgba32ui",
        ImageFormat::Rgba8ui => "rgba8ui",
        ImageFormat::R16ui => "r16ui",
        ImageFormat::R8ui => "r8ui",
        ImageFormat::R32i => "r32i",
        _ => return None,
    }))
}
