//! Looks into any texture of the graph.

mod histogram;
mod image;
mod parts;
mod statistics;
mod strip;
mod viewport;
mod views;
mod work;

use super::Tab;
use crate::graph::param::Value;
use crate::graph::plan::TexturePlan;
use crate::lab::Texels;
use crate::vulkan::format::Channels;
use crate::workbench::background::Wake;
use crate::workbench::desired::edit;
use crate::workbench::desired::request::{InspectTarget, SideRequest};
use crate::workbench::dock::Pane;
use crate::workbench::engine::report::{GraphInfo, Report};
use crate::workbench::panel::control::{named, spin};
use crate::workbench::read_back::{Content, ReadBack};
use crate::workbench::{INSPECTOR, Workbench};
use egui::{DragValue, Slider, TextureId, Ui, Vec2};
use image::{CLIPPED, Channel, Marks, NEGATIVE, Tone};
use std::sync::Arc;
use work::{Done, Source, Work};

/// State of this tab.
pub struct Inspector {
    target: InspectTarget,
    tone: Tone,
    /// Whether the next texels decide the range.
    fit: bool,
    work: Work,
    shown: Option<Done>,
    pan_zoom: viewport::PanZoom,
    before: views::Before,
    strip: strip::Strip,
}

impl Default for Inspector {
    fn default() -> Self {
        Inspector {
            target: InspectTarget {
                side: 0,
                texture: String::new(),
                mip: 0,
                layer: 0,
                axis: 2,
                slice: 0,
            },
            tone: Tone::default(),
            fit: true,
            work: Work::default(),
            shown: None,
            pan_zoom: viewport::PanZoom::default(),
            before: views::Before::default(),
            strip: strip::Strip::default(),
        }
    }
}

impl Tab for Inspector {
    const TITLE: &'static str = "Inspect";
    const ICON: &'static str = egui_phosphor::regular::MAGNIFYING_GLASS;

    fn show(workbench: &mut Workbench, ui: &mut Ui, textures: &[TextureId]) {
        workbench.inspector_tab(ui, textures);
    }

    fn report(workbench: &mut Workbench, report: &Report) {
        if let Report::Content(Content::Texels(target, texels)) = report {
            let volume = workbench.is_volume(target);
            let (inspector, wake) = (&mut workbench.tabs.inspector, &workbench.setup.wake);
            inspector.note(target, texels.clone(), volume, wake);
        }
        if let Report::Content(Content::Thumbnail(target, texels)) = report {
            let volume = workbench.is_volume(target);
            let (inspector, wake) = (&mut workbench.tabs.inspector, &workbench.setup.wake);
            inspector.strip.note(target, texels.clone(), volume, wake);
        }
    }

    fn poll(workbench: &mut Workbench) {
        if let Some(pixels) = workbench.tabs.inspector.take(&workbench.setup.wake) {
            workbench.show(pixels);
        }
    }
}

impl Inspector {
    /// Chooses a texture.
    pub fn open(&mut self, side: usize, texture: String) {
        if self.target.texture != texture {
            self.fit = true;
            self.pan_zoom = viewport::PanZoom::default();
        }
        // A slice that no volume has becomes the middle one.
        self.target = InspectTarget {
            side,
            texture,
            mip: 0,
            layer: 0,
            axis: self.target.axis,
            slice: u32::MAX,
        };
    }

    /// Opens a mip, layer or slice of a texture, with a tone or one that fits.
    fn open_part(&mut self, target: InspectTarget, tone: Option<Tone>) {
        self.open(target.side, target.texture.clone());
        self.target = target;
        self.fit = tone.is_none();
        self.tone = tone.unwrap_or(self.tone);
    }

