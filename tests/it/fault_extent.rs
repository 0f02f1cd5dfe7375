//! How far a fault reaches beyond what was drawn of it: stated, shown, taken back, refused.

use crate::program::{project, run_in};

#[test]
fn a_fault_ends_where_it_was_drawn_unless_it_is_said_to_grow() {
    let folder = project();
    let at = folder.path();
    let grown = |line: &str| {
        let listed = run_in(at, "fault list p.petro --json").done().json();
        let faults = listed["faults"].as_array().cloned().unwrap_or_default();
        let named = faults.iter().find(|fault| fault["name"] == "Dying fault").cloned().unwrap_or_default();
        (run_in(at, line).done(), named["grown_m"].as_f64().unwrap_or(0.0))
    };
    assert_eq!(grown("fault extent p.petro 'Dying fault' grow 150").1, 0.0);
    let (listed, after) = grown("fault list p.petro");
    assert!(after == 150.0 && listed.stdout.contains("reaches 150 m beyond what was drawn"), "{}", listed.stdout);
    assert_eq!(grown("fault extent p.petro 'Dying fault' drawn").1, 150.0);
    assert_eq!(grown("undo p.petro").1, 0.0);
    assert_eq!(grown("fault list p.petro").1, 150.0);
    // Also when it is read; a fault that is drawn anew keeps it.
    run_in(at, "fault remove p.petro 'Dying fault'").done();
    run_in(at, "fault add p.petro 's/faults/Dying fault.ts' --name 'Dying fault' --extent grow 75.5").done();
    assert_eq!(grown("check p.petro").1, 75.5);
    // Options that follow are none of its values.
    assert!(run_in(at, "fault extent p.petro 'Dying fault' drawn --json").done().json().is_object());
    run_in(at, "fault add p.petro 's/faults/Dying fault.ts' --extent drawn --name Second").done();
}

#[test]
fn a_grown_fault_is_longer_on_a_map() {
    let folder = project();
    let at = folder.path();
    let drawn = |out: &str| {
        run_in(at, &format!("render p.petro {out} --map Alpha --size-cm 12x10")).done();
        std::fs::read(at.join(out)).unwrap()
    };
    let before = drawn("before.svg");
    assert_eq!(before, drawn("again.svg"));
    run_in(at, "fault extent p.petro 'Dying fault' grow 300").done();
    assert_ne!(before, drawn("grown.svg"), "the map shows no longer fault");
}

#[test]
fn what_is_no_extent_is_refused() {
    let folder = project();
    for extent in ["grow", "grow -3", "grow x", "grow nan", "shrink 3", "drawn 3"] {
        let run = run_in(folder.path(), &format!("fault extent p.petro 'Dying fault' {extent}"));
        assert_eq!(run.code, 2, "{extent}: {}{}", run.stdout, run.stderr);
        assert!(run.stderr.contains("expected drawn, or grow and metres"), "{extent}: {}", run.stderr);
    }
    run_in(folder.path(), "fault extent p.petro Nothing drawn").failed(&["Nothing"]);
    run_in(folder.path(), "fault extent p.petro 'Dying fault' grow 1e300")
        .failed(&["Dying fault", "beyond what was drawn"]);
    assert_eq!(run_in(folder.path(), "fault list p.petro").done().stdout.matches("reaches").count(), 0);
}
