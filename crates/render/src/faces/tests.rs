//! The shader is valid, and Rust and WGSL agree on every shared struct and constant.

use super::layout::{FaceParams, FaultInfo, GridInfo, ModelInfo, PackedInfo, PlaneInfo, SheetInfo};
use super::light::Slice;
use super::media::{HORIZON_WORDS, MediaParams, MediumInfo};
use super::textures::TextureInfo;
use super::volumes::VolumePlacement;
use super::{Renderer, shader};
use crate::media::{march, samples, table};
use crate::{Inputs, RenderError, Scene, ground, inputs, leaves, visible, wells};
use model::{ModelSettings, StructuralModel};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use param::{KDefinition, ParamSettings, Parameterization};
use std::mem::offset_of;
use survey::{Progress, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;
use ttf::tables::{IntervalEntry, LayerEntry, ScalarEntry, StopEntry, TtfGlobals};
use ttf::{BlockExtent, LayerExtent, TextureLibrary, TransferFunctions, TtfTables};

fn module() -> naga::Module {
    parsed(&shader(true))
}

fn parsed(text: &str) -> naga::Module {
    naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)))
}

#[test]
fn the_shader_is_valid() {
    for text in [shader(true), shader(false)] {
        let module = parsed(&text);
        Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
        for name in ["draw", "carry"] {
            assert!(module.entry_points.iter().any(|entry| entry.name == name), "{name}");
        }
    }
}

/// Compares the members of a struct with Rust's fields: same names, order, offsets and size. Padding is
/// ignored.
fn same_layout(module: &naga::Module, name: &str, size: usize, fields: &[(&str, usize)]) {
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some((_, naga::Type { inner: naga::TypeInner::Struct { members, span }, .. })) = found else {
        panic!("the shader has no struct {name}")
    };
    let members: Vec<(&str, usize)> = members
        .iter()
        .map(|member| (member.name.as_deref().unwrap_or_default(), member.offset as usize))
        .filter(|(member, _)| !member.starts_with("padding"))
        .collect();
    assert_eq!(members, fields, "{name}");
    assert_eq!(*span as usize, size, "size of {name}");
}

macro_rules! check {
    ($module:expr, $name:ident: $($field:ident),+) => {
        same_layout(
            $module,
            stringify!($name),
            size_of::<$name>(),
            &[$((stringify!($field), offset_of!($name, $field))),+],
        )
    };
}

#[test]
fn structs_have_the_same_layout() {
    let m = &module();
    check!(m, FaceParams: origin, origin_dx, origin_dy, direction, direction_dx, direction_dy, box_low, box_high,
        background, voxel_m, light, display_normal_x, display_normal_y, display_normal_z, relief, reference_px,
        samples, cut_count, map_low, map_cells, ground_horizons, ground_opacity, tile, bodies, planes);
    check!(m, PlaneInfo: normal, metric_normal, along, shift, axis, metre_p, metre_q);
    check!(m, SheetInfo: origin, size, offset, level, at, scale_m);
    check!(m, FaultInfo: u, v, w, surface);
    check!(m, ModelInfo: centre, horizons, blocks, faults, layers, unit_from_voxel);
    check!(m, GridInfo: origin, size, levels, first_column, bottom_sheet, top_sheet, bottom_shift, top_shift, is_calm,
        unfolded_i, unfolded_j, log_weight, thickness_m);
    check!(m, PackedInfo: scale, size, i_range, j_range, layers, blocks);
    check!(m, TextureInfo: mean, offset, side, levels);
    check!(m, VolumePlacement: scale, offset, size);
    check!(m, TtfGlobals: no_data, raw_domain, blend, global_frequency, aspect_j, raw_volume, scalar_count, stop_count,
        finer_share, extent_i_m);
    check!(m, LayerEntry: colour, frequency, first_interval, interval_count, thickness_m, is_sized);
    check!(m, IntervalEntry: colour, ink, k, frequency, texture, is_sized);
    check!(m, ScalarEntry: colour, ink, range, factor, texture, volume, opacity);
    check!(m, StopEntry: colour, at);
    check!(m, Slice: index, side);
    check!(m, MediumInfo: low, scale, slot, table, layers, zone, coloured, shades);
    check!(m, MediaParams: display_x, display_y, display_z, covector_x, covector_y, covector_z, light, phong, cells_x,
        cells_y, cells_z, cells_shift, cells_low, back, right, up, forward, grid, cells, bricks, scales, candidates,
        leaves, slice_units, groups, wells, capsules, media);
}

#[test]
#[should_panic(expected = "GridInfo")]
fn a_field_out_of_place_is_noticed() {
    check!(&module(), GridInfo: size, origin, levels, first_column, bottom_sheet, top_sheet, bottom_shift, top_shift, is_calm);
}

