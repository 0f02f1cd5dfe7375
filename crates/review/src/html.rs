//! A review as one page for a browser: nothing is loaded from anywhere else.
//!
//! The page holds its pictures as ordinary images, so that it shows them without script, and when it is printed. The
//! viewer and the style are the same bytes in every page, and the page's Content-Security-Policy names their hashes and
//! nothing else: no other script runs, and no request leaves. The model is a block of data, in which the letters that
//! could end it are written as escapes; the viewer puts words on the page as text alone.

use crate::model::Model;
use crate::page::{self, data_uri};
use crate::picture::jpeg;
use crate::size::SizeEstimate;
use project::error::ProjectError;
use project::folder::refuse_inside_project;
use std::fmt::Write as _;
use std::path::Path;
use survey::Progress;

/// The viewer, bundled by `viewer/build.sh`.
const VIEWER: &str = include_str!("../viewer/dist/viewer.js");
/// The style of the page.
const STYLE: &str = include_str!("../viewer/dist/viewer.css");
/// SHA-256 of both in base64, a line each.
const HASHES: &str = include_str!("../viewer/dist/hashes.txt");
/// Largest size of a page unless stated, MB.
pub const SIZE_MB: f64 = 12.0;
/// Limits of the size of a page, MB.
pub const SIZES_MB: [f64; 2] = [0.5, 2000.0];
/// Steps in which pictures are made smaller until the page fits.
const ATTEMPTS: usize = 6;

/// A page that was written.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct WrittenPage {
    /// Its bytes.
    pub bytes: u64,
    /// The share of the density that the pictures of faces have: 1, or less where the page had to be made smaller.
    pub density_share: f64,
    /// Scenes in it.
    pub scenes: usize,
    /// Triangles of the first scene's block, horizons and faults.
    pub triangles: usize,
}

/// Writes the page of a model, of at most `limit` bytes if that is possible; completely or not at all.
///
/// # Errors
/// The page cannot be as small as `limit`, the file lies inside a project or cannot be written, or the user cancelled.
pub fn write(model: &Model, path: &Path, limit: u64, progress: &Progress) -> Result<WrittenPage, ProjectError> {
    refuse_inside_project(path)?;
    progress.begin("page", 2);
    let data = page::data(&model.covers)?;
    progress.step(1)?;
    let mut share = 1.0;
    let mut text = String::new();
    for _ in 0..ATTEMPTS {
        let illustrated = page::illustrations(&model.covers, share)?;
        progress.check()?;
        text = whole(model, &page::page(model, &illustrated, &data)?)?;
        if text.len() as u64 <= limit {
            break;
        }
        let pictures: usize = illustrated.iter().flatten().map(String::len).sum();
        let fixed = text.len() - pictures;
        let room = (limit as f64 - fixed as f64).max(0.0) / (pictures as f64).max(1.0);
        let next = share * (0.96 * room).sqrt();
        if next < 0.08 {
            break;
        }
        share = next;
    }
    let bytes = text.len() as u64;
    if bytes > limit {
        let megabytes = |bytes: u64| format!("{:.1} MB", bytes as f64 / 1e6);
        let (found, limit) = (megabytes(bytes), megabytes(limit));
        return Err(ProjectError::OverBudget { what: "the review", found, limit });
    }
    if share < 1.0 {
        progress.warn(format!(
            "pictures of faces have {:.0} % of the density that was asked for, so that the page has at most {:.1} MB",
            100.0 * share,
            limit as f64 / 1e6
        ));
    }
    progress.step(1)?;
    store::replace_file(path, text.as_bytes())?;
    Ok(WrittenPage { bytes, density_share: share, scenes: model.scenes.len(), triangles: triangles(model) })
}

/// Triangles of the first scene's block, horizons and faults.
pub fn triangles(model: &Model) -> usize {
    let faces = model.scenes.iter().take(1).flat_map(|scene| &scene.cut.faces).map(|face| &face.mesh);
    let surfaces = model.horizons.iter().chain(&model.faults).map(|surface| &surface.mesh);
    faces.chain(surfaces).map(|mesh| mesh.triangles.len()).sum()
}

/// About how large the page of a model is, with faces of other densities.
///
/// # Errors
/// A picture has no pixels.
pub fn estimate(model: &Model) -> Result<SizeEstimate, ProjectError> {
    let illustrated = page::illustrations(&model.covers, 1.0)?;
    let text = whole(model, &page::page(model, &illustrated, &page::data(&model.covers)?)?)?;
    let pictures: usize = illustrated.iter().flatten().map(String::len).sum();
    Ok(SizeEstimate::new(text.len(), pictures))
}

