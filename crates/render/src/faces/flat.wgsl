// Flat coordinates by the exact lookup: the twin of `param::RegionGrid::lookup`.

struct GridInfo {
    // Voxel column of grid column (0, 0).
    origin: vec2<i32>,
    size: vec2<u32>,
    levels: u32,
    // Entry of column (0, 0) in `columns`.
    first_column: u32,
    // Entries in `sheets` at v = 0 and v = 1, NONE for the plane z = 0; both are shifted downwards.
    bottom_sheet: u32,
    top_sheet: u32,
    bottom_shift: f32,
    top_shift: f32,
    // 1: the boundary that is drawn may lie beyond the sheets, and v goes on there.
    is_calm: u32,
    // Where the pool holds i·(Nx − 1) and j·(Ny − 1) if a horizon of the layer is no height field, else NONE. k then
    // follows from the distances from the horizons, or from `thickness_m` where one is missing.
    unfolded_i: u32,
    unfolded_j: u32,
    // Where it holds ln w, by which k differs from the ratio of the distances, else NONE.
    log_weight: u32,
    thickness_m: f32,
}

// Index block · layers + layer.
@group(3) @binding(8) var<storage, read> grids: array<GridInfo>;
// Per column, [x][y]: its first node in `offsets`; in the second word its first level and, in the upper half,
// the number of visible levels.
@group(3) @binding(9) var<storage, read> columns: array<vec2<u32>>;
// Three floats per node: dx, dy (voxels), dk.
@group(3) @binding(10) var<storage, read> offsets: array<f32>;

// Layers thinner than this have no inside, voxels.
const PINCHED: f32 = 1e-3;

// (i, j, k), and the rows of their Jacobian per voxel.
struct FlatSample {
    ijk: vec3<f32>,
    di: vec3<f32>,
    dj: vec3<f32>,
    dk: vec3<f32>,
}

fn shifted_sheet(sheet: u32, shift: f32, at: vec2<f32>) -> vec3<f32> {
    if sheet == NONE {
        return vec3(shift, 0.0, 0.0);
    }
    return sheet_sample(sheets[sheet], at) + vec3(shift, 0.0, 0.0);
}

fn grid_node(start: u32) -> vec3<f32> {
    return vec3(offsets[start], offsets[start + 1u], offsets[start + 2u]);
}

// Value and slope per level of a column's curve.
struct ColumnSample {
    value: vec3<f32>,
    rise: vec3<f32>,
}

// Catmull–Rom interpolation through four levels. Beyond the ends, a level that continues the parabola through
// the last three.
fn grid_column(index: u32, cell: u32, levels: u32, t: f32) -> ColumnSample {
    let entry = columns[index];
    let first = entry.y & 0xffffu;
    let count = entry.y >> 16u;
    var column: ColumnSample;
    if count < 3u {
        return column;
    }
    // Clamped to the uploaded levels; all visible levels are uploaded.
    let at = (entry.x + clamp(cell, first, first + count - 2u) - first) * 3u;
    let b = grid_node(at);
    let c = grid_node(at + 3u);
    var a: vec3<f32>;
    var d: vec3<f32>;
    if cell > 0u {
        a = grid_node(at - 3u);
    } else {
        a = 3.0 * (b - c) + grid_node(at + 6u);
    }
    if cell + 2u < levels {
        d = grid_node(at + 6u);
    } else {
        d = 3.0 * (c - b) + grid_node(at - 3u);
    }
    let linear = c - a;
    let square = 2.0 * a - 5.0 * b + 4.0 * c - d;
    let cube = 3.0 * (b - c) + d - a;
    column.value = b + 0.5 * t * (linear + t * (square + t * cube));
    column.rise = 0.5 * (linear + t * (2.0 * square + 3.0 * t * cube));
    return column;
}

// Distance in m below a horizon (w) and its derivatives per voxel (xyz).
fn distance_below(info: SheetInfo, p: vec3<f32>) -> vec4<f32> {
    if info.level != NONE {
        // Regions are told by the trilinear field, whose slopes jump from cell to cell.
        return (level_cubic(info.level, p) - vec4(0.0, 0.0, 0.0, info.at)) * info.scale_m;
    }
    let sheet = sheet_sample(info, p.xy);
    return vec4(-sheet.yz, 1.0, p.z - sheet.x) * params.voxel_m.z;
}

