//! Compares declarations of shaders with resources.

use super::linked::Target;
use crate::diagnostics::nearest;
use crate::graph::definition::Graph;
use crate::graph::file::{Bind, PassDecl, TextureDecl};
use crate::graph::interface::ExternalKind;
use crate::shader::{Resource, Shape};
use crate::vulkan::format::{Channels, Format};

/// Why a declaration does not fit, and what would.
pub(super) type Misfit = (String, Option<String>);

/// The resource of a shader's name in a pass, after its `bind` or an alias.
///
/// # Errors
/// There is none of that name, or the shader declares something else.
pub(super) fn resolve(
    graph: &Graph,
    pass: &PassDecl,
    name: &str,
    bind: Option<&Bind>,
    resource: &Resource,
) -> Result<Target, Misfit> {
    let resource_name = bind.map_or(name, |d| d.of.value.as_str());
    let declares = || format!("the shader declares {}", describe(resource));
    if let Some(i) = graph.interface.index(resource_name) {
        let (fits, expected) = match graph.interface.resources[i].kind {
            ExternalKind::Uniform => (*resource == Resource::Uniform, "a uniform block"),
            ExternalKind::Storage => {
                let reads = matches!(resource, Resource::Buffer { write: false, .. });
                (reads, "a read-only buffer")
            }
            ExternalKind::TextureArray => (is_plain_array(resource), "a sampler2DArray"),
        };
        let message = || format!("'{name}' is {expected} of the scene, and {}", declares());
        return match fits {
            true => Ok(Target::External(i)),
            false => Err((message(), None)),
        };
    }
    if let Some(i) = graph.buffer(resource_name) {
        return match resource {
            Resource::Buffer { write: true, .. } if bind.is_some_and(|d| d.history) => {
                Err(read_only(resource_name))
            }
            Resource::Buffer { .. } | Resource::Uniform => Ok(Target::Buffer(i)),
            _ => {
                let what = "is a buffer of the graph";
                Err((
                    format!("'{resource_name}' {what}, and {}", declares()),
                    None,
                ))
            }
        };
    }
    if let Some(i) = graph.texture(resource_name) {
        let texture = &graph.textures[i].1.value;
        let misfit = misfit(graph, resource_name, texture, bind, resource);
        return misfit.map_or(Ok(Target::Texture(i)), Err);
    }
    let aliases = graph.aliases.iter().map(|a| a.name.as_str());
    let known = graph
        .resource_names()
        .chain(aliases)
        .chain(graph.interface.resources.iter().map(|e| e.name))
        .chain(pass.bind.0.iter().map(|b| b.0.value.as_str()));
    let help = nearest(name, known).unwrap_or_else(|| {
        format!("declare it in the graph, or rename it: bind: {{\"{name}\": (of: \"...\")}}")
    });
    let what = describe(resource);
    let message = format!("'{name}' is {what} that neither the graph nor the scene declares");
    Err((message, Some(help)))
}

fn is_plain_array(resource: &Resource) -> bool {
    *resource
        == Resource::Sampled {
            shape: Shape::D2Array,
            compare: false,
            integer: false,
        }
}

fn read_only(name: &str) -> Misfit {
    (format!("the history of '{name}' is read-only"), None)
}

/// A shader's declaration in words.
pub fn describe(resource: &Resource) -> String {
    match resource {
        Resource::Uniform => "a uniform block".into(),
        Resource::Buffer { write: true, .. } => "a buffer that it writes".into(),
        Resource::Buffer { .. } => "a buffer".into(),
        Resource::Sampled {
            shape,
            compare,
            integer,
        } => format!(
            "a {}sampler{}{}",
            if *integer { "u" } else { "" },
            shape.name(),
            if *compare { "Shadow" } else { "" }
        ),
        Resource::Storage { shape, format, .. } => {
            let format = format.map_or(String::from("without a format"), |f| {
                format!("of format {f}")
            });
            format!("an image{} {format}", shape.name())
        }
    }
}

