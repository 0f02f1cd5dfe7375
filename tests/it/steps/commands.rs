//! The commands that change files, each with the small folder that it begins in.
//!
//! A test compares them with what the program's help lists: no command can be forgotten. Seven are left out, each with
//! its reason ([`ELSEWHERE`]).

use super::supervised::{self, Verdict};
use super::{folder_with, program, run_once};
use crate::program::STATE_HOME;
use files::segy::WriteOptions;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use tempfile::TempDir;

/// A command and where it begins.
#[derive(Clone, Copy)]
pub(super) struct Scenario {
    /// The folder that it begins in.
    pub start: Start,
    /// What is done in it first.
    pub prepare: fn(&Path),
    /// The command.
    pub line: &'static str,
    /// The project that it changes or makes.
    pub project: &'static str,
}

/// A folder to begin in.
#[derive(Debug, Clone, Copy)]
pub(super) enum Start {
    /// Files to import alone.
    Files,
    /// The project `p.petro` with a volume, two horizons and a fault.
    Imported,
    /// The same with candidates and a horizon picked from them.
    Extracted,
}

impl Start {
    /// The folder; it is made once.
    pub(super) fn folder(self) -> &'static Path {
        static FOLDERS: [OnceLock<TempDir>; 3] = [const { OnceLock::new() }; 3];
        let folder = FOLDERS[self as usize].get_or_init(|| {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let at = folder.path();
            match self {
                Self::Files => write_files(at),
                Self::Imported => {
                    crate::program::copy(Self::Files.folder(), at);
                    all(at, &["import a.sgy p.petro", ADD_TOP, "horizon add p.petro base.csv --name Base", ADD_FAULT]);
                }
                Self::Extracted => {
                    crate::program::copy(Self::Imported.folder(), at);
                    all(at, &["extract p.petro --min-leaf-triangles 20", PICK, PICK_MORE]);
                }
            }
            folder
        });
        folder.path()
    }
}

const ADD_TOP: &str = "horizon add p.petro top.csv --name Top";
const CUT_FAULT: &str = "fault cut p.petro F --at 3,5,32 --name Part";
const ADD_FAULT: &str = "fault pick p.petro --name F --stick 3,2,4 3,2,60 --stick 3,9,4 3,9,60";
const SET_SCALAR: &str = "scalar set p.petro seismic --interval 0,50,chalk";
const PICK: &str = "pick p.petro --at 4,4,32 --horizon Picked --highest-valid";
const PICK_MORE: &str = "pick p.petro --at 10,4,44 --horizon Picked";

/// Carries out commands one after another.
fn all(at: &Path, lines: &[&str]) {
    for line in lines {
        run_once(at, line).done();
    }
}

/// Inlines, crosslines and samples of the survey.
const SIZE: [usize; 3] = [12, 12, 24];

/// A survey with a fault between inlines 6 and 7, and files of all kinds to go with it.
fn write_files(at: &Path) {
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 4.0, VerticalUnit::Milliseconds);
    let [inlines, crosslines, samples] = SIZE;
    let mut values = Vec::new();
    for n in 0..inlines * crosslines * samples {
        let (inline, sample) = (n / (crosslines * samples), n % samples);
        let phase = sample as f32 - if inline < 6 { 0.0 } else { 3.0 };
        values.push((phase * std::f32::consts::TAU / 8.0).cos() * 100.0);
    }
    let volume = Volume::from_samples(SIZE, values).unwrap();
    files::segy::write(&at.join("a.sgy"), &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
    for (name, z) in [("top.csv", 28.0), ("base.csv", 60.0)] {
        let mut text = "x,y,z\n".to_owned();
        for (x, y) in (0..inlines * crosslines).map(|n| (n / crosslines, n % crosslines)).filter(|at| *at != (5, 5)) {
            writeln!(text, "{},{},{z}", x * 25, y * 25).unwrap();
        }
        fs::write(at.join(name), text).unwrap();
    }
    let mut text = "x,y,z\n".to_owned();
    for (x, y) in (0..20 * 20).map(|n| (n / 20, n % 20)) {
        writeln!(text, "{},{},{}", x * 25, y * 25, if x < 10 { 24 } else { 40 }).unwrap();
    }
    fs::write(at.join("step.csv"), text).unwrap();
    fs::write(at.join("g.ts"), TRIANGLES).unwrap();
    fs::write(at.join("A.csv"), "md_m,inc,azi\n0,0,0\n90,0,0\n").unwrap();
    fs::write(at.join("tops.csv"), "surface,md_m,well\nTop,35,A-1\n").unwrap();
    image::RgbImage::from_pixel(4, 4, image::Rgb([1, 0, 0])).save(at.join("tile.png")).unwrap();
}

