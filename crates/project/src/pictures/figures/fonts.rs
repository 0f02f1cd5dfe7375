//! The font files of a project and of a command, as the faces that figures are lettered in.

use crate::Project;
use crate::error::ProjectError;
use std::cmp::Reverse;
use std::path::{Component, Path, PathBuf};
use system::file;
use ttf::text::{Face, Faces};

/// Where fonts are installed, on Linux, macOS and Windows; the second ones in a person's home.
const INSTALLED: [&str; 5] =
    ["/usr/share/fonts", "/usr/local/share/fonts", "/System/Library/Fonts", "/Library/Fonts", "C:\\Windows\\Fonts"];
const INSTALLED_AT_HOME: [&str; 3] = [".local/share/fonts", ".fonts", "Library/Fonts"];
/// At most so many files are looked at, in folders at most so deep, and so many are named.
const MOST_FILES: usize = 5000;
const DEEPEST: usize = 8;
const MOST_NAMED: usize = 3;

/// Largest font file that is read: those with all Chinese, Japanese and Korean letters have some 20 MB a weight.
const MOST_BYTES: u64 = 1 << 28;

/// The embedded face, those that the project names (`fonts` in `project.toml`), and those of these files.
///
/// # Errors
/// [`ProjectError::Font`]: a file cannot be read, is no font, or a name in the project leads out of its folder.
pub fn faces(project: &Project, files: &[PathBuf]) -> Result<Faces, ProjectError> {
    let mut faces = Vec::new();
    for name in &project.document().fonts {
        faces.push(face(&within(project.root(), name)?)?.1);
    }
    for file in files {
        faces.push(face(file)?.1);
    }
    Ok(Faces::new(faces))
}

/// A font file, and which face of a collection is meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FontFile {
    /// Its bytes, of which a face was read.
    pub bytes: Vec<u8>,
    /// The face, from 0.
    pub index: u32,
}

/// The font files that a project in the folder `root` names: those that can be used.
pub fn font_files(root: &Path, names: &[String]) -> Vec<FontFile> {
    let files = names.iter().map(|name| Ok(face(&within(root, name)?)?.0));
    files.filter_map(|file: Result<FontFile, ProjectError>| file.ok()).collect()
}

/// The path of a font that a project names.
fn within(root: &Path, name: &str) -> Result<PathBuf, ProjectError> {
    if Path::new(name).components().all(|part| matches!(part, Component::Normal(_))) {
        return Ok(root.join(name));
    }
    let fact = "a font of the project lies in the project's folder: copy it there, and write its place in \
                `fonts` from that folder";
    Err(ProjectError::Font { path: PathBuf::from(name), fact: fact.to_owned() })
}

/// The face of a file. `NAME.ttc#3` is the fourth face of a collection.
fn face(path: &Path) -> Result<(FontFile, Face), ProjectError> {
    let whole = path.to_string_lossy();
    let numbered = whole.rsplit_once('#').and_then(|(file, index)| Some((PathBuf::from(file), index.parse().ok()?)));
    let (file, index) = numbered.filter(|_| !path.exists()).unwrap_or_else(|| (path.to_owned(), 0));
    let unusable = |fact: String| ProjectError::Font { path: path.to_owned(), fact };
    let bytes = file::read(&file, MOST_BYTES).map_err(|error| unusable(format!("it could not be read: {error}")))?;
    let face = Face::parse(bytes.clone(), index).map_err(|error| unusable(error.to_string()))?;
    Ok((FontFile { bytes, index }, face))
}

/// Names installed font files that have these characters, after a semicolon: advice alone, since what a figure looks like
/// depends on its project and its command only.
pub(super) fn advice(characters: Vec<char>) -> String {
    let home = std::env::var_os("HOME").or_else(|| std::env::var_os("USERPROFILE")).map(PathBuf::from);
    let at_home = home.into_iter().flat_map(|home| INSTALLED_AT_HOME.map(|folder| home.join(folder)));
    let files = with_characters(INSTALLED.map(PathBuf::from).into_iter().chain(at_home), characters);
    let named: Vec<String> = files.iter().map(|file| format!("--font \"{}\"", file.display())).collect();
    if named.is_empty() { String::new() } else { format!("; installed here are {}", named.join(" ")) }
}

