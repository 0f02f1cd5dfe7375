//! Writes the projects and scenes that fuzzing starts from: `fuzz-document-seeds CORPUS`.

use std::fs;
use std::path::Path;

use petroglyph::project::Document;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some(corpus) = std::env::args_os().nth(1) else {
        return Err("give the folder to write into".into());
    };
    let folder = Path::new(&corpus).join("documents");
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("scene"), toml::to_string(&render::Scene::default())?)?;
    let document = Document::empty(Some(fuzz::survey()));
    fs::write(folder.join("project"), document.to_text(Path::new("project.toml"))?)?;
    Ok(())
}
