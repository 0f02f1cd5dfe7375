//! Adding, renaming and removing wells.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::document::{Document, Id, WellEntry};
use crate::folder::Draft;
use files::well::{self, WellFiles, WellOptions, WellReport};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;
use survey::well::{LogSet, TopPlace, WellPlacement, is_same_surface};
use survey::{Horizon, Progress, Well};

/// Reads a well into the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AddWell {
    /// Name of the well.
    pub name: String,
    /// Its files.
    pub files: WellFiles,
    /// What the user states about them.
    #[serde(default)]
    pub options: WellOptions,
}

/// A top of a well relative to the survey.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlacedTop {
    /// Name of the surface.
    pub name: String,
    /// Its place.
    #[serde(flatten)]
    pub place: TopPlace,
    /// How much deeper the top is than the project's horizon of that name, in the survey's unit; `None` if there is no
    /// such horizon at that place.
    pub below_horizon: Option<f64>,
}

/// A curve of a well.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurveSummary {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its description.
    pub description: String,
    /// First and last measured depth with a value, m.
    pub md_m: Option<[f64; 2]>,
    /// Lowest and highest value.
    pub range: Option<[f32; 2]>,
}

/// A well relative to the survey, and what was read and assumed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WellAdded {
    /// Name of the well.
    pub name: String,
    /// Height of the datum above sea level, m.
    pub datum_m: f64,
    /// Its path in the survey.
    #[serde(flatten)]
    pub placement: WellPlacement,
    /// The survey's vertical unit.
    pub unit: &'static str,
    /// Sharpest bend, degrees per 30 m.
    pub dogleg_severity: f64,
    /// Its tops.
    pub tops: Vec<PlacedTop>,
    /// Its curves.
    pub curves: Vec<CurveSummary>,
    /// What was read and assumed.
    #[serde(flatten)]
    pub report: WellReport,
}

impl WellAdded {
    /// Describes the well relative to the present project.
    ///
    /// # Errors
    /// There is no survey geometry, or a horizon cannot be read.
    pub fn of(
        well: &Well,
        root: &Path,
        document: &Document,
        report: WellReport,
        progress: &Progress,
    ) -> Result<Self, ProjectError> {
        let geometry = document.frame()?;
        let mut tops = Vec::with_capacity(well.tops.len());
        for top in &well.tops {
            let Some(place) = well.place_at_md(top.md_m, geometry) else { continue };
            let entry = document.horizons.iter().find(|entry| is_same_surface(&entry.name, &top.name));
            let below_horizon = match entry {
                Some(entry) => below(&place, &content::read_horizon(root, entry, progress)?),
                None => None,
            };
            tops.push(PlacedTop { name: top.name.clone(), place, below_horizon });
        }
        Ok(Self {
            name: well.name.clone(),
            datum_m: well.path.datum_m(),
            placement: well.placement(geometry),
            unit: geometry.vertical.unit.symbol(),
            dogleg_severity: well.path.dogleg_severity(),
            tops,
            curves: well.logs.iter().flat_map(summaries).collect(),
            report,
        })
    }
}

/// How much deeper a place is than the nearest sheet of a horizon there.
fn below(place: &TopPlace, horizon: &Horizon) -> Option<f64> {
    let world = place.position.truncate();
    horizon
        .sheets
        .iter()
        .map(|sheet| place.z - f64::from(sheet.depth_at_node(sheet.grid.node_at(world))))
        .filter(|off| off.is_finite())
        .min_by(|a, b| a.abs().total_cmp(&b.abs()))
}

fn summaries(set: &LogSet) -> impl Iterator<Item = CurveSummary> + '_ {
    set.curves.iter().map(|curve| {
        let known: Vec<(f64, f32)> =
            set.md_m.iter().copied().zip(curve.values.iter().copied()).filter(|(_, v)| v.is_finite()).collect();
        let range = known.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |r, (_, v)| [r[0].min(*v), r[1].max(*v)]);
        CurveSummary {
            name: curve.name.clone(),
            unit: curve.unit.clone(),
            description: curve.description.clone(),
            md_m: known.first().zip(known.last()).map(|(a, b)| [a.0, b.0]),
            range: (!known.is_empty()).then_some(range),
        }
    })
}

