//! Frame captures by RenderDoc, when the program runs under it; on Linux alone, where the program's
//! own list of mappings says whether it does. Its library knows no macOS.

/// A capture that has begun.
#[cfg(target_os = "linux")]
pub type Capture = renderdoc::RenderDoc<renderdoc::V141>;

/// There is none.
#[cfg(not(target_os = "linux"))]
pub type Capture = std::convert::Infallible;

/// Starts a capture, or says why there is none.
#[cfg(target_os = "linux")]
pub fn begin() -> Result<Capture, String> {
    // Loading its library late would capture nothing, so that is not tried.
    if !std::fs::read_to_string("/proc/self/maps").is_ok_and(|maps| maps.contains("librenderdoc")) {
        return Err(
            "RenderDoc is not attached: start conelab from it, or with `renderdoccmd capture conelab`"
                .into(),
        );
    }
    let mut api = Capture::new().map_err(|e| format!("RenderDoc does not answer: {e}"))?;
    api.start_frame_capture(std::ptr::null(), std::ptr::null());
    Ok(api)
}

/// Says that there is none.
#[cfg(not(target_os = "linux"))]
pub fn begin() -> Result<Capture, String> {
    Err("RenderDoc captures frames only on Linux".into())
}

/// Ends it and says where it is.
pub fn end(begun: Result<Capture, String>) -> String {
    begun.map_or_else(|why| why, finish)
}

#[cfg(target_os = "linux")]
fn finish(mut api: Capture) -> String {
    api.end_frame_capture(std::ptr::null(), std::ptr::null());
    match api.get_capture(api.get_num_captures().saturating_sub(1)) {
        Some((path, _)) => format!("RenderDoc captured a frame: {}", path.display()),
        None => "RenderDoc captured nothing".into(),
    }
}

#[cfg(not(target_os = "linux"))]
fn finish(capture: Capture) -> String {
    match capture {}
}
