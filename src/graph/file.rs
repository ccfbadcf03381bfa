//! What stands in a graph file, field by field.

use super::expr::Expr;
use super::param::Decl;
use super::table::TableDecl;
use crate::diagnostics::{Entries, Items, Loc, RawText, TwoOrThree, nested, offset_in_file};
use serde::Deserialize;

/// A graph file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GraphFile {
    /// Files whose sections come before this one's.
    pub include: Items<String>,
    /// Parameters.
    pub params: Items<Decl>,
    /// Other defaults for parameters of included files.
    pub defaults: Entries<RawText>,
    /// Parameters that the panel shows first: name, title in plain words.
    pub pinned: Entries<String>,
    /// Modules that nobody chooses: name, file in the shader folder.
    pub modules: Entries<String>,
    /// What to write instead of a parameter, or of `parameter=option`, that is no more.
    pub retired: Entries<String>,
    /// Expressions by name, for other expressions and shaders.
    pub values: Entries<ValueDecl>,
    /// Textures by name.
    pub textures: Entries<TextureDecl>,
    /// Buffers by name.
    pub buffers: Entries<BufferDecl>,
    /// Names that shaders bind, each for the first of its cases that holds.
    pub aliases: Entries<Vec<Loc<AliasDecl>>>,
    /// Names that shaders bind, each for a texture sampled in its own way.
    pub samplers: Entries<NamedSampler>,
    /// Passes and groups of them, in order.
    pub passes: Items<PassItem>,
    /// The display-encoded picture.
    pub output: Option<Loc<String>>,
    /// The linear picture.
    pub hdr: Option<Loc<String>>,
    /// Further results that may be asked for.
    pub outputs: Items<String>,
    /// Contributions to the linear picture that other graphs have too: part, texture.
    pub parts: Entries<String>,
    /// What the graph needs of the scene's geometry.
    pub scene: Option<Loc<SceneNeeds>>,
    /// Words of buffers that must be zero after a frame.
    pub checks: Items<CheckDecl>,
    /// Settings that make no sense together.
    pub refuse: Items<RefuseDecl>,
    /// What a picture is said to be made with: a line, where `{NAME}` is the value of a parameter.
    pub caption: Option<Loc<String>>,
    /// The `Vec2` parameter that a click on the picture sets.
    pub pointer: Option<Loc<String>>,
    /// Buffers that may be read as tables.
    pub tables: Items<TableDecl>,
    /// Settings worth comparing.
    pub compare: Items<CompareDecl>,
    /// Settings that show something worth looking into.
    pub views: Items<ViewDecl>,
    /// Parameters that cost time and quality, and the values worth trying.
    pub fit: Entries<Items<RawText>>,
    /// Settings from the ideal to the method: what each step costs is the method's error, split.
    #[serde(alias = "ladder")]
    pub ablation: Items<ViewDecl>,
    /// The voxels that the graph makes.
    pub voxels: Option<Loc<VoxelsDecl>>,
}

/// An expression with its place.
pub type Ex = Loc<Expr>;

/// What a name stands for.
#[derive(Clone, Debug, Deserialize)]
pub enum ValueDecl {
    /// A number.
    Float(Ex),
    /// A whole number.
    Int(Ex),
}

/// Geometry prepared for the graph.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneNeeds {
    /// World length (m) above which triangle edges are split at load.
    pub max_edge: Ex,
    /// When that is needed.
    pub when: Option<Ex>,
}

/// A word of a buffer that must be zero: `field`, or `buffer` and `word`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckDecl {
    /// The member of a buffer's block, `buffer.member`.
    pub field: Option<Loc<Path>>,
    /// The buffer.
    pub buffer: Option<Loc<String>>,
    /// Index of the 32-bit word.
    pub word: Option<u32>,
    /// A texture: the check is made where it is wanted. Always where nothing is said.
    pub with: Option<Loc<String>>,
    /// What it means when it is not zero, and what to do.
    pub message: String,
}

/// Settings that make no sense together.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RefuseDecl {
    /// When they do not.
    pub when: Ex,
    /// Why not, and what to do.
    pub message: String,
}

impl CheckDecl {
    /// The buffer.
    pub fn buffer(&self) -> &str {
        self.field.as_ref().map_or_else(|| self.buffer.as_ref().map_or("", |b| &b.value), |f| &f.value.buffer)
    }
}

