//! The options of the command line in which something about a file can be stated: an error or a note that asks for a
//! statement names the option.

use survey::remedy::Statement;
use survey::{Note, Remedy, Setting};

/// The option that states a setting, with a name for its value where the option's own does not explain it.
fn option(setting: Setting) -> (&'static str, &'static str) {
    match setting {
        Setting::SampleFormat => ("--sample-format", ""),
        Setting::NullAmplitude => ("--null-amplitude", ""),
        Setting::Interval => ("--interval", ""),
        Setting::Start => ("--start", ""),
        Setting::VerticalUnit => ("--vertical-unit", ""),
        Setting::CoordinateUnit => ("--coordinate-unit", ""),
        Setting::CoordinateType => ("--coordinate-type", ""),
        Setting::Bin => ("--bin", ""),
        Setting::InlineByte => ("--inline-byte", ""),
        Setting::CrosslineByte => ("--crossline-byte", ""),
        Setting::LineType => ("--line-type", ""),
        Setting::LineNumbers => ("--line-numbers", ""),
        Setting::XByte => ("--x-byte", ""),
        Setting::YByte => ("--y-byte", ""),
        Setting::ScalarByte => ("--scalar-byte", ""),
        Setting::CoordinateScalar => ("--coordinate-scalar", ""),
        Setting::Duplicates => ("--duplicates", ""),
        Setting::TraceWeight => ("--trace-weight", ""),
        Setting::Format => ("--format", ""),
        Setting::Columns => ("--columns", ""),
        Setting::ZUnit => ("--z-unit", ""),
        Setting::ZPositive => ("--z-positive", ""),
        Setting::ZFactor => ("--z-factor", ""),
        Setting::Null => ("--null", ""),
        Setting::PlaceBy => ("--place-by", ""),
        Setting::Shape => ("--shape", ""),
        Setting::ValueOrder => ("--value-order", ""),
        Setting::MdUnit => ("--md-unit", ""),
        Setting::XyUnit => ("--xy-unit", ""),
        Setting::RotatedGrids => ("--when-rotated", ""),
        Setting::Datum => ("--kb", " M"),
        Setting::Head => ("--head", " X,Y"),
        Setting::WellInFile => ("--well-in-file", " NAME"),
        Setting::Checkshot => ("--checkshot", " FILE"),
    }
}

fn typed(statement: &Statement) -> String {
    let (option, value_name) = option(statement.setting);
    statement.value.as_ref().map_or_else(|| format!("{option}{value_name}"), |value| format!("{option} {value}"))
}

/// What to type, for example `--x-byte 73 --y-byte 77 or --bin`.
pub(super) fn remedy(remedy: &Remedy) -> String {
    let ways = remedy.ways.iter().map(|way| way.iter().map(typed).collect::<Vec<_>>().join(" "));
    ways.collect::<Vec<_>>().join(" or ")
}

/// Names the options in every note of a report.
pub(super) fn name_in<'a>(notes: impl IntoIterator<Item = &'a mut Note>) {
    notes.into_iter().for_each(|note| note.reword(|ways| Some(remedy(ways))));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remedy_is_what_to_type() {
        let bytes = Remedy::all([Setting::InlineByte.stated_as(9), Setting::CrosslineByte.stated_as(21)]);
        let either = Remedy::any([bytes, Setting::LineNumbers.stated()]);
        assert_eq!(remedy(&either), "--inline-byte 9 --crossline-byte 21 or --line-numbers");
        assert_eq!(remedy(&Setting::Head.stated()), "--head X,Y");
        let mut note = Note::unless("so", Setting::MdUnit.stated_as("ft"));
        name_in([&mut note]);
        assert_eq!(note.to_string(), "so (if not: --md-unit ft)");
    }
}
