//! What people write by hand, and what a project and the window keep as text. The environment names which (`FUZZ_FORMAT`): `project`
//! (`project.toml`), `scene`, `step` (a step of the history), `proposals` (of faults) or `settings` (of the window).

#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use app::state::Remembered;
use project::content;
use project::document::Document;
use project::folder::Step;
use project::interpretation::proposals::Proposals;

static KIND: LazyLock<String> = LazyLock::new(|| std::env::var("FUZZ_FORMAT").unwrap_or_default());

/// Writes what fuzzing starts from to the folder that the environment names (`FUZZ_SEEDS`), if it names one.
fn write_seeds() -> Result<(), Box<dyn std::error::Error>> {
    let Some(corpus) = std::env::var_os("FUZZ_SEEDS") else { return Ok(()) };
    let seed = |kind: &str, text: &str| {
        let folder = Path::new(&corpus).join(format!("documents-{kind}"));
        std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(folder.join("seed"), text))
    };
    let project = fuzz::scenes::document().to_text(Path::new("project.toml"))?;
    seed("project", &project)?;
    seed("scene", &toml::to_string(&render::Scene::default())?)?;
    seed("step", &toml::to_string(&Step { summary: "create".into(), project, command: None })?)?;
    seed("proposals", PROPOSALS)?;
    let mut settings = Remembered::default();
    settings.add(Path::new("a.petro"));
    seed("settings", &toml::to_string(&settings)?)?;
    Ok(())
}

/// Proposals of one fault.
const PROPOSALS: &str = r#"{"horizons":["a"],"proposals":[],"repeats":[],"unit":"ms"}"#;

fn check_project(text: &str) {
    let path = Path::new("project.toml");
    if let Ok(document) = Document::from_text(text, path) {
        // What was read can be written, and reads as the same.
        let again = document.to_text(path).unwrap_or_else(|error| panic!("{error}"));
        Document::from_text(&again, path).unwrap_or_else(|error| panic!("{error}\n{again}"));
    }
}

libfuzzer_sys::fuzz_target!(init: write_seeds().unwrap_or_else(|error| panic!("{error}")), |data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match KIND.as_str() {
        "project" => check_project(text),
        "scene" => {
            if let Ok(scene) = toml::from_str::<render::Scene>(text) {
                let _ = scene.validate(&fuzz::survey());
            }
        }
        "step" => {
            if let Ok(step) = toml::from_str::<Step>(text) {
                check_project(&step.project);
            }
        }
        "proposals" => {
            if let Ok(read) = serde_json::from_str::<Proposals>(text) {
                let _ = read.nothing_new();
                for proposal in &read.proposals {
                    let _ = content::hash_fault(&proposal.fault("F"));
                }
            }
        }
        "settings" => drop(toml::from_str::<Remembered>(text)),
        // The run that only writes seeds.
        "" => {}
        other => panic!("FUZZ_FORMAT {other} is no kind of document"),
    }
});
