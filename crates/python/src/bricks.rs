//! Stages as pure functions: the samples of a brick with its halo in, its result out, on one thread, without any cache.
//!
//! What comes out has the shape of what went in; of a stage with a halo the caller keeps the inner part, which is the same
//! whatever the tiling (`reach` says how many lines the halo needs). Dead traces are told by a mask.

use crate::arrays::{array, mask, slice, volume, wrong};
use crate::work::task;
use attribute::blocks::dip_angle as angle_of;
use attribute::{AttributeError, DipSettings, DipVolumes, SemblanceSettings};
use interp::Extremum;
use interp::extrema::extrema_of_trace;
use numpy::{IntoPyArray, PyArray1, PyArray3, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;
use std::convert::Infallible;
use survey::{Progress, SurveyGeometry, Volume};

type Samples<'py> = PyReadonlyArray3<'py, f32>;
type Result3<'py> = PyResult<Bound<'py, PyArray3<f32>>>;

/// Settings from JSON; none are the default ones.
fn settings<S: DeserializeOwned + Default>(json: Option<&str>) -> PyResult<S> {
    json.map_or_else(|| Ok(S::default()), |json| serde_json::from_str(json).map_err(wrong))
}

/// A brick with its mask.
fn brick(samples: &Samples<'_>, live: Option<PyReadonlyArray2<'_, bool>>) -> PyResult<Volume<f32>> {
    volume(samples, mask(live))
}

/// Lines of halo that a stage needs to all four sides.
#[pyfunction]
#[pyo3(signature = (kind, dip=None, semblance=None, geometry=None))]
pub(crate) fn reach(kind: &str, dip: Option<&str>, semblance: Option<&str>, geometry: Option<&str>) -> PyResult<usize> {
    let steering: DipSettings = settings(dip)?;
    let of_survey = || -> PyResult<SurveyGeometry> {
        let json = geometry.ok_or_else(|| wrong(format!("{kind} needs the geometry of the survey")))?;
        serde_json::from_str(json).map_err(wrong)
    };
    match kind {
        "fault-likelihood" => Ok(attribute::likelihood::reach(&of_survey()?)),
        "throw" => Ok(faults::throw_reach(&of_survey()?)),
        "envelope" | "extrema" | "dip-angle" => Ok(0),
        "dip" => Ok(steering.reach()),
        "semblance" => Ok(steering.reach().max(settings::<SemblanceSettings>(semblance)?.half_width)),
        other => Err(wrong(format!(
            "{other}: expected envelope, dip, semblance, fault-likelihood, throw, dip-angle or extrema"
        ))),
    }
}

/// The envelope.
#[pyfunction]
#[pyo3(signature = (samples, live=None))]
pub(crate) fn envelope<'py>(
    py: Python<'py>,
    samples: Samples<'py>,
    live: Option<PyReadonlyArray2<'py, bool>>,
) -> Result3<'py> {
    let brick = brick(&samples, live)?;
    array(py, task(py, || attribute::envelope(&brick, &Progress::silent()))?)
}

/// The dips along inlines and along crosslines, samples a line.
#[pyfunction]
#[pyo3(signature = (samples, live=None, dip=None))]
pub(crate) fn dip<'py>(
    py: Python<'py>,
    samples: Samples<'py>,
    live: Option<PyReadonlyArray2<'py, bool>>,
    dip: Option<&str>,
) -> PyResult<[Bound<'py, PyArray3<f32>>; 2]> {
    let (brick, steering) = (brick(&samples, live)?, settings::<DipSettings>(dip)?);
    let dips = task(py, || attribute::dip(&brick, &steering, &Progress::silent()))?;
    Ok([array(py, dips.inline)?, array(py, dips.crossline)?])
}

/// The semblance along the brick's own dips.
#[pyfunction]
#[pyo3(signature = (samples, live=None, dip=None, semblance=None))]
pub(crate) fn semblance<'py>(
    py: Python<'py>,
    samples: Samples<'py>,
    live: Option<PyReadonlyArray2<'py, bool>>,
    dip: Option<&str>,
    semblance: Option<&str>,
) -> Result3<'py> {
    let (brick, steering) = (brick(&samples, live)?, settings::<DipSettings>(dip)?);
    let measure: SemblanceSettings = settings(semblance)?;
    let found = task(py, || {
        let dips = attribute::dip(&brick, &steering, &Progress::silent())?;
        attribute::semblance(&brick, &dips, &measure, &Progress::silent())
    });
    array(py, found?)
}

