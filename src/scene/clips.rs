//! Choosing an animation by name.

use crate::diagnostics::excerpt::excerpt;
use crate::diagnostics::nearest;

/// Maximum length of an error message that quotes names from the file.
const MAX_MESSAGE: usize = 400;

/// Ending of the warning about each animation that is not played.
pub(super) const LEFT_OUT: &str = "of several animations of one node the first is played. `clip: \"NAME\"` of a scene file's model chooses another";

/// The index of the animation named `clip`.
pub(super) fn number(clip: &str, names: &[String]) -> Result<usize, String> {
    names.iter().position(|name| name == clip).ok_or_else(|| {
        let hint =
            nearest(clip, names.iter().map(String::as_str)).unwrap_or_else(|| "it has none".into());
        excerpt(&format!("it has no clip '{clip}' ({hint})"), MAX_MESSAGE)
    })
}
