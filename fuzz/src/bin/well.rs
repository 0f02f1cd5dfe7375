//! A file of a well. The environment names its kind (`FUZZ_FORMAT`): `deviation`, `tops`, `checkshot`, `las` or `rms`.

#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use files::well::{
    WellOptions, WellReport, describe, parse_checkshot, parse_deviation, parse_las, parse_rms, parse_tops,
};
use survey::well::WellPath;

static KIND: LazyLock<String> = LazyLock::new(|| std::env::var("FUZZ_FORMAT").unwrap_or_default());
static PATH: LazyLock<WellPath> = LazyLock::new(fuzz::well_path);

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let text = String::from_utf8_lossy(data);
    let (file, options, mut notes) = (Path::new("input"), WellOptions::default(), WellReport::default());
    let _ = describe(file, &text);
    match KIND.as_str() {
        "deviation" => drop(parse_deviation(file, &text, &options)),
        "tops" => drop(parse_tops(file, &text, &PATH, &options, &mut notes)),
        "checkshot" => drop(parse_checkshot(file, &text, &PATH, &options, &mut notes)),
        "rms" => drop(parse_rms(file, &text, &options)),
        "las" => drop(parse_las(file, &text)),
        other => panic!("FUZZ_FORMAT {other} is no kind of well file"),
    }
});
