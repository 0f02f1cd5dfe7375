//! Wells as columns of layers: what a correlation panel shows, before it is drawn.
//!
//! A top that has the name of a horizon ([`is_same_surface`]) is where the well meets that horizon, and the layers
//! between such tops follow from the order of the horizons: below a horizon lies the layer that begins there, unless
//! it is erosional and horizons are missing below it; then the layer above the next older one is what was left. A well
//! without such tops takes its layers from the model along its path, which is a prognosis and marked as one.
//!
//! Between two wells a layer that one of them lacks wedges out at the other, at the boundary where it belongs.
//! Vertical values are those of the survey, positive down; layers and horizons count from the youngest.

use crate::error::FigureError;
use crate::spec::CorrelationPart;
use glam::{DVec2, DVec3};
use model::StructuralModel;
use survey::well::is_same_surface;
use survey::{Contact, StratigraphicHorizon, SurveyGeometry, VerticalUnit, Well};

/// Distance of the places at which a well asks the model for its layer, samples.
const STEP: f64 = 0.25;

/// A piece of a well within one layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The layer, 0 = the youngest.
    pub layer: usize,
    /// Its top and base.
    pub z: [f64; 2],
}

/// Where a well meets a named surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Marker {
    /// The surface's name: the horizon's, or that of the file.
    pub name: String,
    /// The horizon, where it is one.
    pub horizon: Option<usize>,
    /// Where.
    pub z: f64,
}

/// A curve along a well.
#[derive(Debug, Clone, PartialEq)]
pub struct LogCurve {
    /// Its name, as in the file.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Places and values, in order of measured depth.
    pub samples: Vec<(f64, f32)>,
}

/// A well as a column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Height of its datum above the sea, m.
    pub datum_m: f64,
    /// X and Y of its head, m.
    pub head: DVec2,
    /// Where it begins and ends, within the survey.
    pub span: [f64; 2],
    /// Its layers from top to bottom.
    pub intervals: Vec<Interval>,
    /// Its tops, or, where the layers are the model's, the horizons that it meets there.
    pub markers: Vec<Marker>,
    /// Whether layers and markers are the model's.
    pub is_prognosis: bool,
    /// What is taken off its values, so that the datum is level.
    pub shift: f64,
    /// A curve for each that is asked for; `None` where it was not measured.
    pub logs: Vec<Option<LogCurve>>,
}

/// What columns are made from.
#[derive(Clone, Copy)]
pub struct ColumnSource<'a> {
    /// The wells of the project.
    pub wells: &'a [Well],
    /// The survey.
    pub geometry: &'a SurveyGeometry,
    /// The horizons in order of age, youngest first.
    pub horizons: &'a [StratigraphicHorizon],
    /// The model, for wells without tops.
    pub model: Option<&'a StructuralModel>,
}

/// The wells of a panel as columns, from left to right.
///
/// # Errors
/// No wells, a well or a curve that is not there, or a well that does not meet the datum.
pub fn columns(part: &CorrelationPart, source: &ColumnSource) -> Result<Vec<Column>, FigureError> {
    if source.wells.is_empty() {
        return Err(FigureError::NoWells);
    }
    let find = |name: &String| {
        let found = source.wells.iter().find(|well| well.name == *name);
        found.ok_or_else(|| FigureError::NoWell {
            well: name.clone(),
            known: source.wells.iter().map(|well| well.name.clone()).collect(),
        })
    };
    let wells: Vec<&Well> = match part.wells.is_empty() {
        true => source.wells.iter().collect(),
        false => part.wells.iter().map(find).collect::<Result<_, _>>()?,
    };
    let logs = match &part.logs {
        Some(names) => checked(names, &wells)?,
        None => commonest(&wells).into_iter().collect(),
    };
    wells.into_iter().map(|well| column(well, &logs, part.datum.as_deref(), source)).collect()
}