/// The value of a constant of the shader.
fn constant(module: &naga::Module, name: &str) -> f64 {
    let found = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name));
    let Some((_, constant)) = found else { panic!("the shader has no constant {name}") };
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::F32(value)) => f64::from(value),
        naga::Expression::Literal(naga::Literal::U32(value)) => f64::from(value),
        ref other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn constants_are_the_same() {
    let m = module();
    for (name, value) in [
        ("TOUCH", f64::from(visible::TOUCH)),
        ("BODIES", super::layout::BODIES as f64),
        ("PLANES", super::layout::PLANES as f64),
        ("SHORTEST_STEP", f64::from(ground::SHORTEST_STEP)),
        ("BISECTIONS", f64::from(ground::BISECTIONS)),
        ("MAX_STEPS", f64::from(ground::MAX_STEPS)),
        ("PINCHED", f64::from(super::grids::PINCHED)),
        ("CELL", f64::from(ground::CELL)),
        ("INTO_CELL", f64::from(ground::INTO_CELL)),
        ("INTO_ROCK", f64::from(ground::INTO_ROCK)),
        ("NO_WEIGHT", f64::from(inputs::NO_WEIGHT)),
        ("SLACK", f64::from(inputs::SLACK)),
        ("MAX_TAPS", f64::from(ttf::texture::MAX_TAPS)),
        ("MAP_ONLY_CALMNESS_SQ", f64::from(ttf::coordinates::MAP_ONLY_CALMNESS_SQ)),
        ("NO_MAP_CALMNESS_SQ", f64::from(ttf::coordinates::NO_MAP_CALMNESS_SQ)),
        ("MAP_RATHER_SQ", f64::from(ttf::coordinates::MAP_RATHER_SQ)),
        ("ACROSS_ONLY_SHARE", f64::from(ttf::coordinates::ACROSS_ONLY_SHARE)),
        ("ALONG_ONLY_SHARE", f64::from(ttf::coordinates::ALONG_ONLY_SHARE)),
        ("NONE", f64::from(ttf::tables::NONE)),
        ("ENTRIES", table::ENTRIES as f64),
        ("OPAQUE", f64::from(table::OPAQUE)),
        ("NO_DATA", f64::from(samples::NO_DATA)),
        ("NO_DATA_BELOW", f64::from(samples::NO_DATA_BELOW)),
        ("SPENT", f64::from(march::SPENT)),
        ("SOFT", f64::from(crate::media::shell::SOFT)),
        ("BRICK", crate::media::preparation::BRICK as f64),
        ("MIXED", f64::from(crate::media::bricks::MIXED)),
        ("HORIZON_WORDS", HORIZON_WORDS as f64),
        ("HALF_WIDTH", f64::from(leaves::HALF_WIDTH)),
        ("FADE", f64::from(leaves::FADE)),
        ("BLACK_AT", f64::from(leaves::BLACK_AT)),
        ("BORDER", f64::from(leaves::BORDER)),
        ("BORDER_REACH", f64::from(leaves::BORDER_REACH)),
        ("BORDER_TONE", f64::from(leaves::BORDER_TONE)),
        ("RIM_LIGHT", f64::from(wells::RIM_LIGHT)),
    ] {
        assert_eq!(constant(&m, name), value, "{name}");
    }
}

/// A model that does not fit into one buffer is split over two, and refused if it does not fit into those.
#[test]
fn a_split_pool_draws_the_same() {
    if std::env::var("PETROGLYPH_GPU_TESTS").is_ok_and(|value| value == "skip") {
        eprintln!("skipped: PETROGLYPH_GPU_TESTS=skip");
        return;
    }
    let quiet = Progress::silent();
    let geometry = SurveyGeometry::regular([21, 17, 25], 25.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dipping(&geometry, &[8.0, 16.0], 10.0, 40.0).with_fault(60.0, 3.0);
    let settings = ModelSettings::default();
    let model = StructuralModel::build(
        &closed.geometry,
        &closed.stratigraphy,
        &closed.horizons,
        &closed.faults,
        &settings,
        &quiet,
    )
    .unwrap();
    // By a definition without sheets of its own, so that the pool holds those of the horizons alone.
    let definitions = vec![KDefinition::DistanceRatio; model.layer_count()];
    let settings = ParamSettings { definitions, ..ParamSettings::default() };
    let param = Parameterization::compute(&model, &settings, &quiet).unwrap();
    let names = closed.stratigraphy.layer_names_bottom_up();
    let block = BlockExtent {
        extent_i_m: 500.0,
        extent_j_m: 400.0,
        layers: names.into_iter().map(|name| LayerExtent { name, thickness_m: 80.0 }).collect(),
        metres_per_mm: 5.0,
    };
    let library = TextureLibrary::builtin().unwrap();
    let tables = TtfTables::compile(&TransferFunctions::default(), &block, &library).unwrap();
    let inputs = Inputs {
        geometry: &closed.geometry,
        model: Some(&model),
        param: Some(&param),
        packed: None,
        tables: Some(&tables),
        volumes: &[],
        candidates: None,
        wells: &[],
        data_key: 1,
    };
    let scene = Scene { size_px: [90, 70], samples: 1, ..Scene::default() };
    let mut renderer = Renderer::headless().unwrap();
    let whole = renderer.render(&scene, &inputs, &quiet).unwrap();
    let largest = renderer.gpu.buffer_floats;
    let pool: usize = (0..4).map(|n| model.sheet(n / 2, (n % 2) as u16).z.len()).sum();
    renderer.gpu.buffer_floats = pool * 5 / 8;
    renderer.model = None;
    // The grids are not uploaded again.
    let split = renderer.render(&scene, &inputs, &quiet).unwrap();
    assert!(renderer.model.as_ref().is_some_and(|model| model.pool_chunks() == 2));
    assert!(split == whole);
    renderer.gpu.buffer_floats = pool / 4;
    renderer.model = None;
    assert!(matches!(renderer.render(&scene, &inputs, &quiet), Err(RenderError::OutOfMemory { .. })));
    renderer.gpu.buffer_floats = largest;
    assert!(renderer.render(&scene, &inputs, &quiet).unwrap() == whole);
}
