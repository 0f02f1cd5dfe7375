//! The structural model: sheets, faults and contact rules together.

use super::contacts::ContactRules;
use super::lattice::MarginLattice;
use super::levels::{LevelSources, LevelSurface};
use super::network::FaultNetwork;
use super::nodes::{HorizonNodes, gather};
use super::order::{self, keep_order};
use super::report::{ModelError, ModelNote, ModelReport};
use super::settings::ModelSettings;
use super::sheets::{BlockPicks, ExtendedSheet, extend_all};
use super::sides::{Below, MOST_HORIZONS};
use glam::{DMat3, Vec3};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use survey::LevelField;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::height_field::HeightField;
use survey::horizon::{Horizon, Quality};
use survey::progress::Progress;
use survey::stratigraphy::{Contact, Stratigraphy};

/// The part of a layer that lies inside one fault block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Region {
    /// Layer, 0 = deepest.
    pub layer: u16,
    /// Fault block.
    pub block: u16,
}

/// A structural model: the extended sheets of the horizons, the faults and the contact rules. It names the
/// layer and the fault block at any position.
///
/// # Examples
/// Two parallel horizons, 10 and 20 samples deep in the middle of the survey, that dip by 20 degrees:
/// ```
/// use glam::Vec3;
/// use model::{ModelSettings, Region, StructuralModel};
/// use survey::geometry::{SurveyGeometry, VerticalUnit};
/// use survey::progress::Progress;
/// use synth::closed_form::ClosedForm;
///
/// let geometry = SurveyGeometry::regular([11, 11, 40], 25.0, 10.0, VerticalUnit::Metres);
/// let form = ClosedForm::dipping(&geometry, &[10.0, 20.0], 20.0, 0.0);
/// let model = StructuralModel::build(
///     &geometry,
///     &form.stratigraphy,
///     &form.horizons,
///     &form.faults,
///     &ModelSettings::default(),
///     &Progress::silent(),
/// )?;
/// assert_eq!((model.layer_count(), model.block_count()), (3, 1));
/// // Between the horizons lies layer 1; layers are counted from the deepest.
/// assert_eq!(model.region_at(Vec3::new(5.0, 5.0, 15.0)), Region { layer: 1, block: 0 });
/// // The plane is exact between nodes, too.
/// let exact = form.sheet_z(0, 0, 7.5, 3.25) as f32;
/// assert!((model.horizon_z(0, 0, 7.5, 3.25) - exact).abs() < 1e-3);
/// # Ok::<(), model::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct StructuralModel {
    size: [usize; 3],
    metric: DMat3,
    stratigraphy: Stratigraphy,
    rules: ContactRules,
    faults: FaultNetwork,
    /// `[horizon][block]`; the topmost part of a horizon that is no height field.
    sheets: Vec<Vec<ExtendedSheet>>,
    /// `[horizon][block]`; `None` for height fields.
    levels: Vec<Vec<Option<LevelSurface>>>,
    /// Of each block, for finding the sheets near a depth.
    depths: Vec<SheetDepths>,
    report: ModelReport,
}

/// The most that the absolute weights of the 4 × 4 nodes around a place add up to: (1 + 1/4)², halfway between nodes.
const MOST_WEIGHT: f32 = 1.5625;

/// Between which depths a sheet lies where nodes surround a place.
fn span(sheet: &ExtendedSheet) -> [f32; 2] {
    let z = &sheet.field.z;
    let low = z.iter().copied().fold(f32::INFINITY, f32::min);
    let high = z.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    // A little more than it can be, for rounding.
    let (middle, reach) =
        (0.5 * (low + high), 0.5 * MOST_WEIGHT * (high - low) + 1e-3 * (1.0 + high.abs().max(low.abs())));
    [middle - reach, middle + reach]
}

