//! Endings of files: each stands in the table of its kind, which everything else asks.

use super::source::{Source, crates};

/// Where endings are written down, and what in other files has the same letters and is none.
const ALLOWED: [(&str, &str, &str); 13] = [
    ("page", "animation/gif.rs", "its line of the table of pages"),
    ("page", "pdf/mod.rs", "its line of the table of pages"),
    ("page", "raster/png.rs", "its line of the table of pages"),
    ("page", "raster/tiff.rs", "its line of the table of pages"),
    ("page", "svg/mod.rs", "its line of the table of pages"),
    ("page", "formats.rs", "the examples of the table"),
    ("review", "share.rs", "the table of what is shared"),
    ("review", "html.rs", "a type of data within a page"),
    ("review", "page.rs", "a type of data within a page"),
    ("ttf", "raster.rs", "the table of files of tiles"),
    ("ttf", "builtin.rs", "names of the program's own tiles"),
    ("files", "segy/mod.rs", "the table of SEG-Y files"),
    ("files", "", "a file for each format of horizons and faults, with its line of the table"),
];

/// Endings of pages, animations, shared files and volumes, and words and endings of formats that surfaces are written in.
fn endings() -> Vec<String> {
    let files = page::FileFormat::pages().chain(page::FileFormat::animations()).map(page::FileFormat::ending);
    let shared =
        [review::ShareKind::Page, review::ShareKind::Model].into_iter().flat_map(|kind| kind.endings().to_vec());
    let kinds = [files::SurfaceKind::Horizon, files::SurfaceKind::Fault];
    let surfaces = files::Format::all().filter(|format| kinds.iter().any(|kind| format.writes(*kind)));
    // Tables and lists of points have endings that are not theirs alone.
    let surfaces =
        surfaces.flat_map(|format| [format.name(), format.extension()]).filter(|word| !["csv", "dat"].contains(word));
    let all = files.chain(shared).chain(files::segy::ENDINGS).chain(surfaces);
    all.map(str::to_owned).collect()
}

/// Whether a line writes an ending down: alone between quotation marks, or in a list with another.
fn is_told(line: &str, endings: &[String]) -> bool {
    let is_ending = |word: &str| endings.iter().any(|ending| ending == word);
    let is_text = line.split('"').skip(1).step_by(2).any(|text| is_ending(text.trim_start_matches('.')));
    let words: Vec<&str> =
        line.split([' ', ',', '|', '(', ')', '"']).filter(|word| !["", "or", "and"].contains(word)).collect();
    let is_dotted = |word: &&str| word.strip_prefix('.').is_some_and(is_ending);
    is_text || words.windows(2).any(|pair| pair.iter().all(is_dotted))
}

#[test]
fn endings_of_files_stand_in_their_tables_alone() {
    let endings = endings();
    assert!(endings.len() > 12, "{endings:?}");
    for told in ["a.extension() == \"png\"", "/// File to write: .png or .tif", "(.sgy, .segy)", "&[\".svg\"]"] {
        assert!(is_told(told, &endings), "the rule finds nothing in {told}");
    }
    for other in ["render north.petro block.png", "a.png, b.svg", "let png = encoded(image);"] {
        assert!(!is_told(other, &endings), "the rule takes {other} for an ending");
    }
    let mut found = Vec::new();
    for (name, folder) in crates() {
        for source in Source::all(&folder).iter().filter(|source| !source.is_test()) {
            let path = source.path.to_string_lossy().replace('\\', "/");
            if ALLOWED
                .iter()
                .any(|(of, file, _)| *of == name && (path == *file || file.is_empty() && !path.contains('/')))
            {
                continue;
            }
            let end = source.text.find("#[cfg(test)]\nmod tests").unwrap_or(source.text.len());
            let lines = source.text[..end].lines().enumerate().filter(|(_, line)| is_told(line, &endings));
            found.extend(lines.map(|(n, line)| format!("{name}/{path}:{}: {}", n + 1, line.trim())));
        }
    }
    assert!(found.is_empty(), "endings beside their tables:\n{}", found.join("\n"));
}