    /// Takes in requested texels. Texels of a volume are a slice.
    fn note(&mut self, target: &InspectTarget, texels: Arc<Texels>, volume: bool, wake: &Wake) {
        // Results of an earlier choice would only delay the present one.
        if target.texture != self.target.texture || target.side != self.target.side {
            return;
        }
        let first = std::mem::take(&mut self.fit);
        if first {
            self.tone = first_tone(&texels, volume, self.tone);
        }
        // Eight bits have a range of their own.
        let fit = first && !is_bytes(&texels);
        let source = Source::New(target.clone(), texels, volume);
        self.work.start(source, self.tone, fit, wake);
    }

    /// New pixels to show, if there are.
    fn take(&mut self, wake: &Wake) -> Option<crate::workbench::NewPixels> {
        let done = self.work.take(wake)?;
        if done.fitted {
            (self.tone.low, self.tone.high) = (done.tone.low, done.tone.high);
        }
        let (size, bytes) = (done.decoded.size, Some(done.image.clone()));
        let pixels = crate::workbench::NewPixels {
            picture: INSPECTOR,
            size,
            bytes,
            shared: None,
        };
        self.shown = Some(done);
        Some(pixels)
    }

    /// Shows the texels there are otherwise, when the tone was changed.
    fn show_again(&mut self, before: Tone, fit: bool, wake: &Wake) {
        if self.tone == before && !fit {
            return;
        }
        if let Some(done) = &self.shown {
            let source = Source::Again(done.decoded.clone(), done.values.clone());
            self.work.start(source, self.tone, fit, wake);
        }
    }
}

/// How texels of that format are shown at first.
fn first_tone(texels: &Texels, volume: bool, tone: Tone) -> Tone {
    let f = texels.format;
    let channel = if f.count == 1 {
        Channel::One(0)
    } else {
        Channel::Rgb
    };
    // Bytes are mostly encoded already; depths and integers are no light.
    let raw = f.channels != Channels::Float || f.name.starts_with("rgba8") || f.count < 3;
    Tone {
        channel,
        raw,
        stops: 0.0,
        low: 0.0,
        high: 1.0,
        // Black light and empty cells would look alike.
        checkerboard: volume && f.count == 4,
        ..tone
    }
}

/// Whether channels are fractions in eight bits.
fn is_bytes(texels: &Texels) -> bool {
    let f = &texels.format;
    f.channels == Channels::Float && f.bytes == f.count
}

impl Workbench {
    /// Shows a texture in the inspector.
    pub(crate) fn inspect(&mut self, side: usize, texture: String) {
        self.tabs.inspector.open(side, texture);
        self.dock.open_tab::<Inspector>();
        self.dock.open(Pane::Texture);
    }

    /// Asks for the texels of the chosen texture.
    pub(super) fn read_texture(&mut self) {
        let asked = ReadBack::Texture(self.tabs.inspector.target.clone());
        if !self.desired.read_back.contains(&asked) {
            self.desired.read_back.push(asked);
        }
    }

    /// Whether a texture is a volume.
    fn is_volume(&self, target: &InspectTarget) -> bool {
        let info = self.sides[target.side.min(1)].info.as_ref();
        info.is_some_and(|info| {
            let number = info.graph.texture(&target.texture);
            number.is_some_and(|n| info.textures.get(n).is_some_and(|t| t.volume))
        })
    }

