//! The options that cut a block: corners, boxes, fences, shafts, planes.

use super::args::ViewArgs;
use super::request::{Usage, numbers};
use glam::{DVec2, DVec3};
use project::Project;
use project::pictures::load::Wells;
use render::{Corner, CutShape, Scene, Side, VoxelBox};
use survey::block::Leaves;
use survey::{Progress, SurveyGeometry};

/// A box in line numbers and vertical values: two inlines, two crosslines, two values.
pub(super) type LineBox = [f64; 6];

/// A cut-out as it was typed.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cut {
    Corner { corner: Option<Corner>, share: [f64; 2] },
    Box(LineBox),
    Fence { corners: Vec<FenceCorner>, side: Option<Side>, smooth: bool, depth: Option<[f64; 2]> },
    Round { lines: [f64; 2], radius_m: f64, depth: Option<[f64; 2]> },
    Plane { place: [f64; 3], bearing_deg: f64, dip_deg: f64 },
}

/// A corner of a fence.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum FenceCorner {
    /// Inline and crossline.
    Lines([f64; 2]),
    /// The head of a well.
    Well(String),
}

/// Share of the block that a corner cut takes by default.
pub(super) const CUT_SHARE: f64 = 0.45;

/// The cut-outs that were typed.
pub(super) fn typed(typed: &ViewArgs) -> Result<Vec<Cut>, Usage> {
    let mut cuts: Vec<Cut> = typed.cut.iter().map(|text| corner_cut(text)).collect::<Result<_, _>>()?;
    for text in &typed.cut_box {
        cuts.push(Cut::Box(numbers("--cut-box", text, ',')?));
    }
    let depth = typed.cut_depth.as_deref().map(|text| numbers::<2>("--cut-depth", text, ',')).transpose()?;
    if depth.is_some() && typed.cut_fence.is_empty() && typed.cut_round.is_empty() {
        return Err("--cut-depth limits --cut-fence and --cut-round; give one of them".into());
    }
    if !typed.cut_fence.is_empty() {
        let corners = typed.cut_fence.iter().map(|text| fence_corner(text)).collect::<Result<_, _>>()?;
        let side = match typed.cut_side.as_deref() {
            None => None,
            Some("left") => Some(Side::Left),
            Some("right") => Some(Side::Right),
            Some(other) => return Err(format!("--cut-side {other}: expected left or right")),
        };
        cuts.push(Cut::Fence { corners, side, smooth: typed.cut_smooth, depth });
    }
    for text in &typed.cut_round {
        let [inline, crossline, radius_m] = numbers("--cut-round", text, ',')?;
        if radius_m <= 0.0 {
            return Err(format!("--cut-round {text}: the radius must be larger than 0"));
        }
        cuts.push(Cut::Round { lines: [inline, crossline], radius_m, depth });
    }
    for text in &typed.cut_plane {
        let [inline, crossline, z, bearing_deg, dip_deg] = numbers("--cut-plane", text, ',')?;
        if !(0.0..=90.0).contains(&dip_deg) {
            return Err(format!("--cut-plane {text}: a dip lies between 0 and 90 degrees"));
        }
        cuts.push(Cut::Plane { place: [inline, crossline, z], bearing_deg, dip_deg });
    }
    Ok(cuts)
}

fn fence_corner(text: &str) -> Result<FenceCorner, Usage> {
    match text.strip_prefix("well:") {
        Some(name) => Ok(FenceCorner::Well(name.to_owned())),
        None => numbers("--cut-fence", text, ',').map(FenceCorner::Lines),
    }
}

fn corner_cut(text: &str) -> Result<Cut, Usage> {
    let usage = || format!("--cut {text}: expected CORNER or CORNER,SHARE,SHARE with shares between 0 and 1");
    let mut parts = text.splitn(2, ',');
    let corner = match parts.next().unwrap_or_default() {
        "nearest" => None,
        "min-min" => Some(Corner::MinMin),
        "min-max" => Some(Corner::MinMax),
        "max-min" => Some(Corner::MaxMin),
        "max-max" => Some(Corner::MaxMax),
        other => {
            return Err(format!("--cut {other}: expected nearest, min-min, min-max, max-min or max-max"));
        }
    };
    let share = match parts.next() {
        None => [CUT_SHARE; 2],
        Some(shares) => numbers::<2>("--cut", shares, ',').map_err(|_| usage())?,
    };
    if share.iter().all(|share| *share > 0.0 && *share < 1.0) {
        Ok(Cut::Corner { corner, share })
    } else {
        Err(usage())
    }
}

