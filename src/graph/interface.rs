//! The interface of a scene to every graph. The graph knows names and kinds. Their meaning is known
//! to the module that states them (`lab::interface`) and to shaders.

use crate::shader::Layout;
use crate::shader::layout::Member;
use std::ops::Range;

/// Resources that passes may bind, and variables that expressions may read.
#[derive(Debug, Default)]
pub struct SceneInterface {
    /// The block of parameters ([`PARAMS`]), then the scene's resources.
    pub resources: Vec<External>,
    /// Variables that have a value in every scene.
    pub variables: Vec<&'static str>,
}

/// Index of the block of parameters, which the graph itself fills.
pub const PARAMS: usize = 0;

/// Variables of a step: its mip, and its number among the repetitions of its pass.
const STEP_VARIABLES: [&str; 2] = ["mip", "index"];

/// Kind of an external resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExternalKind {
    /// A uniform block.
    Uniform,
    /// A read-only storage buffer.
    Storage,
    /// A sampled 2D array.
    TextureArray,
}

/// A resource that exists outside the graph.
#[derive(Clone, Debug)]
pub struct External {
    /// Name in shaders.
    pub name: &'static str,
    /// Kind.
    pub kind: ExternalKind,
    /// The struct that the program fills, if shaders must declare the same.
    pub block: Option<Block>,
    /// Whether a scene has it only for graphs that bind it.
    pub on_request: bool,
    /// Whether it changes only where geometry moves.
    pub moves: bool,
    /// Bytes that count frames. They differ in every frame, and alone keep no pass from resting.
    pub counters: Range<usize>,
}

/// A struct as the program fills it.
#[derive(Clone, Debug)]
pub struct Block {
    /// Members, with their offsets.
    pub members: Vec<Member>,
    /// Size.
    pub bytes: usize,
    /// Whether the resource ends with an array of it.
    pub is_element: bool,
}

impl SceneInterface {
    /// The interface of a scene with these resources and variables.
    pub fn new(scene: Vec<External>, variables: Vec<&'static str>) -> SceneInterface {
        let mut resources = vec![External::new("params", ExternalKind::Uniform)];
        resources.extend(scene);
        SceneInterface {
            resources,
            variables,
        }
    }

    /// Index of a resource.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.resources.iter().position(|e| e.name == name)
    }

    /// Names that expressions of every graph may use.
    pub fn all_variables(&self) -> impl Iterator<Item = &'static str> {
        self.variables.iter().copied().chain(STEP_VARIABLES)
    }

    /// Whether expressions of every graph may use a name.
    pub fn has_variable(&self, name: &str) -> bool {
        self.all_variables().any(|v| v == name)
    }
}

impl External {
    /// A resource without a struct.
    pub fn new(name: &'static str, kind: ExternalKind) -> External {
        External {
            name,
            kind,
            block: None,
            on_request: false,
            moves: false,
            counters: 0..0,
        }
    }

    /// A uniform block, which is this struct.
    pub fn uniform(name: &'static str, (members, bytes): (Vec<Member>, usize)) -> External {
        let block = Block {
            members,
            bytes,
            is_element: false,
        };
        External {
            block: Some(block),
            ..External::new(name, ExternalKind::Uniform)
        }
    }

    /// A storage buffer that ends with an array of this struct.
    pub fn list(name: &'static str, (members, bytes): (Vec<Member>, usize)) -> External {
        let block = Block {
            members,
            bytes,
            is_element: true,
        };
        External {
            block: Some(block),
            ..External::new(name, ExternalKind::Storage)
        }
    }

    /// Why a shader's declaration does not fit the struct, and the member concerned if it is one.
    /// Members of other names are the shader's own affair.
    pub(super) fn mismatch(&self, declared: &Layout) -> Option<(String, Option<String>)> {
        let (name, block) = (self.name, self.block.as_ref()?);
        let (declared, stride) = match block.is_element {
            true => element(declared)?,
            false => (declared, None),
        };
        let bytes = block.bytes;
        if let Some(stride) = stride.filter(|stride| *stride as usize != bytes) {
            let message = format!(
                "an element of '{name}' has {bytes} bytes, and the shader declares {stride}"
            );
            return Some((message, None));
        }
        for member in declared.members() {
            let end = member.offset.saturating_add(member.layout.bytes());
            let message = match block.members.iter().find(|m| m.name == member.name) {
                Some(known) if known.layout != member.layout => {
                    format!(
                        "is of type {}, and the shader declares {}",
                        known.layout, member.layout
                    )
                }
                Some(known) if known.offset != member.offset => {
                    format!(
                        "is at byte {}, and the shader declares it at {}",
                        known.offset, member.offset
                    )
                }
                None if end as usize > bytes => {
                    format!("ends at byte {end}, and there are {bytes}")
                }
                _ => continue,
            };
            return Some((
                format!("'{}' of '{name}' {message}", member.name),
                Some(member.name.clone()),
            ));
        }
        None
    }
}

/// The struct of the array that ends a block, and its stride.
fn element(block: &Layout) -> Option<(&Layout, Option<u32>)> {
    match &block.members().last()?.layout {
        Layout::Array { of, stride, .. } if !of.members().is_empty() => Some((of, Some(*stride))),
        _ => None,
    }
}
