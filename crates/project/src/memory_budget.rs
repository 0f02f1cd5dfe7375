//! The memory that is available.

/// Half of the memory that is available now, bytes ([`system::memory::available`]).
pub fn half_of_available() -> u64 {
    system::memory::available() / 2
}

/// Parses a number of bytes such as `2G`, `512M`, `800K` or a plain number.
///
/// ```
/// assert_eq!(project::memory_budget::parse_bytes("512M"), Some(512 * 1024 * 1024));
/// assert_eq!(project::memory_budget::parse_bytes("much"), None);
/// ```
pub fn parse_bytes(text: &str) -> Option<u64> {
    let text = text.trim();
    let (number, unit) = match text.char_indices().next_back()? {
        (at, 'k' | 'K') => (&text[..at], 1u64 << 10),
        (at, 'm' | 'M') => (&text[..at], 1 << 20),
        (at, 'g' | 'G') => (&text[..at], 1 << 30),
        _ => (text, 1),
    };
    let number: f64 = number.trim().parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0)?;
    Some((number * unit as f64) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_powers_of_1024() {
        assert_eq!(parse_bytes("2G"), Some(2 << 30));
        assert_eq!(parse_bytes("1.5m"), Some(3 << 19));
        assert_eq!(parse_bytes("7K"), Some(7 << 10));
        assert_eq!(parse_bytes("4096"), Some(4096));
        for wrong in ["", "G", "-2G", "2T", "two", "nan", "0"] {
            assert_eq!(parse_bytes(wrong), None, "{wrong}");
        }
    }
}
