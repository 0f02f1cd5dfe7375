//! Turns the options of a view into changes of a scene.

use super::args::ViewArgs;
use super::cuts::{self, Cut, LineBox, voxel_box};
use super::request::{Usage, counts, numbers};
use project::Project;
use render::{Background, FaceData, Faces, Ground, Lookup, Outlines, PatternSize, Projection, Scene, Unpicked, Water};
use survey::SurveyGeometry;
use ttf::Preset;

/// Changes to a scene; what is `None` stays.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct ViewChanges {
    size_px: Option<[u32; 2]>,
    blend: Option<f32>,
    lookup: Option<Lookup>,
    exaggeration: Option<f64>,
    azimuth_deg: Option<f64>,
    elevation_deg: Option<f64>,
    projection: Option<Projection>,
    zoom: Option<f64>,
    roaming_box: Option<LineBox>,
    cuts: Vec<Cut>,
    ground: Option<Option<Ground>>,
    ground_opacity: Option<f32>,
    /// The level of water, or none.
    water: Option<Option<f64>>,
    face_data: Option<FaceData>,
    tree_level: Option<u32>,
    outlines: Option<Outlines>,
    global_frequency: Option<f32>,
    pattern_size: Option<PatternSize>,
    preset: Option<Preset>,
    samples: Option<u32>,
    background: Option<Background>,
}

impl TryFrom<ViewArgs> for ViewChanges {
    type Error = Usage;

    fn try_from(typed: ViewArgs) -> Result<Self, Usage> {
        let size_px = match &typed.size {
            None => None,
            Some(text) => {
                let [width, height] = counts::<2>("--size", text)?;
                let side = |count: usize| u32::try_from(count).map_err(|_| format!("--size {text}: too large"));
                Some([side(width)?, side(height)?])
            }
        };
        let lookup = match typed.lookup.as_deref() {
            None => None,
            Some("exact") => Some(Lookup::Exact),
            Some("packed") => Some(Lookup::Packed),
            Some(other) => return Err(format!("--lookup {other}: expected exact or packed")),
        };
        let cuts = cuts::typed(&typed)?;
        let background = match typed.background.as_deref() {
            None => None,
            Some("transparent") => Some(Background::Transparent),
            Some(text) => Some(Background::Colour(text.parse().map_err(|error: ttf::TtfError| error.to_string())?)),
        };
        Ok(Self {
            size_px,
            blend: typed.blend,
            lookup,
            exaggeration: typed.exaggeration,
            azimuth_deg: typed.azimuth,
            elevation_deg: typed.elevation,
            projection: typed.perspective.map(|fov_deg| Projection::Perspective { fov_deg }),
            zoom: typed.zoom,
            roaming_box: typed.roaming_box.map(|text| numbers("--box", &text, ',')).transpose()?,
            cuts,
            ground: switch("--ground", typed.ground.as_deref(), Some(Ground::default()), None)?,
            ground_opacity: typed.ground_opacity,
            water: match typed.water.as_deref() {
                None => None,
                Some("off") => Some(None),
                Some(text) => Some(Some(numbers::<1>("--water", text, ',')?[0])),
            },
            face_data: match typed.show.as_deref() {
                None => typed.level.map(|_| FaceData::Leaves),
                Some("rock") => Some(FaceData::Rock),
                Some("leaves") => Some(FaceData::Leaves),
                Some("distance") => Some(FaceData::Distance),
                Some("distortion") => Some(FaceData::Distortion),
                Some(other) => return Err(format!("--show {other}: expected rock, leaves, distance or distortion")),
            },
            tree_level: typed.level,
            outlines: match typed.outlines.as_deref() {
                None => None,
                Some("on") => Some(Outlines::default()),
                Some("dashed") => Some(Outlines { unpicked: Unpicked::Dashed, ..Outlines::default() }),
                Some("off") => Some(Outlines::none()),
                Some(other) => return Err(format!("--outlines {other}: expected on, dashed or off")),
            },
            global_frequency: typed.global_frequency,
            pattern_size: match typed.pattern_size.as_deref() {
                None => None,
                Some("rock") => Some(PatternSize::Rock),
                Some("paper") => Some(PatternSize::Paper),
                Some(other) => return Err(format!("--pattern-size {other}: expected rock or paper")),
            },
            preset: typed.preset.as_deref().map(preset).transpose()?,
            samples: typed.samples,
            background,
        })
    }
}

fn preset(text: &str) -> Result<Preset, Usage> {
    let known = Preset::ALL.into_iter().find(|preset| preset.name() == text);
    known.ok_or_else(|| format!("--preset {text}: expected {}", Preset::ALL.map(Preset::name).join(", ")))
}

