//! Stages from links to cuts: `breaks`, `variances`, `evidence`, `surroundings`, `parted`, `cuts`.

use super::Bricks;
use super::patch::{Patch, Values};
use super::samples::Samples;
use super::tiles::Halo;
use crate::error::InterpError;
use crate::extrema::Extrema;
use crate::grow::evidence::{self, LOUD, Median, Noise, ROUNDS};
use crate::grow::links::{Links, NONE};
use crate::grow::lobes::{self, Least, Lobes};
use crate::grow::smoothing::SmoothingScratch;
use crate::grow::surroundings::{self, Surroundings};
use crate::grow::{ours, planes};
use survey::Progress;

/// A patch with what stages after `dips` know of its extrema.
struct Linked {
    patch: Patch,
    links: Links,
    evidence: Vec<[u8; 2]>,
    noise: Noise,
}

impl Bricks<'_> {
    /// Smoothed misfits and changes of amplitude of each link, and samples of their spread.
    pub(crate) fn breaks(&self, brick: usize) -> Result<(), InterpError> {
        let (mut scratch, quiet) = (SmoothingScratch::default(), Progress::silent());
        for kind in 0..self.kinds.len() {
            let noise = self.noise(kind)?;
            let mut samples = Samples::default();
            for axis in 0..2 {
                // Smoothed across the links, that is along the other axis; the links lead to the next trace.
                let mut halo = Halo::around(2);
                (halo.before[1 - axis], halo.behind[1 - axis]) = (ROUNDS + 2, ROUNDS + 2);
                let patch = self.patch(kind, brick, halo, Values::All)?;
                let (links, dips) = (self.links(&patch)?, self.values("dips", &patch)?);
                evidence::smoothed_breaks(&patch.extrema, &links, &dips, &noise, axis, &mut scratch, &quiet)?;
                let ratios: Vec<[f32; 2]> = scratch.values.iter().map(|s| [s[0] / s[2], s[1] / s[2]]).collect();
                for (_, place, index) in patch.own_extrema() {
                    if (index as usize).is_multiple_of(evidence::SPARSE) && scratch.values[place][2] > 0.0 {
                        (0..2).for_each(|which| samples.push(2 * axis + which, ratios[place][which].abs()));
                    }
                }
                self.keep(["breaks-x", "breaks-y"][axis], &patch, &ratios)?;
            }
            self.keep_samples(&self.name("spread", kind), brick, samples)?;
        }
        Ok(())
    }

    /// The variance of smoothed misfits and changes, by axis.
    pub(crate) fn variances(&self) -> Result<(), InterpError> {
        for kind in 0..self.kinds.len() {
            let found = self.at_ranks(&self.name("spread", kind), |count| vec![count / 2])?;
            let variances: [f32; 4] = std::array::from_fn(|class| {
                let median = found.get(&(class as u32));
                let median = median.map(|(count, values)| Median { count: *count, middle: values[0] });
                evidence::variance(median.unwrap_or_default())
            });
            self.write(&self.name("variances", kind), 0, &variances)?;
        }
        Ok(())
    }

    /// Evidence of each link, not yet compared with what is around it, and its sums in coarse bricks.
    pub(crate) fn evidence(&self, brick: usize) -> Result<(), InterpError> {
        let counts = surroundings::counts(self.size);
        for kind in 0..self.kinds.len() {
            let noise = self.noise(kind)?;
            let variances: [f32; 4] = self.read_array(&self.name("variances", kind))?;
            let patch = self.patch(kind, brick, Halo::behind(1), Values::All)?;
            let links = self.links_on(&patch)?;
            let mut found = vec![[0u8; 2]; patch.extrema.len()];
            // Sums and counts in the coarse bricks that the brick meets, by axis.
            let [edge_x, edge_y, _] = surroundings::BRICK;
            let units = [(&patch.own.x, edge_x), (&patch.own.y, edge_y)]
                .map(|(lines, edge)| lines.start / edge..lines.end.div_ceil(edge));
            let mut sums = vec![[[0u32; 2]; 2]; units[0].len() * units[1].len() * counts[2]];
            for axis in 0..2 {
                let variance = [variances[2 * axis], variances[2 * axis + 1]];
                let ratios: Vec<[f32; 2]> = self.values(["breaks-x", "breaks-y"][axis], &patch)?;
                for ([x, y], v, _) in patch.own_extrema() {
                    let is_linked = links.to[2 * axis][v] != NONE;
                    let amplitude = patch.extrema.amplitude[v];
                    let value = evidence::quarters(is_linked, amplitude, &noise, ratios[v], variance);
                    found[v][axis] = value;
                    if is_linked {
                        let [x, y] = [x / edge_x, y / edge_y];
                        let column = (x - units[0].start) * units[1].len() + y - units[1].start;
                        let down = surroundings::down(patch.extrema.z[v], counts[2]);
                        let [sum, count] = &mut sums[column * counts[2] + down][axis];
                        (*sum, *count) = (*sum + u32::from(value.min(LOUD)), *count + 1);
                    }
                }
            }
            self.keep("raw-evidence", &patch, &found)?;
            // Number of the coarse brick and of the axis, sum, count.
            let mut found: Vec<[u32; 3]> = Vec::new();
            for (n, sums) in sums.into_iter().enumerate() {
                let (column, down) = (n / counts[2], n % counts[2]);
                let [x, y] = [units[0].start + column / units[1].len(), units[1].start + column % units[1].len()];
                let at = (x * counts[1] + y) * counts[2] + down;
                for (axis, [sum, count]) in sums.into_iter().enumerate().filter(|(_, [_, count])| *count > 0) {
                    found.push([(2 * at + axis) as u32, sum, count]);
                }
            }
            self.write(&self.name("sums", kind), brick, &found)?;
        }
        Ok(())
    }

    /// Sums of evidence of all bricks.
    pub(crate) fn add_surroundings(&self) -> Result<(), InterpError> {
        let half: usize = surroundings::counts(self.size).iter().product();
        for kind in 0..self.kinds.len() {
            let mut sums = vec![[0u32; 2]; 2 * half];
            for brick in 0..self.tiles.count() {
                for [at, sum, count] in self.read::<[u32; 3]>(&self.name("sums", kind), brick)? {
                    // The axis first.
                    let total = &mut sums[(at % 2) as usize * half + (at / 2) as usize];
                    *total = [total[0] + sum, total[1] + count];
                }
            }
            self.write(&self.name("surroundings", kind), 0, &sums)?;
        }
        Ok(())
    }

    /// The final evidence: beside what is around it, and the greatest between reflectors and side lobes.
    pub(crate) fn parted(&self, brick: usize) -> Result<(), InterpError> {
        let lobes: Vec<f32> = self.read("lobes", 0)?;
        let halo = Halo::around(3);
        let patches: Vec<Patch> =
            (0..self.kinds.len()).map(|kind| self.patch(kind, brick, halo, Values::All)).collect::<Result<_, _>>()?;
        let mut own = vec![Vec::new(); self.kinds.len()];
        // One list of extrema, as their resolution takes them, and back.
        let (extrema, patches): (Vec<Extrema>, Vec<Patch>) = patches.into_iter().map(Patch::split).unzip();
        if let (Some(pair), &[distance, height]) = (lobes::pair_of(&self.kinds), lobes.as_slice()) {
            own = lobes::resolved_heights(&extrema, pair, Lobes { distance, height });
        }
        let (mut scratch, quiet) = (SmoothingScratch::default(), Progress::silent());
        for ((patch, extrema), own) in patches.into_iter().zip(extrema).zip(own) {
            let patch = patch.with(extrema);
            let (links, noise) = (self.links(&patch)?, self.noise(patch.kind)?);
            let mut evidence: Vec<[u8; 2]> = self.values("raw-evidence", &patch)?;
            let sums: Vec<[u32; 2]> = self.read(&self.name("surroundings", patch.kind), 0)?;
            for (axis, sums) in sums.chunks(sums.len() / 2).enumerate() {
                let usual = Surroundings::of_sums(self.size, sums);
                for ([x, y], v, _) in patch.own_extrema().filter(|&(_, v, _)| links.to[2 * axis][v] != NONE) {
                    evidence[v][axis] = evidence::beside(evidence[v][axis], usual.at(x, y, patch.extrema.z[v]));
                }
            }
            let least = Least { share: self.settings.grow.lobe_share, noise: noise.least_change() };
            lobes::part(&patch.extrema, &links, &own, least, &mut evidence, &mut scratch, &quiet)?;
            self.keep("evidence", &patch, &evidence)?;
        }
        Ok(())
    }

    fn linked(&self, kind: usize, brick: usize, halo: Halo) -> Result<Linked, InterpError> {
        let patch = self.patch(kind, brick, halo, Values::All)?;
        let (links, noise) = (self.links(&patch)?, self.noise(kind)?);
        let evidence = self.values("evidence", &patch)?;
        Ok(Linked { patch, links, evidence, noise })
    }

    /// Links that are cut: by planes of faults, or because they do not fit the dip.
    pub(crate) fn cuts(&self, brick: usize) -> Result<(), InterpError> {
        let least = self.settings.grow.fault_evidence;
        let mut cut: Vec<Vec<[bool; 2]>> = vec![Vec::new(); self.kinds.len()];
        for axis in (0..2).filter(|_| least.is_finite()) {
            let reach = planes::reach(axis);
            let halo = Halo { before: reach, behind: reach };
            let all: Vec<Linked> =
                (0..self.kinds.len()).map(|kind| self.linked(kind, brick, halo)).collect::<Result<_, _>>()?;
            let kinds: Vec<_> =
                all.iter().map(|of| (&of.patch.extrema, &of.links, of.evidence.as_slice(), &of.noise)).collect();
            let mut found: Vec<Vec<[bool; 2]>> =
                all.iter().map(|of| vec![[false; 2]; of.patch.extrema.len()]).collect();
            planes::cuts_along(axis, &kinds, least, &mut found, &Progress::silent())?;
            for ((cut, of), found) in cut.iter_mut().zip(&all).zip(found) {
                let own = of.patch.own_rows().flat_map(|row| &found[row]);
                if cut.is_empty() {
                    cut.extend(own.copied());
                } else {
                    cut.iter_mut().zip(own).for_each(|(cut, found)| cut[axis] = found[axis]);
                }
            }
        }
        for (kind, mut cut) in cut.into_iter().enumerate() {
            let Linked { patch, links, evidence, .. } = self.linked(kind, brick, Halo::behind(1))?;
            let dips: Vec<[f32; 2]> = self.values("dips", &patch)?;
            let own: Vec<usize> = patch.own_rows().flatten().collect();
            cut.resize(own.len(), [false; 2]);
            for (cut, v) in cut.iter_mut().zip(own) {
                for (axis, cut) in cut.iter_mut().enumerate() {
                    *cut |= ours::is_misfit(&patch.extrema, &links, &dips, evidence[v], v, axis);
                }
            }
            let codes: Vec<[u8; 2]> = cut.into_iter().map(|cut| cut.map(u8::from)).collect();
            self.write(&self.name("broken", kind), brick, &codes)?;
        }
        Ok(())
    }

    /// Which links of a patch are cut.
    pub(crate) fn broken(&self, patch: &Patch) -> Result<Vec<[bool; 2]>, InterpError> {
        let codes: Vec<[u8; 2]> = self.values("broken", patch)?;
        Ok(codes.into_iter().map(|code| code.map(|cut| cut != 0)).collect())
    }
}
