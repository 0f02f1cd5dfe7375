//! What an interpreter sees over pictures and sections, as borrowed data: sheets of horizons as they were
//! picked, their holes, faults, proposals, sticks, the selection.
//!
//! Space: voxels. Nothing of it needs a model: no pick waits for one.

use glam::DVec3;
use survey::Quality;
use ttf::Colour;

/// A horizon on the survey's traces within one fault block.
#[derive(Debug, Clone, Copy)]
pub struct TraceSheet<'a> {
    /// The fault block it lies in.
    pub block: u16,
    /// Fractional sample of each trace, `[inline][crossline]`; NaN = hole.
    pub z: &'a [f32],
    /// How each node came about.
    pub quality: &'a [Quality],
}

/// A hole of a sheet: traces without a value that the sheet encloses.
#[derive(Debug, Clone, Copy)]
pub struct SheetHole<'a> {
    /// Fault block of the sheet.
    pub block: u16,
    /// Its traces, inline index times crosslines plus crossline index, ascending.
    pub traces: &'a [u32],
}

/// A horizon as it was picked.
#[derive(Debug, Clone)]
pub struct PickedSheets<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its colour.
    pub colour: Colour,
    /// Where it is.
    pub sheets: Vec<TraceSheet<'a>>,
    /// Its holes.
    pub holes: Vec<SheetHole<'a>>,
}

/// A fault's triangles, voxels.
#[derive(Debug, Clone, Copy)]
pub struct FaultMesh<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its colour.
    pub colour: Colour,
    /// Its triangles.
    pub triangles: &'a [[DVec3; 3]],
}

/// A fault stick.
#[derive(Debug, Clone, PartialEq)]
pub struct Stick {
    /// Its places, voxels.
    pub places: Vec<DVec3>,
    /// Its colour.
    pub colour: Colour,
}

/// The node that is selected and not accepted yet.
#[derive(Debug, Clone)]
pub struct DrawnSelection<'a> {
    /// Where it is.
    pub sheets: Vec<TraceSheet<'a>>,
    /// Colour of the horizon it may become part of.
    pub colour: Colour,
}

/// The interpretation as it is.
#[derive(Debug, Clone, Default)]
pub struct DrawnInterpretation<'a> {
    /// Horizons, youngest first.
    pub horizons: Vec<PickedSheets<'a>>,
    /// Faults.
    pub faults: Vec<FaultMesh<'a>>,
    /// Proposed faults that are to be seen.
    pub proposals: Vec<FaultMesh<'a>>,
    /// Sticks.
    pub sticks: Vec<Stick>,
    /// What is selected.
    pub selection: Option<DrawnSelection<'a>>,
    /// The horizon that picks go to: it stands out before the block.
    pub picked: Option<&'a str>,
}
