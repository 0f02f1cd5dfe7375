//! An interpretation back in time: what is younger than a horizon is taken away, and the throws and folds of that horizon are undone.
//!
//! Block by block, rock at voxel p = (x, y, z) goes to
//!
//! ```text
//! x' = (x, y) + u_b(x, y)                   the move on the map that closes the heaves
//! z' = z − T_b(x, y) + D(x')                 vertical shear: the horizon's depth T_b becomes the datum D
//! ```
//!
//! So the vertical thickness of every layer is kept, and with it (∇u = 0 where heaves are constant) area in section and volume.
//! A similar fold is undone exactly, a parallel one is not: beds become shorter than they were. In the layer coordinates of flat
//! space, i and j go along with the rock and k is unchanged. `shift` is how blocks move, `target` how the horizon goes
//! on below faults. A fault goes with its foot wall; the rock of the hanging wall is continued to it, so that nothing gapes and
//! nothing overlaps, and what that took is measured.
//!
//! It is kinematic: nothing is decompacted, no isostasy, no flexural slip, and nothing is balanced.
//!
//! Deliberately absent: files, projects, pictures.

mod balance;
mod carried;
mod datum;
mod fill;
mod restoration;
mod shift;
mod target;
mod ties;

pub use balance::{Balance, HorizonBalance, LayerBalance, Span};
pub use datum::{Datum, DatumPlane};
pub use restoration::{FaultMove, RestoreError, RestoreNote, RestoreSettings, Restored, restore};
