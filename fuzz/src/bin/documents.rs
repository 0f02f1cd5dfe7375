//! What people write by hand, and what a project and the window keep as text. The environment names which (`FUZZ_FORMAT`): `project`
//! (`project.toml`), `scene`, `step` (a step of the history), `proposals` (of faults), `settings` (of the window) or
//! `geological-history` (of a block).

#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use app::state::Remembered;
use history::History;
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
    seed("geological-history", GEOLOGICAL_HISTORY)?;
    Ok(())
}

/// Proposals of one fault.
const PROPOSALS: &str = r#"{"horizons":["a"],"proposals":[],"repeats":[],"unit":"ms"}"#;

/// One of each event that moves rock in its own way, and of what is laid down, cut and intruded.
const GEOLOGICAL_HISTORY: &str = r#"
size = [4000, 3000, 1500]
events = [
  { kind = "beds", beds = [ { rock = "granite", thickness = 900, name = "Basement" },
      { rock = "shale", thickness = 150, to = 0, direction = 45, over = [-500, 500] },
      { rock = "sandstone", thickness = 250, shape = "channel", at = [2000, 1500, 0], width = 600, meander = 90 } ] },
  { kind = "tilt", dip = 12, direction = 90 },
  { kind = "fold", wavelength = 1800, amplitude = 120, axis = 20, plunge = 5, shape = "chevron" },
  { kind = "fault", name = "F1", at = [2000, 1500, 0], strike = 10, dip = 60, slip = 200, extent = [3000, 2000] },
  { kind = "fault", slip = 300, shape = "listric", detachment = 1400, shear = 70 },
  { kind = "erosion", depth = 200, roughness = 20, wavelength = 700 },
  { kind = "dyke", thickness = 20, count = 3 },
  { kind = "pluton", radius = 500, aureole = 90 },
  { kind = "salt", radius = 400, top = 300 },
  { kind = "terrain", depth = 80, valleys = 0.5 },
]
"#;

/// A history that is read answers everywhere, without a number that is none.
fn check_history(text: &str) {
    let Ok(history) = History::from_toml(text) else { return };
    let (stage, size) = (history.last_stage(), history.size());
    for share in [0.1, 0.5, 0.9] {
        let at = size * share;
        if let Some(rock) = stage.place(at).rock() {
            let _ = stage.coordinates(rock, at);
        }
        let _ = stage.ground(at.truncate());
    }
    let _ = history.notes();
}

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
        "geological-history" => check_history(text),
        "settings" => drop(toml::from_str::<Remembered>(text)),
        // The run that only writes seeds.
        "" => {}
        other => panic!("FUZZ_FORMAT {other} is no kind of document"),
    }
});
