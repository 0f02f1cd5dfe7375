//! A fault: the triangulated surface that was interpreted, and what cuts it off.

use crate::mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

/// An interpreted fault. Beyond its tip it is extended for the parameterization only, never drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// Unique within a project.
    pub name: String,
    /// The surface in world coordinates.
    pub mesh: TriangleMesh,
    /// Name of the fault that this one ends at. This fault then exists only on the side of it on which most of its own vertices lie.
    pub truncated_by: Option<String>,
}
