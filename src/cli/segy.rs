//! Turns the options of SEG-Y files into settings.

use super::args::SegyArgs;
use super::interpretation::word;
use super::request::Usage;
use files::ZUnit;
use files::segy::{
    ByteOrder, KeptDuplicate, LengthUnit, LineSource, NullAmplitude, NumberType, SampleFormat, SegyOptions, TraceWeight,
};

pub(super) fn segy_options(typed: &SegyArgs) -> Result<SegyOptions, Usage> {
    let types = NumberType::ALL.map(|number_type| (number_type.name(), number_type));
    let formats: Vec<(&str, SampleFormat)> = SampleFormat::all().map(|format| (format.name(), format)).collect();
    let sources = [
        ("headers", LineSource::Headers),
        ("coordinates", LineSource::Coordinates),
        ("coordinates-swapped", LineSource::CoordinatesSwapped),
    ];
    let weights = [("apply", TraceWeight::Apply), ("inverse", TraceWeight::Inverse), ("ignore", TraceWeight::Ignore)];
    let vertical =
        [ZUnit::Milliseconds, ZUnit::Metres, ZUnit::Feet, ZUnit::SurveyFeet].map(|unit| (unit.symbol(), unit));
    let length = LengthUnit::ALL.map(|unit| (unit.symbol(), unit));
    let orders = [("big", ByteOrder::Big), ("little", ByteOrder::Little)];
    let kept = [("first", KeptDuplicate::First), ("last", KeptDuplicate::Last)];
    Ok(SegyOptions {
        inline_byte: typed.inline_byte,
        crossline_byte: typed.crossline_byte,
        line_type: one("--line-type", &typed.line_type, &types)?,
        line_source: one("--line-numbers", &typed.line_numbers, &sources)?.unwrap_or_default(),
        x_byte: typed.x_byte,
        y_byte: typed.y_byte,
        coordinate_type: one("--coordinate-type", &typed.coordinate_type, &types)?,
        scalar_byte: typed.scalar_byte,
        coordinate_scalar: typed.coordinate_scalar,
        byte_order: one("--byte-order", &typed.byte_order, &orders)?,
        format: one("--sample-format", &typed.sample_format, &formats)?,
        null: typed.null_amplitude.as_deref().map(null).transpose()?,
        interval: typed.interval,
        start: typed.start,
        vertical_unit: one("--vertical-unit", &typed.vertical_unit, &vertical)?,
        coordinate_unit: one("--coordinate-unit", &typed.coordinate_unit, &length)?,
        bin_m: typed.bin_m,
        trace_weight: one("--trace-weight", &typed.trace_weight, &weights)?.unwrap_or_default(),
        duplicates: one("--duplicates", &typed.duplicates, &kept)?,
    })
}

/// A null amplitude, or `none`.
fn null(text: &str) -> Result<NullAmplitude, Usage> {
    text.parse().map_err(|()| format!("--null-amplitude {text}: expected a number or none"))
}

/// Parses a word, if one was given.
fn one<T: Copy>(option: &str, typed: &Option<String>, words: &[(&str, T)]) -> Result<Option<T>, Usage> {
    typed.as_deref().map(|text| word(option, text, words)).transpose()
}
