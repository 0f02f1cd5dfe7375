//! The restoration of a model to one of its horizons.

use crate::balance::{self, Balance};
use crate::carried;
use crate::datum::{Datum, DatumPlane};
use crate::shift::Shift;
use crate::target::{TargetSheet, is_known, target_sheets};
use crate::ties::{Tie, ties};
use glam::{DVec2, DVec3};
use model::{FaultNetwork, ModelError, ModelSettings, StructuralModel};
use serde::{Deserialize, Serialize};
use std::fmt;
use survey::{Cancelled, Fault, Horizon, Progress, Stratigraphy, SurveyGeometry};

/// How a model is restored.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RestoreSettings {
    /// How the horizon lies afterwards.
    #[serde(default)]
    pub datum: Datum,
    /// Its depth in the middle of the survey, vertical unit; by default it keeps the mean of its nodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
}

/// Why a model cannot be restored.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RestoreError {
    /// The horizon has any shape.
    #[error(
        "\"{horizon}\" is no sheet with one depth at each place of a fault block, but a body or an overturned surface: it cannot \
         be laid flat; restore to a horizon that is a sheet"
    )]
    NotASheet {
        /// The horizon.
        horizon: String,
    },
    /// The horizon bounds an intrusion.
    #[error(
        "\"{horizon}\" is the boundary of an intrusion, which never lay flat; restore to a horizon that was laid down"
    )]
    Intrusion {
        /// The horizon.
        horizon: String,
    },
    /// No node of the horizon lies in the block that it belongs to.
    #[error("\"{horizon}\" is nowhere interpreted inside the survey; restore to another horizon")]
    Nowhere {
        /// The horizon.
        horizon: String,
    },
    /// The datum is no slope.
    #[error(
        "a dip of {dip}° towards {direction}° is none that beds are laid down with; state 0 to 60 degrees of dip, and a direction"
    )]
    Dip {
        /// Its dip, degrees.
        dip: f64,
        /// Its direction, degrees.
        direction: f64,
    },
    /// A depth that is far outside of the survey.
    #[error(
        "the depth {depth} lies far outside of the survey, which reaches from {from} to {to}; state one nearer to it"
    )]
    Depth {
        /// What was stated.
        depth: f64,
        /// Where the survey begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// What was restored makes no model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The user cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// What is not as one may expect.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RestoreNote {
    /// Share of the map on which the restored horizon was only continued: it was not interpreted, or eroded.
    Continued {
        /// The horizon.
        horizon: String,
        /// The share, 0 to 1.
        share: f64,
    },
    /// A block without the horizon.
    WithoutHorizon {
        /// The horizon.
        horizon: String,
        /// Count of blocks.
        blocks: usize,
    },
    /// A fault that is no older than what is taken away.
    FaultTakenAway {
        /// The fault.
        fault: String,
    },
    /// A body that cuts the restored horizon is younger.
    BodyTakenAway {
        /// The body.
        body: String,
        /// The restored horizon.
        horizon: String,
    },
    /// A surface of any shape went along with the rock around it.
    Carried {
        /// The horizon that it is.
        horizon: String,
    },
    /// A fault at which the restored horizon has no cut-offs on both sides.
    NotClosed {
        /// The fault.
        fault: String,
    },
}

impl fmt::Display for RestoreNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Continued { horizon, share } => write!(
                f,
                "{horizon} is not interpreted, or eroded, on {:.0} % of the map: it was restored there as the model continues it, \
                 so that rock which is gone is drawn as if it were there",
                100.0 * share
            ),
            Self::WithoutHorizon { horizon, blocks } => write!(
                f,
                "{horizon} was not interpreted in {blocks} of the fault blocks: these were restored by where the model places it"
            ),
            Self::FaultTakenAway { fault } => write!(f, "{fault} lies above the horizon and was taken away"),
            Self::BodyTakenAway { body, horizon } => write!(
                f,
                "{body} cuts {horizon}, so it is younger and was taken away; layers go on through its place as the model continues them"
            ),
            Self::Carried { horizon } => write!(
                f,
                "{horizon} has any shape: it went along with the rock around it, and neither its flow nor its intrusion was undone"
            ),
            Self::NotClosed { fault } => write!(
                f,
                "the horizon does not meet {fault} from both sides: its heave was not closed, and blocks beside it move as their \
                 other faults say"
            ),
        }
    }
}

