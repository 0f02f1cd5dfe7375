//! Commands, undo and redo, crashes and edits by hand, on a project without data.

use super::*;
use crate::command::SetVelocity;
use crate::error::Noun;
use survey::VerticalUnit;

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([4, 5, 6], 25.0, 4.0, VerticalUnit::Milliseconds)
}

fn begun(folder: &Path) -> Project {
    Project::create(&folder.join("a.petro"), Some(geometry())).unwrap().publish().unwrap()
}

fn velocity(velocity_m_s: f64) -> Command {
    Command::SetVelocity(SetVelocity { velocity_m_s })
}

fn bytes(project: &Project) -> String {
    fs::read_to_string(project.root().join("project.toml")).unwrap()
}

#[test]
fn undo_and_redo_restore_every_state_byte_for_byte_through_other_handles() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    let mut states = vec![bytes(&project)];
    for velocity_m_s in [1500.0, 2500.0, 3000.5] {
        project.apply(&velocity(velocity_m_s), &Progress::silent()).unwrap();
        states.push(bytes(&project));
    }
    for state in states.iter().rev().skip(1) {
        let mut other = Project::open(project.root()).unwrap();
        other.undo().unwrap();
        assert_eq!(&bytes(&project), state);
    }
    assert!(matches!(project.undo(), Err(ProjectError::NothingToUndo)));
    for state in &states[1..] {
        Project::open(project.root()).unwrap().redo().unwrap();
        assert_eq!(&bytes(&project), state);
    }
    assert!(matches!(project.redo(), Err(ProjectError::NothingToRedo)));
}

#[test]
fn a_command_after_an_undo_forgets_what_was_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    for velocity_m_s in [1500.0, 2500.0, 3000.0] {
        project.apply(&velocity(velocity_m_s), &Progress::silent()).unwrap();
    }
    project.undo().unwrap();
    project.undo().unwrap();
    project.apply(&velocity(4000.0), &Progress::silent()).unwrap();
    assert!(matches!(project.redo(), Err(ProjectError::NothingToRedo)));
    let steps: Vec<u32> = project.history().iter().map(|line| line.step).collect();
    assert_eq!(steps, [0, 1, 2]);
    project.undo().unwrap();
    assert_eq!(project.document().geometry.as_ref().unwrap().velocity_m_s, 1500.0);
}

#[test]
fn a_refused_command_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    let before = bytes(&project);
    assert!(project.apply(&velocity(-1.0), &Progress::silent()).is_err());
    assert!(project.apply(&velocity(f64::NAN), &Progress::silent()).is_err());
    let cancelled = Progress::silent();
    cancelled.cancel();
    assert!(matches!(project.apply(&velocity(1600.0), &cancelled), Err(ProjectError::Cancelled(_))));
    assert_eq!(bytes(&project), before);
    assert_eq!(project.history().len(), 1);
}

#[test]
fn an_edit_by_hand_is_a_step_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    let path = project.root().join("project.toml");
    fs::write(&path, bytes(&project).replace("velocity_m_s = 2000.0", "velocity_m_s = 1900.0")).unwrap();
    project.apply(&velocity(2600.0), &Progress::silent()).unwrap();
    project.undo().unwrap();
    assert_eq!(project.document().geometry.as_ref().unwrap().velocity_m_s, 1900.0);
    project.undo().unwrap();
    assert_eq!(project.document().geometry.as_ref().unwrap().velocity_m_s, 2000.0);
}

#[test]
fn comments_stay_when_a_command_writes_the_state() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    let path = project.root().join("project.toml");
    let text = bytes(&project).replace("velocity_m_s", "# from the checkshots of W1\nvelocity_m_s");
    fs::write(&path, &text).unwrap();
    project.apply(&velocity(2600.0), &Progress::silent()).unwrap();
    assert!(bytes(&project).contains("# from the checkshots of W1\nvelocity_m_s = 2600.0"), "{}", bytes(&project));
    project.undo().unwrap();
    assert_eq!(bytes(&project), text.replace("step = 0", "step = 1"));
}

