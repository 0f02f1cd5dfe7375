//! Our method of growing, step by step: links, dips, evidence, side lobes, cuts, windows, flood (see
//! [`super`]).
//!
//! All kinds of extrema share the coarse dip and the faults; they never link to one another. Memory in bytes
//! per extremum, beside the 8 of the extremum itself: 16 for links, 8 for dips, 4 for evidence and cuts, 4
//! for own heights, and 34, for one kind at a time, while it is smoothed; half a byte a voxel for the fault
//! planes. With peaks and troughs together every three to four samples that is some 15 bytes a voxel.

use super::evidence::{self, Noise};
use super::links::{self, Links, NEXT_X, NEXT_Y, NONE};
use super::smoothing::SmoothingScratch;
use super::{GrowSettings, assemble, cells, dip, flood, lobes, merge, planes};
use crate::extrema::Extrema;
use crate::surfaces::Surfaces;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Largest difference in depth between linked extrema while dips are not known, samples.
pub(crate) const UNGUIDED_REACH: f32 = 4.0;

/// Largest distance of a linked extremum from the depth that the dip predicts, samples.
pub(crate) const GUIDED_REACH: f32 = 2.0;

/// Misfits at which the weight of a link in the dip is a quarter: first relative to the coarse dip, then
/// relative to the dip along the surface, samples.
pub(crate) const SCALES: [f32; 2] = [0.5, 0.3];

/// Misfit to the dip above which a link is broken, samples.
const BROKEN: f32 = 1.0;

/// One kind of extremum with its links, dips, noise and evidence.
struct Linked<'e> {
    extrema: &'e Extrema,
    links: Links,
    dips: Vec<[f32; 2]>,
    noise: Noise,
    evidence: Vec<[u8; 2]>,
}

/// Grows the surfaces of all kinds; there is at least one kind, and all are of one volume.
///
/// # Errors
/// [`Cancelled`] by the user.
pub fn grow(extrema: &[Extrema], settings: &GrowSettings, progress: &Progress) -> Result<Surfaces, Cancelled> {
    let size = extrema.first().expect("growing checks that there is a kind of extremum").size;
    let lines = size[0];
    progress.begin(
        "growing surfaces",
        (lines * (STEPS_OF_A_KIND * extrema.len() + assemble::STEPS) + planes::steps(size)) as u64,
    );
    let unguided: Vec<Links> = extrema
        .par_iter()
        .map(|e| links::mutual_links(e, &[], UNGUIDED_REACH, progress))
        .collect::<Result<_, Cancelled>>()?;
    let pairs: Vec<(&Extrema, &Links)> = extrema.iter().zip(&unguided).collect();
    let field = dip::DipField::new(size, &pairs);
    progress.check()?;
    let own = if settings.lobe_share > 0.0 { lobes::own_heights(extrema) } else { vec![Vec::new(); extrema.len()] };
    progress.check()?;
    let mut scratch = SmoothingScratch::default();
    // One kind after the other: each is parallel inside, and the smoothing of its dips needs the most memory.
    let linked: Vec<Linked> = extrema
        .iter()
        .zip(unguided)
        .zip(own)
        .map(|((extrema, unguided), own)| linked(extrema, unguided, &own, &field, settings, &mut scratch, progress))
        .collect::<Result<_, Cancelled>>()?;
    drop(scratch);
    let mut broken = if settings.fault_evidence.is_finite() {
        let kinds: Vec<_> =
            linked.iter().map(|kind| (kind.extrema, &kind.links, kind.evidence.as_slice(), &kind.noise)).collect();
        planes::cuts(&kinds, settings.fault_evidence, progress)?
    } else {
        progress.step(planes::steps(size) as u64)?;
        linked.iter().map(|kind| vec![[false; 2]; kind.extrema.len()]).collect()
    };
    let labelled = linked
        .into_par_iter()
        .zip(&mut broken)
        .map(|(kind, broken)| {
            break_misfits(&kind, broken);
            let labels = labels(&kind, broken, settings, progress)?;
            Ok(assemble::Labelled { extrema: kind.extrema, links: kind.links, labels })
        })
        .collect::<Result<_, Cancelled>>()?;
    drop(broken);
    assemble::surfaces(size, labelled, progress)
}

