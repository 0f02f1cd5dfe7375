//! The report of a check, in the words of the command line.

use super::report::Report;
use project::check::{CheckReport, Cure, Damage, LeftoverKind, Outcome, Part};
use project::error::Noun;
use std::path::Path;
use system::command_line::CommandLine;

/// What a check found, for people and programs. The exit code is that of a failure while something is damaged, cannot be
/// read or cannot be drawn.
pub(super) fn report(found: &CheckReport) -> Report {
    let project = found.project.display();
    let repair = CommandLine::new("check").value(&found.project).flag("--repair");
    let state = found.step.map_or("no readable state".to_owned(), |step| format!("step {step}"));
    let mut report = Report::line(format!(
        "{project}: {state}, {} of the history, {} and {} checked",
        counted(found.steps.len(), "step"),
        counted(found.data_files, "data file"),
        counted(found.derived_files, "derived result")
    ));
    for damage in &found.damage {
        say_damage(&mut report, damage, &found.project);
    }
    for unread in &found.unread {
        report.say(format!("cannot be read now: {} ({}): {}", unread.file, unread.what, unread.reason));
    }
    if !found.unread.is_empty() {
        report.say(
            "  what to do: it may be whole, and nothing is removed for it; see to what stands in the way (permissions, \
             open files, memory, disk, network, a path that is no UTF-8), then check again",
        );
    }
    for reason in &found.undrawable {
        report.say(format!("cannot be drawn: {reason}"));
    }
    if !found.undrawable.is_empty() {
        let undo = CommandLine::new("undo").value(&found.project);
        report.say(format!("  what to do: that, or go back with `{undo}`"));
    }
    for leftover in &found.leftovers {
        let why = match leftover.kind {
            LeftoverKind::Unfinished => "left behind by a command that did not finish",
            LeftoverKind::Import => "an interrupted import, from which the same import continues",
            LeftoverKind::Derived => "computed for a state that is gone",
            LeftoverKind::Orphan => "no state needs it",
            LeftoverKind::Doubtful => "only a damaged state may need it, so it is kept",
        };
        report.say(format!("left over: {} ({} bytes): {why}", leftover.file, leftover.bytes));
    }
    for repair in &found.repairs {
        report.say(format!("repaired: {repair}"));
    }
    for note in &found.notes {
        report.say(format!("note: {note}"));
    }
    let remaining = found.damage.iter().filter(|damage| !damage.repaired).count();
    report.say(match (remaining, found.damage.len()) {
        (0, _) if !found.unread.is_empty() => "nothing that could be read is damaged".to_owned(),
        (0, 0) => "nothing is damaged".to_owned(),
        (0, _) => "nothing is damaged any more".to_owned(),
        (1, _) => "1 file or folder is damaged".to_owned(),
        (count, _) => format!("{count} files or folders are damaged"),
    });
    let can_remove = found.leftovers.iter().any(|leftover| leftover.kind != LeftoverKind::Doubtful);
    if can_remove && found.repairs.is_empty() {
        report.say(format!("`{repair}` removes what is left over"));
    }
    report.fields(found).field("ok", found.is_well());
    report.bad(!found.is_well())
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn say_damage(report: &mut Report, damage: &Damage, project: &Path) {
    let word = if damage.repaired { "was damaged" } else { "damaged" };
    report.say(format!("{word}: {} ({}): {}", damage.file, damage.what, damage.reason));
    if damage.part == Part::Data {
        report.say(format!("  needed by: {}", needed_by(damage)));
    }
    if !damage.dependants.is_empty() {
        report.say(format!("  depends on it: {}", damage.dependants.join(", ")));
    }
    if !damage.repaired {
        let ways: Vec<String> = damage.cures.iter().map(|cure| words(cure, project)).collect();
        report.say(format!("  what to do: {}", ways.join("; or ")));
    }
}

/// The states that need something.
fn needed_by(damage: &Damage) -> String {
    let present = damage.is_present.then(|| "the present state".to_owned());
    let steps = match ranges(&damage.steps) {
        ranges if ranges.is_empty() => None,
        ranges if damage.steps.len() == 1 => Some(format!("step {ranges}")),
        ranges => Some(format!("steps {ranges}")),
    };
    present.into_iter().chain(steps).collect::<Vec<_>>().join(", ")
}

/// Ascending numbers, with those that follow one another as `3 to 7`.
fn ranges(numbers: &[u32]) -> String {
    let parts = numbers.chunk_by(|a, b| a + 1 == *b).map(|part| match part {
        [only] => only.to_string(),
        [first, second] => format!("{first}, {second}"),
        [first, .., last] => format!("{first} to {last}"),
        [] => String::new(),
    });
    parts.collect::<Vec<_>>().join(", ")
}

/// What to do about damage.
fn words(cure: &Cure, project: &Path) -> String {
    let line = |command| CommandLine::new(command).value(project);
    let repair = line("check").flag("--repair");
    let removal = |noun: &Noun, name: &str| {
        let command = match noun {
            Noun::Volume => "volume remove",
            Noun::Horizon => "horizon remove",
            Noun::Fault => "fault remove",
            Noun::Well => "well remove",
            _ => return String::new(),
        };
        format!("remove it with `{}`, then ", line(command).value(name))
    };
    match cure {
        Cure::Restore { step } => {
            format!("`{repair}` restores it from step {step} of the history, and keeps the damaged file beside it")
        }
        Cure::SetAside => format!("`{repair}` moves it to damaged/"),
        Cure::Recompute { result } => {
            let again = match result {
                Outcome::Candidates => format!("`{}` makes it again", line("extract")),
                Outcome::FaultProposals => format!("`{}` makes it again", line("fault propose")),
                Outcome::Parameterization => "it is computed again when it is needed".to_owned(),
            };
            format!("`{repair}` removes it, and {again}")
        }
        Cure::MakeAgain => format!("`{repair}` makes it again"),
        Cure::Undo { step, times: 1 } => format!("go back to step {step}: `{}`", line("undo")),
        Cure::Undo { step, times } => format!("go back to step {step}: `{}`, {times} times", line("undo")),
        Cure::Import { noun, name, path } => format!("{}import {} again", removal(noun, name), path.display()),
        Cure::Remake { noun, name, from } => format!("{}make it again ({from})", removal(noun, name)),
        Cure::Prune => {
            format!("only the history needs it: `{}` deletes the history, the present state stays", line("prune"))
        }
        Cure::ReplaceLink => {
            "if you trust where the project comes from, replace the link by a copy of what it points to".to_owned()
        }
        Cure::Backup => "copy the project from a backup: the history has no step that can be read".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_in_a_row_are_told_as_a_range() {
        assert_eq!(ranges(&[1, 3, 4, 5, 9, 10]), "1, 3 to 5, 9, 10");
        assert_eq!(ranges(&[]), "");
    }
}
