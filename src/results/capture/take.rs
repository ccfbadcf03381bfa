//! Takes a capture.

use super::manifest::{check_frames, files_below, hash_file};
use super::{
    EXPERIMENT, Image, MANIFEST, Manifest, Rendered, SCHEMA, SOURCES, SceneRecord, experiment_of,
    failed, render, scene_hash,
};
use crate::experiment::{Experiment, checked_name, resolved_text};
use crate::graph::Graph;
use crate::graph::link::Linked;
use crate::graph::link::generated;
use crate::graph::load::Folders;
use crate::graph::param::Params;
use crate::lab::{Lab, LabError, Loaded, Texels, camera_of, no_texture};
use crate::results::picture;
use crate::results::stats::Stats;
use crate::results::timers::{Rows, Timers, stamped};
use crate::scene::Scene;
use crate::shader::ShaderCompiler;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// A texture of the graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resource {
    /// Name of the texture.
    pub name: String,
    /// Mip level.
    pub mip: u32,
    /// Array layer.
    pub layer: u32,
}

/// Content of a capture in addition to the picture.
#[derive(Clone, Debug, Default)]
pub struct What {
    /// Additional textures.
    pub resources: Vec<Resource>,
    /// Frames to render, at least 1. `None`: as many as the graph needs to converge, or one if time
    /// advances.
    pub frames: Option<usize>,
    /// Time step between frames (s).
    pub step: f64,
    /// GPU times drawn on a second picture, timers.png.
    pub timers: Rows,
    /// Appends a number to the name if it is taken, as [`free_name`] does.
    pub numbered: bool,
}

/// The first of `name`, `name-2`, `name-3` and so on that no capture in `folder` uses.
pub fn free_name(folder: &Path, name: &str) -> String {
    let free = |n: &String| !folder.join(n).exists();
    let numbered = (2u32..).map(|i| format!("{name}-{i}"));
    std::iter::once(name.to_string())
        .chain(numbered)
        .find(free)
        .unwrap_or_else(|| name.to_string())
}

/// Renders an experiment from its first frame and stores pictures, sources, settings and
/// measurements in `folder/name`, atomically. `scene` is the opened scene, with or without the
/// experiment's changes. Returns the folder of the capture.
///
/// # Errors
/// An existing capture of that name; an invalid experiment; no space or permission.
pub fn take(
    lab: &Lab,
    experiment: &Experiment,
    scene: Arc<Scene>,
    what: &What,
    folder: &Path,
    name: &str,
) -> Result<PathBuf, LabError> {
    let name = checked_name(name)?;
    check_frames(what.frames.unwrap_or(1), what.step).map_err(LabError::Request)?;
    if !what.numbered && folder.join(&name).exists() {
        return Err(exists(&folder.join(&name)));
    }
    let Loaded { graph, linked, .. } = lab.home.load_of(experiment).map_err(LabError::Input)?;
    std::fs::create_dir_all(folder).map_err(|e| failed(folder, e))?;
    // The process id tells later whether the writing program still runs.
    let prefix = format!(".{name}.partial-{}-", std::process::id());
    let partial = tempfile::Builder::new().prefix(&prefix).tempdir_in(folder);
    let partial = partial.map_err(|e| failed(folder, e))?;
    let path = partial.path();

    let main = lab.home.graph_path(&experiment.graph);
    let graph_file = write_sources(&graph, &linked, &main, &lab.home.folders(), path)?;
    let scene = experiment.adapted(scene)?;
    write_experiment(experiment, &graph_file, &graph.params, &scene, path)?;
    // From here on only the capture's content is used, so that missing files are detected now.
    let resolved = experiment_of(path, &experiment.name)?;
    let scene = resolved.adapted(scene)?;
    let scene_record = SceneRecord {
        spec: experiment.scene.clone(),
        name: scene.name.clone(),
        sha256: scene_hash(&scene),
    };
    let named = |graph: &Graph| images_of(graph, &what.resources);
    let Rendered {
        images,
        frames,
        stats,
    } = render(lab, path, &resolved, scene, (what.frames, what.step), named)?;
    write_pictures(path, &images)?;
    write_timers(lab, what.timers, (&graph, &resolved), &stats, &images, path)?;
    write(&path.join("stats.json"), &json(&stats)?)?;
    let manifest = Manifest {
        schema: SCHEMA.into(),
        version: stats.version.clone(),
        device: stats.device.name.clone(),
        driver: stats.device.driver.clone(),
        when: rfc3339(SystemTime::now()),
        experiment: experiment.name.clone(),
        graph: graph_file,
        scene: scene_record,
        size: [experiment.size.0, experiment.size.1],
        frames,
        step: what.step,
        images: images.into_iter().map(|i| i.0).collect(),
        files: hashes(path)?,
    };
    write(&path.join(MANIFEST), &json(&manifest)?)?;
    finish(partial, folder, &name, what.numbered)
}