#[test]
fn a_crash_before_the_rename_leaves_the_old_state_and_one_after_it_the_new() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    project.apply(&velocity(1500.0), &Progress::silent()).unwrap();
    let old = bytes(&project);
    let unfinished = |file: &str| storage::begin(project.root(), file).unwrap();
    // Before: the step is prepared, project.toml is not replaced, data is half written.
    let first = project.root().join("history/0001.toml");
    let step = fs::read_to_string(&first).unwrap().replace("1500.0", "1700.0");
    fs::write(unfinished("history/0002.toml"), step).unwrap();
    fs::write(unfinished("history/0003.toml"), "summ").unwrap();
    fs::create_dir_all(unfinished("volumes/x.zarr/0")).unwrap();
    fs::write(unfinished("project.toml"), "vers").unwrap();
    Project::open(project.root()).unwrap().undo().unwrap();
    Project::open(project.root()).unwrap().redo().unwrap();
    assert_eq!(bytes(&project), old);
    assert_eq!(project.history().len(), 2);
    assert!(!project.root().join(storage::UNFINISHED).exists());
    // After: project.toml is the new state, its step has not got its place.
    fs::rename(&first, unfinished("history/0001.toml")).unwrap();
    Project::open(project.root()).unwrap().undo().unwrap();
    assert_eq!(project.history().len(), 2);
}

#[test]
fn pruning_forgets_the_way_but_not_the_state() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    project.apply(&velocity(1500.0), &Progress::silent()).unwrap();
    let state = bytes(&project);
    project.prune().unwrap();
    assert_eq!(bytes(&project), state);
    assert!(matches!(project.undo(), Err(ProjectError::NothingToUndo)));
    project.apply(&velocity(1600.0), &Progress::silent()).unwrap();
    project.undo().unwrap();
    assert_eq!(bytes(&project), state);
}

#[test]
fn a_project_that_is_not_published_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    drop(Project::create(&folder.path().join("a.petro"), None).unwrap());
    assert!(storage::names_in(folder.path()).is_empty());
    let _first = Project::create(&folder.path().join("a.petro"), None).unwrap();
    assert!(matches!(Project::create(&folder.path().join("a.petro"), None), Err(ProjectError::Locked { .. })));
}

#[test]
fn what_is_no_project_is_said_to_be_none() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(Project::open(folder.path()), Err(ProjectError::NotAProject { .. })));
    assert!(matches!(Project::open(&folder.path().join("x")), Err(ProjectError::NotFound { .. })));
    let project = begun(folder.path());
    assert!(matches!(Project::create(project.root(), None).map(|_| ()), Err(ProjectError::Exists { .. })));
    let path = project.root().join("project.toml");
    fs::write(&path, "version = 99\n").unwrap();
    assert!(matches!(Project::open(project.root()), Err(ProjectError::Newer { found: 99, .. })));
}

#[test]
fn a_kill_between_forgetting_a_step_and_releasing_its_data_orphans_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    let path = folder.path().join("t.png");
    image::RgbImage::from_pixel(2, 2, image::Rgb([1, 0, 0])).save(&path).unwrap();
    let texture = Command::AddTexture(crate::command::AddTexture { path, width_mm: None });
    project.apply(&texture, &Progress::silent()).unwrap();
    project.undo().unwrap();
    // Killed after the undone step was taken out of the history.
    fs::rename(
        project.root().join("history/0001.toml"),
        storage::begin(project.root(), "forgotten/0001.toml").unwrap(),
    )
    .unwrap();
    assert!(project.root().join("textures/t.png").exists());
    project.apply(&velocity(1500.0), &Progress::silent()).unwrap();
    assert!(!project.root().join("textures/t.png").exists());
}

