//! Whether the samples are what their format code and byte order say: what the numbers themselves look like.
//!
//! An IBM float is normalised: the first hexadecimal digit of its mantissa is never 0. Where IEEE floats have that digit,
//! an even exponent leaves 0 to 7, and 0 is an eighth of them. The exponents of amplitudes, and the first bytes of
//! integers, are few; those of numbers whose bytes are in another order are all there are. What leaves no doubt is taken,
//! and what only speaks against the code is told.

use super::error::SegyProblem;
use super::header::Traces;
use super::info::Findings;
use super::sample::{ByteOrder, SampleFormat};
use survey::remedy::{Note, Setting};

/// Traces that are looked at, and words of all of them at most.
const TRACES: usize = 48;
const WORDS: usize = 1 << 16;
/// Bytes of a trace that are looked at, at most: whole samples of any width.
const LONGEST: usize = 24 << 15;
/// Fewer words than this prove nothing.
const FEWEST: usize = 500;
/// Exponents that amplitudes have at most, of 128; and those that bytes in another order have at least.
const FEW_EXPONENTS: usize = 24;
const MANY_EXPONENTS: usize = 96;

/// Encoded samples of traces spread over the file, of long ones the first.
pub(super) fn traces_of(traces: &Traces<'_>, count: usize) -> Result<Vec<Vec<u8>>, SegyProblem> {
    let step = traces.count.div_ceil(count).max(1);
    let length = (traces.stride - traces.header_bytes).min(LONGEST);
    let of = |trace: usize| {
        let mut bytes = vec![0; length];
        let from = traces.start + trace as u64 * traces.stride as u64 + traces.header_bytes as u64;
        traces.bytes.copy(from, &mut bytes, Some(trace))?;
        Ok(bytes)
    };
    (0..traces.count).step_by(step).map(of).collect()
}

/// What the words of samples look like in one byte order.
struct Look {
    words: usize,
    /// Words whose first mantissa digit is 0, and 1 to 7.
    zero: usize,
    low: usize,
    /// Exponents of 7 bits that 99 % of the words have.
    exponents: usize,
    /// Words that are integers of 24 bits.
    small: usize,
    /// Words whose exponents are those of amplitudes, of either kind of float.
    float: usize,
    /// Words that are no number in IEEE.
    not_finite: usize,
}

impl Look {
    fn of(words: &[u32]) -> Self {
        let count = |is: &dyn Fn(u32) -> bool| words.iter().filter(|&&word| is(word)).count();
        let mut each = [0_usize; 128];
        words.iter().for_each(|word| each[(word >> 24 & 0x7f) as usize] += 1);
        each.sort_unstable_by(|a, b| b.cmp(a));
        let (mut sum, mut exponents) = (0, 0);
        while sum * 100 < words.len() * 99 && exponents < each.len() {
            sum += each[exponents];
            exponents += 1;
        }
        let digit = |word: u32| word >> 20 & 0xf;
        Self {
            words: words.len(),
            zero: count(&|word| digit(word) == 0),
            low: count(&|word| (1..=7).contains(&digit(word))),
            exponents,
            small: count(&|word| matches!(word >> 24, 0 | 0xff)),
            float: count(&|word| (0x28..=0x58).contains(&(word >> 24 & 0x7f))),
            not_finite: count(&|word| word >> 23 & 0xff == 0xff),
        }
    }

    /// The kind of float that they are without a doubt.
    fn float(&self) -> Option<SampleFormat> {
        let is_float = self.float * 10 >= self.words * 9 && self.exponents <= FEW_EXPONENTS;
        if !is_float || self.low < FEWEST / 2 {
            None
        } else if self.zero == 0 {
            Some(SampleFormat::Ibm32)
        } else {
            (self.zero * 25 > self.low && self.not_finite == 0).then_some(SampleFormat::Ieee32)
        }
    }
}