impl fmt::Display for WellAdded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = self.unit;
        let place = |p: &TopPlace| {
            format!(
                "X {:.1}, Y {:.1}, TVDSS {:.1} m = inline {:.1}, crossline {:.1}, {:.1} {unit}",
                p.position.x, p.position.y, p.position.z, p.lines[0], p.lines[1], p.z
            )
        };
        let placement = &self.placement;
        writeln!(f, "well '{}', datum {} m above sea level", self.name, self.datum_m)?;
        writeln!(f, "  head        {}", place(&placement.head))?;
        writeln!(f, "  end         MD {:.1} m: {}", placement.total_depth.md_m, place(&placement.total_depth))?;
        match placement.inside_md_m {
            Some([first, last]) => writeln!(
                f,
                "  in survey   MD {first:.0} to {last:.0} m, {:.0} % of its length",
                100.0 * placement.inside_share
            )?,
            None => writeln!(
                f,
                "  in survey   nowhere: the well passes beside it; check the X and Y of its head and its datum"
            )?,
        }
        writeln!(f, "  vertical    {}", placement.time_depth)?;
        if self.dogleg_severity > 0.0 {
            writeln!(f, "  bends       up to {:.2} degrees per 30 m", self.dogleg_severity)?;
        }
        for top in &self.tops {
            let horizon = match top.below_horizon {
                Some(off) if off >= 0.0 => format!("; {off:.1} {unit} below the horizon"),
                Some(off) => format!("; {:.1} {unit} above the horizon", -off),
                None => String::new(),
            };
            let beside = if top.place.inside { "" } else { " (outside the survey)" };
            writeln!(
                f,
                "  top         {} at MD {:.1} m, {:.1} {unit}{beside}{horizon}",
                top.name, top.place.md_m, top.place.z
            )?;
        }
        for curve in &self.curves {
            if let (Some(md), Some(range)) = (curve.md_m, curve.range) {
                writeln!(
                    f,
                    "  curve       {} {}: {} to {} from MD {:.1} to {:.1} m",
                    curve.name, curve.unit, range[0], range[1], md[0], md[1]
                )?;
            } else {
                writeln!(f, "  curve       {} {}: no values", curve.name, curve.unit)?;
            }
        }
        self.report.assumptions.iter().try_for_each(|note| writeln!(f, "  assumed     {note}"))?;
        self.report.notes.iter().try_for_each(|note| writeln!(f, "  note        {note}"))?;
        self.report.warnings.iter().try_for_each(|warning| writeln!(f, "  warning     {warning}"))
    }
}

impl AddWell {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Well, &self.name)?;
        draft.document.frame()?;
        let options = WellOptions { name: Some(self.name.clone()), ..self.options.clone() };
        let (well, report) = well::read_well(&self.files, &options)?;
        progress.check()?;
        let done = WellAdded::of(&well, draft.root(), &draft.document, report, progress)?;
        let unhashable = |error: serde_json::Error| ProjectError::Malformed {
            path: self.files.deviation.clone(),
            detail: error.to_string(),
        };
        let hash = content::hash_well(&well).map_err(unhashable)?;
        let (file, new) = draft.generation("wells", &self.name, "json")?;
        store::write_well(&new, &well)?;
        let reading = format!(
            "{} stations, datum {} m, {} tops, {} curves",
            well.path.stations().len(),
            well.path.datum_m(),
            well.tops.len(),
            done.curves.len()
        );
        let origin = super::imported(&self.files.deviation, reading)?;
        draft.document.wells.push(WellEntry {
            id: Id::default(),
            name: self.name.clone(),
            file,
            hash,
            colour: None,
            origin,
        });
        Ok(Effect::WellAdded(Box::new(done)))
    }
}