/// What became of a fault.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FaultMove {
    /// Its name.
    pub fault: String,
    /// Mean heave of the restored horizon before, m; negative where it overlaps.
    pub heave_m: f64,
    /// What is left of it, root of the mean square, m.
    pub left_m: f64,
    /// Mean and largest distance of the hanging wall from the fault where it came to lie, m: what it gaped or overlapped before
    /// its rock was continued to the fault.
    pub misfit_m: [f64; 2],
}

/// A restored interpretation.
#[derive(Debug, Clone)]
pub struct Restored {
    /// Horizons and contacts from the restored one down, with the layers between them; the first layer is air or water.
    pub stratigraphy: Stratigraphy,
    /// The horizons in that order.
    pub horizons: Vec<Horizon>,
    /// The faults that are left.
    pub faults: Vec<Fault>,
    /// The plane that the horizon lies on.
    pub plane: DatumPlane,
    /// What became of the faults.
    pub fault_moves: Vec<FaultMove>,
    /// How lengths and areas changed.
    pub balance: Balance,
    /// What is not as one may expect.
    pub notes: Vec<RestoreNote>,
}

/// How rock moves.
pub(crate) struct Moves<'a> {
    pub model: &'a StructuralModel,
    pub target: usize,
    pub sheets: Vec<TargetSheet>,
    pub shift: Shift,
    pub plane: DatumPlane,
    pub ties: Vec<Tie>,
}

impl Moves<'_> {
    /// Where rock of a block goes, voxels.
    pub(crate) fn moved(&self, block: u16, p: DVec3) -> DVec3 {
        let at = p.truncate();
        let to = at + self.shift.at(block, at);
        to.extend(p.z - self.sheets[usize::from(block)].z_at(at) + self.plane.z_at(to))
    }

    /// The depth to which a horizon of a block comes at a restored place, with its present place.
    pub(crate) fn restored_z(&self, horizon: usize, block: u16, to: DVec2) -> (f64, DVec2) {
        let at = self.shift.back(block, to);
        if horizon == self.target {
            return (self.plane.z_at(to), at);
        }
        let z = f64::from(self.model.sheet(horizon, block).z_at(at.x as f32, at.y as f32));
        (z - self.sheets[usize::from(block)].z_at(at) + self.plane.z_at(to), at)
    }
}

/// Restores a model to its horizon `target` (0 = youngest); `horizons` are those of the model in its order.
///
/// # Errors
/// [`RestoreError`] says what is wrong and what to do.
pub fn restore(
    geometry: &SurveyGeometry,
    model: &StructuralModel,
    horizons: &[Horizon],
    target: usize,
    settings: &RestoreSettings,
    progress: &Progress,
) -> Result<Restored, RestoreError> {
    let name = || model.stratigraphy().horizons[target].name.clone();
    let contacts = model.rules().contacts();
    if (0..model.block_count() as u16).any(|block| model.level(target, block).is_some()) {
        return Err(RestoreError::NotASheet { horizon: name() });
    }
    if contacts[target].is_intrusive() {
        return Err(RestoreError::Intrusion { horizon: name() });
    }
    check(geometry, settings)?;
    progress.begin("restore", 4);
    let sheets = target_sheets(model, target);
    let nodes = known_nodes(model, target);
    let depth = settings.depth.map(|depth| geometry.vertical.index_of(depth));
    let plane = DatumPlane::of(settings.datum, geometry, &nodes, depth)
        .ok_or_else(|| RestoreError::Nowhere { horizon: name() })?;
    progress.step(1)?;
    let ties = ties(model, target);
    let largest = (0..sheets.len()).max_by_key(|&block| (sheets[block].known, usize::MAX - block)).unwrap_or(0) as u16;
    let depth_of = |block: u16, at: DVec2| sheets[usize::from(block)].z_at(at);
    let shift = Shift::closing(model, &ties, &depth_of, largest, progress)?;
    progress.step(1)?;
    let moves = Moves { model, target, shift, plane, ties, sheets };
    let mut notes = notes_on(&moves, &name());
    let faults = carried::faults(&moves, geometry, &mut notes);
    let network = FaultNetwork::build(geometry, &faults, progress)?;
    let carried = carried::horizons(&moves, geometry, horizons, &network, &mut notes);
    progress.step(1)?;
    let after = StructuralModel::build(
        geometry,
        &carried.stratigraphy,
        &carried.horizons,
        &faults,
        &ModelSettings::default(),
        progress,
    )?;
    let balance = balance::of(&moves, geometry, &after, &carried.kept);
    let fault_moves = carried::fault_moves(&moves, &network);
    progress.step(1)?;
    let carried::CarriedHorizons { stratigraphy, horizons, .. } = carried;
    Ok(Restored { stratigraphy, horizons, faults, plane, fault_moves, balance, notes })
}