/// How deep the sheets of a block reach, so that of many only those near a place are evaluated.
#[derive(Debug, Clone, PartialEq)]
struct SheetDepths {
    /// The greatest depth of each horizon and all younger ones.
    deepest: Vec<f32>,
    /// The least depth of each horizon and all older ones.
    highest: Vec<f32>,
}

impl SheetDepths {
    /// Of spans, youngest first.
    fn new(spans: &[[f32; 2]]) -> Self {
        let mut deepest: Vec<f32> = spans.iter().map(|span| span[1]).collect();
        let mut highest: Vec<f32> = spans.iter().map(|span| span[0]).collect();
        for h in 1..spans.len() {
            deepest[h] = deepest[h].max(deepest[h - 1]);
        }
        for h in (1..spans.len()).rev() {
            highest[h - 1] = highest[h - 1].min(highest[h]);
        }
        Self { deepest, highest }
    }

    /// The horizons that a depth may be above or below: it lies below all before them, and above all after them.
    fn around(&self, z: f32) -> Range<usize> {
        self.deepest.partition_point(|deepest| *deepest < z)..self.highest.partition_point(|highest| *highest <= z)
    }
}

impl StructuralModel {
    /// Builds the model of an interpretation. Horizons are looked up by the names in the stratigraphy.
    ///
    /// # Errors
    /// [`ModelError`] says what is wrong and what to change.
    pub fn build(
        geometry: &SurveyGeometry,
        stratigraphy: &Stratigraphy,
        horizons: &[Horizon],
        faults: &[Fault],
        settings: &ModelSettings,
        progress: &Progress,
    ) -> Result<Self, ModelError> {
        geometry.validate()?;
        let ordered = in_order(stratigraphy, horizons)?;
        let mut report = ModelReport::default();
        for horizon in horizons.iter().filter(|h| !ordered.iter().any(|o| o.name == h.name)) {
            report.notes.push(ModelNote::Ignored { horizon: horizon.name.clone() });
        }
        let faults = FaultNetwork::build(geometry, faults, progress)?;
        let size = geometry.size();
        report.notes.extend(faults.crossing_note(geometry));
        report.notes.extend(faults.left_out_note(geometry.size()));
        let lattice = MarginLattice::with_margin(size, settings.margin_for(size));
        let rules = ContactRules::new(stratigraphy);
        let given = LevelSources { geometry, horizons: &ordered, contacts: rules.contacts(), faults: &faults };
        let levels = given.levels(progress)?;
        report.notes.extend(levels.notes);
        let is_field = |h: &usize| levels.surfaces[*h].iter().all(Option::is_none);
        let fields: Vec<usize> = (0..ordered.len()).filter(is_field).collect();
        progress.begin("nodes", fields.len() as u64);
        let mut nodes = Vec::with_capacity(fields.len());
        for horizon in fields.iter().map(|&h| ordered[h]) {
            let found = gather(geometry, lattice, horizon, &faults, settings, &mut report);
            if found.nodes.is_empty() {
                let HorizonNodes { outside, holes, .. } = found;
                return Err(ModelError::EmptyHorizon { name: horizon.name.clone(), outside, holes });
            }
            if found.outside > 0 {
                report.notes.push(ModelNote::Outside { horizon: horizon.name.clone(), nodes: found.outside });
            }
            nodes.push(found);
            progress.step(1)?;
        }
        let names: Vec<&str> = fields.iter().map(|&h| ordered[h].name.as_str()).collect();
        let (mut sheets, placed) = extend_all(lattice, &names, &nodes, &faults, size[2], settings, progress)?;
        report.notes.extend(placed);
        report.notes.extend(extended(lattice, &names, &sheets, &faults));
        let among = rules.among(&fields);
        report.notes.extend(keep_order(geometry, lattice, &among, &names, &mut sheets, settings, &faults)?);
        // The others stand among them with their topmost part.
        for (h, surfaces) in levels.surfaces.iter().enumerate().filter(|(h, _)| !fields.contains(h)) {
            let below = 2.0 * size[2] as f32;
            let top = |level: &LevelSurface| {
                ExtendedSheet::of_level(lattice, level.top(lattice.origin, lattice.size, below), level.own)
            };
            sheets.insert(h, surfaces.par_iter().flatten().map(top).collect());
        }
        let depths = depths_of(&sheets, &levels.surfaces, faults.block_count());
        Ok(Self {
            size,
            metric: geometry.metric_from_voxel(),
            stratigraphy: stratigraphy.clone(),
            rules,
            faults,
            sheets,
            levels: levels.surfaces,
            depths,
            report,
        })
    }

