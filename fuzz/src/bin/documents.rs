//! What people write by hand: `project.toml`, and a scene.

#![no_main]

use std::path::Path;

use project::document::Document;

/// Writes what fuzzing starts from to the folder that the environment names (`FUZZ_SEEDS`), if it names one.
fn write_seeds() -> Result<(), Box<dyn std::error::Error>> {
    let Some(corpus) = std::env::var_os("FUZZ_SEEDS") else { return Ok(()) };
    let folder = Path::new(&corpus).join("documents");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("scene"), toml::to_string(&render::Scene::default())?)?;
    let document = Document::empty(Some(fuzz::survey()));
    std::fs::write(folder.join("project"), document.to_text(Path::new("project.toml"))?)?;
    Ok(())
}

libfuzzer_sys::fuzz_target!(init: write_seeds().unwrap_or_else(|error| panic!("{error}")), |data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let path = Path::new("project.toml");
    if let Ok(document) = Document::from_text(text, path) {
        // What was read can be written, and reads as the same.
        let again = document.to_text(path).unwrap_or_else(|error| panic!("{error}"));
        Document::from_text(&again, path).unwrap_or_else(|error| panic!("{error}\n{again}"));
    }
    let _ = toml::from_str::<render::Scene>(text);
});
