//! A scene and its inputs, checked and with all names resolved: the starting point of both renderers.

use crate::cache::{Kept, Shapes};
use crate::camera::View;
use crate::error::RenderError;
use crate::ground::{self, Relief};
use crate::inputs::{CandidateVolume, Inputs, NamedVolume};
use crate::leaves::FaceData;
use crate::media::field::MediaField;
use crate::media::{Faces, IsosurfaceSource};
use crate::pattern_size::Frequencies;
use crate::scene::{Lookup, Scene};
use crate::visible::Solid;
use crate::wells::Tubes;
use bytemuck::Zeroable;
use glam::{DMat3, DVec3, Vec2, Vec3};
use model::StructuralModel;
use param::{PackedVolume, Parameterization};
use survey::Contact;
use survey::block::BodyPlane;
use survey::block::VoxelBox;
use ttf::tables::{LayerEntry, NONE, StopEntry, TtfGlobals};
use ttf::{FaceFrame, RawColour, TtfTables};

/// Largest number of volumes in a picture.
pub(crate) const MAX_VOLUMES: usize = 6;
/// Colour below raw data if there is no interpretation.
const PLAIN: [f32; 4] = [0.86, 0.86, 0.855, 0.0];

/// Everything that a picture needs, with names resolved.
pub(crate) struct ResolvedScene<'a> {
    pub scene: &'a Scene,
    pub view: View,
    pub solid: Solid,
    /// The part of the survey shown.
    pub roaming_box: VoxelBox,
    /// The transfer functions with the blend, global frequency and raw data of the scene.
    pub tables: TtfTables,
    /// One volume per entry of `tables.volumes`; `None` where the picture does not need it.
    pub volumes: Vec<Option<NamedVolume<'a>>>,
    /// The interpretation. `None`: the picture shows raw data alone.
    pub interpretation: Option<ResolvedInterpretation<'a>>,
    /// Whether textures are visible at all: there is an interpretation, and the blend is not entirely raw.
    pub illustrated: bool,
    /// The ground, if the scene has one.
    pub relief: Option<Relief>,
    /// Sections of the model on faces of the block, and its ground.
    pub shapes: Shapes,
    /// The linear part of the map from voxels to metres.
    pub metric: DMat3,
    /// Metres between voxels along x, y, z.
    pub voxel_m: Vec3,
    /// Factors on the colour of faces of constant x, y, z.
    pub tones: [f32; 3],
    /// Background, straight RGBA. Transparent if edges are drawn behind the media: then they and the
    /// background are added at the end.
    pub background: [f32; 4],
    /// Horizon candidates, if faces show them.
    pub candidates: Option<CandidateVolume<'a>>,
    /// Wells.
    pub tubes: Option<Tubes>,
    /// The media (volume rendering).
    pub field: Option<MediaField<'a>>,
}

/// The interpretation, and the map to flat space.
#[derive(Clone, Copy)]
pub(crate) struct ResolvedInterpretation<'a> {
    pub model: &'a StructuralModel,
    pub flat: Flat<'a>,
}

/// The two ways to look up flat coordinates.
#[derive(Clone, Copy)]
pub(crate) enum Flat<'a> {
    Exact(&'a Parameterization),
    Packed(&'a PackedVolume),
}

impl<'a> ResolvedScene<'a> {
    /// Checks the scene against the inputs and resolves its names.
    pub(crate) fn new(scene: &'a Scene, inputs: &Inputs<'a>, kept: &mut Kept) -> Result<Self, RenderError> {
        scene.validate(inputs.geometry)?;
        let interpretation = resolve_interpretation(scene, inputs)?;
        let view = scene.view(inputs.geometry);
        let mut tables = resolve_tables(scene, inputs, &view, interpretation.is_some())?;
        let media = scene.media.volumes().collect::<Vec<_>>();
        for name in &media {
            if !tables.volumes.iter().any(|known| known == name) {
                tables.volumes.push((*name).to_owned());
            }
        }
        let volumes = resolve_volumes(&tables, &media, inputs.volumes)?;
        let roaming_box = scene.box_in(inputs.geometry);
        kept.renew(inputs.data_key);
        let relief = resolve_relief(scene, inputs, interpretation, kept)?;
        let hidden =
            tables.globals.blend >= 1.0 && tables.globals.raw_volume != NONE && tables.globals.no_data[3] >= 1.0;
        let metric = inputs.geometry.metric_from_voxel();
        let field = MediaField::new(&scene.media, inputs, &tables, &view, relief.is_some(), &mut kept.preparations)?;
        let solid = scene.solid(inputs.geometry);
        let longest_m = (0..3).map(|axis| metric.col(axis).length() * roaming_box.extent()[axis]).fold(0.0, f64::max);
        let background = if scene.has_back_edges() { [0.0; 4] } else { scene.background.rgba() };
        Ok(Self {
            background,
            candidates: resolve_candidates(scene, inputs)?,
            tubes: Tubes::new(inputs.wells, scene, &view, longest_m, solid.roaming_box),
            field,
            roaming_box,
            scene,
            tones: tones(&view, &roaming_box.centre(), scene.face_tone),
            view,
            solid,
            tables,
            volumes,
            interpretation,
            illustrated: interpretation.is_some() && (!hidden || shows_depths(scene)),
            relief,
            shapes: kept.shapes(),
            metric,
            voxel_m: DVec3::new(metric.x_axis.length(), metric.y_axis.length(), metric.z_axis.length()).as_vec3(),
        })
    }
}

impl ResolvedScene<'_> {
    /// Whether a line is that of an unconformity.
    pub(crate) fn is_unconformity(&self, horizon: Option<usize>) -> bool {
        let contacts = self.interpretation.map(|interpretation| interpretation.model.rules().contacts());
        contacts.zip(horizon).and_then(|(contacts, horizon)| contacts.get(horizon)) == Some(&Contact::Erosional)
    }

    /// How patterns lie on a plane of the block.
    pub(crate) fn frame(&self, plane: &BodyPlane) -> FaceFrame {
        let normal = (plane.normal / self.voxel_m).to_array();
        let Some(wall) = plane.wall else {
            // Exactly an axis where the plane is one of an axis.
            let exact = plane.axis.map_or(normal, |axis| Vec3::AXES[axis].to_array());
            return FaceFrame::new(exact);
        };
        let along = Vec2::from(wall.along) * self.voxel_m.truncate();
        FaceFrame::on_wall(normal, along.normalize().to_array(), wall.shift_m / self.tables.globals.extent_i_m)
    }

    /// The factor on colours of a plane of the block: of its direction between those of constant x and y.
    pub(crate) fn tone(&self, plane: &BodyPlane) -> f32 {
        if let Some(axis) = plane.axis {
            return self.tones[axis];
        }
        let normal = (plane.normal / self.voxel_m).normalize();
        1.0 - (1.0 - self.tones[0]) * normal.x * normal.x - (1.0 - self.tones[1]) * normal.y * normal.y
    }
}

