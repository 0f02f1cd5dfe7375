//! Contact rules: which horizon ends at which other one. The rules are applied to sheets that are themselves
//! never cut.
//!
//! Every rule is a boolean function of one bit per horizon, which says "this place is below the sheet of h":
//!
//! - erosional h: an older horizon that rises above h ends there, z_g = max(z_g, z_h);
//! - conformable or onlap h: it ends where it meets an older horizon, z_h = min(z_h, z_g). Between
//!   conformable horizons this happens only within the crossing tolerance, or where sheets are extrapolated.
//!   Against an older erosional or onlap surface it is how the younger layers lap on;
//! - intrusive h: everything below it belongs to its layer, and every other horizon ends where it meets it.
//!   List an intrusion below all the horizons it cuts, so that the layer it closes is its own;
//! - truncated h: an intrusion that ends where it rises above an erosional surface younger than itself.
//!
//! Because the bits suffice, a section is cut by the smooth, unclipped sheets, and junctions are exact
//! intersections of two of them.

use crate::sides::Below;
use survey::stratigraphy::{Contact, Stratigraphy};

/// The contacts of a stratigraphy, youngest first, ready to be applied to the sheets of a model.
///
/// # Examples
/// An erosion surface at 20 cuts an older horizon that rises to 10:
/// ```
/// use model::ContactRules;
/// use survey::stratigraphy::{Contact, Stratigraphy, StratigraphicHorizon};
///
/// let horizon = |name: &str, contact| StratigraphicHorizon { name: name.into(), contact };
/// let rules = ContactRules::new(&Stratigraphy {
///     horizons: vec![horizon("erosion", Contact::Erosional), horizon("older", Contact::Conformable)],
///     layer_names: Vec::new(),
/// });
/// let mut z = [20.0, 10.0];
/// rules.clip(&mut z);
/// assert_eq!(z, [20.0, 20.0]);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ContactRules {
    contacts: Vec<Contact>,
    erosional: Below,
    intrusive: Below,
    truncated: Below,
    /// Intrusive and truncated ones.
    bodies: Below,
}

impl ContactRules {
    /// The rules of `stratigraphy`.
    pub fn new(stratigraphy: &Stratigraphy) -> Self {
        Self::of(stratigraphy.horizons.iter().map(|h| h.contact).collect())
    }

    /// The rules between some of the horizons, given by their places in the order.
    pub(super) fn among(&self, horizons: &[usize]) -> Self {
        Self::of(horizons.iter().map(|&h| self.contacts[h]).collect())
    }

    /// The rules of contacts, youngest horizon first.
    pub fn of(contacts: Vec<Contact>) -> Self {
        let all = |kind: Contact| contacts.iter().map(|contact| *contact == kind).collect();
        let (erosional, intrusive, truncated) =
            (all(Contact::Erosional), all(Contact::Intrusive), all(Contact::Truncated));
        let bodies = contacts.iter().map(|contact| contact.is_intrusive()).collect();
        Self { contacts, erosional, intrusive, truncated, bodies }
    }

    /// The contacts, youngest horizon first.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// The layer of a place that lies below these horizons.
    pub fn layer(&self, below: &Below) -> u16 {
        let n = self.contacts.len();
        let eroded = self.erosional.first_without(below, n).unwrap_or(n);
        // The place belongs to the youngest intrusion that contains it, if no erosion has removed that there.
        let intrusive = self.intrusive.first_shared(below, n);
        let body = intrusive.into_iter().chain(self.truncated.first_shared(below, eroded)).min();
        // Or else, in the order of deposition: the oldest horizon that the place is still below.
        let horizon = body.or_else(|| below.last_without(&self.bodies, eroded));
        horizon.map_or(n, |h| n - 1 - h) as u16
    }

    /// Whether any horizon cuts through others, whatever their age.
    pub(super) fn has_intrusions(&self) -> bool {
        self.bodies != Below::default()
    }

    /// Cuts the heights of all sheets at one place, youngest first, in place: a horizon that has ended lies
    /// on the one it ended at.
    pub fn clip(&self, z: &mut [f32]) {
        self.clip_some(0, z);
    }

    /// The same for the horizons from `first` on, as many as there are heights, as if there were no others.
    pub(super) fn clip_some(&self, first: usize, z: &mut [f32]) {
        let n = z.len();
        let contacts = &self.contacts[first..first + n];
        let mut eroded = f32::NEG_INFINITY;
        for (contact, z) in contacts.iter().zip(&mut *z) {
            match contact {
                Contact::Erosional => eroded = eroded.max(*z),
                Contact::Truncated => *z = z.max(eroded),
                _ => {}
            }
        }
        let mut older: Option<usize> = None;
        for h in (0..n).rev() {
            match contacts[h] {
                Contact::Intrusive | Contact::Truncated => continue,
                Contact::Erosional => {
                    for g in h + 1..n {
                        if !contacts[g].is_intrusive() {
                            z[g] = z[g].max(z[h]);
                        }
                    }
                }
                Contact::Conformable | Contact::Onlap => {
                    if let Some(g) = older {
                        z[h] = z[h].min(z[g]);
                    }
                }
            }
            older = Some(h);
        }
        for i in 0..n {
            if contacts[i].is_intrusive() {
                for h in 0..n {
                    // Between two intrusions the younger one wins.
                    if h != i && (!contacts[h].is_intrusive() || h > i) {
                        z[h] = z[h].min(z[i]);
                    }
                }
            }
        }
    }

