//! Turns the options of volumes, horizons and faults into commands.

use super::args::{
    AttributeArgs, ExportArgs, FaultAction, FaultAddArgs, HorizonAction, HorizonAddArgs, ImportArgs, ReadingArgs,
    StackArgs,
};
use super::assembly;
use super::request::{Listing, Request, Usage, coloured, remove, rename};
use super::segy::segy_options;
use attribute::{DipSettings, SemblanceSettings};
use files::segy::WriteFormat;
use files::{
    Column, ExportOptions, Format, HorizonShape, ImportOptions, PlaceBy, SurfaceKind, ValueOrder, WhenRotated,
    ZPositive, ZUnit,
};
use project::command::{
    AddFault, AddHorizon, Age, AttributeKind, Command, ComputeAttribute, CutAlong, CutFault, GiveSticks, ImportVolume,
    MergeFaults, MoveStickPoint, RemovePick, SetContact, SetFaultExtent, SetTruncation, Spacing, StackHorizons,
};
use project::document::Polarity;
use project::error::Noun;
use project::memory_budget;
use survey::Contact;

/// Parses one of several words.
pub(super) fn word<T: Copy>(option: &str, text: &str, words: &[(&str, T)]) -> Result<T, Usage> {
    words.iter().find(|(word, _)| word.eq_ignore_ascii_case(text)).map(|(_, value)| *value).ok_or_else(|| {
        let known: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        format!("{option} {text}: expected {}", known.join(", "))
    })
}

pub(super) fn import(typed: ImportArgs) -> Result<ImportVolume, Usage> {
    let polarity = [("normal", Polarity::Normal), ("reverse", Polarity::Reverse)];
    Ok(ImportVolume {
        options: segy_options(&typed.segy)?,
        path: typed.survey,
        name: typed.name,
        polarity: word("--polarity", &typed.polarity, &polarity)?,
        memory_bytes: bytes("--memory", typed.memory.as_deref())?,
        moved: false,
        origin: None,
    })
}

/// Parses a number of bytes such as `2G`.
pub(super) fn bytes(option: &str, typed: Option<&str>) -> Result<Option<u64>, Usage> {
    let parsed = |text| {
        memory_budget::parse_bytes(text)
            .ok_or_else(|| format!("{option} {text}: expected bytes such as 2G, 800M or 64K"))
    };
    typed.map(parsed).transpose()
}

pub(super) fn attribute(typed: AttributeArgs) -> Result<Request, Usage> {
    let kinds = AttributeKind::ALL.map(|kind| (kind.name(), kind));
    let mut dip = DipSettings::default();
    dip.max_dip = typed.max_dip.unwrap_or(dip.max_dip);
    let command = ComputeAttribute {
        kind: word("--kind", &typed.kind, &kinds)?,
        name: typed.name,
        volume: typed.volume,
        dip,
        semblance: SemblanceSettings::default(),
        memory_bytes: bytes("--memory", typed.memory.as_deref())?,
    };
    Ok(Request::Change { project: typed.project, command: Command::Attribute(command) })
}

pub(super) fn import_options(typed: ReadingArgs) -> Result<ImportOptions, Usage> {
    let units = ZUnit::ALL.map(|unit| (unit.symbol(), unit));
    let lengths = ZUnit::LENGTHS.map(|unit| (unit.symbol(), unit));
    let signs = [("down", ZPositive::Down), ("up", ZPositive::Up)];
    let orders = [
        ("columns", ValueOrder::Columns),
        ("column", ValueOrder::Columns),
        ("rows", ValueOrder::Rows),
        ("row", ValueOrder::Rows),
    ];
    let shapes = [("map", HorizonShape::Map), ("any", HorizonShape::Any)];
    let places = [("lines", PlaceBy::Lines), ("xy", PlaceBy::World)];
    let z_factor = typed.z_factor.unwrap_or(1.0);
    if !(z_factor.is_finite() && z_factor != 0.0) {
        return Err(format!("--z-factor {z_factor}: expected a number other than 0"));
    }
    if let Some(gap) = typed.gap_m.filter(|gap| !(*gap > 0.0 && gap.is_finite())) {
        return Err(format!("--gap {gap}: expected a positive number of metres"));
    }
    let columns = typed.columns.as_deref().map(Column::parse_list).transpose().map_err(|unknown| {
        format!("--columns: \"{unknown}\" is no column; expected inline, crossline, x, y, z, name, stick or -")
    })?;
    Ok(ImportOptions {
        format: typed.format.as_deref().map(format).transpose()?,
        z_unit: typed.z_unit.as_deref().map(|t| word("--z-unit", t, &units)).transpose()?,
        xy_unit: typed.xy_unit.as_deref().map(|t| word("--xy-unit", t, &lengths)).transpose()?,
        z_positive: typed.z_positive.as_deref().map(|t| word("--z-positive", t, &signs)).transpose()?,
        z_factor,
        null: typed.null,
        name: None,
        select: typed.select,
        columns,
        place_by: typed.place_by.as_deref().map(|t| word("--place-by", t, &places)).transpose()?,
        gap_m: typed.gap_m,
        shape: typed.shape.as_deref().map(|t| word("--shape", t, &shapes)).transpose()?,
        orientations: None,
        value_order: typed.value_order.as_deref().map(|t| word("--value-order", t, &orders)).transpose()?,
    })
}

