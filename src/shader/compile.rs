//! GLSL to SPIR-V through shaderc. Compiled modules are cached on disk by the content of all their
//! inputs.

use super::access::decorated;
use super::debug::{DEBUG_FILE, numbered};
use super::macros::{Grown, check_growth, check_version};
use super::messages::{Message, messages};
use super::reflect::{Interface, MAX_BINDINGS, reflect};
use crate::diagnostics::excerpt::excerpt;
use crate::diagnostics::panics::caught;
use crate::diagnostics::{Diagnostic, Place, nearest};
use crate::vulkan::Stage;
use sha2::{Digest, Sha256};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// A shader file to compile.
#[derive(Clone, Debug)]
pub struct Source {
    /// File name in the shader folder.
    pub file: String,
    /// Stage.
    pub stage: Stage,
}

#[derive(Clone, Debug)]
pub struct Compiled {
    /// File name in the shader folder.
    pub file: String,
    pub stage: Stage,
    pub words: Arc<Vec<u32>>,
    pub interface: Interface,
    /// The text of every included file, by name relative to the shader folder.
    pub texts: Arc<BTreeMap<String, String>>,
}

/// Kept alive, because creating the tables of built-in functions takes a hundred times as long as
/// compiling.
static COMPILER: LazyLock<Result<shaderc::Compiler, shaderc::Error>> =
    LazyLock::new(shaderc::Compiler::new);

/// The last module of each (folder, name) in this process, so that an edit recompiles only affected
/// shaders.
static LAST: Mutex<BTreeMap<(PathBuf, String), Compiled>> = Mutex::new(BTreeMap::new());

/// Files generated from the graph, by include name: `params.glsl`, and one line per module that
/// includes the file of its selected option.
pub type Generated = BTreeMap<String, String>;

/// The include of a module, which expands to the file of its selected option.
pub fn module_include(name: &str) -> String {
    format!("modules/{name}.glsl")
}

/// Path of a file in a shader folder.
pub fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    is_inside(name)
        .then(|| folder.join(name))
        .filter(|path| path.is_file())
}

/// Whether a name stays inside its folder. Names come from untrusted graphs and shaders.
pub(crate) fn is_inside(name: &str) -> bool {
    Path::new(name)
        .components()
        .all(|c| matches!(c, std::path::Component::Normal(_)))
}

/// Compiles shaders of one folder. Each file is read once.
pub struct ShaderCompiler {
    folder: PathBuf,
    cache: Option<PathBuf>,
    /// Cached files, because most are included by many shaders.
    read: Mutex<HashMap<String, Read>>,
}

/// A file's text and includes, or its errors; `None` if the file does not exist.
type Read = Option<Result<Arc<Text>, Vec<Diagnostic>>>;

/// A text and the names that it includes.
struct Text(String, Vec<String>);

impl Text {
    fn new(text: String) -> Arc<Text> {
        let includes = text
            .lines()
            .filter_map(included)
            .map(String::from)
            .collect();
        Arc::new(Text(text, includes))
    }
}

/// Changed whenever cached modules of an older program become invalid.
const CACHE_VERSION: &str = "conelab spirv 2";
/// Shader files larger than this are refused.
pub(crate) const MAX_BYTES: u64 = 2 << 20;

/// Maximum includes of a shader, counted with repetition.
const MAX_INCLUDES: usize = 4096;
/// Start of the message about exceeding [`MAX_INCLUDES`].
const TOO_MANY: &str = "too many includes";
/// Maximum nesting depth of includes.
const MAX_DEPTH: usize = 32;

