//! What was asked for, as far as a hint about a failure needs it.

use super::args::Arguments;
use clap::CommandFactory;
use std::ffi::OsString;
use std::path::PathBuf;

/// The command and the project of a call.
#[derive(Debug, Clone)]
pub(super) struct Asked {
    /// `horizon add` of `horizon add north.petro top.irap`; empty where there is none.
    pub(super) command: String,
    /// The project; where none is named, `PROJECT` stands for it.
    pub(super) project: PathBuf,
}

impl Default for Asked {
    fn default() -> Self {
        Self { command: String::new(), project: "PROJECT".into() }
    }
}

impl Asked {
    /// What these words ask for, without the program's name in front. They may be no command.
    pub(super) fn of(words: &[OsString]) -> Self {
        let command = command_of(words);
        let line = [OsString::from("petroglyph")].into_iter().chain(words.iter().cloned());
        let Ok(matches) = Arguments::command().try_get_matches_from(line) else {
            return Self { command, ..Self::default() };
        };
        let mut matches = &matches;
        while let Some((_, inner)) = matches.subcommand() {
            matches = inner;
        }
        let project = matches.try_get_one::<PathBuf>("project").ok().flatten();
        Self { command, project: project.cloned().unwrap_or(Self::default().project) }
    }
}

/// The command that these words name.
fn command_of(words: &[OsString]) -> String {
    let (mut command, mut named) = (Arguments::command(), Vec::new());
    for word in words {
        let found = word.to_str().and_then(|word| command.find_subcommand(word)).cloned();
        match found {
            Some(next) => {
                named.push(next.get_name().to_owned());
                command = next;
            }
            // Options of all commands may stand in front.
            None if named.is_empty() => {}
            None => break,
        }
    }
    named.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_and_its_project_are_known_where_they_are_named() {
        let of = |line: &str| {
            let asked = Asked::of(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
            (asked.command, asked.project.display().to_string())
        };
        let pair = |command: &str, project: &str| (command.to_owned(), project.to_owned());
        assert_eq!(of("--json horizon add a.petro top.irap --name A"), pair("horizon add", "a.petro"));
        assert_eq!(of("check a.petro"), pair("check", "a.petro"));
        assert_eq!(of("patterns a.png"), pair("patterns", "PROJECT"));
        assert_eq!(of("horizon add a.petro"), pair("horizon add", "PROJECT"));
        assert_eq!(of("what"), pair("", "PROJECT"));
    }
}
