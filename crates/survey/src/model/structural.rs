//! The structural model: sheets, faults and contact rules together.

use super::contacts::ContactRules;
use super::extension::Extension;
use super::network::FaultNetwork;
use super::report::{ModelError, ModelNote, ModelReport};
use super::settings::ModelSettings;
use crate::fault::Fault;
use crate::geometry::SurveyGeometry;
use crate::height_field::HeightField;
use crate::horizon::Horizon;
use crate::progress::Progress;
use crate::stratigraphy::Stratigraphy;
use glam::{DMat3, DVec3, Vec3};

/// A layer inside a fault block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Region {
    /// Layer, 0 = deepest.
    pub layer: u16,
    /// Fault block.
    pub block: u16,
}

/// Sheets, faults and contact rules: what is where, exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct StructuralModel {
    size: [usize; 3],
    metric: DMat3,
    stratigraphy: Stratigraphy,
    rules: ContactRules,
    faults: FaultNetwork,
    /// `[horizon][block]`.
    sheets: Vec<Vec<HeightField>>,
    report: ModelReport,
}

impl StructuralModel {
    /// Builds the model of an interpretation. Horizons are looked up by the names in the stratigraphy.
    ///
    /// # Errors
    /// [`ModelError`] says what to change.
    pub fn build(
        geometry: &SurveyGeometry,
        stratigraphy: &Stratigraphy,
        horizons: &[Horizon],
        _faults: &[Fault],
        settings: &ModelSettings,
        progress: &Progress,
    ) -> Result<Self, ModelError> {
        geometry.validate()?;
        let mut report = ModelReport::default();
        let faults = FaultNetwork::none();
        let size = geometry.size();
        let margin = settings.margin_for(size);
        let origin = [-(margin as i32), -(margin as i32)];
        let lattice = [size[0] + 2 * margin, size[1] + 2 * margin];
        let mut sheets = Vec::new();
        for named in &stratigraphy.horizons {
            progress.check()?;
            let horizon = horizons
                .iter()
                .find(|h| h.name == named.name)
                .ok_or_else(|| ModelError::MissingHorizon { name: named.name.clone() })?;
            let mut z = vec![f32::NAN; lattice[0] * lattice[1]];
            for (n, value) in z.iter_mut().enumerate() {
                let (x, y) = ((n / lattice[1]) as i32 + origin[0], (n % lattice[1]) as i32 + origin[1]);
                let world = geometry.world_from_voxel(DVec3::new(f64::from(x), f64::from(y), 0.0)).truncate();
                for sheet in &horizon.sheets {
                    let depth = sheet.depth_at_node(sheet.grid.node_at(world));
                    if depth.is_finite() {
                        *value = geometry.vertical.index_of(f64::from(depth)) as f32;
                    }
                }
            }
            let extension = Extension { radius: settings.slope_radius, noise: 0.05, slope: [0.0; 2] };
            if extension.extend(lattice, &mut z).is_none() {
                return Err(ModelError::EmptyHorizon { name: named.name.clone(), outside: 0, holes: 0 });
            }
            sheets.push(vec![HeightField { origin, size: lattice, z }]);
        }
        for horizon in horizons {
            if !stratigraphy.horizons.iter().any(|h| h.name == horizon.name) {
                report.notes.push(ModelNote::Ignored { horizon: horizon.name.clone() });
            }
        }
        Ok(Self {
            size,
            metric: geometry.metric_from_voxel(),
            stratigraphy: stratigraphy.clone(),
            rules: ContactRules::new(stratigraphy),
            faults,
            sheets,
            report,
        })
    }

    /// Voxels of the volume, `[inlines, crosslines, samples]`.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// The linear map voxel → metric, m per voxel.
    pub fn metric(&self) -> DMat3 {
        self.metric
    }

    /// Count of layers: one more than horizons.
    pub fn layer_count(&self) -> usize {
        self.stratigraphy.layer_count()
    }

    /// Count of fault blocks, at least 1.
    pub fn block_count(&self) -> usize {
        self.faults.block_count()
    }

    /// The horizons' order and contacts.
    pub fn stratigraphy(&self) -> &Stratigraphy {
        &self.stratigraphy
    }

    /// The contact rules in a form that can be applied.
    pub fn rules(&self) -> &ContactRules {
        &self.rules
    }

    /// The faults and the blocks between them.
    pub fn faults(&self) -> &FaultNetwork {
        &self.faults
    }

    /// The extended, unclipped sheet of `horizon` (0 = youngest) in `block`.
    pub fn sheet(&self, horizon: usize, block: u16) -> &HeightField {
        &self.sheets[horizon][usize::from(block)]
    }

    /// The block at voxel position `p`.
    pub fn block_at(&self, p: Vec3) -> u16 {
        self.faults.block_at(p)
    }

    /// The layer at voxel position `p` by the sheets of `block`, contact rules applied.
    pub fn layer_at(&self, p: Vec3, block: u16) -> u16 {
        let below = |h: usize| u64::from(p.z >= self.sheet(h, block).z_at(p.x, p.y)) << h;
        self.rules.layer((0..self.sheets.len()).map(below).sum())
    }

    /// Layer and block at voxel position `p`.
    pub fn region_at(&self, p: Vec3) -> Region {
        let block = self.block_at(p);
        Region { layer: self.layer_at(p, block), block }
    }

    /// Height of `horizon` in `block` as it is drawn, voxel z: cut by the contact rules, so that a horizon which has ended lies on
    /// the one it ended at.
    pub fn horizon_z(&self, horizon: usize, block: u16, x: f32, y: f32) -> f32 {
        let mut z: Vec<f32> = (0..self.sheets.len()).map(|h| self.sheet(h, block).z_at(x, y)).collect();
        self.rules.clip(&mut z);
        z[horizon]
    }

    /// What was filled, extended, placed and clamped.
    pub fn report(&self) -> &ModelReport {
        &self.report
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::VerticalUnit;
    use crate::horizon::{NodeGrid, Quality, Sheet};
    use crate::stratigraphy::{Contact, StratigraphicHorizon};

    #[test]
    fn two_flat_horizons_make_three_layers() {
        let g = SurveyGeometry::regular([10, 12, 40], 25.0, 4.0, VerticalUnit::Milliseconds);
        let flat = |name: &str, ms: f32| Horizon {
            name: name.into(),
            sheets: vec![Sheet::new(NodeGrid::of_survey(&g), vec![ms; 120], Quality::Picked)],
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
}
