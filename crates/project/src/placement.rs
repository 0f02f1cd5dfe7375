//! The place of a volume with its own lattice in the project's voxel space.
//!
//! A volume of another size and extent can be shown if its lines run along the project's, in the same direction, and if
//! it covers part of the same rock in the same vertical unit (P-illus 5.1: volumes of different size and extent). Then
//! its first and last samples are the corners of a box in voxel space.

use glam::{DVec2, DVec3};
use render::VoxelBox;
use survey::{SurveyGeometry, TriangleMesh, VerticalUnit};

/// Why a volume cannot be shown in a project.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlacementError {
    /// One is in time, the other in depth.
    #[error("its vertical axis is in {found}, the project's in {expected}")]
    VerticalUnit {
        /// The project's unit.
        expected: &'static str,
        /// The volume's unit.
        found: &'static str,
    },
    /// The lines run in another direction than the project's.
    #[error(
        "its {lines} run at {found_deg:.1} degrees from east, the project's at {expected_deg:.1}; the two \
         surveys are turned against one another"
    )]
    Turned {
        /// "inlines" or "crosslines".
        lines: &'static str,
        /// The project's direction, degrees anticlockwise from east.
        expected_deg: f64,
        /// The volume's direction.
        found_deg: f64,
    },
    /// There is no common rock.
    #[error(
        "it covers {axis} {found_from:.0} to {found_to:.0}, the project {expected_from:.0} to {expected_to:.0}: they have no rock in common"
    )]
    Elsewhere {
        /// What is compared, with its unit.
        axis: &'static str,
        /// Where the project begins.
        expected_from: f64,
        /// Where it ends.
        expected_to: f64,
        /// Where the volume begins.
        found_from: f64,
        /// Where it ends.
        found_to: f64,
    },
}

/// Largest difference of direction, as a shift at the far end of a line: a quarter of a bin would be visible.
const MAX_SHIFT_BINS: f64 = 0.25;

/// The voxel positions of the first and the last sample of a volume on the lattice `other`, in the project's
/// `frame`.
///
/// # Errors
/// [`PlacementError`] if its lines do not run along the project's or it lies elsewhere.
pub(crate) fn covers(frame: &SurveyGeometry, other: &SurveyGeometry) -> Result<VoxelBox, PlacementError> {
    if frame.vertical.unit != other.vertical.unit {
        let word = |unit| match unit {
            VerticalUnit::Milliseconds => "ms of two-way time",
            VerticalUnit::Metres => "m of depth",
        };
        return Err(PlacementError::VerticalUnit {
            expected: word(frame.vertical.unit),
            found: word(other.vertical.unit),
        });
    }
    let last = DVec3::from_array(other.size().map(|count| count.saturating_sub(1) as f64));
    let low = frame.voxel_from_world(other.world_from_voxel(DVec3::ZERO));
    let high = frame.voxel_from_world(other.world_from_voxel(last));
    let lines = [
        ("inlines", DVec3::X, frame.inline_vector, other.inline_vector),
        ("crosslines", DVec3::Y, frame.crossline_vector, other.crossline_vector),
    ];
    for (lines, axis, expected, found) in lines {
        let end = frame.voxel_from_world(other.world_from_voxel(axis * last)) - low;
        let along = end.dot(axis);
        let sideways = (end - axis * along).length();
        let one_line = last.dot(axis) == 0.0;
        if !one_line && (along < 0.0 || sideways > MAX_SHIFT_BINS) {
            return Err(PlacementError::Turned { lines, expected_deg: degrees(expected), found_deg: degrees(found) });
        }
    }
    let block = VoxelBox { min: low.to_array(), max: high.to_array() };
    check_overlap(frame, &block)?;
    Ok(block)
}