fn format(name: &str) -> Result<Format, Usage> {
    Format::from_name(name).ok_or_else(|| format!("--format {name}: expected one of {}", formats()))
}

fn formats() -> String {
    Format::all().map(Format::name).collect::<Vec<_>>().join(", ")
}

fn contact(option: &str, text: &str) -> Result<Contact, Usage> {
    word(option, text, &Contact::ALL.map(|contact| (contact.word(), contact)))
}

fn add_horizon(typed: HorizonAddArgs) -> Result<Request, Usage> {
    let age = match (typed.above, typed.below) {
        (Some(name), _) => Age::Above(name),
        (None, Some(name)) => Age::Below(name),
        (None, None) => Age::ByDepth,
    };
    let command = AddHorizon {
        path: typed.file,
        name: typed.name,
        contact: typed.contact.as_deref().map(|t| contact("--contact", t)).transpose()?.unwrap_or_default(),
        age,
        options: ImportOptions { orientations: typed.orientations, ..import_options(typed.reading)? },
    };
    Ok(Request::Change { project: typed.project, command: Command::AddHorizon(command) })
}

pub(super) fn horizon(action: HorizonAction) -> Result<Request, Usage> {
    Ok(match action {
        HorizonAction::Add(typed) => add_horizon(*typed)?,
        HorizonAction::List { project } => Request::List { project, what: Listing::Horizons },
        HorizonAction::Show { project, name } => Request::List { project, what: Listing::Horizon(name) },
        HorizonAction::Rename { project, from, to } => rename(project, Noun::Horizon, from, to),
        HorizonAction::Draw(typed) => assembly::draw(typed)?,
        HorizonAction::Track(typed) => assembly::track(typed)?,
        HorizonAction::Fill(typed) => assembly::fill(typed),
        HorizonAction::Smooth(typed) => assembly::smooth(typed),
        HorizonAction::Stack(typed) => stack(typed)?,
        HorizonAction::Replay(typed) => assembly::replay(typed),
        HorizonAction::Unpick { project, id } => {
            Request::Change { project, command: Command::RemovePick(RemovePick { id }) }
        }
        HorizonAction::Colour { project, name, colour } => coloured(project, Noun::Horizon, name, &colour)?,
        HorizonAction::Contact { project, name, contact: text } => {
            let contact = contact("contact", &text)?;
            Request::Change { project, command: Command::SetContact(SetContact { horizon: name, contact }) }
        }
        HorizonAction::Remove { project, name } => remove(project, Noun::Horizon, name),
    })
}

fn stack(typed: StackArgs) -> Result<Request, Usage> {
    let spacings = [("isochrons", Spacing::Isochrons), ("proportional", Spacing::Proportional)];
    let command = StackHorizons {
        count: typed.count,
        between: <[String; 2]>::try_from(typed.between).ok(),
        spacing: word("--spacing", &typed.spacing, &spacings)?,
        name: typed.name,
    };
    Ok(Request::Change { project: typed.project, command: Command::StackHorizons(command) })
}

fn add_fault(typed: FaultAddArgs) -> Result<Request, Usage> {
    let command = AddFault {
        path: typed.file,
        name: typed.name,
        truncated_by: typed.truncated_by,
        grown_m: if typed.extent.is_empty() { 0.0 } else { grown_m("--extent", &typed.extent)? },
        options: import_options(typed.reading)?,
    };
    Ok(Request::Change { project: typed.project, command: Command::AddFault(command) })
}

/// The metres by which a fault grows, of `drawn` or `grow M`.
fn grown_m(option: &str, words: &[String]) -> Result<f64, Usage> {
    let metres = match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["drawn"] => Some(0.0),
        ["grow", metres] => metres.parse().ok().filter(|metres: &f64| metres.is_finite() && *metres >= 0.0),
        _ => None,
    };
    metres.ok_or_else(|| format!("{option} {}: expected drawn, or grow and metres", words.join(" ")))
}

