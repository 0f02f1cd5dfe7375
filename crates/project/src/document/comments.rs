//! Comments of `project.toml`: what a person wrote between the lines stays when a command writes the file again.
//!
//! A comment belongs to the key, table or entry below it, or to the value before it on the same line. It
//! stays as long as that item exists. Entries of a list are recognised by their `name`, `layer` or `file`.

use toml_edit::{ArrayOfTables, Decor, DocumentMut, Item, Table};

/// The text `new` with the comments that `old` has at the same places.
pub(crate) fn keep_comments(old: &str, new: String) -> String {
    let (Ok(old), Ok(mut document)) = (old.parse::<DocumentMut>(), new.parse::<DocumentMut>()) else { return new };
    keep_in_table(old.as_table(), document.as_table_mut());
    if let Some(end) = old.trailing().as_str().filter(|end| end.contains('#')) {
        document.set_trailing(end);
    }
    document.to_string()
}

fn keep_in_table(old: &Table, new: &mut Table) {
    for (name, old_item) in old {
        if let (Some(from), Some(mut to)) = (old.key(name), new.key_mut(name)) {
            keep_decor(from.leaf_decor(), to.leaf_decor_mut());
        }
        match (old_item, new.get_mut(name)) {
            (Item::Table(old), Some(Item::Table(new))) => {
                keep_decor(old.decor(), new.decor_mut());
                keep_in_table(old, new);
            }
            (Item::ArrayOfTables(old), Some(Item::ArrayOfTables(new))) => keep_in_list(old, new),
            (Item::Value(old), Some(Item::Value(new))) => keep_decor(old.decor(), new.decor_mut()),
            _ => {}
        }
    }
}

fn keep_in_list(old: &ArrayOfTables, new: &mut ArrayOfTables) {
    let same_count = old.len() == new.len();
    for (place, entry) in new.iter_mut().enumerate() {
        let former = match name_of(entry) {
            Some(name) => old.iter().find(|former| name_of(former).as_ref() == Some(&name)),
            None => old.get(place).filter(|_| same_count),
        };
        if let Some(former) = former {
            keep_decor(former.decor(), entry.decor_mut());
            keep_in_table(former, entry);
        }
    }
}

fn name_of(entry: &Table) -> Option<String> {
    let name = ["name", "layer", "file"].iter().find_map(|key| entry.get(key)?.as_str());
    name.map(str::to_owned)
}

/// Takes over text that holds a comment; blank space stays as it is written.
fn keep_decor(old: &Decor, new: &mut Decor) {
    let comment = |text: Option<&toml_edit::RawString>| {
        text.and_then(|text| text.as_str()).filter(|text| text.contains('#')).map(str::to_owned)
    };
    if let Some(prefix) = comment(old.prefix()) {
        new.set_prefix(prefix);
    }
    if let Some(suffix) = comment(old.suffix()) {
        new.set_suffix(suffix);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_stay_with_what_they_are_about() {
        let old = "# ours\n\n# mine, above\nversion = 1 # at the end\n\n[style]\n# inside\nraw = 2\n\n# about B\
                   \n[[horizons]]\nname = \"B\"\nfile = \"b\"\n\n[[horizons]]\nname = \"C\" # c\n# the end\n";
        let new = "# ours\n\nversion = 2\n\n[style]\nraw = 3\n\n[[horizons]]\nname = \"A\"\nfile = \"a\"\n\
                   \n[[horizons]]\nname = \"B\"\nfile = \"b2\"\n";
        let kept = keep_comments(old, new.to_owned());
        assert_eq!(
            kept,
            "# ours\n\n# mine, above\nversion = 2 # at the end\n\n[style]\n# inside\nraw = 3\n\n[[horizons]]\
             \nname = \"A\"\nfile = \"a\"\n\n# about B\n[[horizons]]\nname = \"B\"\nfile = \"b2\"\n# the end\n"
        );
        assert_eq!(keep_comments(&kept, new.to_owned()), kept);
    }

    #[test]
    fn without_comments_the_text_is_as_it_was_written() {
        let new = "version = 2\n\n[a]\nb = [\n    1,\n    2,\n]\n";
        assert_eq!(keep_comments("version = 1\n[a]\nb = [1,2]\n", new.to_owned()), new);
        assert_eq!(keep_comments("not toml at all [", new.to_owned()), new);
    }
}
