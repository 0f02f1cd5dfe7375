//! Models whose every region is known in closed form, for the tests of this crate.

use super::{ModelSettings, StructuralModel};
use glam::{DVec2, DVec3};
use survey::fault::Fault;
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::mesh::TriangleMesh;
use survey::progress::Progress;
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};

/// A fault x = at(y, z), interpreted over a range of y and z.
pub(crate) struct FaultForm {
    pub at: fn(f64, f64) -> f64,
    pub y: [f64; 2],
    pub z: [f64; 2],
    /// The fault this one ends at, and on which side of it (x greater?) it lies.
    pub truncated_by: Option<(usize, bool)>,
}

/// Height of horizon h where the faults' sides (x greater: bit set) are `bits`.
pub(crate) type SheetForm = fn(h: usize, bits: u32, x: f64, y: f64) -> f64;

/// A closed-form model in voxel space.
pub(crate) struct ModelForm {
    pub geometry: SurveyGeometry,
    pub faults: Vec<FaultForm>,
    pub contacts: Vec<Contact>,
    pub sheet: SheetForm,
}

impl ModelForm {
    pub(crate) fn new(size: [usize; 3], faults: Vec<FaultForm>, contacts: Vec<Contact>, sheet: SheetForm) -> Self {
        Self { geometry: SurveyGeometry::regular(size, 25.0, 10.0, VerticalUnit::Metres), faults, contacts, sheet }
    }

    /// Sides of the faults at a voxel position; a fault that does not exist there counts as on its negative
    /// side.
    pub(crate) fn bits(&self, p: DVec3) -> u32 {
        let raw = |f: &FaultForm| p.x >= (f.at)(p.y, p.z);
        let exists = |f: &FaultForm| f.truncated_by.is_none_or(|(by, side)| raw(&self.faults[by]) == side);
        self.faults.iter().enumerate().map(|(i, f)| u32::from(exists(f) && raw(f)) << i).sum()
    }

    /// Layer (conformable horizons) and fault sides at a voxel position.
    pub(crate) fn region(&self, p: DVec3) -> (u16, u32) {
        let bits = self.bits(p);
        let passed = (0..self.contacts.len()).filter(|&h| p.z >= (self.sheet)(h, bits, p.x, p.y)).count();
        ((self.contacts.len() - passed) as u16, bits)
    }

    /// Whether nothing changes within `radius` voxels of `p` (along the axes and diagonals).
    pub(crate) fn is_clear(&self, p: DVec3, radius: f64) -> bool {
        let here = self.region(p);
        let steps = [-1.0, 0.0, 1.0];
        steps.iter().all(|&x| {
            steps.iter().all(|&y| steps.iter().all(|&z| self.region(p + radius * DVec3::new(x, y, z)) == here))
        })
    }

    pub(crate) fn stratigraphy(&self) -> Stratigraphy {
        let horizons = self
            .contacts
            .iter()
            .enumerate()
            .map(|(h, &contact)| StratigraphicHorizon { name: format!("H{h}"), contact })
            .collect();
        Stratigraphy { horizons, layer_names: Vec::new() }
    }

    pub(crate) fn fault_inputs(&self) -> Vec<Fault> {
        self.faults
            .iter()
            .enumerate()
            .map(|(i, f)| Fault {
                truncated_by: f.truncated_by.map(|(by, _)| format!("F{by}")),
                ..Fault::new(format!("F{i}"), self.mesh(f, 24))
            })
            .collect()
    }

    fn mesh(&self, f: &FaultForm, n: usize) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for i in 0..=n {
            for j in 0..=n {
                let (a, b) = (i as f64 / n as f64, j as f64 / n as f64);
                let (y, z) = (f.y[0] + a * (f.y[1] - f.y[0]), f.z[0] + b * (f.z[1] - f.z[0]));
                mesh.vertices.push(self.geometry.world_from_voxel(DVec3::new((f.at)(y, z), y, z)));
            }
        }
        let id = |i: usize, j: usize| (i * (n + 1) + j) as u32;
        for i in 0..n {
            for j in 0..n {
                mesh.triangles.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
                mesh.triangles.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
            }
        }
        mesh
    }

    /// The same surfaces in another geometry of the same world.
    pub(crate) fn in_geometry(&self, geometry: &SurveyGeometry) -> StructuralModel {
        StructuralModel::build(
            geometry,
            &self.stratigraphy(),
            &self.horizons(|_, _| 0.0),
            &self.fault_inputs(),
            &ModelSettings::default(),
            &Progress::silent(),
        )
        .unwrap()
    }

    /// What an interpreter would give: per combination of fault sides, the nodes that lie there.
    pub(crate) fn horizons(&self, noise: impl Fn(usize, usize) -> f64) -> Vec<Horizon> {
        let grid = NodeGrid::of_survey(&self.geometry);
        let [nx, ny, nz] = self.geometry.size();
        (0..self.contacts.len())
            .map(|h| {
                let sheets = (0..1u32 << self.faults.len())
                    .filter_map(|bits| {
                        let depth: Vec<f32> = (0..nx * ny)
                            .map(|n| {
                                let (x, y) = ((n / ny) as f64, (n % ny) as f64);
                                let z = (self.sheet)(h, bits, x, y);
                                let inside = z >= 0.0 && z <= nz as f64 - 1.0;
                                let own = inside && self.bits(DVec3::new(x, y, z)) == bits;
                                if own { self.geometry.vertical.value_at(z + noise(h, n)) as f32 } else { f32::NAN }
                            })
                            .collect();
                        let sheet = Sheet::new(grid, depth, Quality::Picked);
                        (sheet.node_count() > 0).then_some(sheet)
                    })
                    .collect();
                Horizon::new(format!("H{h}"), sheets)
            })
            .collect()
    }

    pub(crate) fn model(&self) -> StructuralModel {
        self.in_geometry(&self.geometry)
    }
}

