//! Names of data files: exactly `KIND/NAME`, so that a state can name only data of its own project.

/// Folders of data, one for each kind.
pub(crate) const KINDS: [&str; 6] = ["volumes", "horizons", "faults", "wells", "textures", "parameterizations"];

/// Whether `file` names data of the kind `kind`: `KIND/NAME` with one plain name that no file system reads as a path.
pub(crate) fn is_data_file(kind: &str, file: &str) -> bool {
    let Some(name) = file.strip_prefix(kind).and_then(|rest| rest.strip_prefix('/')) else { return false };
    !name.is_empty()
        && !name.starts_with('.')
        && !name.contains(['/', '\\', ':'])
        && !name.chars().any(char::is_control)
}

/// Whether `file` names data of any kind.
pub(crate) fn is_any_data_file(file: &str) -> bool {
    KINDS.iter().any(|kind| is_data_file(kind, file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_is_a_kind_and_a_plain_name() {
        for good in ["volumes/far.partial-stack.zarr", "volumes/a b.zarr", "volumes/x.new"] {
            assert!(is_data_file("volumes", good), "{good}");
        }
        for bad in [
            "",
            "volumes",
            "volumes/",
            "volumes/.",
            "volumes/..",
            "volumes/a/b",
            "volumes/a\\b",
            "horizons/a.zarr",
            "/volumes/a",
            "./volumes/a",
            "volumes//a",
            "volumes/c:a",
            "volumes/a\nb",
        ] {
            assert!(!is_data_file("volumes", bad), "{bad}");
        }
    }
}
