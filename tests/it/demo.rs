//! The pattern sheet and the bench: small runs of the long commands. The demonstration itself is `make demo`.

use crate::program::run_in;

#[test]
fn the_pattern_sheet_draws_at_least_sixteen_patterns() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = run_in(folder.path(), "patterns patterns.png --json").done().json();
    assert!(sheet["patterns"].as_array().unwrap().len() >= 16);
    let image = image::open(folder.path().join("patterns.png")).unwrap();
    assert!(image.width() > 500 && image.height() > 500);
}

#[test]
fn a_synthetic_survey_is_the_same_for_the_same_seed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for out in ["a", "b"] {
        run_in(at, &format!("synth {out} --size 24x24x48 --seed 5")).done();
    }
    run_in(at, "synth c --size 24x24x48 --seed 6").done();
    let survey = |out: &str| std::fs::read(at.join(out).join("survey.sgy")).unwrap();
    assert!(survey("a") == survey("b"));
    assert!(survey("a") != survey("c"));
    for file in ["attribute.sgy", "truth.json", "horizons/Alpha.csv", "faults/Dying fault.ts"] {
        assert!(at.join("a").join(file).exists(), "{file}");
    }
    run_in(at, "synth d --size 4x4x4").failed(&["too small"]);
}
