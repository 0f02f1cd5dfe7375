//! A tile, as a project from anyone may bring it. The environment names its kind (`FUZZ_FORMAT`): `svg`, `png` or `jpg`.

#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use ttf::TextureLibrary;

static KIND: LazyLock<String> = LazyLock::new(|| std::env::var("FUZZ_FORMAT").unwrap_or_default());

/// Writes what fuzzing starts from to the folder that the environment names (`FUZZ_SEEDS`), if it names one.
fn write_seeds() -> std::io::Result<()> {
    let Some(corpus) = std::env::var_os("FUZZ_SEEDS") else { return Ok(()) };
    for (kind, name, bytes) in SEEDS {
        let folder = Path::new(&corpus).join(format!("tile-{kind}"));
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}

/// A drawing of everything that may be in one, and the smallest images.
const SEEDS: &[(&str, &str, &[u8])] = &[
    (
        "svg",
        "shapes",
        br##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 10 10" width="5mm"><style>.a{fill:#123456;clip-path:url(#c)}</style><defs><linearGradient id="g" x2="1"><stop offset="0" stop-color="red"/><stop offset="1"/></linearGradient><radialGradient id="r" xlink:href="#g"/><clipPath id="c"><rect width="5" height="5"/></clipPath><symbol id="s" viewBox="0 0 2 2"><circle r="1"/></symbol></defs><g transform="rotate(5) skewX(2)" opacity=".5"><path class="a" d="M0 0h5v5q1 1 2 0t1 1a1 2 3 0 1 4 5zC1 2 3 4 5 6S1 2 3 4" fill="url(#g)" stroke="url(#r)" stroke-dasharray="1 2"/></g><use xlink:href="#s" width="3"/><switch><polygon points="0,0 1,1 2,0"/></switch><ellipse rx="2" ry="3"/><line x2="3"/><svg x="2"><polyline points="1 1 2 2"/></svg></svg>"##,
    ),
    ("svg", "small", br#"<svg xmlns="http://www.w3.org/2000/svg" width="1" height="2"><rect width="1" height="1"/></svg>"#),
    (
        "png",
        "pixel",
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\x06\0\0\0\x1f\x15\xc4\x89\0\0\0\rIDATx\x9cc\xf8\xcf\xc0\xf0\x1f\0\x05\0\x01\xff\x89\x99=\x1d\0\0\0\0IEND\xaeB`\x82",
    ),
    ("jpg", "start", b"\xff\xd8\xff\xe0\0\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0\xff\xdb\0C\0\x08\x06\x06\xff\xd9"),
];

libfuzzer_sys::fuzz_target!(init: write_seeds().unwrap_or_else(|error| panic!("{error}")), |data: &[u8]| {
    if KIND.as_str() == "svg" {
        let _ = ttf::read_svg("input", data);
        return;
    }
    fuzz::with_file_of(&KIND, data, |path| {
        if let Ok(mut library) = TextureLibrary::builtin() {
            let _ = library.add_user(path);
        }
    });
});
