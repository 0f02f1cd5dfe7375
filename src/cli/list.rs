//! Listings of a project's parts.

use super::report::Report;
use super::request::Listing;
use super::well;
use project::Project;
use project::content;
use project::error::Noun;
use project::pictures::scene;
use project::styles;
use serde_json::{Value, json};
use survey::Progress;
use ttf::{LayerStyle, LayerTtf};

/// Makes a listing.
pub(super) fn list(project: &Project, what: Listing) -> anyhow::Result<Report> {
    match what {
        Listing::Volumes => Ok(volumes(project)),
        Listing::Horizons => Ok(horizons(project)),
        Listing::Horizon(name) => show_horizon(project, &name),
        Listing::Faults => Ok(faults(project)),
        Listing::Wells => Ok(well::list(project)),
        Listing::Well(name) => well::show(project, &name),
        Listing::Layers => layers(project),
        Listing::Scalars => Ok(scalars(project)),
        Listing::Scenes => Ok(scenes(project)),
        Listing::Notes => Ok(notes(project)),
        Listing::Scene(name) => show_scene(project, name.as_deref()),
    }
}

fn volumes(project: &Project) -> Report {
    let document = project.document();
    let mut report = Report::default();
    for entry in &document.volumes {
        let own = if entry.geometry.is_some() { ", on a lattice of its own" } else { "" };
        report.say(format!(
            "{}: {}, {} polarity, clipped at {}{own}",
            entry.name, entry.origin, entry.polarity, entry.clip
        ));
    }
    if document.volumes.is_empty() {
        report.say("no volumes");
    }
    report.field("volumes", &document.volumes);
    report
}

fn notes(project: &Project) -> Report {
    let document = project.document();
    let mut report = Report::default();
    for (number, entry) in (1..).zip(&document.notes) {
        let [inline, crossline, z] = entry.at;
        let scene = entry.scene.as_ref().map_or_else(String::new, |scene| format!(", in scene {scene}"));
        report.say(format!("{number}: {} (at {inline},{crossline},{z}{scene})", entry.text));
    }
    if document.notes.is_empty() {
        report.say("no notes");
    }
    report.field("notes", &document.notes);
    report
}

fn horizons(project: &Project) -> Report {
    let document = project.document();
    let mut report = Report::default();
    for entry in &document.horizons {
        report.say(format!("{}: {}, {}", entry.name, entry.contact.word(), entry.history()));
        for query in entry.origin.queries() {
            report.say(format!("  {query}"));
        }
    }
    if document.horizons.is_empty() {
        report.say("no horizons");
    }
    report.field("horizons", &document.horizons);
    report
}

fn show_horizon(project: &Project, name: &str) -> anyhow::Result<Report> {
    let document = project.document();
    let entry = &document.horizons[document.position(Noun::Horizon, name)?];
    let horizon = content::read_horizon(project.root(), entry, &Progress::silent())?;
    let unit = document.frame()?.vertical.unit.symbol();
    let mut report = Report::default();
    report.say(format!("{name}: {}, {}", entry.contact.word(), entry.history()));
    for query in entry.origin.queries() {
        report.say(format!("  {query}"));
    }
    let mut sheets = Vec::new();
    for sheet in &horizon.sheets {
        let known = || sheet.depth.iter().copied().filter(|depth| depth.is_finite());
        let low = known().fold(f32::INFINITY, f32::min);
        let high = known().fold(f32::NEG_INFINITY, f32::max);
        let nodes = sheet.node_count();
        let holes = sheet.depth.len() - nodes;
        let [u, v] = sheet.grid.count;
        report.say(format!("  sheet of {u} x {v} nodes: {nodes} with a depth, {low} to {high} {unit}, {holes} holes"));
        sheets.push(json!({ "count": [u, v], "nodes": nodes, "holes": holes, "range": [low, high] }));
    }
    if let Some(surface) = horizon.any_shape() {
        let (corners, triangles) = (surface.vertices.len(), surface.triangles.len());
        let low = surface.vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
        let high = surface.vertices.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
        report
            .say(format!("  a surface of any shape: {corners} corners, {triangles} triangles, {low} to {high} {unit}"));
        report.field("surface", json!({ "corners": corners, "triangles": triangles, "range": [low, high] }));
    }
    if let Some(log) = &entry.assembly {
        let counted = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
        let drawn = match log.drawn.len() {
            0 => String::new(),
            count => format!(", {} drawn or tracked", counted(count, "part")),
        };
        report.say(format!("  colour {}, {}{drawn}:", log.colour, counted(log.picks.len(), "pick")));
        for pick in &log.picks {
            let [inline, crossline, z] = pick.at;
            let verb = if pick.operation == interp::assembly::Operation::Add { "adds" } else { "removes" };
            report.say(format!(
                "    {}: at {inline},{crossline},{z}, leaf {}, {} up, {verb} {} triangles",
                pick.id, pick.leaf, pick.up, pick.node.triangles
            ));
        }
        for drawn in &log.drawn {
            let [inline, crossline, z] = drawn.part.place();
            report.say(format!("    {}: {} from {inline},{crossline},{z}", drawn.id, drawn.part.noun()));
        }
    }
    report.field("horizon", entry).field("sheets", sheets).field("unit", unit);
    Ok(report)
}

