//! Pictures of the block for the screen: first coarse, then at full resolution, then smooth, always for the latest
//! request.
//!
//! The measured time for each ray decides how coarse the first picture is, so that it takes about `COARSE_S` on any
//! machine. A coarse picture is always finished, otherwise nothing would be visible while the camera moves; finer ones
//! are cancelled by a newer request.

use super::latest_value::{Inbox, LatestValueWorker};
use super::{Event, Outbox, Rocks};
use crate::state::{How, Notice, PickingStep, Place};
use glam::DVec2;
use image::RgbaImage;
use page::list::POINTS_PER_INCH;
use project::pictures::{Device, Painter};
use render::{Media, RenderError, Scene, Shading};
use std::path::PathBuf;
use std::time::Instant;
use survey::Progress;

/// Time for a first picture, seconds: users notice a delay of more than a tenth.
const COARSE_S: f64 = 0.09;
/// Largest factor by which a first picture is coarser.
const COARSEST: u32 = 8;
/// Largest number of light cells in a slice of a coarse picture.
const COARSE_CELLS: u32 = 96;
/// Samples for each pixel along each axis in the final picture.
const SMOOTH_SAMPLES: u32 = 2;
/// Memory for what rays hit, bytes: two pictures of a window, or one on a large screen. A change of colours or patterns
/// only colours it again.
const POINTS_BYTES: usize = 256 << 20;
/// Weight of the latest measurement in the estimate of the time for a ray.
const LATEST: f64 = 0.5;

/// A request for pictures.
#[derive(Clone)]
pub struct PictureRequest {
    /// A number that increases with each request.
    pub number: u64,
    /// The scenes, each with its size on the screen.
    pub scenes: Vec<Scene>,
    /// The data that they are drawn from.
    pub rocks: Rocks,
    /// While the user drags, coarse pictures suffice.
    pub is_moving: bool,
    /// Start at full resolution, because the picture on the screen is already better than a coarse one would be.
    pub begins_fine: bool,
    /// Whether the view is the one on the screen, of other data or styles: after the coarse picture the smooth one follows.
    pub is_restyled: bool,
}

/// A click on volume rendering, where the place that is hit may lie behind the faces.
#[derive(Clone)]
pub(crate) struct Touch {
    /// The project.
    pub root: PathBuf,
    /// The scene, with a size in points.
    pub scene: Scene,
    /// The place of the click, points from the upper left corner.
    pub at: DVec2,
    /// What the click does.
    pub how: How,
    /// The data that the picture was drawn from.
    pub rocks: Rocks,
}

/// A picture.
pub struct Drawn {
    /// Number of its request.
    pub number: u64,
    /// Index of its scene.
    pub pane: usize,
    /// The pixels; fewer than the screen's where the picture is coarse.
    pub image: RgbaImage,
    /// Whether it is the final picture of its request.
    pub is_final: bool,
    /// The device that drew it.
    pub device: String,
}

#[derive(Default)]
struct Wanted {
    request: Option<PictureRequest>,
    touch: Option<Touch>,
    /// Progress of the picture being drawn, if that may be cancelled.
    progress: Option<Progress>,
}

/// The next thing to do: a click does not wait for a picture.
enum Next {
    Touch(Box<Touch>),
    Draw(PictureRequest),
}

impl Wanted {
    fn take(&mut self) -> Option<Next> {
        self.progress = None;
        self.touch.take().map(|touch| Next::Touch(Box::new(touch))).or_else(|| self.request.take().map(Next::Draw))
    }
}

/// A latest-value worker that draws pictures.
pub struct Drawing {
    worker: LatestValueWorker<Wanted>,
}

impl Drawing {
    /// Starts the worker.
    pub fn start(outbox: Outbox) -> Self {
        let told = outbox.clone();
        Self {
            worker: LatestValueWorker::start("the picture", &told, move |inbox| {
                Artist::new(outbox.clone()).work(inbox);
            }),
        }
    }

    /// Draws this next, instead of an earlier request.
    pub fn draw(&self, request: PictureRequest) {
        self.worker.change(|wanted| {
            wanted.request = Some(request);
            wanted.progress.iter().for_each(Progress::cancel);
        });
    }

    /// Finds what is hit at a place of a picture, and picks it.
    pub(crate) fn touch(&self, touch: Touch) {
        self.worker.change(|wanted| wanted.touch = Some(touch));
    }
}

impl Drop for Drawing {
    fn drop(&mut self) {
        self.worker.change(|wanted| wanted.progress.iter().for_each(Progress::cancel));
    }
}

