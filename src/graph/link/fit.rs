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
            ExternalKind::Storage => (
                matches!(resource, Resource::Buffer { write: false, .. }),
                "a read-only buffer",
            ),
            ExternalKind::TextureArray => {
                let array = Resource::Sampled {
                    shape: Shape::D2Array,
                    compare: false,
                    integer: false,
                };
                (*resource == array, "a sampler2DArray")
            }
        };
        return match fits {
            true => Ok(Target::External(i)),
            false => Err((
                format!("'{name}' is {expected} of the scene, and {}", declares()),
                None,
            )),
        };
    }
    if let Some(i) = graph.buffer(resource_name) {
        return match resource {
            Resource::Buffer { write: true, .. } if bind.is_some_and(|d| d.history) => {
                Err(read_only(resource_name))
            }
            Resource::Buffer { .. } | Resource::Uniform => Ok(Target::Buffer(i)),
            _ => Err((
                format!(
                    "'{resource_name}' is a buffer of the graph, and {}",
                    declares()
                ),
                None,
            )),
        };
    }
    if let Some(i) = graph.texture(resource_name) {
        let misfit = misfit(
            graph,
            resource_name,
            &graph.textures[i].1.value,
            bind,
            resource,
        );
        return misfit.map_or(Ok(Target::Texture(i)), Err);
    }
    let known = graph
        .resource_names()
        .chain(graph.aliases.iter().map(|a| a.name.as_str()));
    let known = known
        .chain(graph.interface.resources.iter().map(|e| e.name))
        .chain(pass.bind.0.iter().map(|b| b.0.value.as_str()));
    let help = nearest(name, known).unwrap_or_else(|| {
        format!("declare it in the graph, or rename it: bind: {{\"{name}\": (of: \"...\")}}")
    });
    let message = format!(
        "'{name}' is {} that neither the graph nor the scene declares",
        describe(resource)
    );
    Err((message, Some(help)))
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
    let view = bind
        .and_then(|d| d.format.as_ref())
        .unwrap_or(&texture.format)
        .value
        .as_str();
    let formats: Vec<Format> = match Format::named(view) {
        Some(f) => vec![f],
        None => {
            let options = graph
                .params
                .param(view)
                .map_or(&[][..], |p| p.kind.options());
            options.iter().filter_map(|o| Format::named(o)).collect()
        }
    };
    match resource {
        Resource::Storage {
            format,
            read,
            write,
            ..
        } => {
            if formats.iter().any(|f| f.is_depth()) {
                return Some((
                    format!("'{name}' is a depth texture, which cannot be a storage image"),
                    None,
                ));
            }
            if formats.iter().any(|f| f.name.ends_with("_srgb")) {
                return Some((
                    format!("'{name}' is sRGB-encoded, which a storage image cannot be"),
                    None,
                ));
            }
            if *write && bind.is_some_and(|d| d.history) {
                return Some(read_only(name));
            }
            match format {
                Some(declared) if formats.iter().any(|f| f.name != *declared) => {
                    let message =
                        format!("'{name}' has format {view}, and the shader declares {declared}");
                    match formats.len() {
                        1 => wrong(
                            message,
                            &format!("write layout({view}), or bind it as another declared view"),
                        ),
                        _ => wrong(
                            message,
                            "its format is a choice: write to a `writeonly` image without a format, and read by sampler",
                        ),
                    }
                }
                None if *read => wrong(
                    format!("'{name}' is read as an image without a format"),
                    &format!("write layout({view}), or mark it writeonly"),
                ),
                _ => None,
            }
        }
        Resource::Sampled {
            compare, integer, ..
        } => {
            let wants = formats
                .iter()
                .any(|f| matches!(f.channels, Channels::Uint | Channels::Int));
            if wants != *integer {
                let better = if wants {
                    "declare a usampler"
                } else {
                    "declare a sampler"
                };
                return wrong(
                    format!("'{name}' has format {view}, and {}", declares()),
                    better,
                );
            }
            let sampler = bind.and_then(|d| d.sampler).or(texture.sampler);
            let compares = sampler.is_some_and(|s| s.compare.is_some());
            if compares == *compare {
                return None;
            }
            let help = match compare {
                true => "bind it with sampler: (compare: less_or_equal)",
                false => {
                    "declare a Shadow sampler, or bind it with a sampler that does not compare"
                }
            };
            wrong(
                format!("the sampler of '{name}' does not fit: {}", declares()),
                help,
            )
        }
        _ => None,
    }
}
