//! Colours, text sizes and spacing, in one place.
//!
//! Every colour of the window stands in a [`Palette`]. Status colours mean the same everywhere (green fine, yellow
//! warning, red error) and are never the only sign: a word or a shape goes with each.

use egui::{Color32, CornerRadius, FontFamily, FontId, Stroke, Style, TextStyle, Theme, Ui, Visuals, vec2};

/// The window's colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// Behind everything, and behind the graph.
    pub ground: Color32,
    /// Side, top and bottom panels.
    pub panel: Color32,
    /// Groups, indicators and fields that lie on a panel.
    pub raised: Color32,
    /// Separators and outlines.
    pub line: Color32,
    pub text: Color32,
    /// Labels and units: there when looked for.
    pub weak_text: Color32,
    /// What has focus, what can be moved.
    pub accent: Color32,
    /// Behind what was chosen.
    pub chosen: Color32,
    pub ok: Color32,
    pub warning: Color32,
    pub error: Color32,
    /// The Stop button, and nothing else.
    pub stop: Color32,
    pub on_stop: Color32,
    /// Lines of the graph, in the order of the channels.
    pub traces: [Color32; 24],
    /// Words of a program.
    pub syntax: Syntax,
}

/// Colours of the words of a program, on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Syntax {
    pub command: Color32,
    pub operator: Color32,
    pub kind: Color32,
    pub register: Color32,
    pub directive: Color32,
    pub number: Color32,
    pub text: Color32,
    pub comment: Color32,
    pub label: Color32,
}

