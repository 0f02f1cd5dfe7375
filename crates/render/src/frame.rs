//! A scene and its inputs, checked and resolved: what both renderers start from.

use crate::camera::View;
use crate::error::{NO_CANDIDATES, RenderError};
use crate::ground::Relief;
use crate::inputs::{Candidates, Inputs, NamedVolume};
use crate::leaves::FaceData;
use crate::media::field::Field;
use crate::media::prepared::Preparations;
use crate::media::{Faces, Scalar};
use crate::outline;
use crate::scene::{Lookup, Scene};
use crate::visible::Solid;
use crate::voxel_box::VoxelBox;
use crate::wells::Tubes;
use glam::{DVec3, Vec3};
use model::StructuralModel;
use param::{PackedVolume, Parameterization};
use ttf::tables::{LayerEntry, NONE, StopEntry, TtfGlobals};
use ttf::{RawColour, TtfTables};

/// Volumes that a picture can show.
pub const MAX_VOLUMES: usize = 6;
/// Colour under raw data where there is nothing else.
const PLAIN: [f32; 4] = [0.86, 0.86, 0.855, 0.0];

/// Everything a picture needs, with names resolved.
pub(crate) struct Frame<'a> {
    pub scene: &'a Scene,
    pub view: View,
    pub solid: Solid,
    /// The part of the survey shown.
    pub roaming_box: VoxelBox,
    /// The transfer functions with the scene's blend, frequency and raw data.
    pub tables: TtfTables,
    /// One per entry of `tables.volumes`; `None` where the picture does not need it.
    pub volumes: Vec<Option<NamedVolume<'a>>>,
    /// What illustrates; `None` shows raw data alone.
    pub rock: Option<Rock<'a>>,
    /// Whether textures show at all: there is an interpretation and the blend is not wholly raw.
    pub illustrated: bool,
    /// The ground, if the scene has one.
    pub relief: Option<Relief>,
    /// Metres between voxels along x, y, z.
    pub voxel_m: Vec3,
    /// Factor on the colour of faces across x, y, z.
    pub tones: [f32; 3],
    /// Behind everything, straight: nothing where edges are to be drawn behind what is seen through.
    pub background: [f32; 4],
    /// Horizon candidates, where faces show them.
    pub candidates: Option<Candidates<'a>>,
    /// Wells.
    pub tubes: Option<Tubes>,
    /// What is seen through.
    pub field: Option<Field<'a>>,
}

/// The interpretation and the map to flat space.
#[derive(Clone, Copy)]
pub(crate) struct Rock<'a> {
    pub model: &'a StructuralModel,
    pub flat: Flat<'a>,
}

/// The two lookups.
#[derive(Clone, Copy)]
pub(crate) enum Flat<'a> {
    Exact(&'a Parameterization),
    Packed(&'a PackedVolume),
}

impl<'a> Frame<'a> {
    /// Checks the scene against the inputs.
    pub fn new(scene: &'a Scene, inputs: &Inputs<'a>, kept: &mut Preparations) -> Result<Self, RenderError> {
        scene.validate(inputs.geometry)?;
        let rock = resolve_rock(scene, inputs)?;
        let tables = resolve_tables(scene, inputs, rock.is_some())?;
        let mut tables = tables;
        let media: Vec<&String> =
            scene.media.all().map(|m| &m.volume).chain(paints(scene)).chain(scene.media.isosurface_volumes()).collect();
        for name in &media {
            if !tables.volumes.contains(name) {
                tables.volumes.push((*name).clone());
            }
        }
        let volumes = resolve_volumes(&tables, &media, inputs.volumes)?;
        let roaming_box = scene.box_in(inputs.geometry);
        let relief = match (&scene.ground, rock) {
            (None, _) => None,
            (Some(ground), Some(rock)) => Some(Relief::new(ground, scene, inputs.geometry, rock.model)),
            (Some(_), None) => {
                return Err(RenderError::Missing {
                    what: "horizons for the ground",
                    remedy: "add horizons, or leave `ground` out of the scene",
                });
            }
        };
        let hidden =
            tables.globals.blend >= 1.0 && tables.globals.raw_volume != NONE && tables.globals.no_data[3] >= 1.0;
        let metric = inputs.geometry.metric_from_voxel();
        let view = scene.view(inputs.geometry);
        let field = Field::new(&scene.media, inputs, &tables, &view, relief.is_some(), kept)?;
        let candidates = match (scene.face_data, inputs.candidates) {
            (FaceData::Rock, _) => None,
            (_, None) => return Err(NO_CANDIDATES),
            (_, Some(candidates)) => {
                candidates.validate()?;
                Some(candidates)
            }
        };
        let solid = Solid::new(&roaming_box, &scene.cuts_in(inputs.geometry));
        let longest_m = (0..3).map(|axis| metric.col(axis).length() * roaming_box.extent()[axis]).fold(0.0, f64::max);
        let background = if outline::has_underlay(scene) { [0.0; 4] } else { scene.background.rgba() };
        Ok(Self {
            background,
            candidates,
            tubes: Tubes::new(inputs.wells, &scene.wells, &view, longest_m, solid.roaming_box),
            field,
            roaming_box,
            scene,
            tones: tones(&view, &roaming_box.centre(), scene.face_tone),
            view,
            solid,
            tables,
            volumes,
            rock,
            illustrated: rock.is_some() && (!hidden || shows_depths(scene)),
            relief,
            voxel_m: DVec3::new(metric.x_axis.length(), metric.y_axis.length(), metric.z_axis.length()).as_vec3(),
        })
    }
}

/// The model and the lookup that the scene asks for; `None` when there is nothing to illustrate with.
fn resolve_rock<'a>(scene: &Scene, inputs: &Inputs<'a>) -> Result<Option<Rock<'a>>, RenderError> {
    let (Some(model), Some(tables)) = (inputs.model, inputs.tables) else { return Ok(None) };
    if tables.layers.len() < model.layer_count() {
        return Err(RenderError::LayerCount { styled: tables.layers.len(), layers: model.layer_count() });
    }
    let flat = match scene.lookup {
        Lookup::Exact => inputs.param.map(Flat::Exact),
        Lookup::Packed => inputs.packed.map(Flat::Packed),
    };
    let flat = flat.ok_or(RenderError::Missing {
        what: match scene.lookup {
            Lookup::Exact => "the parameterization",
            Lookup::Packed => "the packed parameterization",
        },
        remedy: "parameterize the project first",
    })?;
    Ok(Some(Rock { model, flat }))
}