/// Replaces wells at the corners of fences by the line numbers of their heads.
///
/// # Errors
/// The project has no such well, or one cannot be read.
pub(super) fn find_wells(cuts: &mut [Cut], project: &Project) -> anyhow::Result<()> {
    let mut wells = None;
    for cut in cuts {
        let Cut::Fence { corners, .. } = cut else { continue };
        for corner in corners {
            let FenceCorner::Well(name) = corner else { continue };
            let frame = project.document().frame()?;
            if wells.is_none() {
                wells = Some(project.facts().get(&Wells, &Progress::silent())?);
            }
            let well = wells.iter().flat_map(|wells| wells.iter()).find(|well| well.name == *name);
            let Some(head) = well.and_then(|well| well.path.first()) else {
                let known: Vec<&str> = project.document().wells.iter().map(|well| well.name.as_str()).collect();
                anyhow::bail!(
                    "the project has no well `{name}` to lead a fence through; its wells: {}",
                    known.join(", ")
                );
            };
            *corner = FenceCorner::Lines(frame.lines_from_voxel(head.truncate()).to_array());
        }
    }
    Ok(())
}

/// Replaces the cut-outs of a scene, if any were typed.
///
/// # Errors
/// A cut that lies beside the block, or takes all of it.
pub(super) fn change(cuts: &[Cut], scene: &mut Scene, geometry: &SurveyGeometry) -> anyhow::Result<()> {
    if cuts.is_empty() {
        return Ok(());
    }
    let block = scene.box_in(geometry);
    let view = scene.view(geometry);
    let depth = |depth: &Option<[f64; 2]>| {
        depth.map(|[a, b]| {
            let (a, b) = (geometry.vertical.index_of(a), geometry.vertical.index_of(b));
            [a.min(b), a.max(b)]
        })
    };
    (scene.cut_outs, scene.cut_shapes) = (Vec::new(), Vec::new());
    for cut in cuts {
        match cut {
            Cut::Corner { corner, share } => {
                let corner = corner.unwrap_or_else(|| view.nearest_corner(&block));
                scene.cut_outs.push(block.corner_cut(corner, *share));
            }
            Cut::Box(lines) => scene.cut_outs.push(voxel_box(*lines, geometry)),
            Cut::Fence { corners, side, smooth, depth: limits } => {
                let place = |corner: &FenceCorner| match corner {
                    FenceCorner::Lines([inline, crossline]) => Some(geometry.voxel_from_lines(*inline, *crossline)),
                    FenceCorner::Well(_) => None,
                };
                let fence: Vec<[f64; 2]> = corners.iter().filter_map(place).map(DVec2::into).collect();
                let side = side.unwrap_or_else(|| Side::facing(&fence, view.towards_camera(block.centre()).truncate()));
                scene.cut_shapes.push(CutShape::Fence { fence, side, smooth: *smooth, depth: depth(limits) });
            }
            Cut::Round { lines: [inline, crossline], radius_m, depth: limits } => {
                let centre = geometry.voxel_from_lines(*inline, *crossline);
                scene.cut_shapes.push(CutShape::round(centre, *radius_m, depth(limits), geometry));
            }
            Cut::Plane { place: [inline, crossline, z], bearing_deg, dip_deg } => {
                let at = geometry.voxel_from_lines(*inline, *crossline).extend(geometry.vertical.index_of(*z));
                scene.cut_shapes.push(CutShape::dipping(at, *bearing_deg, *dip_deg, geometry));
            }
        }
    }
    // What is wrong with a shape by itself is said when the scene is drawn.
    for shape in scene.cut_shapes.iter().filter(|shape| shape.validate(&block).is_ok()) {
        let what = match shape.leaves(&block) {
            Leaves::Part => continue,
            Leaves::Everything => "lies beside the block, so it would cut nothing",
            Leaves::Nothing => "holds the whole block, so nothing of it would be left",
        };
        let option = match shape {
            CutShape::Plane { .. } => "--cut-plane",
            CutShape::Outline { .. } => "--cut-round",
            CutShape::Fence { .. } => "--cut-fence",
        };
        let [low, high] = [block.low(), block.high()].map(|p| (geometry.lines_from_voxel(p.truncate()), p.z));
        let vertical = [low, high].map(|(_, z)| geometry.vertical.value_at(z));
        anyhow::bail!(
            "what {option} states {what}: the block is inlines {} to {}, crosslines {} to {}, {} to {} {}",
            low.0.x,
            high.0.x,
            low.0.y,
            high.0.y,
            vertical[0],
            vertical[1],
            geometry.vertical.unit.symbol()
        );
    }
    Ok(())
}

/// The voxel box between two inlines, two crosslines and two vertical values, in any order. A coordinate within a
/// millionth of a sample is placed on that sample, since people type rounded decimals.
pub(super) fn voxel_box([il0, il1, xl0, xl1, z0, z1]: LineBox, geometry: &SurveyGeometry) -> VoxelBox {
    let on_sample = |voxel: DVec3| {
        let near = voxel.round();
        DVec3::select((voxel - near).abs().cmplt(DVec3::splat(1e-6)), near, voxel)
    };
    let corner = |il, xl, z| on_sample(geometry.voxel_from_lines(il, xl).extend(geometry.vertical.index_of(z)));
    let (a, b): (DVec3, DVec3) = (corner(il0, xl0, z0), corner(il1, xl1, z1));
    VoxelBox { min: a.min(b).to_array(), max: a.max(b).to_array() }
}