fn switch<T>(option: &str, text: Option<&str>, on: T, off: T) -> Result<Option<T>, Usage> {
    match text {
        None => Ok(None),
        Some("on") => Ok(Some(on)),
        Some("off") => Ok(Some(off)),
        Some(other) => Err(format!("{option} {other}: expected on or off")),
    }
}

impl ViewChanges {
    /// Applies the changes to `scene`. Cuts, if any are given, replace the scene's own.
    ///
    /// # Errors
    /// A cut that lies beside the block, or takes all of it.
    pub(super) fn change(&self, scene: &mut Scene, geometry: &SurveyGeometry) -> anyhow::Result<()> {
        scene.size_px = self.size_px.unwrap_or(scene.size_px);
        scene.blend = self.blend.unwrap_or(scene.blend);
        scene.lookup = self.lookup.unwrap_or(scene.lookup);
        scene.exaggeration = self.exaggeration.unwrap_or(scene.exaggeration);
        scene.camera.azimuth_deg = self.azimuth_deg.or(scene.camera.azimuth_deg);
        scene.camera.elevation_deg = self.elevation_deg.unwrap_or(scene.camera.elevation_deg);
        scene.camera.projection = self.projection.unwrap_or(scene.camera.projection);
        scene.camera.zoom = self.zoom.unwrap_or(scene.camera.zoom);
        scene.roaming_box = self.roaming_box.map(|lines| voxel_box(lines, geometry)).or(scene.roaming_box);
        scene.ground = self.ground.unwrap_or(scene.ground);
        if let (Some(ground), Some(opacity)) = (&mut scene.ground, self.ground_opacity) {
            ground.opacity = opacity;
        }
        match self.water {
            None => {}
            Some(None) => scene.water = None,
            Some(Some(level)) => {
                let level = geometry.vertical.index_of(level);
                scene.water = Some(Water { level: Some(level), ..scene.water.unwrap_or_default() });
                scene.ground = scene.ground.or(Some(Ground::default()));
                // The block reaches up to the water at least; below its foot there is none to fill.
                let mut block = scene.box_in(geometry);
                if level < block.min[2] || level >= block.max[2] {
                    block.min[2] = level;
                    scene.roaming_box = Some(block);
                }
            }
        }
        scene.face_data = self.face_data.unwrap_or(scene.face_data);
        scene.tree_level = self.tree_level.unwrap_or(scene.tree_level);
        scene.outlines = self.outlines.unwrap_or(scene.outlines);
        scene.global_frequency = self.global_frequency.unwrap_or(scene.global_frequency);
        scene.pattern_size = self.pattern_size.unwrap_or(scene.pattern_size);
        scene.preset = self.preset.unwrap_or(scene.preset);
        scene.samples = self.samples.unwrap_or(scene.samples);
        scene.background = self.background.unwrap_or(scene.background);
        cuts::change(&self.cuts, scene, geometry)
    }

    /// The same for a view of rock that nobody has composed: where it has a corner cut off, that is the nearest one to the
    /// camera and of the block that were typed, too.
    pub(super) fn with_nearest_cut(mut self, scene: &Scene) -> Self {
        let is_moved = self.azimuth_deg.is_some() || self.roaming_box.is_some();
        if is_moved && self.cuts.is_empty() && !scene.cut_outs.is_empty() && scene.media.faces != Faces::None {
            self.cuts.push(Cut::Corner { corner: None, share: [cuts::CUT_SHARE; 2] });
        }
        self
    }