fn column(well: &Well, logs: &[String], datum: Option<&str>, source: &ColumnSource) -> Result<Column, FigureError> {
    let geometry = source.geometry;
    let vertical = |md_m: f64| well.place_at_md(md_m, geometry).map(|place| place.z);
    let placement = well.placement(geometry);
    let ends = [geometry.vertical.first, geometry.vertical.value_at(geometry.size()[2].saturating_sub(1) as f64)];
    let own = [placement.head.z, placement.total_depth.z];
    let within = [own[0].max(ends[0]), own[1].min(ends[1])];
    let span = if within[0] < within[1] { within } else { own };
    let marker = |top: &survey::well::Top| {
        let horizon = source.horizons.iter().position(|horizon| is_same_surface(&horizon.name, &top.name));
        let name = horizon.map_or(&top.name, |known| &source.horizons[known].name).clone();
        Some(Marker { name, horizon, z: vertical(top.md_m)? })
    };
    let mut markers: Vec<Marker> = well.tops.iter().filter_map(marker).collect();
    let mut intervals = of_tops(&markers, span, source.horizons);
    let is_prognosis = intervals.is_empty() && source.model.is_some();
    if let Some(model) = source.model.filter(|_| is_prognosis) {
        intervals = of_model(&well.path_in_voxels(geometry), model, geometry);
        let met = intervals.windows(2).flat_map(|pair| {
            let mut met = pair[0].layer..pair[1].layer;
            // Where several fall together, the one that cuts the others is seen.
            let cuts =
                |horizon: &usize| source.horizons.get(*horizon).is_some_and(|h| h.contact != Contact::Conformable);
            met.clone().find(cuts).or_else(|| met.next()).map(|horizon| (horizon, pair[1].z[0]))
        });
        let met = met.map(|(horizon, z)| {
            let name = source.horizons.get(horizon).map_or_else(String::new, |known| known.name.clone());
            Marker { name, horizon: Some(horizon), z }
        });
        let met: Vec<Marker> = met.collect();
        markers.extend(met);
        markers.sort_by(|a, b| a.z.total_cmp(&b.z));
    }
    let level = |name: &str| {
        let met = markers.iter().find(|marker| is_same_surface(&marker.name, name));
        met.map(|marker| marker.z).ok_or_else(|| FigureError::NoDatum {
            well: well.name.clone(),
            datum: name.to_owned(),
            tops: well.tops.iter().map(|top| top.name.clone()).collect(),
        })
    };
    let shift = datum.map(level).transpose()?.unwrap_or(0.0);
    let log = |name: &String| {
        let (set, curve) = well.logs.iter().find_map(|set| Some((set, set.curve(name)?)))?;
        let known = set.md_m.iter().zip(&curve.values).filter(|(_, value)| value.is_finite());
        let samples = known.filter_map(|(md_m, value)| Some((vertical(*md_m)?, *value))).collect();
        Some(LogCurve { name: curve.name.clone(), unit: curve.unit.clone(), samples })
    };
    Ok(Column {
        name: well.name.clone(),
        datum_m: well.path.datum_m(),
        head: placement.head.position.truncate(),
        span,
        intervals,
        markers,
        is_prognosis,
        shift,
        logs: logs.iter().map(log).collect(),
    })
}

/// Layers between tops that are horizons; none without such tops. Tops out of the order of age are passed over.
fn of_tops(markers: &[Marker], span: [f64; 2], horizons: &[StratigraphicHorizon]) -> Vec<Interval> {
    let mut met: Vec<(usize, f64)> = Vec::new();
    for (horizon, z) in markers.iter().filter_map(|marker| Some((marker.horizon?, marker.z))) {
        if met.last().is_none_or(|(last, last_z)| horizon > *last && z > *last_z) {
            met.push((horizon, z));
        }
    }
    let (Some(&(first, first_z)), Some(&(last, last_z))) = (met.first(), met.last()) else { return Vec::new() };
    let between = met.windows(2).map(|pair| {
        let [(upper, top), (lower, base)] = [pair[0], pair[1]];
        let is_cut = horizons.get(upper).is_some_and(|horizon| horizon.contact == Contact::Erosional);
        Interval { layer: if is_cut { lower } else { upper + 1 }, z: [top, base] }
    });
    let above = Interval { layer: first, z: [span[0].min(first_z), first_z] };
    let below = Interval { layer: last + 1, z: [last_z, span[1].max(last_z)] };
    let all = std::iter::once(above).chain(between).chain(std::iter::once(below));
    all.filter(|interval| interval.z[0] < interval.z[1]).collect()
}

/// Layers of the model along a path, voxels.
fn of_model(path: &[DVec3], model: &StructuralModel, geometry: &SurveyGeometry) -> Vec<Interval> {
    let last = DVec3::from_array(geometry.size().map(|count| count.saturating_sub(1) as f64));
    let mut intervals: Vec<Interval> = Vec::new();
    let mut before: Option<f64> = None;
    for pair in path.windows(2) {
        let steps = (pair[0].distance(pair[1]) / STEP).ceil().max(1.0) as usize;
        for n in 0..steps {
            let place = pair[0].lerp(pair[1], n as f64 / steps as f64);
            if !(place.cmpge(DVec3::ZERO).all() && place.cmple(last).all()) {
                before = None;
                continue;
            }
            let layer = model.layer_count() - 1 - usize::from(model.region_at(place.as_vec3()).layer);
            let z = geometry.vertical.value_at(place.z);
            match intervals.last_mut().filter(|_| before.is_some()) {
                Some(known) if known.layer == layer => known.z[1] = z,
                Some(known) => {
                    let middle = 0.5 * (known.z[1] + z);
                    known.z[1] = middle;
                    intervals.push(Interval { layer, z: [middle, z] });
                }
                None => intervals.push(Interval { layer, z: [z, z] }),
            }
            before = Some(z);
        }
    }
    intervals.retain(|interval| interval.z[0] < interval.z[1]);
    intervals
}