/// Options for shaders of a stage, and their kind.
fn options(
    stage: Stage,
) -> shaderc::Result<(shaderc::CompileOptions<'static>, shaderc::ShaderKind)> {
    let mut options = shaderc::CompileOptions::new()?;
    options.set_target_env(
        shaderc::TargetEnv::Vulkan,
        shaderc::EnvVersion::Vulkan1_3 as u32,
    );
    options.set_optimization_level(shaderc::OptimizationLevel::Performance);
    // Keeps the names of resources.
    options.set_generate_debug_info();
    options.set_auto_bind_uniforms(true);
    let (number, kind) = match stage {
        Stage::Vertex => (0, shaderc::ShaderKind::Vertex),
        Stage::TessControl => (1, shaderc::ShaderKind::TessControl),
        Stage::TessEvaluation => (2, shaderc::ShaderKind::TessEvaluation),
        Stage::Geometry => (3, shaderc::ShaderKind::Geometry),
        Stage::Fragment => (4, shaderc::ShaderKind::Fragment),
        Stage::Compute => (5, shaderc::ShaderKind::Compute),
    };
    for resource in [
        shaderc::ResourceKind::Sampler,
        shaderc::ResourceKind::Texture,
        shaderc::ResourceKind::Image,
        shaderc::ResourceKind::Buffer,
        shaderc::ResourceKind::StorageBuffer,
    ] {
        // Stages are compiled separately and share one descriptor set.
        options.set_binding_base(resource, number * MAX_BINDINGS as u32);
    }
    Ok((options, kind))
}

impl ShaderCompiler {
    /// A compiler for `folder`; `cache` stores compiled modules.
    pub fn new(folder: &Path, cache: Option<&Path>) -> ShaderCompiler {
        ShaderCompiler {
            folder: folder.to_path_buf(),
            cache: cache.map(Path::to_path_buf),
            read: Mutex::default(),
        }
    }

    /// Compiles one file.
    ///
    /// # Errors
    /// Every message of the compiler, with the original file and line.
    pub fn compile(
        &self,
        source: &Source,
        generated: &Generated,
    ) -> Result<Compiled, Vec<Diagnostic>> {
        let texts = self.texts(&source.file, generated)?;
        let name = (self.folder.clone(), source.file.clone());
        let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = last()
            .get(&name)
            .filter(|k| k.stage == source.stage && *k.texts == texts)
        {
            return Ok(known.clone());
        }
        let key = self.key(source, &texts);
        let cached = self
            .cache
            .as_ref()
            .map(|dir| dir.join(format!("{key}.spv")));
        // A cached module that cannot be read is recompiled.
        let from_cache = cached.as_deref().and_then(crate::files::read_checked);
        let from_cache = from_cache.and_then(|bytes| read_module(&bytes, source.stage));
        let (words, interface) = match from_cache {
            Some(found) => found,
            None => {
                let words = self.run(source, &texts)?;
                if let Some(path) = &cached {
                    let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
                    // A cache that cannot be written costs time, not correctness.
                    let _ = crate::files::write_checked(path, &bytes);
                }
                let interface = reflect(&words, source.stage).map_err(|message| {
                    let place = Place {
                        file: self.folder.join(&source.file),
                        ..Place::default()
                    };
                    vec![Diagnostic::error(place, message)]
                })?;
                (words, interface)
            }
        };
        let compiled = Compiled {
            file: source.file.clone(),
            stage: source.stage,
            words: Arc::new(decorated(&words)),
            interface,
            texts: Arc::new(texts),
        };
        last().insert(name, compiled.clone());
        Ok(compiled)
    }

    /// The files of a shader: name, text.
    pub fn texts(
        &self,
        file: &str,
        generated: &Generated,
    ) -> Result<BTreeMap<String, String>, Vec<Diagnostic>> {
        let mut texts = BTreeMap::new();
        self.collect(file, generated, &mut texts)?;
        Ok(texts)
    }

    fn find(&self, name: &str) -> Option<PathBuf> {
        find(&self.folder, name)
    }

