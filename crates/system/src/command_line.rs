//! Command lines that are shown to people, who paste them into a shell.
//!
//! Names come from files and paths from anywhere. A word that stood as it is could be several words, a pattern, an option,
//! or a command of its own: `Marl$(rm -r .)`. Each word is quoted for the shell so that the program is given exactly that
//! word, and written without characters that would steer the terminal it is pasted into.
//!
//! POSIX shells: sh, dash, bash, zsh, ksh. PowerShell: 7.3 and later; Windows PowerShell 5.1 loses double quotes and
//! empty words on the way to any program, however they are quoted. What needs no more than double quotes is written with
//! these, which `cmd` understands, too.

use std::ffi::{OsStr, OsString};
use std::fmt::{self, Write};

/// A call of this program. Its `Display` is for the shells of this platform.
///
/// ```
/// use system::command_line::{CommandLine, Shell};
///
/// let line = CommandLine::new("layer set").value("my north.petro").value("Marl").option("--colour", "#c0182c");
/// assert_eq!(line.quoted(Shell::Posix), "petroglyph layer set 'my north.petro' Marl --colour '#c0182c'");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandLine {
    command: &'static str,
    values: Vec<OsString>,
    options: Vec<OsString>,
}

impl CommandLine {
    /// A call of a command, `layer set` for example.
    pub fn new(command: &'static str) -> Self {
        Self { command, values: Vec::new(), options: Vec::new() }
    }

    /// Adds a value that needs no option: a path, a name.
    #[must_use]
    pub fn value(mut self, value: impl AsRef<OsStr>) -> Self {
        self.values.push(value.as_ref().to_owned());
        self
    }

    /// Adds an option without a value.
    #[must_use]
    pub fn flag(mut self, name: &str) -> Self {
        self.options.push(name.into());
        self
    }

    /// Adds an option with its value.
    #[must_use]
    pub fn option(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        let value = value.as_ref();
        if looks_like_an_option(value) {
            let mut joined = OsString::from(name);
            joined.push("=");
            joined.push(value);
            self.options.push(joined);
        } else {
            self.options.extend([name.into(), value.to_owned()]);
        }
        self
    }

    /// The line for a shell.
    pub fn quoted(&self, shell: Shell) -> String {
        let mut line = format!("petroglyph {}", self.command);
        let end_of_options = OsString::from("--");
        let (values, options) = (self.values.iter(), self.options.iter());
        let words: Vec<&OsString> = if self.values.iter().any(|value| looks_like_an_option(value)) {
            options.chain([&end_of_options]).chain(values).collect()
        } else {
            values.chain(options).collect()
        };
        for word in words {
            line.push(' ');
            line.push_str(&shell.quote(word));
        }
        line
    }
}

impl fmt::Display for CommandLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.quoted(Shell::here()))
    }
}

fn looks_like_an_option(value: &OsStr) -> bool {
    value.as_encoded_bytes().starts_with(b"-")
}

/// A family of shells, by their rules of quoting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shell {
    /// sh, dash, bash, zsh, ksh.
    Posix,
    /// PowerShell 7.3 and later.
    PowerShell,
}

impl Shell {
    /// That of this platform.
    pub const fn here() -> Self {
        if cfg!(windows) { Self::PowerShell } else { Self::Posix }
    }

    /// A word as it is typed, so that the shell hands on exactly this word.
    pub fn quote(self, word: &OsStr) -> String {
        match self {
            Self::Posix => posix(word),
            Self::PowerShell => power_shell(&word.to_string_lossy()),
        }
    }
}

/// Whether a terminal, or a reader's eye, is led astray by a character: controls, and marks that turn the direction of
/// writing so that a name looks like another.
pub fn misleads(c: char) -> bool {
    c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Between single quotes every character stands for itself, but for the single quote. What may not be written as it is
/// stands in octal, which `printf` turns back.
fn posix(word: &OsStr) -> String {
    let is_bare = |c: char| c.is_alphanumeric() || "%+,-./:@_".contains(c);
    match word.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(is_bare) => text.to_owned(),
        Some(text) if !text.contains(misleads) => format!("'{}'", text.replace('\'', r"'\''")),
        _ if word.as_encoded_bytes().ends_with(b"\n") => {
            // The shell takes line ends off the end of what a command prints. dash does not know this way.
            format!("$'{}'", octal(word))
        }
        _ => format!("\"$(printf '{}')\"", octal(word)),
    }
}

/// The word between single quotes as a format of `printf`.
fn octal(word: &OsStr) -> String {
    let mut text = String::new();
    for chunk in word.as_encoded_bytes().utf8_chunks() {
        for c in chunk.valid().chars() {
            // bash looks for `!` between double quotes.
            if misleads(c) || matches!(c, '\'' | '\\' | '%' | '!') {
                push_octal(&mut text, c.encode_utf8(&mut [0; 4]).as_bytes());
            } else {
                text.push(c);
            }
        }
        push_octal(&mut text, chunk.invalid());
    }
    text
}

fn push_octal(text: &mut String, bytes: &[u8]) {
    for byte in bytes {
        _ = write!(text, "\\{byte:03o}");
    }
}

/// PowerShell takes typographic quotes for quotes, and parts a bare word that begins with a dash at points and colons.
fn power_shell(word: &str) -> String {
    let is_bare = |c: char| c.is_alphanumeric() || "-./:\\_".contains(c);
    let is_double_quote = |c: char| matches!(c, '"' | '\u{201c}'..='\u{201e}');
    let is_single_quote = |c: char| matches!(c, '\'' | '\u{2018}'..='\u{201b}');
    // Between double quotes, `cmd` or PowerShell see more in these than a character.
    let is_active = |c: char| is_double_quote(c) || matches!(c, '$' | '`' | '%' | '!');
    let is_plain_option = |word: &str| word.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
    if !word.is_empty() && word.chars().all(is_bare) && (!word.starts_with('-') || is_plain_option(word)) {
        return word.to_owned();
    }
    let mut text = String::new();
    if word.contains(misleads) {
        for c in word.chars() {
            if misleads(c) {
                _ = write!(text, "$([char]0x{:x})", u32::from(c));
                continue;
            }
            if is_double_quote(c) || matches!(c, '$' | '`') {
                text.push('`');
            }
            text.push(c);
        }
        format!("\"{text}\"")
    } else if word.contains(is_active) || word.ends_with('\\') {
        for c in word.chars() {
            if is_single_quote(c) {
                text.push(c);
            }
            text.push(c);
        }
        format!("'{text}'")
    } else {
        format!("\"{word}\"")
    }
}

#[cfg(test)]
mod tests;