/// Checks what was stated.
fn check(geometry: &SurveyGeometry, settings: &RestoreSettings) -> Result<(), RestoreError> {
    if let Datum::Dipping { dip, direction } = settings.datum
        && !((0.0..=60.0).contains(&dip) && direction.is_finite())
    {
        return Err(RestoreError::Dip { dip, direction });
    }
    let [from, to] = [geometry.vertical.first, geometry.vertical.last()];
    let height = (to - from).abs();
    match settings.depth {
        Some(depth) if !(from - height..=to + height).contains(&depth) => Err(RestoreError::Depth { depth, from, to }),
        _ => Ok(()),
    }
}

/// The nodes of a horizon that are known in their own blocks and the volume, voxels.
fn known_nodes(model: &StructuralModel, horizon: usize) -> Vec<DVec3> {
    let [nx, ny, _] = model.size();
    let blocks = model.block_count() as u16;
    let node = |n: usize| {
        let at = DVec2::new((n / ny) as f64, (n % ny) as f64);
        let known = (0..blocks).filter(move |block| is_known(model, horizon, *block, at));
        known.map(move |block| at.extend(f64::from(model.sheet(horizon, block).z_at(at.x as f32, at.y as f32))))
    };
    (0..nx * ny).flat_map(node).collect()
}

fn notes_on(moves: &Moves<'_>, name: &str) -> Vec<RestoreNote> {
    let mut notes = Vec::new();
    let without = moves.sheets.iter().filter(|sheet| sheet.known == 0).count();
    if without > 0 && without < moves.sheets.len() {
        notes.push(RestoreNote::WithoutHorizon { horizon: name.to_owned(), blocks: without });
    }
    let share = continued_share(moves);
    if share >= 0.005 {
        notes.push(RestoreNote::Continued { horizon: name.to_owned(), share });
    }
    let model = moves.model;
    for (fault, surface) in model.faults().surfaces().iter().enumerate() {
        let own = moves.ties.iter().filter(|tie| tie.fault == fault);
        let meets = own.clone().count() > 0;
        if meets && own.clone().all(|tie| !tie.is_real) {
            // It ends below the horizon, or lies elsewhere: there is nothing to close.
            continue;
        }
        if !meets {
            notes.push(RestoreNote::NotClosed { fault: surface.name.clone() });
        }
    }
    notes
}

/// Share of the places where the horizon lies in its block that are not known.
fn continued_share(moves: &Moves<'_>) -> f64 {
    let model = moves.model;
    let [nx, ny, _] = model.size();
    let (mut all, mut continued) = (0usize, 0usize);
    for n in 0..nx * ny {
        let at = DVec2::new((n / ny) as f64, (n % ny) as f64);
        for block in 0..model.block_count() as u16 {
            let p = at.extend(f64::from(model.sheet(moves.target, block).z_at(at.x as f32, at.y as f32)));
            if model.faults().holds(block, p.as_vec3()) {
                all += 1;
                continued += usize::from(!is_known(model, moves.target, block, at));
            }
        }
    }
    continued as f64 / all.max(1) as f64
}
