//! The data that a scene is drawn from, borrowed from the project. Voxel space.

use crate::error::RenderError;
use crate::leaves::{BORDER, BORDER_REACH, BORDER_STEP};
use crate::wells::DrawnWell;
use glam::Vec3;
use model::StructuralModel;
use param::{PackedVolume, Parameterization};
use survey::block::VoxelBox;
use survey::{SparseVolume, SurveyGeometry, Volume};
use ttf::TtfTables;

/// The data of a picture. What is `None` is not drawn: without a model, for instance, faces show raw data
/// only.
#[derive(Clone, Copy)]
pub struct Inputs<'a> {
    /// Where the samples lie.
    pub geometry: &'a SurveyGeometry,
    /// The structural model of the interpretation.
    pub model: Option<&'a StructuralModel>,
    /// The parameterization (i, j, k) of that model, for the exact lookup.
    pub param: Option<&'a Parameterization>,
    /// The paper's packed volume, for the packed lookup.
    pub packed: Option<&'a PackedVolume>,
    /// Layer styles, scalar functions and raw colours, compiled for this block. The bottom layer is first, as
    /// in the model.
    pub tables: Option<&'a TtfTables>,
    /// Scalar volumes, the raw data among them.
    pub volumes: &'a [NamedVolume<'a>],
    /// Horizon candidates: distances and leaves.
    pub candidates: Option<CandidateVolume<'a>>,
    /// Wells.
    pub wells: &'a [DrawnWell<'a>],
    /// A hash of all but the styles (`tables`): of what a ray can hit. What was uploaded and what is kept of model and
    /// volumes is used again while it stays the same, whatever styles change; 0: never.
    pub data_key: u64,
}

/// A scalar volume and the part of the survey that it covers. Its size and extent may differ from the
/// survey's (P-illus 5.1).
///
/// ```
/// use glam::Vec3;
/// use render::NamedVolume;
/// let mut volume = survey::Volume::filled([2, 2, 2], 0.0f32);
/// // Inline 1 has the value 8.
/// (0..2).for_each(|y| volume.trace_mut(1, y).fill(8.0));
/// let named = NamedVolume::whole("seismic", &volume);
/// assert_eq!(named.sample(Vec3::new(0.25, 0.5, 0.5)), 2.0);
/// assert!(named.sample(Vec3::new(1.5, 0.0, 0.0)).is_nan());
/// ```
#[derive(Clone, Copy)]
pub struct NamedVolume<'a> {
    /// Unique name by which scenes and transfer functions refer to it.
    pub name: &'a str,
    /// The samples.
    pub volume: Samples<'a>,
    /// Voxel positions of the first and the last sample along each axis.
    pub covers: VoxelBox,
}

/// The samples of a volume: all of them, or those that a picture of faces needs.
#[derive(Debug, Clone, Copy)]
pub enum Samples<'a> {
    /// All.
    Whole(&'a Volume<f32>),
    /// Some. Faces, the ground and sections are drawn from them; volume rendering and the GPU need all.
    Sparse(&'a SparseVolume),
}

impl<'a> Samples<'a> {
    /// `[inlines, crosslines, samples]`.
    pub fn size(self) -> [usize; 3] {
        match self {
            Self::Whole(volume) => volume.size(),
            Self::Sparse(volume) => volume.size(),
        }
    }

    /// Whether the trace at (x, y) was recorded.
    pub fn is_live(self, x: usize, y: usize) -> bool {
        match self {
            Self::Whole(volume) => volume.is_live(x, y),
            Self::Sparse(volume) => volume.is_live(x, y),
        }
    }

    /// The sample at (x, y, z).
    pub fn at(self, x: usize, y: usize, z: usize) -> f32 {
        match self {
            Self::Whole(volume) => volume.at(x, y, z),
            Self::Sparse(volume) => volume.at(x, y, z),
        }
    }

    /// The volume, if all of it is there.
    pub fn whole(self) -> Option<&'a Volume<f32>> {
        match self {
            Self::Whole(volume) => Some(volume),
            Self::Sparse(_) => None,
        }
    }

    /// All samples in memory order; none of a sparse volume, of which no medium is made.
    pub(crate) fn all(self) -> &'a [f32] {
        self.whole().map_or(&[], Volume::samples)
    }
}

