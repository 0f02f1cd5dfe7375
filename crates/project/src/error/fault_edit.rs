//! Why a fault cannot be made of sticks, cut, merged or given sticks.

/// Why a fault cannot be made of its sticks, or changed as a whole.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FaultEditError {
    /// A fault that was to be given sticks and has them.
    #[error("fault \"{fault}\" has sticks already")]
    HasSticks {
        /// Its name.
        fault: String,
    },
    /// A place at which a fault was to be cut lies beside it.
    #[error("nothing of fault \"{fault}\" lies beyond inline {:.0}, crossline {:.0}, {:.1}: it cannot be cut there", at[0], at[1], at[2])]
    CutBeside {
        /// Its name.
        fault: String,
        /// Inline, crossline and vertical value.
        at: [f64; 3],
    },
    /// A single fault, or one fault twice, that was to be merged.
    #[error("it takes two different faults or more to merge")]
    FewFaults,
    /// Faults that run side by side and were to be merged.
    #[error(
        "faults \"{}\" and \"{}\" run side by side at inline {:.0}, crossline {:.0}, {apart_m:.0} m apart: they are two",
        faults[0], faults[1], at[0], at[1]
    )]
    SideBySide {
        /// Their names.
        faults: [String; 2],
        /// Inline and crossline where both are.
        at: [f64; 2],
        /// Their distance there, m.
        apart_m: f64,
    },
    /// Sticks that span no surface.
    #[error("the sticks of fault \"{fault}\" span no surface")]
    FlatSticks {
        /// The fault.
        fault: String,
    },
    /// A fault that lies beside the survey.
    #[error("no part of fault \"{fault}\" lies in the survey")]
    FaultElsewhere {
        /// The fault.
        fault: String,
    },
    /// A fault was not drawn with so many sticks, or points on one.
    #[error("fault {fault} has no point {} on a stick {}", point + 1, stick + 1)]
    NoStickPoint {
        /// Its name.
        fault: String,
        /// The stick, counted from 0.
        stick: usize,
        /// The point, counted from 0.
        point: usize,
    },
}
