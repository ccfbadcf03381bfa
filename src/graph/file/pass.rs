//! Passes.

use super::resource::{Bind, Compare, Path};
use crate::diagnostics::{Entries, Items, Loc, nested, offset_in_file};
use crate::graph::expr::Ex;
use crate::vulkan::Blend;
use serde::Deserialize;

/// An item of `passes`.
#[derive(Clone, Debug)]
pub enum PassItem {
    /// A pass.
    Pass(Box<PassDecl>),
    /// Passes that share a stage, a condition, or when they rest.
    Group(Box<Group>),
}

impl<'de> Deserialize<'de> for PassItem {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct Probe {
            passes: Option<serde::de::IgnoredAny>,
        }
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        // Anything but a struct is reported as a bad pass.
        let probe = crate::diagnostics::options().from_str::<Probe>(raw.get_ron());
        match probe {
            Ok(Probe { passes: Some(_) }) => {
                nested(raw).map(|group| PassItem::Group(Box::new(group)))
            }
            _ => nested(raw).map(|pass| PassItem::Pass(Box::new(pass))),
        }
    }
}

/// Passes that share a stage, a condition, or when they rest.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// What tables of times count those under that say nothing else.
    pub stage: Option<String>,
    /// Condition of all passes of the group, in addition to their own.
    pub when: Option<Ex>,
    /// Frames until they converge; see [`PassDecl::settles`].
    pub settles: Option<Ex>,
    /// Frames after which they have converged; see [`PassDecl::converges`].
    pub converges: Option<Ex>,
    /// The passes, or groups again.
    pub passes: Items<PassItem>,
}

/// The passes of a list, with what their groups say.
pub fn ungrouped(items: Items<PassItem>) -> Vec<Loc<PassDecl>> {
    let of = |item: Loc<PassItem>| match item.value {
        PassItem::Pass(pass) => vec![Loc {
            value: *pass,
            at: item.at,
        }],
        PassItem::Group(group) => {
            let mut passes = ungrouped(group.passes);
            for pass in &mut passes {
                pass.value.stage = pass.value.stage.take().or_else(|| group.stage.clone());
                pass.value.outer.splice(0..0, group.when.clone());
                pass.value.settles = pass.value.settles.take().or_else(|| group.settles.clone());
                pass.value.converges = pass
                    .value
                    .converges
                    .take()
                    .or_else(|| group.converges.clone());
            }
            passes
        }
    };
    items.0.into_iter().flat_map(of).collect()
}

/// 32-bit words of VkDispatchIndirectCommand.
pub const DISPATCH_WORDS: u32 = 3;
/// 32-bit words of VkDrawIndirectCommand.
pub const DRAW_WORDS: u32 = 4;

/// A pass.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassDecl {
    /// Name, for people and timings.
    pub name: Loc<String>,
    /// The pass of an included file that it runs right after; where it is written when absent.
    pub after: Option<Loc<String>>,
    /// What tables of times count it under, where that is not its name.
    pub stage: Option<String>,
    /// Its own condition; see [`PassDecl::conditions`].
    #[serde(rename = "when")]
    pub own: Option<Ex>,
    /// Conditions of the enclosing groups.
    #[serde(skip)]
    pub outer: Vec<Ex>,
    /// For passes that accumulate over frames: frames without a change until the pass stops. The
    /// passes of a group stop together.
    pub settles: Option<Ex>,
    /// Frames from a fresh start until the accumulated result has converged; the value of `settles`
    /// when absent. A group counts once.
    pub converges: Option<Ex>,
    /// Whether it reads only geometry that stays as it is, of the resources in which other geometry
    /// moves ([`External::moves`](crate::graph::interface::External::moves)). Movement does not run it
    /// again.
    #[serde(default)]
    pub still: bool,
    /// Whether its compute shader writes every texel of the images that it only stores to, where that
    /// does not follow from one thread for each texel.
    #[serde(default)]
    pub replaces: bool,
    /// Shader files.
    #[serde(default)]
    pub shaders: Items<String>,
    /// Compute grid.
    pub dispatch: Option<Loc<Dispatch>>,
    /// The draw call.
    #[serde(default, deserialize_with = "draw")]
    pub draw: Option<Loc<Draw>>,
    /// Primitives.
    #[serde(default)]
    pub topology: Topology,
    /// Repetition over mips.
    pub each_mip: Option<Loc<EachMip>>,
    /// Repetition by a count.
    pub repeat: Option<Ex>,
    /// Resources of names in shaders, if they differ from the graph's names.
    #[serde(default)]
    pub bind: Entries<Bind>,
    /// Colour attachments by location.
    #[serde(default)]
    pub color: Items<ColorTarget>,
    /// Depth attachment.
    pub depth: Option<Loc<DepthTarget>>,
    /// Raster state.
    #[serde(default)]
    pub raster: Raster,
    /// The texture or buffer that is cleared.
    pub clear: Option<Loc<String>>,
    /// The value it is cleared to.
    pub value: Option<(f64, f64, f64, f64)>,
    /// Textures that are read in place of those it writes while it is off, where both have the same
    /// shape: a filter's input.
    #[serde(default)]
    pub instead: Entries<Loc<String>>,
}

impl PassDecl {
    /// It runs when all of them hold.
    pub fn conditions(&self) -> impl Iterator<Item = &Ex> {
        self.outer.iter().chain(&self.own)
    }

