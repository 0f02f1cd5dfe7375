//! `petroglyph animate --motion history`: the frames of a block that goes through its geological history.
//!
//! Every event that changes something visible takes an equal share of the frames, and the finished block holds at the end.

use anyhow::Context;
use image::RgbaImage;
use project::chains::stages::Stages;
use project::pictures::load::{self, Request};
use project::pictures::{Painter, scene};
use project::{Project, ProjectError};
use render::Scene;
use survey::Progress;

/// How long the finished block holds, seconds, and the share of the frames that it takes at most.
const HOLD_S: f64 = 1.5;
const HOLD_SHARE: f64 = 0.25;

/// Frames of a history.
pub(super) struct Passage<'a> {
    stages: Stages<'a>,
    /// The stage of each frame.
    at: Vec<f64>,
    start: Scene,
    volume_bytes: u64,
    dpi: f64,
    /// The stage that was drawn last, and its picture.
    last: Option<(f64, RgbaImage)>,
    /// Stages that could not be drawn, and why.
    missing: Vec<String>,
}

impl<'a> Passage<'a> {
    /// So many frames, so many of them a second, of a project that was made from a history.
    pub(super) fn new(
        project: &'a Project,
        start: &Scene,
        (frames, rate): (u32, f64),
        (volume_bytes, dpi): (u64, f64),
        progress: &Progress,
    ) -> anyhow::Result<Self> {
        let stages = Stages::of(project)?;
        let changing = stages.seen_to_change(start, progress)?;
        let hold = (HOLD_S * rate).min(HOLD_SHARE * f64::from(frames)).floor() as u32;
        let at = paced(&changing, stages.first(), stages.events() as f64, frames - hold, frames);
        Ok(Self { stages, at, start: start.clone(), volume_bytes, dpi, last: None, missing: Vec::new() })
    }

    /// Draws a frame; one whose stage cannot be made looks like the one before.
    pub(super) fn draw(&mut self, frame: u32, painter: &mut Painter, progress: &Progress) -> anyhow::Result<RgbaImage> {
        let stage = self.at.get(frame as usize).copied().context("there is no such frame")?;
        if let Some((_, picture)) = self.last.as_ref().filter(|(last, _)| *last == stage) {
            return Ok(picture.clone());
        }
        let picture = match (self.picture(stage, painter, progress), &self.last) {
            (Err(ProjectError::Cancelled(cancelled)), _) => return Err(ProjectError::Cancelled(cancelled).into()),
            (Err(error), Some((_, before))) => {
                self.missing.push(error.to_string());
                before.clone()
            }
            (picture, _) => picture?,
        };
        self.last = Some((stage, picture.clone()));
        Ok(picture)
    }

    fn picture(&self, stage: f64, painter: &mut Painter, progress: &Progress) -> Result<RgbaImage, ProjectError> {
        let made = self.stages.at(stage, progress)?;
        let project = made.project();
        let shown = scene::of_what_is_there(project.document(), &self.start);
        let loaded = load::load(project.facts(), &Request::new(&shown).within(self.volume_bytes), progress)?;
        Ok(painter.picture(&shown, &loaded, self.dpi, progress)?)
    }

    /// A sentence where frames repeat the one before because their stage could not be made.
    pub(super) fn note(&self) -> Option<String> {
        let first = self.missing.first()?;
        let frames = if self.missing.len() == 1 {
            "one frame repeats".to_owned()
        } else {
            format!("{} frames repeat", self.missing.len())
        };
        Some(format!("{frames} the one before: {first}"))
    }
}

/// The stage of each frame: from `first` through the events that change something in `moving` frames, then the last stage.
fn paced(changing: &[f64], first: f64, last: f64, moving: u32, frames: u32) -> Vec<f64> {
    let events = changing.len() as f64;
    let stage = |frame: u32| {
        let way = events * f64::from(frame) / f64::from(moving.saturating_sub(1).max(1));
        if frame + 1 >= moving || changing.is_empty() {
            return last;
        }
        let event = changing[(way as usize).min(changing.len() - 1)];
        // Where an event begins, the one before has happened and nothing of it.
        let begin = (event - 1.0).max(first.min(event));
        begin + (event - begin) * way.fract()
    };
    (0..frames).map(stage).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_take_equal_shares_and_the_last_stage_holds() {
        let stages = paced(&[1.0, 2.0, 4.0], 0.2, 5.0, 7, 9);
        let wanted = [0.2, 0.6, 1.0, 1.5, 3.0, 3.5, 5.0, 5.0, 5.0];
        assert!(stages.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-9), "{stages:?}");
        assert_eq!(stages.len(), 9);
        assert_eq!(paced(&[1.0], 1.0, 1.0, 1, 2), [1.0, 1.0]);
        assert!(paced(&[1.0], 0.5, 1.0, 40, 50).windows(2).all(|pair| pair[0] <= pair[1] && pair[0] >= 0.5));
    }
}
