//! Trace header fields of all traces, read in one pass over the file.
//!
//! Memory: 4 bytes a trace for a field that varies within a block of traces, none for a block in which it is constant.

use rayon::prelude::*;

use super::header::{Field, Traces};
use crate::progress::{Cancelled, Progress};

/// Headers of a block (240 bytes each) stay in the cache while its fields are read one after the other.
const BLOCK_BITS: usize = 10;
const BLOCK: usize = 1 << BLOCK_BITS;

#[derive(Debug, Clone)]
enum Block {
    Constant(i32),
    Varying(Vec<i32>),
}

/// One field of every trace.
#[derive(Debug, Clone)]
pub(super) struct Column {
    blocks: Vec<Block>,
    count: usize,
    /// Smallest and largest value.
    pub range: [i32; 2],
}

impl Column {
    /// The value in a trace.
    pub fn at(&self, trace: usize) -> i32 {
        match &self.blocks[trace >> BLOCK_BITS] {
            Block::Constant(value) => *value,
            Block::Varying(values) => values[trace & (BLOCK - 1)],
        }
    }

    /// The value of every trace in file order.
    pub fn iter(&self) -> impl Iterator<Item = i32> + '_ {
        (0..self.count).map(|trace| self.at(trace))
    }

    /// The value that all traces share, if they do.
    pub fn constant(&self) -> Option<i32> {
        (self.range[0] == self.range[1]).then_some(self.range[0])
    }

    /// Whether every trace holds the same value in both.
    pub fn same_as(&self, other: &Self) -> bool {
        self.range == other.range && self.iter().eq(other.iter())
    }
}

/// Fields of every trace.
#[derive(Debug, Clone)]
pub(super) struct Columns {
    fields: Vec<Field>,
    columns: Vec<Column>,
    /// What stands for a field that was not asked for: 0 throughout.
    absent: Column,
}

impl Columns {
    /// Reads `fields` of all traces.
    pub fn read(traces: &Traces<'_>, fields: &[Field], progress: &Progress) -> Result<Self, Cancelled> {
        let count = traces.count();
        progress.begin("reading trace headers", count as u64);
        let blocks: Vec<Vec<Block>> = (0..count.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let range = block * BLOCK..((block + 1) * BLOCK).min(count);
                let column = |field: &Field| {
                    Block::new(range.clone().map(|trace| field.get(traces.header(trace), traces.order)).collect())
                };
                let row = fields.iter().map(column).collect();
                progress.step(range.len() as u64)?;
                Ok(row)
            })
            .collect::<Result<_, Cancelled>>()?;
        let mut columns: Vec<Column> =
            fields.iter().map(|_| Column { blocks: Vec::new(), count, range: [i32::MAX, i32::MIN] }).collect();
        for row in blocks {
            for (column, block) in columns.iter_mut().zip(row) {
                let [low, high] = block.range();
                column.range = [column.range[0].min(low), column.range[1].max(high)];
                column.blocks.push(block);
            }
        }
        let absent = Column { blocks: vec![Block::Constant(0); count.div_ceil(BLOCK)], count, range: [0, 0] };
        Ok(Self { fields: fields.to_vec(), columns, absent })
    }

    /// The column of a field that was read; zeros for one that was not.
    pub fn get(&self, field: Field) -> &Column {
        self.fields.iter().position(|f| *f == field).map_or(&self.absent, |index| &self.columns[index])
    }
}

impl Block {
    fn new(values: Vec<i32>) -> Self {
        match values.first() {
            Some(first) if values.iter().all(|v| v == first) => Self::Constant(*first),
            _ => Self::Varying(values),
        }
    }

    fn range(&self) -> [i32; 2] {
        match self {
            Self::Constant(value) => [*value; 2],
            Self::Varying(values) => {
                values.iter().fold([i32::MAX, i32::MIN], |[low, high], &v| [low.min(v), high.max(v)])
            }
        }
    }
}