    /// Whether younger horizon `h` and older horizon `g` may cross: one of them, or one between them, ends
    /// the other.
    pub fn may_cross(&self, h: usize, g: usize) -> bool {
        self.contacts[h] == Contact::Erosional
            || self.contacts[h].is_intrusive()
            || self.contacts[h + 1..=g].iter().any(|&c| c != Contact::Conformable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::stratigraphy::StratigraphicHorizon;

    fn rules(contacts: &[Contact]) -> ContactRules {
        let horizons = contacts
            .iter()
            .enumerate()
            .map(|(h, &contact)| StratigraphicHorizon { name: format!("H{h}"), contact })
            .collect();
        ContactRules::new(&Stratigraphy { horizons, layer_names: Vec::new() })
    }

    fn below(z: f32, sheets: &[f32]) -> Below {
        sheets.iter().map(|&s| z >= s).collect()
    }

    #[test]
    fn an_erosion_surface_cuts_what_is_older() {
        let r = rules(&[Contact::Conformable, Contact::Erosional, Contact::Conformable, Contact::Conformable]);
        // The third horizon rises above the unconformity at 50; the place between them is already eroded.
        let sheets = [20.0, 50.0, 40.0, 80.0];
        assert_eq!(r.layer(&below(45.0, &sheets)), 3);
        assert_eq!(r.layer(&below(60.0, &sheets)), 1);
        let mut z = sheets;
        r.clip(&mut z);
        assert_eq!(z, [20.0, 50.0, 50.0, 80.0]);
    }

    #[test]
    fn a_younger_horizon_laps_onto_an_onlap_surface() {
        let r = rules(&[Contact::Conformable, Contact::Onlap, Contact::Conformable]);
        let sheets = [60.0, 50.0, 70.0];
        assert_eq!(r.layer(&below(55.0, &sheets)), 1);
        let mut z = sheets;
        r.clip(&mut z);
        assert_eq!(z, [50.0, 50.0, 70.0]);
    }

    #[test]
    fn salt_replaces_everything_below_its_top() {
        let r = rules(&[Contact::Conformable, Contact::Conformable, Contact::Intrusive]);
        let sheets = [20.0, 40.0, 10.0];
        assert_eq!(r.layer(&below(30.0, &sheets)), 0);
        assert_eq!(r.layer(&below(5.0, &sheets)), 3);
        let mut z = sheets;
        r.clip(&mut z);
        assert_eq!(z, [10.0, 10.0, 10.0]);
    }

    #[test]
    fn erosion_cuts_an_intrusion_that_is_older() {
        let r = rules(&[Contact::Conformable, Contact::Erosional, Contact::Conformable, Contact::Truncated]);
        // The intrusion rises to 10 through the erosion surface at 30, over which the youngest bed lies at 20.
        let sheets = [20.0, 30.0, 60.0, 10.0];
        assert_eq!([5.0, 15.0, 25.0, 35.0].map(|z| r.layer(&below(z, &sheets))), [4, 4, 3, 0]);
        let mut z = sheets;
        r.clip(&mut z);
        assert_eq!(z, [20.0, 30.0, 30.0, 30.0]);
    }

    #[test]
    fn layers_and_clipped_sheets_tell_the_same_story() {
        let all = [Contact::Conformable, Contact::Erosional, Contact::Onlap];
        let mut state = 1u32;
        let mut next = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) as f32 / 65536.0
        };
        for _ in 0..4000 {
            let contacts: Vec<Contact> = (0..5)
                .map(|h| match next() {
                    share if h == 4 && share < 0.2 => Contact::Intrusive,
                    share if h == 4 && share < 0.4 => Contact::Truncated,
                    share => all[(share * 1009.0) as usize % 3],
                })
                .collect();
            let r = rules(&contacts);
            let sheets: Vec<f32> = (0..5).map(|h| 20.0 * h as f32 + 60.0 * next()).collect();
            let z = 160.0 * next();
            let mut cut = sheets.clone();
            r.clip(&mut cut);
            assert!(cut.windows(2).all(|w| w[0] <= w[1]), "{contacts:?} {cut:?}");
            let passed = cut.iter().filter(|&&s| z >= s).count();
            assert_eq!(usize::from(r.layer(&below(z, &sheets))), 5 - passed, "{contacts:?} {sheets:?} {z}");
        }
    }
}
