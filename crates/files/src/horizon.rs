//! Makes a [`Horizon`] from a surface as read: converts it, places it on nodes, splits it into sheets and
//! checks it against the survey.

use super::columns::is_inside;
use super::lattice::{self, FittedLattice};
use super::options::{HorizonShape, ImportOptions};
use super::orientations;
use super::overturned_points::SeenSideways;
use super::placement::{self, PlacedPoints, voxel_xy};
use super::raster;
use super::raw::{RawPoint, RawShape, RawSurface};
use super::report::{Gridding, ImportReport, Settled};
use super::scatter::{self, SAME_DEPTH};
use super::sheets::{self, Crowded, MAX_DEPTHS, NodeValues};
use super::surface_kind::{self, MeshKind};
use super::vertical::VerticalRule;
use super::{Format, FormatError, SurfaceKind};
use glam::{DVec2, DVec3};
use std::path::Path;
use survey::Progress;
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::mesh::TriangleMesh;
use survey::remedy::{Note, Setting};

/// Memory that a horizon takes for each trace of the survey while it is put there.
const BYTES_A_TRACE: usize = 24;

/// Depths of a mesh at each trace on average, at most: a horizon has one, two where it is overthrust.
const MAX_MEAN_DEPTHS: usize = 4;

/// So many depths are no work, however few the traces.
const FEW: usize = 100_000;

/// The error of a horizon with too many depths at a place.
fn crowded(file: &Path, name: &str) -> FormatError {
    FormatError::Crowded { file: file.to_path_buf(), name: name.to_owned(), limit: MAX_DEPTHS }
}

/// Sheets, and how they were made.
struct GriddedSheets {
    sheets: Vec<Sheet>,
    gridding: Gridding,
    outside: usize,
    multivalued: usize,
    notes: Vec<String>,
    warnings: Vec<Note>,
    /// What it is instead of sheets.
    surface: Option<TriangleMesh>,
    /// Points far off a map through their neighbours.
    off_map: Option<(usize, Note)>,
    /// What is said of the map through scattered points alone.
    of_map: Vec<String>,
}

impl GriddedSheets {
    /// Sheets of which there is nothing more to say.
    fn of(sheets: Vec<Sheet>, gridding: Gridding, outside: usize) -> Self {
        let (notes, warnings) = (Vec::new(), Vec::new());
        let (surface, off_map, of_map) = (None, None, Vec::new());
        Self { sheets, gridding, outside, multivalued: 0, notes, warnings, surface, off_map, of_map }
    }

    /// A surface that is no height field, as it was given.
    fn any_shape(surface: TriangleMesh, outside: usize, note: Option<&str>) -> Self {
        let gridding = Gridding::AnyShape { corners: surface.vertices.len(), triangles: surface.triangles.len() };
        let notes = note.map(str::to_owned).into_iter().collect();
        Self { notes, surface: Some(surface), ..Self::of(Vec::new(), gridding, outside) }
    }
}

/// Makes the horizon.
pub(super) fn build(
    file: &Path,
    name: String,
    format: Settled<Format>,
    mut raw: RawSurface,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
) -> Result<(Horizon, ImportReport), FormatError> {
    let rule = VerticalRule::settle(file, &raw.vertical, options, geometry.vertical.unit)?;
    let counts = rule.apply(&mut raw.shape);
    if counts.nulls == counts.values {
        let why = format!("'{name}' has {} values, all null", counts.values);
        return Err(FormatError::Empty { file: file.to_path_buf(), kind: SurfaceKind::Horizon, why });
    }
    if let RawShape::Points(points) = &mut raw.shape {
        points.retain(|p| p.z.is_finite());
        take_dips(points, geometry);
        if let (Some(oriented), Some(from)) = (raw.orientations.take(), &options.orientations) {
            raw.notes.push(orientations::join(from, points, *oriented, geometry, options)?);
        }
    }
    let [nu, nv, _] = geometry.size();
    system::memory::check("a map of the survey", &[nu, nv], BYTES_A_TRACE)
        .map_err(|source| FormatError::Memory { file: file.to_path_buf(), source })?;
    let tolerance = (SAME_DEPTH * geometry.vertical.interval) as f32;
    let nodes = match &raw.shape {
        RawShape::Grid { grid, z } => from_grid(file, &name, *grid, z, geometry)?,
        RawShape::Points(points) => from_points(file, &name, points, geometry, options, tolerance)?,
        RawShape::Mesh(mesh) => from_mesh(file, &name, mesh, geometry, options, tolerance)?,
    };
    let values: Vec<f64> = raw.shape.values().collect();
    let outside_range = rule.check(file, &name, &values, &geometry.vertical, SurfaceKind::Horizon)?;
    let mut notes = raw.notes;
    notes.extend(nodes.notes);
    let mut warnings = raw.warnings;
    warnings.extend(nodes.warnings);
    let report = ImportReport {
        file: file.to_path_buf(),
        kind: SurfaceKind::Horizon,
        name: name.clone(),
        format,
        values: counts.values,
        nulls: counts.nulls,
        outside_survey: nodes.outside,
        outside_range,
        range_in_file: counts.range_in_file,
        range: counts.range,
        unit: geometry.vertical.unit,
        assumptions: rule.assumptions(),
        z_unit: rule.unit,
        z_positive: rule.positive,
        z_factor: rule.factor,
        gridding: nodes.gridding,
        sheets: nodes.sheets.len(),
        multivalued: nodes.multivalued,
        notes,
        warnings,
        off_map: nodes.off_map,
        of_map: nodes.of_map,
    };
    Ok((Horizon { name, sheets: nodes.sheets, surface: nodes.surface }, report))
}

