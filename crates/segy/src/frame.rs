//! The frame of a file: its byte order and sample format, and the start, length and count of its traces.
//!
//! The length of the file decides: of the readings that its headers allow, the first with a whole number of
//! traces is taken.

use super::SegyOptions;
use super::error::SegyProblem;
use super::header::{BinaryHeader, FILE_HEADER_BYTES, Field, ORDER_CONSTANT, TRACE_HEADER_BYTES, Traces, at};
use super::info::Findings;
use super::sample::{ByteOrder, SampleFormat};
use super::text::{TEXT_BYTES, TextEncoding, decode_lines, find_end_of_text};

/// What the file headers say, checked against the file's length.
#[derive(Debug, Clone)]
pub(super) struct FileLayout {
    pub order: ByteOrder,
    pub format: SampleFormat,
    pub encoding: TextEncoding,
    /// Lines of the textual header.
    pub text: Vec<String>,
    /// Lines of the extended textual headers.
    pub extended_text: Vec<String>,
    pub binary: BinaryHeader,
    /// Samples per trace.
    pub samples: usize,
    /// Byte at which the traces begin, and the one after their end.
    pub data: [usize; 2],
    pub header_bytes: usize,
    pub stride: usize,
}

impl FileLayout {
    pub fn read(file: &[u8], options: &SegyOptions, findings: &mut Findings) -> Result<Self, SegyProblem> {
        refuse_text(file)?;
        if file.len() < FILE_HEADER_BYTES {
            return Err(SegyProblem::TooShort { bytes: file.len() as u64 });
        }
        let encoding = TextEncoding::of(&file[..TEXT_BYTES]);
        let text = decode_lines(&file[..TEXT_BYTES], encoding);
        findings.evidence(format!("text header: {}", encoding.name()));
        let (order, format) = order_and_format(file, options, findings)?;
        let binary = BinaryHeader::parse(file, order);
        let shape = Shape::find(file, &binary, order, format, encoding, findings)?;
        let extended_text = decode_lines(&file[FILE_HEADER_BYTES..shape.start.max(FILE_HEADER_BYTES)], encoding);
        Ok(Self {
            order,
            format,
            encoding,
            text,
            extended_text,
            binary,
            samples: shape.samples,
            data: [shape.start, shape.start + shape.traces * shape.stride(format)],
            header_bytes: shape.header_bytes,
            stride: shape.stride(format),
        })
    }

    /// The traces of `file`, which must be the one this frame was read from.
    pub fn traces<'a>(&self, file: &'a [u8]) -> Traces<'a> {
        Traces {
            bytes: &file[self.data[0]..self.data[1]],
            order: self.order,
            stride: self.stride,
            header_bytes: self.header_bytes,
        }
    }
}

fn refuse_text(file: &[u8]) -> Result<(), SegyProblem> {
    let start = &file[..file.len().min(FILE_HEADER_BYTES)];
    let whole = match std::str::from_utf8(start) {
        Ok(text) => text,
        // A character may be cut at the end of the excerpt.
        Err(e) if start.len() - e.valid_up_to() < 4 => std::str::from_utf8(&start[..e.valid_up_to()]).unwrap_or(""),
        Err(_) => "",
    };
    if whole.is_empty() || whole.chars().any(|c| c.is_control() && !matches!(c, '\n' | '\r' | '\t' | '\u{c}')) {
        return Ok(());
    }
    Err(SegyProblem::IsText { beginning: whole.trim_start().chars().take(40).collect() })
}