fn write_pictures(folder: &Path, images: &[(Image, Texels)]) -> Result<(), LabError> {
    for (image, texels) in images {
        let bytes = if image.file.ends_with(".png") {
            picture::png(texels)?
        } else {
            picture::exr(texels)?
        };
        write(&folder.join(&image.file), &bytes)?;
    }
    Ok(())
}

/// The timing overlay with the median times of each pass.
fn timers_of(
    rows: Rows,
    graph: &Graph,
    params: &Params,
    stats: &Stats,
    size: (u32, u32),
) -> Timers {
    let number = |name: &str| graph.passes.iter().position(|p| p.value.name.value == name);
    let medians: Vec<_> = stats
        .passes
        .iter()
        .filter_map(|p| Some((number(&p.name)?, p.gpu_ms.median)))
        .collect();
    let device = &stats.device.name;
    Timers::new(rows, graph, params, device, size.into(), &medians)
}

/// SHA-256 of every file below a folder, by relative path.
fn hashes(folder: &Path) -> Result<BTreeMap<String, String>, LabError> {
    let files = files_below(folder).map_err(|e| failed(folder, e))?;
    let hash = |file: String| {
        let hash = hash_file(&folder.join(&file)).map_err(|e| failed(folder, e))?;
        Ok((file, hash))
    };
    files.into_iter().map(hash).collect()
}

/// Renames a finished capture. Renaming never replaces a folder that has files.
fn publish(
    finished: &Path,
    folder: &Path,
    name: &str,
    numbered: bool,
) -> Result<PathBuf, LabError> {
    loop {
        let target = folder.join(if numbered {
            free_name(folder, name)
        } else {
            name.into()
        });
        match std::fs::rename(finished, &target) {
            Ok(()) => return Ok(target),
            // Another process took the name meanwhile.
            Err(_) if numbered && target.exists() => {}
            Err(_) if target.exists() => return Err(exists(&target)),
            Err(e) => return Err(failed(&target, e)),
        }
    }
}

/// A UTC time as RFC 3339, clamped to the years 1970 to 9999, because a device without a battery
/// may start in 1969.
fn rfc3339(time: SystemTime) -> String {
    const LAST: Duration = Duration::from_secs(253_402_300_799);
    humantime::format_rfc3339_seconds(time.clamp(UNIX_EPOCH, UNIX_EPOCH + LAST)).to_string()
}

fn exists(target: &Path) -> LabError {
    failed(target, "there is a capture of that name; choose another")
}

fn json(value: &impl serde::Serialize) -> Result<Vec<u8>, LabError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(LabError::making("JSON"))?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), LabError> {
    Ok(crate::files::write_whole(path, bytes)?)
}

/// Makes a temporary folder, which is private to its owner, as readable as other folders.
fn make_readable(path: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755))?;
    }
    let _ = path;
    Ok(())
}

/// Writes the picture with times, if there are any to draw.
fn write_timers(
    lab: &Lab,
    rows: Rows,
    (graph, experiment): (&Graph, &Experiment),
    stats: &Stats,
    images: &[(Image, Texels)],
    capture: &Path,
) -> Result<(), LabError> {
    let picture = images.iter().find(|i| i.0.file == "picture.png");
    if let Some((_, texels)) = picture.filter(|_| rows != Rows::None) {
        let params = experiment.params_over(&graph.params)?;
        let timers = timers_of(rows, graph, &params, stats, experiment.size);
        let bytes = picture::png(&stamped(&lab.gpu, texels, &timers)?)?;
        write(&capture.join("timers.png"), &bytes)?;
    }
    Ok(())
}

/// Gives the folder its name.
fn finish(
    partial: tempfile::TempDir,
    folder: &Path,
    name: &str,
    numbered: bool,
) -> Result<PathBuf, LabError> {
    let path = partial.path();
    make_readable(path).map_err(|e| failed(path, e))?;
    let target = publish(path, folder, name, numbered)?;
    // The folder has been renamed, so there is nothing left to clean up.
    let _ = partial.keep();
    Ok(target)
}