/// Makes normals of dips, which are told of depths alone.
pub(super) fn take_dips(points: &mut [RawPoint], geometry: &SurveyGeometry) {
    if geometry.vertical.unit == VerticalUnit::Metres {
        points.iter_mut().for_each(|point| point.normal = point.normal.or(point.dip.map(normal_of)));
    }
}

/// The normal, in the directions of X, Y and depth, of beds with a dip, its direction and their polarity: towards the
/// younger ones.
fn normal_of([dip_deg, azimuth_deg, polarity]: [f64; 3]) -> DVec3 {
    let ((sin, cos), (east, north)) = (dip_deg.to_radians().sin_cos(), azimuth_deg.to_radians().sin_cos());
    DVec3::new(sin * east, sin * north, -cos) * if polarity < 0.0 { -1.0 } else { 1.0 }
}

fn from_grid(
    file: &Path,
    name: &str,
    grid: NodeGrid,
    z: &[f64],
    geometry: &SurveyGeometry,
) -> Result<GriddedSheets, FormatError> {
    let nv = grid.count[1];
    let known = z.iter().enumerate().filter(|(_, z)| z.is_finite());
    let worlds: Vec<DVec2> = known.map(|(n, _)| grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64))).collect();
    let outside = worlds.iter().filter(|w| !is_inside(voxel_xy(geometry, **w), geometry)).count();
    if outside == worlds.len() {
        return Err(placement::outside_by_world(file, name, worlds.into_iter(), geometry));
    }
    let depth = z.iter().map(|&z| z as f32).collect();
    let sheets = vec![Sheet::new(grid, depth, Quality::Picked)];
    Ok(GriddedSheets::of(sheets, Gridding::NativeGrid { count: grid.count }, outside))
}