/// A fault of two triangles.
const TRIANGLES: &str = "GOCAD TSurf 1\nHEADER {\nname:G\n}\nTFACE\nVRTX 1 200 0 4\nVRTX 2 200 275 4\n\
    VRTX 3 215 0 60\nVRTX 4 215 275 60\nTRGL 1 2 3\nTRGL 2 4 3\nEND\n";

const fn of(start: Start, line: &'static str) -> Scenario {
    Scenario { start, prepare: |_| {}, line, project: "p.petro" }
}

const fn after(start: Start, prepare: fn(&Path), line: &'static str) -> Scenario {
    Scenario { prepare, ..of(start, line) }
}

use Start::{Extracted, Files, Imported};

/// What makes files and projects.
pub(super) const MAKING: [Scenario; 6] = [
    of(Files, "synth s --size 24x24x48 --seed 3"),
    of(Files, "create p.petro --bounds 0,1000,0,1000,0,1000 --size 9x9x9"),
    of(Files, "import a.sgy p.petro"),
    of(Imported, "import a.sgy p.petro --name second"),
    of(Imported, "volume remove p.petro seismic"),
    Scenario { project: "r.petro", ..of(Imported, "restore p.petro r.petro --to Top") },
];

/// What changes horizons, faults and wells.
pub(super) const INTERPRETING: [Scenario; 26] = [
    of(Imported, "horizon add p.petro top.csv --name Another"),
    of(Imported, "volume rename p.petro seismic Stack"),
    of(Imported, "horizon rename p.petro Top Roof"),
    of(Imported, "horizon draw p.petro Drawn --line 4,2,40 4,9,40 --snap"),
    of(Imported, "horizon track p.petro Tracked --at 3,5,40 --traces 4"),
    of(Imported, "horizon fill p.petro Top"),
    of(Imported, "horizon smooth p.petro Top"),
    of(Imported, "horizon stack p.petro Slice --count 2 --between Top Base --spacing proportional"),
    of(Imported, "horizon contact p.petro Base erosional"),
    of(Imported, "horizon remove p.petro Top"),
    of(Imported, "fault pick p.petro --name G --stick 8,2,4 8,2,60 --stick 8,9,4 8,9,60"),
    of(Imported, "fault add p.petro g.ts --name G"),
    after(Imported, |at| all(at, &["fault add p.petro g.ts --name G"]), "fault truncate p.petro G --by F"),
    of(Imported, "fault extent p.petro F grow 20"),
    after(Imported, |at| all(at, &["fault add p.petro g.ts --name G"]), "fault sticks p.petro G"),
    of(Imported, CUT_FAULT),
    after(Imported, |at| all(at, &[CUT_FAULT]), "fault merge p.petro F Part"),
    of(Imported, "fault move p.petro F --stick 1 --point 2 --to 3,3,60"),
    of(Imported, "fault rename p.petro F North"),
    of(Imported, "fault colour p.petro F '#c0182c'"),
    of(Imported, "fault remove p.petro F"),
    of(Imported, "well add p.petro A.csv --name A-1 --head 100,100 --kb 0 --tops tops.csv"),
    after(Imported, with_well, "well rename p.petro A-1 B-2"),
    after(Imported, with_well, "well colour p.petro A-1 '#c0182c'"),
    after(Imported, with_well, "well remove p.petro A-1"),
    of(Imported, "velocity p.petro 2500"),
];

/// What is done with candidates and proposals.
pub(super) const PICKING: [Scenario; 12] = [
    of(Imported, "extract p.petro --min-leaf-triangles 20"),
    of(Extracted, "pick p.petro --at 4,4,64 --horizon Second --highest-valid"),
    of(Extracted, "time p.petro"),
    after(Extracted, |at| all(at, &["time p.petro"]), "pick p.petro --at 10,4,64 --horizon Level --by-time"),
    of(Extracted, "climb p.petro 2 --levels 2"),
    after(Extracted, |at| all(at, &["climb p.petro 2 --levels 2"]), "descend p.petro 2"),
    of(Extracted, "horizon unpick p.petro 1"),
    of(Extracted, "horizon colour p.petro Picked '#ff0000'"),
    of(Extracted, "horizon replay p.petro"),
    of(Extracted, "fault propose p.petro"),
    after(Files, proposed, "fault accept p.petro 1 --name G"),
    of(Extracted, "horizon remove p.petro Picked"),
];