/// Adds the font files in a folder and those in it, in the order of their names.
fn fonts_below(folder: &Path, deep: usize, fonts: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort_unstable();
    for path in paths {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_font = ending.is_some_and(|ending| ["ttf", "otf", "ttc"].contains(&ending.as_str()));
        if is_font && fonts.len() < MOST_FILES {
            fonts.push(path);
        } else if deep > 0 && path.is_dir() {
            fonts_below(&path, deep - 1, fonts);
        }
    }
}

/// The same for the fonts in these folders.
fn with_characters(folders: impl Iterator<Item = PathBuf>, mut characters: Vec<char>) -> Vec<PathBuf> {
    let mut fonts = Vec::new();
    folders.for_each(|folder| fonts_below(&folder, DEEPEST, &mut fonts));
    let known = fonts.into_iter().filter_map(|path| {
        let face = face(&path).ok()?.1;
        let has: Vec<char> = characters.iter().copied().filter(|character| face.has(*character)).collect();
        // Plain letters rather than bold ones, and without serifs as the embedded face.
        let name = path.file_stem()?.to_string_lossy().to_lowercase();
        let is_odd =
            ["bold", "italic", "black", "light", "thin", "mono", "serif"].iter().any(|word| name.contains(word));
        (!has.is_empty()).then_some((is_odd, path, has))
    });
    let known: Vec<(bool, PathBuf, Vec<char>)> = known.collect();
    let mut named = Vec::new();
    while named.len() < MOST_NAMED {
        let more = |has: &[char]| has.iter().filter(|character| characters.contains(character)).count();
        let best = known.iter().filter(|(_, _, has)| more(has) > 0);
        let Some((_, path, has)) = best.min_by_key(|(is_odd, _, has)| (Reverse(more(has)), *is_odd)) else { break };
        named.push(path.clone());
        characters.retain(|character| !has.contains(character));
    }
    named
}

#[cfg(test)]
mod tests {
    use super::*;

    const FONTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../ttf/tests/fonts");

    #[test]
    fn installed_fonts_are_found_by_their_letters() {
        let folder = || std::iter::once(PathBuf::from(FONTS));
        let names = |letters: &str| -> Vec<String> {
            let found = with_characters(folder(), letters.chars().collect());
            found.iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect()
        };
        assert_eq!(names("石"), ["han.otf"]);
        assert_eq!(names("石灰حج岩"), ["han.otf", "arabic.ttf"]);
        assert!(names("\u{1f30b}").is_empty() && names("").is_empty());
        assert!(with_characters(std::iter::once(PathBuf::from("/no/such/folder")), vec!['石']).is_empty());
    }

    #[test]
    fn faces_come_from_the_project_and_from_the_command() {
        let at = tempfile::tempdir().unwrap();
        let root = at.path().join("p.petro");
        Project::create(&root, None).unwrap().publish().unwrap();
        let project = Project::open(&root).unwrap();
        let arabic = PathBuf::from(FONTS).join("arabic.ttf");
        assert_eq!(faces(&project, std::slice::from_ref(&arabic)).unwrap().count(), 2);
        assert!(faces(&project, &[PathBuf::from(format!("{}#1", arabic.display()))]).is_err());
        // As a person would write it.
        let written = std::fs::read_to_string(root.join("project.toml")).unwrap();
        std::fs::write(root.join("project.toml"), format!("fonts = [\"fonts/han.otf\"]\n{written}")).unwrap();
        let project = Project::open(&root).unwrap();
        let missing = faces(&project, &[]).unwrap_err().to_string();
        assert!(missing.contains("han.otf"), "{missing}");
        std::fs::create_dir(root.join("fonts")).unwrap();
        std::fs::copy(PathBuf::from(FONTS).join("han.otf"), root.join("fonts/han.otf")).unwrap();
        assert_eq!(faces(&project, &[arabic]).unwrap().count(), 3);
        let names = ["fonts/han.otf", "fonts/none.otf", "../han.otf"].map(str::to_owned);
        assert_eq!(font_files(&root, &names).len(), 1);
        std::fs::write(root.join("project.toml"), format!("fonts = [\"../han.otf\"]\n{written}")).unwrap();
        let outside = faces(&Project::open(&root).unwrap(), &[]).unwrap_err().to_string();
        assert!(outside.contains("copy it there"), "{outside}");
    }
}
