//! Frame captures by RenderDoc, when the program runs under it.

use renderdoc::{RenderDoc, V141};

/// Whether RenderDoc is loaded into this program. Loading its library late would capture nothing, so that is not tried.
pub fn present() -> bool {
    std::fs::read_to_string("/proc/self/maps").is_ok_and(|maps| maps.contains("librenderdoc"))
}

/// Starts a capture, or says why there is none.
pub fn begin() -> Result<RenderDoc<V141>, String> {
    if !present() {
        return Err("RenderDoc is not there: start conelab from it, or with `renderdoccmd capture conelab`".into());
    }
    let mut api = RenderDoc::<V141>::new().map_err(|e| format!("RenderDoc does not answer: {e}"))?;
    api.start_frame_capture(std::ptr::null(), std::ptr::null());
    Ok(api)
}

/// Ends it and says where it is.
pub fn end(begun: Result<RenderDoc<V141>, String>) -> String {
    match begun {
        Ok(mut api) => {
            api.end_frame_capture(std::ptr::null(), std::ptr::null());
            match api.get_capture(api.get_num_captures().saturating_sub(1)) {
                Some((path, _)) => format!("RenderDoc captured a frame: {}", path.display()),
                None => "RenderDoc captured nothing".into(),
            }
        }
        Err(why) => why,
    }
}