/// A texture.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextureDecl {
    /// Two sizes for 2D, three for 3D.
    pub size: Size,
    /// A format, or a choice parameter whose options are formats.
    pub format: Loc<String>,
    /// Formats it may also be viewed as.
    #[serde(default)]
    pub views: Items<String>,
    /// Mip levels; 1 when absent.
    pub mips: Option<Ex>,
    /// Layers of a 2D array; a plain 2D texture when absent.
    pub layers: Option<Ex>,
    /// How it is sampled.
    pub sampler: Option<SamplerDecl>,
    /// Keep last frame's content beside this frame's.
    #[serde(default)]
    pub history: bool,
    /// Nothing is left in it from frame to frame; memory is shared.
    #[serde(default)]
    pub transient: bool,
}

/// Size of a texture: two expressions for 2D, three for 3D; with the name of a texture whose they are, until the graph is
/// whole.
#[derive(Clone, Debug)]
pub struct Size(pub Vec<Ex>, pub Option<Loc<String>>);

/// The words for a size.
#[derive(Deserialize)]
enum SizeWord {
    Screen,
    Like(Loc<String>),
}

impl<'de> Deserialize<'de> for Size {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        let text = raw.trim().get_ron();
        if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return nested(raw).map(|TwoOrThree::<Expr>(sizes)| Size(sizes, None));
        }
        let screen = |name| Loc { value: Expr::new(name), at: offset_in_file(text) };
        Ok(match nested(raw)? {
            SizeWord::Screen => Size(vec![screen("width"), screen("height")], None),
            SizeWord::Like(other) => Size(Vec::new(), Some(other)),
        })
    }
}

/// How a texture is sampled.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SamplerDecl {
    /// Between texels.
    pub filter: FilterMode,
    /// Between mips; as `filter` when absent.
    pub mip_filter: Option<FilterMode>,
    /// Outside [0, 1].
    pub address: AddressMode,
    /// Depth comparison.
    pub compare: Option<Compare>,
}

/// A texture sampled in its own way, under a name of its own.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedSampler {
    /// The texture.
    pub of: Loc<String>,
    /// Between texels.
    #[serde(default)]
    pub filter: FilterMode,
    /// Between mips; as `filter` when absent.
    pub mip_filter: Option<FilterMode>,
    /// Outside [0, 1].
    #[serde(default)]
    pub address: AddressMode,
    /// Depth comparison.
    pub compare: Option<Compare>,
}

/// A case of an alias: the fields of [`Bind`], and when it holds.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "as in Bind")]
pub struct AliasDecl {
    /// The condition; absent in the last case.
    pub when: Option<Ex>,
    pub of: Loc<String>,
    pub mip: Option<Ex>,
    pub layer: Option<Ex>,
    #[serde(rename = "as")]
    pub format: Option<Loc<String>>,
    #[serde(default)]
    pub history: bool,
    pub sampler: Option<SamplerDecl>,
}

/// Filtering.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FilterMode {
    /// The nearest texel.
    Nearest,
    /// Interpolated.
    #[default]
    Linear,
}

/// Addressing outside a texture.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum AddressMode {
    /// The edge texel.
    #[default]
    Clamp,
    /// Tiled.
    Repeat,
    /// Tiled and mirrored.
    Mirror,
    /// Zero.
    BorderZero,
    /// One.
    BorderOne,
}

/// A comparison.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "named after Vulkan's VkCompareOp")]
pub enum Compare {
    Never,
    Less,
    Equal,
    LessOrEqual,
    Greater,
    NotEqual,
    GreaterOrEqual,
    Always,
}

/// A buffer and, after a point, a member of its block as shaders declare it; after further points what is in that.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Path {
    /// The buffer.
    pub buffer: String,
    /// The member; empty where none is named.
    pub member: String,
}

impl std::fmt::Display for Path {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let point = if self.member.is_empty() { "" } else { "." };
        write!(f, "{}{point}{}", self.buffer, self.member)
    }
}

impl<'de> Deserialize<'de> for Path {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let (buffer, member) = text.split_once('.').unwrap_or((&text, ""));
        Ok(Path { buffer: buffer.into(), member: member.into() })
    }
}

/// Where the sizes of a dispatch or draw lie: `"buffer.member"`, or `"buffer", byte`.
#[derive(Clone, Debug)]
pub struct Command {
    /// The buffer, and the member.
    pub path: Loc<Path>,
    /// The byte, where no member says it.
    pub offset: Option<u64>,
}