/// The format and byte order of the samples: as the header says, or what the numbers are without a doubt.
pub(super) fn settle(
    traces: &Traces<'_>,
    code: SampleFormat,
    order: ByteOrder,
    findings: &mut Findings,
) -> Result<(SampleFormat, ByteOrder), SegyProblem> {
    let four = [SampleFormat::Ibm32, SampleFormat::Ieee32, SampleFormat::Int32, SampleFormat::Uint32];
    if !four.contains(&code) {
        return Ok((code, order));
    }
    let bytes = traces_of(traces, TRACES)?;
    let words: Vec<u32> = bytes
        .iter()
        .flat_map(|trace| trace.as_chunks::<4>().0)
        .map(|word| u32::from_be_bytes(order.get(word, 0)))
        .filter(|word| word & 0x7fff_ffff != 0)
        .take(WORDS)
        .collect();
    let mut distinct = words.clone();
    distinct.sort_unstable();
    distinct.dedup();
    if distinct.len() < FEWEST / 2 || words.len() < FEWEST {
        return Ok((code, order));
    }
    let swapped: Vec<u32> = words.iter().map(|word| word.swap_bytes()).collect();
    let (straight, crossed) = (Look::of(&words), Look::of(&swapped));
    let is_crossed = straight.exponents >= MANY_EXPONENTS && crossed.exponents <= FEW_EXPONENTS;
    let look = if is_crossed { &crossed } else { &straight };
    let other = if order == ByteOrder::Big { ByteOrder::Little } else { ByteOrder::Big };
    if is_crossed {
        findings.warning(Note::from(format!(
            "the samples are {} while the headers are {}: in the order of the headers their exponents would be all there \
             are ({} of 128)",
            other.name(),
            order.name(),
            straight.exponents
        )));
    }
    let order = if is_crossed { other } else { order };
    let is_integer = matches!(code, SampleFormat::Int32 | SampleFormat::Uint32);
    let found = if look.small * 100 >= look.words * 99 {
        if is_integer { code } else { SampleFormat::Int32 }
    } else {
        look.float().unwrap_or(code)
    };
    let stated = Setting::SampleFormat.stated_as(code.name());
    if found != code {
        let why = match found {
            SampleFormat::Ibm32 => {
                format!("none of {} numbers begins with a hexadecimal digit of 0, as IBM floats", look.words)
            }
            SampleFormat::Ieee32 => format!(
                "{} of {} numbers begin with a hexadecimal digit of 0, which IBM floats never do",
                look.zero, look.words
            ),
            _ => "their first bytes are those of small integers".to_owned(),
        };
        findings.warning(Note::unless(
            format!("the format code says {}, but {why}: they are read as {}", code.name(), found.name()),
            stated,
        ));
    } else if code == SampleFormat::Ibm32 && look.zero * 200 > look.words {
        findings.warning(Note::unless(
            format!(
                "{} of {} samples are not normalised, which is unusual for IBM floats: they may be IEEE floats",
                look.zero, look.words
            ),
            Setting::SampleFormat.stated_as("ieee32"),
        ));
    }
    Ok((found, order))
}

/// The format of samples of another width than the code says, by their numbers.
pub(super) fn of_width(traces: &Traces<'_>, width: usize) -> Result<Option<SampleFormat>, SegyProblem> {
    Ok(match width {
        1 => {
            let bytes = traces_of(traces, TRACES)?.concat();
            // Amplitudes are mostly small: signed ones lie around 0 and 255, unsigned ones around 128.
            let near = |middle: u8| bytes.iter().filter(|byte| byte.wrapping_sub(middle).wrapping_add(32) < 64).count();
            Some(if near(128) > near(0) { SampleFormat::Uint8 } else { SampleFormat::Int8 })
        }
        2 => Some(SampleFormat::Int16),
        3 => Some(SampleFormat::Int24),
        4 => Some(SampleFormat::Ieee32),
        8 => Some(SampleFormat::Ieee64),
        _ => None,
    })
}
