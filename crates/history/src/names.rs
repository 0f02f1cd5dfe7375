//! The known names that are most like one that is not known, and how they are offered.

/// At most this many are offered.
const OFFERED: usize = 3;

/// The known names that differ from `name` by at most half of their letters, best first, at most three.
pub(crate) fn alike<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let plain = |name: &str| name.to_lowercase().replace([' ', '-'], "_");
    let asked = plain(name);
    let rated = known.into_iter().filter_map(|known| {
        let apart = strsim::damerau_levenshtein(&asked, &plain(known));
        let longer = asked.chars().count().max(known.chars().count());
        (2 * apart <= longer).then_some((apart, known))
    });
    let mut rated: Vec<(usize, &str)> = rated.collect();
    rated.sort_unstable();
    let most = rated.first().map_or(0, |(apart, _)| apart + 1);
    rated.into_iter().filter(|(apart, _)| *apart <= most).map(|(_, known)| known.to_owned()).take(OFFERED).collect()
}

/// A question with the names that are alike, or else what all of them are.
pub(crate) fn offered(alike: &[String], otherwise: &str, all: &[String]) -> String {
    match alike {
        [] => format!("{otherwise} {}", all.join(", ")),
        [only] => format!("did you mean {only}?"),
        [others @ .., last] => format!("did you mean {} or {last}?", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_a_wrong_letter_are_found_and_others_are_not() {
        let known = ["wavelength", "amplitude", "axis"];
        assert_eq!(alike("wavelenght", known), ["wavelength"]);
        assert_eq!(alike("Axes", known), ["axis"]);
        assert!(alike("depth", known).is_empty());
    }
}
