//! The stages of an extraction in bricks, in their order, and their tasks.

use super::Bricks;
use super::flood::Flood;
use crate::error::InterpError;
use survey::Progress;

/// A stage: a function whose tasks may be done in any order, once all stages before it are done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stage(Kind);

/// What a stage does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Extrema,
    Offsets,
    Jumps,
    Field,
    Beside,
    Lobes,
    Dips,
    Noise,
    Breaks,
    Variances,
    Evidence,
    Surroundings,
    Parted,
    Cuts,
    Windows,
    Components,
    Labels,
    Basins(Flood),
    Divides(Flood),
    Flooded(Flood),
    Layers(Flood),
    Trimmed(Flood),
    Pieces,
    Joined,
    Triangles,
    Order,
    Trees,
    Distances,
}

impl Stage {
    /// The name, by which a task can be asked for in another process.
    pub fn name(self) -> &'static str {
        let flood = |flood: Flood, names: [&'static str; 2]| names[usize::from(flood == Flood::All)];
        match self.0 {
            Kind::Extrema => "extrema",
            Kind::Offsets => "offsets",
            Kind::Jumps => "jumps",
            Kind::Field => "field",
            Kind::Beside => "beside",
            Kind::Lobes => "lobes",
            Kind::Dips => "dips",
            Kind::Noise => "noise",
            Kind::Breaks => "breaks",
            Kind::Variances => "variances",
            Kind::Evidence => "evidence",
            Kind::Surroundings => "surroundings",
            Kind::Parted => "parted",
            Kind::Cuts => "cuts",
            Kind::Windows => "windows",
            Kind::Components => "components",
            Kind::Labels => "labels",
            Kind::Basins(of) => flood(of, ["core-basins", "basins"]),
            Kind::Divides(of) => flood(of, ["core-divides", "divides"]),
            Kind::Flooded(of) => flood(of, ["core-flooded", "flooded"]),
            Kind::Layers(of) => flood(of, ["core-layers", "layers"]),
            Kind::Trimmed(of) => flood(of, ["core-trimmed", "trimmed"]),
            Kind::Pieces => "pieces",
            Kind::Joined => "joined",
            Kind::Triangles => "triangles",
            Kind::Order => "order",
            Kind::Trees => "trees",
            Kind::Distances => "distances",
        }
    }

    /// What the stage does, in words.
    pub(crate) fn doing(self) -> &'static str {
        match self.0 {
            Kind::Extrema | Kind::Offsets => "finding extrema in bricks",
            Kind::Trees => "building surface trees",
            Kind::Distances => "measuring distances to surfaces",
            Kind::Triangles | Kind::Order => "making triangles in bricks",
            _ => "growing surfaces in bricks",
        }
    }

    /// Whether the stage has one task, which handles summaries of all bricks.
    pub(crate) fn is_merging(self) -> bool {
        use Kind::{Components, Divides, Field, Joined, Layers, Lobes, Noise, Offsets, Order, Surroundings, Variances};
        matches!(
            self.0,
            Offsets
                | Field
                | Lobes
                | Noise
                | Variances
                | Surroundings
                | Components
                | Divides(_)
                | Layers(_)
                | Joined
                | Order
        )
    }

    /// Whether the count of its tasks depends on the survey and the bricks alone.
    pub fn is_counted(self) -> bool {
        self.0 != Kind::Trees
    }

    pub(crate) fn is_growing(self) -> bool {
        !matches!(self.0, Kind::Trees | Kind::Distances)
    }

    pub(crate) fn is_trees(self) -> bool {
        self.0 == Kind::Trees
    }

    /// Arrays that no stage after this one reads. Those that each kind of extremum has are named without it.
    pub(crate) fn last_to_read(self) -> &'static [&'static str] {
        match self.0 {
            Kind::Offsets => &["counts"],
            Kind::Field => &["jumps", "heights", "marks-heights", "strong", "marks-strong"],
            Kind::Lobes => &["beside", "marks-beside"],
            Kind::Noise => &["places", "marks-places", "changes", "marks-changes"],
            Kind::Variances => &["spread", "marks-spread"],
            Kind::Surroundings => &["sums"],
            Kind::Evidence => &["breaks-x", "breaks-y"],
            Kind::Parted => &["raw-evidence"],
            Kind::Cuts => &["dips"],
            Kind::Components => &["narrow-counts", "narrow-faces", "core-counts", "core-faces"],
            Kind::Labels => &["narrow-part", "core-part"],
            Kind::Divides(Flood::Cores) => &["cores-branches"],
            Kind::Divides(Flood::All) => &["all-branches"],
            Kind::Flooded(Flood::Cores) => &["cores-forest", "cores-gates", "cores-outside", "cores-gate-labels"],
            Kind::Flooded(Flood::All) => &["all-forest", "all-gates", "all-outside", "all-gate-labels"],
            Kind::Trimmed(Flood::Cores) => &["cores-flooded", "core-label"],
            Kind::Trimmed(Flood::All) => &["all-flooded", "narrow-label", "rooted"],
            Kind::Joined => &["pieces", "piece-traces", "boundaries", "broken", "evidence"],
            Kind::Triangles => &["label", "links", "z", "amplitude"],
            Kind::Trees => &["corners", "cells", "members"],
            Kind::Distances => &["tree-corners"],
            _ => &[],
        }
    }
}

