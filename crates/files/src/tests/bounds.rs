//! A survey around the points of an interpretation that comes without one.

use super::super::raw::RawShape;
use super::super::vertical::VerticalRule;
use super::*;
use glam::{DVec2, DVec3};
use survey::geometry::{DEFAULT_VELOCITY_M_S, LineAxis, VerticalAxis, VerticalUnit};

/// A file of an interpretation, and how it is to be read.
pub(super) struct InterpretationFile {
    pub path: PathBuf,
    pub kind: SurfaceKind,
    pub options: ImportOptions,
}

/// An unrotated survey of `size` around the files, with a margin of 15 % above and below their points: inlines count along
/// X and crosslines along Y, both from 1.
pub(super) fn survey_from_points(
    files: &[InterpretationFile],
    unit: VerticalUnit,
    size: [usize; 3],
) -> Result<SurveyGeometry, FormatError> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut add = |p: DVec3| {
        if p.is_finite() {
            low = low.min(p);
            high = high.max(p);
        }
    };
    for file in files {
        let source = SourceFile::open(&file.path)?;
        for mut raw in read_source(&source, None, &file.options, file.kind)?.1 {
            VerticalRule::settle(&file.path, &raw.vertical, &file.options, unit)?.apply(&mut raw.shape);
            match &raw.shape {
                RawShape::Mesh(mesh) => mesh.vertices.iter().for_each(|v| add(*v)),
                RawShape::Grid { grid, z } => {
                    let nv = grid.count[1];
                    let node = |n: usize| grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
                    z.iter().enumerate().for_each(|(n, z)| add(node(n).extend(*z)));
                }
                RawShape::Points(points) => points.iter().filter_map(|p| Some(p.xy?.extend(p.z))).for_each(&mut add),
            }
        }
    }
    let margin = DVec3::Z * (0.15 * (high.z - low.z));
    (low, high) = (low - margin, high + margin);
    let bin = (high - low) / DVec3::from_array(size.map(|n| (n - 1) as f64));
    Ok(SurveyGeometry {
        inlines: LineAxis { first: 1, step: 1, count: size[0] },
        crosslines: LineAxis { first: 1, step: 1, count: size[1] },
        vertical: VerticalAxis { first: low.z, interval: bin.z, count: size[2], unit },
        origin: low.truncate(),
        inline_vector: DVec2::new(bin.x, 0.0),
        crossline_vector: DVec2::new(0.0, bin.y),
        velocity_m_s: DEFAULT_VELOCITY_M_S,
    })
}