// k between surfaces of any shape (w), and its derivatives per voxel (xyz): the twin of `RegionGrid::level_k`.
fn level_k(grid: GridInfo, p: vec3<f32>) -> vec4<f32> {
    if grid.bottom_sheet == NONE && grid.top_sheet == NONE {
        return vec4(0.0, 0.0, 0.0, 0.5);
    }
    if grid.top_sheet == NONE {
        return -distance_below(sheets[grid.bottom_sheet], p) / grid.thickness_m;
    }
    let top = distance_below(sheets[grid.top_sheet], p);
    if grid.bottom_sheet == NONE {
        return vec4(0.0, 0.0, 0.0, 1.0) - top / grid.thickness_m;
    }
    let bottom = distance_below(sheets[grid.bottom_sheet], p);
    let sum = top.w - bottom.w;
    if abs(sum) < PINCHED {
        return vec4(0.0, 0.0, 0.0, 0.5);
    }
    let slope = (top.xyz * bottom.w - bottom.xyz * top.w) / (sum * sum);
    let ratio = clamp(-bottom.w / sum, 0.0, 1.0);
    if grid.log_weight == NONE {
        return vec4(slope, ratio);
    }
    // The twin of `weight::weighed`.
    let log_weight = level_cubic(grid.log_weight, p);
    let weight = exp(log_weight.w);
    let weighed = ratio * weight + 1.0 - ratio;
    let to_k = (slope + log_weight.xyz * (ratio * (1.0 - ratio))) * (weight / (weighed * weighed));
    return vec4(to_k, ratio * weight / weighed);
}

// The twin of `RegionGrid::lookup_unfolded`.
fn flat_unfolded(grid: GridInfo, p: vec3<f32>) -> FlatSample {
    let unit = model.unit_from_voxel;
    let i = level_cubic(grid.unfolded_i, p) * unit.x;
    let j = level_cubic(grid.unfolded_j, p) * unit.y;
    let k = level_k(grid, p);
    return FlatSample(vec3(i.w, j.w, k.w), i.xyz, j.xyz, k.xyz);
}

fn flat_exact(p: vec3<f32>, layer: u32, block: u32) -> FlatSample {
    let grid = grids[block * model.layers + layer];
    if has_levels == 1u && grid.unfolded_i != NONE {
        return flat_unfolded(grid, p);
    }
    let bottom = shifted_sheet(grid.bottom_sheet, grid.bottom_shift, p.xy);
    let top = shifted_sheet(grid.top_sheet, grid.top_shift, p.xy);
    let thickness = bottom.x - top.x;
    var v = 0.5;
    var v_slope = vec3(0.0);
    if thickness >= PINCHED {
        let inverse = 1.0 / thickness;
        v = (bottom.x - p.z) * inverse;
        v_slope = vec3((bottom.yz * (1.0 - v) + top.yz * v) * inverse, -inverse);
        if grid.is_calm == 0u {
            v = clamp(v, 0.0, 1.0);
        }
    }
    var value = vec3(0.0);
    var along_x = vec3(0.0);
    var along_y = vec3(0.0);
    var along_v = vec3(0.0);
    if grid.size.x > 0u {
        let scale = f32(grid.levels - 1u);
        let last = vec3<f32>(vec3(grid.size, grid.levels) - 1u);
        let at = clamp(vec3(p.xy - vec2<f32>(grid.origin), v * scale), vec3(0.0), last);
        let cell = min(vec3<u32>(at), vec3(grid.size, grid.levels) - 2u);
        let f = at - vec3<f32>(cell);
        let index = grid.first_column + cell.x * grid.size.y + cell.y;
        let c00 = grid_column(index, cell.z, grid.levels, f.z);
        let c01 = grid_column(index + 1u, cell.z, grid.levels, f.z);
        let c10 = grid_column(index + grid.size.y, cell.z, grid.levels, f.z);
        let c11 = grid_column(index + grid.size.y + 1u, cell.z, grid.levels, f.z);
        let low = c00.value + (c01.value - c00.value) * f.y;
        let high = c10.value + (c11.value - c10.value) * f.y;
        value = low + (high - low) * f.x;
        along_x = high - low;
        let step_0 = c01.value - c00.value;
        let step_1 = c11.value - c10.value;
        along_y = step_0 + (step_1 - step_0) * f.x;
        let rise_0 = c00.rise + (c01.rise - c00.rise) * f.y;
        let rise_1 = c10.rise + (c11.rise - c10.rise) * f.y;
        if v >= 0.0 && v <= 1.0 {
            along_v = (rise_0 + (rise_1 - rise_0) * f.x) * scale;
        }
    }
    let unit = model.unit_from_voxel;
    var flat: FlatSample;
    flat.ijk = vec3((p.xy + value.xy) * unit, v + value.z);
    flat.di = (vec3(1.0 + along_x.x, along_y.x, 0.0) + v_slope * along_v.x) * unit.x;
    flat.dj = (vec3(along_x.y, 1.0 + along_y.y, 0.0) + v_slope * along_v.y) * unit.y;
    flat.dk = vec3(along_x.z, along_y.z, 0.0) + v_slope * (1.0 + along_v.z);
    return flat;
}
