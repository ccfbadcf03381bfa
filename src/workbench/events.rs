//! What happens in the window, one JSON object a line, for scripts and tests (`conelab view
//! --events FILE`).

use egui::accesskit;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// A number for a picture's red, green and blue (FNV-1a), to tell whether two are the same.
pub fn fingerprint(rgba: &[u8]) -> String {
    let rgb = rgba.chunks_exact(4).flat_map(|p| &p[..3]);
    format!(
        "{:016x}",
        rgb.fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(*b))
            .wrapping_mul(0x0100_0000_01b3))
    )
}

/// A log of events.
pub struct Events {
    file: File,
    start: Instant,
    widgets: Value,
    place: Option<egui::Rect>,
    nodes: HashMap<u64, accesskit::Node>,
    sent: Instant,
    released: bool,
}

impl Events {
    /// Writes to a file, which is replaced.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn new(path: &Path) -> std::io::Result<Events> {
        let now = Instant::now();
        let file = File::create(path)?;
        Ok(Events {
            file,
            start: now,
            widgets: Value::Null,
            place: None,
            nodes: HashMap::new(),
            sent: now,
            released: false,
        })
    }

    /// Writes an event; the time is added, in ms since the start.
    pub fn write(&mut self, event: &str, mut fields: Value) {
        if let Some(map) = fields.as_object_mut() {
            map.insert("event".into(), event.into());
            map.insert("ms".into(), json!(self.start.elapsed().as_secs_f64() * 1e3));
        }
        // A disk that is full must not end the program.
        let _ = writeln!(self.file, "{fields}");
    }

    /// Writes where the picture is on the screen, in pixels, when that changed.
    pub fn place(&mut self, place: Option<egui::Rect>, scale: f32) {
        if place != self.place
            && let Some(r) = place
        {
            let rect = [r.min.x, r.min.y, r.max.x, r.max.y].map(|v| f64::from((v * scale).round()));
            self.write("place", json!({ "rect": rect }));
        }
        self.place = place;
    }

    /// Writes where the widgets are, in points, when that changed; at most some times a second,
    /// but always in the frame after a button of the mouse was `released`, followed by that event.
    /// `true` if more is to be written later.
    pub fn widgets(
        &mut self,
        update: Option<&accesskit::TreeUpdate>,
        scale: f32,
        released: bool,
    ) -> bool {
        let answered = std::mem::replace(&mut self.released, released);
        let more = self.changed_widgets(update, scale, answered);
        if answered {
            self.write("released", json!({}));
        }
        more || released
    }

    fn changed_widgets(
        &mut self,
        update: Option<&accesskit::TreeUpdate>,
        scale: f32,
        at_once: bool,
    ) -> bool {
        if let Some(update) = update {
            self.nodes = update
                .nodes
                .iter()
                .map(|(id, node)| (id.0, node.clone()))
                .collect();
        }
        let mut list: Vec<Value> = Vec::new();
        for node in self.nodes.values() {
            let label = node.label().or(node.value()).unwrap_or_default();
            let Some(b) = node.bounds().filter(|_| !label.is_empty()) else {
                continue;
            };
            let rect = [b.x0, b.y0, b.x1, b.y1].map(|v| v.round());
            let value = node
                .numeric_value()
                .map_or_else(|| json!(node.value().unwrap_or_default()), |v| json!(v));
            list.push(json!({ "role": format!("{:?}", node.role()), "label": label, "value": value, "rect": rect }));
        }
        list.sort_by_key(Value::to_string);
        let list = json!({ "scale": scale, "list": list });
        if list == self.widgets {
            return false;
        }
        if !at_once && self.sent.elapsed().as_millis() < 100 {
            return true;
        }
        self.sent = Instant::now();
        self.widgets = list.clone();
        self.write("widgets", list);
        false
    }
}