    fn inspector_tab(&mut self, ui: &mut Ui, textures: &[TextureId]) {
        self.view_buttons(ui);
        if self.desired.sides[1].is_none() {
            self.tabs.inspector.target.side = 0;
        } else {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.tabs.inspector.target.side, 0, "A");
                ui.selectable_value(&mut self.tabs.inspector.target.side, 1, "B");
            });
        }
        let Some(info) = self.sides[self.tabs.inspector.target.side].info.clone() else {
            ui.weak(self.waiting_text());
            return;
        };
        let plan = self.choose(ui, &info);
        let Some(plan) = plan else {
            ui.weak("The graph has no textures");
            return;
        };
        self.read_texture();
        ui.separator();
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| {
                self.tones(ui, &plan);
                self.numbers(ui);
                if !self.dock.shows(&Pane::Texture) && self.tabs.inspector.shown.is_some() {
                    let size = Vec2::new(
                        ui.available_width(),
                        ui.available_width().max(ui.available_height()),
                    );
                    ui.allocate_ui(size, |ui| self.inspected(ui, textures));
                }
            });
    }

    /// Chooses the texture of the picture if the graph does not have the chosen one, or none was.
    /// None if it has no textures.
    pub(super) fn choose_first(&mut self, info: &GraphInfo) -> Option<()> {
        let mut names = info.graph.textures.iter().map(|t| t.0.as_str());
        let chosen = &self.tabs.inspector.target;
        if !names.clone().any(|name| name == chosen.texture) {
            let preferred = info.graph.hdr.as_deref().or(info.graph.output.as_deref());
            let name = preferred.or(names.next())?.to_string();
            let side = chosen.side;
            self.tabs.inspector.open(side, name);
        }
        Some(())
    }

    /// Texture, mip, layer or slice.
    fn choose(&mut self, ui: &mut Ui, info: &GraphInfo) -> Option<TexturePlan> {
        let names: Vec<&str> = info.graph.textures.iter().map(|t| t.0.as_str()).collect();
        self.choose_first(info)?;
        self.texture_menu(ui, info, &names);
        let (dock_shows, mut large) = (self.dock.shows(&Pane::Texture), false);
        let inspector = &mut self.tabs.inspector;
        let target = &mut inspector.target;
        let index = info.graph.texture(&target.texture)?;
        let help = &info.graph.textures[index].1.value.help;
        if !help.is_empty() {
            ui.weak(help);
        }
        let plan = info.textures.get(index)?.clone();
        let mip = target.mip;
        choose_part(ui, &plan, target);
        self.link_mip(info, mip, plan.mips.saturating_sub(1));
        if plan.volume {
            self.show_slice(ui, info, &plan);
        }
        let inspector = &mut self.tabs.inspector;
        let target = &inspector.target;
        let shown = inspector.shown.as_ref();
        let waits = shown.is_none_or(|s| s.decoded.target != *target);
        ui.horizontal(|ui| {
            if waits && plan.usage.is_empty() {
                ui.weak("Not allocated: no active pass uses it");
            } else if waits {
                ui.weak("…");
            }
            large = !dock_shows && ui.button("Show large").clicked();
            large |= self.strip_buttons(ui);
        });
        if large {
            self.dock.open(Pane::Texture);
        }
        Some(plan)
    }

    /// A switch that draws the slice over the picture.
    fn show_slice(&mut self, ui: &mut Ui, info: &GraphInfo, plan: &TexturePlan) {
        let slice = info.graph.slice.as_ref();
        let Some(param) = slice.and_then(|name| info.graph.params.param(name)) else {
            return;
        };
        let target = &self.tabs.inspector.target;
        let is_of = |side: &SideRequest| {
            let value = side.params.iter().find(|p| p.0 == param.name).map(|p| &p.1);
            matches!(value, Some(Value::Vector(v)) if v.first().is_some_and(|x| *x >= 0.0))
        };
        let was_on = self.desired.sides[target.side].as_ref().is_some_and(is_of);
        let mut on = was_on;
        ui.checkbox(&mut on, "Show in the picture")
            .on_hover_text("Draws the slice over the picture: lines where it cuts surfaces, a tint in front of them");
        if !(on || was_on) {
            return;
        }
        let extent = plan.mip_extent(target.mip);
        // Parts along x are the same place; those along z are one volume behind the other.
        let edge = if target.axis == 0 {
            extent[1]
        } else {
            extent[target.axis]
        };
        let middle = f64::from(target.slice % edge.max(1)) + 0.5;
        let place = match on {
            true => vec![target.axis as f64, middle / f64::from(edge.max(1))],
            false => vec![-1.0; 2],
        };
        for side in self.desired.sides.iter_mut().flatten() {
            edit::set(side, param, &Value::Vector(place.clone()));
        }
    }

    fn texture_menu(&mut self, ui: &mut Ui, info: &GraphInfo, names: &[&str]) {
        let inspector = &mut self.tabs.inspector;
        let shown = inspector.target.texture.clone();
        let mut chosen = None;
        let menu = egui::ComboBox::from_id_salt("texture").width(ui.available_width() - 8.0);
        let menu = menu.height(500.0).selected_text(describe(info, &shown));
        let menu = menu.show_ui(ui, |ui| {
            for name in names {
                let row = ui.selectable_label(*name == shown, describe(info, name));
                if row.clicked() {
                    chosen = Some((*name).to_string());
                }
            }
        });
        let label = format!("texture {shown}");
        named(&menu.response, egui::WidgetType::ComboBox, &label);
        if let Some(name) = chosen {
            inspector.open(inspector.target.side, name);
        }
    }

    fn tones(&mut self, ui: &mut Ui, plan: &TexturePlan) {
        let before = self.tabs.inspector.tone;
        let mut fit = false;
        let tone = &mut self.tabs.inspector.tone;
        ui.horizontal_wrapped(|ui| {
            if plan.format.count >= 2 {
                ui.selectable_value(&mut tone.channel, Channel::Rgb, "RGB");
            }
            for (i, name) in ["R", "G", "B", "A"]
                .iter()
                .enumerate()
                .take(plan.format.count as usize)
            {
                ui.selectable_value(&mut tone.channel, Channel::One(i), *name);
            }
            if plan.format.count >= 3 {
                ui.selectable_value(&mut tone.channel, Channel::Luminance, "luminance");
            }
        });
        if let Some(done) = &self.tabs.inspector.shown {
            histogram::show(ui, done, tone);
        }
        ui.add(
            Slider::new(&mut tone.stops, -12.0..=12.0)
                .step_by(0.1)
                .text("stops"),
        );
        ui.horizontal(|ui| {
            let speed = f64::from((tone.high - tone.low).abs()).max(1e-6) * 0.005;
            let field = DragValue::new(&mut tone.low).speed(speed).max_decimals(6);
            spin(ui, field, "black").on_hover_text("Value shown as black");
            ui.label("to");
            let field = DragValue::new(&mut tone.high).speed(speed).max_decimals(6);
            spin(ui, field, "white").on_hover_text("Value shown as white");
            fit = ui
                .button("fit range")
                .on_hover_text("From the smallest to the largest finite value")
                .clicked();
            if ui.button("0 to 1").clicked() {
                (tone.low, tone.high, tone.stops) = (0.0, 1.0, 0.0);
            }
        });
        let mut encoded = !tone.raw;
        ui.checkbox(&mut encoded, "linear light").on_hover_text(
            "Treats values as linear light and encodes them for the screen (sRGB). Off: values are shown unchanged. rgba8_srgb textures are already encoded",
        );
        tone.raw = !encoded;
        if plan.format.count == 4 {
            ui.checkbox(&mut tone.checkerboard, "alpha over a checkerboard")
                .on_hover_text("Treats colours as premultiplied by alpha");
        }
        let marked = self.tabs.inspector.shown.as_ref().map(|s| s.marked);
        marks(ui, &mut tone.marks, marked.unwrap_or_default());
        self.tabs
            .inspector
            .show_again(before, fit, &self.setup.wake);
    }

    fn numbers(&mut self, ui: &mut Ui) {
        let Some(done) = &self.tabs.inspector.shown else {
            return;
        };
        let nan: usize = done.values.iter().map(|v| v.nan).sum();
        let infinite: usize = done.values.iter().map(|v| v.infinite).sum();
        if nan + infinite > 0 {
            let text =
                format!("{nan} values are not a number (magenta), {infinite} are infinite (cyan)");
            ui.colored_label(ui.visuals().error_fg_color, text);
        }
        egui::Grid::new("values")
            .num_columns(6)
            .striped(true)
            .show(ui, |ui| {
                for head in ["", "min", "max", "mean", "NaN", "inf"] {
                    ui.weak(head);
                }
                ui.end_row();
                for (name, v) in ["R", "G", "B", "A"].iter().zip(done.values.iter()) {
                    ui.label(*name);
                    if v.count == 0 {
                        (0..3).for_each(|_| drop(ui.label("-")));
                    } else {
                        for x in [f64::from(v.min), f64::from(v.max), v.mean()] {
                            ui.monospace(short_number(x));
                        }
                    }
                    for n in [v.nan, v.infinite] {
                        let text = egui::RichText::new(n.to_string()).monospace();
                        ui.label(if n > 0 {
                            text.color(ui.visuals().error_fg_color)
                        } else {
                            text
                        });
                    }
                    ui.end_row();
                }
            });
    }
}