const fn hex(rgb: u32) -> Color32 {
    Color32::from_rgb((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
}

const DARK: Palette = Palette {
    ground: hex(0x17_19_1d),
    panel: hex(0x1f_22_27),
    raised: hex(0x2a_2e_35),
    line: hex(0x3a_40_49),
    text: hex(0xdf_e3_e9),
    weak_text: hex(0xa6_b0_bc),
    accent: hex(0x4a_9d_f0),
    chosen: hex(0x23_42_65),
    ok: hex(0x45_c0_6b),
    warning: hex(0xf0_b9_29),
    error: hex(0xff_5d_57),
    stop: hex(0xd4_2c_2c),
    on_stop: Color32::WHITE,
    traces: DARK_TRACES,
    syntax: Syntax {
        command: hex(0x6c_b2_f7),
        operator: hex(0xc8_a2_f2),
        kind: hex(0x4f_d0_c0),
        register: hex(0xf2_c0_6b),
        directive: hex(0xf0_8f_c0),
        number: hex(0xb5_d8_8f),
        text: hex(0xf0_9f_80),
        comment: hex(0x84_94_a4),
        label: hex(0xf0_e0_9a),
    },
};

const LIGHT: Palette = Palette {
    ground: hex(0xff_ff_ff),
    panel: hex(0xf2_f4_f7),
    raised: hex(0xe2_e6_ec),
    line: hex(0xc3_ca_d4),
    text: hex(0x1a_1f_27),
    weak_text: hex(0x4a_54_62),
    accent: hex(0x14_60_b4),
    chosen: hex(0xcb_de_f5),
    ok: hex(0x0f_6c_31),
    warning: hex(0x85_53_00),
    error: hex(0xc4_1c_1c),
    stop: hex(0xc9_1f_1f),
    on_stop: Color32::WHITE,
    traces: LIGHT_TRACES,
    syntax: Syntax {
        command: hex(0x0a_55_b5),
        operator: hex(0x74_2c_b8),
        kind: hex(0x00_70_6a),
        register: hex(0x8a_50_00),
        directive: hex(0xa8_1c_76),
        number: hex(0x2f_6d_10),
        text: hex(0xa6_33_10),
        comment: hex(0x5f_6c_7a),
        label: hex(0x7a_5a_00),
    },
};

/// Setpoint, output, speed, position and current of motor 1, then related hues for those of motor 2, then the rest.
const DARK_TRACES: [Color32; 24] = [
    hex(0xf5_f5_f5),
    hex(0xff_c1_4d),
    hex(0x5a_b8_ff),
    hex(0x5f_dd_8a),
    hex(0xff_7a_9c),
    hex(0xa9_b4_c2),
    hex(0xff_8a_3d),
    hex(0x7c_88_ff),
    hex(0x1f_b5_a8),
    hex(0xd9_6b_f2),
    hex(0xd2_e0_4f),
    hex(0x9f_8a_5c),
    hex(0x8c_e8_e8),
    hex(0xc8_a8_ff),
    hex(0xff_a6_8c),
    hex(0xc0_5a_5a),
    hex(0x8f_b3_66),
    hex(0x66_94_b3),
    hex(0xb3_66_8f),
    hex(0x80_80_b8),
    hex(0xe0_c8_a0),
    hex(0xa0_c8_e0),
    hex(0xc8_e0_a0),
    hex(0xe0_a0_c8),
];

const LIGHT_TRACES: [Color32; 24] = [
    hex(0x22_22_22),
    hex(0xc9_82_00),
    hex(0x0b_72_c9),
    hex(0x12_8a_43),
    hex(0xd0_21_5a),
    hex(0x77_80_8c),
    hex(0xd9_4f_04),
    hex(0x45_4f_d8),
    hex(0x00_7f_76),
    hex(0xa0_25_c0),
    hex(0x7a_86_00),
    hex(0x7a_5c_20),
    hex(0x00_8a_9c),
    hex(0x76_45_d0),
    hex(0xc2_55_34),
    hex(0x8f_2a_2a),
    hex(0x4d_7a_1f),
    hex(0x2a_5f_85),
    hex(0x8a_2f_60),
    hex(0x4a_4a_90),
    hex(0x8a_6a_30),
    hex(0x30_6a_8a),
    hex(0x5a_7a_30),
    hex(0x8a_30_6a),
];

impl Palette {
    pub const fn of_theme(theme: Theme) -> &'static Self {
        match theme {
            Theme::Dark => &DARK,
            Theme::Light => &LIGHT,
        }
    }

    /// Every colour that text is written in, with each that it stands on.
    pub fn texts(&self) -> Vec<(&'static str, Color32, Color32)> {
        let mut all = Vec::new();
        for (name, color) in self.words() {
            all.extend([self.ground, self.panel, self.raised].map(|back| (name, color, back)));
        }
        // What is chosen, and what the pointer is on.
        for (name, color) in [("text", self.text), ("weak text", self.weak_text)] {
            all.extend([self.chosen, self.line].map(|back| (name, color, back)));
        }
        all.push(("Stop", self.on_stop, self.stop));
        let Syntax { command, operator, kind, register, directive, number, text, comment, label } =
            self.syntax;
        let syntax = [command, operator, kind, register, directive, number, text, comment, label];
        all.extend(syntax.map(|color| ("a word of a program", color, self.ground)));
        all
    }

    const fn words(&self) -> [(&'static str, Color32); 6] {
        [
            ("text", self.text),
            ("weak text", self.weak_text),
            ("accent", self.accent),
            ("ok", self.ok),
            ("warning", self.warning),
            ("error", self.error),
        ]
    }

    /// Every colour of a mark, a line of the graph or a ring, with each that it stands on. Lines that only part one thing from another are
    /// none.
    pub fn marks(&self) -> Vec<(&'static str, Color32, Color32)> {
        let mut all = Vec::new();
        for (name, color) in self.words() {
            let backs = [self.ground, self.panel, self.raised, self.chosen];
            all.extend(backs.map(|back| (name, color, back)));
        }
        all.extend(self.traces.map(|color| ("a trace", color, self.ground)));
        all
    }

    /// The palette `ui` is drawn with.
    pub fn of(ui: &Ui) -> &'static Self {
        if ui.visuals().dark_mode { &DARK } else { &LIGHT }
    }
}

/// The name of the text style for live figures.
pub fn figures() -> TextStyle {
    TextStyle::Name("figures".into())
}

/// Sets both themes of `ctx`; which one is shown is [`egui::ThemePreference`]'s business.
pub fn install(ctx: &egui::Context) {
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(theme, |style| set(style, theme));
    }
    // A name that two widgets share is shown in red in builds for tests, which leave out the other assertions of egui.
    ctx.options_mut(|options| options.warn_on_id_clash = cfg!(debug_assertions));
}

/// Cheaper drawing for software rendering: hard edges and no dithering.
pub fn draw_plainly(ctx: &egui::Context, plainly: bool) {
    ctx.tessellation_options_mut(|options| options.feathering = !plainly);
}

