//! Source files as text: where they are, what in them is code, how long their functions are.

use std::fs;
use std::path::{Path, PathBuf};

/// A source file.
pub(crate) struct Source {
    /// Where it is, from the crate's folder.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
}

/// Names and folders of the workspace's crates.
pub(crate) fn crates() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = vec![("petroglyph".to_owned(), root.to_owned())];
    for entry in fs::read_dir(root.join("crates")).expect("the crates").flatten() {
        found.push((entry.file_name().to_string_lossy().into_owned(), entry.path()));
    }
    found.sort();
    found
}

impl Source {
    /// Every source file of the crate in `folder`.
    pub(crate) fn all(folder: &Path) -> Vec<Self> {
        let (mut found, mut folders) = (Vec::new(), vec![folder.join("src")]);
        while let Some(next) = folders.pop() {
            for entry in fs::read_dir(&next).expect("a folder of sources").flatten() {
                let path = entry.path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let text = fs::read_to_string(&path).expect("a source file");
                    let path = path.strip_prefix(folder.join("src")).expect("inside").to_owned();
                    found.push(Self { path, text });
                }
            }
        }
        found.sort_by(|a, b| a.path.cmp(&b.path));
        found
    }

    /// Its lines.
    pub(crate) fn line_count(&self) -> usize {
        self.text.lines().count()
    }

    /// Whether all of it is a test.
    pub(crate) fn is_test(&self) -> bool {
        let is_test = |part: &str| part == "tests" || part == "tests.rs" || part.ends_with("_tests.rs");
        self.path.iter().any(|part| part.to_str().is_some_and(is_test))
    }

    /// Its code without comments, texts and what follows the first test module.
    pub(crate) fn code(&self) -> String {
        let end = self.text.find("#[cfg(test)]\nmod tests {").unwrap_or(self.text.len());
        let mut code = String::with_capacity(end);
        for line in self.text[..end].lines() {
            let line = line.split("//").next().unwrap_or_default();
            let parts: Vec<&str> = line.split('"').collect();
            // What stands between quotation marks is no code; a text over several lines does no harm here.
            code.extend(parts.iter().step_by(2).map(|part| format!("{part} ")));
            code.push('\n');
        }
        code
    }

    /// Name and lines of each function, by the indentation that the formatter gives: from `fn` to the brace below it.
    pub(crate) fn functions(&self) -> Vec<(String, usize)> {
        let lines: Vec<&str> = self.text.lines().collect();
        let mut found = Vec::new();
        for (start, line) in lines.iter().enumerate() {
            let body = line.trim_start();
            let words = body.split("fn ").next().unwrap_or_default();
            let is_head = body.contains("fn ")
                && words
                    .split_whitespace()
                    .all(|word| word.starts_with("pub") || ["const", "unsafe", "async"].contains(&word));
            if !is_head {
                continue;
            }
            let close = format!("{}}}", &line[..line.len() - body.len()]);
            let is_one_line = body.ends_with('}') || body.ends_with(';');
            let length =
                if is_one_line { 1 } else { lines[start..].iter().take_while(|line| **line != close).count() + 1 };
            let name = body.split("fn ").nth(1).unwrap_or_default();
            found.push((name.split(['(', '<']).next().unwrap_or_default().to_owned(), length));
        }
        found
    }
}
