//! Distances to the horizons of an interpretation, in the form of an extraction's: so that imported horizons, too, are seen in volumes and on
//! faces (P-horiz 5.2).
//!
//! The distance of a voxel to a sheet z = h(x, y) is |z − h|/√(1 + |∇h|²), exact for a plane; it is told up to ten voxels. The id of the n-th
//! horizon, youngest first, is n + 1. Voxel space.

use glam::Vec3;
use rayon::prelude::*;
use render::Candidates;
use survey::model::StructuralModel;
use survey::{Cancelled, Progress};

/// Greatest distance told, voxels.
const FARTHEST: f32 = 10.0;
/// Its code; one more stands for "farther".
const STEPS: f32 = 254.0;

/// Distance to and number of the nearest horizon, `[inline][crossline][sample]`.
pub struct HorizonDistances {
    size: [usize; 3],
    distance: Vec<u8>,
    horizon: Vec<u32>,
}

impl HorizonDistances {
    /// Of all horizons of a model: five bytes a voxel.
    ///
    /// # Errors
    /// Cancelled.
    pub fn new(model: &StructuralModel, progress: &Progress) -> Result<Self, Cancelled> {
        let size = model.size();
        let [nx, ny, nz] = size;
        let mut distance = vec![u8::MAX; nx * ny * nz];
        let mut horizon = vec![0u32; nx * ny * nz];
        progress.begin("distances to horizons", nx as u64);
        let planes = distance.par_chunks_mut((ny * nz).max(1)).zip(horizon.par_chunks_mut((ny * nz).max(1)));
        planes.enumerate().try_for_each(|(x, (distance, horizon))| {
            for y in 0..ny {
                let trace = y * nz..(y + 1) * nz;
                fill(model, [x, y], &mut distance[trace.clone()], &mut horizon[trace]);
            }
            progress.step(1)
        })?;
        Ok(Self { size, distance, horizon })
    }

    /// As renderers take them.
    pub fn candidates(&self) -> Candidates<'_> {
        Candidates {
            size: self.size,
            distance: &self.distance,
            leaf: &self.horizon,
            voxels_per_step: FARTHEST / STEPS,
            groups: None,
        }
    }
}

/// One trace: each block's sheets, where that block is.
fn fill(model: &StructuralModel, [x, y]: [usize; 2], distance: &mut [u8], horizon: &mut [u32]) {
    let (fx, fy) = (x as f32, y as f32);
    for block in 0..model.block_count() as u16 {
        for h in 0..model.stratigraphy().horizons.len() {
            let slope = model.sheet(h, block).sample(fx, fy).gradient.length();
            let z = model.horizon_z(h, block, fx, fy);
            let share = 1.0 / (1.0 + slope * slope).sqrt();
            let reach = FARTHEST / share;
            let first = (z - reach).ceil().max(0.0) as usize;
            let last = (z + reach).floor().min(distance.len() as f32 - 1.0);
            if last < 0.0 {
                continue;
            }
            for n in first..=last as usize {
                let code = ((n as f32 - z).abs() * share * (STEPS / FARTHEST)).round() as u8;
                if code < distance[n] && model.block_at(Vec3::new(fx, fy, n as f32)) == block {
                    distance[n] = code;
                    horizon[n] = h as u32 + 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::model::ModelSettings;
    use survey::synth::closed_form::ClosedForm;
    use survey::{SurveyGeometry, VerticalUnit};

    #[test]
    fn distances_to_a_dipping_plane_are_across_it() {
        let geometry = SurveyGeometry::regular([30, 20, 60], 10.0, 10.0, VerticalUnit::Metres);
        let closed = ClosedForm::dipping(&geometry, &[30.0], 30.0, 90.0);
        let quiet = Progress::silent();
        let settings = ModelSettings::default();
        let (stratigraphy, horizons) = (&closed.stratigraphy, &closed.horizons);
        let model =
            StructuralModel::build(&geometry, stratigraphy, horizons, &closed.faults, &settings, &quiet).unwrap();
        let made = HorizonDistances::new(&model, &quiet).unwrap();
        let candidates = made.candidates();
        candidates.validate().unwrap();
        let share = 30f32.to_radians().cos();
        for (x, y) in [(15, 10), (20, 4)] {
            let z = model.horizon_z(0, 0, x as f32, y as f32);
            for n in 0..60usize {
                let expected = (n as f32 - z).abs() * share;
                let at = (x * 20 + y) * 60 + n;
                if expected < 9.9 {
                    let found = f32::from(candidates.distance[at]) * candidates.voxels_per_step;
                    assert!((found - expected).abs() < 0.05 && candidates.leaf[at] == 1, "{found} {expected}");
                } else if expected > 10.1 {
                    assert_eq!((candidates.distance[at], candidates.leaf[at]), (255, 0));
                }
            }
        }
    }
}