/// Shape of a texture as a binding sees it.
pub fn bound_shape(texture: &TextureDecl) -> Shape {
    match &texture.layers {
        _ if texture.is_volume() => Shape::D3,
        Some(_) => Shape::D2Array,
        None => Shape::D2,
    }
}

/// Why a texture does not fit a shader's declaration.
fn misfit(
    graph: &Graph,
    name: &str,
    texture: &TextureDecl,
    bind: Option<&Bind>,
    resource: &Resource,
) -> Option<Misfit> {
    let wrong = |message: String, help: &str| Some((message, Some(help.into())));
    let declares = || format!("the shader declares {}", describe(resource));
    let (shape, wanted) = match resource {
        Resource::Sampled { shape, .. } | Resource::Storage { shape, .. } => {
            (*shape, bound_shape(texture))
        }
        _ => return Some((format!("'{name}' is a texture, and {}", declares()), None)),
    };
    if shape != wanted {
        let message = format!("'{name}' is {}, and {}", wanted.name(), declares());
        return wrong(message, &format!("declare it as {}", wanted.name()));
    }
    let view = bind.and_then(|d| d.format.as_ref());
    let view = view.unwrap_or(&texture.format).value.as_str();
    let param = graph.params.param(view);
    let options = param.map_or(&[][..], |p| p.kind.options());
    let options = options.iter().filter_map(|o| Format::named(o));
    let formats = Format::named(view).map_or_else(|| options.collect(), |f| vec![f]);
    match resource {
        Resource::Storage {
            format,
            read,
            write,
            ..
        } => {
            let to_history = *write && bind.is_some_and(|d| d.history);
            storage_misfit((name, view), &formats, *format, *read, to_history)
        }
        Resource::Sampled {
            compare, integer, ..
        } => {
            let is_integer = |f: &Format| matches!(f.channels, Channels::Uint | Channels::Int);
            let wants = formats.iter().any(is_integer);
            let sampler = bind.and_then(|d| d.sampler).or(texture.sampler);
            let compares = sampler.is_some_and(|s| s.compare.is_some());
            let format = format!("'{name}' has format {view}, and {}", declares());
            let unfit = format!("the sampler of '{name}' does not fit: {}", declares());
            match (wants, compares) {
                (true, _) if !integer => wrong(format, "declare a usampler"),
                (false, _) if *integer => wrong(format, "declare a sampler"),
                (_, false) if *compare => {
                    wrong(unfit, "bind it with sampler: (compare: less_or_equal)")
                }
                (_, true) if !compare => wrong(
                    unfit,
                    "declare a Shadow sampler, or bind it with a sampler that does not compare",
                ),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Why a texture does not fit an image. `format` is declared by the shader; `view` is the name of
/// the texture's format or of a parameter that chooses it.
fn storage_misfit(
    (name, view): (&str, &str),
    formats: &[Format],
    format: Option<&str>,
    read: bool,
    to_history: bool,
) -> Option<Misfit> {
    if formats.iter().any(|f| f.is_depth()) {
        let why = "is a depth texture, which cannot be a storage image";
        return Some((format!("'{name}' {why}"), None));
    }
    if formats.iter().any(|f| f.name.ends_with("_srgb")) {
        let why = "is sRGB-encoded, which a storage image cannot be";
        return Some((format!("'{name}' {why}"), None));
    }
    if to_history {
        return Some(read_only(name));
    }
    let (why, help) = match format {
        Some(declared) if formats.iter().any(|f| f.name != declared) => (
            format!("has format {view}, and the shader declares {declared}"),
            match formats.len() {
                1 => format!("write layout({view}), or bind it as another declared view"),
                _ => "its format is a choice: write to a `writeonly` image without a format, and read by sampler".into(),
            },
        ),
        None if read => (
            "is read as an image without a format".into(),
            format!("write layout({view}), or mark it writeonly"),
        ),
        _ => return None,
    };
    Some((format!("'{name}' {why}"), Some(help)))
}