#[test]
fn a_damaged_step_is_told_and_stops_no_work() {
    let folder = tempfile::tempdir().unwrap();
    let mut project = begun(folder.path());
    let path = folder.path().join("t.png");
    image::RgbImage::from_pixel(2, 2, image::Rgb([1, 0, 0])).save(&path).unwrap();
    let texture = Command::AddTexture(crate::command::AddTexture { path, width_mm: None });
    for command in [velocity(1500.0), texture] {
        project.apply(&command, &Progress::silent()).unwrap();
    }
    project.undo().unwrap();
    // The undone step that holds the texture, cut in its middle; and the step in effect, unreadable.
    let step = project.root().join("history/0002.toml");
    let text = fs::read_to_string(&step).unwrap();
    fs::write(&step, &text[..text.len() - 20]).unwrap();
    fs::write(project.root().join("history/0001.toml"), [0xff, 0xfe, 0]).unwrap();
    assert!(project.history()[1].summary.contains("cannot be read"), "{:?}", project.history());
    project.apply(&velocity(1600.0), &Progress::silent()).unwrap();
    assert!(project.root().join("textures/t.png").exists(), "it may still be somebody's");
    project.prune().unwrap();
    assert_eq!(project.history().len(), 1);
    fs::remove_dir_all(project.root().join("history")).unwrap();
    project.apply(&velocity(1700.0), &Progress::silent()).unwrap();
    project.apply(&velocity(1800.0), &Progress::silent()).unwrap();
    project.undo().unwrap();
    assert_eq!(project.document().geometry.as_ref().unwrap().velocity_m_s, 1700.0);
}

/// Numbers that look random (the multiplicative congruential generator of Park and Miller).
struct Dice(u64);

impl Dice {
    fn throw(&mut self, sides: u64) -> u64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 % sides
    }
}

/// Everything a state consists of: its text and the bytes of the data it refers to.
fn whole(project: &Project) -> (String, Vec<Vec<u8>>) {
    let project = Project::open(project.root()).unwrap();
    let data = project.document().files().map(|file| fs::read(project.root().join(file)).unwrap()).collect();
    (bytes(&project), data)
}

/// Any sequence of commands, undos, redos and cancelled commands walks along one line of states, and each
/// comes back with its data.
#[test]
fn any_walk_through_the_history_meets_the_same_states() {
    for seed in 1..6 {
        let mut dice = Dice(seed);
        let folder = tempfile::tempdir().unwrap();
        let mut project = begun(folder.path());
        let (mut line, mut at) = (vec![whole(&project)], 0);
        for turn in 0..60u64 {
            match dice.throw(4) {
                0 if at > 0 => {
                    project.undo().unwrap();
                    at -= 1;
                }
                1 if at + 1 < line.len() => {
                    project.redo().unwrap();
                    at += 1;
                }
                2 => {
                    let cancelled = Progress::silent();
                    cancelled.cancel();
                    assert!(project.apply(&command_of(&mut dice, turn, folder.path()), &cancelled).is_err());
                }
                _ => {
                    if project.apply(&command_of(&mut dice, turn, folder.path()), &Progress::silent()).is_ok() {
                        line.truncate(at + 1);
                        line.push(whole(&project));
                        at += 1;
                    }
                }
            }
            assert_eq!(whole(&project), line[at], "seed {seed}, turn {turn}");
        }
        let kept = storage::names_in(&project.root().join("textures")).len();
        let known: std::collections::BTreeSet<&Vec<u8>> = line.iter().flat_map(|(_, data)| data).collect();
        assert_eq!(kept, known.len(), "data that no state refers to is gone, and no other");
    }
}

/// A command of any kind; some are refused.
fn command_of(dice: &mut Dice, turn: u64, folder: &Path) -> Command {
    match dice.throw(4) {
        0 => velocity(1000.0 + dice.throw(2000) as f64),
        1 => Command::AddScene(crate::command::AddScene {
            name: format!("s{}", dice.throw(5)),
            scene: render::Scene { exaggeration: 1.0 + turn as f64, ..render::Scene::default() },
        }),
        2 => Command::Remove(crate::command::Remove { noun: Noun::Scene, name: format!("s{}", dice.throw(5)) }),
        _ => {
            let path = folder.join(format!("t{turn}.png"));
            image::RgbImage::from_pixel(2, 2, image::Rgb([turn as u8, 0, 0])).save(&path).unwrap();
            Command::AddTexture(crate::command::AddTexture { path, width_mm: None })
        }
    }
}
