//! The reflections beside an isochron: the vertices of all candidates, found by trace.

use crate::cuts::Cut;
use crate::hubs::Hubs;
use interp::{Extremum, Surfaces};

/// All vertices of candidates by trace. Memory: 20 bytes a vertex.
pub struct Reflections(Hubs);

/// A point of a reflection on a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflection {
    /// Fractional sample.
    pub z: f32,
    /// What it is.
    pub kind: Extremum,
}

impl Reflections {
    /// Sorts the vertices of candidates; patches are cut at faults.
    pub fn new(surfaces: &Surfaces, cuts: &[Cut]) -> Self {
        Self(Hubs::new(surfaces, cuts, 1, 1.0))
    }

    pub(crate) fn hubs(&self) -> &Hubs {
        &self.0
    }

    /// The reflection on trace (x, y) that is closest to sample `z` within `reach` samples, of one kind or of any.
    ///
    /// ```
    /// use interp::{Extremum, Surface, Surfaces, Vertex};
    /// use time::Reflections;
    ///
    /// let vertices = vec![Vertex { x: 0, y: 0, z: 4.2 }, Vertex { x: 0, y: 1, z: 4.4 }, Vertex { x: 1, y: 0, z: 4.6 }];
    /// let surface = Surface { extremum: Extremum::Peak, vertices: 0..3, triangles: 0..1 };
    /// let surfaces = Surfaces { size: [2, 2, 9], vertices, triangles: vec![[0, 1, 2]], surfaces: vec![surface] };
    /// let reflections = Reflections::new(&surfaces, &[]);
    /// assert_eq!(reflections.nearest([0, 1], 5.0, None, 1.0).map(|at| at.z), Some(4.4));
    /// assert_eq!(reflections.nearest([0, 1], 5.0, Some(Extremum::Trough), 1.0), None);
    /// assert_eq!(reflections.nearest([0, 1], 6.0, None, 1.0), None);
    /// ```
    pub fn nearest(&self, trace: [usize; 2], z: f32, kind: Option<Extremum>, reach: f32) -> Option<Reflection> {
        let hubs = &self.0;
        let own = hubs.on_trace(trace[0] * hubs.size[1] + trace[1]);
        let of = |v: usize| hubs.kind[hubs.hub[v] as usize];
        own.filter(|&v| (hubs.z[v] - z).abs() <= reach && kind.is_none_or(|kind| of(v) == kind))
            .min_by(|&v, &w| (hubs.z[v] - z).abs().total_cmp(&(hubs.z[w] - z).abs()))
            .map(|v| Reflection { z: hubs.z[v], kind: of(v) })
    }
}
