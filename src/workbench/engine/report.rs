//! Messages from the engine to the window.

use super::error_worker::ErrorResult;
use crate::diagnostics::Diagnostic;
use crate::graph::Graph;
use crate::graph::expr::Env;
use crate::graph::link::Linked;
use crate::graph::param::Params;
use crate::graph::plan::TexturePlan;
use crate::graph::run::Change;
use crate::graph::run::{FrameTimes, PassExecutables};
use crate::scene::Scene;
use crate::vulkan::Buffer;
use crate::workbench::read_back::Content;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// The device that the engine uses.
#[derive(Clone, Debug)]
pub struct DeviceReport {
    /// Name.
    pub name: String,
    /// Driver.
    pub driver: String,
}

/// Names of the resources that a pass uses.
#[derive(Clone, Debug, Default)]
pub struct PassUses {
    /// Number of the pass.
    pub pass: usize,
    /// Resources it reads, of this or the last frame.
    pub reads: Vec<String>,
    /// Resources it writes.
    pub writes: Vec<String>,
}

/// The graph of a side as it runs now.
#[derive(Clone)]
pub struct GraphInfo {
    /// The graph.
    pub graph: Arc<Graph>,
    /// Its passes with their shaders.
    pub linked: Arc<Vec<Linked>>,
    /// Scene, size and device, as its expressions see them.
    pub variables: Env,
    /// Its parameters with the values they were built with.
    pub params: Params,
    /// The textures as they were made, in the graph's order.
    pub textures: Vec<TexturePlan>,
    /// (name, bytes) of resources that exist.
    pub memory: Vec<(String, u64)>,
    /// Bytes of geometry and textures of the scene.
    pub scene_bytes: u64,
    /// Numbers of the passes that run, in order.
    pub passes: Vec<usize>,
    /// Reads and writes of the passes that run, in order.
    pub uses: Vec<PassUses>,
    /// Passes that do not run, and why.
    pub left_out: Vec<(usize, String)>,
    /// Resources that only passes which are off would write.
    pub empty: Vec<String>,
}

/// A session that a side runs from now on.
#[derive(Clone)]
pub struct BuiltReport {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// The running session.
    pub info: Arc<GraphInfo>,
    /// Numbers of objects kept and rebuilt.
    pub change: Change,
    /// From the start of the build to the swap.
    pub ms: f64,
    /// The sources' revision.
    pub revision: u64,
    /// Vulkan objects that live on the device: what grows is never let go.
    pub objects: usize,
}

/// A picture and the times of its frame.
#[derive(Clone)]
pub struct PictureReport {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// The request that it fulfils.
    pub request: u64,
    /// Revision of the files that it was made from.
    pub revision: u64,
    /// Whether it is the preview, shown until the graph's own picture is there.
    pub preview: bool,
    /// Counts the side's frames.
    pub frame: u64,
    /// When it was finished, as the engine saw it.
    pub finished: Instant,
    /// Frames that follow until the picture has converged, at most.
    pub left: u32,
    /// Frames from the change until the picture has converged, at most.
    pub asked: u32,
    /// Time of the scene, s.
    pub time: f64,
    /// Width and height.
    pub size: [u32; 2],
    /// RGBA, 8 bits each, in main memory. If the window takes pictures from the device, only on
    /// request.
    pub bytes: Option<Arc<Vec<u8>>>,
    /// The same on the device.
    pub shared: Option<Arc<Buffer>>,
    /// Times, without the picture.
    pub times: FrameTimes,
}

/// A message from the engine.
pub enum Report {
    /// A device was opened.
    Device(DeviceReport),
    /// A side runs something new.
    Built(BuiltReport),
    /// A build failed; what ran before runs on.
    Failed {
        /// 0 is A, 1 is B.
        side: usize,
        /// The errors, with their places.
        diagnostics: Vec<Diagnostic>,
        /// The sources' revision.
        revision: u64,
    },
    /// A side's parameters were set without building anything.
    Set {
        /// 0 is A, 1 is B.
        side: usize,
    },
    /// A and B restart together, because their pictures and times are not of the same frames.
    Restarted,
    /// A frame has finished.
    Picture(PictureReport),
    /// The pixels of a side's frame, now in main memory too.
    Pixels {
        /// 0 is A, 1 is B.
        side: usize,
        /// Counts the side's frames.
        frame: u64,
        /// RGBA, 8 bits each.
        bytes: Arc<Vec<u8>>,
    },
    /// A scene is being loaded: what, and the share done.
    Loading(String, f32),
    /// The files that the scene being loaded was read from, also when that failed.
    Reads(Vec<PathBuf>),
    /// A scene is there.
    Loaded(Arc<Scene>),
    /// A scene could not be loaded; the one before stays.
    LoadFailed(String),
    /// A resource for a tab.
    Content(Content),
    /// Messages of the graph's checks that failed.
    Checks(usize, Vec<String>),
    /// A capture was made, or why not.
    Captured(Result<PathBuf, String>),
    /// The driver's statistics of a side's pipelines, or the reason for having none.
    Statistics(usize, Result<Vec<PassExecutables>, String>),
    /// The error of a shown picture.
    Error(ErrorResult),
    /// The device failed, and what can be done: the engine waits.
    DeviceFailed(String),
    /// Something the user should know.
    Trouble(String),
}
