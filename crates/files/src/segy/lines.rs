//! The lattice of line numbers: which trace lies at which inline and crossline.
//!
//! The step of an axis is the greatest common divisor of the differences of its numbers, so decimated and
//! stepped lines need no hint and a missing line remains a gap. The direction is the order in which the file
//! counts.

use glam::DVec2;

use super::columns::HeaderColumn;
use super::header::NO_INTEGER;
use super::options::KeptDuplicate;
use crate::lattice::gcd;
use survey::geometry::LineAxis;

/// Marks a lattice position without a trace.
pub(super) const NO_TRACE: u32 = u32::MAX;

/// A lattice has at most this many positions per trace; otherwise the numbers are not line numbers.
const MAX_PLACES_PER_TRACE: u64 = 64;

/// Traces on a lattice of line numbers.
#[derive(Debug, Clone)]
pub(super) struct LineLattice {
    pub inlines: LineAxis,
    pub crosslines: LineAxis,
    /// Trace at `[inline][crossline]`, the first if there are several; [`NO_TRACE`] if there is none.
    pub trace_of: Vec<u32>,
    /// Traces at a place that an earlier one holds.
    pub duplicates: usize,
    /// An example of such a trace.
    pub first_duplicate: Option<usize>,
    /// Traces without numbers (both 0 among others that are far from it, or no X and Y where those number
    /// them): not placed.
    pub unnumbered: usize,
    /// Whether the inline number changes less often than the crossline number along the file.
    pub inline_sorted: bool,
}

/// Why two columns are not line numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Flaw {
    /// Both are 0 throughout.
    AllZero,
    /// The inline number does not vary, and is this.
    OneInline(i32),
    /// The crossline number does not vary, and is this.
    OneCrossline(i32),
    /// The numbers would need a lattice of this many places.
    Scattered(u64),
}

impl LineLattice {
    /// Places every trace by its two numbers.
    pub(super) fn build(inline: &HeaderColumn, crossline: &HeaderColumn, kept: KeptDuplicate) -> Result<Self, Flaw> {
        match (inline.constant(), crossline.constant()) {
            (Some(0), Some(0)) => return Err(Flaw::AllZero),
            (Some(number), None) => return Err(Flaw::OneInline(number)),
            (None, Some(number)) => return Err(Flaw::OneCrossline(number)),
            _ => {}
        }
        // A float that is no integer is no line number.
        if inline.range[0] == NO_INTEGER || crossline.range[0] == NO_INTEGER {
            return Err(Flaw::Scattered(u64::MAX));
        }
        let skip = unnumbered(inline, crossline).then_some((0, 0));
        Self::place(inline, crossline, skip, kept)
    }

    /// Places every trace whose numbers are not `skip`, also on a single line.
    pub(super) fn place(
        inline: &HeaderColumn,
        crossline: &HeaderColumn,
        skip: Option<(i32, i32)>,
        kept: KeptDuplicate,
    ) -> Result<Self, Flaw> {
        let ranges = [inline.range, crossline.range];
        let (inline, crossline) = rayon::join(|| inline.to_vec(), || crossline.to_vec());
        let pairs = || inline.iter().copied().zip(crossline.iter().copied());
        let is_numbered = |pair: &(i32, i32)| Some(*pair) != skip;
        let limit = MAX_PLACES_PER_TRACE * inline.len() as u64 + 1024;
        let (inlines, crosslines) = rayon::join(
            || AxisNumbers::find(pairs().filter(is_numbered), ranges[0], limit),
            || AxisNumbers::find(pairs().filter(is_numbered).map(|(i, x)| (x, i)), ranges[1], limit),
        );
        let (inlines, crosslines) = (inlines?, crosslines?);
        let places = (inlines.count as u64).saturating_mul(crosslines.count as u64);
        if places > limit {
            return Err(Flaw::Scattered(places));
        }
        let (inlines, crosslines) = (inlines.line_axis(), crosslines.line_axis());
        let mut lattice = Self {
            inlines,
            crosslines,
            trace_of: vec![NO_TRACE; places as usize],
            duplicates: 0,
            first_duplicate: None,
            unnumbered: 0,
            inline_sorted: true,
        };
        let mut changes = [0_usize; 2];
        let mut last = None;
        for (trace, pair) in pairs().enumerate() {
            if Some(pair) == skip {
                lattice.unnumbered += 1;
                continue;
            }
            if let Some((inline, crossline)) = last.replace(pair) {
                changes[0] += usize::from(inline != pair.0);
                changes[1] += usize::from(crossline != pair.1);
            }
            let place =
                &mut lattice.trace_of[index_of(&inlines, pair.0) * crosslines.count + index_of(&crosslines, pair.1)];
            if *place == NO_TRACE {
                *place = trace as u32;
            } else {
                lattice.duplicates += 1;
                lattice.first_duplicate.get_or_insert(trace);
                if kept == KeptDuplicate::Last {
                    *place = trace as u32;
                }
            }
        }
        lattice.inline_sorted = changes[0] <= changes[1];
        Ok(lattice)
    }

    /// Places of the lattice.
    pub(super) fn places(&self) -> usize {
        self.trace_of.len()
    }

    /// Places that a trace holds.
    pub(super) fn filled(&self) -> usize {
        self.trace_of.iter().filter(|&&trace| trace != NO_TRACE).count()
    }