/// Byte order by, first, the option, the constant at 3297, the format code; then by which order fits better.
fn order_and_format(
    file: &[u8],
    options: &SegyOptions,
    findings: &mut Findings,
) -> Result<(ByteOrder, SampleFormat), SegyProblem> {
    let orders = [ByteOrder::Big, ByteOrder::Little];
    let headers = orders.map(|order| BinaryHeader::parse(file, order));
    let format_in = |header: &BinaryHeader| match options.format {
        Some(format) => Ok(Some(format)),
        None => SampleFormat::from_code(header.format),
    };
    let chosen = if let Some(order) = options.byte_order {
        findings.evidence(format!("byte order: {}, as stated", order.name()));
        order
    } else if let Some(k) = headers.iter().position(|h| h.order_constant == ORDER_CONSTANT) {
        findings.evidence(format!("byte order: {}, by the constant at byte 3297", orders[k].name()));
        orders[k]
    } else if headers[0].order_constant == ORDER_CONSTANT.rotate_left(16).swap_bytes() {
        return Err(SegyProblem::PairwiseSwapped);
    } else {
        let scores = [0, 1].map(|k| fitness(file, &headers[k], orders[k], format_in(&headers[k]).ok().flatten()));
        let known = headers.each_ref().map(|h| !matches!(format_in(h), Ok(None)));
        let k = match known {
            [true, false] => 0,
            [false, true] => 1,
            [false, false] => {
                return Err(SegyProblem::NotSegy { big: headers[0].format, little: headers[1].format });
            }
            [true, true] => usize::from(scores[1] > scores[0]),
        };
        findings.evidence(format!(
            "byte order: {} (the format code reads {} big-endian and {} little-endian; counts, interval and length speak {} : {} for them)",
            orders[k].name(),
            headers[0].format,
            headers[1].format,
            scores[0],
            scores[1],
        ));
        orders[k]
    };
    let header = &headers[usize::from(chosen == ByteOrder::Little)];
    let Some(format) = format_in(header)? else {
        return Err(SegyProblem::NotSegy { big: headers[0].format, little: headers[1].format });
    };
    findings.evidence(match options.format {
        Some(_) => format!("sample format: {}, as stated (byte 3225 holds {})", format.name(), header.format),
        None => format!("sample format: {} (code {} at byte 3225)", format.name(), header.format),
    });
    Ok((chosen, format))
}

/// How well a byte order explains the file, 0 to 6.
fn fitness(file: &[u8], header: &BinaryHeader, order: ByteOrder, format: Option<SampleFormat>) -> u32 {
    let Some(format) = format else { return 0 };
    let start = FILE_HEADER_BYTES + TEXT_BYTES * usize::from(header.extended_headers.max(0).unsigned_abs());
    let samples = usize::from(header.samples);
    let mut score = 0;
    if (100..=20_000).contains(&header.interval) {
        score += 1;
    }
    if samples > 0 {
        let stride = TRACE_HEADER_BYTES + samples * format.bytes();
        if file.len() > start && (file.len() - start).is_multiple_of(stride) {
            score += 3;
        }
        let trace = file.get(start..start + TRACE_HEADER_BYTES);
        let in_trace = trace.map_or(0, |header| Field::U16(at::SAMPLES).get(header, order));
        if in_trace == i32::from(header.samples) {
            score += 2;
        }
    }
    score
}

/// One reading of where the traces are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shape {
    start: usize,
    header_bytes: usize,
    samples: usize,
    traces: usize,
}

impl Shape {
    fn stride(&self, format: SampleFormat) -> usize {
        self.header_bytes + self.samples * format.bytes()
    }

    fn find(
        file: &[u8],
        binary: &BinaryHeader,
        order: ByteOrder,
        format: SampleFormat,
        encoding: TextEncoding,
        findings: &mut Findings,
    ) -> Result<Self, SegyProblem> {
        let starts = starts(file, binary, encoding, findings);
        let trailer_bytes = match binary.trailers {
            n @ 1.. if binary.has_revision_2() => TEXT_BYTES.saturating_mul(n as usize),
            _ => 0,
        };
        let end = file.len().saturating_sub(trailer_bytes);
        let extra = match binary.extra_trace_headers {
            n @ 1.. if binary.has_revision_2() => usize::from(n.unsigned_abs()),
            _ => 0,
        };
        let header_sizes = [TRACE_HEADER_BYTES * (1 + extra), TRACE_HEADER_BYTES];
        let mut preferred = None;
        for start in starts {
            let first_header = file.get(start..).and_then(|rest| rest.get(..TRACE_HEADER_BYTES));
            let in_trace = first_header.map_or(0, |header| Field::U16(at::SAMPLES).get(header, order)) as usize;
            let counts = sample_counts(binary, in_trace);
            for header_bytes in header_sizes {
                for &samples in &counts {
                    let mut shape = Self { start, header_bytes, samples, traces: 0 };
                    let preferred = *preferred.get_or_insert(shape);
                    let bytes = end.saturating_sub(start);
                    if bytes == 0 || !bytes.is_multiple_of(shape.stride(format)) {
                        continue;
                    }
                    let is_preferred = shape == preferred;
                    shape.traces = bytes / shape.stride(format);
                    if is_preferred {
                        shape.check_announced(binary, findings)?;
                    } else if !shape.headers_agree(file, order, format) {
                        continue;
                    } else {
                        findings.warning(format!(
                            "the headers announce {} samples a trace from byte {}, but the file's length fits \
                             {} from byte {}, which is what is read",
                            preferred.samples,
                            preferred.start + 1,
                            shape.samples,
                            shape.start + 1,
                        ));
                    }
                    if in_trace != 0 && in_trace != shape.samples {
                        findings.warning(format!(
                            "trace headers announce {in_trace} samples (byte 115), the binary header {}; the file's length fits {}",
                            counts[0], shape.samples
                        ));
                    }
                    return Ok(shape);
                }
            }
        }
        let Some(preferred) = preferred else {
            return Err(if end > FILE_HEADER_BYTES {
                SegyProblem::NoSampleCount
            } else {
                SegyProblem::NoTraces { bytes: file.len() as u64 }
            });
        };
        if end <= preferred.start {
            return Err(SegyProblem::NoTraces { bytes: file.len() as u64 });
        }
        Err(preferred.diagnose(&file[..end], order, format))
    }