/// Uniform random numbers in [0, 1).
pub(crate) struct Random(pub u32);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 8) / f64::from(1u32 << 24)
    }

    /// A place in the volume of `size`.
    pub(crate) fn place(&mut self, size: [usize; 3]) -> DVec3 {
        DVec3::from_array(size.map(|n| (n as f64 - 1.0) * self.next()))
    }

    /// A direction.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0;
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.normalize();
            }
        }
    }
}

/// A fault through the whole volume.
pub(crate) fn through(at: fn(f64, f64) -> f64) -> FaultForm {
    FaultForm { at, y: [-2.0, 60.0], z: [-2.0, 80.0], truncated_by: None }
}

const SIZE: [usize; 3] = [64, 48, 72];
const CONFORMABLE: [Contact; 3] = [Contact::Conformable; 3];

/// Flat horizons, no fault.
pub(crate) fn flat() -> ModelForm {
    ModelForm::new(SIZE, vec![], CONFORMABLE.into(), |h, _, _, _| 15.3 + 20.0 * h as f64)
}

/// Dipping horizons and a normal fault of 60° (in voxels), throw 6.5.
pub(crate) fn dipping_normal() -> ModelForm {
    let fault = through(|y, z| 24.0 + 0.55 * (z - 36.0) + 0.08 * y);
    ModelForm::new(SIZE, vec![fault], CONFORMABLE.into(), |h, bits, x, y| {
        12.0 + 18.0 * h as f64 + 0.18 * x - 0.1 * y - if bits & 1 == 1 { 0.0 } else { 6.5 }
    })
}

/// Domes and a reverse fault: two depths at one trace.
pub(crate) fn domed_reverse() -> ModelForm {
    let fault = through(|y, z| 34.0 + 0.6 * (z - 36.0) - 0.05 * y);
    ModelForm::new(SIZE, vec![fault], CONFORMABLE.into(), |h, bits, x, y| {
        let r_sq = ((x - 30.0).powi(2) + (y - 24.0).powi(2)) / (2.0 * 22.0f64.powi(2));
        30.0 + 15.0 * h as f64 - (14.0 + h as f64) * (-r_sq).exp() + if bits & 1 == 1 { -5.5 } else { 0.0 }
    })
}

/// An antithetic fault that ends at a main fault (Y).
pub(crate) fn truncated_y() -> ModelForm {
    let main = through(|_, z| 14.0 + 0.5 * z);
    let antithetic =
        FaultForm { at: |_, z| 50.0 - 0.4 * z, y: [-2.0, 60.0], z: [-2.0, 39.5], truncated_by: Some((0, true)) };
    ModelForm::new(SIZE, vec![main, antithetic], CONFORMABLE.into(), |h, bits, x, y| {
        let throw = if bits & 1 == 0 { 0.0 } else { 7.0 } - if bits & 2 == 2 { 4.0 } else { 0.0 };
        10.0 + 18.0 * h as f64 + 0.1 * x + 0.05 * y + throw
    })
}

/// Two crossing faults (X): four blocks.
pub(crate) fn crossing_x() -> ModelForm {
    let a = through(|y, z| 30.0 + 0.4 * (z - 36.0) + 0.1 * (y - 24.0));
    let b = through(|y, z| 32.0 - 0.45 * (z - 36.0) - 0.1 * (y - 24.0));
    ModelForm::new(SIZE, vec![a, b], CONFORMABLE.into(), |h, bits, x, y| {
        let throw = 5.0 * f64::from(bits & 1) - 4.0 * f64::from(bits >> 1);
        14.0 + 18.0 * h as f64 + 0.05 * x + 0.08 * y + throw
    })
}

/// A vertical fault that dies out at y = 26 with a throw that tapers to nothing.
pub(crate) fn dying_out() -> ModelForm {
    let fault = FaultForm { at: |_, _| 31.4, y: [-2.0, 26.0], z: [-2.0, 80.0], truncated_by: None };
    ModelForm::new(SIZE, vec![fault], CONFORMABLE.into(), |h, bits, x, y| {
        let throw = if y < 26.0 { 0.012 * (26.0 - y).powi(2) } else { 0.0 };
        // The displacement decays away from the fault, too.
        let away = (-(x - 31.4).abs() / 25.0).exp();
        15.0 + 18.0 * h as f64 + 0.1 * x + 0.05 * y + throw * away * (f64::from(bits) - 0.5)
    })
}

/// All of them, by name.
pub(crate) fn all() -> Vec<(&'static str, ModelForm)> {
    vec![
        ("flat", flat()),
        ("dipping, normal", dipping_normal()),
        ("domed, reverse", domed_reverse()),
        ("Y", truncated_y()),
        ("X", crossing_x()),
        ("dying out", dying_out()),
    ]
}

/// (s, t) far enough from the border of a rectangle that a cell around it fits.
pub(crate) fn inside(random: &mut Random, extent: [f64; 2]) -> DVec2 {
    DVec2::new(random.next(), random.next()) * DVec2::from_array(extent)
}