/// The text of the page.
fn whole(model: &Model, data: &serde_json::Value) -> Result<String, ProjectError> {
    let [script, style] = hashes();
    let policy = format!(
        "default-src 'none'; script-src '{script}'; style-src '{style}'; img-src data: blob:; base-uri 'none'; \
         form-action 'none'"
    );
    let mut page = String::new();
    let title = escaped(&model.title);
    let _ = write!(
        page,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"referrer\" content=\"no-referrer\">\n\
         <meta name=\"generator\" content=\"Petroglyph {}\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <main id=\"still\">\n<h1>{title}</h1>\n",
        env!("CARGO_PKG_VERSION")
    );
    if let Some(warning) = &model.warning {
        let _ = writeln!(page, "<p class=\"warning\">{}</p>", escaped(warning));
    }
    for scene in &model.scenes {
        let name = escaped(&scene.name);
        let picture = data_uri("jpeg", &jpeg(&scene.picture)?);
        let _ = writeln!(
            page,
            "<figure><img src=\"{picture}\" alt=\"{name}: block of {title}\" width=\"{}\" height=\"{}\">\
             <figcaption>{name}, vertical exaggeration {}</figcaption></figure>",
            scene.picture.width(),
            scene.picture.height(),
            scene.scene.exaggeration
        );
    }
    still_legend(model, &mut page)?;
    page.push_str("</main>\n<div id=\"app\" hidden></div>\n<script type=\"application/json\" id=\"model\">");
    page.push_str(&harmless(&data.to_string()));
    let _ = write!(page, "</script>\n<script>{VIEWER}</script>\n</body>\n</html>\n");
    Ok(page)
}

/// The legend, notes and sources for readers without script.
fn still_legend(model: &Model, page: &mut String) -> Result<(), ProjectError> {
    if !model.layers.is_empty() {
        page.push_str("<h2>Layers</h2>\n<ul class=\"legend\">\n");
        for layer in model.layers.iter().rev().filter(|layer| layer.is_seen) {
            let swatch = data_uri("png", &crate::picture::png(&layer.swatch)?);
            let words = [&layer.name, &layer.rock, &layer.age];
            let words: Vec<String> =
                words.into_iter().filter(|word| !word.is_empty()).map(|word| escaped(word)).collect();
            let _ = writeln!(
                page,
                "<li><img src=\"{swatch}\" alt=\"\" width=\"48\" height=\"26\"> {}</li>",
                words.join(", ")
            );
        }
        page.push_str("</ul>\n");
    }
    let doubtful = model.horizons.iter().filter(|horizon| horizon.picked_share < 0.995);
    let doubtful: Vec<String> = doubtful
        .map(|horizon| format!("{}: {:.0} % picked", escaped(&horizon.name), 100.0 * horizon.picked_share))
        .collect();
    if !doubtful.is_empty() {
        let _ = writeln!(page, "<p>Filled or extrapolated in part: {}.</p>", doubtful.join(", "));
    }
    if !model.notes.is_empty() {
        page.push_str("<h2>Notes</h2>\n<ul>\n");
        for note in &model.notes {
            let _ = writeln!(page, "<li>{}</li>", escaped(&note.text));
        }
        page.push_str("</ul>\n");
    }
    let _ = writeln!(page, "<p class=\"sources\">{}</p>", escaped(&model.provenance.join("; ")));
    Ok(())
}

/// The hashes of script and style as a policy names them.
fn hashes() -> [String; 2] {
    let mut lines = HASHES.lines();
    std::array::from_fn(|_| format!("sha256-{}", lines.next().unwrap_or_default().trim()))
}

/// A text between tags or in an attribute.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            other => safe.push(other),
        }
    }
    safe
}

/// JSON in which nothing can end the block of data around it.
fn harmless(json: &str) -> String {
    let mut safe = String::with_capacity(json.len());
    for letter in json.chars() {
        match letter {
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' => {
                let _ = write!(safe, "\\u{:04x}", u32::from(letter));
            }
            other => safe.push(other),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_leave_their_place() {
        let name = "</script><img src=x onerror=\"alert(1)\">&\u{2028}'";
        let json = harmless(&serde_json::json!({ "name": name }).to_string());
        assert!(!json.contains(['<', '>', '&', '\u{2028}']), "{json}");
        let back: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(back["name"], name);
        assert!(!escaped(name).contains(['<', '>', '"', '\'']));
    }

    #[test]
    fn the_viewer_is_what_its_hash_says_and_cannot_end_its_element() {
        assert_eq!(HASHES.lines().count(), 2);
        assert!(hashes().iter().all(|hash| hash.len() == 51), "{:?}", hashes());
        assert!(!VIEWER.to_lowercase().contains("</script") && !STYLE.contains("</style"));
    }
}
