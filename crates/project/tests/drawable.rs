//! What cannot be drawn is refused by the command that brings it, and told by a check of a project that was edited so.

use project::command::{DrawHorizon, PickFault, Remove, SetContact};
use project::document::{Document, Drawn};
use project::error::Noun;
use project::{Command, Project, ProjectError};
use std::fs;
use std::path::Path;
use survey::{Contact, Progress, SurveyGeometry, VerticalUnit};

const SIZE: [usize; 3] = [30, 24, 40];

fn begun(folder: &Path) -> Project {
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres);
    Project::create(&folder.join("p.petro"), Some(geometry)).unwrap().publish().unwrap()
}

/// Draws a horizon on every third inline, from one depth at its first crossline to another at its last.
fn draw(project: &mut Project, horizon: &str, from: f64, to: f64) -> Result<(), ProjectError> {
    for inline in (1..=SIZE[0]).step_by(3).map(|inline| inline as f64) {
        let points = vec![[inline, 1.0, from], [inline, SIZE[1] as f64, to]];
        let part = Drawn::Line { points, snap: false };
        let command = DrawHorizon { horizon: horizon.to_owned(), colour: None, part };
        project.apply(&Command::DrawHorizon(command), &Progress::silent())?;
    }
    Ok(())
}

fn stick(project: &mut Project, name: &str, sticks: Vec<Vec<[f64; 3]>>) -> Result<String, ProjectError> {
    let command = Command::PickFault(PickFault { name: name.to_owned(), sticks });
    project.apply(&command, &Progress::silent()).map(|effect| effect.summary())
}

fn text(project: &Project) -> String {
    fs::read_to_string(project.root().join("project.toml")).unwrap()
}

/// Sticks down a wall around the middle of the survey, over so many degrees, `radius` inlines wide.
fn around(degrees: f64, count: usize, radius: impl Fn(f64) -> f64) -> Vec<Vec<[f64; 3]>> {
    let stick = |n: usize| {
        let share = n as f64 / (count as f64 - 1.0);
        let (angle, radius) = ((degrees * share).to_radians(), radius(share));
        let (x, y) = (15.0 + radius * angle.cos(), 12.0 + radius * angle.sin());
        vec![[x, y, 10.0], [x, y, 380.0]]
    };
    (0..count).map(stick).collect()
}

#[test]
fn horizons_that_cross_are_refused_by_the_command_that_makes_them_cross() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    draw(&mut project, "Upper", 120.0, 120.0).unwrap();
    let before = text(&project);
    let error = draw(&mut project, "Tilted", 60.0, 240.0).unwrap_err().to_string();
    assert!(error.contains("Upper") && error.contains("Tilted") && error.contains("lies below"), "{error}");
    // The line that crosses is refused, not those before it.
    let lines = |text: &str| text.matches("Tilted").count();
    assert!(lines(&text(&project)) <= lines(&before) + 4, "{}", text(&project));
    assert!(project::check::check(project.root(), &Progress::silent()).unwrap().is_well());
}

#[test]
fn a_contact_and_a_horizon_on_which_others_rely_stay() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    draw(&mut project, "Young", 60.0, 60.0).unwrap();
    draw(&mut project, "Erosion", 120.0, 120.0).unwrap();
    let contact = |contact| Command::SetContact(SetContact { horizon: "Erosion".to_owned(), contact });
    project.apply(&contact(Contact::Erosional), &Progress::silent()).unwrap();
    draw(&mut project, "Old", 80.0, 380.0).unwrap();
    let before = text(&project);
    let error = project.apply(&contact(Contact::Conformable), &Progress::silent()).unwrap_err().to_string();
    assert!(error.contains("\"Erosion\"") && error.contains("\"Old\""), "{error}");
    assert_eq!(text(&project), before);
    // By hand it can be done; a check says so, and it can be mended.
    let path = project.root().join("project.toml");
    fs::write(&path, before.replace("contact = \"erosional\"", "contact = \"conformable\"")).unwrap();
    let found = project::check::check(project.root(), &Progress::silent()).unwrap();
    assert!(!found.is_well() && found.damage.is_empty(), "{found:?}");
    assert_eq!(found.undrawable, [error]);
    let mut project = Project::open(project.root()).unwrap();
    stick(&mut project, "F", around(60.0, 3, |_| 8.0)).unwrap();
    project
        .apply(&Command::Remove(Remove { noun: Noun::Horizon, name: "Old".to_owned() }), &Progress::silent())
        .unwrap();
    assert!(project::check::check(project.root(), &Progress::silent()).unwrap().is_well());
}

#[test]
fn a_fault_that_turns_too_far_is_cut_into_faults_that_are_edited_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    draw(&mut project, "Upper", 120.0, 120.0).unwrap();
    let said = stick(&mut project, "Ring", around(300.0, 21, |_| 9.0)).unwrap();
    assert!(said.contains("turns too far for one surface"), "{said}");
    let names: Vec<String> = project.document().faults.iter().map(|fault| fault.name.clone()).collect();
    assert!(names.len() >= 2 && names.starts_with(&["Ring".to_owned(), "Ring 2".to_owned()]), "{names:?}");
    let sticks: usize = project.document().sticks.iter().map(|drawn| drawn.sticks.len()).sum();
    assert_eq!(sticks, 21 + names.len() - 1, "neighbours share a stick");
    // Each is a fault that was drawn.
    stick(&mut project, "Ring 2", vec![vec![[20.0, 20.0, 10.0], [20.0, 20.0, 380.0]]]).unwrap();
    assert!(project::check::check(project.root(), &Progress::silent()).unwrap().is_well());
    project.undo().unwrap();
    project.undo().unwrap();
    assert!(project.document().faults.is_empty());
    // What turns by a right angle is one fault.
    stick(&mut project, "Corner", around(90.0, 7, |_| 9.0)).unwrap();
    assert_eq!(project.document().faults.len(), 1);
}

