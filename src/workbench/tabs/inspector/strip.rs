//! Small pictures of textures: those that are pinned, and on request all of the graph.

use super::image::{Decoded, Tone, upright};
use super::{Workbench, first_tone, is_bytes, statistics};
use crate::graph::plan::TexturePlan;
use crate::lab::Texels;
use crate::workbench::background::{Background, Wake};
use crate::workbench::desired::request::InspectTarget;
use crate::workbench::engine::report::GraphInfo;
use crate::workbench::panel::control::named;
use crate::workbench::read_back::{ReadBack, THUMBNAIL};
use egui::{ColorImage, Response, TextureHandle, Ui, Vec2, WidgetType};
use std::sync::Arc;

/// Pinned textures, and the small pictures.
#[derive(Default)]
pub struct Strip {
    /// Pinned parts of textures, and how they are shown.
    pins: Vec<(InspectTarget, Tone)>,
    /// Whether all textures are listed.
    lists_all: bool,
    /// Pictures by the parts that they show.
    pictures: Vec<(InspectTarget, TextureHandle)>,
    work: Background<InspectTarget, ColorImage>,
}

/// The effect of a click on the strip.
enum Click {
    Open(InspectTarget, Option<Tone>),
    Unpin(usize),
}

/// Height of the row, points.
pub const HEIGHT: f32 = THUMBNAIL as f32 + 42.0;

impl Strip {
    /// Whether there is anything to show.
    pub fn is_shown(&self) -> bool {
        self.lists_all || !self.pins.is_empty()
    }

    /// Takes in the texels of a small picture.
    pub fn note(&mut self, target: &InspectTarget, texels: Arc<Texels>, volume: bool, wake: &Wake) {
        let pinned = self.pins.iter().find(|pin| pin.0 == *target);
        let (tone, of) = (pinned.map(|pin| pin.1), target.clone());
        let job = move || small(of, Arc::unwrap_or_clone(texels), volume, tone);
        self.work.start(target.clone(), wake, job);
    }

    /// Takes finished pictures.
    pub fn poll(&mut self, context: &egui::Context) {
        while let Some((target, image)) = self.work.take() {
            let Ok(image) = image else { continue };
            let options = egui::TextureOptions::NEAREST;
            match self.pictures.iter_mut().find(|p| p.0 == target) {
                Some((_, texture)) => texture.set(image, options),
                None => {
                    let texture = context.load_texture("thumbnail", image, options);
                    self.pictures.push((target, texture));
                }
            }
        }
    }
}

/// The picture of texels, with a tone or one that fits.
fn small(target: InspectTarget, texels: Texels, volume: bool, tone: Option<Tone>) -> ColorImage {
    let fits = tone.is_none() && !is_bytes(&texels);
    let tone = tone.unwrap_or_else(|| first_tone(&texels, volume, Tone::default()));
    let texels = match volume {
        true => upright(texels, target.axis),
        false => texels,
    };
    let decoded = Decoded::new(target, texels);
    let tone = match fits {
        true => statistics::fit(&tone, &statistics::values(&decoded)),
        false => tone,
    };
    let size = decoded.size.map(|n| n as usize);
    ColorImage::from_rgba_unmultiplied(size, &decoded.image(&tone))
}

impl Workbench {
    /// The pinned textures and the list of all, in one row.
    pub(super) fn texture_strip(&mut self, ui: &mut Ui, info: &GraphInfo) {
        self.tabs.inspector.strip.poll(ui.ctx());
        let mut click = None;
        let pins = self.tabs.inspector.strip.pins.clone();
        let row = egui::ScrollArea::horizontal().auto_shrink(false);
        row.show(ui, |ui| {
            ui.horizontal_top(|ui| {
                for (i, (target, tone)) in pins.iter().enumerate() {
                    let name = format!("{} mip {}", target.texture, target.mip);
                    let picture = self.small_picture(ui, target, &name, "pinned");
                    if picture.clicked() {
                        click = Some(Click::Open(target.clone(), Some(*tone)));
                    }
                    let unpin = |ui: &mut Ui| {
                        if ui.button("Unpin").clicked() {
                            click = Some(Click::Unpin(i));
                            ui.close();
                        }
                    };
                    picture.context_menu(unpin);
                }
                if self.tabs.inspector.strip.lists_all {
                    for target in all(info, self.tabs.inspector.target.side) {
                        let name = target.texture.clone();
                        if self.small_picture(ui, &target, &name, "show").clicked() {
                            let whole = InspectTarget { mip: 0, ..target };
                            click = Some(Click::Open(whole, None));
                        }
                    }
                }
            });
        });
        match click {
            Some(Click::Open(target, tone)) => self.tabs.inspector.open_part(target, tone),
            Some(Click::Unpin(i)) => drop(self.tabs.inspector.strip.pins.remove(i)),
            None => {}
        }
    }

    /// A button with the picture and the name of a texture.
    fn small_picture(
        &mut self,
        ui: &mut Ui,
        target: &InspectTarget,
        name: &str,
        label: &str,
    ) -> Response {
        self.desired
            .read_back
            .push(ReadBack::Thumbnail(target.clone()));
        let pictures = &self.tabs.inspector.strip.pictures;
        let texture = pictures.iter().find(|p| p.0 == *target).map(|p| &p.1);
        let size = Vec2::splat(THUMBNAIL as f32);
        let inner = ui.vertical(|ui| {
            ui.set_width(size.x);
            let button = match texture {
                Some(texture) => {
                    let image =
                        egui::Image::new(texture).fit_to_exact_size(size - Vec2::splat(8.0));
                    ui.add_sized(size, egui::Button::image(image))
                }
                None => ui.add_sized(size, egui::Button::new("…")),
            };
            ui.add(egui::Label::new(name).truncate());
            button
        });
        let button = inner.inner;
        named(&button, WidgetType::Button, &format!("{label} {name}"));
        button.on_hover_text(name)
    }

    /// Buttons that pin the shown part of a texture, and list all textures. Returns whether the strip
    /// is to be seen.
    pub(super) fn strip_buttons(&mut self, ui: &mut Ui) -> bool {
        let inspector = &mut self.tabs.inspector;
        let pin = (inspector.target.clone(), inspector.tone);
        let strip = &mut inspector.strip;
        let is_new = !strip.pins.iter().any(|other| other.0 == pin.0);
        let button = ui.add_enabled(is_new, egui::Button::new("Pin"));
        let about =
            "Pins a thumbnail of this level or slice below the texture. A right click unpins it";
        let pinned = button.on_hover_text(about).clicked();
        if pinned {
            strip.pins.push(pin);
        }
        let about = "Shows thumbnails of all textures below the texture. They take memory and are read every 2 s while the picture changes";
        let all = ui.toggle_value(&mut strip.lists_all, "All textures");
        pinned || all.on_hover_text(about).clicked() && strip.lists_all
    }
}

/// The textures that passes use, at the last level that has the texels of a small picture.
fn all(info: &GraphInfo, side: usize) -> Vec<InspectTarget> {
    let declared = info.graph.textures.iter().zip(&info.textures);
    let used = declared.filter(|t| !t.1.usage.is_empty());
    let target = |(name, plan): (&String, &TexturePlan)| {
        let longest = plan.extent[0].max(plan.extent[1]);
        InspectTarget {
            side,
            texture: name.clone(),
            mip: (longest / THUMBNAIL).max(1).ilog2().min(plan.mips - 1),
            layer: 0,
            axis: 2,
            slice: u32::MAX,
        }
    };
    used.map(|((name, _), plan)| target((name, plan))).collect()
}
