//! The interpreter's view: what is read from a project, together with what only the view knows.

use crate::Project;
use crate::content;
use crate::document::FaultEntry;
use crate::error::ProjectError;
use crate::interpretation::{HorizonSheets, proposals};
use figure::draw::NamedColour;
use figure::interpretation::{
    DrawnInterpretation, DrawnSelection, FaultMesh, PickedSheets, SheetHole, Stick, TraceSheet,
};
use glam::DVec3;
use interp::faults::Proposal;
use interp::holes::{Hole, find_holes};
use interp::reassembly::VoxelSheet;
use std::sync::Arc;
use survey::{Progress, SurveyGeometry};
use ttf::Colour;

/// Sticks of faults that are part of the project.
const STICK: Colour = Colour::BLACK;

/// What only an interpreter's view knows; none of it is part of the project.
#[derive(Debug, Clone, Default)]
pub struct InterpreterView {
    /// The horizon that picks go to.
    pub picked: Option<String>,
    /// Whether minor proposals are shown, too.
    pub minor: bool,
    /// Proposals that are not shown, by number.
    pub dismissed: Vec<u32>,
    /// Sticks that are drawn but not part of the project yet: line numbers and vertical values.
    pub sticks: Vec<(Vec<[f64; 3]>, Colour)>,
    /// The node that is selected and not accepted yet.
    pub selection: Option<(Vec<VoxelSheet>, Colour)>,
}

impl InterpreterView {
    /// Whether a proposal is shown.
    pub fn shows(&self, proposal: &Proposal) -> bool {
        (self.minor || !proposal.is_minor) && !self.dismissed.contains(&proposal.id)
    }
}

/// A horizon as it was picked.
struct Picked {
    name: String,
    colour: Colour,
    sheets: Arc<Vec<VoxelSheet>>,
    holes: Vec<Hole>,
}

/// A fault with its triangles, voxels.
struct Mesh {
    name: String,
    colour: Colour,
    triangles: Vec<[DVec3; 3]>,
}

/// The interpretation of a project.
pub(super) struct InterpreterPicks<'a> {
    view: &'a InterpreterView,
    horizons: Vec<Picked>,
    faults: Vec<Mesh>,
    proposals: Vec<Mesh>,
    sticks: Vec<Stick>,
}

impl<'a> InterpreterPicks<'a> {
    /// Reads the interpretation.
    pub(super) fn read(
        project: &Project,
        colours: &[NamedColour],
        view: &'a InterpreterView,
        progress: &Progress,
    ) -> Result<Self, ProjectError> {
        let (root, document) = (project.root(), project.document());
        let geometry = document.frame()?;
        let [nx, ny, _] = geometry.size();
        let made = document.sticks.iter().flat_map(|fault| {
            let colour = document.faults.iter().find(|entry| entry.name == fault.fault).map_or(STICK, FaultEntry::ink);
            fault.sticks.iter().map(move |stick| (stick, colour))
        });
        let drawn = view.sticks.iter().map(|(stick, colour)| (stick, *colour));
        let sticks = made.chain(drawn).map(|(stick, colour)| Stick { places: voxels(stick, geometry), colour });
        let mut horizons = Vec::new();
        for (entry, named) in document.horizons.iter().zip(colours) {
            let sheets = project.facts().get(&HorizonSheets(entry), progress)?;
            let holes = find_holes(&sheets, [nx, ny]);
            horizons.push(Picked { name: named.name.clone(), colour: named.colour, sheets, holes });
        }
        let faults = document.faults.iter().map(|entry| {
            let fault = content::read_fault(root, entry)?;
            Ok(Mesh {
                name: entry.name.clone(),
                colour: entry.ink(),
                triangles: content::fault_triangles(&fault, geometry),
            })
        });
        let open = proposals::open(root, document).into_iter().filter(|proposal| view.shows(proposal));
        let open = open.map(|proposal| {
            let triangles = content::fault_triangles(&proposal.fault(&proposal.name), geometry);
            Mesh { name: proposal.name, colour: Colour::BLACK, triangles }
        });
        Ok(Self {
            view,
            faults: faults.collect::<Result<_, ProjectError>>()?,
            proposals: open.collect(),
            sticks: sticks.collect(),
            horizons,
        })
    }

    /// The interpretation in the form that figures take.
    pub(super) fn borrowed(&self) -> DrawnInterpretation<'_> {
        DrawnInterpretation {
            horizons: self.horizons.iter().map(Picked::borrowed).collect(),
            faults: self.faults.iter().map(Mesh::borrowed).collect(),
            proposals: self.proposals.iter().map(Mesh::borrowed).collect(),
            sticks: self.sticks.clone(),
            selection: self.view.selection.as_ref().map(|(sheets, colour)| DrawnSelection {
                sheets: sheets.iter().map(borrowed).collect(),
                colour: *colour,
            }),
            picked: self.view.picked.as_deref(),
        }
    }
}

impl Picked {
    fn borrowed(&self) -> PickedSheets<'_> {
        PickedSheets {
            name: &self.name,
            colour: self.colour,
            sheets: self.sheets.iter().map(borrowed).collect(),
            holes: self.holes.iter().map(|hole| SheetHole { block: hole.block, traces: hole.nodes() }).collect(),
        }
    }
}

impl Mesh {
    fn borrowed(&self) -> FaultMesh<'_> {
        FaultMesh { name: &self.name, colour: self.colour, triangles: &self.triangles }
    }
}

/// A sheet in the form that figures take.
pub fn borrowed(sheet: &VoxelSheet) -> TraceSheet<'_> {
    TraceSheet { block: sheet.block, z: &sheet.z, quality: &sheet.quality }
}

/// Voxel positions of the points of a stick.
fn voxels(stick: &[[f64; 3]], geometry: &SurveyGeometry) -> Vec<DVec3> {
    let voxel = |[inline, crossline, value]: &[f64; 3]| {
        geometry.voxel_from_lines(*inline, *crossline).extend(geometry.vertical.index_of(*value))
    };
    stick.iter().map(voxel).collect()
}
