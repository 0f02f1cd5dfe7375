//! Our growing, step by step: links, dips, evidence, cuts, windows, flood (see [`super`]).
//!
//! All kinds of extrema share the coarse dip and the faults; they never link to one another. Memory beside the 8 bytes of an extremum:
//! 16 of links, 8 of dips, 4 of evidence and cuts, and, for one kind at a time, 40 while its dips are smoothed; half a byte a voxel for the
//! fault planes. With peaks and troughs together every three to four samples that is some 15 bytes a voxel.

use super::evidence::{self, Noise};
use super::links::{self, Links, NEXT_X, NEXT_Y, NONE};
use super::{GrowSettings, assemble, cells, dip, flood, merge, planes};
use crate::extrema::Extrema;
use crate::surfaces::Surfaces;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Farthest that a continuation may lie from the same depth while dips are not known, samples.
const UNGUIDED_REACH: f32 = 4.0;

/// Farthest from where the dip expects it, samples.
const GUIDED_REACH: f32 = 2.0;

/// Misfits at which a link's weight for the dip is a quarter: first beside the coarse dip, then beside the dip along the surface, samples.
const SCALES: [f32; 2] = [0.5, 0.3];

/// Misfit to the dip beyond which a link is broken, samples.
const BROKEN: f32 = 1.0;

/// One kind of extremum with what is known of it.
struct Linked<'e> {
    extrema: &'e Extrema,
    links: Links,
    dips: Vec<[f32; 2]>,
    noise: Noise,
    evidence: Vec<[u8; 2]>,
}

/// Surfaces of each kind.
///
/// # Errors
/// [`Cancelled`] by the user.
pub(super) fn grow(
    extrema: &[Extrema],
    settings: &GrowSettings,
    progress: &Progress,
) -> Result<Vec<Surfaces>, Cancelled> {
    progress.begin("surfaces", 4);
    let Some(first) = extrema.first() else { return Ok(Vec::new()) };
    let unguided: Vec<Links> = extrema.par_iter().map(|e| links::mutual_links(e, &[], UNGUIDED_REACH)).collect();
    let pairs: Vec<(&Extrema, &Links)> = extrema.iter().zip(&unguided).collect();
    let field = dip::DipField::new(first.size, &pairs);
    drop(unguided);
    progress.step(1)?;
    // One kind after the other: each is parallel inside, and needs most memory while its dips are smoothed.
    let linked: Vec<Linked> = extrema.iter().map(|extrema| linked(extrema, &field)).collect();
    progress.step(1)?;
    let mut broken = if settings.fault_evidence.is_finite() {
        let kinds: Vec<_> =
            linked.iter().map(|kind| (kind.extrema, &kind.links, kind.evidence.as_slice(), &kind.noise)).collect();
        planes::cuts(&kinds, settings.fault_evidence)
    } else {
        linked.iter().map(|kind| vec![[false; 2]; kind.extrema.len()]).collect()
    };
    progress.step(1)?;
    let grown = linked
        .into_par_iter()
        .zip(&mut broken)
        .map(|(kind, broken)| {
            break_misfits(&kind, broken);
            let labels = labels(&kind, broken, settings);
            assemble::surfaces(kind.extrema, &kind.links, &labels)
        })
        .collect();
    progress.step(1)?;
    Ok(grown)
}

/// Links, dips and evidence of one kind.
fn linked<'e>(extrema: &'e Extrema, field: &dip::DipField) -> Linked<'e> {
    let coarse = field.at_extrema(extrema);
    let links = links::mutual_links(extrema, &coarse, GUIDED_REACH);
    let dips = SCALES.iter().fold(coarse, |dips, &scale| dip::along_surfaces(extrema, &links, &dips, scale));
    let noise = Noise::measure(extrema, &links, &dips);
    let evidence = evidence::evidence(extrema, &links, &dips, &noise);
    Linked { extrema, links, dips, noise, evidence }
}

/// Breaks the links that do not fit the dip.
fn break_misfits(kind: &Linked, broken: &mut [[bool; 2]]) {
    broken.par_iter_mut().with_min_len(1 << 14).enumerate().for_each(|(v, broken)| {
        for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
            let next = kind.links.to[direction][v];
            broken[axis] |=
                next != NONE && evidence::misfit(kind.extrema, &kind.dips, v, next as usize, axis).abs() > BROKEN;
        }
    });
}

/// The surface of each extremum, or [`NONE`].
fn labels(kind: &Linked, broken: &[[bool; 2]], settings: &GrowSettings) -> Vec<u32> {
    let Linked { extrema, links, evidence, .. } = kind;
    let narrow = cells::label(extrema, links, broken, settings.min_front_width);
    let mut labels = if settings.core_width > settings.min_front_width {
        let mut cores = cells::label(extrema, links, broken, settings.core_width);
        flood::flood(links, evidence, &mut cores);
        cores.iter_mut().zip(narrow).for_each(|(core, narrow)| *core = if *core == NONE { narrow } else { *core });
        cores
    } else {
        narrow
    };
    flood::flood(links, evidence, &mut labels);
    if settings.join_share <= 1.0 {
        merge::merge(extrema, links, broken, evidence, &mut labels, settings.join_share);
    }
    labels
}
