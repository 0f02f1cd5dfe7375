//! The dialogue fields in which something about a file can be stated: an error or a note that asks for a statement
//! names the field to put it in.

use survey::remedy::Statement;
use survey::{Note, Remedy, Setting};

/// The name of the field that states this setting; `None` where no dialogue has such a field.
pub fn field(setting: Setting) -> Option<&'static str> {
    Some(match setting {
        Setting::InlineByte => "Inline",
        Setting::CrosslineByte => "Crossline",
        Setting::XByte => "X",
        Setting::YByte => "Y",
        Setting::VerticalUnit | Setting::ZUnit => "Vertical unit",
        Setting::Interval => "Sample interval",
        Setting::Start => "First sample",
        Setting::CoordinateUnit => "Unit of X and Y",
        Setting::CoordinateScalar => "Coordinate scalar",
        Setting::Bin => "Square bins, m",
        Setting::LineNumbers => "Line numbers",
        Setting::Duplicates => "Repeated traces",
        Setting::TraceWeight => "Trace weight",
        Setting::NullAmplitude => "No-data amplitude",
        Setting::ZPositive => "Sign",
        Setting::ZFactor => "Factor",
        Setting::Format => "Format",
        Setting::Columns => "Columns",
        Setting::Null => "Value of holes",
        Setting::PlaceBy => "Placed by",
        Setting::Shape => "Shape",
        Setting::ValueOrder => "Order of values",
        Setting::MdUnit => "Lengths along the well",
        Setting::XyUnit => "Unit of X and Y",
        Setting::Datum => "Datum above sea level, m",
        Setting::Head => "Head X, Y, m",
        Setting::WellInFile => "Name in the files",
        Setting::Checkshot => "Checkshots",
        Setting::SampleFormat
        | Setting::CoordinateType
        | Setting::LineType
        | Setting::ScalarByte
        | Setting::RotatedGrids => return None,
    })
}

/// Advice on what to do next.
pub fn advice(remedy: &Remedy) -> String {
    match ways(remedy) {
        Some(ways) => format!("state {ways}"),
        None => format!("this can be stated on the command line only: {remedy}"),
    }
}

/// The note, followed by the fields in which something else can be stated.
pub fn note(note: &Note) -> String {
    let mut note = note.clone();
    note.reword(ways);
    note.fact
}

/// The alternatives that can be stated entirely through fields, if there are any.
fn ways(remedy: &Remedy) -> Option<String> {
    let named = |way: &Vec<Statement>| -> Option<String> {
        let names: Option<Vec<String>> = way.iter().map(named).collect();
        names.map(|names| names.join(" and "))
    };
    let ways: Vec<String> = remedy.ways.iter().filter_map(named).collect();
    (!ways.is_empty()).then(|| ways.join(", or "))
}

fn named(statement: &Statement) -> Option<String> {
    let field = field(statement.setting)?;
    Some(statement.value.as_ref().map_or_else(|| format!("“{field}”"), |value| format!("{value} under “{field}”")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_to_be_stated_names_its_field() {
        assert_eq!(advice(&Setting::MdUnit.stated_as("m or ft")), "state m or ft under “Lengths along the well”");
        assert_eq!(advice(&Setting::Head.stated()), "state “Head X, Y, m”");
        assert_eq!(advice(&Setting::CoordinateScalar.stated_as(-100)), "state -100 under “Coordinate scalar”");
        let bytes = Remedy::all([Setting::InlineByte.stated_as(9), Setting::CrosslineByte.stated_as(21)]);
        let typed = Remedy::all([bytes.clone(), Setting::LineType.stated_as("i16")]);
        assert_eq!(advice(&Remedy::any([typed, bytes])), "state 9 under “Inline” and 21 under “Crossline”");
        assert!(advice(&Setting::SampleFormat.stated()).ends_with("on the command line only: sample format"));
        assert_eq!(note(&Note::unless("so", Setting::Datum.stated())), "so (if not: “Datum above sea level, m”)");
        assert_eq!(note(&Note::unless("so", Setting::CoordinateType.stated())), "so");
    }
}
