//! The tops of a LAS 3.0 file, as a table of tops.
//!
//! `~Tops_Parameter` tells the reference of depths (`TOPDR. Subsea`), `~Tops_Definition` the columns, `~Tops_Data |
//! Tops_Definition` the rows. The names of columns differ: the name is `TOPN`, or the only column of words; the depth is
//! `TOPT`, unless that is a column of words, or `TOPD`, `TOPDEP`, `MD`, `TVDSS` … Its unit is its own, or that of `STRT`.

use super::columns::{self, WellColumn};
use super::las::{LasItem, item};
use crate::text;

/// What names a top, the likeliest first.
const NAMES: [&str; 8] = ["TOPN", "TOPNAME", "NAME", "SURFACE", "FORMATION", "FORM", "TOP", "TOPS"];
/// What is the depth of a top.
const DEPTHS: [&str; 6] = ["TOPT", "TOPD", "TOPDEP", "TOPDEPTH", "TOPMD", "TOP"];

/// Whether a text begins with a section.
pub(super) fn is_las(text: &str) -> bool {
    text::lines(text).find(|line| !line.text.starts_with('#')).is_some_and(|line| line.text.starts_with('~'))
}

/// The file as a table: the columns of its tops on the line of the title of their data, the rows where they are, and all
/// other lines empty, so that lines keep their numbers. `None` if it has no tops.
pub(super) fn table_of(las: &str) -> Option<String> {
    if !is_las(las) {
        return None;
    }
    let mut table = String::new();
    let (mut section, mut delimiter, mut reference, mut unit) = (String::new(), None, String::new(), String::new());
    let mut items: Vec<LasItem> = Vec::new();
    let (mut header, mut rows) = (String::new(), 0_usize);
    for line in las.lines() {
        let line = line.trim();
        let found = |name: &str| item(line).filter(|item| item.mnemonic.eq_ignore_ascii_case(name));
        if let Some(title) = line.strip_prefix('~') {
            section = section_of(title);
            if section == "definition" {
                items.clear();
            }
            if section == "data" {
                let own = header_of(&items, &reference, &unit).unwrap_or_default();
                // Further tables of other columns are left out.
                if header.is_empty() {
                    header = own;
                    table += &header;
                } else if own != header {
                    section.clear();
                }
            }
        } else if !line.starts_with('#') {
            match section.as_str() {
                "definition" => items.extend(item(line)),
                "parameter" => reference = found("TOPDR").map_or(reference, |item| item.value),
                "data" if !line.is_empty() => {
                    rows += 1;
                    let fields = text::fields(line, delimiter);
                    table += &fields.iter().map(|field| field.text.replace(';', ",")).collect::<Vec<_>>().join(";");
                }
                _ => {
                    delimiter = match found("DLM").map(|item| item.value.to_ascii_uppercase()).as_deref() {
                        Some("COMMA") => Some(','),
                        Some("TAB") => Some('\t'),
                        Some(_) => None,
                        None => delimiter,
                    };
                    unit = found("STRT").map_or(unit, |item| item.unit);
                }
            }
        }
        table.push('\n');
    }
    (!header.is_empty() && rows > 0).then_some(table)
}

/// The part of the tops that a section is: parameter, definition or data; empty for other sections.
fn section_of(title: &str) -> String {
    let title = title.trim().to_ascii_lowercase();
    let own = title.split(['|', '[', ' ']).next().unwrap_or("");
    match own.split_once('_') {
        Some(("tops" | "top" | "formation" | "formations", part)) => match part {
            "parameter" | "parameters" => "parameter".to_owned(),
            "definition" | "definitions" => "definition".to_owned(),
            "data" => "data".to_owned(),
            _ => String::new(),
        },
        _ => String::new(),
    }
}

fn is_words(item: &LasItem) -> bool {
    item.description.contains("{S") || item.value.contains("{S")
}

/// The names of the columns as a table of tops has them; `None` without a name or a depth.
fn header_of(items: &[LasItem], reference: &str, unit: &str) -> Option<String> {
    let mnemonic = |item: &LasItem| item.mnemonic.to_ascii_uppercase();
    let known = |names: &[&str], is_own: &dyn Fn(&LasItem) -> bool| {
        names.iter().find_map(|name| items.iter().position(|item| mnemonic(item) == *name && is_own(item)))
    };
    let of_kind = |wanted: &[WellColumn]| {
        items.iter().position(|item| !is_words(item) && wanted.contains(&columns::of_name(&item.mnemonic).0))
    };
    let name = known(&NAMES, &is_words)
        .or_else(|| items.iter().position(is_words))
        .or_else(|| known(&NAMES, &|item| mnemonic(item) != "TOP"))?;
    let depth = known(&DEPTHS, &|item| !is_words(item))
        .or_else(|| of_kind(&[WellColumn::Md, WellColumn::From]))
        .or_else(|| of_kind(&[WellColumn::Tvdss, WellColumn::Tvd]))
        .filter(|depth| *depth != name)?;
    let named = columns::of_name(&items[depth].mnemonic).0;
    let reference = reference.to_ascii_lowercase();
    let kind = match named {
        WellColumn::Tvdss => "tvdss",
        WellColumn::Tvd => "tvd",
        _ if ["subsea", "sub-sea", "sub sea", "tvdss", "msl", "sea level"].iter().any(|w| reference.contains(w)) => {
            "tvdss"
        }
        _ if reference.contains("tvd") || reference.contains("vertical") => "tvd",
        _ => "md",
    };
    let own = if items[depth].unit.is_empty() { unit } else { &items[depth].unit };
    let column = |n: usize| match n {
        n if n == name => "surface".to_owned(),
        n if n == depth && own.is_empty() => kind.to_owned(),
        n if n == depth => format!("{kind}[{own}]"),
        n => format!("other{n}"),
    };
    Some((0..items.len()).map(column).collect::<Vec<_>>().join(";"))
}
