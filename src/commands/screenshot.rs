//! `conelab screenshot`.

use super::DeviceArgs;
use super::adapt::{Changes, parse_size};
use crate::graph::run::Execution;
use crate::lab::{LabError, Workspace};
use crate::results::stats::{Spread, spreads};
use crate::workbench::Options;
use crate::workbench::hosts::screenshot::{Edit, Pace, Script, Shot, take};
use crate::workbench::session::Restore;
use clap::Args;
use std::io::Cursor;
use std::path::PathBuf;
use std::time::Duration;

/// Arguments of `screenshot`.
#[derive(Debug, Args)]
pub struct ScreenshotArgs {
    /// Experiment file; configs/cones.ron when absent.
    experiment: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
    /// Size of the whole interface, pixels.
    #[arg(long, value_name = "WxH", default_value = "1600x900")]
    window: String,
    /// Pixels per point.
    #[arg(long, default_value_t = 1.0)]
    scale: f32,
    /// Theme of the interface: dark or light.
    #[arg(long, value_name = "THEME", default_value = "dark", value_parser = ["dark", "light"])]
    theme: String,
    /// Write the texts of the picture to this file (JSON): size in points, colour, place in pixels.
    #[arg(long, value_name = "FILE")]
    texts: Option<PathBuf>,
    /// Click on the widget with this label, or at X,Y (repeatable). Hidden widgets are scrolled
    /// into view first.
    #[arg(long, value_name = "LABEL")]
    click: Vec<String>,
    /// Measure this number of frames of the interface and print their times.
    #[arg(long, default_value_t = 0)]
    measure: usize,
    /// Measure the pace of the interface over this number of the engine's pictures. The engine must
    /// keep rendering (`--click continuous`).
    #[arg(long, value_name = "PICTURES", default_value_t = 0)]
    pace: usize,
    /// Milliseconds between frames of the interface while its pace is measured, like the refresh of
    /// a screen. When absent: a frame for each new picture.
    #[arg(long, value_name = "MS", requires = "pace")]
    every: Option<f64>,
    /// Measure the time from a saved edit of this file to its painted picture. The file is restored
    /// afterwards.
    #[arg(long, value_name = "FILE", requires_all = ["from", "to"])]
    edit: Option<PathBuf>,
    /// A text that occurs once in the edited file.
    #[arg(long, value_name = "TEXT", requires = "edit")]
    from: Option<String>,
    /// Its replacement, in every second save.
    #[arg(long, value_name = "TEXT", requires = "edit")]
    to: Option<String>,
    /// Saves to measure.
    #[arg(long, default_value_t = 16)]
    times: usize,
    /// Write events to this file, one JSON object per line.
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Seconds to wait for the picture after each click, and for its convergence at the end.
    #[arg(long, default_value_t = 120)]
    patience: u64,
    /// Output file, .png or .jpg.
    #[arg(short, long)]
    output: PathBuf,
    #[command(flatten)]
    device: DeviceArgs,
}

fn script(args: &ScreenshotArgs) -> Result<Script, LabError> {
    Ok(Script {
        size: parse_size(&args.window)?,
        scale: args.scale,
        clicks: args.click.clone(),
        measure: args.measure,
        pace: (args.pace > 0).then(|| Pace {
            pictures: args.pace,
            every: args
                .every
                .map(|ms| Duration::from_secs_f64(ms.clamp(0.1, 1e4) / 1e3)),
        }),
        light: args.theme == "light",
        texts: args.texts.is_some(),
        edit: args.edit.clone().map(|file| Edit {
            file,
            from: args.from.clone().unwrap_or_default(),
            to: args.to.clone().unwrap_or_default(),
            times: args.times,
        }),
        patience: Duration::from_secs(args.patience),
    })
}

/// Takes the picture.
pub fn run(args: &ScreenshotArgs) -> Result<(), LabError> {
    let home = Workspace::find()?;
    let format = image::ImageFormat::from_path(&args.output)
        .ok()
        .filter(|f| matches!(f, image::ImageFormat::Png | image::ImageFormat::Jpeg))
        .ok_or_else(|| {
            LabError::Request(format!(
                "'{}': give it the ending .png or .jpg",
                args.output.display()
            ))
        })?;
    if !(0.25..=8.0).contains(&args.scale) {
        return Err(LabError::Request("--scale must be 0.25 to 8".into()));
    }
    let gpu = args.device.options();
    let script = script(args)?;
    let file = super::opened(args.experiment.as_deref(), &home);
    let options = Options {
        experiment: args.changes.read(&file)?,
        file,
        size: args.changes.size()?,
        home,
        gpu: gpu.clone(),
        execution: Execution::Full,
        events: args.events.clone(),
        restore: Restore::Nothing,
    };
    let shot = take(options, &gpu, script)?;
    let rgb: Vec<u8> = shot
        .bytes
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    let mut file = Cursor::new(Vec::new());
    let [width, height] = shot.size;
    image::write_buffer_with_format(
        &mut file,
        &rgb,
        width,
        height,
        image::ColorType::Rgb8,
        format,
    )
    .map_err(LabError::making("the picture"))?;
    crate::files::write_whole(&args.output, file.get_ref())?;
    if let Some(path) = &args.texts {
        let texts = serde_json::to_vec_pretty(&shot.texts);
        let texts = texts.map_err(LabError::making("the list of texts"))?;
        crate::files::write_whole(path, &texts)?;
    }
    if args.measure > 0 || shot.pace.is_some() || shot.edit_ms.is_some() {
        print_times(&shot, args.measure > 0);
    }
    if shot.frames_left > 0 {
        warn!(
            "warning: the picture has not converged, {} frames are missing; --patience gives it more time",
            shot.frames_left
        );
    }
    say!("wrote {}", super::shown(&args.output).display());
    match shot.errors.is_empty() {
        true => Ok(()),
        false => Err(LabError::Input(shot.errors)),
    }
}

fn print_times(shot: &Shot, measured: bool) {
    let mut rows = Vec::new();
    let mut add = |name: &str, spread: &Spread| rows.push((name.to_string(), *spread));
    if measured {
        add("interface, CPU", &shot.cpu_ms);
        add("interface, GPU", &shot.gpu_ms);
        add("copying pictures, GPU", &shot.copy_ms);
    }
    if let Some(pace) = &shot.pace {
        add("from picture to picture", &pace.engine_ms);
        add("from paint to paint", &pace.paint_ms);
        add("from picture to its paint", &pace.delay_ms);
        add("interface, CPU", &pace.cpu_ms);
        add("  new layouts", &pace.layout_ms);
    }
    if let Some(edit) = &shot.edit_ms {
        add("save to pixels", edit);
    }
    say_part!("{}", spreads("ms", &rows));
    if let Some(pace) = &shot.pace {
        say!(
            "{} pictures, {} painted, {} layouts",
            pace.pictures,
            pace.painted,
            pace.layouts
        );
        if let Some((before, after)) = pace.memory {
            say!(
                "{:.1} MiB after a tenth of them, {:.1} MiB after all",
                mib(before),
                mib(after)
            );
        }
    }
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}
