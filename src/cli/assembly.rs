//! Turns arguments for picks and faults into commands, and evaluates extractions.

use super::args::{
    ClimbArgs, DescendArgs, DrawArgs, FaultPickArgs, FaultProposeArgs, FillArgs, PickArgs, ReplayArgs, SmoothArgs,
    TimeArgs, TrackArgs,
};
use super::interpretation::bytes;
use super::report::Report;
use super::request::{Request, Usage};
use ::time::TimeSettings;
use anyhow::bail;
use interp::assembly::Operation;
use interp::faults::ProposeSettings;
use interp::holes::FillSettings;
use interp::refine::{SmoothSettings, TrackSettings};
use model::FaultNetwork;
use project::Project;
use project::command::{
    AcceptFault, Climb, Command, ComputeTime, DrawHorizon, FillHorizon, Move, MovePick, PickByTime, PickFault,
    PickNode, ReplayPicks, SmoothHorizon, TimeLevel, Unfit,
};
use project::document::Drawn;
use project::interpretation::candidates::Candidates;
use reference::evaluation::{
    EvaluateSettings, HorizonScore, PickScore, PickSettings, TruthIndex, count_picks, evaluate_with,
};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use survey::Progress;
use ttf::Colour;

/// Parses three numbers separated by commas.
pub(super) fn place(option: &str, text: &str) -> Result<[f64; 3], Usage> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    let wrong = || format!("{option} {text}: expected INLINE,CROSSLINE,Z, three numbers");
    let place: [f64; 3] = numbers.try_into().map_err(|_| wrong())?;
    if text.split(',').count() == 3 && place.iter().all(|number| number.is_finite()) { Ok(place) } else { Err(wrong()) }
}

pub(super) fn time(typed: TimeArgs) -> Result<Request, Usage> {
    let memory_bytes = bytes("--memory", typed.memory.as_deref())?;
    let command = ComputeTime { name: typed.name, settings: TimeSettings::default(), memory_bytes };
    Ok(Request::Change { project: typed.project, command: Command::Time(command) })
}

pub(super) fn pick(typed: PickArgs) -> Result<Request, Usage> {
    if typed.by_time {
        let command = PickByTime { level: TimeLevel::Through(place("--at", &typed.at)?), horizon: typed.horizon };
        return Ok(Request::Change { project: typed.project, command: Command::PickByTime(command) });
    }
    let climb = if typed.highest_valid { Climb::HighestValid } else { Climb::Levels(typed.up.unwrap_or(0)) };
    let command = PickNode {
        at: place("--at", &typed.at)?,
        horizon: typed.horizon,
        climb,
        operation: if typed.remove { Operation::Remove } else { Operation::Add },
        colour: colour(typed.colour)?,
    };
    Ok(Request::Change { project: typed.project, command: Command::Pick(command) })
}

pub(super) fn climb(typed: ClimbArgs) -> Request {
    let to = if typed.highest_valid { Move::HighestValid } else { Move::Up(typed.levels) };
    Request::Change { project: typed.project, command: Command::MovePick(MovePick { id: typed.id, to }) }
}

pub(super) fn descend(typed: DescendArgs) -> Request {
    let command = MovePick { id: typed.id, to: Move::Down(typed.levels) };
    Request::Change { project: typed.project, command: Command::MovePick(command) }
}

pub(super) fn fill(typed: FillArgs) -> Request {
    let settings = FillSettings { max_traces: typed.max_traces, along_reflection: typed.along_reflection };
    let command = Command::FillHorizon(FillHorizon { name: typed.name, settings });
    Request::Change { project: typed.project, command }
}

fn colour(typed: Option<String>) -> Result<Option<Colour>, Usage> {
    typed.map(|text| text.parse().map_err(|_| format!("--colour {text}: expected #rrggbb"))).transpose()
}

pub(super) fn draw(typed: DrawArgs) -> Result<Request, Usage> {
    let points = typed.line.iter().map(|text| place("--line", text)).collect::<Result<_, _>>()?;
    let part = Drawn::Line { points, snap: typed.snap };
    let command = DrawHorizon { horizon: typed.name, colour: colour(typed.colour)?, part };
    Ok(Request::Change { project: typed.project, command: Command::DrawHorizon(command) })
}

pub(super) fn track(typed: TrackArgs) -> Result<Request, Usage> {
    let window = TrackSettings { traces: typed.traces, samples: typed.samples };
    let part = Drawn::Tracked { at: place("--at", &typed.at)?, window };
    let command = DrawHorizon { horizon: typed.name, colour: colour(typed.colour)?, part };
    Ok(Request::Change { project: typed.project, command: Command::DrawHorizon(command) })
}

pub(super) fn smooth(typed: SmoothArgs) -> Request {
    let settings = SmoothSettings { radius: typed.radius, passes: typed.passes };
    let command = Command::SmoothHorizon(SmoothHorizon { name: typed.name, settings });
    Request::Change { project: typed.project, command }
}

