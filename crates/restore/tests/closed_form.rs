//! Blocks told as events, and restored: what the events did is undone, to a share of a voxel.

use glam::{DVec3, Vec3};
use history::{FaultBlocks, History};
use model::{FaultNetwork, FaultThrows, ModelSettings, StructuralModel};
use restore::{Datum, RestoreError, RestoreNote, RestoreSettings, Restored, restore};
use survey::{Progress, SurveyGeometry};

/// A block, its model and the horizons of it.
struct Told {
    geometry: SurveyGeometry,
    model: StructuralModel,
    horizons: Vec<survey::Horizon>,
}

impl Told {
    fn by(events: &str) -> Self {
        let text = format!(
            "size = [4000, 600, 1500]
            [[events]]
            kind = \"beds\"
            beds = [{{ rock = \"granite\", thickness = 900, name = \"Basement\" }},
                {{ rock = \"limestone\", thickness = 200, name = \"Lime\" }},
                {{ rock = \"shale\", thickness = 150, name = \"Shale\" }},
                {{ rock = \"sandstone\", thickness = 150, name = \"Sand\" }},
                {{ rock = \"siltstone\", thickness = 100, name = \"Silt\" }}]
            {events}"
        );
        let history = History::from_toml(&text).unwrap();
        let stage = history.last_stage();
        let (geometry, faults) = (stage.geometry(), stage.faults());
        let network = FaultNetwork::build(&geometry, &faults, &Progress::silent()).unwrap();
        let at = |p: DVec3| network.block_at(geometry.voxel_from_world(p).as_vec3());
        let made = stage.interpretation(&FaultBlocks { count: network.block_count(), at: &at });
        let settings = ModelSettings::default();
        let model = StructuralModel::build(
            &geometry,
            &made.stratigraphy,
            &made.horizons,
            &faults,
            &settings,
            &Progress::silent(),
        );
        Self { geometry, model: model.unwrap(), horizons: made.horizons }
    }

    fn to(&self, name: &str, datum: Datum) -> Result<Restored, RestoreError> {
        let target = self.horizons.iter().position(|horizon| horizon.name == name).unwrap();
        let settings = RestoreSettings { datum, depth: Some(300.0) };
        restore(&self.geometry, &self.model, &self.horizons, target, &settings, &Progress::silent())
    }

    /// The model of what was restored.
    fn model_of(&self, restored: &Restored) -> StructuralModel {
        let Restored { stratigraphy, horizons, faults, .. } = restored;
        let settings = ModelSettings::default();
        StructuralModel::build(&self.geometry, stratigraphy, horizons, faults, &settings, &Progress::silent()).unwrap()
    }
}

/// The largest distance, voxels, of a horizon from a level depth (m) where it is drawn in a model.
fn off_level(told: &Told, model: &StructuralModel, name: &str, depth: f64) -> f64 {
    let h = model.stratigraphy().horizons.iter().position(|horizon| horizon.name == name).unwrap();
    let z = told.geometry.vertical.index_of(depth);
    let [nx, ny, _] = model.size();
    let mut worst = 0.0f64;
    for (x, y) in (0..nx).flat_map(|x| (0..ny).step_by(4).map(move |y| (x as f32, y as f32))) {
        for block in 0..model.block_count() as u16 {
            let found = model.sheet(h, block).z_at(x, y);
            if model.faults().holds(block, Vec3::new(x, y, found)) {
                worst = worst.max((f64::from(found) - z).abs());
            }
        }
    }
    worst
}

/// The largest throw of all horizons along all faults, voxels.
fn largest_throw(model: &StructuralModel) -> f64 {
    let faults = 0..model.faults().surfaces().len();
    let of_fault = |fault: usize| FaultThrows::new(model, fault).profile(9);
    let throws = faults.flat_map(of_fault).flat_map(|of| of.throws);
    throws.map(|throw| throw.samples().abs()).fold(0.0, f64::max)
}

const TILT: &str = "[[events]]\nkind = \"tilt\"\ndip = 4\ndirection = 90\n";
const FOLD: &str = "[[events]]\nkind = \"fold\"\nwavelength = 1700\namplitude = 90\naxis = 0\n";

fn fault(strike: f64, slip: f64) -> String {
    format!(
        "[[events]]\nkind = \"fault\"\nname = \"F1\"\nat = [2000, 300, 0]\nstrike = {strike}\ndip = 60\nslip = {slip}\n"
    )
}

/// Below the top of the sand, which is restored to 300 m, lie the tops of the shale, the lime and the basement.
fn is_a_layer_cake(told: &Told, most_voxels: f64) -> Restored {
    let restored = told.to("Top Sand", Datum::Flat).unwrap();
    let names: Vec<&str> = restored.horizons.iter().map(|horizon| horizon.name.as_str()).collect();
    assert_eq!(names, ["Top Sand", "Top Shale", "Top Lime", "Top Basement"], "the silt is gone");
    let model = told.model_of(&restored);
    for (name, depth) in [("Top Sand", 300.0), ("Top Shale", 450.0), ("Top Lime", 600.0), ("Top Basement", 800.0)] {
        let off = off_level(told, &model, name, depth);
        assert!(off < most_voxels, "{name}: {off}");
    }
    assert!(off_level(told, &model, "Top Sand", 300.0) < 0.01);
    let throw = largest_throw(&model);
    assert!(throw < most_voxels, "{throw}");
    restored
}

#[test]
fn tilt_fault_and_fold_are_undone() {
    for (strike, slip) in [(0.0, 200.0), (0.0, -150.0), (20.0, 180.0)] {
        let told = Told::by(&[TILT, &fault(strike, slip), FOLD].concat());
        let restored = is_a_layer_cake(&told, 0.6);
        let [moved] = &restored.fault_moves[..] else { panic!("{:?}", restored.fault_moves) };
        let heave = slip * 60f64.to_radians().cos();
        assert!((moved.heave_m / heave - 1.0).abs() < 0.1, "{moved:?}");
        assert!(moved.left_m < 2.0 && moved.misfit_m[1] < 6.0, "{moved:?}");
        for layer in &restored.balance.layers {
            let percent = layer.section_m2.percent.unwrap();
            assert!(percent.abs() < 0.5, "{strike} {slip} {layer:?}");
        }
        for horizon in &restored.balance.horizons {
            assert!(horizon.map_m2.percent.unwrap().abs() < 0.5, "{horizon:?}");
            // The sine of the fold, 90 m and 1700 m: 1 + (2π a / λ)² / 4 without the tilt.
            let percent = horizon.length_m.percent.unwrap();
            assert!(percent < -1.5 && percent > -4.5, "{strike} {slip}: {horizon:?}");
        }
    }
}

#[test]
fn a_fold_before_the_fault_goes_on_below_it() {
    let told = Told::by(&[FOLD, &fault(0.0, 200.0)].concat());
    let restored = is_a_layer_cake(&told, 1.0);
    assert!(restored.notes.iter().all(|note| !matches!(note, RestoreNote::NotClosed { .. })), "{:?}", restored.notes);
}

#[test]
fn a_tip_joins_blocks_that_move_apart_beside_it() {
    let events = "[[events]]\nkind = \"fault\"\nname = \"F1\"\nat = [2000, 0, 700]\nstrike = 0\ndip = 60\nslip = 120\n\
         extent = [900, 4000]\n";
    let told = Told::by(events);
    let restored = told.to("Top Sand", Datum::Flat).unwrap();
    let model = told.model_of(&restored);
    assert!(off_level(&told, &model, "Top Sand", 300.0) < 0.05);
    assert!(largest_throw(&model) < 3.0, "{}", largest_throw(&model));
    assert!(restored.fault_moves[0].left_m < 3.0, "{:?}", restored.fault_moves);
}

#[test]
fn a_regional_slope_is_kept_and_a_stated_one_given() {
    let told = Told::by(&[TILT, FOLD].concat());
    let slope = 4f64.to_radians().tan();
    let voxel = |restored: &Restored| restored.plane.slope * told.geometry.sample_m() / told.geometry.inline_vector.x;
    let regional = voxel(&told.to("Top Sand", Datum::Regional).unwrap());
    // The fold is not a whole number of waves long.
    assert!((regional.x - slope).abs() < 0.03 && regional.y.abs() < 1e-3, "{regional}");
    let stated = voxel(&told.to("Top Sand", Datum::Dipping { dip: 4.0, direction: 90.0 }).unwrap());
    assert!((stated.x - slope).abs() < 1e-9 && stated.y.abs() < 1e-9, "{stated}");
}

#[test]
fn what_was_worn_away_is_put_back_and_said() {
    let told = Told::by(&[&fault(0.0, 200.0), "[[events]]\nkind = \"erosion\"\ndepth = 180\n"].concat());
    let restored = is_a_layer_cake(&told, 0.6);
    let continued = restored.notes.iter().find_map(|note| match note {
        RestoreNote::Continued { share, .. } => Some(*share),
        _ => None,
    });
    assert!(continued.is_some_and(|share| share > 0.3 && share < 0.7), "{:?}", restored.notes);
}

#[test]
fn a_body_that_cuts_the_horizon_is_younger_and_one_below_it_goes_along() {
    let pluton = |height: f64| {
        format!("[[events]]\nkind = \"pluton\"\nname = \"Pluton\"\nradius = 500\nheight = {height}\nroughness = 0\n")
    };
    let told = Told::by(&pluton(1450.0));
    let restored = told.to("Top Sand", Datum::Flat).unwrap();
    let is_gone = |note: &RestoreNote| matches!(note, RestoreNote::BodyTakenAway { body, .. } if body == "Pluton");
    assert!(restored.notes.iter().any(is_gone), "{:?}", restored.notes);
    assert!(matches!(told.to("Pluton", Datum::Flat), Err(RestoreError::NotASheet { .. })));
    let steep = told.to("Top Sand", Datum::Dipping { dip: 80.0, direction: 0.0 });
    assert!(matches!(steep, Err(RestoreError::Dip { .. })));
    let told = Told::by(&[FOLD, &pluton(700.0)].concat());
    let restored = told.to("Top Sand", Datum::Flat).unwrap();
    assert!(restored.notes.iter().any(|note| matches!(note, RestoreNote::Carried { .. })), "{:?}", restored.notes);
    // Its roof was 700 m deep under a crest, 600 m below the horizon.
    let pluton = restored.horizons.iter().find_map(|horizon| horizon.any_shape()).unwrap();
    let roof = pluton.vertices.iter().map(|vertex| vertex.z).fold(f64::INFINITY, f64::min);
    assert!(roof > 850.0 && roof < 1100.0, "{roof}");
}