    /// Reads a file and, textually, everything it includes.
    fn collect(
        &self,
        name: &str,
        generated: &Generated,
        texts: &mut BTreeMap<String, String>,
    ) -> Result<(), Vec<Diagnostic>> {
        if texts.contains_key(name) {
            return Ok(());
        }
        let text = match generated.get(name) {
            Some(text) => Text::new(text.clone()),
            None => self.read(name).unwrap_or_else(|| self.missing(name))?,
        };
        texts.insert(name.to_string(), text.0.clone());
        for include in &text.1 {
            // The compiler reports a missing include with its line.
            if generated.contains_key(include) || self.read(include).is_some() {
                self.collect(include, generated, texts)?;
            }
        }
        Ok(())
    }

    /// The text of a file, read once; `None` if it does not exist.
    fn read(&self, name: &str) -> Read {
        let known = || self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(read) = known().get(name) {
            return read.clone();
        }
        let read = self.find(name).map(|path| text_of(&path));
        known().insert(name.into(), read.clone());
        read
    }

    /// The error of a missing file. Names that lead out of the folder are not opened, because
    /// captures contain untrusted graphs.
    fn missing(&self, name: &str) -> Result<Arc<Text>, Vec<Diagnostic>> {
        if is_inside(name) {
            return text_of(&self.folder.join(name));
        }
        let place = Place {
            file: self.folder.clone(),
            ..Place::default()
        };
        Err(vec![Diagnostic::error(
            place,
            format!("the shader '{name}' leads out of this folder"),
        )])
    }

