//! Notes on places.

use super::{Effect, Noun, ProjectError};
use crate::document::NoteEntry;
use crate::folder::Draft;
use serde::{Deserialize, Serialize};
use survey::SurveyGeometry;

/// Longest text of a note, characters.
const LONGEST: usize = 500;

/// Writes a note on a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AddNote {
    /// The note.
    pub note: NoteEntry,
}

impl AddNote {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let NoteEntry { text, at, scene } = &self.note;
        let bad = |fact: String| Err(ProjectError::BadNote(fact));
        if text.trim().is_empty() {
            return bad("it is empty".to_owned());
        }
        if text.chars().any(|c| c.is_control() && c != '\n') {
            return bad("it contains control characters".to_owned());
        }
        if text.chars().count() > LONGEST {
            return bad(format!("it is longer than {LONGEST} characters"));
        }
        if let Some(scene) = scene {
            draft.document.position(Noun::Scene, scene)?;
        }
        let frame = draft.document.frame()?;
        if !is_inside(frame, *at) {
            let [inlines, crosslines, vertical] =
                [[frame.inlines.first, frame.inlines.last()], [frame.crosslines.first, frame.crosslines.last()]]
                    .map(|ends| ends.map(f64::from))
                    .into_iter()
                    .chain([[frame.vertical.first, frame.vertical.last()]])
                    .map(|[first, last]| format!("{first} to {last}"))
                    .collect::<Vec<_>>()
                    .try_into()
                    .unwrap_or_default();
            return bad(format!(
                "its place {},{},{} lies outside the survey, whose inlines are {inlines}, crosslines {crosslines} and \
                 vertical values {vertical}",
                at[0], at[1], at[2]
            ));
        }
        draft.document.notes.push(self.note.clone());
        Ok(Effect::Changed { summary: format!("note {}", draft.document.notes.len()) })
    }
}

/// Whether a place of inline, crossline and vertical value lies in a survey.
fn is_inside(frame: &SurveyGeometry, [inline, crossline, z]: [f64; 3]) -> bool {
    let voxel = frame.voxel_from_lines(inline, crossline).extend(frame.vertical.index_of(z));
    let size = frame.size();
    (0..3).all(|axis| voxel[axis] >= -1e-6 && voxel[axis] <= (size[axis].max(1) - 1) as f64 + 1e-6)
}