/// The transfer functions as this scene uses them.
fn resolve_tables(scene: &Scene, inputs: &Inputs, illustrated: bool) -> Result<TtfTables, RenderError> {
    let mut tables = inputs.tables.cloned().unwrap_or_else(no_tables);
    tables.globals.blend = scene.blend;
    tables.globals.global_frequency = scene.global_frequency;
    if let Some(raw) = &scene.raw {
        raw.function.validate(&format!("the colours of `{}`", raw.volume))?;
        set_raw(&mut tables, raw);
    }
    if !illustrated {
        if tables.globals.raw_volume == NONE && scene.media.faces != Faces::None && scene.face_data == FaceData::Rock {
            return Err(RenderError::Missing {
                what: "something to show",
                remedy: "add horizons and parameterize the project, or name a volume under `raw`",
            });
        }
        tables.globals.blend = 1.0;
        tables.globals.scalar_count = 0;
        tables.scalars.clear();
        let plain = LayerEntry { colour: PLAIN, frequency: [1.0; 2], first_interval: 0, interval_count: 0 };
        tables.layers = vec![plain];
    }
    if tables.globals.blend == 0.0 {
        tables.globals.raw_volume = NONE;
    }
    Ok(tables)
}

fn no_tables() -> TtfTables {
    TtfTables {
        globals: TtfGlobals {
            no_data: [0.0; 4],
            raw_domain: [0.0, 1.0],
            blend: 1.0,
            global_frequency: 1.0,
            aspect_j: 1.0,
            raw_volume: NONE,
            scalar_count: 0,
            stop_count: 0,
        },
        layers: Vec::new(),
        intervals: Vec::new(),
        scalars: Vec::new(),
        stops: Vec::new(),
        volumes: Vec::new(),
        textures: Vec::new(),
    }
}

/// Puts the scene's raw data in place of the transfer functions'.
fn set_raw(tables: &mut TtfTables, raw: &RawColour) {
    let slot = tables.volumes.iter().position(|name| *name == raw.volume).unwrap_or_else(|| {
        tables.volumes.push(raw.volume.clone());
        tables.volumes.len() - 1
    });
    let rgba = |colour: ttf::Colour, alpha: f32| {
        let [r, g, b] = colour.to_unit();
        [r, g, b, alpha]
    };
    tables.stops = raw
        .function
        .stops
        .iter()
        .map(|stop| StopEntry { colour: rgba(stop.colour, stop.opacity), at: stop.at, padding: [0.0; 3] })
        .collect();
    tables.globals.raw_volume = slot as u32;
    tables.globals.raw_domain = raw.function.domain;
    tables.globals.stop_count = tables.stops.len() as u32;
    tables.globals.no_data = raw.no_data.map_or([0.0; 4], |colour| rgba(colour, 1.0));
}

/// Whether flat coordinates are looked up inside the block.
pub(crate) fn shows_depths(scene: &Scene) -> bool {
    scene.media.isosurfaces.iter().any(|surface| surface.of == Scalar::Depth)
}

/// Volumes painted on horizons.
fn paints(scene: &Scene) -> impl Iterator<Item = &String> {
    scene.media.horizons.iter().filter_map(|horizon| horizon.paint.as_ref()).map(|paint| &paint.volume)
}

/// The volumes behind the slots that are in use.
fn resolve_volumes<'a>(
    tables: &TtfTables,
    media: &[&String],
    volumes: &[NamedVolume<'a>],
) -> Result<Vec<Option<NamedVolume<'a>>>, RenderError> {
    if tables.volumes.len() > MAX_VOLUMES {
        return Err(RenderError::TooManyVolumes { found: tables.volumes.len(), limit: MAX_VOLUMES });
    }
    let is_used = |slot: u32| {
        tables.globals.raw_volume == slot
            || tables.scalars.iter().any(|s| s.volume == slot)
            || media.contains(&&tables.volumes[slot as usize])
    };
    let find = |name: &String| {
        volumes.iter().find(|v| v.name == *name).copied().ok_or_else(|| RenderError::UnknownVolume {
            name: name.clone(),
            present: volumes.iter().map(|v| v.name.to_owned()).collect(),
        })
    };
    (0u32..).zip(&tables.volumes).map(|(slot, name)| is_used(slot).then(|| find(name)).transpose()).collect()
}

/// Darkens the vertical faces by how far they turn to the viewer's right.
fn tones(view: &View, centre: &DVec3, face_tone: f32) -> [f32; 3] {
    let here = view.project(*centre);
    let towards = view.towards_camera(*centre);
    let rightness = |axis: DVec3| {
        let outwards = axis * axis.dot(towards).signum();
        (view.project(*centre + outwards * 1e-3) - here).x
    };
    if rightness(DVec3::X) >= rightness(DVec3::Y) { [1.0 - face_tone, 1.0, 1.0] } else { [1.0, 1.0 - face_tone, 1.0] }
}