    /// Whether the traces of a reading that is not the preferred one say its sample count themselves.
    fn headers_agree(&self, file: &[u8], order: ByteOrder, format: SampleFormat) -> bool {
        [0, self.traces / 2, self.traces - 1].iter().all(|trace| {
            let header = &file[self.start + trace * self.stride(format)..][..TRACE_HEADER_BYTES];
            Field::U16(at::SAMPLES).get(header, order) as usize == self.samples
        })
    }

    fn check_announced(&self, binary: &BinaryHeader, findings: &mut Findings) -> Result<(), SegyProblem> {
        let (announced, found) = (binary.trace_count, self.traces as u64);
        if !binary.has_revision_2() || announced == 0 || announced == found {
            return Ok(());
        }
        if announced > found {
            return Err(SegyProblem::TracesMissing { announced, found });
        }
        findings.warning(format!(
            "the header announces {announced} traces (byte 3513); the file holds {found}, all are read"
        ));
        Ok(())
    }

    /// Why no whole number of traces fits: lengths that vary, or an end cut off.
    fn diagnose(&self, file: &[u8], order: ByteOrder, format: SampleFormat) -> SegyProblem {
        let mut position = self.start;
        let mut trace = 0_u64;
        let mut first = 0;
        let mut different = None;
        while let Some(header) = file.get(position..).and_then(|rest| rest.get(..TRACE_HEADER_BYTES)) {
            let samples = Field::U16(at::SAMPLES).get(header, order) as usize;
            trace += 1;
            if trace == 1 {
                first = samples;
            } else if samples != first && different.is_none() {
                different = Some((trace, samples));
            }
            if samples == 0 {
                break;
            }
            position += self.header_bytes + samples * format.bytes();
        }
        if let Some((trace, other)) = different
            && position == file.len()
        {
            return SegyProblem::VariableLength { first, trace, other };
        }
        let (stride, bytes) = (self.stride(format) as u64, (file.len() - self.start) as u64);
        SegyProblem::Truncated {
            trace: bytes / stride + 1,
            present: bytes % stride,
            trace_bytes: stride,
            samples: self.samples,
        }
    }
}

/// Bytes at which traces may begin, the likeliest first.
fn starts(file: &[u8], binary: &BinaryHeader, encoding: TextEncoding, findings: &mut Findings) -> Vec<usize> {
    let mut starts = Vec::new();
    if binary.has_revision_2()
        && let Ok(first) = usize::try_from(binary.first_trace)
        && first >= FILE_HEADER_BYTES
    {
        starts.push(first);
    }
    match binary.extended_headers {
        n @ 1.. => starts.push(FILE_HEADER_BYTES + TEXT_BYTES * usize::from(n.unsigned_abs())),
        -1 => match find_end_of_text(&file[FILE_HEADER_BYTES..], encoding) {
            Some(n) => starts.push(FILE_HEADER_BYTES + TEXT_BYTES * n),
            None => findings.warning(
                "byte 3505 announces extended text headers closed by ((SEG: EndText)), which is nowhere in the \
                 file; none are read"
                    .to_owned(),
            ),
        },
        _ => {}
    }
    starts.push(FILE_HEADER_BYTES);
    starts.dedup();
    starts
}

/// Sample counts that the headers give, the likeliest first. Read unsigned: counts above 32767 occur.
fn sample_counts(binary: &BinaryHeader, in_trace: usize) -> Vec<usize> {
    let mut counts = Vec::new();
    if binary.has_revision_2() && binary.extended_samples > 0 {
        counts.push(binary.extended_samples as usize);
    }
    counts.extend([usize::from(binary.samples), in_trace].into_iter().filter(|&n| n > 0));
    counts.dedup();
    counts
}