impl Bricks<'_> {
    /// All stages in their order.
    pub fn stages(&self) -> Vec<Stage> {
        use Kind::{
            Basins, Beside, Breaks, Components, Cuts, Dips, Distances, Divides, Evidence, Extrema, Field, Flooded,
            Joined, Jumps, Labels, Layers, Lobes, Noise, Offsets, Order, Parted, Pieces, Surroundings, Trees,
            Triangles, Trimmed, Variances, Windows,
        };
        let mut stages = vec![Extrema, Offsets, Jumps, Field, Beside, Lobes, Dips, Noise, Breaks, Variances, Evidence];
        stages.extend([Surroundings, Parted, Cuts, Windows, Components, Labels]);
        for flood in [Flood::Cores, Flood::All].into_iter().filter(|&flood| flood == Flood::All || self.has_cores()) {
            stages.extend([Basins(flood), Divides(flood), Flooded(flood), Layers(flood), Trimmed(flood)]);
        }
        stages.extend([Pieces, Joined, Triangles, Order, Trees, Distances]);
        stages.into_iter().map(Stage).collect()
    }

    /// Count of tasks of a stage; stages before it are done.
    ///
    /// # Errors
    /// An array cannot be read.
    pub fn tasks(&self, stage: Stage) -> Result<usize, InterpError> {
        match stage.0 {
            Kind::Trees => self.batches(),
            Kind::Distances => Ok(self.column_count()),
            _ if stage.is_merging() => Ok(1),
            _ => Ok(self.tiles.count()),
        }
    }

    /// Does one task of a stage; stages before it are done. What the task wrote before is replaced by the same bytes.
    ///
    /// # Errors
    /// [`InterpError`].
    pub(crate) fn run_task(&self, stage: Stage, task: usize, progress: &Progress) -> Result<(), InterpError> {
        progress.check()?;
        match stage.0 {
            Kind::Extrema => self.extrema(task),
            Kind::Offsets => self.number_extrema(),
            Kind::Jumps => self.jumps(task),
            Kind::Field => self.field(),
            Kind::Beside => self.beside(task),
            Kind::Lobes => self.measure_lobes(),
            Kind::Dips => self.dips(task),
            Kind::Noise => self.measure_noise(),
            Kind::Breaks => self.breaks(task),
            Kind::Variances => self.variances(),
            Kind::Evidence => self.evidence(task),
            Kind::Surroundings => self.add_surroundings(),
            Kind::Parted => self.parted(task),
            Kind::Cuts => self.cuts(task),
            Kind::Windows => self.windows(task),
            Kind::Components => self.components(),
            Kind::Labels => self.labels(task),
            Kind::Basins(flood) => self.basins(flood, task),
            Kind::Divides(flood) => self.divides(flood),
            Kind::Flooded(flood) => self.flooded(flood, task),
            Kind::Layers(flood) => self.layers(flood),
            Kind::Trimmed(flood) => self.trimmed(flood, task),
            Kind::Pieces => self.pieces(task),
            Kind::Joined => self.joined(progress),
            Kind::Triangles => self.triangles(task),
            Kind::Order => self.order(),
            Kind::Trees => self.trees(task, progress),
            Kind::Distances => self.distances(task, progress),
        }
    }
}
