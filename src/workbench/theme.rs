//! Colours, fonts and text sizes of the interface: one table of roles for each theme.

use egui::style::{ScrollStyle, Selection, TextCursorStyle, WidgetVisuals, Widgets};
use egui::{
    Color32, Context, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Margin, Shadow,
    Spacing, Stroke, Style, TextStyle, Theme, Ui, Visuals, vec2,
};
use std::sync::Arc;

/// Colours by role. Text has a contrast of at least 4.5:1 on every ground of its theme, secondary
/// text of at least 6:1 (WCAG 2.2, success criterion 1.4.3); a test computes both.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Roles {
    /// Around pictures.
    pub ground: Color32,
    /// Behind panels, menus and windows.
    pub panel: Color32,
    /// Behind text that is edited, and behind charts.
    pub field: Color32,
    /// Buttons at rest.
    pub button: Color32,
    /// Buttons under the pointer.
    pub hovered: Color32,
    /// Lines between panels.
    pub line: Color32,
    pub text: Color32,
    /// Explanations, units, table heads.
    pub secondary: Color32,
    /// Behind selected widgets.
    pub selected: Color32,
    /// Text and marks on [`Roles::selected`].
    pub on_selected: Color32,
    /// Links, and the filled part of sliders.
    pub accent: Color32,
    /// Values that are not at their default, and warnings.
    pub modified: Color32,
    pub error: Color32,
    /// A reached state, such as a converged picture.
    pub good: Color32,
    /// Behind the costliest pass of the nodes.
    pub hot: Color32,
}

const fn rgb(hex: u32) -> Color32 {
    Color32::from_rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8)
}

const DARK: Roles = Roles {
    ground: rgb(0x1b1d21),
    panel: rgb(0x23262b),
    field: rgb(0x17191c),
    button: rgb(0x353a42),
    hovered: rgb(0x424853),
    line: rgb(0x3d424b),
    text: rgb(0xe4e6ea),
    secondary: rgb(0xb9bfc8),
    selected: rgb(0x2a5a9c),
    on_selected: rgb(0xffffff),
    accent: rgb(0x93c1ff),
    modified: rgb(0xffc454),
    error: rgb(0xffa79d),
    good: rgb(0x86dc98),
    hot: rgb(0x8c4228),
};

const LIGHT: Roles = Roles {
    ground: rgb(0xd9dce1),
    panel: rgb(0xf5f6f8),
    field: rgb(0xffffff),
    button: rgb(0xe1e4e9),
    hovered: rgb(0xd0d5dc),
    line: rgb(0xc3c8d0),
    text: rgb(0x1b1f25),
    secondary: rgb(0x363d47),
    selected: rgb(0xbcd6fb),
    on_selected: rgb(0x0c2a52),
    accent: rgb(0x0f4fa8),
    modified: rgb(0x724400),
    error: rgb(0xa01d16),
    good: rgb(0x15552a),
    hot: rgb(0xffc79e),
};

/// Share of its colour that a disabled widget keeps: secondary text stays at 4.5:1.
const DISABLED: f32 = 0.8;

/// The roles of the theme in use.
pub(crate) fn roles(ui: &Ui) -> &'static Roles {
    match ui.visuals().dark_mode {
        true => &DARK,
        false => &LIGHT,
    }
}

/// Text of titles, in bold.
pub(crate) fn title(text: impl Into<String>) -> egui::RichText {
    egui::RichText::new(text).text_style(TextStyle::Heading)
}

/// Sets fonts and both themes. The theme follows the system's until the user chooses one.
pub(crate) fn install(context: &Context) {
    context.set_fonts(fonts());
    for (theme, roles) in [(Theme::Dark, &DARK), (Theme::Light, &LIGHT)] {
        context.set_style_of(theme, style(theme, roles));
    }
}

/// Noto Sans, with digits of one width, before the icons and egui's own fonts.
fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let bold = FontFamily::Name("bold".into());
    fonts.families.remove(&FontFamily::Proportional);
    let fallback: Vec<String> = ["NotoEmoji-Regular", "emoji-icon-font", "Hack"]
        .map(String::from)
        .into();
    for (family, name, bytes) in [
        (FontFamily::Proportional, "regular", notosans::REGULAR_TTF),
        (bold, "bold", notosans::BOLD_TTF),
    ] {
        let data = Arc::new(FontData::from_static(bytes));
        fonts.font_data.insert(name.into(), data);
        let mut list = vec![name.to_string()];
        list.extend(fallback.iter().cloned());
        fonts.families.insert(family, list);
    }
    egui_phosphor::add_to_fonts(&mut fonts, egui_phosphor::Variant::Regular);
    fonts
}

