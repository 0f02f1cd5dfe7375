//! The look of the window: one accent colour, muted surfaces, text that can be read on a projector.
//!
//! Sizes are points (pixels at a scale of 1). Text on its background has a contrast of at least 7 : 1, weak text of 4.5
//! : 1.

use eframe::egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, Style, TextStyle, Theme, Vec2, Visuals,
};

/// Ochre, as in rock paintings.
pub(crate) const ACCENT_LIGHT: Color32 = Color32::from_rgb(0xa4, 0x4a, 0x1c);
/// The same for the dark theme.
pub(crate) const ACCENT_DARK: Color32 = Color32::from_rgb(0xe5, 0x95, 0x5c);

/// The accent colour of a theme.
pub(crate) fn accent(visuals: &Visuals) -> Color32 {
    if visuals.dark_mode { ACCENT_DARK } else { ACCENT_LIGHT }
}

/// Sets both themes.
pub(crate) fn install(ctx: &Context) {
    ctx.set_style_of(Theme::Light, style(Theme::Light));
    ctx.set_style_of(Theme::Dark, style(Theme::Dark));
    // Where the desktop states no preference, the light theme is used.
    ctx.options_mut(|options| options.fallback_theme = Theme::Light);
}

fn style(theme: Theme) -> Style {
    let mut style = theme.default_style();
    let font = |size: f32| FontId::new(size, FontFamily::Proportional);
    style.text_styles.insert(TextStyle::Heading, font(21.0));
    style.text_styles.insert(TextStyle::Body, font(14.5));
    style.text_styles.insert(TextStyle::Button, font(14.5));
    style.text_styles.insert(TextStyle::Small, font(12.5));
    style.text_styles.insert(TextStyle::Monospace, FontId::new(13.0, FontFamily::Monospace));
    style.spacing.item_spacing = Vec2::new(8.0, 7.0);
    style.spacing.button_padding = Vec2::new(10.0, 4.0);
    style.spacing.interact_size = Vec2::new(40.0, 24.0);
    style.spacing.slider_width = 140.0;
    style.spacing.menu_margin = Margin::same(8);
    style.spacing.window_margin = Margin::same(18);
    style.visuals = visuals(theme);
    style
}

fn visuals(theme: Theme) -> Visuals {
    let dark = theme == Theme::Dark;
    let grey = |light: u8, night: u8| Color32::from_gray(if dark { night } else { light });
    let mut visuals = theme.default_visuals();
    let accent = if dark { ACCENT_DARK } else { ACCENT_LIGHT };
    visuals.panel_fill = if dark { Color32::from_rgb(0x22, 0x24, 0x26) } else { Color32::from_rgb(0xf6, 0xf5, 0xf2) };
    visuals.window_fill = if dark { Color32::from_rgb(0x2a, 0x2c, 0x2f) } else { Color32::from_rgb(0xf9, 0xf8, 0xf6) };
    visuals.extreme_bg_color = if dark { Color32::from_rgb(0x18, 0x1a, 0x1b) } else { Color32::WHITE };
    visuals.faint_bg_color = grey(0xee, 0x2c);
    visuals.window_stroke = Stroke::new(1.0, grey(0xd4, 0x42));
    visuals.window_corner_radius = CornerRadius::same(10);
    visuals.menu_corner_radius = CornerRadius::same(8);
    let shade = Color32::from_black_alpha(if dark { 110 } else { 40 });
    visuals.window_shadow = Shadow { offset: [0, 6], blur: 24, spread: 0, color: shade };
    visuals.popup_shadow = Shadow { offset: [0, 3], blur: 10, spread: 0, color: shade };
    visuals.hyperlink_color = accent;
    visuals.selection.bg_fill = accent.gamma_multiply(if dark { 0.45 } else { 0.26 });
    visuals.selection.stroke =
        Stroke::new(1.0, if dark { Color32::WHITE } else { Color32::from_rgb(0x4a, 0x1f, 0x08) });
    visuals.error_fg_color =
        if dark { Color32::from_rgb(0xff, 0x8a, 0x80) } else { Color32::from_rgb(0xb0, 0x1e, 0x1e) };
    visuals.warn_fg_color =
        if dark { Color32::from_rgb(0xf2, 0xc1, 0x4e) } else { Color32::from_rgb(0x85, 0x5a, 0x00) };
    visuals.slider_trailing_fill = true;
    let text = grey(0x1d, 0xe8);
    let radius = CornerRadius::same(6);
    for widget in [
        &mut visuals.widgets.noninteractive,
        &mut visuals.widgets.inactive,
        &mut visuals.widgets.hovered,
        &mut visuals.widgets.active,
        &mut visuals.widgets.open,
    ] {
        widget.corner_radius = radius;
        widget.fg_stroke.color = text;
        widget.expansion = 0.0;
    }
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, grey(0xd9, 0x3d));
    visuals.widgets.inactive.weak_bg_fill = grey(0xe7, 0x36);
    visuals.widgets.inactive.bg_fill = grey(0xdc, 0x40);
    visuals.widgets.hovered.weak_bg_fill = grey(0xdc, 0x42);
    visuals.widgets.hovered.bg_stroke = Stroke::new(1.0, grey(0xb8, 0x66));
    visuals.widgets.active.weak_bg_fill = accent.gamma_multiply(0.4);
    visuals.widgets.active.bg_stroke = Stroke::new(1.0, accent);
    visuals
}
