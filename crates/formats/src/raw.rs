//! The result of a format's reader: names and numbers as they are in the file, before any conversion.

use super::SurfaceKind;
use super::options::ImportOptions;
use super::unit::{Domain, ZPositive, ZUnit};
use glam::DVec2;
use survey::geometry::SurveyGeometry;
use survey::horizon::{NodeGrid, Quality};
use survey::mesh::TriangleMesh;
use survey::remedy::Note;

/// What a reader may use besides its file.
pub(super) struct ReadContext<'a> {
    /// The survey, when there is one; only to tell columns apart.
    pub geometry: Option<&'a SurveyGeometry>,
    /// What the user says.
    pub options: &'a ImportOptions,
    /// What is wanted from the file.
    pub kind: SurfaceKind,
}

impl ReadContext<'_> {
    /// Time or depth, as the survey has it.
    pub fn domain(&self) -> Option<Domain> {
        self.geometry.map(|g| Domain::of(g.vertical.unit))
    }
}

/// A point of a table.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct RawPoint {
    /// Inline, crossline.
    pub lines: Option<DVec2>,
    /// World X, Y.
    pub xy: Option<DVec2>,
    /// Vertical value; NaN = none.
    pub z: f64,
    /// Stick it belongs to.
    pub stick: Option<f64>,
    /// Place along its stick.
    pub node: Option<f64>,
    /// Sheet it belongs to.
    pub sheet: Option<f64>,
    /// How it came about, when the file says.
    pub quality: Option<Quality>,
}

/// The geometry of a surface as its format has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum RawShape {
    /// A regular grid with a value per node, `[u][v]`; NaN = hole.
    Grid { grid: NodeGrid, z: Vec<f64> },
    /// Points in file order.
    Points(Vec<RawPoint>),
    /// Triangles in world coordinates.
    Mesh(TriangleMesh),
}

impl RawShape {
    /// The vertical values, to read.
    pub fn values(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Grid { z, .. } => Box::new(z.iter().copied()),
            Self::Points(points) => Box::new(points.iter().map(|p| p.z)),
            Self::Mesh(mesh) => Box::new(mesh.vertices.iter().map(|v| v.z)),
        }
    }

    /// The vertical values, to change.
    pub fn values_mut(&mut self) -> Box<dyn Iterator<Item = &mut f64> + '_> {
        match self {
            Self::Grid { z, .. } => Box::new(z.iter_mut()),
            Self::Points(points) => Box::new(points.iter_mut().map(|p| &mut p.z)),
            Self::Mesh(mesh) => Box::new(mesh.vertices.iter_mut().map(|v| &mut v.z)),
        }
    }
}

/// What the file itself says of its vertical axis, with the words that say it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct VerticalFacts {
    pub unit: Option<(ZUnit, String)>,
    pub domain: Option<(Domain, String)>,
    pub positive: Option<(ZPositive, String)>,
}

/// One surface as read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawSurface {
    /// Its name in the file.
    pub name: Option<String>,
    pub shape: RawShape,
    pub vertical: VerticalFacts,
    pub notes: Vec<String>,
    /// What the user should check.
    pub warnings: Vec<Note>,
}