    fn key(&self, source: &Source, texts: &BTreeMap<String, String>) -> String {
        let mut hash = Sha256::new();
        hash.update(CACHE_VERSION);
        let (version, revision) = shaderc::get_spirv_version();
        hash.update(version.to_le_bytes());
        hash.update(revision.to_le_bytes());
        hash.update(&source.file);
        for (name, text) in texts {
            hash.update((name.len() as u64).to_le_bytes());
            hash.update(name);
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text);
        }
        crate::files::hex(&hash.finalize()[..16])
    }

    fn run(
        &self,
        source: &Source,
        texts: &BTreeMap<String, String>,
    ) -> Result<Vec<u32>, Vec<Diagnostic>> {
        let broken = |message: String| {
            let place = Place {
                file: self.folder.join(&source.file),
                ..Place::default()
            };
            vec![Diagnostic::error(place, message)]
        };
        let misused = |(file, line, message): (String, u32, String)| {
            let (place, source) = self.place(&file, line, texts);
            let found = Diagnostic::error(place, message);
            vec![Diagnostic { source, ..found }]
        };
        let (compiled, _) = numbered(&source.file, texts).map_err(misused)?;
        let compiled = &*compiled;
        let compiler = COMPILER.as_ref();
        let compiler = compiler.map_err(|e| broken(format!("the compiler did not start: {e}")))?;
        let (mut options, kind) = options(source.stage).map_err(|e| broken(e.to_string()))?;
        if texts.contains_key(DEBUG_FILE) {
            let stage = match source.stage {
                Stage::Fragment => "4",
                Stage::Compute => "5",
                _ => "0",
            };
            options.add_macro_definition("DEBUG_STAGE", Some(stage));
        }
        let main = compiled.get(&source.file).map_or("", String::as_str);
        // Files that include others twice grow exponentially with depth.
        let (count, chain) = (Cell::new(0), RefCell::new(Vec::new()));
        options.set_include_callback(move |name, _, _, depth| {
            let mut chain = chain.borrow_mut();
            chain.truncate(depth.saturating_sub(1));
            chain.push(name.to_string());
            count.set(count.get() + 1);
            if depth > MAX_DEPTH || count.get() > MAX_INCLUDES {
                let names = crate::diagnostics::excerpt::chain(&chain);
                return Err(format!(
                    "{TOO_MANY} ({MAX_INCLUDES} at most, {MAX_DEPTH} of them nested): {names}"
                ));
            }
            match compiled.get(name) {
                Some(content) => Ok(shaderc::ResolvedInclude {
                    resolved_name: name.to_string(),
                    content: content.clone(),
                }),
                None => {
                    let hint = nearest(name, self.includes().iter().map(String::as_str));
                    Err(format!("no such include; {}", hint.unwrap_or_default()))
                }
            }
        });
        let late = check_version(main).map_err(|(line, message)| Grown {
            file: source.file.clone(),
            line,
            message,
        });
        late.and_then(|()| check_growth(texts)).map_err(|grown| {
            let (place, source) = self.place(&grown.file, grown.line, texts);
            vec![Diagnostic {
                source,
                ..Diagnostic::error(place, grown.message)
            }]
        })?;
        match compiler.compile_into_spirv(main, kind, &source.file, "main", Some(&options)) {
            Ok(artifact) => Ok(artifact.as_binary().to_vec()),
            Err(e) => Err(self.messages(&e.to_string(), texts, &source.file)),
        }
    }

    /// Valid include names.
    fn includes(&self) -> Vec<String> {
        let mut names = vec![String::from("params.glsl")];
        let mut folders = vec![PathBuf::new()];
        while let Some(folder) = folders.pop() {
            // Deeper nested folders hold no shaders.
            let Ok(entries) = std::fs::read_dir(self.folder.join(&folder)) else {
                continue;
            };
            for entry in entries.flatten() {
                let name = folder.join(entry.file_name());
                match entry.file_type() {
                    Ok(kind) if kind.is_dir() && folder.components().count() < 4 => {
                        folders.push(name)
                    }
                    Ok(kind) if kind.is_file() => names.push(name.to_string_lossy().into_owned()),
                    _ => {}
                }
            }
        }
        names
    }

    /// A line of a file, and its text.
    fn place(
        &self,
        file: &str,
        line: u32,
        texts: &BTreeMap<String, String>,
    ) -> (Place, Option<String>) {
        let generated = || PathBuf::from(format!("{file} (generated)"));
        let text = texts.get(file);
        let text = text.and_then(|t| t.lines().nth(line.saturating_sub(1) as usize));
        let place = Place {
            file: self.find(file).unwrap_or_else(generated),
            line,
            column: 0,
        };
        (place, text.map(|l| l.trim().to_string()))
    }

    /// Splits the compiler's output into messages with their lines.
    fn messages(
        &self,
        text: &str,
        texts: &BTreeMap<String, String>,
        main: &str,
    ) -> Vec<Diagnostic> {
        let diagnostic = |found: Message| {
            let (place, source) = self.place(&found.file, found.line, texts);
            // Some messages print a whole type.
            let message = excerpt(&shortened(&found.text), 400);
            let diagnostic = match found.is_error {
                true => Diagnostic::error(place, message),
                false => Diagnostic::warning(place, message),
            };
            Diagnostic {
                source,
                ..diagnostic.help(found.help)
            }
        };
        let found = messages(text, texts).into_iter().map(diagnostic);
        let mut list: Vec<Diagnostic> = found.collect();
        if list.is_empty() {
            let place = Place {
                file: self.folder.join(main),
                ..Place::default()
            };
            list.push(Diagnostic::error(place, text.trim()));
        }
        list
    }
}

/// The text of a shader file.
fn text_of(path: &Path) -> Result<Arc<Text>, Vec<Diagnostic>> {
    let fail = |why: String| {
        let place = Place {
            file: path.to_path_buf(),
            ..Place::default()
        };
        vec![Diagnostic::error(place, format!("cannot read it: {why}"))]
    };
    let text = crate::files::read_input_text(path, MAX_BYTES).map_err(|e| fail(e.to_string()))?;
    if text.contains('\0') {
        Err(fail("it holds a zero byte".into()))
    } else {
        Ok(Text::new(text))
    }
}

/// The message without the members of printed types.
fn shortened(message: &str) -> String {
    let mut out = String::new();
    let mut depth = 0_u32;
    for c in message.chars() {
        match c {
            '{' => {
                if depth == 0 {
                    out.push_str("{...}");
                }
                depth += 1;
            }
            '}' => depth = depth.saturating_sub(1),
            _ if depth == 0 => out.push(c),
            _ => {}
        }
    }
    out
}

