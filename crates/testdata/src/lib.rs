//! What tests share: the folder of the real data files, which `PETROGLYPH_DATA` names, and an object storage on
//! loopback ([`s3`]).
//!
//! Without the folder a test on real data says that it is skipped. Where the data are promised, because the variable is set or
//! because continuous integration runs (`CI=true`), their absence is a failure. Used by tests only.

pub mod s3;

use std::env;
use std::path::PathBuf;

/// The folder of the data files; none where nobody promised them, which is said on stderr.
///
/// # Panics
/// The variable names something that is no folder, or is missing although `CI` is `true`.
pub fn folder() -> Option<PathBuf> {
    let Some(folder) = env::var_os("PETROGLYPH_DATA").map(PathBuf::from) else {
        assert!(
            env::var("CI").as_deref() != Ok("true"),
            "CI is true, so tests on real data must run: set PETROGLYPH_DATA to the folder of the data files"
        );
        eprintln!("skipped: PETROGLYPH_DATA does not name the folder of the real data files");
        return None;
    };
    assert!(folder.is_dir(), "PETROGLYPH_DATA names {}, which is no folder", folder.display());
    Some(folder)
}