/// Writes the experiment with everything that it sets, on the capture's copy of the graph.
fn write_experiment(
    experiment: &Experiment,
    graph_file: &str,
    params: &Params,
    scene: &Scene,
    capture: &Path,
) -> Result<(), LabError> {
    let (camera, file) = (camera_of(experiment, scene)?, capture.join(EXPERIMENT));
    let mut resolved = experiment.clone();
    resolved.graph = graph_file.into();
    let text = resolved_text(&resolved, params, &camera, scene, &file)?;
    write(&file, text.as_bytes())
}

/// Writes every source file of the graph and its shaders where the program looks for them. Returns
/// the name of the graph's file.
fn write_sources(
    graph: &Graph,
    linked: &[Linked],
    main: &Path,
    folders: &Folders,
    capture: &Path,
) -> Result<String, LabError> {
    let sources = capture.join(SOURCES);
    let main_name = main
        .file_name()
        .and_then(|n| n.to_str())
        .ok_or_else(|| failed(main, "it is no graph file"))?;
    let mut wanted: BTreeMap<PathBuf, &str> = BTreeMap::new();
    for (file, text) in graph.sources.texts() {
        let name = match file == main {
            true => Path::new(main_name),
            false => file.strip_prefix(&folders.passes).unwrap_or(file),
        };
        let mut components = name.components();
        if components.any(|c| !matches!(c, Component::Normal(_))) {
            let why = "it lies outside the folder of graphs and cannot be captured; move it there";
            return Err(failed(file, why));
        }
        let other = wanted.insert(Path::new("passes").join(name), text);
        if other.is_some_and(|other| other != text) {
            let why = format!("an include has the name of the graph, '{main_name}'; rename one");
            return Err(failed(file, why));
        }
    }
    // Generated files depend on parameters. Files of other options are included, so that a capture
    // can be varied.
    let generated = generated(graph, &graph.params);
    let compiler = ShaderCompiler::new(&folders.shaders, None);
    let options = graph.params.list.iter().flat_map(|p| &p.files);
    let others: Vec<_> = options
        .filter_map(|file| compiler.texts(file, &generated).ok())
        .collect();
    let compiled = linked.iter().flat_map(|l| &l.stages).map(|s| &*s.texts);
    for (name, text) in others
        .iter()
        .chain(compiled)
        .flatten()
        .filter(|t| !generated.contains_key(t.0))
    {
        wanted.insert(Path::new("shaders").join(name), text);
    }
    // Graphs without shaders have an empty folder.
    std::fs::create_dir_all(sources.join("shaders")).map_err(|e| failed(&sources, e))?;
    for (file, text) in wanted {
        write(&sources.join(file), text.as_bytes())?;
    }
    Ok(main_name.to_string())
}

/// The pictures of a capture: the graph's results, then the requested textures.
fn images_of(graph: &Graph, resources: &[Resource]) -> Result<Vec<Image>, LabError> {
    let result = |name: &Option<String>, file: &str| {
        name.clone().map(|texture| Image {
            file: file.into(),
            texture,
            mip: 0,
            layer: 0,
        })
    };
    let mut images: Vec<Image> = result(&graph.output, "picture.png")
        .into_iter()
        .chain(result(&graph.hdr, "picture.exr"))
        .collect();
    for r in resources {
        if graph.texture(&r.name).is_none() {
            return Err(no_texture(graph, &r.name));
        }
        let part = |n: u32, what: &str| {
            if n > 0 {
                format!("-{what}{n}")
            } else {
                String::new()
            }
        };
        let file = format!(
            "resources/{}{}{}.exr",
            r.name,
            part(r.mip, "mip"),
            part(r.layer, "layer")
        );
        if !images.iter().any(|i| i.file == file) {
            images.push(Image {
                file,
                texture: r.name.clone(),
                mip: r.mip,
                layer: r.layer,
            });
        }
    }
    if images.is_empty() {
        let message = format!(
            "graph '{}' has neither `output` nor `hdr`; name a texture to capture",
            graph.name
        );
        return Err(LabError::Request(message));
    }
    Ok(images)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_outside_the_calendar_have_a_date() {
        let day = Duration::from_secs(86_400);
        assert_eq!(rfc3339(UNIX_EPOCH - 1000 * day), "1970-01-01T00:00:00Z");
        assert_eq!(rfc3339(UNIX_EPOCH + day), "1970-01-02T00:00:00Z");
        assert_eq!(
            rfc3339(UNIX_EPOCH + 4_000_000 * day),
            "9999-12-31T23:59:59Z"
        );
    }
}
