//! A fault: the triangulated surface that was interpreted, and the fault that truncates it.

use crate::mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

/// An interpreted fault. The parameterization extends it beyond its tip line; the extension is never drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// Unique within a project.
    pub name: String,
    /// The surface in world coordinates.
    pub mesh: TriangleMesh,
    /// Name of the fault that truncates this one. This fault then exists only on the side on which most of
    /// its own vertices lie.
    pub truncated_by: Option<String>,
    /// By how much it reaches beyond what was drawn, on every side along its surface, m; 0: it ends where it was drawn.
    pub grown_m: f64,
}

impl Fault {
    /// A fault that ends where it was drawn and at no other fault.
    pub fn new(name: impl Into<String>, mesh: TriangleMesh) -> Self {
        Self { name: name.into(), mesh, truncated_by: None, grown_m: 0.0 }
    }
}