/// The distance volume of the horizon candidates (P-horiz 4.4, 5.2): for every sample of the survey, the
/// distance to the nearest candidate surface and the leaf of its surface tree there.
///
/// ```
/// use glam::Vec3;
/// // A trace of three samples with the leaf 7 on the middle one; a step is half a voxel.
/// let candidates = render::CandidateVolume {
///     size: [1, 1, 3],
///     distance: &[2, 0, 2],
///     leaf: &[7; 3],
///     voxels_per_step: 0.5,
///     groups: None,
/// };
/// candidates.validate().unwrap();
/// assert_eq!(candidates.leaf_at(Vec3::new(0.0, 0.0, 1.2)), 7);
/// assert_eq!(candidates.distance_at(Vec3::new(0.0, 0.0, 0.5)), 0.5);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct CandidateVolume<'a> {
    /// `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// Distance in steps; 255 stands for all larger distances.
    pub distance: &'a [u8],
    /// Leaf id; 0 stands for no leaf.
    pub leaf: &'a [u32],
    /// Length of a step of `distance`, voxels.
    pub voxels_per_step: f32,
    /// The group by leaf id, which determines a leaf's colour: for instance its ancestor at some level of the
    /// surface tree. 0: the leaf is not shown. Absent: each leaf is a group of its own.
    pub groups: Option<&'a [u32]>,
}

impl CandidateVolume<'_> {
    /// Checks that there is one distance and one leaf per sample.
    ///
    /// # Errors
    /// [`RenderError::CandidateSize`].
    pub fn validate(&self) -> Result<(), RenderError> {
        let expected = self.size.iter().product();
        let found = [self.distance.len(), self.leaf.len()];
        if found == [expected; 2] && expected > 0 {
            Ok(())
        } else {
            Err(RenderError::CandidateSize { size: self.size, expected, found })
        }
    }

    /// Leaf at the nearest sample.
    pub fn leaf_at(&self, p: Vec3) -> u32 {
        self.leaf[self.index_of(self.sample_at(p))]
    }

    fn sample_at(&self, p: Vec3) -> [usize; 3] {
        [0, 1, 2].map(|axis| ((p[axis] + 0.5).max(0.0) as usize).min(self.size[axis] - 1))
    }

    fn index_of(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * self.size[1] + y) * self.size[2] + z
    }

    /// The group of a leaf; 0 if it is not shown.
    pub fn group(&self, leaf: u32) -> u32 {
        self.groups.map_or(leaf, |groups| groups.get(leaf as usize).copied().unwrap_or(0))
    }

    /// Whether a point lies at the border of two groups: on a neighbouring trace, its surface continues as a
    /// surface of another group.
    ///
    /// Surfaces may lie only a few samples apart, so it is not enough that a neighbouring sample belongs to
    /// another group. First the sample of the point's own surface is located on its trace. On the
    /// neighbouring traces that surface is searched for at about the same depth; only if it does not continue
    /// there, a surface of another group counts.
    pub(crate) fn is_border(&self, p: Vec3) -> bool {
        let place = self.sample_at(p);
        let own = self.group(self.leaf[self.index_of(place)]);
        let reach = (1.5 * self.distance_at(p)) as usize + 1;
        let own_z = self.surface_sample(place, reach, Some(own)).map_or(place[2], |(z, _)| z);
        let aside = |shift: Vec3| {
            let [x, y, _] = self.sample_at(p + shift);
            let goes_on = self.surface_sample([x, y, own_z], 2 * BORDER_STEP, Some(own));
            goes_on.or_else(|| self.surface_sample([x, y, own_z], BORDER_STEP, None)).map_or(0, |(_, group)| group)
        };
        let differ = |a: u32, b: u32| a != b && a != 0 && b != 0;
        differ(aside(Vec3::X * BORDER), aside(Vec3::X * -BORDER))
            || differ(aside(Vec3::Y * BORDER), aside(Vec3::Y * -BORDER))
    }

    /// The sample of a trace that is nearest to its surface, and the group of that surface. Considers samples
    /// at most `reach` above and below z, and one group if `only` names it. `None` if all samples are too far
    /// from their surfaces.
    fn surface_sample(&self, [x, y, z]: [usize; 3], reach: usize, only: Option<u32>) -> Option<(usize, u32)> {
        let mut nearest = BORDER_REACH;
        let mut found = None;
        for z in z.saturating_sub(reach)..=(z + reach).min(self.size[2] - 1) {
            let at = self.index_of([x, y, z]);
            let distance = f32::from(self.distance[at]) * self.voxels_per_step;
            let group = self.group(self.leaf[at]);
            if distance < nearest && only.is_none_or(|only| only == group) {
                nearest = distance;
                found = Some((z, group));
            }
        }
        found
    }

    /// Distance to the nearest candidate, interpolated trilinearly, voxels.
    pub fn distance_at(&self, p: Vec3) -> f32 {
        let last = Vec3::from_array(self.size.map(|n| (n - 1) as f32));
        let clamped = p.clamp(Vec3::ZERO, last);
        let low = clamped.floor().min((last - 1.0).max(Vec3::ZERO));
        let f = clamped - low;
        let at = |x: usize, y: usize, z: usize| {
            let x = (low.x as usize + x).min(self.size[0] - 1);
            let y = (low.y as usize + y).min(self.size[1] - 1);
            let z = (low.z as usize + z).min(self.size[2] - 1);
            f32::from(self.distance[(x * self.size[1] + y) * self.size[2] + z])
        };
        let along_z = |x: usize, y: usize| at(x, y, 0) + (at(x, y, 1) - at(x, y, 0)) * f.z;
        let along_y = |x: usize| along_z(x, 0) + (along_z(x, 1) - along_z(x, 0)) * f.y;
        (along_y(0) + (along_y(1) - along_y(0)) * f.x) * self.voxels_per_step
    }
}

