//! Who imports whom in a crate, and the circles in it.

use super::source::Source;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module: the names from the crate's root down.
type Module = Vec<String>;

/// A crate's modules and what they import.
pub(crate) struct Crate {
    files: BTreeMap<Module, PathBuf>,
    /// Names that a module takes in by `use`, with the path they stand for.
    uses: BTreeMap<Module, Vec<(String, Vec<String>)>>,
    /// All paths that begin in the crate, module by module.
    paths: BTreeMap<Module, Vec<Vec<String>>>,
}

impl Crate {
    /// Reads the crate in `folder`.
    pub(crate) fn read(folder: &Path) -> Self {
        let mut made = Self { files: BTreeMap::new(), uses: BTreeMap::new(), paths: BTreeMap::new() };
        for source in Source::all(folder).into_iter().filter(|source| !source.is_test()) {
            let module = module_of(&source.path);
            let code = source.code();
            let uses: Vec<(String, Vec<String>)> = use_trees(&code);
            let mut paths: Vec<Vec<String>> = uses.iter().map(|(_, path)| path.clone()).collect();
            paths.extend(paths_in(&code));
            made.uses.insert(module.clone(), uses);
            made.paths.insert(module.clone(), paths);
            made.files.insert(module, source.path);
        }
        made
    }

    /// The file that defines what `path` names, seen from `module`; none for what other crates define.
    fn resolve(&self, module: &Module, path: &[String], depth: usize) -> Option<Module> {
        let (mut at, mut rest) = match path.first()?.as_str() {
            "crate" => (Module::new(), &path[1..]),
            "self" => (module.clone(), &path[1..]),
            "super" => (module.split_last()?.1.to_vec(), &path[1..]),
            first => {
                let child: Module = module.iter().cloned().chain([first.to_owned()]).collect();
                (self.files.contains_key(&child).then_some(module.clone())?, path)
            }
        };
        while let Some((name, tail)) = rest.split_first() {
            if name == "super" {
                at.pop()?;
            } else {
                let child: Module = at.iter().cloned().chain([name.clone()]).collect();
                if !self.files.contains_key(&child) {
                    let uses = self.uses.get(&at).into_iter().flatten();
                    let exported = uses.filter(|(exported, _)| exported == name).map(|(_, path)| path);
                    let found = exported.filter(|_| depth < 8).find_map(|path| self.resolve(&at, path, depth + 1));
                    return Some(found.unwrap_or(at));
                }
                at = child;
            }
            rest = tail;
        }
        Some(at)
    }

    /// Circles of files that do not all lie in one folder, each as a line.
    pub(crate) fn circles(&self) -> Vec<String> {
        let mut imports: BTreeMap<&Module, BTreeSet<Module>> = BTreeMap::new();
        for (module, paths) in &self.paths {
            let found = paths.iter().filter_map(|path| self.resolve(module, path, 0));
            // The root and a folder's own face hand names on; who asks them was led further above.
            imports.insert(module, found.filter(|other| other != module && !module.starts_with(other)).collect());
        }
        let reaches = |from: &Module| -> BTreeSet<Module> {
            let (mut seen, mut open) = (BTreeSet::new(), vec![from.clone()]);
            while let Some(next) = open.pop() {
                for other in imports.get(&next).into_iter().flatten() {
                    if seen.insert(other.clone()) {
                        open.push(other.clone());
                    }
                }
            }
            seen
        };
        let reached: BTreeMap<&Module, BTreeSet<Module>> = self.files.keys().map(|m| (m, reaches(m))).collect();
        let mut told = BTreeSet::new();
        let mut circles = Vec::new();
        for module in self.files.keys() {
            let members: BTreeSet<&Module> = reached[module]
                .iter()
                .filter(|other| reached.get(*other).is_some_and(|r| r.contains(module)))
                .collect();
            let folders: BTreeSet<PathBuf> = members.iter().map(|m| self.folder(m)).collect();
            if folders.len() > 1 && told.insert(members.clone()) {
                let edges = members.iter().flat_map(|from| {
                    let to =
                        imports[*from].iter().filter(|to| members.contains(to) && self.folder(from) != self.folder(to));
                    to.map(|to| format!("{} -> {}", self.files[*from].display(), self.files[to].display()))
                });
                circles.push(edges.collect::<Vec<_>>().join("; "));
            }
        }
        circles
    }

    /// The folder that a module belongs to: `a.rs` beside a folder `a` is that folder's face.
    fn folder(&self, module: &Module) -> PathBuf {
        let path = &self.files[module];
        let has_children = self.files.keys().any(|other| other.len() > module.len() && other.starts_with(module));
        if has_children { PathBuf::from(module.join("/")) } else { path.parent().unwrap_or(Path::new("")).to_owned() }
    }
}

fn module_of(path: &Path) -> Module {
    let mut names: Module = path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if matches!(names.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        names.pop();
    }
    names
}

/// Every `use` as the name it takes in and its whole path.
fn use_trees(code: &str) -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(at) = rest.find("use ") {
        let is_word = at == 0 || rest[..at].ends_with(char::is_whitespace);
        rest = &rest[at + 4..];
        if let Some(end) = rest.find(';').filter(|_| is_word) {
            tree(&rest[..end].split_whitespace().collect::<Vec<_>>().join(" "), &[], &mut found);
            rest = &rest[end..];
        }
    }
    found
}

/// Follows `a::{b, c::d as e}` to its leaves.
fn tree(text: &str, before: &[String], found: &mut Vec<(String, Vec<String>)>) {
    let text = text.trim();
    if let Some(open) = text.find('{') {
        let mut path = before.to_vec();
        path.extend(segments(&text[..open]));
        let inner = text[open + 1..].trim_end().trim_end_matches('}');
        let (mut depth, mut start) = (0usize, 0);
        for (at, c) in inner.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth = depth.saturating_sub(1),
                ',' if depth == 0 => {
                    tree(&inner[start..at], &path, found);
                    start = at + 1;
                }
                _ => {}
            }
        }
        return tree(&inner[start..], &path, found);
    }
    let (path_text, name) = text.split_once(" as ").map_or((text, None), |(path, name)| (path, Some(name)));
    let mut path = before.to_vec();
    path.extend(segments(path_text).into_iter().filter(|part| part != "self" || before.is_empty()));
    if let Some(last) = path.last().cloned() {
        found.push((name.map_or(last, str::to_owned), path));
    }
}

fn segments(text: &str) -> Vec<String> {
    text.split("::").map(str::trim).filter(|part| !part.is_empty()).map(str::to_owned).collect()
}

/// Paths in the code that begin with `crate` or `super`.
fn paths_in(code: &str) -> Vec<Vec<String>> {
    let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let words = code.split(|c: char| !is_path(c));
    words.filter(|word| word.starts_with("crate::") || word.starts_with("super::")).map(segments).collect()
}
