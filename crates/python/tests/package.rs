//! The extension is built with the tests of the workspace, so that `make test-python` compiles nothing again. What is in it
//! is tested in Python, beside this file.

use std::path::PathBuf;

/// The folder in which this test and the extension were built.
fn built() -> PathBuf {
    let here = std::env::current_exe().expect("the path of this test");
    here.parent().expect("a folder").to_owned()
}

#[cfg(target_os = "linux")]
#[test]
fn the_extension_needs_no_library_of_python_and_has_the_function_that_python_calls() {
    let content = std::fs::read(built().join("libpetroglyph_native.so")).expect("the extension");
    let has = |text: &[u8]| content.windows(text.len()).any(|part| part == text);
    assert!(has(b"PyInit__native\0"));
    assert!(!has(b"libpython"), "it would not load into an interpreter that is linked statically");
}

#[cfg(not(target_os = "linux"))]
#[test]
fn the_extension_is_built() {
    let endings = ["dylib", "dll"];
    let found = std::fs::read_dir(built()).expect("the folder").flatten().any(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        name.contains("petroglyph_native") && endings.iter().any(|ending| name.ends_with(ending))
    });
    assert!(found);
}
