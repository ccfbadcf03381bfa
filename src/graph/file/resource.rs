//! Textures, buffers and their members, and names for them.

use crate::diagnostics::{Items, Loc, TwoOrThree, nested, offset_in_file};
use crate::graph::expr::{Ex, Expr};
use serde::Deserialize;

/// A texture.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextureDecl {
    /// Two sizes for 2D, three for 3D.
    pub size: Size,
    /// A format, or a choice parameter with formats as options.
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
    /// Keep last frame's content in a second copy.
    #[serde(default)]
    pub history: bool,
    /// Nothing is left in it from frame to frame; memory is shared.
    #[serde(default)]
    pub transient: bool,
    /// What its texels are, for people.
    #[serde(default)]
    pub help: String,
    /// Names of the parts of a volume that consists of several.
    #[serde(default)]
    pub parts: Parts,
}

/// Names of volumes that share a texture, one after the other along x and along z. Each is a cube
/// with the edge of the texture's height.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Parts {
    /// Along x.
    pub x: Items<String>,
    /// Along z.
    pub z: Items<String>,
}

impl TextureDecl {
    /// All its expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Ex> {
        self.size.0.iter().chain(&self.mips).chain(&self.layers)
    }

    /// Whether it is 3D.
    pub fn is_volume(&self) -> bool {
        self.size.0.len() == 3
    }
}

/// Size of a texture: two expressions for 2D, three for 3D. Until the graph is complete, it may be
/// the name of a texture of the same size.
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
        let screen = |name| Loc {
            value: Expr::new(name),
            at: offset_in_file(text),
        };
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
    #[serde(rename = "as")]
    pub format: Option<Loc<String>>,
    #[serde(default)]
    pub history: bool,
    pub sampler: Option<SamplerDecl>,
}

/// The resource of a name in shaders.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bind {
    /// Texture or buffer.
    pub of: Loc<String>,
    /// One mip.
    pub mip: Option<Ex>,
    /// Viewed as another format.
    #[serde(rename = "as")]
    pub format: Option<Loc<String>>,
    /// Last frame's content.
    #[serde(default)]
    pub history: bool,
    /// Sampled otherwise.
    pub sampler: Option<SamplerDecl>,
}

impl NamedSampler {
    /// The texture with this sampler.
    pub fn bind(self) -> Bind {
        Bind {
            of: self.of,
            mip: None,
            format: None,
            history: false,
            sampler: Some(SamplerDecl {
                filter: self.filter,
                mip_filter: self.mip_filter,
                address: self.address,
                compare: self.compare,
            }),
        }
    }
}

impl Bind {
    /// With the additions of a pass.
    pub fn narrowed(&self, by: &Bind) -> Bind {
        Bind {
            of: self.of.clone(),
            mip: by.mip.clone().or(self.mip.clone()),
            format: by.format.clone().or(self.format.clone()),
            history: by.history || self.history,
            sampler: by.sampler.or(self.sampler),
        }
    }
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

/// Size of a buffer.
#[derive(Clone, Debug)]
pub enum BufferSize {
    /// Bytes.
    Bytes(Ex),
    /// Size of the block as shaders declare it, with this number of elements in the array at its
    /// end.
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
            text if text.starts_with(|c: char| c.is_ascii_alphabetic())
                && !["true", "false"].contains(&text) =>
            {
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

/// A buffer and, after a point, a member of its block as shaders declare it. Further points lead
/// into structs.
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
        Ok(Path {
            buffer: buffer.into(),
            member: member.into(),
        })
    }
}