impl<'de> Deserialize<'de> for Command {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = Command;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("\"buffer.member\", or \"buffer\" and a byte")
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut parts: A) -> Result<Command, A::Error> {
                let path = parts.next_element()?.ok_or_else(|| serde::de::Error::invalid_length(0, &self))?;
                Ok(Command { path, offset: parts.next_element()? })
            }
        }
        deserializer.deserialize_tuple(2, Visitor)
    }
}

/// Size of a buffer.
#[derive(Clone, Debug)]
pub enum BufferSize {
    /// Bytes.
    Bytes(Ex),
    /// That of the block as shaders declare it, with so many elements of the array at its end.
    Struct(Option<Ex>),
}

impl BufferSize {
    /// The expression in it.
    pub fn expression(&self) -> Option<&Ex> {
        match self {
            BufferSize::Bytes(ex) => Some(ex),
            BufferSize::Struct(count) => count.as_ref(),
        }
    }
}

/// The forms of [`BufferSize::Struct`] with a count.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum StructSize {
    Struct {
        /// Elements of the array at the end.
        of: Ex,
    },
}

impl<'de> Deserialize<'de> for BufferSize {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        match raw.trim().get_ron() {
            "Struct" => Ok(BufferSize::Struct(None)),
            text if text.starts_with(|c: char| c.is_ascii_alphabetic()) && !["true", "false"].contains(&text) => {
                let StructSize::Struct { of } = nested(raw)?;
                Ok(BufferSize::Struct(Some(of)))
            }
            _ => nested(raw).map(BufferSize::Bytes),
        }
    }
}

/// A buffer.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BufferDecl {
    /// Bytes.
    pub size: Loc<BufferSize>,
    /// Whether dispatches and draws read their size from it.
    #[serde(default)]
    pub indirect: bool,
    /// Two copies, this frame's and last frame's; see [`Bind`].
    #[serde(default)]
    pub history: bool,
    /// Nothing is left in it from frame to frame; memory is shared.
    #[serde(default)]
    pub transient: bool,
}

/// An item of `passes`.
#[derive(Clone, Debug)]
pub enum PassItem {
    /// A pass.
    Pass(Box<PassDecl>),
    /// Passes that share a stage, a condition, or when they rest.
    Group(Group),
}

impl<'de> Deserialize<'de> for PassItem {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct Probe {
            passes: Option<serde::de::IgnoredAny>,
        }
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        // What is no struct at all is told as a pass that it is not.
        let probe = crate::diagnostics::options().from_str::<Probe>(raw.get_ron());
        match probe {
            Ok(Probe { passes: Some(_) }) => nested(raw).map(PassItem::Group),
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
    /// Condition of all, beside their own.
    pub when: Option<Ex>,
    /// Frames after which they rest; see [`PassDecl::settles`].
    pub settles: Option<Ex>,
    /// The passes, or groups again.
    pub passes: Items<PassItem>,
}

/// The passes of a list, with what their groups say.
pub fn ungrouped(items: Items<PassItem>) -> Vec<Loc<PassDecl>> {
    let of = |item: Loc<PassItem>| match item.value {
        PassItem::Pass(pass) => vec![Loc { value: *pass, at: item.at }],
        PassItem::Group(group) => {
            let mut passes = ungrouped(group.passes);
            for pass in &mut passes {
                pass.value.stage = pass.value.stage.take().or_else(|| group.stage.clone());
                pass.value.outer.splice(0..0, group.when.clone());
                pass.value.settles = pass.value.settles.take().or_else(|| group.settles.clone());
            }
            passes
        }
    };
    items.0.into_iter().flat_map(of).collect()
}

/// A pass.
#[derive(Clone, Debug, Deserialize)]
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
    /// Conditions of the groups that it stands in.
    #[serde(skip)]
    pub outer: Vec<Ex>,
    /// It gathers over frames, and rests once nothing has changed for so many but what it leaves to itself. Those of a group
    /// rest together.
    pub settles: Option<Ex>,
    /// Shader files.
    #[serde(default)]
    pub shaders: Items<String>,
    /// Compute grid.
    pub dispatch: Option<Loc<Dispatch>>,
    /// What is drawn.
    #[serde(default, deserialize_with = "draw")]
    pub draw: Option<Loc<Draw>>,
    /// Primitives.
    #[serde(default)]
    pub topology: Topology,
    /// Repetition over mips.
    pub each_mip: Option<Loc<EachMip>>,
    /// Repetition by a count.
    pub repeat: Option<Ex>,
    /// What the shaders' names stand for, where they differ from the graph's.
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
    /// The mip that is cleared; all when absent.
    pub mip: Option<Ex>,
    /// The value it is cleared to.
    pub value: Option<(f64, f64, f64, f64)>,
    /// A copy.
    pub copy: Option<Loc<CopyDecl>>,
    /// A note to readers.
    pub comment: Option<String>,
}

