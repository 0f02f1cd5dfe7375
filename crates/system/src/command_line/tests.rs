//! Lines are run by the shells that are there, with a program that prints what it was given.

use super::*;
use std::process::Command;

/// Words that shells, terminals or the program itself could take for something else.
const NASTY: [&str; 34] = [
    "",
    " ",
    "north.petro",
    "my north.petro",
    "Marl$(touch x)",
    "Marl`touch x`",
    "${HOME}",
    "$HOME",
    "%PATH%",
    "it's",
    "'",
    "''",
    "\"",
    "a \"b\" c",
    "\u{2018}a\u{2019} \u{201c}b\u{201d}",
    "wow!",
    "a\nb",
    "a\n$(touch x)!\t'%s'\\n",
    "\u{1b}[31m",
    "a\u{202e}b",
    "*",
    "~",
    "~root/a",
    "#a",
    "=ls",
    "{a,b}",
    "a;touch x",
    "a & touch x | cat > x",
    "-x",
    "--repair",
    "-",
    "back\\slash\\",
    "Müller Ø 層 🪨",
    "@(1),2",
];

/// Numbers without a pattern; the same ones in each run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }
}

/// Words of up to eight pieces of nasty ones.
fn words_at_random(count: usize) -> Vec<String> {
    let pieces: Vec<char> = NASTY.concat().chars().collect();
    let mut numbers = Numbers(40);
    (0..count).map(|_| (0..numbers.below(9)).map(|_| pieces[numbers.below(pieces.len())]).collect()).collect()
}

/// The words that a program is given by a shell which runs a line; `None` where there is no such shell.
fn given(shell: &[&str], script: &str) -> Option<Vec<Vec<u8>>> {
    let run = Command::new(shell[0]).args(&shell[1..]).arg(script).current_dir(std::env::temp_dir()).output().ok()?;
    assert!(run.stderr.is_empty(), "{script}: {}", String::from_utf8_lossy(&run.stderr));
    let mut words: Vec<Vec<u8>> = run.stdout.split(|&byte| byte == 0).map(<[u8]>::to_owned).collect();
    assert_eq!(words.pop(), Some(Vec::new()), "{script}");
    Some(words)
}

/// Has POSIX shells run words, quoted; all of them are given as they are.
#[cfg(unix)]
fn hand_over(words: &[OsString]) {
    use std::os::unix::ffi::OsStrExt;
    let ends_with_line = |word: &OsString| word.as_bytes().ends_with(b"\n");
    for shell in ["sh", "dash", "bash", "zsh", "ksh"] {
        let skipped = |word: &&OsString| ["sh", "dash"].contains(&shell) && ends_with_line(word);
        for words in words.chunks(100) {
            let words: Vec<&OsString> = words.iter().filter(|word| !skipped(word)).collect();
            let line: Vec<String> = words.iter().map(|word| Shell::Posix.quote(word)).collect();
            let script = format!("stub() {{ printf '%s\\0' \"$@\"; }}; stub {}", line.join(" "));
            assert!(!script.contains(misleads), "{script:?}");
            let Some(given) = given(&[shell, "-c"], &script) else { continue };
            for ((given, word), quoted) in given.iter().zip(&words).zip(&line) {
                assert_eq!(OsStr::from_bytes(given), *word, "{shell}: {quoted}");
            }
            assert_eq!(given.len(), words.len(), "{shell}");
        }
    }
}

#[cfg(unix)]
#[test]
fn posix_shells_hand_over_the_words_as_they_are() {
    use std::os::unix::ffi::OsStringExt;
    let mut words: Vec<OsString> = NASTY.iter().map(Into::into).collect();
    words.extend(words_at_random(600).into_iter().map(Into::into));
    words.extend(["a\n", "\n\n", "a\u{1}'!\n"].map(Into::into));
    // Bytes that are no text, each of them once.
    words.extend((1..=255).map(|byte| OsString::from_vec(vec![b'a', byte, b'z'])));
    words.push(OsString::from_vec(b"\xff$(touch x)\xc3".to_vec()));
    hand_over(&words);
}

#[test]
fn powershell_hands_over_the_words_as_they_are() {
    let words: Vec<String> = NASTY.iter().map(|&word| word.to_owned()).chain(words_at_random(200)).collect();
    let line: Vec<String> = words.iter().map(|word| Shell::PowerShell.quote(word.as_ref())).collect();
    assert!(!line.concat().contains(misleads));
    // `printf` is a program of its own there; Windows has none.
    let Some(given) = given(&["pwsh", "-NoProfile", "-Command"], &format!("printf '%s\\0' {}", line.join(" "))) else {
        return;
    };
    assert_eq!(given, words.iter().map(|word| word.clone().into_bytes()).collect::<Vec<_>>());
}

#[test]
fn words_are_quoted_no_more_than_needed() {
    for (word, posix, power_shell) in [
        ("north.petro", "north.petro", "north.petro"),
        ("Müller-2", "Müller-2", "Müller-2"),
        ("--repair", "--repair", "--repair"),
        ("--kb=-2.5", "'--kb=-2.5'", "\"--kb=-2.5\""),
        ("-a.b", "-a.b", "\"-a.b\""),
        ("C:\\north.petro", "'C:\\north.petro'", "C:\\north.petro"),
        ("my north.petro", "'my north.petro'", "\"my north.petro\""),
        ("", "''", "\"\""),
        ("~", "'~'", "\"~\""),
        ("0,100", "0,100", "\"0,100\""),
        ("it's", "'it'\\''s'", "\"it's\""),
        ("Marl$(touch x)", "'Marl$(touch x)'", "'Marl$(touch x)'"),
        ("$it's", "'$it'\\''s'", "'$it''s'"),
        ("\u{2018}a\u{201d}", "'\u{2018}a\u{201d}'", "'\u{2018}\u{2018}a\u{201d}'"),
        ("100 %", "'100 %'", "'100 %'"),
        ("a b\\", "'a b\\'", "'a b\\'"),
        ("a\nb", "\"$(printf 'a\\012b')\"", "\"a$([char]0xa)b\""),
        ("$a\u{202e}\"", "\"$(printf '$a\\342\\200\\256\"')\"", "\"`$a$([char]0x202e)`\"\""),
        ("a!\n", "$'a\\041\\012'", "\"a!$([char]0xa)\""),
    ] {
        assert_eq!(Shell::Posix.quote(word.as_ref()), posix);
        assert_eq!(Shell::PowerShell.quote(word.as_ref()), power_shell);
    }
}

#[test]
fn values_that_look_like_options_stay_values() {
    let line = CommandLine::new("layer set").value("a.petro").value("-x").option("--name", "--y").flag("--json");
    assert_eq!(line.quoted(Shell::Posix), "petroglyph layer set '--name=--y' --json -- a.petro -x");
    let line = CommandLine::new("create").value("a.petro").option("--bounds", "-1,2").option("--size", "2x2x2");
    assert_eq!(line.quoted(Shell::Posix), "petroglyph create a.petro '--bounds=-1,2' --size 2x2x2");
}