pub(super) fn replay(typed: ReplayArgs) -> Request {
    let unfit = if typed.drop_unfit { Unfit::Drop } else { Unfit::Refuse };
    let command = Command::ReplayPicks(ReplayPicks { horizon: typed.name, unfit });
    Request::Change { project: typed.project, command }
}

pub(super) fn fault_pick(typed: FaultPickArgs) -> Result<Request, Usage> {
    let stick = |places: &Vec<String>| places.iter().map(|text| place("--stick", text)).collect();
    let sticks = typed.sticks.0.iter().map(stick).collect::<Result<Vec<Vec<_>>, Usage>>()?;
    let command = Command::PickFault(PickFault { name: typed.name, sticks });
    Ok(Request::Change { project: typed.project, command })
}

pub(super) fn fault_propose(typed: &FaultProposeArgs) -> Result<Request, Usage> {
    let usual = ProposeSettings::default();
    let settings = ProposeSettings {
        reach: typed.reach.unwrap_or(usual.reach),
        min_throw: typed.min_throw.unwrap_or(usual.min_throw),
        min_dip_deg: typed.min_dip.unwrap_or(usual.min_dip_deg),
        ..usual
    };
    if !(1..=200).contains(&settings.reach) {
        return Err(format!("--reach {}: expected 1 to 200 traces", settings.reach));
    }
    if !(settings.min_throw > 0.0 && settings.min_throw.is_finite()) {
        return Err(format!("--min-throw {}: expected a positive number of samples", settings.min_throw));
    }
    if !(settings.min_dip_deg > 0.0 && settings.min_dip_deg < 90.0) {
        return Err(format!("--min-dip {}: expected degrees between 0 and 90", settings.min_dip_deg));
    }
    Ok(Request::ProposeFaults { project: typed.project.clone(), settings })
}

pub(super) fn fault_accept(project: PathBuf, id: u32, name: String) -> Request {
    Request::Change { project, command: Command::AcceptFault(AcceptFault { id, name }) }
}

/// Measures the present extraction against a synthetic survey's truth.
pub(super) fn evaluate(project: &Path, truth: &Path, progress: &Progress) -> anyhow::Result<Report> {
    let project = Project::open(project)?;
    let truth = project::chains::demo::survey_files::read_truth(truth)?;
    let candidates = Candidates::load(project.facts(), progress)?;
    let size = candidates.forest.surfaces.size;
    if size != truth.size {
        bail!(
            "the extraction has {size:?} voxels, the truth {:?}; give the folder of the survey that the project was imported from",
            truth.size
        );
    }
    let (settings, picks) = (EvaluateSettings::default(), PickSettings::default());
    let index = TruthIndex::new(&truth);
    let found = evaluate_with(&candidates.forest.surfaces, &truth, &index, &settings);
    let none = FaultNetwork::none();
    let counts = count_picks(&candidates.forest, &truth, &index, &none, &settings, &picks, progress)?;
    let mut report = Report::text(found.to_string().trim_end());
    report.say("").say(format!("{:<16} {:>6} {:>8} {:>8}", "picks", "parts", "oracle", "replay"));
    for count in &counts {
        let shown = |count: reference::evaluation::PickCount| {
            if count.reached { count.picks.to_string() } else { format!("({})", count.picks) }
        };
        report.say(format!(
            "{:<16} {:>6} {:>8} {:>8}",
            count.name,
            count.parts,
            shown(count.oracle),
            shown(count.replay)
        ));
    }
    if counts.iter().any(|count| !(count.oracle.reached && count.replay.reached)) {
        report.say("(in brackets: a coverage of 95 % with a precision of 98 % was not reached)");
    }
    let horizons: Vec<Value> =
        found.horizons.iter().zip(&counts).map(|(score, count)| object(score, Some(count))).collect();
    report.field("horizons", horizons).field("all", object(&found.all, None));
    Ok(report)
}

fn object(score: &HorizonScore, picks: Option<&PickScore>) -> Value {
    let worst = score
        .worst
        .map(|worst| json!({ "surface": worst.surface, "triangles": worst.triangles, "purity": worst.purity() }));
    let parts: Vec<Value> = score
        .parts
        .iter()
        .map(|part| json!({ "blocks": part.blocks, "nodes": part.nodes, "coverage": part.coverage() }))
        .collect();
    json!({
        "name": score.name,
        "coverage": score.coverage(),
        "precision": score.precision(),
        "purity": score.purity,
        "worst_surface": worst,
        "surfaces": score.surfaces,
        "nodes": score.nodes,
        "parts": parts,
        "picks": picks.map(|picks| json!({ "oracle": picks.oracle, "replay": picks.replay })),
    })
}