    /// The expressions that count frames.
    pub fn over_frames(&self) -> impl Iterator<Item = &Ex> {
        self.settles.iter().chain(&self.converges)
    }

    /// What tables of times count it under.
    pub fn stage(&self) -> &str {
        self.stage.as_deref().unwrap_or(&self.name.value)
    }

    /// The binding of a name in its shaders.
    pub fn bind(&self, name: &str) -> Option<&Bind> {
        self.bind
            .0
            .iter()
            .find(|(key, _)| key.value == name)
            .map(|(_, bind)| &bind.value)
    }

    /// The member that holds the sizes of its dispatch or draw, and 32-bit words there, if a buffer
    /// holds them.
    pub fn command(&self) -> Option<(&Loc<Path>, u32)> {
        match (
            self.dispatch.as_ref().map(|d| &d.value),
            self.draw.as_ref().map(|d| &d.value),
        ) {
            (Some(Dispatch::Indirect(command)), _) => Some((command, DISPATCH_WORDS)),
            (_, Some(Draw::Indirect(command))) => Some((command, DRAW_WORDS)),
            _ => None,
        }
    }

    /// All its expressions.
    pub fn expressions(&self) -> Vec<&Ex> {
        let mut list: Vec<&Ex> = self
            .conditions()
            .chain(self.over_frames())
            .chain(&self.repeat)
            .collect();
        if let Some(Dispatch::Threads(x, y, z) | Dispatch::Groups(x, y, z)) =
            self.dispatch.as_ref().map(|d| &d.value)
        {
            list.extend([x, y, z]);
        }
        list.extend(self.bind.0.iter().flat_map(|(_, bind)| &bind.value.mip));
        list.extend(
            self.color
                .0
                .iter()
                .flat_map(|target| target.value.mip.iter().chain(&target.value.layer)),
        );
        list.extend(self.depth.iter().flat_map(|d| &d.value.layer));
        list.extend(
            self.raster
                .size
                .iter()
                .flat_map(|size| [&size.value.0, &size.value.1]),
        );
        list.extend(&self.raster.samples);
        list
    }
}

/// Size of a compute grid.
#[derive(Clone, Debug, Deserialize)]
pub enum Dispatch {
    /// One thread a texel of a binding or texture.
    Cover(Loc<String>),
    /// Number of threads.
    Threads(Ex, Ex, Ex),
    /// Number of groups.
    Groups(Ex, Ex, Ex),
    /// Groups read from a buffer (VkDispatchIndirectCommand).
    Indirect(Loc<Path>),
}

/// Geometry of a raster pass.
#[derive(Clone, Debug, Deserialize)]
pub enum Draw {
    /// The scene's triangles.
    Scene {
        /// Which.
        #[serde(default)]
        what: Which,
    },
    /// One triangle over the whole picture.
    Fullscreen,
    /// Counts read from a buffer (VkDrawIndirectCommand).
    Indirect(Loc<Path>),
}

/// `Scene` alone is all of it.
fn draw<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<Loc<Draw>>, D::Error> {
    let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
    match raw.trim().get_ron() {
        text @ "Scene" => Ok(Some(Loc {
            value: Draw::Scene { what: Which::All },
            at: offset_in_file(text),
        })),
        _ => nested(raw),
    }
}

/// Which triangles of the scene.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Which {
    /// All.
    #[default]
    All,
    /// Draws without alpha mask.
    Opaque,
    /// Draws with alpha mask.
    Masked,
}

/// Primitives.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Topology {
    /// Triangles.
    #[default]
    Triangles,
    /// Points.
    Points,
    /// Lines.
    Lines,
    /// Patches of three vertices.
    Patches,
}

/// Repetition over the mips of a texture.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EachMip {
    /// The texture.
    pub texture: Loc<String>,
    /// First mip.
    #[serde(default)]
    pub from: u32,
}

/// A colour attachment.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColorTarget {
    /// The texture.
    pub to: Loc<String>,
    /// Cleared to this first; kept when absent.
    pub clear: Option<(f32, f32, f32, f32)>,
    /// The mip.
    pub mip: Option<Ex>,
    /// The layer.
    pub layer: Option<Ex>,
    /// Blending.
    #[serde(default)]
    pub blend: Blend,
}

/// A depth attachment.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthTarget {
    /// The texture.
    pub to: Loc<String>,
    /// Cleared to this first; kept when absent.
    pub clear: Option<f32>,
    /// The layer.
    pub layer: Option<Ex>,
    /// The test.
    pub test: Option<Compare>,
    /// Whether depth is written.
    #[serde(default = "yes")]
    pub write: bool,
}

fn yes() -> bool {
    true
}

/// Raster state.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Raster {
    /// Viewport without attachments.
    pub size: Option<Loc<(Ex, Ex)>>,
    /// Samples without attachments.
    pub samples: Option<Ex>,
    /// Culled faces.
    pub cull: Cull,
    /// Clamp depth instead of clipping.
    pub depth_clamp: bool,
    /// Conservative rasterisation.
    pub conservative: Option<Conservative>,
    /// No rasterisation.
    pub discard: bool,
}

/// Culling.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Cull {
    /// Both faces are drawn.
    #[default]
    None,
    /// Back faces are not.
    Back,
    /// Front faces are not.
    Front,
}

/// Conservative rasterisation by the device.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Conservative {
    /// Every touched pixel.
    Overestimate,
}
