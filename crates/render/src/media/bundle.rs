//! Marches many rays through one volume side by side. This is the most frequent case, so it must be fast.
//!
//! The result is that of [`super::march::gather`] if there is only one medium
//! ([`super::field::MediaField::only_medium`]). The neighbouring rays of a bundle advance together, eight
//! samples of each at a time, so that they find in the cache what their neighbours have read. Each stage is a
//! short loop without branches over [`BATCH`] samples of several rays: positions, values, extinctions. Only
//! then does each ray composite its samples one by one.
//!
//! Empty space is looked up once per ray and eight samples. If the medium has a single colour c and is not
//! shaded, the result is a closed expression of a sum:
//!
//! ```text
//! T = exp(−Σ κᵢ·Δ)      C = c·(1 − T)
//! ```
//!
//! Otherwise the visible samples are first collected and then shaded. Voxel space and index space. The
//! position of a sample depends on its number alone, so the picture does not depend on what was skipped.

use super::Faces;
use super::Shading;
use super::bricks::{Bricks, SampleLine};
use super::field::MediaField;
use super::light::LightVolume;
use super::march::{Gathered, SPENT, gather};
use super::medium::{FieldMedium, Zone};
use super::phong::{LitSurfaces, half_way};
use super::samples::{BATCH, IndexPositions, NO_DATA_BELOW, VolumeSamples};
use super::stretches::stretches;
use super::table::absorbed;
use crate::visible::{Ray, Solid};
use glam::{Mat3, Vec3};
use system::wide::{Wide, widest};

/// Number of rays in a bundle.
pub(crate) const RAYS: usize = 64;
/// Number of samples that a ray takes at a time.
const LANES: usize = 8;
const NUMBERS: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Integrates the media along rays, each between two distances. Fast if neighbours in the list are neighbours
/// in the picture.
pub(crate) fn gather_all(
    field: &MediaField,
    light: Option<&LightVolume>,
    solid: &Solid,
    rays: &[(Ray, [f32; 2])],
) -> Vec<Gathered> {
    // Samples are addressed with 32 bits.
    match field.only_medium().filter(|medium| medium.volume.volume.all().len() < u32::MAX as usize) {
        None => rays.iter().map(|(ray, between)| gather(field, light, solid, ray, *between)).collect(),
        Some(medium) => {
            let mut gathered = Vec::with_capacity(rays.len());
            for rays in rays.chunks(RAYS) {
                let mut bundle = Bundle::new(field, medium, light, solid, rays);
                widest(March(&mut bundle));
                gathered.extend(bundle.walkers.iter().map(|walker| bundle.gathered(walker)));
            }
            gathered
        }
    }
}

/// The rays of a bundle, and what they march through.
struct Bundle<'b> {
    bricks: &'b Bricks,
    medium: &'b FieldMedium<'b>,
    samples: VolumeSamples<'b>,
    light: Option<&'b LightVolume>,
    shading: Shading,
    /// Direction to the light, in display space.
    towards_light: Vec3,
    /// The colour of the medium, if a sample needs nothing else.
    plain: Option<Vec3>,
    /// Map from differences per sample to normals in display space.
    normal: Mat3,
    /// Position in the word of a brick of the distance for this medium.
    shift: u32,
    walkers: Vec<Walker>,
    legs: Vec<Leg>,
}

/// The march of a bundle, as a loop for wide registers.
struct March<'m, 'b>(&'m mut Bundle<'b>);

impl Wide for March<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.march();
    }
}

/// A stretch of a ray through the medium.
struct Leg {
    /// Voxel position of the first sample, and the offset to the next.
    at: Vec3,
    per: Vec3,
    /// Number of samples, and the optical length of each.
    steps: u32,
    step: f32,
}

/// The state of a ray.
struct Walker {
    /// Half-way direction between those to the light and to the viewer.
    half: Vec3,
    /// Its remaining legs.
    legs: std::ops::Range<usize>,
    /// Voxel positions of the samples of the current leg.
    line: SampleLine,
    /// The first sample and the offset to the next, in index space.
    index: Vec3,
    index_per: Vec3,
    /// Number of the next sample, number of samples of the leg, and the optical length of each.
    n: u32,
    steps: u32,
    step: f32,
    /// Optical depth so far, if the medium has a single colour.
    depth: f32,
    gathered: Gathered,
}

/// Samples of several rays that are processed together.
struct Batch {
    places: IndexPositions,
    values: [f32; BATCH],
    entries: [u32; BATCH],
    extinctions: [f32; BATCH],
    /// The rays of the samples, [`LANES`] samples each, and how many of those are valid.
    walkers: [(usize, usize); BATCH / LANES],
    filled: usize,
    seen: [VisibleSample; BATCH],
    surfaces: LitSurfaces,
}

/// A visible sample.
#[derive(Clone, Copy, Default)]
struct VisibleSample {
    walker: usize,
    n: f32,
    entry: usize,
    /// Its weight in the colour of the ray.
    weight: f32,
}