    /// Whether picks of horizons that are height fields make a model among the blocks of `faults`: what
    /// [`StructuralModel::build`] would refuse of them is refused here, at a small share of its cost. Notes what it would
    /// resolve.
    ///
    /// # Errors
    /// [`ModelError`] says what is wrong and what to change.
    pub fn check_picks(
        geometry: &SurveyGeometry,
        stratigraphy: &Stratigraphy,
        horizons: &[Horizon],
        faults: &FaultNetwork,
        settings: &ModelSettings,
    ) -> Result<Vec<ModelNote>, ModelError> {
        geometry.validate()?;
        let ordered = in_order(stratigraphy, horizons)?;
        let size = geometry.size();
        let lattice = MarginLattice::with_margin(size, settings.margin_for(size));
        let found =
            |horizon: &&Horizon| gather(geometry, lattice, horizon, faults, settings, &mut ModelReport::default());
        let nodes: Vec<HorizonNodes> = ordered.par_iter().map(found).collect();
        if let Some((found, horizon)) = nodes.iter().zip(&ordered).find(|(found, _)| found.nodes.is_empty()) {
            let HorizonNodes { outside, holes, .. } = *found;
            return Err(ModelError::EmptyHorizon { name: horizon.name.clone(), outside, holes });
        }
        let fewest = BlockPicks::fewest(faults, settings);
        let blocks = 0..faults.block_count();
        let of_horizon = |found: &HorizonNodes| -> Vec<Option<BlockPicks>> {
            blocks.clone().map(|b| BlockPicks::of(lattice, &found.nodes, faults, b, fewest)).collect()
        };
        let picks: Vec<Vec<Option<BlockPicks>>> = nodes.par_iter().map(of_horizon).collect();
        let nothing = (vec![f32::NAN; lattice.len()], vec![false; lattice.len()]);
        let of_block = |found| -> order::Picks<'_> {
            // What was stated past the end of the picks gives way to others.
            Option::<&BlockPicks>::map_or(found, (&nothing.0, &nothing.1), |found| (&found.z, &found.fixed))
        };
        let picks: Vec<Vec<_>> =
            picks.iter().map(|of| of.iter().map(|found| of_block(found.as_ref())).collect()).collect();
        let names: Vec<&str> = ordered.iter().map(|horizon| horizon.name.as_str()).collect();
        order::check(geometry, lattice, &ContactRules::new(stratigraphy), &names, &picks, settings)
    }

    /// Voxels of the volume, `[inlines, crosslines, samples]`.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// The linear part of the map from voxel to metric space, m per voxel.
    pub fn metric(&self) -> DMat3 {
        self.metric
    }

    /// Number of layers: one more than there are horizons.
    pub fn layer_count(&self) -> usize {
        self.stratigraphy.layer_count()
    }

    /// Number of fault blocks, at least 1.
    pub fn block_count(&self) -> usize {
        self.faults.block_count()
    }

    /// The age order and the contacts of the horizons.
    pub fn stratigraphy(&self) -> &Stratigraphy {
        &self.stratigraphy
    }

    /// The contact rules, ready to be applied to sheets.
    pub fn rules(&self) -> &ContactRules {
        &self.rules
    }

    /// The faults and the blocks between them.
    pub fn faults(&self) -> &FaultNetwork {
        &self.faults
    }

    /// The surface of `horizon` in `block` if it is no height field: it has an overturned limb, encloses a body, or was
    /// made of the points of a whole series.
    pub fn level(&self, horizon: usize, block: u16) -> Option<&LevelSurface> {
        self.levels[horizon][usize::from(block)].as_ref()
    }

    /// Whether any horizon is no height field.
    pub fn has_levels(&self) -> bool {
        self.levels.iter().flatten().any(Option::is_some)
    }

    /// Whether `horizon` is the outline of a body that cuts through all others.
    pub fn is_body(&self, horizon: usize) -> bool {
        self.rules.contacts()[horizon].is_intrusive() && self.levels[horizon].iter().any(Option::is_some)
    }

    /// Offset of voxel position `p` from the unclipped surface of `horizon` in `block`, positive below it, on its older
    /// side or inside the body: voxels for a height field (vertical), about metres otherwise.
    pub fn offset(&self, horizon: usize, block: u16, p: Vec3) -> f32 {
        match self.level(horizon, block) {
            Some(level) => level.offset_m(p),
            None => p.z - self.sheet(horizon, block).z_at(p.x, p.y),
        }
    }

    /// The extended, unclipped sheet of `horizon` (0 = youngest) in `block`. Where the horizon is no height field
    /// ([`StructuralModel::level`]), its topmost part, and twice the depth of the volume where it has none.
    pub fn sheet(&self, horizon: usize, block: u16) -> &HeightField {
        &self.sheets[horizon][usize::from(block)].field
    }

    /// Whether the sheet of `horizon` in `block` was picked, filled or extrapolated at voxel (x, y).
    pub fn quality_at(&self, horizon: usize, block: u16, x: f32, y: f32) -> Quality {
        let sheet = &self.sheets[horizon][usize::from(block)];
        let HeightField { origin, size, .. } = sheet.field;
        let node = |c: f32, axis: usize| (c.round() as i32 - origin[axis]).clamp(0, size[axis] as i32 - 1) as usize;
        sheet.quality[node(x, 0) * size[1] + node(y, 1)]
    }

    /// Number of interpreted nodes that `horizon` has in `block`; 0 when it was placed there without data.
    #[cfg(test)]
    pub(crate) fn own_nodes(&self, horizon: usize, block: u16) -> usize {
        self.sheets[horizon][usize::from(block)].own
    }

    /// The block at voxel position `p`.
    pub fn block_at(&self, p: Vec3) -> u16 {
        self.faults.block_at(p)
    }

    /// The layer at voxel position `p` according to the sheets of `block`, with the contact rules applied.
    pub fn layer_at(&self, p: Vec3, block: u16) -> u16 {
        self.rules.layer(&self.below_at(p, block))
    }

    /// Which unclipped surfaces of horizons in `block` voxel position `p` lies at or below, on their older side, or
    /// inside their body.
    pub fn below_at(&self, p: Vec3, block: u16) -> Below {
        let mut last: Option<(&Arc<LevelField>, f32)> = None;
        let mut is_below = |h: usize| match self.level(h, block) {
            None => p.z >= self.sheet(h, block).z_at(p.x, p.y),
            // Horizons of one series share their field.
            Some(level) => match last {
                Some((field, value)) if Arc::ptr_eq(field, &level.field) => value >= level.at,
                _ => {
                    let value = level.field.value(p);
                    last = Some((&level.field, value));
                    value >= level.at
                }
            },
        };
        let around = self.horizons_around(p, block);
        let mut below = Below::youngest(around.start);
        for h in around {
            below.set(h, is_below(h));
        }
        below
    }

    /// The horizons that a place may be above or below according to their depths alone. All sheets have the same nodes,
    /// which bound them only where they surround the place.
    fn horizons_around(&self, p: Vec3, block: u16) -> Range<usize> {
        match self.sheets.first() {
            Some(sheets) if sheets[usize::from(block)].field.surrounds(p.x, p.y) => {
                self.depths[usize::from(block)].around(p.z)
            }
            _ => 0..self.sheets.len(),
        }
    }

    /// Layer and block at voxel position `p`.
    pub fn region_at(&self, p: Vec3) -> Region {
        let block = self.block_at(p);
        Region { layer: self.layer_at(p, block), block }
    }

    /// The horizon that bounds the body in which a voxel position of `block` lies.
    pub fn body_at(&self, p: Vec3, block: u16) -> Option<usize> {
        if !self.has_levels() {
            return None;
        }
        self.stratigraphy.top_of(usize::from(self.layer_at(p, block))).filter(|top| self.is_body(*top))
    }

    /// Whether a voxel position of `block` lies in a body that cuts everything, erosion surfaces and faults too.
    pub fn is_pierced_at(&self, p: Vec3, block: u16) -> bool {
        self.body_at(p, block).is_some_and(|horizon| self.rules.contacts()[horizon] == Contact::Intrusive)
    }

    /// Whether the layers on the two sides of a horizon differ at a place of `block` where it comes to the surface of the
    /// youngest horizon: they do not where something else has cut it off.
    pub fn crops_out_at(&self, horizon: usize, p: Vec3, block: u16) -> bool {
        // The place is rock, just below the surface.
        let below = self.below_at(p, block).with(0, true);
        let layer = |is_below: bool| self.rules.layer(&below.with(horizon, is_below));
        layer(true) != layer(false) && self.block_at(p) == block
    }

    /// [`StructuralModel::region_at`] at every depth (voxel z) of the trace at (x, y), in order: `found(n,
    /// region)` for `depths[n]`. The sheets are evaluated once per block instead of once per depth.
    pub fn regions_down(&self, x: f32, y: f32, depths: &[f32], mut found: impl FnMut(usize, Region)) {
        let has_levels = self.has_levels();
        let mut sheets_z: Vec<Option<Vec<f32>>> = vec![None; self.block_count()];
        for (n, &z) in depths.iter().enumerate() {
            let p = Vec3::new(x, y, z);
            let block = self.block_at(p);
            if has_levels {
                found(n, Region { layer: self.layer_at(p, block), block });
                continue;
            }
            let sheets_z = sheets_z[usize::from(block)]
                .get_or_insert_with(|| (0..self.sheets.len()).map(|h| self.sheet(h, block).z_at(x, y)).collect());
            let around = self.horizons_around(p, block);
            let mut below = Below::youngest(around.start);
            for h in around {
                below.set(h, z >= sheets_z[h]);
            }
            found(n, Region { layer: self.rules.layer(&below), block });
        }
    }

    /// Height of `horizon` in `block` as it is drawn, voxel z: cut by the contact rules, so that a horizon
    /// which has ended lies on the one it ended at. Of a horizon that is no height field, the topmost part; bodies cut
    /// nothing here.
    pub fn horizon_z(&self, horizon: usize, block: u16, x: f32, y: f32) -> f32 {
        let z_of = |h: usize| self.sheet(h, block).z_at(x, y);
        let contacts = self.rules.contacts();
        if self.is_body(horizon) {
            let is_eroded = |h: &usize| contacts[horizon] == Contact::Truncated && contacts[*h] == Contact::Erosional;
            return (0..horizon).filter(is_eroded).map(z_of).fold(z_of(horizon), f32::max);
        }
        let tangled = self.tangled(horizon, block, x, y);
        let mut z: Vec<f32> = tangled.clone().map(|h| if self.is_body(h) { f32::MAX } else { z_of(h) }).collect();
        self.rules.clip_some(tangled.start, &mut z);
        z[horizon - tangled.start]
    }

    /// The horizons around one that may cut each other at a place: the younger ones lie above all of these, the older ones
    /// below.
    fn tangled(&self, horizon: usize, block: u16, x: f32, y: f32) -> Range<usize> {
        if self.rules.has_intrusions() || !self.sheet(horizon, block).surrounds(x, y) {
            return 0..self.sheets.len();
        }
        let z_of = |h: usize| self.sheet(h, block).z_at(x, y);
        let depths = &self.depths[usize::from(block)];
        let [mut low, mut high] = [z_of(horizon); 2];
        let mut found = horizon..horizon + 1;
        loop {
            let first = (depths.around(low).start..found.start).find(|h| z_of(*h) >= low).unwrap_or(found.start);
            let last = (found.end..depths.around(high).end).rev().find(|h| z_of(*h) <= high);
            let wider = first..last.map_or(found.end, |h| h + 1);
            if wider == found {
                return found;
            }
            for z in wider.clone().map(z_of) {
                (low, high) = (low.min(z), high.max(z));
            }
            found = wider;
        }
    }

    /// What was filled, extended, placed and clamped.
    pub fn report(&self) -> &ModelReport {
        &self.report
    }
}

