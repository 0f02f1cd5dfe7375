//! Grids as files hold them: where their nodes are, in which order their values stand, which of them are none.

use super::FormatError;
use super::raw::{RawShape, RawSurface};
use super::text::SourceFile;
use glam::DVec2;
use survey::horizon::NodeGrid;

/// The order of a grid's values in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NodeOrder {
    /// Rows along u, the first at v = 0.
    Rows,
    /// Rows along u, the first at the last v.
    RowsFromNorth,
    /// Columns along v from u = 0.
    Columns,
    /// The same, each column from the last v down: ZMAP+, CPS-3.
    ColumnsFromNorth,
}

impl NodeOrder {
    /// Values in file order, one for each node, to `[u][v]`.
    pub(crate) fn sorted(self, file: &[f64], [nu, nv]: [usize; 2]) -> Vec<f64> {
        let place = |n: usize| match (self, n / nv, n % nv) {
            (Self::Rows, u, v) => v * nu + u,
            (Self::RowsFromNorth, u, v) => (nv - 1 - v) * nu + u,
            (Self::Columns, ..) => n,
            (Self::ColumnsFromNorth, u, v) => u * nv + (nv - 1 - v),
        };
        (0..file.len()).map(|n| file[place(n)]).collect()
    }
}

/// A surface of a grid's values, of which those that `is_null` knows are holes; refused unless there is one for each
/// node.
pub(super) fn surface(
    source: &SourceFile,
    name: Option<String>,
    grid: NodeGrid,
    (mut values, order): (Vec<f64>, NodeOrder),
    is_null: impl Fn(f64) -> bool,
) -> Result<RawSurface, FormatError> {
    source.check_values(grid.count, values.len())?;
    values.iter_mut().filter(|value| is_null(**value)).for_each(|value| *value = f64::NAN);
    let z = if order == NodeOrder::Columns { values } else { order.sorted(&values, grid.count) };
    Ok(RawSurface::new(name, RawShape::Grid { grid, z }))
}

/// The numbers of a grid that may be rotated: u along the first step, v to its left.
pub(super) struct GridHeader {
    pub count: [f64; 2],
    /// A negative one mirrors.
    pub step: [f64; 2],
    /// Anticlockwise, about the origin.
    pub rotation_deg: f64,
    pub origin: DVec2,
}

impl GridHeader {
    /// The nodes; refuses what makes none.
    pub(crate) fn grid(&self, source: &SourceFile) -> Result<NodeGrid, FormatError> {
        let ([nu, nv], [du, dv]) = (self.count, self.step);
        if !(nu >= 1.0 && nv >= 1.0 && nu * nv <= f64::from(u32::MAX) && nu.fract() == 0.0 && nv.fract() == 0.0) {
            return Err(source.bad_grid(format!("{nu} columns and {nv} rows")));
        }
        let numbers = [du, dv, self.rotation_deg, self.origin.x, self.origin.y];
        if numbers.iter().any(|v| !v.is_finite() || v.abs() > 1e12) || du == 0.0 || dv == 0.0 {
            let DVec2 { x, y } = self.origin;
            let rotation = self.rotation_deg;
            return Err(source.bad_grid(format!("steps {du} and {dv}, rotation {rotation}, origin {x}, {y}")));
        }
        let along = DVec2::from_angle(self.rotation_deg.to_radians());
        let count = [nu as usize, nv as usize];
        // Without a zero that is negative.
        let v_step = along.perp() * dv + DVec2::ZERO;
        Ok(NodeGrid { origin: self.origin, u_step: along * du, v_step, count })
    }
}

/// An unrotated grid between two corners.
pub(super) fn unrotated(
    source: &SourceFile,
    count: [f64; 2],
    x: [f64; 2],
    y: [f64; 2],
) -> Result<NodeGrid, FormatError> {
    let [nx, ny] = count;
    if !(nx >= 2.0 && ny >= 2.0) {
        return Err(source.bad_grid(format!("{nx} columns and {ny} rows; a grid needs two of each")));
    }
    let step = [(x[1] - x[0]) / (nx - 1.0), (y[1] - y[0]) / (ny - 1.0)];
    if !(step[0] > 0.0 && step[1] > 0.0) {
        return Err(source.bad_grid(format!("X {} to {}, Y {} to {}", x[0], x[1], y[0], y[1])));
    }
    GridHeader { count, step, rotation_deg: 0.0, origin: DVec2::new(x[0], y[0]) }.grid(source)
}

