//! The plan of the house, held against the code: no import circle between modules of different folders, no file or
//! function that has grown too long, a module documentation at the top of every file.
//!
//! Reads the sources as text; nothing is compiled. `use` statements and paths in the code are followed to the file that
//! defines what they name, through re-exports. Tests are left out.

mod endings;
mod imports;
mod source;

use imports::Crate;
use source::{Source, crates};
use std::path::Path;

/// Lines of a file.
const FILE_LINES: usize = 600;
/// Lines of a function.
const FUNCTION_LINES: usize = 100;

#[test]
fn no_import_circle_joins_modules_of_different_folders() {
    let mut circles = Vec::new();
    for (name, folder) in crates() {
        circles.extend(Crate::read(&folder).circles().into_iter().map(|circle| format!("{name}: {circle}")));
    }
    assert!(circles.is_empty(), "import circles:\n{}", circles.join("\n"));
}

#[test]
fn files_and_functions_stay_short() {
    let mut long = Vec::new();
    for (_, folder) in crates() {
        let sources = Source::all(&folder);
        for source in &sources {
            if source.line_count() > FILE_LINES {
                long.push(format!("{}: {} lines", source.path.display(), source.line_count()));
            }
            let functions = source.functions().into_iter().filter(|(_, lines)| *lines > FUNCTION_LINES);
            long.extend(functions.map(|(name, lines)| format!("{}: fn {name}: {lines} lines", source.path.display())));
        }
    }
    assert!(long.is_empty(), "too long:\n{}", long.join("\n"));
}

#[test]
fn every_file_says_what_it_is_about() {
    let mut silent = Vec::new();
    for (_, folder) in crates() {
        let sources = Source::all(&folder);
        silent.extend(sources.iter().filter(|source| !source.text.starts_with("//!")).map(|s| s.path.clone()));
    }
    assert!(silent.is_empty(), "without module documentation: {silent:?}");
}

/// docs/tried.md promises for each row a test that fails when it is no longer so.
#[test]
fn every_case_that_was_tried_has_its_test() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/tried.md")).unwrap();
    let mut code = String::new();
    for folder in ["crates", "src", "tests"] {
        gather(&root.join(folder), &mut code);
    }
    let rows = page.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| tried"));
    let mut count = 0;
    for row in rows {
        let cell = row.trim_end_matches(['|', ' ']).rsplit('|').next().unwrap_or_default();
        // The words in code quotes: names of tests, and of files where these are.
        let quoted = cell.split('`').skip(1).step_by(2);
        let tests: Vec<&str> = quoted.filter(|name| !name.contains(['/', '.'])).collect();
        assert!(!tests.is_empty(), "without a test: {row}");
        for name in tests {
            assert!(code.contains(&format!("fn {name}()")), "docs/tried.md names {name}, which is no test");
            count += 1;
        }
    }
    assert!(count > 50, "{count} tests were named");
}

/// The text of all Rust files of a folder.
fn gather(folder: &Path, code: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            gather(&path, code);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            code.push_str(&std::fs::read_to_string(&path).unwrap());
        }
    }
}

/// The finder must be able to fail: a circle across folders is found, through re-exports too, and one within a folder
/// is not.
#[test]
fn a_circle_is_found_where_there_is_one() {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = folder.path().join("src").join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("lib.rs", "mod a;\nmod b;\npub use b::inner::Thing;\n");
    write("a/mod.rs", "mod one;\nmod two;\n");
    write("a/one.rs", "use super::two::X;\nuse crate::Thing;\n");
    write("a/two.rs", "use super::one::Y;\n// use crate::b::Never;\n");
    write("b/mod.rs", "pub mod inner;\n");
    write("b/inner.rs", "pub struct Thing;\n");
    assert_eq!(Crate::read(folder.path()).circles(), Vec::<String>::new());
    write(
        "b/inner.rs",
        "pub struct Thing;\nfn f() { crate::a::one::g(); }\n#[cfg(test)]\nmod tests { use crate::a; }\n",
    );
    let circles = Crate::read(folder.path()).circles();
    assert_eq!(circles.len(), 1, "{circles:?}");
    assert!(circles[0].contains("b/inner.rs") && circles[0].contains("a/one.rs"), "{circles:?}");
}