fn from_points(
    file: &Path,
    name: &str,
    points: &[RawPoint],
    geometry: &SurveyGeometry,
    options: &ImportOptions,
    tolerance: f32,
) -> Result<GriddedSheets, FormatError> {
    let mut placed = placement::place(file, name, points, geometry, options.place_by)?;
    let mut notes: Vec<String> = placed.note.take().into_iter().collect();
    let mut of_map: Vec<String> = Vec::new();
    if points.iter().all(|p| p.normal.is_some()) && options.shape != Some(HorizonShape::Map) {
        if let Some(found) = through_normals(file, name, points, &placed, geometry, options)? {
            return Ok(GriddedSheets { notes: notes.into_iter().chain(found.notes).collect(), ..found });
        }
        of_map.push("its normals are not used: it is a map".to_owned());
    }
    let is_any = options.shape == Some(HorizonShape::Any);
    let any_shape = |notes: Vec<String>, note: Option<&str>| {
        let place = |(voxel, p): (&DVec2, &RawPoint)| placement::world_xy(geometry, *voxel).extend(p.z);
        let vertices = placed.voxels.iter().zip(points).map(place).collect();
        let found = GriddedSheets::any_shape(TriangleMesh { vertices, triangles: Vec::new() }, placed.outside, note);
        GriddedSheets { notes: notes.into_iter().chain(found.notes).collect(), ..found }
    };
    if is_any {
        return Ok(any_shape(notes, None));
    }
    let (lattice, gridding) = if let Some((lattice, step)) = lattice::of_survey(&placed.voxels, geometry) {
        (lattice, Gridding::SurveyTraces { step })
    } else {
        let worlds: Vec<DVec2> = placed.voxels.iter().map(|v| placement::world_xy(geometry, *v)).collect();
        let Some(lattice) = lattice::of_points(&worlds, geometry) else {
            if points.len() < 3 {
                notes.push("fewer than three points: nothing lies between them".into());
            }
            let pairs: Vec<_> = placed.voxels.iter().zip(points).map(|(v, p)| (*v, p.z as f32)).collect();
            let told =
                if options.shape.is_none() { surface_kind::of_points(&pairs, geometry) } else { SeenSideways::Map };
            if told == SeenSideways::Overturned {
                let fact = "its points are overturned: several limbs lie over one place on the map";
                let note = Note::unless(fact, Setting::Shape.stated_as("map"));
                return Ok(GriddedSheets { warnings: vec![note], ..any_shape(notes, None) });
            }
            let gridded = scatter::grid(&pairs, geometry, options.gap_m, tolerance).map_err(|_| crowded(file, name))?;
            if gridded.repeated > 0 {
                of_map.push(format!(
                    "{} points share their place with another of the same depth and were averaged with it",
                    gridded.repeated
                ));
            }
            let off_map = gridded.outliers.map(|o| (o.count, Note::from(o.sentence(geometry.vertical.unit))));
            let mut warnings: Vec<Note> = off_map.iter().map(|(_, note)| note.clone()).collect();
            notes.extend(of_map.iter().cloned());
            if told == SeenSideways::Unclear {
                let fact = "its points are taken as a map, but seen from aside some of them seem to lie upside down, as on an \
                            overturned limb";
                of_map.push(fact.to_owned());
                warnings.push(Note::unless(fact, Setting::Shape.stated_as("any")));
            }
            let count = |q| gridded.sheets.iter().flat_map(|s| &s.quality).filter(|k| **k == q).count();
            let (picked, filled) = (count(Quality::Picked), count(Quality::Filled));
            let gridding = Gridding::Interpolated { gap_m: gridded.gap_m, picked, filled };
            return Ok(GriddedSheets {
                multivalued: gridded.multivalued,
                notes,
                warnings,
                surface: any_shape(Vec::new(), None).surface,
                off_map,
                of_map,
                ..GriddedSheets::of(gridded.sheets, gridding, placed.outside)
            });
        };
        let (u, v) = (lattice.grid.u_step, lattice.grid.v_step);
        let gridding = Gridding::InferredLattice {
            count: lattice.grid.count,
            step_m: [u.length(), v.length()],
            rotation_deg: u.to_angle().to_degrees(),
        };
        (lattice, gridding)
    };
    let told = points.iter().filter_map(|p| p.sheet).filter(|sheet| (0.0..1000.0).contains(sheet)).fold(0.0, f64::max);
    let [nu, nv] = lattice.grid.count;
    system::memory::check("its sheets", &[nu, nv, told as usize + 1], BYTES_A_TRACE)
        .map_err(|source| FormatError::Memory { file: file.to_path_buf(), source })?;
    let (sheets, multivalued, twice) = on_lattice(&lattice, points, tolerance).map_err(|_| crowded(file, name))?;
    notes.extend(of_map);
    if twice > 0 {
        notes.push(format!("{twice} points repeat the depth of another at the same node and were averaged with it"));
    }
    Ok(GriddedSheets { multivalued, notes, ..GriddedSheets::of(sheets, gridding, placed.outside) })
}

/// The surface through points and their normals; `None` where it is a map and no other shape is stated.
fn through_normals(
    file: &Path,
    name: &str,
    points: &[RawPoint],
    placed: &PlacedPoints,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
) -> Result<Option<GriddedSheets>, FormatError> {
    let normals: Vec<DVec3> = points.iter().filter_map(|p| p.normal).collect();
    let worlds = placed.voxels.iter().zip(points).map(|(v, p)| placement::world_xy(geometry, *v).extend(p.z));
    let worlds: Vec<DVec3> = worlds.collect();
    let mesh = model::surface_through(name, &worlds, &normals, geometry, &Progress::silent())
        .map_err(|source| FormatError::Normals { file: file.to_path_buf(), why: source.to_string() })?;
    let shape = surface_kind::of_mesh(&mesh);
    if shape.is_none() && options.shape != Some(HorizonShape::Any) {
        return Ok(None);
    }
    let note = match shape {
        Some(MeshKind::Body) => "a closed body through its points and normals",
        _ => "a surface through its points and normals",
    };
    Ok(Some(GriddedSheets::any_shape(mesh, placed.outside, Some(note))))
}

