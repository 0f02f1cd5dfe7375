//! The result of a format's reader: names and numbers as they are in the file, before any conversion.

use super::SurfaceKind;
use super::options::ImportOptions;
use super::unit::words::{HeaderUnits, Quantity, Statement};
use super::unit::{Domain, ZPositive, ZUnit};
use glam::{DVec2, DVec3};
use survey::geometry::SurveyGeometry;
use survey::horizon::{NodeGrid, Quality};
use survey::mesh::TriangleMesh;
use survey::remedy::{Note, Setting};

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

    /// Whether the user names that surface.
    pub(crate) fn asks_for(&self, name: &str) -> bool {
        [&self.options.select, &self.options.name].into_iter().flatten().any(|wanted| wanted == name)
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
    /// Dip from the horizontal, its direction clockwise from north, degrees, and 1, or -1 where beds are overturned.
    pub dip: Option<[f64; 3]>,
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
    /// The unit of X and Y that the file states, with its words.
    pub horizontal: Option<(ZUnit, String)>,
    /// Orientations of it from a file of their own.
    pub orientations: Option<Box<RawSurface>>,
    pub notes: Vec<String>,
    /// What the user should check.
    pub warnings: Vec<Note>,
}

impl RawSurface {
    /// A surface of which the file says nothing more.
    pub(crate) fn new(name: Option<String>, shape: RawShape) -> Self {
        let (vertical, notes, warnings) = (VerticalFacts::default(), Vec::new(), Vec::new());
        Self { name, shape, vertical, horizontal: None, orientations: None, notes, warnings }
    }

    /// Takes what the header of the file states about units where the surface's own part of it is silent, and shows both
    /// where they contradict one another.
    pub(crate) fn take_units(&mut self, header: &HeaderUnits, survey: Option<Domain>) {
        let quote = |said: &Statement| format!("'{}'", said.quote);
        let domain = self.vertical.domain.as_ref().map(|(domain, _)| *domain);
        if let Some((said, other)) =
            header.vertical(domain.or(self.vertical.unit.as_ref().map(|u| Domain::of_unit(u.0))), survey)
        {
            let (unit, words) = self.vertical.unit.get_or_insert_with(|| (said.unit, quote(said))).clone();
            let against = [Some(said), other].into_iter().flatten().find(|said| said.unit != unit);
            if let Some(against) = against {
                self.warnings.push(Note::unless(
                    format!(
                        "the file gives the vertical unit twice: {} ({words}) and {} ({}); {} is taken",
                        unit.symbol(),
                        against.unit.symbol(),
                        quote(against),
                        unit.symbol()
                    ),
                    Setting::ZUnit.stated_as(against.unit.symbol()),
                ));
            }
        }
        if let Some((said, _)) = header.find(&[Quantity::Horizontal]).filter(|(said, _)| !said.unit.is_time()) {
            self.horizontal.get_or_insert_with(|| (said.unit, quote(said)));
        }
    }

    /// Brings X and Y to metres, by the option or the file's own words.
    pub(crate) fn convert_places(&mut self, told: Option<ZUnit>) {
        let told = told.map(|unit| (unit, "as told".to_owned()));
        let stated = self.horizontal.take().map(|(unit, words)| (unit, format!("the file says {words}")));
        let Some((unit, why)) = told.or(stated).filter(|(unit, _)| *unit != ZUnit::Metres && !unit.is_time()) else {
            return;
        };
        let metres = unit.in_survey();
        match &mut self.shape {
            RawShape::Grid { grid, .. } => {
                grid.origin *= metres;
                grid.u_step *= metres;
                grid.v_step *= metres;
            }
            RawShape::Points(points) => {
                for point in points {
                    point.xy = point.xy.map(|xy| xy * metres);
                    point.normal = point.normal.map(|n| DVec3::new(n.x / metres, n.y / metres, n.z));
                }
            }
            RawShape::Mesh(mesh) => {
                mesh.vertices.iter_mut().for_each(|v| *v *= DVec3::new(metres, metres, 1.0));
            }
        }
        let note = format!("X and Y are in {} and were converted to metres ({why})", unit.symbol());
        self.notes.push(note);
    }
}
