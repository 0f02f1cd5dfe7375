//! Text that is safe on a terminal.
//!
//! Names, headers and error texts come from files, and a file may hold characters that make a terminal do things: move the cursor,
//! change the title, answer as if it had been typed. They are shown as `\\u{1b}` instead. Characters that turn the direction of writing
//! could make a name look like another, and are shown so too.

use std::borrow::Cow;
use system::command_line::misleads;

/// The text with control characters shown, but for line ends and tabs.
pub(super) fn plain(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unsafe) {
        return Cow::Borrowed(text);
    }
    let shown = |c: char| if is_unsafe(c) { c.escape_unicode().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(shown).collect())
}

/// JSON with control characters as escapes. JSON itself asks for that below 0x20 only; others stand in strings alone.
pub(super) fn plain_json(json: &str) -> Cow<'_, str> {
    if !json.contains(is_unsafe) {
        return Cow::Borrowed(json);
    }
    let shown = |c: char| if is_unsafe(c) { format!("\\u{:04x}", u32::from(c)) } else { c.to_string() };
    Cow::Owned(json.chars().map(shown).collect())
}

fn is_unsafe(c: char) -> bool {
    misleads(c) && !matches!(c, '\n' | '\t')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_makes_a_terminal_do_things_is_shown() {
        assert_eq!(plain("a\u{1b}]0;b\u{7}\r"), "a\\u{1b}]0;b\\u{7}\\u{d}");
        assert_eq!(plain("\u{9b}31m\u{202e}x"), "\\u{9b}31m\\u{202e}x");
        assert_eq!(plain("Top Chalk ä\n\tµ"), "Top Chalk ä\n\tµ");
    }

    #[test]
    fn json_says_the_same_as_before() {
        let value = serde_json::json!({ "name": "a\u{9b}\u{7f}\u{1b}\u{202e}b" });
        let text = value.to_string();
        let shown = plain_json(&text);
        assert!(!shown.chars().any(char::is_control), "{shown}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&shown).unwrap(), value);
    }
}