pub(super) fn fault(action: FaultAction) -> Result<Request, Usage> {
    Ok(match action {
        FaultAction::Add(typed) => add_fault(*typed)?,
        FaultAction::Pick(typed) => assembly::fault_pick(typed)?,
        FaultAction::Move { project, name, stick, point, to } => {
            let counted = |option: &str, number: usize| {
                number.checked_sub(1).ok_or_else(|| format!("{option} 0: they are counted from 1"))
            };
            let (stick, point) = (counted("--stick", stick)?, counted("--point", point)?);
            let command = MoveStickPoint { fault: name, stick, point, to: assembly::place("--to", &to)? };
            Request::Change { project, command: Command::MoveStickPoint(command) }
        }
        FaultAction::Propose(typed) => assembly::fault_propose(&typed)?,
        FaultAction::Accept { project, id, name } => assembly::fault_accept(project, id, name),
        FaultAction::Cut { project, fault, at, along, name } => {
            let along = if along == "strike" { CutAlong::Strike } else { CutAlong::Dip };
            let command = CutFault { fault, at: assembly::place("--at", &at)?, along, name };
            Request::Change { project, command: Command::CutFault(command) }
        }
        FaultAction::Merge { project, faults, name } => {
            let name = name.unwrap_or_else(|| faults[0].clone());
            Request::Change { project, command: Command::MergeFaults(MergeFaults { faults, name }) }
        }
        FaultAction::Sticks { project, fault } => {
            Request::Change { project, command: Command::GiveSticks(GiveSticks { fault }) }
        }
        FaultAction::List { project } => Request::List { project, what: Listing::Faults },
        FaultAction::Truncate { project, name, by } => {
            Request::Change { project, command: Command::SetTruncation(SetTruncation { fault: name, by }) }
        }
        FaultAction::Extent { project, name, extent } => {
            let grown_m = grown_m("extent", &extent)?;
            Request::Change { project, command: Command::SetFaultExtent(SetFaultExtent { fault: name, grown_m }) }
        }
        FaultAction::Colour { project, name, colour } => coloured(project, Noun::Fault, name, &colour)?,
        FaultAction::Rename { project, from, to } => rename(project, Noun::Fault, from, to),
        FaultAction::Remove { project, name } => remove(project, Noun::Fault, name),
    })
}

pub(super) fn export(typed: ExportArgs) -> Result<Request, Usage> {
    if typed.model {
        return Ok(Request::ExportModel(typed.try_into()?));
    }
    let address = typed.out.to_str().filter(|out| out.contains("://")).map(str::to_owned);
    if let (Some(url), None) = (&address, &typed.volume) {
        return Err(format!("{url}: only volumes are written to object storage; name one by --volume"));
    }
    if let Some(volume) = typed.volume {
        if let Some(url) = address {
            return match typed.format_code {
                Some(_) => Err(format!("{url}: --format-code is for SEG-Y files; object storage takes Zarr")),
                None => Ok(Request::UploadVolume { project: typed.project, url, volume }),
            };
        }
        let formats = [
            (1, WriteFormat::Ibm32),
            (3, WriteFormat::Int16),
            (5, WriteFormat::Ieee32),
            (8, WriteFormat::Int8),
            (11, WriteFormat::Uint16),
            (16, WriteFormat::Uint8),
        ];
        let format = typed.format_code.map(|code| {
            let found = formats.iter().find(|(known, _)| *known == code).map(|(_, format)| *format);
            found.ok_or_else(|| format!("--format-code {code}: expected 1, 3, 5, 8, 11 or 16"))
        });
        let format = format.transpose()?;
        return Ok(Request::ExportVolume { project: typed.project, out: typed.out, volume, format });
    }
    if let (Some(horizon), false) = (&typed.horizon, typed.values.is_empty()) {
        let (horizon, values, window) = (horizon.clone(), typed.values, typed.window);
        return Ok(Request::ExportValues { project: typed.project, out: typed.out, horizon, values, window });
    }
    let surface = match (typed.horizon, typed.fault) {
        (Some(name), _) => (SurfaceKind::Horizon, name),
        (None, Some(name)) => (SurfaceKind::Fault, name),
        (None, None) => return Ok(Request::ExportCandidates { project: typed.project, out: typed.out }),
    };
    let format = match typed.format.as_deref() {
        Some(name) => format(name)?,
        None => {
            let extension = typed.out.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
            // One that cannot be written is found last, so that it is refused by its name.
            let writable = Format::all().filter(|format| format.writes(surface.0));
            let found = writable.chain(Format::all()).find(|format| format.extension().eq_ignore_ascii_case(extension));
            found.ok_or_else(|| {
                format!("{}: the extension names no format; give --format, one of {}", typed.out.display(), formats())
            })?
        }
    };
    let rotated = [("resample", WhenRotated::Resample), ("refuse", WhenRotated::Refuse)];
    let when_rotated = typed.when_rotated.as_deref().map(|t| word("--when-rotated", t, &rotated)).transpose()?;
    let options = ExportOptions { when_rotated: when_rotated.unwrap_or_default() };
    Ok(Request::Export { project: typed.project, out: typed.out, surface, format, options })
}
