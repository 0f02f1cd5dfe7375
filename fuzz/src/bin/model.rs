//! A mutated document through the structural model: what it says of the survey, the order of horizons, their contacts and the faults.

#![no_main]

use std::path::Path;

use glam::Vec3;
use project::document::Document;

/// Writes what fuzzing starts from to the folder that the environment names (`FUZZ_SEEDS`), if it names one.
fn write_seeds() -> Result<(), Box<dyn std::error::Error>> {
    let Some(corpus) = std::env::var_os("FUZZ_SEEDS") else { return Ok(()) };
    let folder = Path::new(&corpus).join("model");
    std::fs::create_dir_all(&folder)?;
    let mut document = fuzz::scenes::document();
    std::fs::write(folder.join("project"), document.to_text(Path::new("project.toml"))?)?;
    document.horizons.reverse();
    document.horizons[1].contact = survey::Contact::Erosional;
    document.faults.clear();
    std::fs::write(folder.join("reversed"), document.to_text(Path::new("project.toml"))?)?;
    Ok(())
}

libfuzzer_sys::fuzz_target!(init: write_seeds().unwrap_or_else(|error| panic!("{error}")), |data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(document) = Document::from_text(text, Path::new("project.toml")) else { return };
    let Some(Ok(model)) = fuzz::scenes::model_of(&document) else { return };
    let size = model.size().map(|count| count as f32);
    for n in 0..9 {
        let share = n as f32 / 4.0 - 0.5;
        let region = model.region_at(Vec3::new(size[0] * share, size[1] * (1.0 - share), size[2] * share));
        assert!(usize::from(region.layer) < model.layer_count() && usize::from(region.block) < model.block_count());
    }
});