#[test]
fn what_no_few_surfaces_fit_is_refused_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    let before = text(&project);
    let spiral = around(360.0 * 9.0, 300, |share| 2.0 + 9.0 * share);
    let error = stick(&mut project, "Spiral", spiral).unwrap_err().to_string();
    assert!(error.contains("\"Spiral\" folds back over itself") && error.contains("give it as several"), "{error}");
    let beside = vec![vec![[36.0, 1.0, 10.0], [36.0, 1.0, 300.0]], vec![[36.0, 20.0, 10.0], [36.0, 20.0, 300.0]]];
    let error = stick(&mut project, "Beside", beside).unwrap_err().to_string();
    assert!(error.contains("no part of fault \"Beside\" lies in the survey"), "{error}");
    assert_eq!(text(&project), before);
}

#[test]
fn a_check_tells_what_render_would_refuse_of_colours_styles_scenes_and_figures() {
    use project::command::ImportVolume;
    use project::document::Polarity;
    use project::pictures::load::{Request, load};
    use project::pictures::scene;
    let folder = tempfile::tempdir().unwrap();
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres);
    let (path, quiet) = (folder.path().join("north.sgy"), Progress::silent());
    let samples = (0..SIZE.iter().product()).map(|n| (n as f32 * 0.3).sin()).collect();
    let volume = survey::Volume::from_samples(SIZE, samples).unwrap();
    files::segy::write(&path, &geometry, &volume, &files::segy::WriteOptions::default(), &quiet).unwrap();
    let mut project = begun(folder.path());
    let options = files::segy::SegyOptions::default();
    let polarity = Polarity::default();
    let import = ImportVolume { path, name: None, polarity, options, origin: None, memory_bytes: None, moved: false };
    project.apply(&Command::Import(import), &quiet).unwrap();
    draw(&mut project, "Upper", 120.0, 120.0).unwrap();
    let (root, before) = (project.root().to_owned(), text(&project));
    assert!(project::check::check(&root, &quiet).unwrap().is_well());
    let clip = before.lines().find(|line| line.starts_with("clip = ")).unwrap().to_owned();
    let document = project.document().clone();
    let changed = |change: &dyn Fn(&mut Document)| {
        let mut document = document.clone();
        change(&mut document);
        document.to_text(&root.join("project.toml")).unwrap()
    };
    let in_layer = "layer = 'above Upper'\ncolour = '#ffffff'\nintervals = [{ k = [0.0, 1e-300], texture = 'sand' }]";
    let by_values = "volume = 'seismic'\nintervals = [{ range = [nan, 1.0], texture = 'sand' }]";
    let steep = "name = 'steep'\n[scene]\nexaggeration = 1e-300";
    let cloud = "name = 'cloud'\n[[scene.media.surroundings]]\nvolume = 'seismic'\nfunction = { domain = [1.0, 1.0], stops = \
                 [{ at = 0.0, colour = '#ffffff' }, { at = 1.0, colour = '#ffffff' }] }";
    let edits: [(&str, String); 8] = [
        ("clip = 0.0", before.replace(&clip, "clip = 0.0")),
        ("clip = nan", before.replace(&clip, "clip = nan")),
        ("interval", before.replace("interval = 10.0", "interval = 1e-300")),
        ("a layer", changed(&|document| document.style.layers.set(toml::from_str(in_layer).unwrap()))),
        ("values", changed(&|document| document.style.scalars.push(toml::from_str(by_values).unwrap()))),
        ("a scene", changed(&|document| document.scenes.push(toml::from_str(steep).unwrap()))),
        ("a medium", changed(&|document| document.scenes.push(toml::from_str(cloud).unwrap()))),
        ("a figure", changed(&|document| document.figures.push(toml::from_str("file = 'block.doc'").unwrap()))),
    ];
    for (what, edited) in edits {
        assert_ne!(edited, before, "{what}");
        fs::write(root.join("project.toml"), edited).unwrap();
        let found = project::check::check(&root, &quiet).unwrap();
        assert!(found.damage.is_empty() && !found.undrawable.is_empty(), "{what}: {found:?}");
        // A picture says the same of what it shows.
        let project = Project::open(&root).unwrap();
        let name = project.document().scenes.first().map(|entry| entry.name.as_str());
        let said = scene::choose(project.document(), name).and_then(|mut scene| {
            scene::prepare(project.document(), &mut scene, &quiet)?;
            load(project::Facts::of(&root, project.document()), &Request::new(&scene), &quiet).map(drop)
        });
        let said = said.err().map(|error| error.to_string());
        let is_told = said.as_ref().is_none_or(|said| found.undrawable.iter().any(|told| told.contains(said)));
        assert!(is_told, "{what}: {said:?}, not {:?}", found.undrawable);
        assert!(said.is_some() || ["a medium", "a figure"].contains(&what), "{what} is drawn");
    }
    fs::write(root.join("project.toml"), &before).unwrap();
    assert!(project::check::check(&root, &quiet).unwrap().is_well());
}
