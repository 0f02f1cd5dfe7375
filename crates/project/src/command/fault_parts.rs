//! The faults as which a surface is taken in: itself, or the parts of one that turns too far for a single surface.

use crate::document::Document;
use crate::error::{FaultEditError, Noun, ProjectError};
use crate::placement;
use files::{fault_of_sticks, sticks_along_strike};
use glam::DVec3;
use model::{MOST_PARTS, ModelError};
use std::ops::Range;
use survey::{Fault, SurveyGeometry};

/// Faults in place of one.
pub(super) struct Parts {
    /// The first has the name that was asked for; each of the others ends at one before it, or nowhere.
    pub faults: Vec<Fault>,
    /// What was done, if the surface is not what was given.
    pub told: Option<String>,
}

/// Takes a surface as one fault, or cuts it into parts that have names of their own in `document`.
///
/// # Errors
/// [`ModelError`] where no surface fits it, nor a few parts of it.
pub(super) fn of_surface(document: &Document, geometry: &SurveyGeometry, fault: &Fault) -> Result<Parts, ProjectError> {
    let parts = model::split(geometry, fault)?;
    let (faults, ends): (Vec<_>, Vec<_>) =
        parts.into_iter().map(|part| (Fault::new("", part.mesh), part.ends_at)).unzip();
    let kept = inside(geometry, fault, &faults)?;
    named(document, geometry, fault, &faults, &ends, &kept)
}

/// Takes sticks as one fault, or as parts that share a stick with their neighbour; also which sticks each part has.
///
/// # Errors
/// [`FaultEditError::FlatSticks`] without area, [`ModelError`] where no surface fits them, nor a few parts of them.
pub(super) fn of_sticks(
    document: &Document,
    geometry: &SurveyGeometry,
    name: &str,
    lines: &[Vec<DVec3>],
) -> Result<(Parts, Vec<Vec<usize>>), ProjectError> {
    let flat = || FaultEditError::FlatSticks { fault: name.to_owned() };
    let whole = fault_of_sticks(name, lines, geometry).ok_or_else(flat)?;
    let folded = match model::fit_of(geometry, &whole) {
        Ok(_) => {
            let kept = inside(geometry, &whole, std::slice::from_ref(&whole))?;
            let parts = named(document, geometry, &whole, std::slice::from_ref(&whole), &[None], &kept)?;
            return Ok((parts, vec![(0..lines.len()).collect()]));
        }
        Err(folded @ ModelError::FoldedFault { .. }) => folded,
        Err(error) => return Err(error.into()),
    };
    let order = sticks_along_strike(lines, geometry);
    let fault_of = |range: &Range<usize>| {
        let lines: Vec<Vec<DVec3>> = order[range.clone()].iter().map(|&n| lines[n].clone()).collect();
        fault_of_sticks(name, &lines, geometry).filter(|fault| model::fit_of(geometry, fault).is_ok())
    };
    let mut groups: Vec<(Range<usize>, Fault)> = Vec::new();
    let mut first = 0;
    while first + 1 < order.len() {
        // As many sticks as have a surface: twice as many, then half of the difference.
        let mut fits =
            fault_of(&(first..first + 2)).map(|fault| (first..first + 2, fault)).ok_or_else(|| folded.clone())?;
        let mut step = 1;
        let mut may_double = true;
        while step > 0 {
            let wanted = first..(fits.0.end + step).min(order.len());
            match fault_of(&wanted).filter(|_| wanted.end > fits.0.end) {
                Some(fault) => fits = (wanted, fault),
                None => may_double = false,
            }
            step = if may_double { 2 * step } else { step / 2 };
        }
        first = fits.0.end - 1;
        groups.push(fits);
        if groups.len() > MOST_PARTS {
            return Err(folded.into());
        }
    }
    // Along the chain, so that each meets the one before.
    let (ranges, faults): (Vec<_>, Vec<_>) = groups.into_iter().unzip();
    let ends = model::ends_of_parts(geometry, &faults, |part, at| part == at + 1)?;
    let kept = inside(geometry, &whole, &faults)?;
    let parts = named(document, geometry, &whole, &faults, &ends, &kept)?;
    Ok((parts, kept.into_iter().map(|n| order[ranges[n].clone()].to_vec()).collect()))
}

/// Which parts of a fault lie in the survey.
fn inside(geometry: &SurveyGeometry, whole: &Fault, parts: &[Fault]) -> Result<Vec<usize>, ProjectError> {
    let kept: Vec<usize> = (0..parts.len()).filter(|&n| placement::reaches(geometry, &parts[n].mesh)).collect();
    if kept.is_empty() { Err(FaultEditError::FaultElsewhere { fault: whole.name.clone() }.into()) } else { Ok(kept) }
}

/// Those parts of `whole` that are kept, with names of their own; the first has its name and ends where it ends.
fn named(
    document: &Document,
    geometry: &SurveyGeometry,
    whole: &Fault,
    parts: &[Fault],
    ends: &[Option<usize>],
    kept: &[usize],
) -> Result<Parts, ProjectError> {
    let ends: Vec<Option<usize>> =
        kept.iter().map(|&n| ends[n].and_then(|at| kept.iter().position(|&k| k == at))).collect();
    let parts: Vec<Fault> = kept.iter().map(|&n| parts[n].clone()).collect();
    let mut names = vec![whole.name.clone()];
    let mut number = 1;
    while names.len() < parts.len() {
        number += 1;
        let name = format!("{} {number}", whole.name);
        match document.check_new_name(Noun::Fault, &name) {
            Ok(()) if document.sticks.iter().any(|drawn| drawn.fault == name) => {}
            Ok(()) => names.push(name),
            Err(ProjectError::Duplicate { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    let off_m = parts.iter().filter_map(|part| model::fit_of(geometry, part).ok().flatten()).fold(0.0, f64::max);
    let fault = |(n, part): (usize, Fault)| Fault {
        name: names[n].clone(),
        truncated_by: ends[n].map(|at| names[at].clone()).or_else(|| whole.truncated_by.clone()),
        grown_m: whole.grown_m,
        mesh: part.mesh,
    };
    let faults: Vec<Fault> = parts.into_iter().enumerate().map(fault).collect();
    let mut told = Vec::new();
    if let [first, others @ ..] = names.as_slice()
        && !others.is_empty()
    {
        let others: Vec<String> = others.iter().map(|name| format!("\"{name}\"")).collect();
        told.push(format!(
            "it turns too far for one surface and was cut: \"{first}\" goes on as {}",
            others.join(", ")
        ));
    }
    if off_m > 0.0 {
        told.push(format!("where it folds over itself its surface is smooth, nine tenths of it within {off_m:.0} m"));
    }
    Ok(Parts { faults, told: (!told.is_empty()).then(|| told.join("; ")) })
}
