//! The known names that are most like one that is not known.

/// At most this many are offered.
const OFFERED: usize = 3;

/// Of the known names those that are most like a name, best first: at most three, which differ by at most half of their
/// letters, and by hardly more letters than the best. Accents, capitals and spaces do not count.
pub(crate) fn alike<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let asked = plain(name);
    let rated = known.into_iter().filter_map(|known| {
        let letters = plain(known);
        let (apart, longer) =
            (strsim::levenshtein(&asked, &letters), asked.chars().count().max(letters.chars().count()));
        (2 * apart <= longer).then_some((1000 * apart / longer.max(1), apart, known))
    });
    let mut rated: Vec<(usize, usize, &str)> = rated.collect();
    rated.sort_unstable();
    rated.dedup();
    let most = rated.first().map_or(0, |(_, apart, _)| apart + 1);
    rated.into_iter().filter(|(_, apart, _)| *apart <= most).map(|(.., known)| known).take(OFFERED).collect()
}

/// Names that are alike as a question at the end of a sentence, or else what to do instead.
pub(crate) fn offered(names: &[&str], otherwise: &str) -> String {
    match names {
        [] => otherwise.to_owned(),
        [only] => format!("did you mean {only}?"),
        [others @ .., last] => format!("did you mean {} or {last}?", others.join(", ")),
    }
}

/// The letters and digits of a name without capitals and the commonest accents.
pub(crate) fn plain(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase);
    letters.map(unaccented).collect()
}

fn unaccented(letter: char) -> char {
    const ACCENTED: [(&str, char); 8] = [
        ("àáâãäåā", 'a'),
        ("ç", 'c'),
        ("èéêëē", 'e'),
        ("ìíîïī", 'i'),
        ("ñ", 'n'),
        ("òóôõöøō", 'o'),
        ("ùúûüū", 'u'),
        ("ýÿ", 'y'),
    ];
    ACCENTED.into_iter().find(|(accented, _)| accented.contains(letter)).map_or(letter, |(_, plain)| plain)
}