impl PassDecl {
    /// It runs when all of them hold.
    pub fn conditions(&self) -> impl Iterator<Item = &Ex> {
        self.outer.iter().chain(&self.own)
    }

    /// What tables of times count it under.
    pub fn stage(&self) -> &str {
        self.stage.as_deref().unwrap_or(&self.name.value)
    }
}

/// Size of a compute grid.
#[derive(Clone, Debug, Deserialize)]
pub enum Dispatch {
    /// One thread a texel of a binding or texture.
    Cover(Loc<String>),
    /// So many threads.
    Threads(Ex, Ex, Ex),
    /// So many groups.
    Groups(Ex, Ex, Ex),
    /// Groups read from a buffer (VkDispatchIndirectCommand).
    Indirect(Command),
}

/// What a raster pass draws.
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
    /// So many vertices without a buffer.
    Vertices(Ex),
    /// Counts read from a buffer (VkDrawIndirectCommand).
    Indirect(Command),
}

/// `Scene` alone is all of it.
fn draw<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<Loc<Draw>>, D::Error> {
    let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
    match raw.trim().get_ron() {
        text @ "Scene" => Ok(Some(Loc { value: Draw::Scene { what: Which::All }, at: offset_in_file(text) })),
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
    /// Those without alpha mask.
    Opaque,
    /// Those with.
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

/// What a shader's name stands for.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bind {
    /// Texture or buffer.
    pub of: Loc<String>,
    /// One mip.
    pub mip: Option<Ex>,
    /// One layer.
    pub layer: Option<Ex>,
    /// Viewed as another format.
    #[serde(rename = "as")]
    pub format: Option<Loc<String>>,
    /// Last frame's content.
    #[serde(default)]
    pub history: bool,
    /// Sampled otherwise.
    pub sampler: Option<SamplerDecl>,
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
    pub blend: BlendMode,
}

/// Blending.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BlendMode {
    /// Replace.
    #[default]
    Off,
    /// Over.
    Alpha,
    /// Sum.
    Add,
    /// The smaller of both: does not depend on the order.
    Min,
    /// The larger of both: does not depend on the order.
    Max,
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
    /// Constant and slope bias.
    pub depth_bias: Option<(f32, f32)>,
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

/// A copy.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CopyDecl {
    /// From.
    pub from: Loc<String>,
    /// To.
    pub to: Loc<String>,
}

/// Two settings that the graph offers to put side by side.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CompareDecl {
    /// What a button says.
    pub title: String,
    /// One line.
    pub help: String,
    /// Parameters of the first.
    pub a: Entries<RawText>,
    /// Parameters of the second.
    pub b: Entries<RawText>,
}

/// Settings that the graph offers to look into its work.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewDecl {
    /// What a button says.
    pub title: String,
    /// One line.
    pub help: String,
    /// Parameters that it sets.
    pub set: Entries<RawText>,
}

/// Voxels that a graph makes, for comparing them with what its triangles exactly overlap.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VoxelsDecl {
    /// 3D texture whose first channel is not zero in occupied cells.
    pub occupied: Loc<String>,
    /// 3D texture of linear base colour; alpha is opacity.
    pub color: Loc<String>,
    /// 3D texture of the unit normal * 0.5 + 0.5.
    pub normal: Loc<String>,
    /// Buffer that says where the cells lie: a 32-bit word that is 1 where they are boxes, else 0; the z of the first of
    /// them in the textures; how many there are along x, y and z; then, as floats, the world coordinates (m) of their
    /// borders along x, y and z, one more than cells each.
    pub borders: Loc<String>,
    /// Ways of making them that are worth comparing.
    #[serde(default)]
    pub modes: Items<ViewDecl>,
}
