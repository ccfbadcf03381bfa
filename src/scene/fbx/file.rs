//! From a file's bytes to a ufbx document, with bounds on memory and depth.

use ufbx::{
    AllocatorOpts, CoordinateAxes, ErrorType, FileFormat, InheritModeHandling, LoadOpts,
    ProgressCb, ProgressResult, SceneRoot, load_memory,
};

use crate::scene::progress::Progress;

/// Memory that any file may use.
const MEMORY: usize = 256 << 20;
/// Additional memory per byte of the file: arrays are compressed, and numbers become 64 bits.
const PER_BYTE: usize = 64;
/// Header of a binary file; ufbx does not recognise very short ones.
const MAGIC: &[u8] = b"Kaydara FBX Binary";
/// Maximum depth of the node hierarchy.
const MAX_DEPTH: u32 = 512;

/// Limits memory by the file's length in bytes.
pub(super) fn memory(bytes: usize) -> AllocatorOpts {
    AllocatorOpts {
        memory_limit: MEMORY.saturating_add(bytes.saturating_mul(PER_BYTE)),
        ..AllocatorOpts::default()
    }
}

/// Reads a document in metres with y up; the transform of the root node holds the conversion.
pub(super) fn read(bytes: &[u8], progress: Progress) -> Result<SceneRoot, String> {
    let ask = |_: &ufbx::Progress| match progress.stopped() {
        true => ProgressResult::Cancel,
        false => ProgressResult::Continue,
    };
    let options = LoadOpts {
        temp_allocator: memory(bytes.len()),
        result_allocator: memory(bytes.len()),
        progress_cb: ProgressCb::Ref(&ask),
        node_depth_limit: MAX_DEPTH,
        file_format: if bytes.starts_with(MAGIC) {
            FileFormat::Fbx
        } else {
            FileFormat::Unknown
        },
        no_format_from_extension: true,
        evaluate_skinning: true,
        generate_missing_normals: true,
        use_blender_pbr_material: true,
        inherit_mode_handling: InheritModeHandling::HelperNodes,
        target_axes: CoordinateAxes::right_handed_y_up(),
        target_unit_meters: 1.0,
        ..LoadOpts::default()
    };
    let file = load_memory(bytes, options).map_err(|error| match error.type_ {
        ErrorType::EmptyFile | ErrorType::UnrecognizedFileFormat if !bytes.starts_with(MAGIC) => not_fbx(),
        ErrorType::MemoryLimit => {
            format!("it needs more than {MEMORY} bytes of memory and {PER_BYTE} for each of its own. Export it again")
        }
        ErrorType::NodeDepthLimit => format!("its nodes are nested more than {MAX_DEPTH} deep"),
        _ => format!("it cannot be read ({}). Export it again", error.description.to_lowercase()),
    })?;
    if file.metadata.file_format == FileFormat::Fbx {
        Ok(file)
    } else {
        Err(not_fbx())
    }
}

fn not_fbx() -> String {
    "it is no FBX file. Check the file, or export it again".into()
}