/// A grid whose values run from a first node along one step, then line by line along another, in any directions.
pub(super) struct Scan {
    pub first: DVec2,
    pub along: DVec2,
    pub across: DVec2,
    /// Nodes along, and across.
    pub count: [usize; 2],
}

impl Scan {
    /// The surface, its v to the left of its u.
    pub(crate) fn surface(
        self,
        source: &SourceFile,
        name: Option<String>,
        values: Vec<f64>,
        is_null: impl Fn(f64) -> bool,
    ) -> Result<RawSurface, FormatError> {
        let Self { first, along, across, count } = self;
        let area = along.perp_dot(across);
        let far = first + along * count[0] as f64 + across * count[1] as f64;
        let is_usable = area.is_finite() && area != 0.0 && first.is_finite() && far.abs().max_element() < 1e12;
        if !is_usable || count.contains(&0) || count[0].checked_mul(count[1]).is_none() {
            let [nx, ny] = count;
            return Err(source.bad_grid(format!("{nx} by {ny} nodes from {first} along {along} and {across}")));
        }
        let (origin, v_step, order) = match area > 0.0 {
            true => (first, across, NodeOrder::Rows),
            false => (first + across * (count[1] as f64 - 1.0), -across, NodeOrder::RowsFromNorth),
        };
        surface(source, name, NodeGrid { origin, u_step: along, v_step, count }, (values, order), is_null)
    }
}

/// The first value and the step of evenly spaced ones, to a hundredth of the step.
pub(super) fn even_steps(values: &[f64]) -> Option<(f64, f64)> {
    let (&first, &last) = (values.first()?, values.last()?);
    let step = (last - first) / (values.len() as f64 - 1.0);
    let is_on = |(n, value): (usize, &f64)| (value - first - step * n as f64).abs() <= 0.01 * step.abs();
    (step.is_finite() && step != 0.0 && values.iter().enumerate().all(is_on)).then_some((first, step))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3 by 2 nodes, `[u][v]` = 10 u + v.
    #[test]
    fn each_order_puts_values_on_their_nodes() {
        let wanted = [0.0, 1.0, 10.0, 11.0, 20.0, 21.0];
        for (order, file) in [
            (NodeOrder::Rows, [0.0, 10.0, 20.0, 1.0, 11.0, 21.0]),
            (NodeOrder::RowsFromNorth, [1.0, 11.0, 21.0, 0.0, 10.0, 20.0]),
            (NodeOrder::Columns, wanted),
            (NodeOrder::ColumnsFromNorth, [1.0, 0.0, 11.0, 10.0, 21.0, 20.0]),
        ] {
            assert_eq!(order.sorted(&file, [3, 2]), wanted, "{order:?}");
        }
    }

    #[test]
    fn a_scan_in_any_direction_has_each_value_at_its_place() {
        let source = SourceFile { path: "a".into(), bytes: Vec::new() };
        for (along, across) in
            [(DVec2::X, -DVec2::Y), (-DVec2::Y, DVec2::X), (-DVec2::X, -DVec2::Y), (DVec2::Y, DVec2::X)]
        {
            let scan = Scan { first: DVec2::new(5.0, 7.0), along, across, count: [3, 2] };
            let surface = scan.surface(&source, None, (0..6).map(f64::from).collect(), |v| v == 4.0).unwrap();
            let RawShape::Grid { grid, z } = surface.shape else { panic!("a grid") };
            assert!(grid.u_step.perp_dot(grid.v_step) > 0.0);
            for n in 0..6 {
                let at = grid.node_at(DVec2::new(5.0, 7.0) + along * (n % 3) as f64 + across * (n / 3) as f64).round();
                let found = z[at.x as usize * grid.count[1] + at.y as usize];
                assert!(if n == 4 { found.is_nan() } else { found == n as f64 }, "{along} {across}: {n}, {found}");
            }
        }
    }

    #[test]
    fn steps_are_even_or_none() {
        assert_eq!(even_steps(&[10.0, 7.5, 5.0]), Some((10.0, -2.5)));
        for uneven in [&[1.0, 2.0, 4.0][..], &[1.0], &[], &[3.0, 3.0], &[f64::NAN, 1.0]] {
            assert_eq!(even_steps(uneven), None);
        }
    }
}