/// Puts points on their nodes; several depths at a node make several sheets. Also counts such nodes, and repeated
/// depths.
fn on_lattice(
    lattice: &FittedLattice,
    points: &[RawPoint],
    tolerance: f32,
) -> Result<(Vec<Sheet>, usize, usize), Crowded> {
    let [nu, nv] = lattice.grid.count;
    let own: Vec<(usize, &RawPoint)> = lattice
        .nodes
        .iter()
        .zip(points)
        .filter(|([u, v], _)| *u >= 0 && *v >= 0 && (*u as usize) < nu && (*v as usize) < nv)
        .map(|([u, v], p)| (*u as usize * nv + *v as usize, p))
        .collect();
    let pairs: Vec<(usize, f32)> = own.iter().map(|(n, p)| (*n, p.z as f32)).collect();
    let (values, element) = NodeValues::group(nu * nv, &pairs, tolerance)?;
    let told = own.iter().all(|(_, p)| p.sheet.is_some_and(|s| (0.0..1000.0).contains(&s)));
    let sheet_of = if told { Vec::new() } else { sheets::split(&values, &sheets::grid_neighbours([nu, nv])) };
    let mut sheets: Vec<Sheet> = Vec::new();
    for ((node, point), &e) in own.iter().zip(&element) {
        let sheet = if told { point.sheet.unwrap_or(0.0) as usize } else { usize::from(sheet_of[e as usize]) };
        while sheets.len() <= sheet {
            sheets.push(Sheet::new(lattice.grid, vec![f32::NAN; nu * nv], Quality::Picked));
        }
        sheets[sheet].depth[*node] = if told { point.z as f32 } else { values.z[e as usize] };
        sheets[sheet].quality[*node] = point.quality.unwrap_or(Quality::Picked);
    }
    let twice = if told { 0 } else { pairs.len() - values.z.len() };
    Ok((sheets, values.multivalued(), twice))
}

fn from_mesh(
    file: &Path,
    name: &str,
    mesh: &TriangleMesh,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
    tolerance: f32,
) -> Result<GriddedSheets, FormatError> {
    let found = if options.shape == Some(HorizonShape::Map) { None } else { surface_kind::of_mesh(mesh) };
    if found.is_some() || options.shape == Some(HorizonShape::Any) {
        let worlds = || mesh.vertices.iter().map(|v| v.truncate());
        let outside = worlds().filter(|w| !is_inside(voxel_xy(geometry, *w), geometry)).count();
        if outside == mesh.vertices.len() {
            return Err(placement::outside_by_world(file, name, worlds(), geometry));
        }
        let note = found.map(|shape| match shape {
            MeshKind::Body => "it is closed: a body",
            MeshKind::Overturned => "it is overturned: a part of it lies above another",
        });
        return Ok(GriddedSheets::any_shape(mesh.clone(), outside, note));
    }
    let grid = NodeGrid::of_survey(geometry);
    let most = (grid.count[0] * grid.count[1]).saturating_mul(MAX_MEAN_DEPTHS).saturating_add(FEW);
    let mut pairs = Vec::new();
    for n in 0..mesh.triangles.len() {
        let corners = mesh.corners(n).map(|p| voxel_xy(geometry, p.truncate()).extend(p.z));
        raster::triangle(corners, grid.count, &mut |u, v, z| pairs.push((u * grid.count[1] + v, z as f32)));
        if pairs.len() > most {
            return Err(crowded(file, name));
        }
    }
    let worlds = || mesh.vertices.iter().map(|v| v.truncate());
    if pairs.is_empty() {
        return Err(placement::outside_by_world(file, name, worlds(), geometry));
    }
    let outside = worlds().filter(|w| !is_inside(voxel_xy(geometry, *w), geometry)).count();
    let (values, _) =
        NodeValues::group(grid.count[0] * grid.count[1], &pairs, tolerance).map_err(|_| crowded(file, name))?;
    let sheet_of = sheets::split(&values, &sheets::grid_neighbours(grid.count));
    let count = sheet_of.iter().max().map_or(1, |&s| usize::from(s) + 1);
    let nodes = grid.count[0] * grid.count[1];
    let mut depths = vec![vec![f32::NAN; nodes]; count];
    let values_of = |node: usize| values.offsets[node] as usize..values.offsets[node + 1] as usize;
    for (node, e) in (0..nodes).flat_map(|node| values_of(node).map(move |e| (node, e))) {
        depths[usize::from(sheet_of[e])][node] = values.z[e];
    }
    let sheets = depths.into_iter().map(|d| Sheet::new(grid, d, Quality::Picked)).collect();
    let gridding = Gridding::Rasterised { triangles: mesh.triangles.len() };
    Ok(GriddedSheets { multivalued: values.multivalued(), ..GriddedSheets::of(sheets, gridding, outside) })
}