impl<'b> Bundle<'b> {
    fn new(
        field: &'b MediaField,
        medium: &'b FieldMedium,
        light: Option<&'b LightVolume>,
        solid: &Solid,
        rays: &[(Ray, [f32; 2])],
    ) -> Self {
        let lit = matches!(field.shading, Shading::Phong(_));
        let plain = medium.table.uniform.filter(|_| light.is_none() && !lit);
        let mut legs = Vec::with_capacity(rays.len());
        let walkers = rays.iter().map(|(ray, between)| {
            let along = field.display_from_voxel * ray.direction;
            let metres = along.length();
            let units = metres / field.unit_m;
            let first = legs.len();
            stretches(solid, ray, *between, |stretch| {
                // The inside of rock whose faces are drawn is not visible.
                if stretch.zone == medium.zone && (stretch.zone == Zone::CutOut || field.faces != Faces::All) {
                    let [from, to] = stretch.t;
                    let steps = ((to - from) * units * field.samples_per_unit).ceil().max(1.0);
                    let step_t = (to - from) / steps;
                    let (at, per) = (ray.at(from + 0.5 * step_t), ray.direction * step_t);
                    legs.push(Leg { at, per, steps: steps as u32, step: step_t * units });
                }
            });
            let half = if lit { half_way(field.light, -along / metres) } else { Vec3::ZERO };
            Walker::new(half, first..legs.len())
        });
        let walkers = walkers.collect();
        Self {
            bricks: &field.bricks,
            medium,
            samples: medium.samples(),
            light,
            shading: field.shading,
            towards_light: field.light,
            plain: plain.map(Vec3::from_array),
            normal: field.display_normal_from_voxel * Mat3::from_diagonal(medium.index_from_voxel().0 * 0.5),
            shift: if medium.zone == Zone::CutOut { 8 } else { 0 },
            walkers,
            legs,
        }
    }

    fn gathered(&self, walker: &Walker) -> Gathered {
        match self.plain {
            None => walker.gathered,
            Some(colour) => {
                let covers = absorbed(walker.depth);
                Gathered { colour: colour * covers, transmittance: 1.0 - covers }
            }
        }
    }

    /// Marches all rays to their ends.
    #[inline(always)]
    fn march(&mut self) {
        let mut batch = Batch::new();
        let mut walking: Vec<usize> = (0..self.walkers.len()).collect();
        let mut on = Vec::with_capacity(walking.len());
        while !walking.is_empty() {
            let mut left = walking.iter();
            loop {
                batch.filled = 0;
                for &walker in left.by_ref() {
                    if self.walkers[walker].advance(self.bricks, self.shift, self.medium, &self.legs) {
                        batch.push(walker, &self.walkers[walker]);
                        if batch.filled == batch.walkers.len() {
                            break;
                        }
                    }
                }
                if batch.filled == 0 {
                    break;
                }
                batch.read(&self.samples, self.medium);
                if self.plain.is_some() {
                    self.sum(&batch, &mut on);
                } else {
                    self.collect(&mut batch, &mut on);
                }
            }
            std::mem::swap(&mut walking, &mut on);
            on.clear();
        }
    }

    /// Adds optical depths.
    #[inline(always)]
    fn sum(&mut self, batch: &Batch, on: &mut Vec<usize>) {
        // The optical depth at which a ray ends.
        let spent = -SPENT.ln();
        for (extinctions, &(index, count)) in batch.extinctions.chunks_exact(LANES).zip(&batch.walkers[..batch.filled])
        {
            let walker = &mut self.walkers[index];
            walker.n += count as u32;
            let mut depths = [walker.depth; LANES];
            let mut depth = walker.depth;
            for (lane, extinction) in extinctions.iter().enumerate() {
                depth += if lane < count { extinction * walker.step } else { 0.0 };
                depths[lane] = depth;
            }
            // A ray ends at the first sample behind which nothing is visible.
            let ended = depth >= spent;
            walker.depth =
                if ended { depths.into_iter().find(|depth| *depth >= spent).unwrap_or(depth) } else { depth };
            if !ended {
                on.push(index);
            }
        }
    }

