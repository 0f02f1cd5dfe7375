//! Files that are damaged, or are something else. Whatever the bytes, an error, never a panic.

use super::super::{SegyOptions, SegyProblem, WriteOptions, read, scan, write};
use super::builder::{Built, with_file};
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::progress::Progress;
use survey::volume::Volume;

fn refusal(bytes: &[u8]) -> (SegyProblem, String) {
    with_file(bytes, |path| {
        let error = scan(path, &SegyOptions::default(), &Progress::silent()).expect_err("it should have been refused");
        let sentence = error.to_string();
        (error.problem, sentence)
    })
}

fn small() -> Built {
    Built::grid(&[1, 2], &[3, 4, 5])
}

#[test]
fn a_file_cut_anywhere_is_refused_or_read_and_never_panics() {
    let whole = small().bytes();
    let trace = 240 + 16;
    for length in 0..whole.len() {
        let outcome = with_file(&whole[..length], |path| read(path, &SegyOptions::default(), &Progress::silent()));
        let traces = length.saturating_sub(3600) / trace;
        let is_whole = length >= 3600 && (length - 3600).is_multiple_of(trace);
        match outcome {
            // Cut between traces, what is left is a smaller volume.
            Ok(found) => assert!(is_whole && found.info.traces == traces, "{length}"),
            Err(error) if is_whole => assert!(traces < 4, "{length}: {error}"),
            Err(error) => match error.problem {
                SegyProblem::TooShort { .. } | SegyProblem::IsText { .. } => assert!(length < 3600),
                SegyProblem::Truncated { trace: cut, .. } => assert_eq!(cut as usize, traces + 1),
                _ => panic!("{length}: {error}"),
            },
        }
    }
}

#[test]
fn damaged_bytes_never_panic() {
    let whole = small().bytes();
    let mut state = 7_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    for round in 0..3000 {
        let mut bytes = whole.clone();
        for _ in 0..=random() % 12 {
            // Headers are where damage matters.
            let at = match random() % 3 {
                0 => 3200 + random() % 400,
                1 => 3600 + random() % (bytes.len() - 3600),
                _ => 3600 + (random() % 6) * 256 + [28, 70, 88, 108, 114, 168, 180, 188, 192, 214][random() % 10],
            };
            bytes[at] = random() as u8;
            if round % 3 == 0 {
                bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random() % 5];
            }
        }
        bytes.truncate(bytes.len() - random() % 2 * (random() % 300));
        let _ = with_file(&bytes, |path| read(path, &SegyOptions::default(), &Progress::silent()));
    }
    for length in [0, 1, 3599, 3600, 3601, 4000, 10_000] {
        let bytes: Vec<u8> = (0..length).map(|_| random() as u8).collect();
        let _ = refusal(&bytes);
    }
}

#[test]
fn text_and_short_files_are_named() {
    let (problem, sentence) = refusal(b"name,x,y,z\nF1,1.0,2.0,3.0\n".repeat(400).as_slice());
    assert!(matches!(problem, SegyProblem::IsText { .. }) && sentence.contains("text file"), "{sentence}");
    assert!(matches!(refusal(b"x y z\n").0, SegyProblem::IsText { .. }));
    assert!(matches!(refusal("Größe µ\n".repeat(1000).as_bytes()).0, SegyProblem::IsText { .. }));
    assert!(matches!(refusal(b"").0, SegyProblem::TooShort { bytes: 0 }));
    assert!(matches!(refusal(&[0; 100]).0, SegyProblem::TooShort { bytes: 100 }));
    assert!(matches!(refusal(&[0; 10_000]).0, SegyProblem::NotSegy { big: 0, little: 0 }));
    let (problem, sentence) = refusal(&small().bytes()[..3600]);
    assert!(matches!(problem, SegyProblem::NoTraces { .. }), "{sentence}");
}

#[test]
fn traces_of_different_length_are_named() {
    let file = small().each(|index, t| {
        if index == 2 {
            t.i16(115, 6);
            t.floats(&[0.0; 6]);
        }
    });
    let (problem, sentence) = file.refusal();
    assert!(matches!(problem, SegyProblem::VariableLength { first: 4, trace: 3, other: 6 }), "{sentence}");
}

#[test]
fn files_that_are_not_there_are_named_with_a_hint() {
    let error =
        scan("/nowhere/volume.sgy".as_ref(), &SegyOptions::default(), &Progress::silent()).unwrap_err().to_string();
    assert!(error.contains("/nowhere/volume.sgy") && error.contains("check the name"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let error = scan(folder.path(), &SegyOptions::default(), &Progress::silent()).unwrap_err().to_string();
    assert!(error.contains("not a folder"), "{error}");
}

#[test]
fn a_cancelled_read_says_so() {
    let progress = Progress::silent();
    progress.cancel();
    let error = with_file(&small().bytes(), |path| scan(path, &SegyOptions::default(), &progress)).unwrap_err();
    assert!(matches!(error.problem, SegyProblem::Cancelled(_)));
}

#[test]
fn a_write_that_fails_leaves_nothing_and_spares_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("volume.sgy");
    std::fs::write(&path, "old").unwrap();
    let geometry = SurveyGeometry::regular([2, 2, 3], 25.0, 4.0, VerticalUnit::Milliseconds);
    let volume = Volume::filled([2, 2, 3], 0.0);
    let cancelled = Progress::silent();
    cancelled.cancel();
    assert!(write(&path, &geometry, &volume, &WriteOptions::default(), &cancelled).is_err());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let nowhere = folder.path().join("no/such/folder.sgy");
    let error = write(&nowhere, &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap_err();
    assert!(error.to_string().contains("folder exists"), "{error}");
}

#[test]
fn what_revision_1_cannot_hold_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("volume.sgy");
    let regular = SurveyGeometry::regular([2, 2, 3], 25.0, 4.0, VerticalUnit::Milliseconds);
    let volume = Volume::filled([2, 2, 3], 0.0);
    let refused = |change: &dyn Fn(&mut SurveyGeometry)| {
        let mut geometry = regular.clone();
        change(&mut geometry);
        let error = write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap_err();
        assert!(!path.exists());
        error.problem
    };
    assert!(matches!(refused(&|g| g.vertical.interval = 10.0 / 3.0), SegyProblem::NotRepresentable { .. }));
    assert!(matches!(refused(&|g| g.vertical.interval = 70.0), SegyProblem::NotRepresentable { .. }));
    assert!(matches!(refused(&|g| g.vertical.first = 0.123_45), SegyProblem::NotRepresentable { .. }));
    assert!(matches!(refused(&|g| g.vertical.count = 4), SegyProblem::SizeMismatch { .. }));
    assert!(matches!(refused(&|g| g.crossline_vector = g.inline_vector), SegyProblem::Geometry(_)));
    assert!(matches!(refused(&|g| g.origin.x = 1e15), SegyProblem::Geometry(_)));
    let mut none = volume.clone();
    none.set_live(Some(vec![false; 4])).unwrap();
    let error = write(&path, &regular, &none, &WriteOptions::default(), &Progress::silent()).unwrap_err();
    assert!(matches!(error.problem, SegyProblem::NothingLive));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
