//! Smoothing by local planes: a node comes to lie where the plane through the nodes around it is, so that a dipping
//! plane stays what it is, at its edges too.

use crate::reassembly::VoxelSheet;
use glam::{DMat3, DVec3, Vec3};
use model::FaultNetwork;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use survey::{Cancelled, Progress};

/// Settings of smoothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct SmoothSettings {
    /// Traces from a node to the farthest ones that count. More takes out longer waves, and crests with them.
    pub radius: u32,
    /// How often the sheet is smoothed; twice is smoother than once at the same radius.
    pub passes: u32,
}

impl Default for SmoothSettings {
    fn default() -> Self {
        Self { radius: 3, passes: 1 }
    }
}

impl SmoothSettings {
    /// The largest radius and the largest number of passes; more counts as these.
    pub const MOST: Self = Self { radius: 50, passes: 20 };
}

/// Smooths every sheet by itself, and returns the largest change of a node in samples. A node that would leave its fault
/// block stays where it is. `size` is `[inlines, crosslines]`. Cost: radius² for each node and pass.
///
/// # Errors
/// [`Cancelled`].
///
/// ```
/// use interp::reassembly::VoxelSheet;
/// use model::FaultNetwork;
/// use interp::refine::{SmoothSettings, smooth};
/// use survey::Progress;
///
/// // A spike on a plane that dips by half a sample a trace.
/// let mut sheet = VoxelSheet::empty(0, 400);
/// sheet.z.iter_mut().enumerate().for_each(|(n, z)| *z = 0.5 * (n / 20) as f32);
/// sheet.z[210] += 4.0;
/// let mut sheets = [sheet];
/// let most = smooth(&mut sheets, [20, 20], &FaultNetwork::none(), &SmoothSettings::default(), &Progress::silent())?;
/// assert!(most > 3.0 && (sheets[0].z[210] - 5.0).abs() < 1.0);
/// assert!((sheets[0].z[399] - 9.5).abs() < 1e-4, "the plane dips as before up to its edge");
/// # Ok::<(), survey::Cancelled>(())
/// ```
pub fn smooth(
    sheets: &mut [VoxelSheet],
    size: [usize; 2],
    blocks: &FaultNetwork,
    settings: &SmoothSettings,
    progress: &Progress,
) -> Result<f32, Cancelled> {
    let stencil = Stencil::of(settings.radius.min(SmoothSettings::MOST.radius));
    let passes = settings.passes.min(SmoothSettings::MOST.passes);
    progress.begin("smoothing", u64::from(passes) * sheets.len() as u64);
    let mut most = 0.0_f32;
    for sheet in sheets {
        let before = sheet.z.clone();
        for _ in 0..passes {
            progress.step(1)?;
            let rows: Vec<Vec<f32>> = (0..size[0]).into_par_iter().map(|x| stencil.row(&sheet.z, size, x)).collect();
            sheet.z = rows.concat();
        }
        for (n, z) in sheet.z.iter_mut().enumerate().filter(|(_, z)| z.is_finite()) {
            if blocks.holds(sheet.block, Vec3::new((n / size[1]) as f32, (n % size[1]) as f32, *z)) {
                most = most.max((*z - before[n]).abs());
            } else {
                *z = before[n];
            }
        }
    }
    Ok(most)
}

/// The traces around a node with their weights: a bell that has fallen to a seventh at the radius.
struct Stencil {
    around: Vec<([i64; 2], f64)>,
}

