//! Help, usage and exit codes.

use crate::program::{run, run_in};

const COMMANDS: [&str; 21] = [
    "demo",
    "synth",
    "info",
    "create",
    "import",
    "volume list",
    "horizon add",
    "horizon contact",
    "fault add",
    "fault truncate",
    "export",
    "velocity",
    "layer set",
    "scalar set",
    "raw",
    "texture",
    "scene add",
    "scene show",
    "parameterize",
    "render",
    "patterns",
];

#[test]
fn the_help_of_these_commands_shows_an_example() {
    let more = [
        "view",
        "attribute",
        "check",
        "undo",
        "redo",
        "prune",
        "bench",
        "layer list",
        "scene remove",
        "horizon remove",
        "fault remove",
        "well add",
        "well show",
        "pick",
        "climb",
        "descend",
        "evaluate",
        "horizon fill",
        "horizon replay",
        "fault pick",
        "fault propose",
        "fault accept",
    ];
    for command in COMMANDS.into_iter().chain(more) {
        let help = run(command.split(' ').chain(["--help"])).done().stdout;
        assert!(help.contains("Example") && help.contains("petroglyph "), "{command}: {help}");
    }
}

#[test]
fn no_command_review_is_promised() {
    let help = run(["--help"]).done().stdout;
    let later = "review";
    assert!(!help.lines().any(|line| line.trim_start().starts_with(later)), "{later}: {help}");
}

#[test]
fn wrong_usage_is_2_and_failure_is_1() {
    assert_eq!(run(["frobnicate"]).code, 2);
    assert_eq!(run(["render"]).code, 2);
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for usage in [
        "create a.petro --bounds 0,1,2",
        "create a.petro --bounds 0,10,0,10,10,0",
        "create a.petro --bounds 0,10,0,10,0,10 --size 4x4",
        "render a.petro a.txt",
        "render a.petro a.png --lookup fast",
        "render a.petro a.png --technique magic",
        "import a.sgy a.petro --polarity sideways",
        "horizon add a.petro a.csv --name A --z-unit furlong",
        "horizon add a.petro a.csv --name A --z-factor 0",
        "layer set a.petro A",
        "synth s --snr -1",
    ] {
        let run = run_in(at, usage);
        assert_eq!(run.code, 2, "{usage}: {}", run.stderr);
        assert!(run.stderr.contains("error: "), "{usage}: {}", run.stderr);
    }
    run_in(at, "info a.petro").failed(&["there is no project"]);
    run_in(at, "undo a.petro").failed(&["there is no project"]);
    assert_eq!(std::fs::read_dir(at).unwrap().count(), 0);
}

#[test]
fn json_is_one_object_also_for_failures() {
    let folder = tempfile::tempdir().unwrap();
    let failed = run_in(folder.path(), "info a.petro --json");
    assert_eq!(failed.code, 1);
    assert!(failed.json()["error"].as_str().unwrap().contains("there is no project"));
    let done = run_in(folder.path(), "create a.petro --bounds 0,10,0,10,0,10 --size 4x4x4 --json").done();
    assert_eq!(done.json()["project"], "a.petro");
}