fn style(theme: Theme, roles: &Roles) -> Style {
    let family = FontFamily::Proportional;
    Style {
        text_styles: [
            (TextStyle::Small, FontId::new(12.0, family.clone())),
            (TextStyle::Body, FontId::new(14.0, family.clone())),
            (TextStyle::Button, FontId::new(14.0, family)),
            (TextStyle::Monospace, FontId::monospace(13.0)),
            (
                TextStyle::Heading,
                FontId::new(14.0, FontFamily::Name("bold".into())),
            ),
        ]
        .into(),
        spacing: Spacing {
            item_spacing: vec2(6.0, 4.0),
            button_padding: vec2(6.0, 2.0),
            menu_margin: Margin::same(6),
            interact_size: vec2(36.0, 22.0),
            slider_width: 100.0,
            tooltip_width: 420.0,
            scroll: ScrollStyle::solid(),
            ..Spacing::default()
        },
        visuals: visuals(theme, roles),
        ..Style::default()
    }
}

fn visuals(theme: Theme, roles: &Roles) -> Visuals {
    let base = theme.default_visuals();
    let round = CornerRadius::same(4);
    let widget = |fill: Color32, edge: Stroke, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: edge,
        corner_radius: round,
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    let line = Stroke::new(1.0, roles.line);
    let focus = Stroke::new(1.0, roles.accent);
    let shadow = |shadow: Shadow| Shadow { blur: 8, ..shadow };
    Visuals {
        weak_text_color: Some(roles.secondary),
        widgets: Widgets {
            noninteractive: widget(roles.panel, line, roles.text),
            inactive: widget(roles.button, Stroke::NONE, roles.text),
            hovered: widget(roles.hovered, line, roles.text),
            active: widget(roles.hovered, focus, roles.text),
            open: widget(roles.hovered, line, roles.text),
        },
        selection: Selection {
            bg_fill: roles.selected,
            stroke: Stroke::new(1.0, roles.on_selected),
        },
        hyperlink_color: roles.accent,
        faint_bg_color: roles.panel.lerp_to_gamma(roles.button, 0.35),
        extreme_bg_color: roles.field,
        code_bg_color: roles.button,
        warn_fg_color: roles.modified,
        error_fg_color: roles.error,
        window_corner_radius: CornerRadius::same(6),
        menu_corner_radius: CornerRadius::same(6),
        window_shadow: shadow(base.window_shadow),
        popup_shadow: shadow(base.popup_shadow),
        window_fill: roles.panel,
        window_stroke: line,
        panel_fill: roles.panel,
        text_cursor: TextCursorStyle {
            stroke: Stroke::new(2.0, roles.accent),
            ..base.text_cursor
        },
        slider_trailing_fill: true,
        disabled_alpha: DISABLED,
        ..base
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance (WCAG 2.2).
    fn luminance(color: Color32) -> f64 {
        let linear = |v: u8| {
            let v = f64::from(v) / 255.0;
            match v <= 0.04045 {
                true => v / 12.92,
                false => ((v + 0.055) / 1.055).powf(2.4),
            }
        };
        let [r, g, b, _] = color.to_array();
        0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn text_stands_out_on_every_ground_of_its_theme() {
        for (name, roles) in [("dark", DARK), ("light", LIGHT)] {
            let grounds = [
                roles.ground,
                roles.panel,
                roles.field,
                roles.button,
                roles.hovered,
            ];
            for (i, ground) in grounds.into_iter().enumerate() {
                let against = |what: &str, color: Color32, least: f64| {
                    let found = contrast(color, ground);
                    assert!(
                        found >= least,
                        "{name}: {what} on ground {i} has {found:.2}:1"
                    );
                };
                against("text", roles.text, 7.0);
                // Secondary text is never on a button under the pointer.
                against(
                    "secondary text",
                    roles.secondary,
                    if i < 3 { 6.0 } else { 4.5 },
                );
                for (what, color) in [
                    ("a link", roles.accent),
                    ("a modified value", roles.modified),
                    ("an error", roles.error),
                    ("a state", roles.good),
                ] {
                    against(what, color, 4.5);
                }
                if i < 3 {
                    let faded = ground.lerp_to_gamma(roles.secondary, DISABLED);
                    against("disabled secondary text", faded, 4.5);
                }
            }
            assert!(contrast(roles.on_selected, roles.selected) >= 4.5, "{name}");
            assert!(contrast(roles.text, roles.hot) >= 4.5, "{name}");
        }
    }

    #[test]
    fn no_text_style_is_below_twelve_points() {
        for roles in [&DARK, &LIGHT] {
            let style = style(Theme::Dark, roles);
            assert!(style.text_styles.values().all(|font| font.size >= 12.0));
        }
    }
}