/// The model and the lookup that the scene asks for; `None` if there is no interpretation.
fn resolve_interpretation<'a>(
    scene: &Scene,
    inputs: &Inputs<'a>,
) -> Result<Option<ResolvedInterpretation<'a>>, RenderError> {
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
    Ok(Some(ResolvedInterpretation { model, flat }))
}

/// The ground, if the scene shows it.
fn resolve_relief(
    scene: &Scene,
    inputs: &Inputs,
    interpretation: Option<ResolvedInterpretation>,
    kept: &mut Kept,
) -> Result<Option<Relief>, RenderError> {
    match (&scene.ground, interpretation) {
        (None, _) => Ok(None),
        (Some(ground), Some(interpretation)) => {
            let heights = kept.heights(interpretation.model, ground::corners(scene, inputs.geometry));
            Ok(Some(Relief::over(&heights, ground, scene, inputs.geometry)))
        }
        (Some(_), None) => Err(RenderError::Missing {
            what: "horizons for the ground",
            remedy: "add horizons, or leave `ground` out of the scene",
        }),
    }
}

/// The horizon candidates, if faces show them.
fn resolve_candidates<'a>(scene: &Scene, inputs: &Inputs<'a>) -> Result<Option<CandidateVolume<'a>>, RenderError> {
    if !scene.face_data.shows_candidates() {
        return Ok(None);
    }
    let candidates = inputs.candidates.ok_or(RenderError::NO_CANDIDATES)?;
    candidates.validate()?;
    Ok(Some(candidates))
}

/// The transfer functions with the settings of the scene.
fn resolve_tables(scene: &Scene, inputs: &Inputs, view: &View, illustrated: bool) -> Result<TtfTables, RenderError> {
    let mut tables = inputs.tables.cloned().unwrap_or_else(no_tables).exaggerated(scene.exaggeration as f32);
    tables.globals.blend = scene.blend;
    let frequencies = Frequencies::of(scene, inputs.geometry, view);
    tables.globals.global_frequency = frequencies.factor;
    tables.globals.finer_share = frequencies.finer_share;
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
        let plain = LayerEntry { colour: PLAIN, frequency: [1.0; 2], ..LayerEntry::zeroed() };
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
            finer_share: 0.0,
            extent_i_m: 1.0,
            padding: [0; 2],
        },
        layers: Vec::new(),
        intervals: Vec::new(),
        scalars: Vec::new(),
        stops: Vec::new(),
        volumes: Vec::new(),
        textures: Vec::new(),
        patterns: Vec::new(),
        faults: Vec::new(),
    }
}

/// Replaces the raw data of the transfer functions by those of the scene.
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

/// Whether flat coordinates are needed inside the block and not only on faces.
pub(crate) fn shows_depths(scene: &Scene) -> bool {
    scene.media.isosurfaces.iter().any(|surface| surface.of == IsosurfaceSource::Depth)
}

/// The volumes of the slots that are in use.
fn resolve_volumes<'a>(
    tables: &TtfTables,
    media: &[&str],
    volumes: &[NamedVolume<'a>],
) -> Result<Vec<Option<NamedVolume<'a>>>, RenderError> {
    if tables.volumes.len() > MAX_VOLUMES {
        return Err(RenderError::TooManyVolumes { found: tables.volumes.len(), limit: MAX_VOLUMES });
    }
    let is_used = |slot: u32| {
        tables.globals.raw_volume == slot
            || tables.scalars.iter().any(|s| s.volume == slot)
            || media.contains(&tables.volumes[slot as usize].as_str())
    };
    (0u32..)
        .zip(&tables.volumes)
        .map(|(slot, name)| is_used(slot).then(|| NamedVolume::find(volumes, name)).transpose())
        .collect()
}

/// Factors that darken one pair of vertical faces: the pair whose visible face points farther to the right.
fn tones(view: &View, centre: &DVec3, face_tone: f32) -> [f32; 3] {
    let here = view.project(*centre);
    let towards = view.towards_camera(*centre);
    let rightness = |axis: DVec3| {
        let outwards = axis * axis.dot(towards).signum();
        (view.project(*centre + outwards * 1e-3) - here).x
    };
    if rightness(DVec3::X) >= rightness(DVec3::Y) { [1.0 - face_tone, 1.0, 1.0] } else { [1.0, 1.0 - face_tone, 1.0] }
}