/// The media for a picture that is coarser by a factor: light and samples along rays are coarser too, because their
/// cost does not depend on the number of pixels.
fn media_for(media: &Media, divisor: u32) -> Media {
    let mut media = media.clone();
    if divisor > 1 {
        media.samples_per_voxel *= 0.5;
        if let Shading::Occlusion(occlusion) = &mut media.shading {
            occlusion.slices_per_voxel *= 0.5;
            occlusion.max_cells = occlusion.max_cells.min(COARSE_CELLS);
        }
    }
    media
}

struct Artist {
    outbox: Outbox,
    painter: Option<Painter>,
    /// Estimated time for a ray, seconds.
    ray_s: f64,
}

impl Artist {
    fn new(outbox: Outbox) -> Self {
        // Before the first measurement a slow processor is assumed.
        Self { outbox, painter: None, ray_s: 1.5e-6 }
    }

    fn work(mut self, inbox: &Inbox<Wanted>) {
        while let Some(next) = inbox.next(Wanted::take) {
            match next {
                Next::Touch(touch) => self.find(&touch),
                Next::Draw(request) => {
                    if let Err(error) = self.satisfy(&request, inbox) {
                        self.outbox.send(Event::Told(Notice::failure(Place::Block, &error)));
                    }
                }
            }
        }
    }

    /// Finds what is hit at a place and reports a click there.
    fn find(&self, touch: &Touch) {
        let loaded = &touch.rocks;
        let scene = loaded.complete(&touch.scene);
        let (volumes, wells) = (loaded.named_volumes(), loaded.well_paths());
        match render::pick::pick(&scene, &loaded.inputs(&volumes, &wells), touch.at) {
            Ok(Some(seen)) => {
                let step = PickingStep::At(seen.voxel.as_dvec3(), touch.how);
                self.outbox.send(Event::Picking { root: touch.root.clone(), step });
            }
            Ok(None) => {}
            Err(error) => self.outbox.send(Event::Told(Notice::failure(Place::Interpret, &error))),
        }
    }

    /// Draws the requested picture at increasing resolution until it is smooth or a newer request arrives.
    fn satisfy(&mut self, request: &PictureRequest, inbox: &Inbox<Wanted>) -> Result<(), RenderError> {
        let rays: f64 =
            request.scenes.iter().map(|scene| f64::from(scene.size_px[0]) * f64::from(scene.size_px[1])).sum();
        let divisor = ((rays * self.ray_s / COARSE_S).sqrt().ceil() as u32).clamp(1, COARSEST);
        let mut passes = Vec::new();
        if !request.begins_fine {
            passes.push((divisor, 1));
        }
        if !request.is_moving {
            if (divisor > 1 || request.begins_fine) && !request.is_restyled {
                passes.push((1, 1));
            }
            passes.push((1, SMOOTH_SAMPLES));
        }
        for (index, (divisor, samples)) in passes.iter().copied().enumerate() {
            let progress = Progress::silent();
            if index > 0 || request.begins_fine {
                let may_go_on = inbox.look(|wanted| {
                    wanted.progress = Some(progress.clone());
                    wanted.request.is_none()
                });
                if may_go_on != Some(true) {
                    return Ok(());
                }
            }
            for pane in 0..request.scenes.len() {
                match self.draw(request, pane, divisor, samples, index + 1 == passes.len(), &progress) {
                    Err(RenderError::Cancelled(_)) => return Ok(()),
                    other => other?,
                }
            }
        }
        Ok(())
    }

    fn draw(
        &mut self,
        request: &PictureRequest,
        pane: usize,
        divisor: u32,
        samples: u32,
        is_final: bool,
        progress: &Progress,
    ) -> Result<(), RenderError> {
        let painter = match &mut self.painter {
            Some(painter) => painter,
            none => none.insert(Painter::new(Device::Auto, progress)?.keeping_points(POINTS_BYTES)),
        };
        let scene = &request.scenes[pane];
        let size_px = scene.size_px.map(|side| side.div_ceil(divisor).max(1));
        let media = media_for(&scene.media, divisor);
        let scene = Scene { size_px, samples, media, in_motion: divisor > 1, ..scene.clone() };
        let loaded = &request.rocks;
        let start = Instant::now();
        let image = super::compute(|| painter.picture(&scene, loaded, POINTS_PER_INCH, progress))?;
        let rays = f64::from(size_px[0]) * f64::from(size_px[1]) * f64::from(samples * samples);
        self.ray_s += (start.elapsed().as_secs_f64() / rays - self.ray_s) * LATEST;
        let device = painter.device().to_owned();
        self.outbox.send(Event::Drawn(Drawn { number: request.number, pane, image, is_final, device }));
        Ok(())
    }
}
