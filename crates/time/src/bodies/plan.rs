//! A part of the survey's map, with the traces that something covers: distances from trace to trace, gaps closed, holes
//! filled, depths carried into gaps.

use std::collections::VecDeque;

/// Traces of a rectangle of the survey.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    /// Inline and crossline index of its first trace.
    pub(super) low: [usize; 2],
    /// Inlines and crosslines.
    pub(super) size: [usize; 2],
    /// Whether a trace is covered, `[inline][crossline]`.
    pub(super) covers: Vec<bool>,
}

/// Steps to the eight neighbours, one after another around.
const AROUND: [[isize; 2]; 8] = [[-1, -1], [-1, 0], [-1, 1], [0, 1], [1, 1], [1, 0], [1, -1], [0, -1]];
/// Those to the four that share a side.
const BESIDE: [usize; 4] = [1, 3, 5, 7];

impl Plan {
    /// A plan around traces of a survey of `survey` traces, `margin` wider than they are.
    pub(super) fn around(traces: &[[usize; 2]], margin: usize, survey: [usize; 2]) -> Self {
        let bounds = |axis: usize| {
            let all = || traces.iter().map(|trace| trace[axis]);
            let low = all().min().unwrap_or(0).saturating_sub(margin);
            (low, (all().max().unwrap_or(0) + margin + 1).min(survey[axis]) - low)
        };
        let (x, y) = (bounds(0), bounds(1));
        let mut plan = Self { low: [x.0, y.0], size: [x.1, y.1], covers: vec![false; x.1 * y.1] };
        for trace in traces {
            let cell = plan.cell(*trace);
            plan.covers[cell] = true;
        }
        plan
    }

    /// The index of a trace of the plan.
    pub(super) fn cell(&self, [x, y]: [usize; 2]) -> usize {
        (x - self.low[0]) * self.size[1] + y - self.low[1]
    }

    /// The inline and crossline index of a cell.
    pub(super) fn trace(&self, cell: usize) -> [usize; 2] {
        [self.low[0] + cell / self.size[1], self.low[1] + cell % self.size[1]]
    }

    /// The neighbour of a cell by a step of [`AROUND`].
    fn neighbour(&self, cell: usize, [dx, dy]: [isize; 2]) -> Option<usize> {
        let x = (cell / self.size[1]).checked_add_signed(dx).filter(|x| *x < self.size[0])?;
        let y = (cell % self.size[1]).checked_add_signed(dy).filter(|y| *y < self.size[1])?;
        Some(x * self.size[1] + y)
    }

    /// The cells beside one, corners included.
    pub(super) fn around_cell(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        AROUND.into_iter().filter_map(move |step| self.neighbour(cell, step))
    }

    /// Steps, diagonal ones included, from each cell to the closest for which `is_there` holds; `usize::MAX` without any.
    fn steps(&self, is_there: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut steps = vec![usize::MAX; self.covers.len()];
        let mut next: VecDeque<usize> = (0..steps.len()).filter(|cell| is_there(*cell)).collect();
        next.iter().for_each(|cell| steps[*cell] = 0);
        while let Some(cell) = next.pop_front() {
            for other in self.around_cell(cell) {
                if steps[other] == usize::MAX {
                    steps[other] = steps[cell] + 1;
                    next.push_back(other);
                }
            }
        }
        steps
    }

    /// Steps from each cell to the closest that is not covered, 0 where the cell itself is not; those outside of the survey
    /// are not covered.
    pub(super) fn depths(&self, survey: [usize; 2]) -> Vec<usize> {
        let mut steps = self.steps(|cell| !self.covers[cell]);
        for (cell, depth) in steps.iter_mut().enumerate() {
            let edge = self.trace(cell).into_iter().zip(survey).map(|(at, count)| (at + 1).min(count - at));
            *depth = edge.fold(*depth, usize::min);
        }
        steps
    }

    /// The same with gaps of up to `2 reach` traces closed and with holes filled.
    pub(super) fn closed(self, reach: usize) -> Self {
        let grown = self.steps(|cell| self.covers[cell]);
        let kept = self.steps(|cell| grown[cell] > reach);
        let covers: Vec<bool> = kept.into_iter().map(|steps| steps > reach).collect();
        let plan = Self { covers, ..self };
        let mut is_outside = vec![false; plan.covers.len()];
        let [nx, ny] = plan.size;
        let is_border = |cell: &usize| {
            let (x, y) = (cell / ny, cell % ny);
            !plan.covers[*cell] && (x == 0 || y == 0 || x + 1 == nx || y + 1 == ny)
        };
        let mut next: Vec<usize> = (0..is_outside.len()).filter(is_border).collect();
        next.iter().for_each(|cell| is_outside[*cell] = true);
        while let Some(cell) = next.pop() {
            for step in BESIDE {
                if let Some(other) = plan.neighbour(cell, AROUND[step]).filter(|&other| !plan.covers[other])
                    && !is_outside[other]
                {
                    is_outside[other] = true;
                    next.push(other);
                }
            }
        }
        Self { covers: is_outside.into_iter().map(|outside| !outside).collect(), ..plan }
    }