/// Switches that mark texels, with their numbers.
fn marks(ui: &mut Ui, marks: &mut Marks, [negative, clipped]: [usize; 2]) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Mark:");
        let color = |[r, g, b, _]: [u8; 4]| egui::Color32::from_rgb(r, g, b);
        for (on, name, count, mark) in [
            (&mut marks.negative, "negative", negative, NEGATIVE),
            (&mut marks.clipped, "above white", clipped, CLIPPED),
        ] {
            ui.checkbox(on, format!("{name} ({count})"));
            let (rect, _) = ui.allocate_exact_size(Vec2::splat(10.0), egui::Sense::hover());
            ui.painter().rect_filled(rect, 2.0, color(mark));
        }
    });
}

/// Mip, layer or slice of a texture.
fn choose_part(ui: &mut Ui, plan: &TexturePlan, target: &mut InspectTarget) {
    let last = |n: u32| n.saturating_sub(1);
    target.mip = target.mip.min(last(plan.mips));
    target.layer = target.layer.min(last(plan.layers));
    if plan.mips > 1 {
        let old = target.mip;
        ui.add(Slider::new(&mut target.mip, 0..=last(plan.mips)).text("mip"));
        // The same place of the volume.
        target.slice = if target.mip > old {
            target.slice >> (target.mip - old)
        } else {
            target.slice << (old - target.mip)
        };
    }
    if plan.layers > 1 {
        ui.add(Slider::new(&mut target.layer, 0..=last(plan.layers)).text("layer"));
    }
    if plan.volume {
        ui.horizontal(|ui| {
            ui.label("Slice axis");
            for (axis, name) in ["x", "y", "z"].iter().enumerate() {
                ui.selectable_value(&mut target.axis, axis, *name);
            }
        });
        let size = (plan.extent[target.axis.min(2)] >> target.mip.min(31)).max(1);
        if target.slice >= size {
            target.slice = size / 2;
        }
        ui.add(Slider::new(&mut target.slice, 0..=size - 1).text("slice"));
    }
}

fn short_number(x: f64) -> String {
    let size = x.abs();
    match () {
        () if x == x.trunc() && size < 1e9 => format!("{x}"),
        () if (1e-3..1e6).contains(&size) => format!("{x:.4}"),
        () => format!("{x:.3e}"),
    }
}

/// Name, size and format of a texture.
fn describe(info: &GraphInfo, name: &str) -> String {
    let index = info.graph.texture(name);
    let Some(p) = index.and_then(|i| info.textures.get(i)) else {
        return name.to_string();
    };
    let [x, y, z] = p.extent;
    let size = if p.volume {
        format!("{x}×{y}×{z}")
    } else {
        format!("{x}×{y}")
    };
    let layers = if p.layers > 1 {
        format!(", {} layers", p.layers)
    } else {
        String::new()
    };
    let mips = if p.mips > 1 {
        format!(", {} mips", p.mips)
    } else {
        String::new()
    };
    format!("{name}  {size} {}{layers}{mips}", p.format.name)
}