    /// Collects the visible samples and shades them.
    #[inline(always)]
    fn collect(&mut self, batch: &mut Batch, on: &mut Vec<usize>) {
        let mut found = 0;
        for (slot, &(index, count)) in batch.walkers[..batch.filled].iter().enumerate() {
            let walker = &mut self.walkers[index];
            let lanes = slot * LANES..(slot + 1) * LANES;
            let mut alphas = [0.0f32; LANES];
            for (alpha, extinction) in alphas.iter_mut().zip(&batch.extinctions[lanes.clone()]) {
                // Exactly 0 for invisible samples, so that the result does not depend on what is skipped.
                *alpha = if *extinction > 0.0 { absorbed(extinction * walker.step) } else { 0.0 };
            }
            let mut transmittance = walker.gathered.transmittance;
            let mut ended = false;
            for (lane, alpha) in alphas[..count].iter().enumerate() {
                let weight = alpha * transmittance;
                // Always written but only counted if visible, to avoid a branch.
                batch.seen[found] = VisibleSample {
                    walker: index,
                    n: (walker.n + lane as u32) as f32,
                    entry: batch.entries[lanes.start + lane] as usize,
                    weight,
                };
                found += usize::from(batch.extinctions[lanes.start + lane] > 0.0);
                transmittance *= 1.0 - alpha;
                if transmittance <= SPENT {
                    ended = true;
                    break;
                }
            }
            walker.gathered.transmittance = transmittance;
            walker.n += count as u32;
            if !ended {
                on.push(index);
            }
        }
        let seen = &batch.seen[..found];
        if let Shading::Phong(phong) = self.shading {
            for (n, seen) in seen.iter().enumerate() {
                let walker = &self.walkers[seen.walker];
                let differences = self.samples.differences(walker.index + walker.index_per * seen.n);
                let normal = self.normal * differences;
                [batch.surfaces.normals[0][n], batch.surfaces.normals[1][n], batch.surfaces.normals[2][n]] =
                    normal.to_array();
                [batch.surfaces.halves[0][n], batch.surfaces.halves[1][n], batch.surfaces.halves[2][n]] =
                    walker.half.to_array();
            }
            batch.surfaces.light(&phong, self.towards_light);
        }
        for (n, seen) in seen.iter().enumerate() {
            let walker = &mut self.walkers[seen.walker];
            let [r, g, b, _] = self.medium.table.entries[seen.entry];
            let mut colour = Vec3::new(r, g, b);
            if matches!(self.shading, Shading::Phong(_)) {
                colour = colour * batch.surfaces.factor[n] + batch.surfaces.white[n];
            }
            if let Some(light) = self.light {
                colour *= light.at(walker.line.at + walker.line.per * seen.n);
            }
            walker.gathered.colour += colour * seen.weight;
        }
    }
}

impl Walker {
    fn new(half: Vec3, legs: std::ops::Range<usize>) -> Self {
        Self {
            half,
            legs,
            line: SampleLine::default(),
            index: Vec3::ZERO,
            index_per: Vec3::ZERO,
            n: 0,
            steps: 0,
            step: 0.0,
            depth: 0.0,
            gathered: Gathered::default(),
        }
    }

    /// Advances to the next sample in a visible brick; returns false if there is none.
    #[inline(always)]
    fn advance(&mut self, bricks: &Bricks, shift: u32, medium: &FieldMedium, legs: &[Leg]) -> bool {
        loop {
            self.n = bricks.first_shown(&self.line, self.n, self.steps, shift);
            if self.n < self.steps {
                return true;
            }
            let Some(leg) = self.legs.next() else { return false };
            self.begin(&legs[leg], medium);
        }
    }

    fn begin(&mut self, leg: &Leg, medium: &FieldMedium) {
        let (scale, offset) = medium.index_from_voxel();
        self.line = SampleLine::new(leg.at, leg.per);
        self.index = leg.at * scale + offset;
        self.index_per = leg.per * scale;
        self.n = 0;
        self.steps = leg.steps;
        self.step = leg.step;
    }
}

impl Batch {
    fn new() -> Self {
        Self {
            places: IndexPositions::default(),
            values: [0.0; BATCH],
            entries: [0; BATCH],
            extinctions: [0.0; BATCH],
            walkers: [(0, 0); BATCH / LANES],
            filled: 0,
            seen: [VisibleSample::default(); BATCH],
            surfaces: LitSurfaces::new(),
        }
    }

    /// Adds the next samples of a ray.
    #[inline(always)]
    fn push(&mut self, index: usize, walker: &Walker) {
        let start = self.filled * LANES;
        let first = walker.n as f32;
        for (axis, places) in self.places.axes.iter_mut().enumerate() {
            let (at, per) = (walker.index[axis], walker.index_per[axis]);
            for (place, lane) in places[start..start + LANES].iter_mut().zip(NUMBERS) {
                *place = at + per * (first + lane);
            }
        }
        self.walkers[self.filled] = (index, LANES.min((walker.steps - walker.n) as usize));
        self.filled += 1;
    }

    /// Reads the values and extinctions of the samples.
    #[inline(always)]
    fn read(&mut self, samples: &VolumeSamples, medium: &FieldMedium) {
        let count = self.filled * LANES;
        samples.values(&self.places, count, &mut self.values);
        let table = &medium.table;
        table.entries_of(&self.values, &mut self.entries);
        for n in 0..count {
            let extinction = table.extinctions[self.entries[n] as usize];
            self.extinctions[n] = if self.values[n] < NO_DATA_BELOW { 0.0 } else { extinction };
        }
    }
}

#[cfg(test)]
mod tests;
