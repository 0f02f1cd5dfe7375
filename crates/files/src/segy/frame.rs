//! The frame of a file: its byte order and sample format, and the start, length and count of its traces.
//!
//! The length of the file decides: of the readings that its headers allow, the first with a whole number of
//! traces is taken.

use super::SegyOptions;
use super::bytes::Bytes;
use super::error::SegyProblem;
use super::evidence;
use super::header::{BinaryHeader, FILE_HEADER_BYTES, Field, ORDER_CONSTANT, TRACE_HEADER_BYTES, Traces, at};
use super::info::Findings;
use super::sample::{ByteOrder, SampleFormat};
use super::text::{TEXT_BYTES, TextEncoding, decode_lines, decode_texts, ends_text, is_text};
use survey::remedy::{Note, Setting};

/// Bytes of extended text that are read at most: 300 headers. The standard's stanzas take a few.
const MOST_EXTENDED_TEXT: usize = 300 * TEXT_BYTES;

/// Traces whose headers must say the same sample count.
const PROBES: usize = 16;

/// Sample counts that a field of 2 bytes may have folded: this many times 65536.
const MOST_FOLDS: usize = 16;

/// Extended text headers that are read at once.
const HEADERS_TOGETHER: usize = 80;

/// What the file headers say, checked against the file's length.
#[derive(Debug, Clone)]
pub(super) struct FileLayout {
    pub order: ByteOrder,
    pub format: SampleFormat,
    /// The order of the samples' bytes, which may be another one.
    pub sample_order: ByteOrder,
    pub encoding: TextEncoding,
    /// Lines of the textual header.
    pub text: Vec<String>,
    /// Lines of the extended textual headers.
    pub extended_text: Vec<String>,
    pub binary: BinaryHeader,
    /// Samples per trace.
    pub samples: usize,
    /// Byte at which the traces begin.
    pub start: u64,
    /// Count of traces.
    pub traces: usize,
    pub header_bytes: usize,
    pub stride: usize,
}

impl FileLayout {
    pub(super) fn read(file: &Bytes, options: &SegyOptions, findings: &mut Findings) -> Result<Self, SegyProblem> {
        let mut head = vec![0; file.len().min(FILE_HEADER_BYTES as u64) as usize];
        file.copy(0, &mut head, None)?;
        refuse_seismic_unix(file)?;
        refuse_text(&head)?;
        if head.len() < FILE_HEADER_BYTES {
            return Err(SegyProblem::TooShort { bytes: file.len() });
        }
        let encoding = TextEncoding::of(&head[..TEXT_BYTES]);
        let text = decode_lines(&head[..TEXT_BYTES], encoding);
        findings.evidence(format!("text header: {}", encoding.name()));
        let (order, format) = order_and_format(file, &head, options, findings)?;
        let binary = BinaryHeader::parse(&head, order);
        let (shape, width) = LayoutReading::find(file, &binary, order, format, encoding, options, findings)?;
        let extended = (shape.start.saturating_sub(FILE_HEADER_BYTES as u64) as usize).min(MOST_EXTENDED_TEXT);
        let extended_text = match file.get(FILE_HEADER_BYTES as u64, extended, None)? {
            Some(bytes) => decode_texts(&bytes, encoding),
            None => Vec::new(),
        };
        let traces = shape.traces(file, order, width);
        let coded =
            if width == format.bytes() { format } else { evidence::of_width(&traces, width)?.unwrap_or(format) };
        let (settled, sample_order) = match options.format {
            Some(_) => (format, order),
            None => evidence::settle(&traces, coded, order, findings)?,
        };
        if width != format.bytes() {
            findings.warning(Note::unless(
                format!(
                    "the format code says {}, of {} bytes a sample, but the trace headers follow one another at samples of \
                     {width}: they are read as {}",
                    format.name(),
                    format.bytes(),
                    settled.name()
                ),
                Setting::SampleFormat.stated(),
            ));
        }
        let format = settled;
        Ok(Self {
            order,
            format,
            sample_order,
            encoding,
            text,
            extended_text,
            binary,
            samples: shape.samples,
            start: shape.start,
            traces: shape.traces,
            header_bytes: shape.header_bytes,
            stride: shape.stride(format),
        })
    }