/// First and last value of the axis of a panel: what is asked for, or all of the wells.
///
/// # Errors
/// [`FigureError::NoRange`].
pub fn range(part: &CorrelationPart, columns: &[Column]) -> Result<[f64; 2], FigureError> {
    let spans = columns.iter().map(|column| column.span.map(|z| z - column.shift));
    let whole = spans.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [from, to]| [low.min(from), high.max(to)]);
    let [from, to] = part.range.unwrap_or(whole);
    if from < to && from.is_finite() && to.is_finite() {
        Ok([from, to])
    } else {
        Err(FigureError::NoRange { from, to })
    }
}

/// What a reader must know of a panel.
pub fn caption(columns: &[Column], geometry: &SurveyGeometry) -> String {
    let mut said = vec!["Wells equally spaced".to_owned()];
    if columns.iter().any(|column| column.is_prognosis) {
        said.push("dashed: from the model".to_owned());
    }
    if geometry.vertical.unit == VerticalUnit::Milliseconds {
        said.push(format!("where there are no checkshots at {} m/s", geometry.velocity_m_s));
    }
    said.join("; ")
}

/// What the axis of a panel counts; `name` is what it counts without a datum, such as "Depth (m)".
pub(crate) fn axis_name(name: &str, part: &CorrelationPart, columns: &[Column]) -> String {
    let Some(datum) = &part.datum else { return name.to_owned() };
    let mut met = columns.iter().flat_map(|column| &column.markers).map(|marker| &marker.name);
    let datum = met.find(|known| is_same_surface(known, datum)).unwrap_or(datum);
    match name.split_once(" (") {
        Some((counted, unit)) => format!("{counted} below {datum} ({unit}"),
        None => format!("{name} below {datum}"),
    }
}

/// Where a layer lies in a column, as it is drawn: its first piece, or the place where it wedges out; `None` where the
/// well does not reach it.
pub(crate) fn place_of_layer(column: &Column, layer: usize) -> Option<[f64; 2]> {
    let own = column.intervals.iter().find(|interval| interval.layer == layer);
    let wedge = || {
        let below = column.intervals.iter().find(|interval| interval.layer > layer)?;
        Some([below.z[0]; 2])
    };
    own.map(|interval| interval.z).or_else(wedge).map(|z| z.map(|z| z - column.shift))
}

/// Where a surface lies in a column, as it is drawn, and whether it is met there; a horizon that is missing lies where
/// the layer below it wedges out.
pub(crate) fn place_of_surface(column: &Column, surface: &Marker) -> Option<(f64, bool)> {
    let is_it = |marker: &&Marker| match surface.horizon {
        Some(horizon) => marker.horizon == Some(horizon),
        None => marker.horizon.is_none() && is_same_surface(&marker.name, &surface.name),
    };
    if let Some(met) = column.markers.iter().find(is_it) {
        return Some((met.z - column.shift, true));
    }
    let horizon = surface.horizon?;
    let older = column.intervals.iter().find(|interval| interval.layer > horizon)?;
    Some((older.z[0] - column.shift, false))
}

/// The curves that are asked for, which some well has.
fn checked(names: &[String], wells: &[&Well]) -> Result<Vec<String>, FigureError> {
    let missing =
        names.iter().find(|name| !wells.iter().any(|well| well.logs.iter().any(|set| set.curve(name).is_some())));
    match missing {
        None => Ok(names.to_vec()),
        Some(log) => {
            let mut known: Vec<String> = curve_names(wells).into_iter().map(|(name, _)| name).collect();
            known.dedup();
            Err(FigureError::NoLog { log: log.clone(), known })
        }
    }
}

/// The curve that most wells have; of those the first in the files.
fn commonest(wells: &[&Well]) -> Option<String> {
    let names = curve_names(wells);
    let most = names.iter().map(|(_, count)| *count).max()?;
    names.into_iter().find(|(_, count)| *count == most).map(|(name, _)| name)
}

/// The curves of wells in the order of their files, and how many wells have each.
fn curve_names(wells: &[&Well]) -> Vec<(String, usize)> {
    let mut names: Vec<(String, usize)> = Vec::new();
    for well in wells {
        let mut own: Vec<&str> = Vec::new();
        for curve in well.logs.iter().flat_map(|set| &set.curves) {
            let has_values = curve.values.iter().any(|value| value.is_finite());
            if !has_values || own.iter().any(|name| name.eq_ignore_ascii_case(&curve.name)) {
                continue;
            }
            own.push(&curve.name);
            match names.iter_mut().find(|(name, _)| name.eq_ignore_ascii_case(&curve.name)) {
                Some((_, count)) => *count += 1,
                None => names.push((curve.name.clone(), 1)),
            }
        }
    }
    names
}

#[cfg(test)]
mod tests;
