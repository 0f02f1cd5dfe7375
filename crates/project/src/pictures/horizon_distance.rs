//! Distances to the horizons of an interpretation in the format of an extraction, so that imported horizons can be
//! shown in volumes and on faces, too (P-horiz 5.2).
//!
//! The distance of a voxel to a sheet z = h(x, y) is |z − h|/√(1 + |∇h|²), exact for a plane, up to the largest
//! distance that the codes can hold; that to a surface of any shape is told by its field alike. Where there are candidates already, a horizon replaces them within two voxels and
//! wherever it is nearer. Voxel space.

use glam::{Vec2, Vec3};
use model::{LevelSurface, StructuralModel};
use rayon::prelude::*;
use survey::candidates::{BEYOND, CandidateBox};
use survey::{Cancelled, Progress};

/// Largest distance that is stored if nothing else determines it, voxels.
pub(super) const FARTHEST: f32 = 10.0;
/// The code of the largest distance.
const STEPS: f32 = (BEYOND - 1) as f32;
/// Distance within which a horizon takes precedence over candidates, since it may run along one of them.
const OWN: f32 = 2.0;

/// How far on both sides of a surface of any shape the layers are compared, voxels.
const BESIDE: f32 = 0.5;

/// A lattice whose voxels are all far from everything.
pub(super) fn nothing_near(size: [usize; 3]) -> CandidateBox {
    let count = size.iter().product();
    CandidateBox { size, distance: vec![BEYOND; count], leaf: vec![0; count] }
}

/// Adds the horizons numbered `which` of a model to distances up to `farthest` voxels; the id of the model's n-th
/// horizon is `first_id + n`.
///
/// # Errors
/// The user cancelled.
pub(super) fn add_horizons(
    model: &StructuralModel,
    which: &[usize],
    first_id: u32,
    farthest: f32,
    into: &mut CandidateBox,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let [nx, ny, nz] = into.size;
    progress.begin("distances to horizons", nx as u64);
    let row = (ny * nz).max(1);
    let planes = into.distance.par_chunks_mut(row).zip(into.leaf.par_chunks_mut(row));
    let adding = Adding { model, which, first_id, farthest, depth: nz };
    planes.enumerate().try_for_each(|(x, (distance, leaf))| {
        for y in 0..ny {
            let trace = y * nz..(y + 1) * nz;
            adding.fill([x, y], &mut distance[trace.clone()], &mut leaf[trace]);
        }
        progress.step(1)
    })
}

struct Adding<'a> {
    model: &'a StructuralModel,
    which: &'a [usize],
    first_id: u32,
    farthest: f32,
    /// Voxels along a trace.
    depth: usize,
}

