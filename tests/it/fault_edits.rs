//! Faults that are changed as a whole: cut in two, merged, given sticks; what cannot be done is refused.

use crate::program::{project, run_in};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// A project without a volume, with fault "F" drawn by three sticks on inlines 10, 30 and 50.
fn drawn() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "create p.petro --bounds 0,1500,0,1500,0,600 --size 61x61x61").done();
    run_in(at, "fault pick p.petro --name F --stick 10,20,100 10,30,500 --stick 30,21,100 30,31,500 --stick 50,22,100 50,32,500")
        .done();
    folder
}

fn faults(at: &Path) -> Vec<Value> {
    let listed = run_in(at, "fault list p.petro --json").done().json();
    listed["faults"].as_array().unwrap().clone()
}

fn names(at: &Path) -> Vec<String> {
    faults(at).iter().map(|fault| fault["name"].as_str().unwrap().to_owned()).collect()
}

/// The range of a column (x, y or depth) of an exported fault.
fn range(at: &Path, fault: &str, column: usize) -> [f64; 2] {
    let _ = std::fs::remove_file(at.join("out.ts"));
    run_in(at, &format!("export p.petro out.ts --fault '{fault}'")).done();
    let text = std::fs::read_to_string(at.join("out.ts")).unwrap();
    let vertices = text.lines().filter(|line| line.starts_with("VRTX") || line.starts_with("PVRTX"));
    let values = vertices.map(|line| line.split_whitespace().nth(2 + column).unwrap().parse::<f64>().unwrap().abs());
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

#[test]
fn a_fault_is_cut_and_merged_again() {
    let folder = drawn();
    let at = folder.path();
    let whole: Vec<[f64; 2]> = (0..3).map(|column| range(at, "F", column)).collect();
    let told = run_in(at, "fault cut p.petro F --at 20,25,300").done().stdout;
    assert!(told.contains("F 2 is 25 % of it"), "{told}");
    assert_eq!(names(at), ["F", "F 2"]);
    // They meet at the cut, and each has the line of the cut as a stick, which can be moved.
    let axis = (0..2).max_by(|&a, &b| (whole[a][1] - whole[a][0]).total_cmp(&(whole[b][1] - whole[b][0]))).unwrap();
    let [f, second] = ["F", "F 2"].map(|name| range(at, name, axis));
    assert!((second[1] - f[0]).abs() < 20.0 || (second[0] - f[1]).abs() < 20.0, "{f:?} {second:?}");
    run_in(at, "fault move p.petro 'F 2' --stick 2 --point 1 --to 20,24,100").done();
    run_in(at, "undo p.petro").done();
    run_in(at, "fault truncate p.petro 'F 2' --by F").done();
    let told = run_in(at, "fault merge p.petro F 'F 2' --name 'Main fault'").done().stdout;
    assert!(told.contains("are Main fault now"), "{told}");
    assert_eq!(names(at), ["Main fault"]);
    assert!(faults(at)[0]["truncated_by"].is_null());
    for (column, whole) in whole.iter().enumerate() {
        let merged = range(at, "Main fault", column);
        assert!((merged[0] - whole[0]).abs() < 1.0 && (merged[1] - whole[1]).abs() < 1.0, "{merged:?} {whole:?}");
    }
    run_in(at, "check p.petro").done();

    // Along the strike, and put together again: one above the other.
    run_in(at, "fault cut p.petro 'Main fault' --at 30,26,400 --along strike --name Deep").done();
    assert!((range(at, "Deep", 2)[0] - 400.0).abs() < 1.0 && (range(at, "Main fault", 2)[1] - 400.0).abs() < 1.0);
    run_in(at, "fault merge p.petro 'Main fault' Deep").done();
    assert_eq!(names(at), ["Main fault"]);
    assert!((range(at, "Main fault", 2)[1] - 500.0).abs() < 1.0);
}

/// What is imported or proposed has no sticks: it is cut as a surface, and can be given sticks.
#[test]
fn a_surface_from_a_file_is_cut_and_given_sticks() {
    let folder = project();
    let at = folder.path();
    let name = names(at)[0].clone();
    run_in(at, &format!("fault move p.petro '{name}' --stick 1 --point 1 --to 120,530,300"))
        .failed(&["not drawn as sticks", "fault sticks"]);
    let told = run_in(at, &format!("fault sticks p.petro '{name}'")).done().stdout;
    let within = told.split("within ").nth(1).unwrap().split(" m").next().unwrap().parse::<f64>().unwrap();
    assert!(within < 5.0, "{told}");
    run_in(at, &format!("fault sticks p.petro '{name}'")).failed(&["has sticks already"]);
    run_in(at, "undo p.petro").done();
    let [low, high] = range(at, &name, 2);
    let shown = run_in(at, "fault list p.petro --json").done().json();
    let middle = 0.5 * (low + high);
    let told = run_in(at, &format!("fault cut p.petro '{name}' --at 130,530,{middle} --along strike --name Part"));
    let told = told.done().stdout;
    assert!(told.contains("Part is ") && names(at).len() == shown["faults"].as_array().unwrap().len() + 1, "{told}");
    assert!(
        (range(at, "Part", 2)[1] - range(at, &name, 2)[0]).abs() < 1.0
            || (range(at, "Part", 2)[0] - range(at, &name, 2)[1]).abs() < 1.0
    );
    run_in(at, "render p.petro out.png --size 160x120").done();
    run_in(at, &format!("fault merge p.petro '{name}' Part")).done();
    assert_eq!(names(at).len(), shown["faults"].as_array().unwrap().len());
    run_in(at, "check p.petro").done();
}

#[test]
fn what_is_no_cut_and_no_merger_is_refused() {
    let folder = drawn();
    let at = folder.path();
    run_in(at, "fault cut p.petro F --at 58,25,300")
        .failed(&["nothing of fault \"F\" lies beyond", "between its ends"]);
    run_in(at, "fault cut p.petro F --at 20,25,99999").failed(&["outside the survey"]);
    run_in(at, "fault cut p.petro G --at 20,25,300").failed(&["G"]);
    run_in(at, "fault merge p.petro F F").failed(&["two different faults"]);
    assert_eq!(run_in(at, "fault merge p.petro F").code, 2);
    run_in(at, "fault pick p.petro --name G --stick 10,40,100 10,50,500 --stick 50,42,100 50,52,500").done();
    let before = faults(at);
    run_in(at, "fault merge p.petro F G").failed(&["\"F\" and \"G\" run side by side", "500 m apart", "they are two"]);
    assert_eq!(faults(at), before);
}
