//! A horizon or fault file. The environment names the format (`FUZZ_FORMAT`), or leaves it to be detected.

#![no_main]

use std::sync::LazyLock;

use files::{Format, ImportOptions, read_fault, read_horizons};

static FORMAT: LazyLock<Option<Format>> = LazyLock::new(|| {
    let name = std::env::var("FUZZ_FORMAT").ok().filter(|name| name != "detected")?;
    Some(Format::from_name(&name).unwrap_or_else(|| panic!("FUZZ_FORMAT {name} is no format")))
});

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let survey = fuzz::survey();
    let options = ImportOptions { format: *FORMAT, ..ImportOptions::default() };
    fuzz::with_file(data, |path| {
        let _ = read_horizons(path, &survey, &options);
        let _ = read_fault(path, &survey, &options);
    });
});
