//! The font files of a project and of a command, as the faces that figures are lettered in.

use project::Project;
use project::error::ProjectError;
use std::path::{Component, Path, PathBuf};
use survey::file;
use ttf::text::{Face, Faces};

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

#[cfg(test)]
mod tests {
    use super::*;

    const FONTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../ttf/tests/fonts");

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