/// Progress steps of each kind of extremum per inline: links twice, dips twice, evidence along both axes,
/// labels in four.
const STEPS_OF_A_KIND: usize = 10;

/// Links, dips and evidence of one kind.
fn linked<'e>(
    extrema: &'e Extrema,
    unguided: Links,
    own: &[f32],
    field: &dip::DipField,
    settings: &GrowSettings,
    scratch: &mut SmoothingScratch,
    progress: &Progress,
) -> Result<Linked<'e>, Cancelled> {
    let mut dips = field.at_extrema(extrema, [0; 2]);
    let links = unguided.renew(extrema, &dips, GUIDED_REACH, progress)?;
    for scale in SCALES {
        dip::along_surfaces(extrema, &links, &mut dips, scale, scratch, progress)?;
    }
    let noise = Noise::measure(extrema, &links, &dips);
    let mut evidence = evidence::evidence(extrema, &links, &dips, &noise, scratch, progress)?;
    let least = lobes::Least { share: settings.lobe_share, noise: noise.least_change() };
    lobes::part(extrema, &links, own, least, &mut evidence, scratch, progress)?;
    Ok(Linked { extrema, links, dips, noise, evidence })
}

/// Breaks the links that do not fit the dip, and those with the greatest evidence for a break.
fn break_misfits(kind: &Linked, broken: &mut [[bool; 2]]) {
    let Linked { extrema, links, dips, evidence, .. } = kind;
    broken.par_iter_mut().with_min_len(1 << 14).enumerate().for_each(|(v, broken)| {
        for (axis, broken) in broken.iter_mut().enumerate() {
            *broken |= is_misfit(extrema, links, dips, evidence[v], v, axis);
        }
    });
}

/// Whether the link of an extremum along an axis does not fit the dip, or has the greatest evidence for a break.
pub(crate) fn is_misfit(
    extrema: &Extrema,
    links: &Links,
    dips: &[[f32; 2]],
    evidence: [u8; 2],
    v: usize,
    axis: usize,
) -> bool {
    let next = links.to[[NEXT_X, NEXT_Y][axis]][v];
    next != NONE
        && (evidence[axis] == evidence::MOST || evidence::misfit(extrema, dips, v, next as usize, axis).abs() > BROKEN)
}

/// The label of the surface of each extremum, or [`NONE`].
fn labels(
    kind: &Linked,
    broken: &[[bool; 2]],
    settings: &GrowSettings,
    progress: &Progress,
) -> Result<Vec<u32>, Cancelled> {
    let Linked { extrema, links, evidence, .. } = kind;
    let lines = extrema.size[0] as u64;
    let open = cells::open_cells(links, broken);
    let narrow = cells::label(extrema, links, &open, settings.min_front_width, progress)?;
    progress.step(lines)?;
    let mut labels = if settings.core_width > settings.min_front_width {
        let mut cores = cells::label(extrema, links, &open, settings.core_width, progress)?;
        flood::flood(extrema, links, evidence, &mut cores, progress)?;
        cores.iter_mut().zip(narrow).for_each(|(core, narrow)| *core = if *core == NONE { narrow } else { *core });
        cores
    } else {
        narrow
    };
    drop(open);
    progress.step(lines)?;
    flood::flood(extrema, links, evidence, &mut labels, progress)?;
    progress.step(lines)?;
    if settings.join_share <= 1.0 {
        merge::merge(extrema, links, broken, evidence, &mut labels, settings.join_share, progress)?;
    }
    progress.step(lines)?;
    Ok(labels)
}