    /// The traces of `file`, which must be the one this frame was read from.
    pub(super) fn traces<'a>(&self, file: &'a Bytes) -> Traces<'a> {
        Traces {
            bytes: file,
            start: self.start,
            count: self.traces,
            order: self.order,
            stride: self.stride,
            header_bytes: self.header_bytes,
        }
    }
}

/// Seismic Unix files are traces alone: no file header, IEEE samples in the byte order of the machine.
fn refuse_seismic_unix(file: &Bytes) -> Result<(), SegyProblem> {
    /// Traces that must look alike.
    const PROBES: u64 = 8;
    for order in [ByteOrder::Big, ByteOrder::Little] {
        let shape_at = |start: u64| -> Result<Option<[u16; 2]>, SegyProblem> {
            let header = file.get(start, TRACE_HEADER_BYTES, None)?;
            Ok(header.map(|header| {
                [at::SAMPLES, at::INTERVAL].map(|byte| u16::from_be_bytes(order.get(&header, usize::from(byte) - 1)))
            }))
        };
        let Some(first @ [samples, interval]) = shape_at(0)? else { continue };
        let stride = TRACE_HEADER_BYTES as u64 + 4 * u64::from(samples);
        let traces = file.len() / stride;
        if samples < 2 || interval == 0 || traces < 2 || !file.len().is_multiple_of(stride) {
            continue;
        }
        let mut is_alike = true;
        for probe in 1..=PROBES.min(traces - 1) {
            is_alike &= shape_at(probe * (traces - 1) / PROBES.min(traces - 1) * stride)? == Some(first);
        }
        if is_alike {
            return Err(SegyProblem::SeismicUnix { traces, samples });
        }
    }
    Ok(())
}

fn refuse_text(start: &[u8]) -> Result<(), SegyProblem> {
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
    file: &Bytes,
    head: &[u8],
    options: &SegyOptions,
    findings: &mut Findings,
) -> Result<(ByteOrder, SampleFormat), SegyProblem> {
    let orders = [ByteOrder::Big, ByteOrder::Little];
    let headers = orders.map(|order| BinaryHeader::parse(head, order));
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
        let score = |k: usize| fitness(file, &headers[k], orders[k], format_in(&headers[k]).ok().flatten());
        let scores = [score(0)?, score(1)?];
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
fn fitness(
    file: &Bytes,
    header: &BinaryHeader,
    order: ByteOrder,
    format: Option<SampleFormat>,
) -> Result<u32, SegyProblem> {
    let Some(format) = format else { return Ok(0) };
    let start = (FILE_HEADER_BYTES + TEXT_BYTES * usize::from(header.extended_headers.max(0).unsigned_abs())) as u64;
    let samples = usize::from(header.samples);
    let mut score = 0;
    if (100..=20_000).contains(&header.interval) {
        score += 1;
    }
    if samples > 0 {
        let stride = (TRACE_HEADER_BYTES + samples * format.bytes()) as u64;
        if file.len() > start && (file.len() - start).is_multiple_of(stride) {
            score += 3;
        }
        let in_trace = samples_in_header(file, start, 0, order)?.unwrap_or(0);
        if in_trace == samples {
            score += 2;
        }
    }
    Ok(score)
}

/// The sample count that a trace header at `byte` states; none where the file ends before.
fn samples_in_header(file: &Bytes, byte: u64, trace: usize, order: ByteOrder) -> Result<Option<usize>, SegyProblem> {
    let header = file.get(byte, TRACE_HEADER_BYTES, Some(trace))?;
    Ok(header.map(|header| Field::U16(at::SAMPLES).get(&header, order) as usize))
}

/// One reading of where the traces are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LayoutReading {
    start: u64,
    header_bytes: usize,
    samples: usize,
    traces: usize,
}

impl LayoutReading {
    fn stride(&self, format: SampleFormat) -> usize {
        self.header_bytes + self.samples * format.bytes()
    }