fn faults(project: &Project) -> Report {
    let document = project.document();
    let mut report = Report::default();
    for entry in &document.faults {
        let ends = entry.truncated_by.as_ref().map_or_else(String::new, |by| format!(", ends at {by}"));
        let grown = match entry.grown_m {
            0.0 => String::new(),
            metres => format!(", reaches {metres} m beyond what was drawn"),
        };
        report.say(format!("{}: {}{ends}{grown}", entry.name, entry.origin));
    }
    if document.faults.is_empty() {
        report.say("no faults");
    }
    report.field("faults", &document.faults);
    report
}

fn layers(project: &Project) -> anyhow::Result<Report> {
    let document = project.document();
    let library = styles::pattern_library(project.root(), document)?;
    let names = document.layers();
    let mut report = Report::default();
    let mut objects = Vec::new();
    let definitions = document.k_definitions();
    for (position, name) in names.iter().enumerate() {
        let index = names.len() - 1 - position;
        let own = document.style.layers.style(name);
        let style = own.cloned().unwrap_or_else(|| LayerTtf::default_style(name, index, &library));
        let by_default = if own.is_none() { " (by default)" } else { "" };
        report.say(format!("{name}: {}{by_default}", describe(&style)));
        objects.push(json!({ "name": name, "index": index, "assigned": own.is_some(), "style": style,
            "k": definitions[index] }));
    }
    report.field("layers", objects);
    Ok(report)
}

fn describe(style: &LayerStyle) -> String {
    let textures: Vec<String> = style
        .intervals
        .iter()
        .map(|interval| match interval.k {
            [0.0, 1.0] => interval.texture.clone(),
            [low, high] => format!("{} from {low} to {high}", interval.texture),
        })
        .collect();
    let textures = if textures.is_empty() { "no pattern".to_owned() } else { textures.join(", ") };
    format!("{textures} on {}", style.colour)
}

fn scalars(project: &Project) -> Report {
    let stack = &project.document().style.scalars;
    let mut report = Report::default();
    for function in stack {
        for interval in &function.intervals {
            let [low, high] = interval.range;
            report.say(format!(
                "{}: {} from {low} to {high}, opacity {}",
                function.volume, interval.texture, interval.opacity
            ));
        }
    }
    if stack.is_empty() {
        report.say("no textures by value");
    }
    // JSON has no infinity, so an open end is null.
    let finite = |value: f32| if value.is_finite() { json!(value) } else { Value::Null };
    let objects: Vec<Value> = stack
        .iter()
        .map(|function| {
            let intervals: Vec<Value> = function
                .intervals
                .iter()
                .map(|interval| {
                    json!({
                        "range": interval.range.map(finite),
                        "texture": interval.texture,
                        "opacity": interval.opacity,
                        "factor": interval.factor,
                    })
                })
                .collect();
            json!({ "volume": function.volume, "intervals": intervals })
        })
        .collect();
    report.field("scalars", objects);
    report
}

fn scenes(project: &Project) -> Report {
    let names = project.document().names(Noun::Scene);
    let mut report = Report::default();
    if names.is_empty() {
        report.say("no scenes yet: rendering starts from a default view");
    }
    for name in &names {
        report.say(name);
    }
    report.field("scenes", names);
    report
}

fn show_scene(project: &Project, name: Option<&str>) -> anyhow::Result<Report> {
    let scene = scene::choose(project.document(), name)?;
    let mut report = Report::text(toml::to_string_pretty(&scene)?.trim_end());
    report.field("scene", scene);
    Ok(report)
}
