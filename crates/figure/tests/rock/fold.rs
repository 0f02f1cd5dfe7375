//! A closed form drawn with patterns on a page, as pictures and as paths.

use figure::cut::SectionSource;
use figure::draw::NamedColour;
use figure::draw::block::BlockPainter;
use figure::{BlockPart, Figure, FigureInputs, PageSize, make};
use glam::DVec3;
use image::RgbaImage;
use model::{ModelSettings, StructuralModel};
use page::list::DisplayList;
use param::{ParamSettings, Parameterization};
use render::vector::{VectorBlock, vectors};
use render::{Inputs, RenderError, Scene, VoxelBox};
use survey::{Progress, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;
use ttf::{BlockExtent, Colour, LayerExtent, LayerStyle, TextureLibrary, TransferFunctions, TtfTables};

/// A fold with a fault, each layer in a pattern.
pub(crate) struct Fold {
    pub geometry: SurveyGeometry,
    pub model: StructuralModel,
    param: Parameterization,
    tables: TtfTables,
    library: TextureLibrary,
    pub layers: Vec<LayerStyle>,
}

impl Fold {
    pub(crate) fn new() -> Self {
        let geometry = SurveyGeometry::regular([61, 41, 51], 12.5, 12.5, VerticalUnit::Metres);
        let closed = ClosedForm::dome(&geometry, &[10.0, 22.0, 34.0], 30.0).with_fault(65.0, 6.0);
        Self::of(geometry, &closed, &["limestone", "shale", "dolostone", "limestone"])
    }

    /// A closed form with a pattern, or a colour such as #c81e1e, for each layer, deepest first.
    pub(crate) fn of(geometry: SurveyGeometry, closed: &ClosedForm, patterns: &[&str]) -> Self {
        let quiet = Progress::silent();
        let (stratigraphy, horizons) = (&closed.stratigraphy, &closed.horizons);
        let settings = ModelSettings::default();
        let model =
            StructuralModel::build(&geometry, stratigraphy, horizons, &closed.faults, &settings, &quiet).unwrap();
        let param = Parameterization::compute(&model, &ParamSettings::default(), &quiet).unwrap();
        let library = TextureLibrary::builtin().unwrap();
        let names = closed.stratigraphy.layer_names_bottom_up();
        let styles = names.iter().zip(patterns).map(|(name, pattern)| match pattern.strip_prefix('#') {
            Some(colour) => {
                let [_, r, g, b] = u32::from_str_radix(colour, 16).unwrap().to_be_bytes();
                LayerStyle::plain(name, Colour::new(r, g, b))
            }
            None => LayerStyle::textured(name, library.pattern(library.find(pattern).unwrap()).colour, pattern),
        });
        let mut layers: Vec<LayerStyle> = styles.collect();
        let mut functions = TransferFunctions::default();
        layers.iter().for_each(|style| functions.layers.set(style.clone()));
        let extent = geometry.metric_from_voxel() * DVec3::from_array(VoxelBox::of_size(geometry.size()).max);
        let thickness_m = 12.0 * 12.5;
        let block = BlockExtent {
            extent_i_m: extent.x.abs() as f32,
            extent_j_m: extent.y.abs() as f32,
            layers: names.into_iter().map(|name| LayerExtent { name, thickness_m }).collect(),
            metres_per_mm: extent.x.abs() as f32 / 120.0,
        };
        let tables = TtfTables::compile(&functions, &block, &library).unwrap();
        // Youngest first, as legends list them.
        layers.reverse();
        Self { geometry, model, param, tables, library, layers }
    }

    pub(crate) fn inputs(&self) -> Inputs<'_> {
        Inputs {
            geometry: &self.geometry,
            model: Some(&self.model),
            param: Some(&self.param),
            packed: None,
            tables: Some(&self.tables),
            volumes: &[],
            candidates: None,
            wells: &[],
            data_key: 1,
        }
    }

    pub(crate) fn page(&self, scene: &Scene, has_vectors: bool) -> DisplayList {
        let part = BlockPart { scene: scene.clone(), ..BlockPart::default() };
        let figure = Figure { size: PageSize::Px(scene.size_px), dpi: 200.0, ..Figure::of(part.into()) };
        self.made(&figure, has_vectors)
    }

    pub(crate) fn made(&self, figure: &Figure, has_vectors: bool) -> DisplayList {
        let horizons = ["H1", "H2", "H3"].map(|name| NamedColour { name: name.into(), colour: Colour::BLACK });
        let inputs = FigureInputs {
            source: SectionSource { data: self.inputs(), raw: None },
            horizons: &horizons,
            strata: &self.model.stratigraphy().horizons,
            outlined: &[],
            wells: &[],
            faults: &["F1".to_owned()],
            fault_colours: &[],
            layers: &self.layers,
            library: Some(&self.library),
            interpretation: None,
            provenance: "",
        };
        make(figure, &inputs, &mut Painter { fold: self, has_vectors }).unwrap()
    }
}

struct Painter<'a> {
    fold: &'a Fold,
    has_vectors: bool,
}

impl BlockPainter for Painter<'_> {
    fn paint(&mut self, scene: &Scene) -> Result<RgbaImage, RenderError> {
        render::reference::render(scene, &self.fold.inputs(), &Progress::silent())
    }

    fn trace(&mut self, scene: &Scene, tolerance_px: f64) -> Result<Option<VectorBlock>, RenderError> {
        if !self.has_vectors {
            return Ok(None);
        }
        vectors(scene, &self.fold.inputs(), &self.fold.library, tolerance_px, scene.size_px, &Progress::silent())
    }
}