    fn traces<'a>(&self, bytes: &'a Bytes, order: ByteOrder, width: usize) -> Traces<'a> {
        let (start, count, header_bytes) = (self.start, self.traces, self.header_bytes);
        Traces { bytes, start, count, order, stride: header_bytes + self.samples * width, header_bytes }
    }

    /// The first reading with a whole number of traces, and the bytes of its samples.
    fn find(
        file: &Bytes,
        binary: &BinaryHeader,
        order: ByteOrder,
        format: SampleFormat,
        encoding: TextEncoding,
        options: &SegyOptions,
        findings: &mut Findings,
    ) -> Result<(Self, usize), SegyProblem> {
        let starts = starts(file, binary, encoding, findings)?;
        let trailer_bytes = match binary.trailers {
            n @ 1.. if binary.has_revision_2() => (TEXT_BYTES as u64).saturating_mul(u64::from(n.unsigned_abs())),
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
            let in_trace = samples_in_header(file, start, 0, order)?.unwrap_or(0);
            let counts = sample_counts(binary, in_trace);
            for header_bytes in header_sizes {
                for &samples in &counts {
                    let mut shape = Self { start, header_bytes, samples, traces: 0 };
                    let preferred = *preferred.get_or_insert(shape);
                    let bytes = end.saturating_sub(start);
                    let stride = shape.stride(format) as u64;
                    if bytes == 0 || !bytes.is_multiple_of(stride) {
                        continue;
                    }
                    let is_preferred = shape == preferred;
                    shape.traces = (bytes / stride) as usize;
                    if is_preferred {
                        // Where headers are elsewhere than at this length, or in between, another one is theirs.
                        let other =
                            if in_trace == 0 { None } else { shape.other(file, end, order, format, options)? };
                        if let Some((other, width)) = other {
                            note_other(&other, samples, findings);
                            return Ok((other, width));
                        }
                        shape.check_announced(binary, findings)?;
                    } else if !shape.headers_agree(file, order, format.bytes())? {
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
                    return Ok((shape, format.bytes()));
                }
            }
        }
        let Some(preferred) = preferred else {
            return Err(if end > FILE_HEADER_BYTES as u64 {
                SegyProblem::NoSampleCount
            } else {
                SegyProblem::NoTraces { bytes: file.len() }
            });
        };
        if end <= preferred.start {
            return Err(SegyProblem::NoTraces { bytes: file.len() });
        }
        if let Some((other, width)) = preferred.other(file, end, order, format, options)? {
            note_other(&other, preferred.samples, findings);
            return Ok((other, width));
        }
        Err(preferred.diagnose(file, end, order, format)?)
    }

    /// Another size of samples, or count of them beyond what the header's 2 bytes hold, that divides the file into traces
    /// whose headers say their count: the shortest length, of which the others are multiples.
    fn other(
        &self,
        file: &Bytes,
        end: u64,
        order: ByteOrder,
        format: SampleFormat,
        options: &SegyOptions,
    ) -> Result<Option<(Self, usize)>, SegyProblem> {
        let widths = [1, 2, 3, 4, 8].into_iter().filter(|width| *width != format.bytes() && options.format.is_none());
        let more = (1..=MOST_FOLDS).map(|fold| (format.bytes(), self.samples + (fold << 16)));
        let own = [(format.bytes(), self.samples)].into_iter();
        let mut found: Vec<(Self, usize, u64)> = Vec::new();
        for (width, samples) in own.chain(widths.map(|width| (width, self.samples))).chain(more) {
            let mut shape = Self { samples, ..*self };
            let stride = (shape.header_bytes + samples * width) as u64;
            let bytes = end.saturating_sub(shape.start);
            shape.traces = (bytes / stride) as usize;
            let is_whole = bytes.is_multiple_of(stride) && shape.traces > 1;
            if is_whole && shape.headers_agree(file, order, width)? {
                found.push((shape, width, stride));
            }
        }
        let Some(&(shape, width, least)) = found.iter().min_by_key(|(_, _, stride)| *stride) else { return Ok(None) };
        let is_own = width == format.bytes() && shape.samples == self.samples;
        let is_sole = found.iter().all(|(_, _, stride)| stride.is_multiple_of(least));
        Ok((is_sole && !is_own).then_some((shape, width)))
    }

    /// Whether traces spread over the file say the sample count themselves, as far as 2 bytes hold it.
    fn headers_agree(&self, file: &Bytes, order: ByteOrder, width: usize) -> Result<bool, SegyProblem> {
        let traces = self.traces(file, order, width);
        let probes = PROBES.min(self.traces);
        for probe in 0..probes {
            let trace = probe * (self.traces - 1) / (probes - 1).max(1);
            let byte = self.start + trace as u64 * traces.stride as u64;
            if samples_in_header(file, byte, trace, order)? != Some(self.samples & 0xffff) {
                return Ok(false);
            }
        }
        Ok(true)
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

    /// Why no whole number of traces fits before the byte `end`: lengths that vary, or an end cut off.
    fn diagnose(
        &self,
        file: &Bytes,
        end: u64,
        order: ByteOrder,
        format: SampleFormat,
    ) -> Result<SegyProblem, SegyProblem> {
        let mut position = self.start;
        let mut trace = 0_u64;
        let mut first = 0;
        let mut different = None;
        while position + TRACE_HEADER_BYTES as u64 <= end {
            let Some(samples) = samples_in_header(file, position, trace as usize, order)? else { break };
            trace += 1;
            if trace == 1 {
                first = samples;
            } else if samples != first && different.is_none() {
                different = Some((trace, samples));
            }
            if samples == 0 {
                break;
            }
            position += (self.header_bytes + samples * format.bytes()) as u64;
        }
        if let Some((trace, other)) = different
            && position == end
        {
            return Ok(SegyProblem::VariableLength { first, trace, other });
        }
        let (stride, bytes) = (self.stride(format) as u64, end - self.start);
        Ok(SegyProblem::Truncated {
            trace: bytes / stride + 1,
            present: bytes % stride,
            trace_bytes: stride,
            samples: self.samples,
        })
    }
}

/// Says that the traces are of another length than the headers announce.
fn note_other(found: &LayoutReading, announced: usize, findings: &mut Findings) {
    if found.samples != announced {
        findings.warning(format!(
            "the headers hold {announced} samples a trace, which is all that 2 bytes hold of {}: the trace headers follow \
             one another at that length",
            found.samples
        ));
    }
}

/// Bytes at which traces may begin, the likeliest first.
fn starts(
    file: &Bytes,
    binary: &BinaryHeader,
    encoding: TextEncoding,
    findings: &mut Findings,
) -> Result<Vec<u64>, SegyProblem> {
    let after = |headers: u64| FILE_HEADER_BYTES as u64 + TEXT_BYTES as u64 * headers;
    let mut starts = Vec::new();
    if binary.has_revision_2() && binary.first_trace >= FILE_HEADER_BYTES as u64 {
        starts.push(binary.first_trace);
    }
    let written = texts(file, encoding)?;
    match binary.extended_headers {
        n @ 1.. => starts.push(after(u64::from(n.unsigned_abs()))),
        ..=-1 => match find_end_of_text(file)? {
            Some(n) => starts.push(after(n)),
            None => findings.warning(
                "byte 3505 announces extended text headers closed by ((SEG: EndText)), which is nowhere in the \
                 file; what looks like text is taken for them"
                    .to_owned(),
            ),
        },
        _ => {}
    }
    starts.push(after(written));
    starts.push(after(0));
    // No trace begins in the midst of text, however many headers are announced.
    let first = starts[0];
    let announced = u64::try_from(binary.extended_headers).map_or(first, after);
    starts.retain(|start| *start >= after(written) && *start < file.len());
    if starts.first().is_some_and(|start| *start != announced && *start != binary.first_trace) {
        findings.warning(format!(
            "byte 3505 announces {} extended text headers, and {written} are there",
            binary.extended_headers
        ));
    }
    if starts.is_empty() {
        starts.push(first);
    }
    starts.dedup();
    Ok(starts)
}

/// How many blocks behind the file header are text.
fn texts(file: &Bytes, encoding: TextEncoding) -> Result<u64, SegyProblem> {
    let (mut count, mut from) = (0, FILE_HEADER_BYTES as u64);
    while count < (MOST_EXTENDED_TEXT / TEXT_BYTES) as u64 {
        match file.get(from, TEXT_BYTES, None)? {
            Some(block) if is_text(&block, encoding.of_block(&block)) => {
                (count, from) = (count + 1, from + TEXT_BYTES as u64);
            }
            _ => break,
        }
    }
    Ok(count)
}

/// Number of the extended header (from 1) that holds the end-of-text stanza.
fn find_end_of_text(file: &Bytes) -> Result<Option<u64>, SegyProblem> {
    let (mut room, mut number, mut from) = (Vec::new(), 0, FILE_HEADER_BYTES as u64);
    while from + TEXT_BYTES as u64 <= file.len() {
        let to = (from + (TEXT_BYTES * HEADERS_TOGETHER) as u64).min(file.len());
        for block in file.read(from..to, &mut room, None)?.chunks_exact(TEXT_BYTES) {
            number += 1;
            if ends_text(block) {
                return Ok(Some(number));
            }
        }
        from = to;
    }
    Ok(None)
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