impl Stencil {
    fn of(radius: u32) -> Self {
        let reach = i64::from(radius);
        let square = (reach * reach) as f64;
        let offsets = (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| [x, y]));
        let weighed = offsets.filter_map(|[x, y]| {
            let distance = (x * x + y * y) as f64;
            (distance <= square).then(|| ([x, y], if square > 0.0 { (-2.0 * distance / square).exp() } else { 1.0 }))
        });
        Self { around: weighed.collect() }
    }

    /// The smoothed depths of inline `x`.
    fn row(&self, z: &[f32], size: [usize; 2], x: usize) -> Vec<f32> {
        (0..size[1]).map(|y| if z[x * size[1] + y].is_finite() { self.at(z, size, [x, y]) } else { f32::NAN }).collect()
    }

    /// The height at its middle of the plane with the least weighted squares; the node itself where there is no plane.
    fn at(&self, z: &[f32], size: [usize; 2], [x, y]: [usize; 2]) -> f32 {
        let here = z[x * size[1] + y];
        let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
        for ([dx, dy], weight) in &self.around {
            let (Some(at_x), Some(at_y)) = (x.checked_add_signed(*dx as isize), y.checked_add_signed(*dy as isize))
            else {
                continue;
            };
            if at_x >= size[0] || at_y >= size[1] {
                continue;
            }
            let other = z[at_x * size[1] + at_y];
            if other.is_finite() {
                let row = DVec3::new(1.0, *dx as f64, *dy as f64);
                normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z) * *weight;
                right += row * (*weight * f64::from(other - here));
            }
        }
        // Nodes on one line span no plane.
        if normal.determinant().abs() < 1e-6 { here } else { here + (normal.inverse() * right).x as f32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::{SurveyGeometry, VerticalUnit};

    const SIZE: [usize; 2] = [40, 30];

    fn sheet(block: u16, height: impl Fn(usize, usize) -> f32) -> VoxelSheet {
        let mut sheet = VoxelSheet::empty(block, SIZE[0] * SIZE[1]);
        for (n, z) in sheet.z.iter_mut().enumerate() {
            *z = height(n / SIZE[1], n % SIZE[1]);
        }
        sheet
    }

    fn roughness(sheet: &VoxelSheet) -> f32 {
        sheet.z.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| step.is_finite()).sum()
    }

    #[test]
    fn more_radius_and_more_passes_are_smoother_and_holes_stay() {
        let mut rough = sheet(0, |x, y| 20.0 + ((x * 7 + y * 13) % 5) as f32);
        rough.z[333] = f32::NAN;
        let smoothed = |radius, passes| {
            let mut sheets = [rough.clone()];
            let settings = SmoothSettings { radius, passes };
            smooth(&mut sheets, SIZE, &FaultNetwork::none(), &settings, &Progress::silent()).unwrap();
            assert!(sheets[0].z[333].is_nan());
            roughness(&sheets[0])
        };
        assert!(smoothed(2, 1) < 0.7 * roughness(&rough));
        assert!(smoothed(4, 1) < smoothed(2, 1));
        assert!(smoothed(2, 3) < smoothed(2, 1));
        assert_eq!(smoothed(0, 1), roughness(&rough));
    }

    #[test]
    fn a_throw_at_a_fault_stays_sharp() {
        // A vertical fault between inlines 19 and 20 throws the horizon by six samples.
        let geometry = SurveyGeometry::regular([40, 30, 60], 25.0, 4.0, VerticalUnit::Milliseconds);
        let corner = |y: f64, z: f64| geometry.world_from_voxel(DVec3::new(19.5, y, z));
        let vertices = vec![corner(-1.0, -1.0), corner(31.0, -1.0), corner(31.0, 61.0), corner(-1.0, 61.0)];
        let mesh = survey::TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] };
        let fault = survey::Fault::new("F", mesh);
        let blocks = FaultNetwork::build(&geometry, &[fault], &Progress::silent()).unwrap();
        let height = |x: usize| if x < 20 { 20.0 } else { 26.0 };
        let side = |x: f32| blocks.block_at(Vec3::new(x, 15.0, 23.0));
        let mut sheets = [(side(5.0), 0..20), (side(35.0), 20..40)].map(|(block, inlines)| {
            sheet(block, |x, y| if inlines.contains(&x) { height(x) + ((x + y) % 2) as f32 } else { f32::NAN })
        });
        let settings = SmoothSettings { radius: 4, passes: 3 };
        smooth(&mut sheets, SIZE, &blocks, &settings, &Progress::silent()).unwrap();
        for (n, z) in sheets.iter().flat_map(|sheet| sheet.z.iter().enumerate()).filter(|(_, z)| z.is_finite()) {
            let wanted = height(n / SIZE[1]) + 0.5;
            assert!((z - wanted).abs() < 0.3, "inline {}: {z}, expected {wanted}", n / SIZE[1]);
        }
    }
}
