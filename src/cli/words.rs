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
    /// How many values it takes each time it is given: the least, and the most unless any number.
    pub values: (usize, Option<usize>),
    /// Whether it may be given more than once, with further values.
    pub repeats: bool,
    /// What its values are, as `--help` shows them.
    pub value_names: Vec<String>,
    /// What it says.
    pub help: String,
}

/// Every command that does something, in the order of `--help`.
pub fn commands() -> Vec<CommandWords> {
    let mut found = Vec::new();
    let mut program = Arguments::command();
    // What is not stated of an option, such as how many values a flag takes, is known then.
    program.build();
    collect(&program, &[], &mut found);
    found
}

fn collect(command: &clap::Command, before: &[String], found: &mut Vec<CommandWords>) {
    for child in command.get_subcommands().filter(|child| child.get_name() != "help") {
        let words: Vec<String> = before.iter().cloned().chain([child.get_name().to_owned()]).collect();
        if child.has_subcommands() {
            collect(child, &words, found);
        } else {
            let about = child.get_about().map(ToString::to_string).unwrap_or_default();
            let options = child.get_arguments().filter(|arg| !is_of_every_command(arg)).map(option).collect();
            found.push(CommandWords { words, about, options });
        }
    }
}

/// Whether an option says how any command is carried out or answered.
fn is_of_every_command(arg: &Arg) -> bool {
    arg.is_global_set() || arg.get_id() == "help" || arg.get_id() == "version"
}

fn option(arg: &Arg) -> OptionWords {
    let values = arg.get_num_args().unwrap_or_default();
    let most = values.max_values();
    OptionWords {
        name: arg.get_long().map_or_else(|| arg.get_id().to_string().replace('_', "-"), str::to_owned),
        positional: arg.is_positional(),
        required: arg.is_required_set(),
        values: (values.min_values(), (most < usize::MAX).then_some(most)),
        repeats: matches!(arg.get_action(), ArgAction::Append),
        value_names: arg.get_value_names().unwrap_or_default().iter().map(ToString::to_string).collect(),
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
        assert_eq!((option("name").values, option("name").repeats), ((1, Some(1)), false));
        let remove = of(&["pick"]).options.iter().find(|option| option.name == "remove").expect("a flag");
        assert_eq!((remove.values, remove.repeats, remove.positional), ((0, Some(0)), false, false));
        let stick = of(&["fault", "pick"]).options.iter().find(|option| option.name == "stick").expect("sticks");
        assert_eq!((stick.values, stick.repeats, stick.required), ((1, None), true, true));
        assert_eq!(stick.value_names, ["INLINE,CROSSLINE,Z"]);
        assert!(all.iter().flat_map(|command| &command.options).all(|option| option.name != "json"));
        assert!(of(&["pick"]).about.starts_with("Pick a candidate"));
        assert!(all.iter().all(|command| command.words != ["help"] && command.words != ["horizon"]));
    }
}
