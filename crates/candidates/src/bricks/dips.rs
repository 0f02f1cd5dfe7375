//! Stages from samples to links and dips: `extrema`, `offsets`, `jumps`, `field`, `beside`, `lobes`, `dips`, `noise`.

use super::Bricks;
use super::patch::Values;
use super::samples::Samples;
use super::tiles::{Halo, Tiling};
use crate::error::InterpError;
use crate::extrema::extrema_of_trace;
use crate::grow::dip::{self, DipField, Histograms};
use crate::grow::evidence::{self, DIP_CLASSES, HEIGHT_CLASSES, HEIGHT_SHARES, Median, Noise};
use crate::grow::links::mutual_links;
use crate::grow::lobes::{self, Lobes};
use crate::grow::ours::{GUIDED_REACH, SCALES, UNGUIDED_REACH};
use crate::grow::smoothing::SmoothingScratch;
use survey::Progress;

/// Traces around a brick on which its dips depend: three of smoothing and one of links, twice, one for the links of the
/// last, and one for the noise along links to the next brick.
const DIP_HALO: usize = 11;

impl Bricks<'_> {
    /// Extrema of a brick's traces: counts, depths and amplitudes of each kind.
    pub(crate) fn extrema(&self, brick: usize) -> Result<(), InterpError> {
        let area = self.tiles.area(brick);
        let [nx, ny] = [area.x.len(), area.y.len()];
        let start = [area.x.start, area.y.start, 0];
        let volume = self.source.read_box(start, [nx, ny, self.size[2]]).map_err(InterpError::Source)?;
        for (kind, &extremum) in self.kinds.iter().enumerate() {
            let (mut counts, mut z, mut amplitude) = (vec![0u32; nx * ny], Vec::new(), Vec::new());
            for trace in (0..nx * ny).filter(|trace| volume.is_live(trace / ny, trace % ny)) {
                let before = z.len();
                extrema_of_trace(volume.trace(trace / ny, trace % ny), extremum, &mut |at, height| {
                    z.push(at);
                    amplitude.push(height);
                });
                counts[trace] = (z.len() - before) as u32;
            }
            self.write(&self.name("counts", kind), brick, &counts)?;
            self.write(&self.name("z", kind), brick, &z)?;
            self.write(&self.name("amplitude", kind), brick, &amplitude)?;
        }
        Ok(())
    }

    /// Index of the first extremum of each trace.
    pub(crate) fn number_extrema(&self) -> Result<(), InterpError> {
        let [nx, ny, _] = self.size;
        for kind in 0..self.kinds.len() {
            let mut offsets = vec![0u32; nx * ny + 1];
            for brick in 0..self.tiles.count() {
                let (area, counts) = (self.tiles.area(brick), self.read::<u32>(&self.name("counts", kind), brick)?);
                for (row, x) in counts.chunks(area.y.len()).zip(area.x.clone()) {
                    offsets[x * ny + area.y.start + 1..x * ny + area.y.end + 1].copy_from_slice(row);
                }
            }
            let mut reached = 0u64;
            for offset in &mut offsets {
                reached += u64::from(*offset);
                *offset = reached as u32;
            }
            if reached >= u64::from(u32::MAX) {
                let found = reached as usize;
                return Err(InterpError::Growing(Box::new(
                    crate::extrema::ExtremaError::<std::convert::Infallible>::TooMany { found },
                )));
            }
            self.write(&self.name("offsets", kind), 0, &offsets)?;
        }
        Ok(())
    }

    /// Histograms of the jumps of unguided links, and samples of heights.
    pub(crate) fn jumps(&self, brick: usize) -> Result<(), InterpError> {
        let counts = dip::counts(self.size);
        let [edge_x, edge_y, _] = dip::BRICK;
        let [units_x, units_y] = Tiling::units(&self.tiles.area(brick), [edge_x, edge_y]);
        let mut histograms: Vec<Histograms> = vec![[[0.0; dip::BINS]; 2]; units_x.len() * units_y.len() * counts[2]];
        let (mut strong, quiet) = (Samples::default(), Progress::silent());
        let pair = lobes::pair_of(&self.kinds).unwrap_or([usize::MAX; 2]);
        for kind in 0..self.kinds.len() {
            let patch = self.patch(kind, brick, Halo::behind(edge_x.max(edge_y) + 1), Values::All)?;
            let links = mutual_links(&patch.extrema, &[], UNGUIDED_REACH, &quiet)?;
            for ([x, y], places, _) in patch.traces() {
                let unit = [x / edge_x, y / edge_y];
                if units_x.contains(&unit[0]) && units_y.contains(&unit[1]) {
                    let column = (unit[0] - units_x.start) * units_y.len() + unit[1] - units_y.start;
                    dip::add_trace(&patch.extrema, &links, places, &mut histograms[column * counts[2]..]);
                }
            }
            let mut heights = Samples::default();
            for (_, place, index) in patch.own_extrema() {
                let amplitude = patch.extrema.amplitude[place];
                if (index as usize).is_multiple_of(evidence::SPARSE) {
                    heights.push(0, amplitude);
                }
                if pair.contains(&kind) && (index as usize).is_multiple_of(lobes::SPARSE) {
                    strong.push(0, amplitude);
                }
            }
            self.keep_samples(&self.name("heights", kind), brick, heights)?;
        }
        self.keep_samples("strong", brick, strong)?;
        self.write("jumps", brick, histograms.as_flattened().as_flattened())
    }

    /// The coarse dips, the classes of amplitude, and what is strong.
    pub(crate) fn field(&self) -> Result<(), InterpError> {
        let counts @ [rows, ..] = dip::counts(self.size);
        let mut dips: Vec<[f32; 2]> = Vec::with_capacity(counts.iter().product());
        let mut around = [None, self.jumps_of_row(0)?, if rows > 1 { self.jumps_of_row(1)? } else { None }];
        for row in 0..rows {
            dips.extend(dip::dips_of_row([counts[1], counts[2]], around.each_ref().map(|row| row.as_deref())));
            around.rotate_left(1);
            around[2] = if row + 2 < rows { self.jumps_of_row(row + 2)? } else { None };
        }
        self.write("field", 0, &dips)?;
        for kind in 0..self.kinds.len() {
            let ranks = |count: usize| HEIGHT_SHARES.iter().map(|&share| evidence::rank(share, count)).collect();
            let mut steps = [f32::INFINITY; HEIGHT_CLASSES - 1];
            if let Some((count, found)) = self.at_ranks(&self.name("heights", kind), ranks)?.remove(&0) {
                let reached = HEIGHT_SHARES.iter().filter(|&&share| evidence::rank(share, count) < count).count();
                steps[..reached].copy_from_slice(&found[..reached]);
            }
            self.write(&self.name("steps", kind), 0, &steps)?;
        }
        let strong = self.at_ranks("strong", |count| vec![lobes::strong_rank(count)])?;
        // Lobes are told from both kinds or not at all; what no extremum reaches is never strong.
        self.write(
            "strong-height",
            0,
            &[strong.get(&0).and_then(|(_, found)| found.first().copied()).unwrap_or(f32::NAN)],
        )
    }

    /// Histograms of a row of coarse bricks.
    fn jumps_of_row(&self, row: usize) -> Result<Option<Vec<Histograms>>, InterpError> {
        let counts = dip::counts(self.size);
        let mut all: Vec<Histograms> = vec![[[0.0; dip::BINS]; 2]; counts[1] * counts[2]];
        let along_y = self.tiles.counts()[1];
        let first = row * dip::BRICK[0] / self.tiles.edge[0] * along_y;
        for brick in first..(first + along_y).min(self.tiles.count()) {
            let [xs, ys] = Tiling::units(&self.tiles.area(brick), [dip::BRICK[0], dip::BRICK[1]]);
            if xs.contains(&row) && !ys.is_empty() {
                let out = &mut all[ys.start * counts[2]..ys.end * counts[2]];
                let from = (row - xs.start) * out.len() * 2 * dip::BINS;
                self.read_at("jumps", brick, from, out.as_flattened_mut().as_flattened_mut())?;
            }
        }
        Ok(Some(all))
    }

    /// Distances and relative heights of what lies beside strong extrema.
    pub(crate) fn beside(&self, brick: usize) -> Result<(), InterpError> {
        let strong = self.read::<f32>("strong-height", 0)?[0];
        let (mut samples, mut trace) = (Samples::default(), Vec::new());
        if let Some(pair) = lobes::pair_of(&self.kinds).filter(|_| self.settings.grow.lobe_share > 0.0) {
            let patch = |kind| self.patch(kind, brick, Halo::default(), Values::All);
            let [a, b] = &[patch(pair[0])?, patch(pair[1])?];
            for ([x, y], ..) in a.own_traces().filter(|([x, y], ..)| lobes::is_measured(*x, *y)) {
                lobes::merged([&a.extrema, &b.extrema], x - a.area.x.start, y - a.area.y.start, &mut trace);
                lobes::each_beside(&trace, strong, |pair| (0..2).for_each(|which| samples.push(which, pair[which])));
            }
        }
        self.keep_samples("beside", brick, samples)
    }

    /// The side lobes of the survey's reflectors: distance and height, or nothing.
    pub(crate) fn measure_lobes(&self) -> Result<(), InterpError> {
        const SHARES: [f32; 3] = [0.25, 0.5, 0.75];
        let found =
            self.at_ranks("beside", |count| SHARES.iter().map(|&share| evidence::rank(share, count)).collect())?;
        let lobes = Lobes::of_quantiles(|which, share| {
            let at = SHARES.iter().position(|&other| other == share)?;
            found.get(&(which as u32))?.1.get(at).copied()
        });
        self.write("lobes", 0, &lobes.map_or_else(Vec::new, |lobes| vec![lobes.distance, lobes.height]))
    }

    /// Links along the dip, the dips along surfaces, and samples of the noise.
    pub(crate) fn dips(&self, brick: usize) -> Result<(), InterpError> {
        let field = DipField::of_dips(self.size, self.read("field", 0)?);
        let (mut scratch, quiet) = (SmoothingScratch::default(), Progress::silent());
        for kind in 0..self.kinds.len() {
            let patch = self.patch(kind, brick, Halo::around(DIP_HALO), Values::All)?;
            let extrema = &patch.extrema;
            let mut dips = field.at_extrema(extrema, [patch.area.x.start, patch.area.y.start]);
            let links = mutual_links(extrema, &dips, GUIDED_REACH, &quiet)?;
            for scale in SCALES {
                dip::along_surfaces(extrema, &links, &mut dips, scale, &mut scratch, &quiet)?;
            }
            let steps: [f32; HEIGHT_CLASSES - 1] = self.read_array(&self.name("steps", kind))?;
            let (mut places, mut changes) = (Samples::default(), Samples::default());
            for (_, place, _) in
                patch.own_extrema().filter(|(.., index)| (*index as usize).is_multiple_of(evidence::SPARSE))
            {
                evidence::each_sample(extrema, &links, &dips, &steps, place, |[dip, height], [misfit, change]| {
                    places.push(dip, misfit);
                    changes.push(height * DIP_CLASSES + dip, change);
                });
            }
            self.keep_samples(&self.name("places", kind), brick, places)?;
            self.keep_samples(&self.name("changes", kind), brick, changes)?;
            self.keep("dips", &patch, &dips)?;
            self.keep_links(&patch, &links)?;
        }
        Ok(())
    }

    /// The noise of each kind.
    pub(crate) fn measure_noise(&self) -> Result<(), InterpError> {
        for kind in 0..self.kinds.len() {
            let medians = |array: &str| self.at_ranks(&self.name(array, kind), |count| vec![count / 2]);
            let (places, changes) = (medians("places")?, medians("changes")?);
            let median = |found: Option<&(usize, Vec<f32>)>| {
                found.map_or(Median::default(), |(count, values)| Median { count: *count, middle: values[0] })
            };
            let steps = self.read_array(&self.name("steps", kind))?;
            let noise = Noise::of_medians(
                steps,
                std::array::from_fn(|dip| median(places.get(&(dip as u32)))),
                |height, dip| median(changes.get(&((height * DIP_CLASSES + dip) as u32))),
            );
            self.write(&self.name("noise", kind), 0, &noise.to_numbers())?;
        }
        Ok(())
    }

    /// The noise that [`Bricks::measure_noise`] found.
    pub(crate) fn noise(&self, kind: usize) -> Result<Noise, InterpError> {
        let name = self.name("noise", kind);
        Noise::of_numbers(&self.read::<f32>(&name, 0)?).ok_or(InterpError::DamagedArray { array: name })
    }

    /// The whole of an array of one part that has N values.
    pub(crate) fn read_array<T: bytemuck::Pod, const N: usize>(&self, name: &str) -> Result<[T; N], InterpError> {
        self.read::<T>(name, 0)?.try_into().map_err(|_| InterpError::DamagedArray { array: name.to_owned() })
    }
}
