//! Trace header fields of all traces, read in one pass over the file.
//!
//! Memory: 4 bytes per trace for a field that varies within a block of traces, none for a block in which it
//! is constant.
//!
//! In the file, headers are a trace apart. They are first copied side by side, and the fields are then read
//! from the processor's cache.

use std::borrow::Cow;

use rayon::prelude::*;

use super::error::SegyProblem;
use super::field_sweep::Sweep;
use super::header::{Field, Traces, reinterpret};
use super::number_type::NumberType;
use super::sample::ByteOrder;
use super::text_bytes::NamedBytes;
use survey::progress::Progress;

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
pub(super) struct HeaderColumn {
    blocks: Vec<Block>,
    count: usize,
    /// Smallest and largest value.
    pub range: [i32; 2],
}

impl HeaderColumn {
    /// The value in a trace.
    pub(super) fn at(&self, trace: usize) -> i32 {
        match &self.blocks[trace >> BLOCK_BITS] {
            Block::Constant(value) => *value,
            Block::Varying(values) => values[trace & (BLOCK - 1)],
        }
    }

    /// The value of every trace in file order.
    pub(super) fn iter(&self) -> impl Iterator<Item = i32> + '_ {
        self.blocks.iter().enumerate().flat_map(|(index, block)| {
            let (values, constant, count) = match block {
                Block::Constant(value) => (&[][..], *value, BLOCK.min(self.count - (index << BLOCK_BITS))),
                Block::Varying(values) => (&values[..], 0, 0),
            };
            values.iter().copied().chain(std::iter::repeat_n(constant, count))
        })
    }

    /// The value of every trace in file order, side by side.
    pub(super) fn to_vec(&self) -> Vec<i32> {
        let mut all = Vec::with_capacity(self.count);
        for block in &self.blocks {
            match block {
                Block::Constant(value) => all.resize((all.len() + BLOCK).min(self.count), *value),
                Block::Varying(values) => all.extend_from_slice(values),
            }
        }
        all
    }

    /// The value that all traces share, if they do.
    pub(super) fn constant(&self) -> Option<i32> {
        (self.range[0] == self.range[1]).then_some(self.range[0])
    }

    /// Of numbers that were worked out, not read.
    pub(super) fn of(values: &[i32]) -> Self {
        let blocks: Vec<Block> = values.chunks(BLOCK).map(|values| Block::new(values.to_vec())).collect();
        let range = values.iter().fold([i32::MAX, i32::MIN], |[low, high], &v| [low.min(v), high.max(v)]);
        Self { blocks, count: values.len(), range }
    }

    /// Whether every trace holds the same value in both.
    pub(super) fn same_as(&self, other: &Self) -> bool {
        self.range == other.range && self.iter().eq(other.iter())
    }
}

/// What is known of all trace headers before they are read.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeaderLayout {
    /// Bytes of a trace header, extensions included.
    pub bytes: usize,
    /// Bytes that the textual header names.
    pub named: NamedBytes,
}

/// Fields of every trace.
#[derive(Debug, Clone)]
pub(super) struct Columns {
    fields: Vec<Field>,
    columns: Vec<HeaderColumn>,
    order: ByteOrder,
    layout: HeaderLayout,
    sweep: Option<Sweep>,
    /// What stands for a field that was not asked for: 0 throughout.
    absent: HeaderColumn,
}

impl Columns {
    /// Reads `fields` of all traces, and those of a sweep.
    pub(super) fn read(
        traces: &Traces<'_>,
        fields: &[Field],
        sweep: Option<Sweep>,
        named: NamedBytes,
        progress: &Progress,
    ) -> Result<Self, SegyProblem> {
        let count = traces.count;
        let fields = match sweep {
            Some(sweep) => &sweep.with_fields(fields.to_vec()),
            None => fields,
        };
        progress.begin("reading trace headers", count as u64);
        let blocks: Vec<Vec<Block>> = (0..count.div_ceil(BLOCK))
            .into_par_iter()
            .map_init(Default::default, |(headers, room): &mut (Vec<u8>, Vec<u8>), block| {
                let range = block * BLOCK..((block + 1) * BLOCK).min(count);
                traces.headers(range.clone(), headers, room)?;
                let column = |field: &Field| Block::new(field.get_all(headers, traces.header_bytes, traces.order));
                let row = fields.iter().map(column).collect();
                progress.step(range.len() as u64)?;
                Ok(row)
            })
            .collect::<Result<_, SegyProblem>>()?;
        let mut columns: Vec<HeaderColumn> =
            fields.iter().map(|_| HeaderColumn { blocks: Vec::new(), count, range: [i32::MAX, i32::MIN] }).collect();
        for row in blocks {
            for (column, block) in columns.iter_mut().zip(row) {
                let [low, high] = block.range();
                column.range = [column.range[0].min(low), column.range[1].max(high)];
                column.blocks.push(block);
            }
        }
        let layout = HeaderLayout { bytes: traces.header_bytes, named };
        let absent = HeaderColumn { blocks: vec![Block::Constant(0); count.div_ceil(BLOCK)], count, range: [0, 0] };
        Ok(Self { fields: fields.to_vec(), columns, order: traces.order, layout, sweep, absent })
    }

    /// Traces in the file.
    pub(super) fn count(&self) -> usize {
        self.absent.count
    }

    /// Line numbers of any type, from the field that was read for it, or from the 4-byte field that starts
    /// there.
    pub(super) fn numbers(&self, byte: u16, number_type: NumberType) -> Cow<'_, HeaderColumn> {
        match number_type {
            NumberType::F64 => Cow::Borrowed(self.get(Field::F64(byte))),
            NumberType::I32 => Cow::Borrowed(self.get(Field::I32(byte))),
            NumberType::I16 if self.fields.contains(&Field::I16(byte)) => Cow::Borrowed(self.get(Field::I16(byte))),
            NumberType::U16 if self.fields.contains(&Field::U16(byte)) => Cow::Borrowed(self.get(Field::U16(byte))),
            _ => {
                let values = self.get(Field::I32(byte)).iter().map(|v| reinterpret(v, number_type, self.order));
                Cow::Owned(HeaderColumn::of(&values.collect::<Vec<_>>()))
            }
        }
    }

    /// An IEEE float of 8 bytes, from the two 4-byte fields it is made of.
    pub(super) fn double(&self, byte: u16, trace: usize) -> f64 {
        let [first, second] = [byte, byte + 4].map(|byte| self.get(Field::I32(byte)).at(trace).cast_unsigned());
        let (high, low) = match self.order {
            ByteOrder::Big => (first, second),
            ByteOrder::Little => (second, first),
        };
        f64::from_bits(u64::from(high) << 32 | u64::from(low))
    }

    /// The number of another type that starts where a 4-byte field starts.
    pub(super) fn reinterpret(&self, field: i32, number_type: NumberType) -> i32 {
        reinterpret(field, number_type, self.order)
    }

    /// Whether every field of a sweep was read.
    pub(super) fn has_all_of(&self, sweep: Sweep) -> bool {
        self.sweep == Some(sweep)
    }

    /// What was known of the headers before they were read.
    pub(super) fn layout(&self) -> HeaderLayout {
        self.layout
    }

    /// The column of a field that was read; zeros for one that was not.
    pub(super) fn get(&self, field: Field) -> &HeaderColumn {
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
