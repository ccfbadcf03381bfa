//! Animations of one file to choose from.

use crate::diagnostics::excerpt::excerpt;
use crate::diagnostics::nearest;

/// Characters of an error that may quote the file.
const MAX_MESSAGE: usize = 400;

/// The warning about each that is not played.
pub(super) const LEFT_OUT: &str = "of several animations of one node the first is played. `clip: \"NAME\"` of a scene file's model chooses another";

/// The number of the clip with a name.
pub(super) fn number(clip: &str, names: &[String]) -> Result<usize, String> {
    names.iter().position(|name| name == clip).ok_or_else(|| {
        let hint =
            nearest(clip, names.iter().map(String::as_str)).unwrap_or_else(|| "it has none".into());
        excerpt(&format!("it has no clip '{clip}' ({hint})"), MAX_MESSAGE)
    })
}
