//! Many rays through one volume side by side: the case that has to be quick.
//!
//! What [`super::march::gather`] gathers, where one medium is all there is ([`super::field::Field::alone`]). A bundle of neighbouring rays advances
//! together, eight samples of each at a time, so that they find in the cache what their neighbours read, and each stage is a short loop over
//! [`BATCH`] samples of several rays, without a branch: places, values, extinctions. Only then does each ray take up what it met, sample by sample.
//!
//! Empty space is asked for once per ray and eight samples. Where the medium has one colour c and no light falls on it, a ray is a sum:
//!
//! ```text
//! T = exp(−Σ κᵢ·Δ)      C = c·(1 − T)
//! ```
//!
//! Otherwise samples that show something are first collected, then lit. Voxel space and index space; every sample is placed by its number alone, so that the
//! picture does not depend on what was skipped.

use super::Faces;
use super::Shading;
use super::bricks::{Bricks, Line};
use super::field::Field;
use super::light::LightVolume;
use super::lit::{Surfaces, half_way};
use super::march::{Gathered, SPENT, gather};
use super::medium::{FieldMedium, Place};
use super::samples::{BATCH, Places, Samples};
use super::stretches::stretches;
use super::table::{NO_DATA_BELOW, absorbed};
use super::wide::{Loops, widest};
use crate::visible::{Ray, Solid};
use glam::{Mat3, Vec3};

/// Rays of a bundle.
pub const RAYS: usize = 64;
/// Samples that a ray takes at a time.
const LANES: usize = 8;
const NUMBERS: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Gathers what rays meet between two distances each; quick where neighbours in the list are neighbours in the picture.
pub fn gather_all(
    field: &Field,
    light: Option<&LightVolume>,
    solid: &Solid,
    rays: &[(Ray, [f32; 2])],
) -> Vec<Gathered> {
    // Places are counted in 32 bits.
    match field.alone().filter(|medium| medium.volume.volume.samples().len() < u32::MAX as usize) {
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

/// A few rays on their way.
struct Bundle<'b> {
    bricks: &'b Bricks,
    medium: &'b FieldMedium<'b>,
    samples: Samples<'b>,
    light: Option<&'b LightVolume>,
    shading: Shading,
    /// The direction to the light of surfaces, in display space.
    towards_light: Vec3,
    /// The medium's colour, where that is all there is to know of a sample.
    plain: Option<Vec3>,
    /// Differences per sample → normal in display space.
    normal: Mat3,
    /// Where in a brick's word the medium's distance is.
    shift: u32,
    walkers: Vec<Walker>,
    legs: Vec<Leg>,
}

/// A bundle's way.
struct March<'m, 'b>(&'m mut Bundle<'b>);

impl Loops for March<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.march();
    }
}

/// A stretch of a ray through the medium.
struct Leg {
    /// Voxel position of the first sample and the way to the next.
    at: Vec3,
    per: Vec3,
    /// Samples, and their optical length.
    steps: u32,
    step: f32,
}

/// A ray and how far it is.
struct Walker {
    /// Between the directions to the light and to the viewer.
    half: Vec3,
    /// Its legs that are still to come.
    legs: std::ops::Range<usize>,
    /// Voxel positions of the leg's samples.
    line: Line,
    /// The first and the way to the next in index space.
    index: Vec3,
    index_per: Vec3,
    /// Next sample, samples of the leg, and their optical length.
    n: u32,
    steps: u32,
    step: f32,
    /// Optical depth so far, where the medium is plain.
    depth: f32,
    gathered: Gathered,
}

/// Samples of several rays.
struct Batch {
    places: Places,
    values: [f32; BATCH],
    entries: [u32; BATCH],
    extinctions: [f32; BATCH],
    /// The rays they are of, [`LANES`] samples each, and how many of those count.
    walkers: [(usize, usize); BATCH / LANES],
    filled: usize,
    seen: [Seen; BATCH],
    surfaces: Surfaces,
}

/// A sample that shows something.
#[derive(Clone, Copy, Default)]
struct Seen {
    walker: usize,
    n: f32,
    entry: usize,
    /// What of its light arrives.
    weight: f32,
}

impl<'b> Bundle<'b> {
    fn new(
        field: &'b Field,
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
                // Rock that is drawn as faces is not looked into.
                if stretch.place == medium.place && (stretch.place == Place::CutOut || field.faces != Faces::All) {
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
            shift: if medium.place == Place::CutOut { 8 } else { 0 },
            walkers,
            legs,
        }
    }

    fn gathered(&self, walker: &Walker) -> Gathered {
        match self.plain {
            None => walker.gathered,
            Some(colour) => {
                let covers = absorbed(walker.depth);
                Gathered { colour: colour * covers, passes: 1.0 - covers }
            }
        }
    }

    /// Follows all rays to their ends.
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

    /// Adds up optical depths.
    #[inline(always)]
    fn sum(&mut self, batch: &Batch, on: &mut Vec<usize>) {
        // The depth behind which less than the last light arrives.
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
            // A ray ends at the first sample behind which nothing is seen.
            let ended = depth >= spent;
            walker.depth =
                if ended { depths.into_iter().find(|depth| *depth >= spent).unwrap_or(depth) } else { depth };
            if !ended {
                on.push(index);
            }
        }
    }

    /// Collects what shows, and lights it.
    #[inline(always)]
    fn collect(&mut self, batch: &mut Batch, on: &mut Vec<usize>) {
        let mut found = 0;
        for (slot, &(index, count)) in batch.walkers[..batch.filled].iter().enumerate() {
            let walker = &mut self.walkers[index];
            let lanes = slot * LANES..(slot + 1) * LANES;
            let mut alphas = [0.0f32; LANES];
            for (alpha, extinction) in alphas.iter_mut().zip(&batch.extinctions[lanes.clone()]) {
                // Exactly nothing where nothing shows, whatever is skipped.
                *alpha = if *extinction > 0.0 { absorbed(extinction * walker.step) } else { 0.0 };
            }
            let mut passes = walker.gathered.passes;
            let mut ended = false;
            for (lane, alpha) in alphas[..count].iter().enumerate() {
                let weight = alpha * passes;
                // Written in any case, counted if it shows: no branch.
                batch.seen[found] = Seen {
                    walker: index,
                    n: (walker.n + lane as u32) as f32,
                    entry: batch.entries[lanes.start + lane] as usize,
                    weight,
                };
                found += usize::from(batch.extinctions[lanes.start + lane] > 0.0);
                passes *= 1.0 - alpha;
                if passes <= SPENT {
                    ended = true;
                    break;
                }
            }
            walker.gathered.passes = passes;
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
            line: Line::default(),
            index: Vec3::ZERO,
            index_per: Vec3::ZERO,
            n: 0,
            steps: 0,
            step: 0.0,
            depth: 0.0,
            gathered: Gathered::default(),
        }
    }

    /// Goes on to the next sample in a brick that shows something; false where there is none.
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
        self.line = Line::new(leg.at, leg.per);
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
            places: Places::default(),
            values: [0.0; BATCH],
            entries: [0; BATCH],
            extinctions: [0.0; BATCH],
            walkers: [(0, 0); BATCH / LANES],
            filled: 0,
            seen: [Seen::default(); BATCH],
            surfaces: Surfaces::new(),
        }
    }

    /// The next samples of a ray.
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

    /// Values and extinctions of its samples.
    #[inline(always)]
    fn read(&mut self, samples: &Samples, medium: &FieldMedium) {
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