    /// The same with wells at the corners of fences found in a project.
    pub(super) fn with_wells(&self, project: &Project) -> anyhow::Result<Self> {
        let mut found = self.clone();
        cuts::find_wells(&mut found.cuts, project)?;
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use survey::VerticalUnit;

    fn geometry() -> SurveyGeometry {
        let mut geometry = SurveyGeometry::regular([41, 31, 21], 25.0, 4.0, VerticalUnit::Milliseconds);
        geometry.inlines.first = 140;
        geometry.inlines.step = -1;
        geometry
    }

    #[test]
    fn typed_decimals_mean_the_sample_they_name() {
        let mut geometry = SurveyGeometry::regular([4, 4, 255], 25.0, 2.6, VerticalUnit::Metres);
        geometry.vertical.first = 1166.0;
        let whole = voxel_box([1.0, 4.0, 1.0, 4.0, 1202.4, 1826.4], &geometry);
        assert_eq!((whole.min[2], whole.max[2]), (14.0, 254.0));
        assert_eq!(
            voxel_box([1.0, 4.0, 1.0, 4.0, 1167.3, 1826.4], &geometry).min[2],
            geometry.vertical.index_of(1167.3)
        );
    }

    #[test]
    fn boxes_are_given_in_line_numbers_also_where_they_count_down() {
        let typed = ViewArgs { roaming_box: Some("130,110,1,11,8,40".into()), ..ViewArgs::default() };
        let mut scene = Scene::default();
        ViewChanges::try_from(typed).unwrap().change(&mut scene, &geometry()).unwrap();
        let block = scene.roaming_box.unwrap();
        assert_eq!((block.min, block.max), ([10.0, 0.0, 2.0], [30.0, 10.0, 10.0]));
    }

    #[test]
    fn the_nearest_corner_depends_on_the_camera() {
        let cut = |azimuth| {
            let typed = ViewArgs { cut: vec!["nearest,0.5,0.5".into()], azimuth: Some(azimuth), ..ViewArgs::default() };
            let mut scene = Scene::default();
            ViewChanges::try_from(typed).unwrap().change(&mut scene, &geometry()).unwrap();
            scene.cut_outs[0]
        };
        assert_ne!(cut(30.0), cut(210.0));
        assert_eq!(cut(30.0).extent(), DVec3::new(20.0, 15.0, 20.0));
    }

    #[test]
    fn a_view_that_nobody_composed_is_cut_at_the_nearest_corner() {
        let geometry = geometry();
        let mut scene = Scene::default();
        scene.cut_outs = vec![scene.box_in(&geometry).corner_cut(render::Corner::MinMin, [0.45; 2])];
        let cut = |typed: ViewArgs| {
            let mut scene = scene.clone();
            let changes = ViewChanges::try_from(typed).unwrap().with_nearest_cut(&scene);
            changes.change(&mut scene, &geometry).unwrap();
            scene.cut_outs
        };
        assert_eq!(cut(ViewArgs::default()), scene.cut_outs);
        for azimuth in [30.0, 120.0, 210.0, 300.0] {
            let azimuth = Some(azimuth);
            let nearest = cut(ViewArgs { cut: vec!["nearest".into()], azimuth, ..ViewArgs::default() });
            assert_eq!(cut(ViewArgs { azimuth, ..ViewArgs::default() }), nearest);
            let other = cut(ViewArgs { cut: vec!["min-max,0.2,0.2".into()], azimuth, ..ViewArgs::default() });
            assert_ne!(other, nearest);
        }
        let part = cut(ViewArgs { roaming_box: Some("130,110,1,11,8,40".into()), ..ViewArgs::default() });
        assert!(part[0].min[0] >= 10.0 && part[0].max[0] <= 30.0, "{part:?}");
    }

    #[test]
    fn a_fence_is_cut_towards_the_viewer() {
        let side = |azimuth| {
            let cut_fence = vec!["140,16".into(), "120,10".into(), "100,16".into()];
            let typed = ViewArgs { cut_fence, azimuth: Some(azimuth), ..ViewArgs::default() };
            let mut scene = Scene::default();
            ViewChanges::try_from(typed).unwrap().change(&mut scene, &geometry()).unwrap();
            let [render::CutShape::Fence { side, fence, .. }] = scene.cut_shapes.as_slice() else { panic!("a fence") };
            assert_eq!(fence[1], [20.0, 9.0]);
            assert!(scene.validate(&geometry()).is_ok());
            *side
        };
        assert_ne!(side(0.0), side(180.0));
    }

    #[test]
    fn nonsense_is_a_usage_error() {
        let refused = |typed: ViewArgs| ViewChanges::try_from(typed).unwrap_err();
        refused(ViewArgs { cut: vec!["left".into()], ..ViewArgs::default() });
        refused(ViewArgs { cut: vec!["nearest,0.5".into()], ..ViewArgs::default() });
        refused(ViewArgs { cut: vec!["nearest,0,1".into()], ..ViewArgs::default() });
        refused(ViewArgs { cut_fence: vec!["1,2".into(), "3".into()], ..ViewArgs::default() });
        refused(ViewArgs { cut_round: vec!["1,2,0".into()], ..ViewArgs::default() });
        refused(ViewArgs { cut_plane: vec!["1,2,3,4,95".into()], ..ViewArgs::default() });
        refused(ViewArgs { cut_depth: Some("1,2".into()), ..ViewArgs::default() });
        refused(ViewArgs { size: Some("800".into()), ..ViewArgs::default() });
        refused(ViewArgs { lookup: Some("fast".into()), ..ViewArgs::default() });
        refused(ViewArgs { preset: Some("sepia".into()), ..ViewArgs::default() });
        refused(ViewArgs { background: Some("red".into()), ..ViewArgs::default() });
    }
}