fn check_overlap(frame: &SurveyGeometry, block: &VoxelBox) -> Result<(), PlacementError> {
    let whole = VoxelBox::of_size(frame.size());
    let number: [Box<dyn Fn(f64) -> f64>; 3] = [
        Box::new(|index| frame.inlines.number_at(index)),
        Box::new(|index| frame.crosslines.number_at(index)),
        Box::new(|index| frame.vertical.value_at(index)),
    ];
    let vertical = match frame.vertical.unit {
        VerticalUnit::Milliseconds => "times (ms)",
        VerticalUnit::Metres => "depths (m)",
    };
    for (axis, name) in ["the project's inlines", "the project's crosslines", vertical].into_iter().enumerate() {
        if block.max[axis] < whole.min[axis] || block.min[axis] > whole.max[axis] {
            return Err(PlacementError::Elsewhere {
                axis: name,
                expected_from: number[axis](whole.min[axis]),
                expected_to: number[axis](whole.max[axis]),
                found_from: number[axis](block.min[axis]),
                found_to: number[axis](block.max[axis]),
            });
        }
    }
    Ok(())
}

/// Direction of a step between lines, degrees anticlockwise from east.
fn degrees(step: DVec2) -> f64 {
    step.y.atan2(step.x).to_degrees()
}

/// Whether a fault may reach the survey or a trace beside it: whether the box around one of its triangles does. Also where
/// there are no triangles at all.
pub(crate) fn reaches(frame: &SurveyGeometry, mesh: &TriangleMesh) -> bool {
    let last = DVec2::new(frame.size()[0] as f64, frame.size()[1] as f64);
    let voxels: Vec<DVec2> = mesh.vertices.iter().map(|vertex| frame.voxel_from_world(*vertex).truncate()).collect();
    let reaches = |triangle: &[u32; 3]| {
        let corners = triangle.map(|v| voxels[v as usize]);
        let (low, high) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
        high.cmpge(DVec2::NEG_ONE).all() && low.cmple(last).all()
    };
    mesh.triangles.is_empty() || mesh.triangles.iter().any(reaches)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> SurveyGeometry {
        let mut frame = SurveyGeometry::regular([41, 31, 21], 25.0, 4.0, VerticalUnit::Milliseconds);
        frame.origin = DVec2::new(1000.0, 500.0);
        frame.inline_vector = DVec2::new(15.0, 20.0);
        frame.crossline_vector = DVec2::new(-20.0, 15.0);
        frame
    }

    /// Every second line of a part of the frame, twice as many samples.
    fn part() -> SurveyGeometry {
        let mut part = frame();
        part.origin = frame().world_from_voxel(DVec3::new(4.0, 6.0, 0.0)).truncate();
        part.inline_vector *= 2.0;
        part.crossline_vector *= 2.0;
        (part.inlines.count, part.crosslines.count) = (11, 6);
        part.vertical.first = 8.0;
        part.vertical.interval = 2.0;
        part
    }

    #[test]
    fn a_part_at_another_density_lands_where_it_is() {
        let block = covers(&frame(), &part()).unwrap();
        for axis in 0..3 {
            assert!((block.min[axis] - [4.0, 6.0, 2.0][axis]).abs() < 1e-9, "{block:?}");
            assert!((block.max[axis] - [24.0, 16.0, 12.0][axis]).abs() < 1e-9, "{block:?}");
        }
        assert_eq!(covers(&frame(), &frame()).unwrap(), VoxelBox::of_size([41, 31, 21]));
    }

    #[test]
    fn what_cannot_be_shown_is_told_apart() {
        let refused = |change: fn(&mut SurveyGeometry)| {
            let mut other = part();
            change(&mut other);
            covers(&frame(), &other).unwrap_err()
        };
        assert!(matches!(refused(|g| g.vertical.unit = VerticalUnit::Metres), PlacementError::VerticalUnit { .. }));
        assert!(matches!(refused(|g| g.inline_vector = -g.inline_vector), PlacementError::Turned { .. }));
        assert!(matches!(refused(|g| g.inline_vector = DVec2::new(50.0, 0.0)), PlacementError::Turned { .. }));
        assert!(matches!(refused(|g| g.origin += DVec2::new(1e5, 0.0)), PlacementError::Elsewhere { .. }));
        assert!(matches!(refused(|g| g.vertical.first = 9000.0), PlacementError::Elsewhere { .. }));
    }
}