/// The depths of each block's sheets, of `[horizon][block]`.
fn depths_of(sheets: &[Vec<ExtendedSheet>], levels: &[Vec<Option<LevelSurface>>], blocks: usize) -> Vec<SheetDepths> {
    let of_block = |block: usize| {
        let spans = sheets.iter().zip(levels).map(|(sheets, levels)| match levels[block] {
            None => span(&sheets[block]),
            Some(_) => [f32::NEG_INFINITY, f32::INFINITY],
        });
        SheetDepths::new(&spans.collect::<Vec<_>>())
    };
    (0..blocks).map(of_block).collect()
}

/// The horizons of the stratigraphy, youngest first.
fn in_order<'a>(stratigraphy: &Stratigraphy, horizons: &'a [Horizon]) -> Result<Vec<&'a Horizon>, ModelError> {
    let found = stratigraphy.horizons.len();
    if found > MOST_HORIZONS {
        return Err(ModelError::TooMany { what: "horizons", found, limit: MOST_HORIZONS });
    }
    for (i, named) in stratigraphy.horizons.iter().enumerate() {
        let given = horizons.iter().filter(|h| h.name == named.name).count();
        if given > 1 || stratigraphy.horizons[..i].iter().any(|h| h.name == named.name) {
            return Err(ModelError::DuplicateName { what: "horizons", name: named.name.clone() });
        }
    }
    stratigraphy
        .horizons
        .iter()
        .map(|named| {
            let horizon = horizons.iter().find(|h| h.name == named.name);
            horizon.ok_or_else(|| ModelError::MissingHorizon { name: named.name.clone() })
        })
        .collect()
}

