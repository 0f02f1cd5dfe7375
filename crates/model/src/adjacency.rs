//! Which layers touch: across horizons, unconformities and faults.
//!
//! Neighbours on a lattice of at most [`NODES`] nodes along each axis are compared. Between two that lie in different
//! layers the line is halved until its ends are [`CLOSE`] apart, so that a thin layer between them is found and the two
//! beside it are not said to touch. A layer that reaches no lattice line is missed. Positions in voxels.

use crate::StructuralModel;
use glam::Vec3;
use std::collections::BTreeSet;

/// Nodes along each axis.
const NODES: usize = 40;
/// The length, in voxels, of a line whose ends touch.
const CLOSE: f32 = 0.02;

impl StructuralModel {
    /// The pairs of layers that share a boundary somewhere in the survey, the deeper one first (0 = deepest).
    pub fn touching_layers(&self) -> Vec<[u16; 2]> {
        let size = self.size();
        let counts = size.map(|side| side.clamp(1, NODES));
        let at =
            |axis: usize, n: usize| (size[axis] - 1) as f32 * n as f32 / counts[axis].saturating_sub(1).max(1) as f32;
        let place = |n: [usize; 3]| Vec3::new(at(0, n[0]), at(1, n[1]), at(2, n[2]));
        let layer = |p: Vec3| self.region_at(p).layer;
        let mut found = BTreeSet::new();
        let mut layers = vec![0; counts.iter().product()];
        let index = |[x, y, z]: [usize; 3]| (x * counts[1] + y) * counts[2] + z;
        for x in 0..counts[0] {
            for y in 0..counts[1] {
                for z in 0..counts[2] {
                    let here = [x, y, z];
                    let own = layer(place(here));
                    layers[index(here)] = own;
                    for axis in 0..3 {
                        let mut before = here;
                        if before[axis] == 0 {
                            continue;
                        }
                        before[axis] -= 1;
                        let other = layers[index(before)];
                        if other != own {
                            between(&layer, (place(before), other), (place(here), own), &mut found);
                        }
                    }
                }
            }
        }
        found.into_iter().collect()
    }
}

/// Adds the pairs that touch along the line between two places in different layers.
fn between(layer: &impl Fn(Vec3) -> u16, first: (Vec3, u16), last: (Vec3, u16), found: &mut BTreeSet<[u16; 2]>) {
    if first.1 == last.1 {
        return;
    }
    if first.0.distance(last.0) <= CLOSE {
        found.insert([first.1.min(last.1), first.1.max(last.1)]);
        return;
    }
    let middle = (first.0 + last.0) * 0.5;
    let middle = (middle, layer(middle));
    between(layer, first, middle, found);
    between(layer, middle, last, found);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ModelSettings;
    use survey::geometry::{SurveyGeometry, VerticalUnit};
    use survey::progress::Progress;
    use synth::closed_form::ClosedForm;

    fn touching(form: &ClosedForm) -> Vec<[u16; 2]> {
        let settings = ModelSettings::default();
        let (strata, horizons, faults) = (&form.stratigraphy, &form.horizons, &form.faults);
        let model =
            StructuralModel::build(&form.geometry, strata, horizons, faults, &settings, &Progress::silent()).unwrap();
        model.touching_layers()
    }

    #[test]
    fn neighbours_touch_and_a_thin_layer_keeps_those_beside_it_apart() {
        let geometry = SurveyGeometry::regular([31, 21, 60], 25.0, 10.0, VerticalUnit::Metres);
        for thickness in [6.0, 0.4] {
            let form = ClosedForm::dipping(&geometry, &[20.0, 20.0 + thickness, 40.0], 10.0, 0.0);
            assert_eq!(touching(&form), [[0, 1], [1, 2], [2, 3]], "{thickness}");
        }
    }

    #[test]
    fn a_fault_brings_layers_together() {
        let geometry = SurveyGeometry::regular([61, 31, 60], 25.0, 10.0, VerticalUnit::Metres);
        // The hanging wall lies six samples deeper: its top layer meets the one below the thin one.
        let form = ClosedForm::flat(&geometry, &[20.0, 22.0, 40.0]).with_fault(60.0, 6.0);
        assert_eq!(touching(&form), [[0, 1], [1, 2], [1, 3], [2, 3]]);
    }
}
