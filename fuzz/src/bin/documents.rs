//! What people write by hand: `project.toml`, and a scene.

#![no_main]

use std::path::Path;

use petroglyph::project::Document;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let path = Path::new("project.toml");
    if let Ok(document) = Document::from_text(text, path) {
        // What was read can be written, and reads as the same.
        let again = document.to_text(path).unwrap_or_else(|error| panic!("{error}"));
        Document::from_text(&again, path).unwrap_or_else(|error| panic!("{error}\n{again}"));
    }
    let _ = toml::from_str::<render::Scene>(text);
});
