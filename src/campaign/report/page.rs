//! The page: data, charts, style and script in one file.

use super::bars::COLORS;
use super::data::{Chart, Data, Dot, Failed};
use super::scenes::Scenes;
use crate::lab::LabError;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use std::fmt::Write;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

#[derive(Serialize)]
struct PageDot<'a> {
    #[serde(flatten)]
    dot: &'a Dot,
    picture: Option<String>,
    error_map: Option<String>,
}

#[derive(Serialize)]
struct PageChart<'a> {
    subject: usize,
    part: &'a str,
    metric: &'a str,
    points: &'a [usize],
}

#[derive(Serialize)]
struct PageData<'a> {
    names: &'a [String],
    subjects: &'a [String],
    settings: &'a [String],
    parts: &'a [String],
    colors: Vec<String>,
    charts: Vec<PageChart<'a>>,
    dots: Vec<PageDot<'a>>,
}

/// The page as HTML.
///
/// # Errors
/// Writing to memory gives none, whatever the data.
pub fn page(
    data: &Data,
    charts: &[Chart],
    passes: &[(String, String)],
    table: &str,
    scenes: Option<&Scenes>,
) -> Result<String, LabError> {
    let jpeg = |bytes: &Option<Vec<u8>>| bytes.as_ref().map(|b| url("image/jpeg", b));
    let dots =
        data.dots.iter().map(|dot| PageDot { dot, picture: jpeg(&dot.picture), error_map: jpeg(&dot.error_map) });
    let charted =
        charts.iter().map(|c| PageChart { subject: c.subject, part: &c.part, metric: &c.metric, points: &c.points });
    let shown = PageData {
        names: &data.names,
        subjects: &data.subjects,
        settings: &data.settings,
        parts: &data.parts,
        colors: COLORS.iter().map(|c| format!("rgb({},{},{})", c.0, c.1, c.2)).collect(),
        charts: charted.collect(),
        dots: dots.collect(),
    };
    // Nothing in a string can end the element that the data stands in.
    let json = serde_json::to_string(&shown).map_err(|e| LabError::Request(e.to_string()))?.replace('<', "\\u003c");
    let title = escaped(&data.sweeps.join(", "));
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}: error against time</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\"><style>\n{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n"
    );
    let counts = (data.dots.len(), data.failed.len(), data.left);
    let _ = writeln!(
        out,
        "<p>{} points measured, {} failed, {} left. Times are GPU milliseconds of a frame, medians. Errors are against a \
         path-traced reference. Only points of one scene, camera, size and device are put on one chart. Hollow: less than \
         4 times the noise of the reference. <a download=\"points.csv\" href=\"{}\">points.csv</a></p>",
        counts.0,
        counts.1,
        counts.2,
        url("text/csv", table.as_bytes())
    );
    out += &scenes.map_or(String::new(), |s| s.html(data));
    out += "<div id=\"controls\"></div><p id=\"settings\"></p>\n<div id=\"filters\"></div>\n<div id=\"charts\">\n";
    if charts.is_empty() {
        out += "<p>No point has a reference to be compared with: make one with <code>conelab reference</code> and run the \
                sweep again.</p>\n";
    }
    for (i, chart) in charts.iter().enumerate() {
        let _ = writeln!(out, "<figure data-chart=\"{i}\" hidden>{}</figure>", chart.svg);
    }
    out += "</div>\n<h2>Passes</h2>\n";
    for (i, (_, svg)) in passes.iter().enumerate() {
        let _ = writeln!(out, "<figure data-passes=\"{i}\" hidden>{svg}</figure>");
    }
    out += "<h2>Points</h2>\n<div class=\"wide\"><table id=\"points\"></table></div>\n";
    if !data.failed.is_empty() {
        out += "<h2>Failed</h2>\n<ul>\n";
        for Failed { labels, error, .. } in &data.failed {
            let labels: Vec<String> = labels.iter().map(|(name, value)| format!("{name} {value}")).collect();
            let error = error.lines().next().unwrap_or_default();
            let _ = writeln!(out, "<li>{}: {}</li>", escaped(&labels.join(", ")), escaped(error));
        }
        out += "</ul>\n";
    }
    let _ = write!(
        out,
        "<div id=\"tip\" hidden></div>\n<script type=\"application/json\" id=\"data\">{json}</script>\n\
         <script>\n{SCRIPT}</script>\n</body></html>\n"
    );
    Ok(out)
}

/// A file inside of the page.
pub fn url(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(bytes))
}

/// Text that HTML shows as it is.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