    /// Covers nothing but the largest part of what is left without its outermost trace, and what that touches. Where its rim
    /// would touch itself, in a corner or across a gap of one trace, it is closed.
    pub(super) fn whole(self) -> Self {
        let inner = self.steps(|cell| !self.covers[cell]);
        let mut part = vec![usize::MAX; self.covers.len()];
        let mut largest = (0, usize::MAX);
        for first in 0..part.len() {
            if inner[first] < 2 || inner[first] == usize::MAX || part[first] != usize::MAX {
                continue;
            }
            let (mut count, mut next) = (0, vec![first]);
            part[first] = first;
            while let Some(cell) = next.pop() {
                count += 1;
                for other in BESIDE.into_iter().filter_map(|step| self.neighbour(cell, AROUND[step])) {
                    if inner[other] >= 2 && part[other] == usize::MAX {
                        part[other] = first;
                        next.push(other);
                    }
                }
            }
            largest = largest.max((count, first));
        }
        let kept = self.steps(|cell| part[cell] == largest.1 && largest.0 > 0);
        let mut plan = Self { covers: kept.into_iter().map(|steps| steps <= 1).collect(), ..self };
        loop {
            let touched: Vec<usize> = (0..part.len()).filter(|&cell| plan.sides(cell) > 1).collect();
            if touched.is_empty() {
                return plan;
            }
            touched.into_iter().for_each(|cell| plan.covers[cell] = true);
        }
    }

    /// On how many sides of a cell that is not covered there are covered ones, apart from one another.
    fn sides(&self, cell: usize) -> usize {
        if self.covers[cell] {
            return 0;
        }
        let near = AROUND.map(|step| self.neighbour(cell, step).is_some_and(|other| self.covers[other]));
        (0..near.len()).filter(|&n| near[n] && !near[(n + near.len() - 1) % near.len()]).count()
    }

    /// Values of the covered cells: those that are NaN are means of their neighbours, from the known ones inwards, then all
    /// are smoothed by the median and the mean of those around them.
    pub(super) fn filled(&self, mut values: Vec<f32>) -> Vec<f32> {
        loop {
            let missing = (0..values.len()).filter(|&cell| self.covers[cell] && values[cell].is_nan());
            let found: Vec<(usize, f32)> = missing
                .filter_map(|cell| {
                    let near = self.around_cell(cell).map(|other| values[other]).filter(|value| value.is_finite());
                    let (sum, count) = near.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
                    (count > 0).then(|| (cell, sum / count as f32))
                })
                .collect();
            if found.is_empty() {
                break;
            }
            found.into_iter().for_each(|(cell, value)| values[cell] = value);
        }
        for is_median in [true, false] {
            values = (0..values.len())
                .map(|cell| {
                    if !self.covers[cell] {
                        return f32::NAN;
                    }
                    let around = self.around_cell(cell).filter(|&other| self.covers[other]).map(|other| values[other]);
                    let mut near: Vec<f32> = around.chain([values[cell]]).filter(|value| value.is_finite()).collect();
                    near.sort_by(f32::total_cmp);
                    if is_median {
                        near.get(near.len() / 2).copied().unwrap_or(f32::NAN)
                    } else {
                        near.iter().sum::<f32>() / near.len() as f32
                    }
                })
                .collect();
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_closed_holes_filled_and_necks_of_a_trace_cut() {
        // A square of 9 with a hole of 3 traces and a slit, a neck of one trace, and a second square of 5.
        let square = |low: usize, wide: usize| {
            (low..low + wide).flat_map(move |x| (low..low + wide).map(move |y| [x, y])).collect::<Vec<_>>()
        };
        let mut traces = square(3, 9);
        traces.retain(|[x, y]| !((6..9).contains(x) && *y == 7 || *x == 5 && *y < 5));
        traces.extend((12..15).map(|n| [n, n]));
        traces.extend(square(15, 5));
        let plan = Plan::around(&traces, 3, [40, 40]);
        assert_eq!((plan.low, plan.size), ([0, 0], [23, 23]));
        let whole = plan.closed(1).whole();
        let covered: Vec<[usize; 2]> =
            (0..whole.covers.len()).filter(|&cell| whole.covers[cell]).map(|cell| whole.trace(cell)).collect();
        assert!(square(3, 9).iter().all(|trace| covered.contains(trace)), "{covered:?}");
        assert!(covered.iter().all(|[x, _]| *x < 13), "{covered:?}");
        let depths = whole.depths([40, 40]);
        assert_eq!(depths[whole.cell([7, 7])], 5);
        assert_eq!(depths[whole.cell([3, 7])], 1);
        // Known on one side alone, the values of the others follow.
        let values =
            (0..whole.covers.len()).map(|cell| if whole.trace(cell)[0] < 6 { 4.0 } else { f32::NAN }).collect();
        assert!(whole.filled(values).iter().zip(&whole.covers).all(|(value, covers)| !covers || *value == 4.0));
    }

    #[test]
    fn the_edge_of_the_survey_is_an_edge() {
        let traces: Vec<[usize; 2]> = (0..5).flat_map(|x| (0..7).map(move |y| [x, y])).collect();
        let plan = Plan::around(&traces, 2, [5, 7]);
        assert_eq!((plan.low, plan.size), ([0, 0], [5, 7]));
        let depths = plan.depths([5, 7]);
        assert_eq!((depths[plan.cell([2, 3])], depths[plan.cell([0, 3])]), (3, 1));
    }
}
