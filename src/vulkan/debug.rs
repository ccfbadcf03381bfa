//! Validation messages, collected so that tests and the command line can fail on any of them.

use ash::{ext, vk};
use std::ffi::{CStr, c_void};
use std::io::Write;
use std::sync::Mutex;

/// Messages of the validation layer. The owner boxes them, so that the callback's pointer stays
/// valid.
#[derive(Default)]
pub(super) struct Messages(pub(super) Mutex<Vec<String>>);

/// Receives one message of the validation layer.
///
/// # Safety
/// The loader passes a valid `data`, and as `user` the [`Messages`] given on creation, which
/// outlives the messenger.
pub(super) unsafe extern "system" fn on_message(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: see the function's contract; the strings of `data` live for this call.
    let (text, messages) = unsafe {
        let text = if data.is_null() || (*data).p_message.is_null() {
            String::from("(no text)")
        } else {
            CStr::from_ptr((*data).p_message)
                .to_string_lossy()
                .into_owned()
        };
        (text, &*user.cast::<Messages>())
    };
    // The loader warns about drivers that it cannot open; that is not an error of this program.
    if !text.starts_with("loader") && !text.contains("terminator_CreateInstance") {
        let level = if severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR) {
            "error"
        } else {
            "warning"
        };
        // A closed standard error must not unwind through the driver.
        let _ = writeln!(std::io::stderr(), "vulkan validation {level}: {text}");
        if let Ok(mut list) = messages.0.lock() {
            list.push(format!("{level}: {text}"));
        }
    }
    vk::FALSE
}

/// Messenger settings: warnings and errors of all types.
pub(super) fn messenger_info(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(
            vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
        )
        .message_type(
            vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION
                | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE
                | vk::DebugUtilsMessageTypeFlagsEXT::GENERAL,
        )
        .pfn_user_callback(Some(on_message))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast())
}

/// Object names and labels for debuggers; requires VK_EXT_debug_utils.
pub(super) struct Names {
    pub(super) device: ext::debug_utils::Device,
}