fn set(style: &mut Style, theme: Theme) {
    let sizes = [
        (TextStyle::Small, 11.0, FontFamily::Proportional),
        (TextStyle::Body, 13.5, FontFamily::Proportional),
        (TextStyle::Button, 13.5, FontFamily::Proportional),
        (TextStyle::Heading, 18.0, FontFamily::Proportional),
        (TextStyle::Monospace, 12.5, FontFamily::Monospace),
        (figures(), 13.0, FontFamily::Monospace),
    ];
    style.text_styles = sizes.map(|(name, size, family)| (name, FontId::new(size, family))).into();
    style.drag_value_text_style = figures();
    style.spacing.item_spacing = vec2(8.0, 6.0);
    style.spacing.button_padding = vec2(10.0, 4.0);
    style.spacing.interact_size = vec2(40.0, 24.0);
    // The longest list of a setting unfolds in full.
    style.spacing.combo_height = 430.0;
    style.spacing.icon_width = 16.0;
    style.animation_time = 0.0;
    style.visuals = visuals(theme);
}

fn visuals(theme: Theme) -> Visuals {
    let palette = Palette::of_theme(theme);
    let mut visuals = theme.default_visuals();
    visuals.panel_fill = palette.panel;
    visuals.window_fill = palette.panel;
    visuals.window_stroke = Stroke::new(1.0, palette.line);
    visuals.extreme_bg_color = palette.ground;
    visuals.faint_bg_color = palette.raised;
    visuals.weak_text_color = Some(palette.weak_text);
    visuals.warn_fg_color = palette.warning;
    visuals.error_fg_color = palette.error;
    visuals.hyperlink_color = palette.accent;
    visuals.selection.bg_fill = palette.chosen;
    visuals.selection.stroke = Stroke::new(1.0, palette.text);
    visuals.window_corner_radius = CornerRadius::same(6);
    visuals.menu_corner_radius = CornerRadius::same(6);
    let widgets = &mut visuals.widgets;
    let all = [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ];
    for widget in all {
        widget.corner_radius = CornerRadius::same(4);
        widget.fg_stroke = Stroke::new(1.0, palette.text);
        widget.bg_stroke = Stroke::new(1.0, palette.line);
        widget.bg_fill = palette.raised;
        widget.weak_bg_fill = palette.raised;
        widget.expansion = 0.0;
    }
    widgets.hovered.weak_bg_fill = palette.line;
    widgets.hovered.bg_fill = palette.line;
    widgets.hovered.bg_stroke = Stroke::new(1.0, palette.weak_text);
    widgets.active.weak_bg_fill = palette.line;
    widgets.active.bg_fill = palette.line;
    // The ring round what has keyboard focus.
    widgets.active.bg_stroke = Stroke::new(2.0, palette.accent);
    widgets.open.bg_stroke = Stroke::new(1.0, palette.accent);
    visuals
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance, WCAG 2.
    fn luminance(color: Color32) -> f64 {
        let linear = |part: u8| {
            let part = f64::from(part) / 255.0;
            if part <= 0.040_45 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(color.r()) + 0.7152 * linear(color.g()) + 0.0722 * linear(color.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn text_has_the_contrast_that_accessibility_rules_ask_for() {
        for (theme, palette) in [("dark", &DARK), ("light", &LIGHT)] {
            for back in [palette.ground, palette.panel, palette.raised, palette.chosen] {
                assert!(contrast(palette.text, back) >= 7.0, "{theme}: text on {back:?}");
            }
            for (name, color, back) in palette.texts() {
                let found = contrast(color, back);
                assert!(found >= 4.5, "{theme}: {name} {color:?} on {back:?} has {found:.2}");
            }
        }
    }

    #[test]
    fn words_of_a_program_can_be_read() {
        for palette in [&DARK, &LIGHT] {
            let words = palette.texts().into_iter().filter(|(name, ..)| name.contains("program"));
            let found: Vec<f64> = words.map(|(_, color, back)| contrast(color, back)).collect();
            assert!(found.len() == 9 && found.iter().all(|contrast| *contrast >= 4.5), "{found:?}");
        }
    }

    #[test]
    fn indicators_and_traces_stand_out_from_what_is_behind_them() {
        for (theme, palette) in [("dark", &DARK), ("light", &LIGHT)] {
            for (name, color, back) in palette.marks() {
                let found = contrast(color, back);
                assert!(found >= 3.0, "{theme}: {name} {color:?} on {back:?} has {found:.2}");
            }
        }
    }

    #[test]
    fn no_two_traces_have_the_same_colour() {
        for palette in [&DARK, &LIGHT] {
            for (index, color) in palette.traces.iter().enumerate() {
                assert!(!palette.traces[..index].contains(color), "{color:?} twice");
            }
        }
    }
}