/// The name of an `#include "name"` line.
fn included(line: &str) -> Option<&str> {
    let rest = line
        .trim_start()
        .strip_prefix('#')?
        .trim_start()
        .strip_prefix("include")?;
    rest.split('"').nth(1)
}

/// A cached module with its interface; `None` for invalid bytes, on which the reflector may panic.
pub fn read_module(bytes: &[u8], stage: Stage) -> Option<(Vec<u32>, Interface)> {
    let words = to_words(bytes)?;
    let interface = caught(|| reflect(&words, stage)).ok()?.ok()?;
    Some((words, interface))
}

fn to_words(bytes: &[u8]) -> Option<Vec<u32>> {
    const MAGIC: u32 = 0x0723_0203;
    if !bytes.len().is_multiple_of(4) {
        return None;
    }
    let words: Vec<u32> = bytes
        .chunks_exact(4)
        .map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]))
        .collect();
    (words.first() == Some(&MAGIC)).then_some(words)
}

#[cfg(test)]
mod tests {
    use super::super::access::{Access, accesses};
    use super::super::reflect::without_constant_operations;
    use super::*;
    use crate::graph::load::Folders;
    use crate::lab::load;
    use rayon::prelude::*;
    use spirq::prelude::*;

    /// The qualifiers of storage buffers and images by binding.
    fn qualifiers(words: &[u32]) -> BTreeMap<u32, AccessType> {
        let entries = ReflectConfig::new()
            .spv(without_constant_operations(words))
            .ref_all_rscs(true)
            .reflect()
            .unwrap();
        let access = |var: &Variable| match var {
            Variable::Descriptor {
                desc_bind,
                desc_ty:
                    DescriptorType::StorageBuffer(access) | DescriptorType::StorageImage(access),
                ..
            } => Some((desc_bind.bind(), *access)),
            _ => None,
        };
        entries[0].vars.iter().filter_map(access).collect()
    }

    #[test]
    fn instructions_do_what_the_qualifiers_of_every_shader_say() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let folders = Folders {
            passes: root.join("passes"),
            shaders: root.join("shaders"),
        };
        let graph = load(&folders.passes.join("rays.ron"), &folders).unwrap();
        let generated = crate::graph::link::generated(&graph, &graph.params);
        let mut files: Vec<&String> = graph
            .passes
            .iter()
            .flat_map(|p| &p.value.shaders.0)
            .map(|s| &s.value)
            .collect();
        files.sort();
        files.dedup();
        let compiler = ShaderCompiler::new(&folders.shaders, None);
        let checked: usize = files
            .par_iter()
            .map(|file| {
                let source = Source {
                    file: (*file).clone(),
                    stage: Stage::of_file(file).unwrap(),
                };
                let words = compiler
                    .run(&source, &compiler.texts(file, &generated).unwrap())
                    .unwrap();
                let found = accesses(&words);
                let qualifiers = qualifiers(&words);
                for (binding, qualifier) in &qualifiers {
                    let Access { read, write, size } = found[binding];
                    let agrees = match qualifier {
                        // A buffer may be used only for its length.
                        AccessType::ReadOnly => !write,
                        AccessType::WriteOnly => !read && (write || size),
                        // Without qualifiers any access is possible.
                        AccessType::ReadWrite => true,
                    };
                    assert!(
                        agrees,
                        "{file}: binding {binding}: {qualifier:?}, {:?}",
                        found[binding]
                    );
                }
                // The accesses derived from the decorated module must be the same.
                assert_eq!(accesses(&decorated(&words)), found);
                for (binding, access) in self::qualifiers(&decorated(&words)) {
                    let Access { read, write, .. } = found[&binding];
                    let expected = match (read, write) {
                        (true, true) => AccessType::ReadWrite,
                        (false, true) => AccessType::WriteOnly,
                        _ => AccessType::ReadOnly,
                    };
                    assert_eq!(access, expected, "{file}: binding {binding}");
                }
                qualifiers.len()
            })
            .sum();
        assert!(checked > 60, "{checked}");
    }
}
