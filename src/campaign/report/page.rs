//! The page: data, charts, style and script in one file.

use super::data::{Chart, Data, Dot};
use super::equal::Equal;
use super::scatter::{BAR_OPACITY, FRONT};
use super::scenes::Scenes;
use crate::campaign::charts::{COLORS, hex};
use crate::campaign::page::{page as whole_page, url};
use crate::campaign::points::labelled;
use crate::campaign::record::first_line;
use crate::lab::LabError;
use crate::metrics::{Best, METRICS};
use maud::{PreEscaped, html};
use serde::Serialize;

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
    groups: &'a [usize],
    colors: &'a [String],
    bars: &'a [usize],
}

/// A metric: key, title, and whether it is a ratio.
type PageMetric = (&'static str, &'static str, bool);

#[derive(Serialize)]
struct PageData<'a> {
    names: &'a [String],
    subjects: &'a [String],
    settings: &'a [String],
    parts: &'a [String],
    colors: Vec<String>,
    front: String,
    bar_opacity: String,
    metrics: Vec<PageMetric>,
    charts: Vec<PageChart<'a>>,
    dots: Vec<PageDot<'a>>,
}

/// What the page's script shows.
fn page_data<'a>(data: &'a Data, charts: &'a [Chart]) -> PageData<'a> {
    let jpeg = |bytes: &Option<Vec<u8>>| bytes.as_ref().map(|b| url("image/jpeg", b));
    let dots = data.dots.iter().map(|dot| PageDot {
        dot,
        picture: jpeg(&dot.picture),
        error_map: jpeg(&dot.error_map),
    });
    let charted = charts.iter().map(|c| PageChart {
        subject: c.subject,
        part: &c.part,
        metric: c.metric.key,
        points: &c.points,
        groups: &c.groups,
        colors: &c.colors,
        bars: &c.bars,
    });
    PageData {
        names: &data.names,
        subjects: &data.subjects,
        settings: &data.settings,
        parts: &data.parts,
        colors: COLORS
            .iter()
            .map(|c| format!("rgb({},{},{})", c.0, c.1, c.2))
            .collect(),
        front: hex(FRONT),
        bar_opacity: BAR_OPACITY.to_string(),
        metrics: METRICS
            .iter()
            .map(|m| (m.key, m.title, m.best == Best::One))
            .collect(),
        charts: charted.collect(),
        dots: dots.collect(),
    }
}

/// The page as HTML.
pub fn page(
    data: &Data,
    charts: &[Chart],
    passes: &[(String, String)],
    table: &str,
    (scenes, equal): (Option<&Scenes>, Option<&Equal>),
) -> Result<String, LabError> {
    // Without `<` no string can close the script element.
    let json = serde_json::to_string(&page_data(data, charts))
        .map_err(LabError::making("JSON"))?
        .replace('<', "\\u003c");
    let title = data.sweeps.join(", ");
    let body = html! {
        h1 { (title) }
        p {
            (data.dots.len()) " points measured, " (data.failed.len()) " failed, " (data.left) " left. Times are GPU \
             milliseconds of a frame, medians. Errors are against a path-traced reference. Only points of one scene, camera, \
             size and device are put on one chart. Lines: the points of each colour that none of the colour beats in both time and \
             error. Vertical bars: the noise of the reference. Hollow: less than 4 times that noise. "
            a download="points.csv" href=(url("text/csv", table.as_bytes())) { "points.csv" }
        }
        @if let Some(scenes) = scenes { (scenes.html(data)) }
        div id="controls" {}
        p id="settings" {}
        div id="filters" {}
        div id="charts" {
            @if charts.is_empty() {
                p {
                    "No point has a reference to be compared with: make one with " code { "conelab reference" } " and run \
                     the sweep again."
                }
            }
            @for (i, chart) in charts.iter().enumerate() { figure data-chart=(i) hidden { (PreEscaped(&chart.svg)) } }
        }
        @if let Some(equal) = equal { (equal.html()) }
        h2 { "Passes" }
        @for (i, (_, svg)) in passes.iter().enumerate() { figure data-passes=(i) hidden { (PreEscaped(svg)) } }
        h2 { "Points" }
        div.wide { table id="points" {} }
        @if !data.failed.is_empty() {
            h2 { "Failed" }
            ul { @for failed in &data.failed { li { (labelled(&failed.labels)) ": " (first_line(&failed.error)) } } }
        }
        div id="tip" hidden {}
        script type="application/json" id="data" { (PreEscaped(json)) }
        script { (PreEscaped(SCRIPT)) }
    };
    Ok(whole_page(
        &format!("{title}: error against time"),
        STYLE,
        &body,
    ))
}