impl Adding<'_> {
    /// One trace: the surfaces of each block, in the part of the trace that lies in the block.
    fn fill(&self, [x, y]: [usize; 2], distance: &mut [u8], leaf: &mut [u32]) {
        let own = (OWN * STEPS / self.farthest).round() as u8;
        for block in 0..self.model.block_count() as u16 {
            for &h in self.which {
                let id = self.first_id + h as u32;
                let mut add = |n: usize, off: f32| {
                    let code = (off * (STEPS / self.farthest)).round() as u8;
                    let wins = code < distance[n] || leaf[n] < self.first_id && code <= own;
                    if wins && self.model.block_at(Vec3::new(x as f32, y as f32, n as f32)) == block {
                        (distance[n], leaf[n]) = (code, id);
                    }
                };
                match self.model.level(h, block) {
                    Some(level) => {
                        for n in 0..self.depth {
                            let off = self.off(level, Vec3::new(x as f32, y as f32, n as f32), block);
                            off.into_iter().for_each(|off| add(n, off));
                        }
                    }
                    None => self.offs_of_sheet(h, block, Vec2::new(x as f32, y as f32), add),
                }
            }
        }
    }

    /// The distances from the sheet of a horizon along a trace, up to the farthest, where no body has replaced it.
    fn offs_of_sheet(&self, h: usize, block: u16, at: Vec2, mut found: impl FnMut(usize, f32)) {
        let slope = self.model.sheet(h, block).sample(at.x, at.y).gradient.length();
        let z = self.model.horizon_z(h, block, at.x, at.y);
        let share = 1.0 / (1.0 + slope * slope).sqrt();
        let reach = self.farthest / share;
        let last = (z + reach).floor().min(self.depth as f32 - 1.0);
        if last < 0.0 || self.model.body_at(at.extend(z), block).is_some() {
            return;
        }
        let first = (z - reach).ceil().max(0.0) as usize;
        (first..=last as usize).for_each(|n| found(n, (n as f32 - z).abs() * share));
    }

    /// The distance of a place from a surface of any shape where that bounds a layer, voxels; `None` beyond the farthest.
    fn off(&self, level: &LevelSurface, p: Vec3, block: u16) -> Option<f32> {
        let (offset, slope) = level.sample_m(p);
        let steepness = slope.length();
        let off = offset.abs() / steepness;
        // Also where the field is flat, far from its surface.
        if off.is_nan() || off > self.farthest {
            return None;
        }
        let across = slope / steepness;
        let foot = p - across * (offset / steepness);
        let beside = |by: f32| self.model.layer_at(foot + across * by, block);
        (beside(-BESIDE) != beside(BESIDE)).then_some(off)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use model::ModelSettings;
    use survey::horizon::Horizon;
    use survey::stratigraphy::{Contact, StratigraphicHorizon};
    use survey::{SurveyGeometry, VerticalUnit};
    use synth::closed_form::ClosedForm;
    use synth::shapes::Diapir;

    #[test]
    fn distances_to_a_dipping_plane_are_across_it() {
        let geometry = SurveyGeometry::regular([30, 20, 60], 10.0, 10.0, VerticalUnit::Metres);
        let closed = ClosedForm::dipping(&geometry, &[30.0], 30.0, 90.0);
        let quiet = Progress::silent();
        let settings = ModelSettings::default();
        let (stratigraphy, horizons) = (&closed.stratigraphy, &closed.horizons);
        let model =
            StructuralModel::build(&geometry, stratigraphy, horizons, &closed.faults, &settings, &quiet).unwrap();
        let mut made = nothing_near([30, 20, 60]);
        add_horizons(&model, &[0], 1, FARTHEST, &mut made, &quiet).unwrap();
        let share = 30f32.to_radians().cos();
        for (x, y) in [(15, 10), (20, 4)] {
            let z = model.horizon_z(0, 0, x as f32, y as f32);
            for n in 0..60usize {
                let expected = (n as f32 - z).abs() * share;
                let at = (x * 20 + y) * 60 + n;
                if expected < 9.9 {
                    let found = f32::from(made.distance[at]) * FARTHEST / STEPS;
                    assert!((found - expected).abs() < 0.05 && made.leaf[at] == 1, "{found} {expected}");
                } else if expected > 10.1 {
                    assert_eq!((made.distance[at], made.leaf[at]), (255, 0));
                }
            }
        }
    }

    /// Above and below a ball the distance is that to its surface, also on the side where it overhangs.
    #[test]
    fn distances_to_a_body_are_those_to_its_surface_all_around() {
        let geometry = SurveyGeometry::regular([30, 30, 30], 10.0, 10.0, VerticalUnit::Metres);
        let mut closed = ClosedForm::flat(&geometry, &[26.0]);
        let body = Diapir {
            axis: DVec2::splat(150.0),
            bulb_z: 140.0,
            bulb_radius: 70.0,
            bulb_height: 70.0,
            stem_radius: 0.0,
            base_z: 400.0,
        };
        closed.horizons.push(Horizon::of_surface("salt", body.mesh(&geometry, 60)));
        closed.stratigraphy.horizons.push(StratigraphicHorizon { name: "salt".into(), contact: Contact::Intrusive });
        let quiet = Progress::silent();
        let (stratigraphy, settings) = (&closed.stratigraphy, ModelSettings::default());
        let model = StructuralModel::build(&geometry, stratigraphy, &closed.horizons, &[], &settings, &quiet).unwrap();
        let mut made = nothing_near([30; 3]);
        add_horizons(&model, &[1], 1, FARTHEST, &mut made, &quiet).unwrap();
        let mut near = 0;
        for n in 0..30 * 30 * 26 {
            let p = [n / (30 * 26), n / 26 % 30, n % 26].map(|v| v as f32);
            let truth = ((Vec3::from_array(p) - Vec3::new(15.0, 15.0, 14.0)).length() - 7.0).abs();
            let at = (p[0] as usize * 30 + p[1] as usize) * 30 + p[2] as usize;
            if truth < 3.0 {
                let found = f32::from(made.distance[at]) * FARTHEST / STEPS;
                assert!((found - truth).abs() < 0.4 && made.leaf[at] == 2, "{p:?}: {found} {truth}");
                near += 1;
            }
        }
        assert!(near > 2000, "{near}");
    }

    #[test]
    fn beside_candidates_a_horizon_wins_nearby_and_where_it_is_nearer() {
        let geometry = SurveyGeometry::regular([4, 4, 60], 10.0, 10.0, VerticalUnit::Metres);
        let closed = ClosedForm::dipping(&geometry, &[30.0], 0.0, 0.0);
        let quiet = Progress::silent();
        let (stratigraphy, horizons) = (&closed.stratigraphy, &closed.horizons);
        let model = StructuralModel::build(&geometry, stratigraphy, horizons, &[], &ModelSettings::default(), &quiet);
        let model = model.unwrap();
        let z = model.horizon_z(0, 0, 0.0, 0.0).round();
        // A candidate of leaf 5 one sample below the horizon.
        let mut made = nothing_near([4, 4, 60]);
        for n in 0..60usize {
            let code = ((n as f32 - z - 1.0).abs() * STEPS / FARTHEST).round();
            if code <= STEPS {
                (made.distance[n], made.leaf[n]) = (code as u8, 5);
            }
        }
        add_horizons(&model, &[0], 9, FARTHEST, &mut made, &quiet).unwrap();
        let leaf = |off: i32| made.leaf[(z as i32 + off) as usize];
        assert_eq!([-9, -2, 0, 1, 2].map(leaf), [9; 5]);
        assert_eq!([3, 6, 10].map(leaf), [5; 3]);
    }
}
