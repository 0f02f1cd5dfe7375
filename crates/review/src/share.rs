//! The kinds of files that a review leaves the program in: the one table of their endings.

use std::path::Path;

/// What is shared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShareKind {
    /// A page for browsers.
    Page,
    /// A model for slides.
    Model,
}

impl ShareKind {
    /// The endings of its files, without the dot, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Page => &["html", "htm"],
            Self::Model => &["glb"],
        }
    }

    /// The usual ending of its files, without the dot.
    pub fn ending(self) -> &'static str {
        self.endings()[0]
    }

    /// Whether a name has one of its endings.
    ///
    /// ```
    /// use review::ShareKind;
    /// assert!(ShareKind::Page.is_of("north.HTM".as_ref()) && !ShareKind::Model.is_of("north.html".as_ref()));
    /// ```
    pub fn is_of(self, path: &Path) -> bool {
        let ending = path.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| self.endings().iter().any(|known| known.eq_ignore_ascii_case(ending)))
    }
}
