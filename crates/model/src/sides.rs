//! Which horizons a place lies below: one bit for each.

/// Words of bits.
const WORDS: usize = 16;
/// Bits of a word.
const BITS: usize = u64::BITS as usize;
/// Largest number of horizons of a model.
pub const MOST_HORIZONS: usize = WORDS * BITS;

/// For each horizon of a model, youngest first, whether a place lies at or below its unclipped sheet, on its older side,
/// or inside its body.
///
/// ```
/// use model::Below;
/// let below: Below = [true, false, true].into_iter().collect();
/// assert!(below.has(0) && !below.has(1) && below.has(2));
/// assert!(below.differs_only_at(2, &below.with(2, false)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Below([u64; WORDS]);

impl Below {
    /// Whether the place lies below a horizon.
    pub fn has(&self, horizon: usize) -> bool {
        self.0[horizon / BITS] >> (horizon % BITS) & 1 == 1
    }

    /// The same with another answer for one horizon.
    #[must_use]
    pub fn with(mut self, horizon: usize, is_below: bool) -> Self {
        self.set(horizon, is_below);
        self
    }

    /// Changes the answer for one horizon.
    pub(crate) fn set(&mut self, horizon: usize, is_below: bool) {
        let bit = 1 << (horizon % BITS);
        let word = &mut self.0[horizon / BITS];
        *word = if is_below { *word | bit } else { *word & !bit };
    }

    /// Whether another place lies on the other side of this horizon, and of no other one.
    pub fn differs_only_at(&self, horizon: usize, other: &Self) -> bool {
        let alone = Self::default().with(horizon, true);
        (0..WORDS).all(|n| self.0[n] ^ other.0[n] == alone.0[n])
    }

    /// The first `count` horizons, the youngest.
    pub(crate) fn youngest(count: usize) -> Self {
        Self(std::array::from_fn(|n| bits_before(count, n)))
    }

    /// The first horizon before `end` that both have.
    pub(crate) fn first_shared(&self, other: &Self, end: usize) -> Option<usize> {
        first_bit(end, |n| self.0[n] & other.0[n])
    }

    /// The first horizon before `end` that this has and the other one has not.
    pub(crate) fn first_without(&self, other: &Self, end: usize) -> Option<usize> {
        first_bit(end, |n| self.0[n] & !other.0[n])
    }

    /// The last horizon before `end` that this has and the other one has not.
    pub(crate) fn last_without(&self, other: &Self, end: usize) -> Option<usize> {
        (0..end.div_ceil(BITS)).rev().find_map(|n| {
            let word = self.0[n] & !other.0[n] & bits_before(end, n);
            word.checked_ilog2().map(|bit| n * BITS + bit as usize)
        })
    }

    /// The first horizon from `first` on, in order of age, that does not have all of three places on one side.
    pub(crate) fn first_between(places: [&Self; 3], first: usize) -> Option<usize> {
        let [a, b, c] = places;
        (first / BITS..WORDS).find_map(|n| {
            let seen = if n == first / BITS { u64::MAX << (first % BITS) } else { u64::MAX };
            let apart = ((a.0[n] ^ b.0[n]) | (b.0[n] ^ c.0[n])) & seen;
            (apart != 0).then(|| n * BITS + apart.trailing_zeros() as usize)
        })
    }

    /// Takes the answers of another place for all horizons from `first` on.
    pub(crate) fn take_from(&mut self, first: usize, other: &Self) {
        for n in first / BITS..WORDS {
            let taken = if n == first / BITS { u64::MAX << (first % BITS) } else { u64::MAX };
            self.0[n] = self.0[n] & !taken | other.0[n] & taken;
        }
    }
}

/// Those bits of word `n` that stand for horizons before `end`.
fn bits_before(end: usize, n: usize) -> u64 {
    match end.saturating_sub(n * BITS) {
        count @ 0..BITS => (1 << count) - 1,
        _ => u64::MAX,
    }
}

/// The first horizon before `end` whose bit is set in the words.
fn first_bit(end: usize, word: impl Fn(usize) -> u64) -> Option<usize> {
    (0..end.div_ceil(BITS)).find_map(|n| {
        let word = word(n) & bits_before(end, n);
        (word != 0).then(|| n * BITS + word.trailing_zeros() as usize)
    })
}

/// The answers for the horizons in order, youngest first. Further ones than `MOST_HORIZONS` are left out.
impl FromIterator<bool> for Below {
    fn from_iter<T: IntoIterator<Item = bool>>(answers: T) -> Self {
        let mut below = Self::default();
        for (h, is_below) in answers.into_iter().take(MOST_HORIZONS).enumerate() {
            below.0[h / BITS] |= u64::from(is_below) << (h % BITS);
        }
        below
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_horizon_has_a_bit_of_its_own() {
        for h in [0, 1, 63, 64, 65, 127, 128, MOST_HORIZONS - 1] {
            let one = Below::default().with(h, true);
            assert!((0..MOST_HORIZONS).all(|g| one.has(g) == (g == h)));
            assert_eq!(one, (0..MOST_HORIZONS).map(|g| g == h).collect());
            assert!(one.differs_only_at(h, &Below::default()) && !one.differs_only_at((h + 1) % 70, &Below::default()));
            assert_eq!(one.with(h, false), Below::default());
        }
    }

    #[test]
    fn horizons_of_two_places_are_found_from_either_end() {
        let at = |horizons: &[usize]| horizons.iter().fold(Below::default(), |below, h| below.with(*h, true));
        let (one, other) = (at(&[3, 63, 64, 200]), at(&[3, 64, 130]));
        let ends = [0, 3, 4, 63, 64, 65, 200, 201, MOST_HORIZONS];
        let found = |of: fn(&Below, &Below, usize) -> Option<usize>| ends.map(|end| of(&one, &other, end));
        let (none, three, last) = (None, Some(3), Some(63));
        assert_eq!(found(Below::first_shared), [none, none, three, three, three, three, three, three, three]);
        assert_eq!(found(Below::first_without), [none, none, none, none, last, last, last, last, last]);
        assert_eq!(found(Below::last_without), [none, none, none, none, last, last, last, Some(200), Some(200)]);
        for count in [0, 1, 63, 64, 65, MOST_HORIZONS] {
            assert_eq!(Below::youngest(count), (0..count).map(|_| true).collect());
        }
    }

    #[test]
    fn horizons_between_places_are_found_in_order() {
        let at = |horizons: &[usize]| horizons.iter().fold(Below::default(), |below, h| below.with(*h, true));
        let places = [at(&[3, 64, 200]), at(&[3, 64]), at(&[3, 70, 200])];
        let first = |from| Below::first_between(places.each_ref(), from);
        assert_eq!(
            [0, 64, 65, 70, 71, 200, 201].map(first),
            [Some(64), Some(64), Some(70), Some(70), Some(200), Some(200), None]
        );
        let mut taken = places[0];
        taken.take_from(65, &places[2]);
        assert_eq!(taken, at(&[3, 64, 70, 200]));
    }
}