/// A note for each sheet that was continued by more than a few nodes inside its own block and the volume.
fn extended(
    lattice: MarginLattice,
    names: &[&str],
    sheets: &[Vec<ExtendedSheet>],
    faults: &FaultNetwork,
) -> Vec<ModelNote> {
    let jobs: Vec<(usize, usize)> = (0..sheets.len()).flat_map(|h| (0..sheets[h].len()).map(move |b| (h, b))).collect();
    let count = |&(h, b): &(usize, usize)| {
        let sheet = &sheets[h][b];
        if sheet.own == 0 {
            return 0;
        }
        let near = sheet.near_data(lattice);
        let bare = |&n: &usize| !near[n] && lattice.is_inside(n);
        let own = |&n: &usize| faults.holds(b as u16, lattice.place(n, sheet.field.z[n]));
        (0..lattice.len()).filter(bare).filter(own).count()
    };
    let traces: Vec<usize> = jobs.par_iter().map(count).collect();
    let note = |(&(h, b), traces): (&(usize, usize), usize)| {
        (traces > 0).then(|| ModelNote::Extended { horizon: names[h].to_owned(), block: b as u16, traces })
    };
    jobs.iter().zip(traces).filter_map(note).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::geometry::VerticalUnit;
    use survey::horizon::{NodeGrid, Quality, Sheet};
    use survey::stratigraphy::{Contact, StratigraphicHorizon};

    #[test]
    fn two_flat_horizons_make_three_layers() {
        let g = SurveyGeometry::regular([10, 12, 40], 25.0, 4.0, VerticalUnit::Milliseconds);
        let flat = |name: &str, ms: f32| {
            Horizon::new(name, vec![Sheet::new(NodeGrid::of_survey(&g), vec![ms; 120], Quality::Picked)])
        };
        let stratigraphy = Stratigraphy {
            horizons: ["A", "B"]
                .map(|name| StratigraphicHorizon { name: name.into(), contact: Contact::Conformable })
                .into(),
            layer_names: Vec::new(),
        };
        let model = StructuralModel::build(
            &g,
            &stratigraphy,
            &[flat("B", 80.0), flat("A", 40.0)],
            &[],
            &ModelSettings::default(),
            &Progress::silent(),
        )
        .unwrap();
        assert_eq!((model.layer_count(), model.block_count()), (3, 1));
        let layer = |z: f32| model.region_at(Vec3::new(4.3, 5.1, z)).layer;
        assert_eq!((layer(5.0), layer(15.0), layer(25.0)), (2, 1, 0));
        assert_eq!(model.horizon_z(1, 0, 3.5, 14.0), 20.0);
    }

    /// Only sheets near a place are asked, and the answers are those of all sheets.
    #[test]
    fn many_sheets_that_cut_each_other_are_told_from_those_nearby() {
        let g = SurveyGeometry::regular([24, 16, 160], 25.0, 4.0, VerticalUnit::Milliseconds);
        let mut state = 1u32;
        let mut next = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) as f32 / 65536.0
        };
        let count = 70;
        let name = |h: usize| format!("H{h}");
        let contact = |h: usize| [Contact::Erosional, Contact::Onlap, Contact::Erosional][h % 3];
        let horizons: Vec<Horizon> = (0..count)
            .map(|h| {
                let (tilt, bend) = (6.0 * (next() - 0.5), 3.0 * next());
                let ms = |n: usize| 8.0 * h as f32 + tilt * (n / 16) as f32 + bend * (n % 16) as f32;
                let nodes = (0..24 * 16).map(ms).collect();
                Horizon::new(name(h), vec![Sheet::new(NodeGrid::of_survey(&g), nodes, Quality::Picked)])
            })
            .collect();
        let horizon = |h| StratigraphicHorizon { name: name(h), contact: contact(h) };
        let stratigraphy = Stratigraphy { horizons: (0..count).map(horizon).collect(), layer_names: Vec::new() };
        let settings = ModelSettings::default();
        let model = StructuralModel::build(&g, &stratigraphy, &horizons, &[], &settings, &Progress::silent()).unwrap();
        let (mut cut, mut around) = (0, 0);
        for _ in 0..300 {
            // Beyond the survey, too, where nodes do not bound the sheets.
            let (x, y, z) = (60.0 * next() - 18.0, 40.0 * next() - 12.0, 180.0 * next() - 10.0);
            let own: Vec<f32> = (0..count).map(|h| model.sheet(h, 0).z_at(x, y)).collect();
            let below: Below = own.iter().map(|sheet| z >= *sheet).collect();
            let p = Vec3::new(x, y, z);
            assert_eq!(model.below_at(p, 0), below, "{p}");
            around += usize::from(model.horizons_around(p, 0).len() < count);
            let mut clipped = own.clone();
            model.rules().clip(&mut clipped);
            cut += (0..count).filter(|h| clipped[*h] != own[*h]).count();
            let drawn: Vec<f32> = (0..count).map(|h| model.horizon_z(h, 0, x, y)).collect();
            assert_eq!(drawn, clipped, "{p}");
        }
        assert!(cut > 3000 && around > 100, "{cut} {around}");
    }
}