/// A volume that depends on a brick and the geometry of its survey.
type OfSurvey = fn(&Volume<f32>, &SurveyGeometry, &Progress) -> Result<Volume<f32>, AttributeError>;

fn along_faults<'py>(
    py: Python<'py>,
    samples: &Samples<'py>,
    geometry: &str,
    live: Option<PyReadonlyArray2<'py, bool>>,
    measure: OfSurvey,
) -> Result3<'py> {
    let brick = brick(samples, live)?;
    let geometry: SurveyGeometry = serde_json::from_str(geometry).map_err(wrong)?;
    array(py, task(py, || measure(&brick, &geometry, &Progress::silent()))?)
}

/// The fault likelihood along the brick's own slopes; `geometry` is that of the survey.
#[pyfunction]
#[pyo3(signature = (samples, geometry, live=None))]
pub(crate) fn fault_likelihood<'py>(
    py: Python<'py>,
    samples: Samples<'py>,
    geometry: &str,
    live: Option<PyReadonlyArray2<'py, bool>>,
) -> Result3<'py> {
    along_faults(py, &samples, geometry, live, attribute::fault_likelihood)
}

/// The throws where the fault likelihood has a ridge, samples; `geometry` is that of the survey.
#[pyfunction]
#[pyo3(signature = (samples, geometry, live=None))]
pub(crate) fn throw<'py>(
    py: Python<'py>,
    samples: Samples<'py>,
    geometry: &str,
    live: Option<PyReadonlyArray2<'py, bool>>,
) -> Result3<'py> {
    along_faults(py, &samples, geometry, live, faults::throw)
}

/// The angle of the reflections from the horizontal, degrees, from two dips; `geometry` is that of the survey.
#[pyfunction]
#[pyo3(signature = (inline, crossline, geometry, live=None))]
pub(crate) fn dip_angle<'py>(
    py: Python<'py>,
    inline: Samples<'py>,
    crossline: Samples<'py>,
    geometry: &str,
    live: Option<PyReadonlyArray2<'py, bool>>,
) -> Result3<'py> {
    if inline.shape() != crossline.shape() {
        return Err(wrong(format!("the dips differ in shape: {:?} and {:?}", inline.shape(), crossline.shape())));
    }
    let geometry: SurveyGeometry = serde_json::from_str(geometry).map_err(wrong)?;
    let dips = DipVolumes { inline: brick(&inline, live)?, crossline: volume(&crossline, None)? };
    array(py, task(py, || Ok::<_, AttributeError>(angle_of(&dips, &geometry)))?)
}

/// Counts of extrema of each trace, their fractional samples and their amplitudes, trace after trace from the top down.
type Extrema<'py> = (Bound<'py, PyArray1<u32>>, Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<f32>>);

/// The extrema of one kind of every live trace.
#[pyfunction]
#[pyo3(signature = (samples, kind, live=None))]
pub(crate) fn extrema<'py>(
    py: Python<'py>,
    samples: Samples<'py>,
    kind: &str,
    live: Option<PyReadonlyArray2<'py, bool>>,
) -> PyResult<Extrema<'py>> {
    let kind = match kind {
        "peak" => Extremum::Peak,
        "trough" => Extremum::Trough,
        "zero" => Extremum::Zero,
        other => return Err(wrong(format!("{other}: expected peak, trough or zero"))),
    };
    let count = samples.shape()[0] * samples.shape()[1];
    let length = samples.shape()[2].max(1);
    let live = mask(live);
    if live.as_ref().is_some_and(|live| live.len() != count) {
        return Err(wrong(format!("the mask has {} traces, the brick {count}", live.map_or(0, |live| live.len()))));
    }
    let traces = slice(&samples)?;
    let (mut counts, mut z, mut amplitude) = (vec![0u32; count], Vec::new(), Vec::new());
    task(py, || {
        for (n, trace) in traces.chunks(length).enumerate().filter(|(n, _)| live.as_ref().is_none_or(|live| live[*n])) {
            extrema_of_trace(trace, kind, &mut |at, height| {
                counts[n] += 1;
                z.push(at);
                amplitude.push(height);
            });
        }
        Ok::<_, Infallible>(())
    })?;
    Ok((counts.into_pyarray(py), z.into_pyarray(py), amplitude.into_pyarray(py)))
}
