//! The commands and their options as data, for programs that offer the same commands.

use super::args::Arguments;
use clap::{Arg, ArgAction, CommandFactory};
use serde::Serialize;

/// A command of the program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CommandWords {
    /// Its words, such as `horizon add`.
    pub words: Vec<String>,
    /// What it does.
    pub about: String,
    /// What can be said with it, in the order of `--help`.
    pub options: Vec<OptionWords>,
}

/// An argument or an option of a command.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct OptionWords {
    /// Its name: that of the option without dashes, or that of the argument.
    pub name: String,
    /// Whether it stands for itself, without a name in front.
    pub positional: bool,
    /// Whether it must be there.
    pub required: bool,
    /// Whether it has a value.
    pub takes_value: bool,
    /// Whether it has several values.
    pub several: bool,
    /// What it says.
    pub help: String,
}

/// Every command that does something, in the order of `--help`.
pub fn commands() -> Vec<CommandWords> {
    let mut found = Vec::new();
    collect(&Arguments::command(), &[], &mut found);
    found
}

fn collect(command: &clap::Command, before: &[String], found: &mut Vec<CommandWords>) {
    for child in command.get_subcommands().filter(|child| child.get_name() != "help") {
        let words: Vec<String> = before.iter().cloned().chain([child.get_name().to_owned()]).collect();
        if child.has_subcommands() {
            collect(child, &words, found);
        } else {
            let about = child.get_about().map(ToString::to_string).unwrap_or_default();
            let options = child.get_arguments().filter(|arg| arg.get_id() != "help").map(option).collect();
            found.push(CommandWords { words, about, options });
        }
    }
}

fn option(arg: &Arg) -> OptionWords {
    let positional = arg.get_long().is_none();
    let name = arg.get_long().map_or_else(|| arg.get_id().to_string().replace('_', "-"), str::to_owned);
    let most = arg.get_num_args().map_or(1, |count| count.max_values());
    let takes_value = arg.get_action().takes_values();
    OptionWords {
        name,
        positional,
        required: arg.is_required_set(),
        takes_value,
        several: takes_value && (matches!(arg.get_action(), ArgAction::Append) || most > 1),
        help: arg.get_help().map(ToString::to_string).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_listed_with_their_options() {
        let all = commands();
        let of = |words: &[&str]| all.iter().find(|command| command.words == words).expect("a command");
        let add = of(&["horizon", "add"]);
        let option = |name: &str| add.options.iter().find(|option| option.name == name).expect("an option");
        assert!(option("project").positional && option("project").required);
        assert!(option("name").takes_value && !option("name").several);
        let remove = of(&["pick"]).options.iter().find(|option| option.name == "remove").expect("a flag");
        assert!(!remove.takes_value && !remove.several && !remove.positional);
        assert!(of(&["pick"]).about.starts_with("Pick a candidate"));
        assert!(all.iter().all(|command| command.words != ["help"] && command.words != ["horizon"]));
    }
}