/// What changes how it looks.
pub(super) const LOOKING: [Scenario; 12] = [
    of(Imported, "layer set p.petro 'Top - Base' --name Chalk --pattern chalk"),
    of(Imported, "layer set p.petro 'Top - Base' --rock 'oolitic limestone' --age Campanian"),
    of(Imported, "layer reset p.petro 'Top - Base'"),
    of(Imported, SET_SCALAR),
    after(Imported, |at| all(at, &[SET_SCALAR]), "scalar remove p.petro seismic"),
    of(Imported, "raw p.petro --map grey"),
    of(Imported, "texture p.petro tile.png"),
    of(Imported, "scene add p.petro front --blend 0.5"),
    after(Imported, |at| all(at, &["scene add p.petro front"]), "scene rename p.petro front back"),
    after(Imported, |at| all(at, &["scene add p.petro front"]), "scene remove p.petro front"),
    of(Imported, "note add p.petro 'Look here' --at 4,4,24"),
    after(Imported, |at| all(at, &["note add p.petro Here --at 4,4,24"]), "note remove p.petro 1"),
];

/// What is computed, drawn and exported.
pub(super) const COMPUTING: [Scenario; 13] = [
    of(Imported, "attribute p.petro --kind envelope --name strength"),
    of(Imported, "parameterize p.petro --size 6x6x6"),
    after(Imported, with_arrays, "parameterize p.petro --from own.zarr --size 6x6x6"),
    of(Imported, "render p.petro a.png --size 16x12 --samples 1 --device cpu"),
    of(Imported, "render p.petro a.png --inline 4 --size-cm 3x2"),
    of(Imported, "animate p.petro a.gif --frames 2 --size 16x12 --samples 1 --device cpu"),
    after(Imported, with_figures, "figures p.petro out"),
    of(Imported, "export p.petro top.irap --horizon Top --format irap"),
    of(Imported, "export p.petro values.csv --horizon Top --values seismic --window 2"),
    of(Imported, "export p.petro out.sgy --volume seismic"),
    of(Extracted, "export p.petro c.csv --candidates"),
    of(Imported, "review p.petro a.html --density 64 --sections 1 --device cpu"),
    of(Imported, "export p.petro a.glb --model --density 64 --triangles 4000 --device cpu"),
];

/// What leads back, and what repairs.
pub(super) const MENDING: [Scenario; 7] = [
    of(Imported, "undo p.petro"),
    of(Extracted, "undo p.petro"),
    after(Imported, |at| all(at, &["undo p.petro"]), "redo p.petro"),
    after(Imported, |at| all(at, &["undo p.petro"]), "velocity p.petro 2500"),
    after(Imported, |at| all(at, &["undo p.petro"]), "prune p.petro"),
    after(Imported, killed_when_saved, "velocity p.petro 2500"),
    after(Imported, damaged, "check p.petro --repair"),
];

/// A project with a horizon that has a step of 16 ms, for which a fault was proposed.
fn proposed(at: &Path) {
    let create = "create p.petro --bounds 0,475,0,475,0,92 --size 20x20x24 --z-unit ms";
    all(at, &[create, "horizon add p.petro step.csv --name Step", "fault propose p.petro"]);
}

/// A long history, of which the present step is in the middle.
pub(super) const LONG_PRUNE: Scenario =
    after(Extracted, |at| all(at, &["undo p.petro", "undo p.petro"]), "prune p.petro");

/// A project that lists two small figures.
fn with_figures(at: &Path) {
    let state = at.join("p.petro/project.toml");
    let mut text = fs::read_to_string(&state).unwrap();
    for file in ["a.png", "b.svg"] {
        write!(text, "\n[[figures]]\nfile = \"{file}\"\nsize = {{ cm = [3, 2] }}\n").unwrap();
        text.push_str("[[figures.parts]]\nsection = { kind = \"inline\", at = 4.0 }\n");
    }
    fs::write(&state, text).unwrap();
}

/// The project's own i, j, k beside it, as if another program had written them.
fn with_arrays(at: &Path) {
    all(at, &["parameterize p.petro --size 6x6x6"]);
    fs::rename(at.join("p.petro/derived/parameterization.zarr"), at.join("own.zarr")).unwrap();
}

