//! Help, usage and exit codes.

use crate::program::{run, run_in};

/// The names below "Commands:" in a help; none if what it is the help of is a command itself.
fn subcommands(help: &str) -> Vec<String> {
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    // Descriptions that go on in a second line are indented further.
    let listed = listed.take_while(|line| line.starts_with("  ")).filter(|line| !line.starts_with("   "));
    let names = listed.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// Every command of the program by its words, with its help.
pub(crate) fn commands() -> Vec<(String, String)> {
    let (mut asked, mut found) = (vec![Vec::new()], Vec::new());
    while let Some(words) = asked.pop() {
        let help = run(words.iter().map(String::as_str).chain(["--help"])).done().stdout;
        let below = subcommands(&help);
        if below.is_empty() {
            found.push((words.join(" "), help));
        }
        asked.extend(below.into_iter().map(|name| words.iter().cloned().chain([name]).collect()));
    }
    found
}

#[test]
fn the_help_of_every_command_shows_an_example() {
    let found = commands();
    for one in ["render", "horizon add", "scene remove"] {
        assert!(found.iter().any(|(command, _)| command == one), "no {one} in {found:?}");
    }
    let has_example = |help: &str| help.contains("Example") && help.contains("petroglyph ");
    let without: Vec<_> = found.iter().filter(|(_, help)| !has_example(help)).map(|(command, _)| command).collect();
    assert!(without.is_empty(), "no example in the help of {without:?}");
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