/// Samples with an interpolation weight below this are not read.
pub(crate) const NO_WEIGHT: f32 = 1e-5;
/// How far outside its extent a volume still has values, in its own samples: only rounding.
pub const SLACK: f32 = 1e-3;

impl<'a> Inputs<'a> {
    /// Raw data without an interpretation.
    pub fn raw(geometry: &'a SurveyGeometry, volumes: &'a [NamedVolume<'a>]) -> Self {
        Self {
            geometry,
            model: None,
            param: None,
            packed: None,
            tables: None,
            volumes,
            candidates: None,
            wells: &[],
            data_key: 0,
        }
    }
}

impl<'a> NamedVolume<'a> {
    /// The volume of this name.
    pub(crate) fn find(volumes: &[Self], name: &str) -> Result<Self, RenderError> {
        volumes.iter().find(|v| v.name == name).copied().ok_or_else(|| RenderError::UnknownVolume {
            name: name.to_owned(),
            present: volumes.iter().map(|v| v.name.to_owned()).collect(),
        })
    }

    /// A volume on the lattice of the survey.
    pub fn whole(name: &'a str, volume: &'a Volume<f32>) -> Self {
        Self { name, volume: Samples::Whole(volume), covers: VoxelBox::of_size(volume.size()) }
    }

    /// Scale and offset from voxel positions to the volume's own sample indices: `index = p · scale +
    /// offset`.
    pub(crate) fn index_from_voxel(&self) -> (Vec3, Vec3) {
        let last = Vec3::from_array(self.volume.size().map(|n| n.saturating_sub(1) as f32));
        let scale = last / self.covers.extent().as_vec3().max(Vec3::splat(1e-6));
        (scale, -self.covers.low().as_vec3() * scale)
    }

    /// Value at a voxel position, interpolated trilinearly. NaN outside the extent, and where a needed sample
    /// is dead or not finite.
    pub fn sample(&self, p: Vec3) -> f32 {
        let (scale, offset) = self.index_from_voxel();
        let index = p * scale + offset;
        let size = self.volume.size();
        let mut low = [0usize; 3];
        let mut fraction = [0.0f32; 3];
        for axis in 0..3 {
            let last = size[axis].saturating_sub(1) as f32;
            if !(index[axis] >= -SLACK && index[axis] <= last + SLACK) {
                return f32::NAN;
            }
            let clamped = index[axis].clamp(0.0, last);
            let floor = clamped.floor().min((last - 1.0).max(0.0));
            low[axis] = floor as usize;
            fraction[axis] = clamped - floor;
        }
        let mut sum = 0.0;
        for corner in 0..8usize {
            let mut weight = 1.0;
            let mut at = low;
            for axis in 0..3 {
                if corner >> axis & 1 == 1 {
                    weight *= fraction[axis];
                    at[axis] = (at[axis] + 1).min(size[axis] - 1);
                } else {
                    weight *= 1.0 - fraction[axis];
                }
            }
            if weight < NO_WEIGHT {
                continue;
            }
            if !self.volume.is_live(at[0], at[1]) {
                return f32::NAN;
            }
            let value = self.volume.at(at[0], at[1], at[2]);
            if !value.is_finite() {
                return f32::NAN;
            }
            sum += weight * value;
        }
        sum
    }
}

#[cfg(test)]
mod tests;
