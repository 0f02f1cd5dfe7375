//! The result of a format's reader: names and numbers as they are in the file, before any conversion.

use super::SurfaceKind;
use super::options::ImportOptions;
use super::unit::{Domain, ZPositive, ZUnit};
use glam::{DVec2, DVec3};
use survey::geometry::SurveyGeometry;
use survey::horizon::{NodeGrid, Quality};
use survey::mesh::TriangleMesh;
use survey::remedy::Note;

/// What a reader may use besides its file.
pub(super) struct ReadContext<'a> {
    /// The survey, if there is one; it is used only to identify columns.
    pub geometry: Option<&'a SurveyGeometry>,
    /// What the user states.
    pub options: &'a ImportOptions,
    /// The kind of surface to read.
    pub kind: SurfaceKind,
}

impl ReadContext<'_> {
    /// The domain of the survey: time or depth.
    pub(crate) fn domain(&self) -> Option<Domain> {
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
    /// Its stick.
    pub stick: Option<f64>,
    /// Its position along the stick.
    pub node: Option<f64>,
    /// Its sheet.
    pub sheet: Option<f64>,
    /// The normal of the surface there, in the directions of X, Y and Z.
    pub normal: Option<DVec3>,
    /// The origin of its depth, if the file states it.
    pub quality: Option<Quality>,
}

/// The geometry of a surface in the form of its format.
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
    /// The vertical values, for reading.
    pub(crate) fn values(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Grid { z, .. } => Box::new(z.iter().copied()),
            Self::Points(points) => Box::new(points.iter().map(|p| p.z)),
            Self::Mesh(mesh) => Box::new(mesh.vertices.iter().map(|v| v.z)),
        }
    }

    /// The vertical values, for changing.
    pub(crate) fn values_mut(&mut self) -> Box<dyn Iterator<Item = &mut f64> + '_> {
        match self {
            Self::Grid { z, .. } => Box::new(z.iter_mut()),
            Self::Points(points) => Box::new(points.iter_mut().map(|p| &mut p.z)),
            Self::Mesh(mesh) => Box::new(mesh.vertices.iter_mut().map(|v| &mut v.z)),
        }
    }
}

/// What the file states about its vertical axis, with the words in which it does.
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

impl RawSurface {
    /// A surface of which the file says nothing more.
    pub(crate) fn new(name: Option<String>, shape: RawShape) -> Self {
        Self { name, shape, vertical: VerticalFacts::default(), notes: Vec::new(), warnings: Vec::new() }
    }
}
