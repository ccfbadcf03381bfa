//! The buffer of shown values and failed checks of shaders (`shaders/common/debug.glsl`), which every
//! graph has without declaring it.

use super::expr::Expr;
use super::file::{BufferDecl, BufferSize, GraphFile, PassDecl};
use crate::diagnostics::{At, Loc};

/// The buffer.
pub(super) const DEBUG_BUFFER: &str = "debugRecord";
/// The pass that clears it. It runs if another pass that runs uses the buffer.
pub(super) const CLEAR: &str = "debug clear";

/// Sizes in the shader: bytes before the values, their number and bytes; the same of checks.
pub(super) const VALUES: (usize, usize, usize) = (4, 256, 24);
pub(super) const CHECKS: (usize, usize, usize) = (4 + 256 * 24, 16384, 8);

/// Adds the buffer and its clear to a graph, unless it declares a buffer of that name.
pub(super) fn declare(file: &mut GraphFile, passes: &mut Vec<Loc<PassDecl>>) {
    let declared = file.buffers.0.iter().any(|b| b.0.value == DEBUG_BUFFER);
    if declared || passes.iter().any(|p| p.value.name.value == CLEAR) {
        return;
    }
    let bytes = CHECKS.0 + CHECKS.1 * CHECKS.2;
    let size = implied(BufferSize::Bytes(implied(Expr::new(&bytes.to_string()))));
    let buffer = BufferDecl {
        size,
        indirect: false,
        history: false,
        transient: false,
    };
    let name = implied(DEBUG_BUFFER.to_string());
    file.buffers.0.push((name.clone(), implied(buffer)));
    let clear = PassDecl {
        name: implied(CLEAR.into()),
        clear: Some(name),
        ..PassDecl::default()
    };
    passes.insert(0, implied(clear));
}

/// A declaration that is in no file.
fn implied<T>(value: T) -> Loc<T> {
    Loc {
        value,
        at: At::default(),
    }
}