fn with_well(at: &Path) {
    all(at, &["well add p.petro A.csv --name A-1 --head 100,100 --kb 0 --tops tops.csv"]);
}

/// As a kill leaves it after the state was saved, and before its step was.
fn killed_when_saved(at: &Path) {
    let root = at.join("p.petro");
    all(at, &["velocity p.petro 2200"]);
    fs::create_dir_all(root.join("unfinished/history")).unwrap();
    fs::rename(root.join("history/0005.toml"), root.join("unfinished/history/0005.toml")).unwrap();
}

/// A damaged step, an orphan, and what a command left behind.
fn damaged(at: &Path) {
    let root = at.join("p.petro");
    fs::write(root.join("history/0002.toml"), "= damaged").unwrap();
    fs::create_dir_all(root.join("unfinished/volumes/x.zarr")).unwrap();
    fs::write(root.join("unfinished/volumes/x.zarr/zarr.json"), "{}").unwrap();
    fs::create_dir_all(root.join("horizons/Orphan.zarr/0")).unwrap();
    fs::write(root.join("horizons/Orphan.zarr/0/zarr.json"), "{}").unwrap();
}

/// Commands that change no file.
const READING: [&str; 16] = [
    "info p.petro",
    "volume list p.petro",
    "horizon list p.petro",
    "horizon show p.petro Top",
    "fault list p.petro",
    "well list p.petro",
    "well show p.petro A-1",
    "layer list p.petro",
    "scalar list p.petro",
    "note list p.petro",
    "scene list p.petro",
    "scene show p.petro front",
    "check p.petro",
    "info a.sgy",
    "info top.csv",
    "--version",
];

/// What is not disturbed itself, and why.
const ELSEWHERE: [(&str, &str); 8] = [
    (
        "demo",
        "carries out `synth`, `import`, `extract`, `pick`, `climb`, `horizon fill`, `layer set`, `scene add` and `render`",
    ),
    (
        "history",
        "writes its page by what `render` writes pages by; its stages are projects in the folder for temporary files",
    ),
    (
        "illustrate",
        "carries out `import`, `extract`, `time`, `pick --by-time`, `layer set` and `render`, and draws for seconds",
    ),
    ("patterns", "writes its picture by what `render` writes pictures by, and draws it for seconds"),
    (
        "volume link",
        "reads from object storage, and writes its folder by what `import` writes volumes by; `remote` tests it",
    ),
    ("bench", "changes no project; with `--dump` and `--segy` it writes files of its own to a folder"),
    ("evaluate", "reads a project and the truth, and prints"),
    ("view", "is the window, which changes projects by the same commands"),
];

#[test]
fn every_command_is_disturbed_or_changes_nothing() {
    let groups = [&MAKING[..], &INTERPRETING, &PICKING, &LOOKING, &COMPUTING, &MENDING];
    let disturbed = groups.into_iter().flatten().map(|scenario| scenario.line);
    let known: Vec<&str> = disturbed.chain(READING).chain(ELSEWHERE.map(|(command, _)| command)).collect();
    let begins = |line: &str, command: &str| line == command || line.starts_with(&format!("{command} "));
    let commands = crate::help::commands();
    let is_known = |command: &str| known.iter().any(|line| begins(line, command));
    let forgotten: Vec<_> = commands.iter().map(|(command, _)| command).filter(|command| !is_known(command)).collect();
    assert!(forgotten.is_empty(), "neither disturbed nor said to change nothing: {forgotten:?}");
    let gone = |(command, _): &&(&str, &str)| !commands.iter().any(|(real, _)| real == command);
    assert!(!ELSEWHERE.iter().any(|one| gone(&one)), "{ELSEWHERE:?}");
}

#[test]
fn what_is_said_to_change_nothing_changes_nothing() {
    let folder = folder_with(Imported.folder());
    with_well(folder.path());
    all(folder.path(), &["scene add p.petro front"]);
    // A check notes outside of a project that it is known, once.
    let reading = |line: &str| {
        let mut program = program(folder.path(), line);
        program.env("XDG_STATE_HOME", STATE_HOME);
        program
    };
    assert!(reading("check p.petro").status().expect("the program runs").success());
    for line in READING {
        let mut calls = Vec::new();
        let run = supervised::run(reading(line), |_, call| {
            calls.push(call.name());
            Verdict::Go
        });
        let Some(run) = run else { return };
        run.done();
        assert!(calls.is_empty(), "`{line}`: {calls:?}");
    }
}
