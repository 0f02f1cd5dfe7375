//! How much patterns are distorted, in words.

use super::report::Report;
use project::document::Document;
use render::distortion::LayerDistortion;
use serde_json::json;

/// Adds the distortion of each layer (bottom to top) and of all together; nothing where none was measured.
pub(super) fn say(document: &Document, layers: &[LayerDistortion], report: &mut Report) {
    if layers.is_empty() {
        return;
    }
    let percent = |part: f64, of: f64| if of > 0.0 { 100.0 * part / of } else { 0.0 };
    let line = |name: &str, found: &LayerDistortion| {
        format!(
            "  {name}: {:.2} % of the painted area (aspect ratio above 2: {:.2} %, area factor outside 0.5 to 2: {:.2} %)",
            100.0 * found.share(),
            percent(found.narrow_m2, found.area_m2),
            percent(found.scaled_m2, found.area_m2)
        )
    };
    let all = LayerDistortion::total(layers);
    let names = document.stratigraphy().layer_names_bottom_up();
    report.say("distortion of patterns");
    let rows = names.iter().zip(layers).rev().filter(|(_, found)| found.area_m2 > 0.0);
    for (name, found) in rows.clone() {
        report.say(line(name, found));
    }
    report.say(line("all layers", &all));
    let row = |name: &str, found: &LayerDistortion| json!({ "layer": name, "share": found.share(), "measured": found });
    report.field("distortion", rows.map(|(name, found)| row(name, found)).collect::<Vec<_>>());
    report.field("distortion_share", all.share());
}
