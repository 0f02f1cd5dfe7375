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
        let is_within = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        if !is_within {
            let fact = "a font of the project lies in the project's folder: copy it there, and write its place in \
                        `fonts` from that folder";
            return Err(ProjectError::Font { path: PathBuf::from(name), fact: fact.to_owned() });
        }
        faces.push(face(&project.root().join(name))?);
    }
    for file in files {
        faces.push(face(file)?);
    }
    Ok(Faces::new(faces))
}

/// The face of a file. `NAME.ttc#3` is the fourth face of a collection.
fn face(path: &Path) -> Result<Face, ProjectError> {
    let whole = path.to_string_lossy();
    let numbered = whole.rsplit_once('#').and_then(|(file, index)| Some((PathBuf::from(file), index.parse().ok()?)));
    let (file, index) = numbered.filter(|_| !path.exists()).unwrap_or_else(|| (path.to_owned(), 0));
    let unusable = |fact: String| ProjectError::Font { path: path.to_owned(), fact };
    let bytes = file::read(&file, MOST_BYTES).map_err(|error| unusable(format!("it could not be read: {error}")))?;
    Face::parse(bytes, index).map_err(|error| unusable(error.to_string()))
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
        std::fs::write(root.join("project.toml"), format!("fonts = [\"../han.otf\"]\n{written}")).unwrap();
        let outside = faces(&Project::open(&root).unwrap(), &[]).unwrap_err().to_string();
        assert!(outside.contains("copy it there"), "{outside}");
    }
}