    /// Inlines and crosslines that hold a trace at all.
    pub(super) fn occupied_lines(&self) -> [usize; 2] {
        let mut inlines = vec![false; self.inlines.count];
        let mut crosslines = vec![false; self.crosslines.count];
        for (inline, crossline, _) in self.traces() {
            inlines[inline] = true;
            crosslines[crossline] = true;
        }
        [inlines, crosslines].map(|lines| lines.into_iter().filter(|&occupied| occupied).count())
    }

    /// Inline and crossline index of a place, counted along the crosslines.
    pub(super) fn index_at(&self, place: usize) -> DVec2 {
        DVec2::new((place / self.crosslines.count) as f64, (place % self.crosslines.count) as f64)
    }

    /// Inline and crossline index and trace of every filled place.
    pub(super) fn traces(&self) -> impl Iterator<Item = (usize, usize, usize)> + Clone + '_ {
        self.trace_of
            .iter()
            .enumerate()
            .filter(|(_, trace)| **trace != NO_TRACE)
            .map(|(place, &trace)| (place / self.crosslines.count, place % self.crosslines.count, trace as usize))
    }
}

fn index_of(axis: &LineAxis, number: i32) -> usize {
    ((i64::from(number) - i64::from(axis.first)) / i64::from(axis.step)) as usize
}

/// Whether traces with both numbers 0 stand apart from the lattice that the others make.
fn unnumbered(inline: &HeaderColumn, crossline: &HeaderColumn) -> bool {
    let contains_zero = |column: &HeaderColumn| column.range[0] <= 0 && column.range[1] >= 0;
    if !contains_zero(inline) || !contains_zero(crossline) {
        return false;
    }
    let mut zeros = 0_usize;
    let mut nearest = [i64::MAX; 2];
    let mut count = 0;
    for (i, x) in inline.iter().zip(crossline.iter()) {
        count += 1;
        if (i, x) == (0, 0) {
            zeros += 1;
        } else {
            nearest = [nearest[0].min(i64::from(i).abs()), nearest[1].min(i64::from(x).abs())];
        }
    }
    zeros > 0 && zeros < count && nearest[0].max(nearest[1]) > 1 && nearest[0].min(nearest[1]) > 0
}

/// The numbers of one axis.
struct AxisNumbers {
    low: i64,
    high: i64,
    step: i64,
    count: usize,
    descending: bool,
}

impl AxisNumbers {
    /// From `(number, number of the other axis)` in file order; numbers lie in `range`.
    fn find(pairs: impl Iterator<Item = (i32, i32)>, range: [i32; 2], limit: u64) -> Result<Self, Flaw> {
        let mut numbers = Numbers::within(range);
        // Steps up and down: among traces of one other line, and among all.
        let mut along = [0_usize; 2];
        let mut any = [0_usize; 2];
        let mut last: Option<(i32, i32)> = None;
        for (number, other) in pairs {
            if let Some((last_number, last_other)) = last.replace((number, other)) {
                if number == last_number {
                    continue;
                }
                any[usize::from(number < last_number)] += 1;
                if other == last_other {
                    along[usize::from(number < last_number)] += 1;
                }
            }
            numbers.insert(number);
        }
        let numbers = numbers.ascending();
        let (Some(&low), Some(&high)) = (numbers.first(), numbers.last()) else {
            return Err(Flaw::AllZero);
        };
        let (low, high) = (i64::from(low), i64::from(high));
        let step = numbers.windows(2).map(|w| i64::from(w[1]) - i64::from(w[0])).fold(0, gcd).max(1);
        let count = ((high - low) / step + 1) as u64;
        if count > limit || i32::try_from(step).is_err() {
            return Err(Flaw::Scattered(count));
        }
        let [up, down] = if along == [0, 0] { any } else { along };
        Ok(Self { low, high, step, count: count as usize, descending: down > up })
    }

    fn line_axis(&self) -> LineAxis {
        let (first, step) = if self.descending { (self.high, -self.step) } else { (self.low, self.step) };
        LineAxis { first: first as i32, step: step as i32, count: self.count }
    }
}

/// A set of line numbers.
enum Numbers {
    /// Which of the numbers from the first one on occur.
    Marked(i32, Vec<bool>),
    /// Those of a range too wide for that, some more than once.
    Listed(Vec<i32>),
}

impl Numbers {
    /// Marks are kept for so many numbers.
    const MAX_MARKS: i64 = 1 << 20;

    fn within([low, high]: [i32; 2]) -> Self {
        let count = i64::from(high) - i64::from(low) + 1;
        match usize::try_from(count) {
            Ok(marks) if count <= Self::MAX_MARKS => Self::Marked(low, vec![false; marks]),
            _ => Self::Listed(Vec::new()),
        }
    }

    fn insert(&mut self, number: i32) {
        match self {
            Self::Marked(low, marks) => marks[(i64::from(number) - i64::from(*low)) as usize] = true,
            Self::Listed(numbers) => {
                numbers.push(number);
                // Runs repeat for every line of the other axis: fold them now and then, so that memory stays
                // small.
                if numbers.len() >= 1 << 20 && numbers.len().is_power_of_two() {
                    numbers.sort_unstable();
                    numbers.dedup();
                }
            }
        }
    }

    /// Each once, from the least.
    fn ascending(self) -> Vec<i32> {
        match self {
            Self::Marked(low, marks) => {
                (low..=i32::MAX).zip(marks).filter(|(_, is_there)| *is_there).map(|(number, _)| number).collect()
            }
            Self::Listed(mut numbers) => {
                numbers.sort_unstable();
                numbers.dedup();
                numbers
            }
        }
    }
}
