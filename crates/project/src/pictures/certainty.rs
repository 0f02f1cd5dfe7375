//! How much of each horizon was picked, as against filled or extrapolated: a picture shows the one like the other.
//!
//! As in the model and in the dashes of pictures, a place within four traces of a pick counts as picked.

use super::load::Rock;
use crate::document::Document;
use glam::Vec3;
use rayon::prelude::*;

/// Places along each line at which a horizon is looked at: the share is right to about a percent.
const PLACES: usize = 72;
/// Share below which a horizon is called sparse.
const SPARSE: f64 = 0.5;
/// Distance above and below a horizon at which the layers are compared, samples.
const BESIDE: f32 = 0.05;

/// How much of a horizon was picked of the places where it bounds a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct PickedShare {
    /// Its name.
    pub name: String,
    /// The share that was picked, 0 to 1; NaN where it bounds no layer.
    pub share: f64,
}

impl PickedShare {
    /// Whether less than half was picked.
    pub(crate) fn is_sparse(&self) -> bool {
        self.share < SPARSE
    }

    /// The share as it is written everywhere.
    pub fn percent(&self) -> String {
        format!("{:.0} %", 100.0 * self.share)
    }

    /// What there is to know before a picture is believed.
    pub fn sentence(&self) -> String {
        let percent = self.percent();
        // "Horizon 1" is its name already.
        let noun = if self.name.to_lowercase().starts_with("horizon") { "" } else { "horizon " };
        format!("{noun}{} was picked on or near {percent} of its traces; the rest is filled or extrapolated", self.name)
    }
}

/// Most horizons that are named as hardly picked.
const MOST_NAMED: usize = 8;

/// What there is to know of horizons that were hardly picked: a sentence each, and one that counts the rest of very many.
///
/// ```
/// use project::pictures::{PickedShare, sparse_sentences};
/// let sparse: Vec<_> = (0..1000).map(|n| PickedShare { name: format!("H{n}"), share: 0.0 }).collect();
/// assert_eq!(sparse_sentences(&sparse[..2]).len(), 2);
/// assert_eq!(sparse_sentences(&sparse).len(), 9);
/// assert!(sparse_sentences(&sparse)[8].starts_with("992 more horizons were picked on or near less than half"));
/// ```
pub fn sparse_sentences(sparse: &[PickedShare]) -> Vec<String> {
    // A line that counts a single one would be no shorter.
    let named = if sparse.len() > MOST_NAMED + 1 { MOST_NAMED } else { sparse.len() };
    let rest = sparse.len() - named;
    let counted = format!("{rest} more horizons were picked on or near less than half of their traces");
    sparse[..named].iter().map(PickedShare::sentence).chain((rest > 0).then_some(counted)).collect()
}

impl Rock {
    /// The share of each horizon, youngest first, that was picked or tracked, 0 to 1, of the places where it bounds a
    /// layer; NaN where it bounds none.
    pub fn picked_shares(&self) -> Vec<f64> {
        let model = &self.model;
        let [nx, ny, nz] = model.size();
        let at = |n: usize, count: usize, size: usize| n as f32 * (size - 1) as f32 / (count - 1).max(1) as f32;
        let [across, along] = [nx, ny].map(|size| size.min(PLACES));
        let share = |horizon: usize| {
            let places = (0..across).into_par_iter().flat_map_iter(|x| (0..along).map(move |y| (x, y)));
            let counts = places.map(|(x, y)| {
                let (x, y) = (at(x, across, nx), at(y, along, ny));
                let mut counts = [0usize; 2];
                let blocks = 0..model.block_count() as u16;
                // What is no height field is whole: it was made of all of its points.
                for block in blocks.filter(|block| model.level(horizon, *block).is_none()) {
                    let z = model.horizon_z(horizon, block, x, y);
                    if !(z >= 0.0 && z <= (nz - 1) as f32) {
                        continue;
                    }
                    let [above, below] = [-BESIDE, BESIDE].map(|off| model.region_at(Vec3::new(x, y, z + off)));
                    if above.block == block && above.layer != below.layer {
                        let quality = model.quality_at(horizon, block, x, y);
                        counts[0] += usize::from(quality.is_on_data());
                        counts[1] += 1;
                    }
                }
                counts
            });
            let [picked, all] = counts.reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            picked as f64 / all as f64
        };
        (0..model.stratigraphy().horizons.len()).map(share).collect()
    }

    /// The same by the names that the horizons have in a project.
    pub fn picked(&self, document: &Document) -> Vec<PickedShare> {
        let shares = self.picked.get_or_init(|| self.picked_shares());
        let named = document.stratigraphy().horizons.into_iter().zip(shares);
        named.map(|(horizon, share)| PickedShare { name: horizon.name, share: *share }).collect()
    }
}
