//! Where each method fails, on one picture for documents: its worst case as method, reference and difference, with names and
//! numbers beside them.

use super::record::{CaseRecord, Report, Worst, picture};
use crate::files::FileError;
use crate::lab::LabError;
use crate::metrics::{RELMSE, within_noise};
use crate::results::table::{Table, short};
use egui::epaint::text::{FontDefinitions, Fonts, TextOptions};
use egui::{Color32, FontId};
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{FilterType, crop_imm, resize};
use image::{Rgb, RgbImage};
use indexmap::IndexSet;
use std::path::Path;

/// Largest file, bytes.
const MAX_BYTES: usize = 200_000;
/// Widths of a panel, pixels, and qualities of JPEG, percent: the first with which the file is small enough.
const TRIALS: [(u32, u8); 6] = [
    (240, 90),
    (240, 80),
    (200, 80),
    (200, 70),
    (160, 70),
    (120, 60),
];
/// Width of the texts, pixels.
const TEXT: u32 = 250;
/// Around everything, pixels.
const GAP: u32 = 8;
/// Height of the line with the columns' names, pixels.
const HEAD: u32 = 22;
/// White between the panels of a result's picture, pixels.
const BETWEEN: u32 = super::pictures::GAP as u32;

/// A method's worst case.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// The method.
    pub method: String,
    /// The case, with its variant.
    pub case: String,
    /// What the number is: relMSE of a case of one frame, E_t of others; and of which part of the light.
    pub metric: String,
    /// The number.
    pub value: f64,
    /// The same number between the halves of the reference.
    pub noise: Option<f64>,
    id: String,
    worst: Worst,
}

/// The worst case of each method among those of one frame, by relMSE, and among those of several, by E_t: of those that are
/// told apart from the reference's noise, if any is.
pub fn failures(report: &Report) -> Vec<Failure> {
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
    /// Whether it is told apart from the noise of its reference.
    pub fn above_noise(&self) -> bool {
        self.value > 0.0 && !within_noise(self.value, self.noise)
    }

    fn lines(&self) -> String {
        let noise = self
            .noise
            .map_or(String::new(), |n| format!(" (noise {})", short(n)));
        let (frame, full) = (self.worst.frame, short(self.worst.full));
        let (metric, value) = (&self.metric, short(self.value));
        format!(
            "{}\n{}\n{metric} {value}{noise}\nframe {frame}, full red, blue {full}/255",
            self.method, self.case
        )
    }
}

/// A table for documents, Markdown.
pub fn table(list: &[Failure]) -> String {
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
    table.column("Noise", |f| f.noise.map_or("-".into(), short));
    table.markdown()
}

/// The sheet as JPEG; pictures are those in the suite's folder.
///
/// # Errors
/// Pictures that cannot be read.
pub fn sheet(list: &[Failure], folder: &Path) -> Result<Vec<u8>, LabError> {
    let rows: Vec<[RgbImage; 3]> = list
        .iter()
        .map(|f| panels(f, folder))
        .collect::<Result<_, LabError>>()?;
    let mut bytes = Vec::new();
    for (width, quality) in TRIALS {
        let sheet = draw(list, &rows, width);
        bytes.clear();
        JpegEncoder::new_with_quality(&mut bytes, quality)
            .encode_image(&sheet)
            .map_err(LabError::making("the sheet"))?;
        if bytes.len() <= MAX_BYTES {
            break;
        }
    }
    Ok(bytes)
}

/// The frame, the reference (white without one) and the difference of a result's picture.
fn panels(failure: &Failure, folder: &Path) -> Result<[RgbImage; 3], LabError> {
    let path = folder.join(picture(&failure.id));
    let read = image::open(&path).map_err(|e| FileError::read(&path, e))?;
    let picture = read.to_rgb8();
    let names = &failure.worst.panels;
    let count = u32::try_from(names.len()).unwrap_or(1).max(1);
    let width = (picture.width() + BETWEEN)
        .saturating_div(count)
        .saturating_sub(BETWEEN)
        .max(1);
    let panel = |i: Option<usize>| match i.and_then(|i| u32::try_from(i).ok()) {
        Some(i) => crop_imm(&picture, i * (width + BETWEEN), 0, width, picture.height()).to_image(),
        None => RgbImage::from_pixel(width, picture.height(), Rgb([255; 3])),
    };
    let named = |name: &str| names.iter().position(|n| n == name);
    Ok([
        panel(named("the frame")),
        panel(named("reference")),
        panel(names.len().checked_sub(1)),
    ])
}

fn draw(list: &[Failure], rows: &[[RgbImage; 3]], width: u32) -> RgbImage {
    let fit = |p: &RgbImage| {
        let height = (u64::from(p.height()) * u64::from(width) / u64::from(p.width().max(1)))
            .clamp(1, 4096) as u32;
        let filter = if p.width() > width {
            FilterType::Triangle
        } else {
            FilterType::Nearest
        };
        resize(p, width, height, filter)
    };
    let rows: Vec<[RgbImage; 3]> = rows.iter().map(|r| r.each_ref().map(fit)).collect();
    let height = |r: &[RgbImage; 3]| r[0].height().max(76) + GAP;
    let all = HEAD + GAP + rows.iter().map(height).sum::<u32>();
    let mut sheet = RgbImage::from_pixel(TEXT + 3 * (width + GAP) + 2 * GAP, all, Rgb([255; 3]));
    let left = |column: u32| GAP + TEXT + column * (width + GAP);
    let mut fonts = Fonts::new(TextOptions::default(), FontDefinitions::default());
    for (column, name) in (0..).zip(["worst frame", "reference", "difference"]) {
        write(&mut sheet, &mut fonts, (left(column), 4), width, name);
    }
    let mut top = HEAD;
    for (failure, row) in list.iter().zip(&rows) {
        write(
            &mut sheet,
            &mut fonts,
            (GAP, top),
            TEXT - GAP,
            &failure.lines(),
        );
        for (column, panel) in (0..).zip(row) {
            image::imageops::replace(&mut sheet, panel, left(column).into(), top.into());
        }
        top += height(row);
    }
    sheet
}

/// Black text on a picture.
fn write(
    picture: &mut RgbImage,
    fonts: &mut Fonts,
    (left, top): (u32, u32),
    width: u32,
    text: &str,
) {
    let mut view = fonts.with_pixels_per_point(1.0);
    let galley = view.layout(
        text.to_string(),
        FontId::proportional(14.0),
        Color32::BLACK,
        width as f32,
    );
    let atlas = view.image();
    for row in &galley.rows {
        for glyph in row.glyphs.iter().filter(|g| !g.uv_rect.is_nothing()) {
            let (uv, at) = (
                &glyph.uv_rect,
                row.pos + glyph.pos.to_vec2() + glyph.uv_rect.offset,
            );
            for (y, v) in (uv.min[1]..uv.max[1]).enumerate() {
                for (x, u) in (uv.min[0]..uv.max[0]).enumerate() {
                    let covered = atlas[(usize::from(u), usize::from(v))].a();
                    let (x, y) = (
                        at.x.round() as i64 + x as i64,
                        at.y.round() as i64 + y as i64,
                    );
                    let place = (
                        u32::try_from(x + i64::from(left)),
                        u32::try_from(y + i64::from(top)),
                    );
                    if let (Ok(x), Ok(y)) = place
                        && let Some(pixel) = picture.get_pixel_mut_checked(x, y)
                    {
                        pixel.0 = pixel
                            .0
                            .map(|c| (u32::from(c) * u32::from(255 - covered) / 255) as u8);
                    }
                }
            }
        }
    }
}
