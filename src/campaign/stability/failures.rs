//! The worst case of each method, as a table and as a page with its picture.

use super::page::STYLE;
use super::record::{CaseRecord, Report, Worst, picture};
use crate::campaign::page::{page, url};
use crate::files::FileError;
use crate::lab::LabError;
use crate::metrics::{RELMSE, within_noise};
use crate::results::table::{Table, short};
use indexmap::IndexSet;
use maud::{Markup, html};
use std::path::Path;

/// A method's worst case.
pub(crate) struct Failure {
    method: String,
    /// Title of the case, with its variant.
    case: String,
    /// relMSE for a case of one frame, E_t for others, and the part of the light.
    metric: String,
    value: f64,
    /// The same metric between the halves of the reference.
    noise: Option<f64>,
    id: String,
    worst: Worst,
}

/// The worst case of each method: one among cases of one frame, by relMSE, and one among the
/// others, by E_t. Cases above the noise of their reference come before all others.
pub(crate) fn failures(report: &Report) -> Vec<Failure> {
    let methods: IndexSet<&str> = report
        .results
        .iter()
        .map(|r| r.about.method.as_str())
        .collect();
    let kinds =
        [false, true].map(|moving| methods.iter().filter_map(move |m| worst(report, m, moving)));
    let mut list: Vec<Failure> = kinds.into_iter().flatten().collect();
    list.sort_by_key(|f| methods.get_index_of(f.method.as_str()));
    list
}

fn worst(report: &Report, method: &str, moving: bool) -> Option<Failure> {
    let failure = |r: &CaseRecord| {
        let worst = r.done()?.worst.clone()?;
        let part = r.part(&worst.part)?;
        let (metric, value, noise) = match moving {
            true => ("E_t", part.e?, part.e_noise),
            false => ("relMSE", part.scores.as_ref()?.get(RELMSE), part.noise),
        };
        let metric = format!("{metric} of {}", worst.part);
        let (case, id, method) = (r.about.title(), r.id.clone(), r.about.method.clone());
        Some(Failure {
            method,
            case,
            metric,
            value,
            noise,
            id,
            worst,
        })
    };
    let own = report
        .results
        .iter()
        .filter(|r| r.about.method == method && (r.about.frames > 1) == moving);
    own.filter_map(failure).max_by(|a, b| {
        (a.above_noise(), a.value)
            .partial_cmp(&(b.above_noise(), b.value))
            .unwrap_or(a.above_noise().cmp(&b.above_noise()))
    })
}

impl Failure {
    /// Whether the value exceeds the noise of its reference.
    fn above_noise(&self) -> bool {
        self.value > 0.0 && !within_noise(self.value, self.noise)
    }

    fn noise(&self) -> String {
        self.noise.map_or("-".into(), short)
    }
}

/// The worst cases as a Markdown table.
pub(crate) fn table(list: &[Failure]) -> String {
    let mut table = Table::new(list);
    table.column("Method", |f| f.method.clone());
    table.column("Worst case", |f| f.case.clone());
    table.column("Figure", |f| {
        let mark = match f.above_noise() {
            true => "",
            false => ", not told apart",
        };
        format!("{} {}{mark}", f.metric, short(f.value))
    });
    table.column("Noise", Failure::noise);
    table.markdown()
}

/// The worst cases as a page. The pictures come from the suite's folder and are part of the page.
///
/// # Errors
/// [`LabError::File`] if a picture cannot be read.
pub(crate) fn sheet(suite: &str, list: &[Failure], folder: &Path) -> Result<String, LabError> {
    let figures: Vec<Markup> = list
        .iter()
        .map(|f| figure(f, folder))
        .collect::<Result<_, LabError>>()?;
    let title = format!("{suite}: worst cases");
    let body = html! {
        h1 { (title) }
        @for figure in figures { (figure) }
    };
    Ok(page(&title, STYLE, &body))
}

fn figure(failure: &Failure, folder: &Path) -> Result<Markup, LabError> {
    let path = folder.join(picture(&failure.id));
    let bytes = std::fs::read(&path).map_err(|e| FileError::read(&path, e))?;
    let worst = &failure.worst;
    Ok(html! {
        figure {
            img src=(url("image/png", &bytes)) alt="";
            figcaption {
                b { (failure.method) } ", " (failure.case) ": " (failure.metric) " " (short(failure.value))
                " (noise " (failure.noise()) "). Frame " (worst.frame) ": " (worst.panels.join(" | "))
                "; red brighter, blue darker, full at " (short(worst.full)) " / 255."
            }
        }
    })
}
