//! What is interpreted, from one state of a project to the next.

use super::*;
use files::ImportOptions;
use project::command::{AddHorizon, Age};
use survey::{Contact, VerticalUnit};

#[test]
fn a_state_that_cannot_be_read_leaves_the_one_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("top.csv");
    let lines = (1..=6).flat_map(|inline| (1..=6).map(move |crossline| format!("{inline},{crossline},12\n")));
    std::fs::write(&path, lines.fold("inline,crossline,z\n".to_owned(), |text, line| text + &line)).unwrap();
    let geometry = SurveyGeometry::regular([6, 6, 8], 25.0, 4.0, VerticalUnit::Metres);
    let mut new = Project::create(&folder.path().join("a.petro"), Some(geometry)).unwrap();
    let add = AddHorizon {
        path,
        name: "Top".to_owned(),
        contact: Contact::Conformable,
        age: Age::ByDepth,
        options: ImportOptions::default(),
    };
    new.project().apply(&Command::AddHorizon(add), &Progress::silent()).unwrap();
    let project = new.publish().unwrap();
    let (sender, events) = channel();
    let mut keeper = Keeper::new(Outbox { sender, wake: Arc::new(|| {}) }, Running::default());
    keeper.follow(project.root().to_owned(), project.document().clone()).unwrap();
    // The next state says that the horizon is another one than is on disk.
    let mut other = project.document().clone();
    (other.horizons[0].hash, other.step) = ("0".repeat(64), other.step + 1);
    let error = keeper.follow(project.root().to_owned(), other).unwrap_err();
    assert!(matches!(error, ProjectError::OtherContent { .. }), "{error}");
    let followed = keeper.followed.unwrap();
    assert_eq!((followed.document.step, followed.sheets.len()), (project.document().step, 1));
    assert!(matches!(events.try_recv(), Ok(Event::Interpreted(_))) && events.try_recv().is_err());
}
