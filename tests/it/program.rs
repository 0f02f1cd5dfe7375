//! Running the program, and projects to run it on.

use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use tempfile::TempDir;

/// What a run of the program gave.
#[derive(Debug)]
pub(crate) struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Run {
    pub(crate) fn of(output: &Output) -> Self {
        Self {
            code: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// The run must have succeeded.
    #[track_caller]
    pub(crate) fn done(self) -> Self {
        assert_eq!(self.code, 0, "{}{}", self.stdout, self.stderr);
        self
    }

    /// The run must have failed with a reason that has all of `words`, and a hint.
    #[track_caller]
    pub(crate) fn failed(self, words: &[&str]) -> Self {
        assert_eq!(self.code, 1, "{}{}", self.stdout, self.stderr);
        assert!(self.stderr.contains("error: "), "{}", self.stderr);
        assert!(self.stderr.contains("hint: "), "{}", self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        for word in words {
            assert!(self.stderr.contains(word), "no \"{word}\" in: {}", self.stderr);
        }
        self
    }

    /// The one object on stdout.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}{}", self.stdout, self.stderr))
    }
}

/// Where the program remembers projects: not where that of the user does.
pub(crate) const STATE_HOME: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/state");

pub(crate) fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_petroglyph"));
    command.env("XDG_STATE_HOME", STATE_HOME);
    command
}

/// Runs the program.
pub(crate) fn run<I: AsRef<OsStr>>(arguments: impl IntoIterator<Item = I>) -> Run {
    Run::of(&command().args(arguments).output().expect("the program runs"))
}

/// Runs the program with words separated by blanks, where `@` stands for the folder.
pub(crate) fn run_in(folder: &Path, line: &str) -> Run {
    Run::of(&command().current_dir(folder).args(words(line)).output().expect("the program runs"))
}

/// Starts the program with words separated by blanks, and does not wait for it.
pub(crate) fn begin_in(folder: &Path, line: &str) -> Child {
    let mut command = command();
    command.current_dir(folder).args(words(line)).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the program runs")
}

/// Splits at blanks, but not inside single quotes.
pub(crate) fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (index, part) in line.split('\'').enumerate() {
        if index % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// A small synthetic survey and the project `p.petro` with all of it, made once: copy it to change it.
fn finished() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER
        .get_or_init(|| {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let at = folder.path();
            run_in(at, "synth s --size 48x40x56 --seed 3 --snr 5").done();
            run_in(at, "import s/survey.sgy p.petro").done();
            run_in(at, "import s/attribute.sgy p.petro --name impedance").done();
            for (name, contact) in HORIZONS {
                run_in(at, &format!("horizon add p.petro s/horizons/{name}.csv --name {name} --contact {contact}"))
                    .done();
            }
            for name in FAULTS {
                run_in(at, &format!("fault add p.petro 's/faults/{name}.ts' --name '{name}'")).done();
            }
            folder
        })
        .path()
}

/// Horizons of the synthetic survey, youngest first.
pub(crate) const HORIZONS: [(&str, &str); 5] = [
    ("Alpha", "conformable"),
    ("Bravo", "conformable"),
    ("Unconformity", "erosional"),
    ("Charlie", "conformable"),
    ("Delta", "conformable"),
];
/// Its faults.
pub(crate) const FAULTS: [&str; 3] = ["Normal fault", "Dying fault", "Reverse fault"];

/// A folder with the survey `s` and the project `p.petro` of one's own.
pub(crate) fn project() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    copy(finished(), folder.path());
    folder
}

/// A folder with the survey `s` alone.
pub(crate) fn survey() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir(folder.path().join("s")).expect("a folder");
    copy(&finished().join("s"), &folder.path().join("s"));
    folder
}

/// Takes the hash of the first tile out of the state of a project, as it is in those from before it was recorded.
pub(crate) fn forget_hash_of_tile(root: &Path) {
    let state = root.join("project.toml");
    let text = fs::read_to_string(&state).expect("a state");
    let from = text.find("[[textures]]").expect("a tile");
    let (head, tail) = text[from..].split_once("hash = ").expect("a hash");
    let (_, rest) = tail.split_once('\n').expect("a line");
    fs::write(&state, format!("{}{head}{rest}", &text[..from])).expect("a state that can be written");
}

/// Copies the content of a folder.
pub(crate) fn copy(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).expect("a folder") {
        let entry = entry.expect("an entry");
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            fs::create_dir_all(&target).expect("a folder");
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).expect("a file");
        }
    }
}

/// Every file below a folder with its bytes, the lock apart.
pub(crate) fn bytes(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.file_name() != Some(OsStr::new("lock")) {
                let content = fs::read(&path).expect("a file");
                found.insert(path, content);
            }
        }
    }
    found
}
