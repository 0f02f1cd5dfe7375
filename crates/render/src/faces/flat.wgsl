// Flat coordinates by the exact path: the twin of `param::RegionGrid::lookup`.

struct GridInfo {
    // Voxel column of grid column (0, 0).
    origin: vec2<i32>,
    size: vec2<u32>,
    levels: u32,
    // First float of the first node in the pool; a node is (dx, dy, dk).
    offset: u32,
    // Horizons at v = 0 and v = 1, NONE for the plane z = 0; both shifted downwards.
    bottom_horizon: u32,
    top_horizon: u32,
    bottom_shift: f32,
    top_shift: f32,
    padding_0: u32,
    padding_1: u32,
}

// Index block · layers + layer.
@group(3) @binding(4) var<storage, read> grids: array<GridInfo>;

// Layers thinner than this have no inside, voxels.
const PINCHED: f32 = 1e-3;

// (i, j, k), and the rows of their Jacobian per voxel.
struct FlatSample {
    ijk: vec3<f32>,
    di: vec3<f32>,
    dj: vec3<f32>,
    dk: vec3<f32>,
}

fn shifted_sheet(horizon: u32, shift: f32, block: u32, at: vec2<f32>) -> vec3<f32> {
    if horizon == NONE {
        return vec3(shift, 0.0, 0.0);
    }
    return sheet_sample(sheets[horizon * model.blocks + block], at) + vec3(shift, 0.0, 0.0);
}

fn grid_node(start: u32) -> vec3<f32> {
    return vec3(pool(start), pool(start + 1u), pool(start + 2u));
}

fn flat_exact(p: vec3<f32>, layer: u32, block: u32) -> FlatSample {
    let grid = grids[block * model.layers + layer];
    let bottom = shifted_sheet(grid.bottom_horizon, grid.bottom_shift, block, p.xy);
    let top = shifted_sheet(grid.top_horizon, grid.top_shift, block, p.xy);
    let thickness = bottom.x - top.x;
    var v = 0.5;
    var v_slope = vec3(0.0);
    if thickness >= PINCHED {
        let inverse = 1.0 / thickness;
        v = (bottom.x - p.z) * inverse;
        v_slope = vec3((bottom.yz * (1.0 - v) + top.yz * v) * inverse, -inverse);
        v = clamp(v, 0.0, 1.0);
    }
    var value = vec3(0.0);
    var along_x = vec3(0.0);
    var along_y = vec3(0.0);
    var along_v = vec3(0.0);
    if grid.size.x > 0u {
        let count = vec3(grid.size, grid.levels);
        let last = vec3<f32>(count - 1u);
        let scale = last.z;
        let at = clamp(vec3(p.xy - vec2<f32>(grid.origin), v * scale), vec3(0.0), last);
        let cell = min(vec3<u32>(at), max(count, vec3(2u)) - 2u);
        let f = at - vec3<f32>(cell);
        let next = min(cell + 1u, count - 1u) - cell;
        let stride_y = grid.levels * 3u;
        let stride_x = grid.size.y * stride_y;
        let start = grid.offset + cell.x * stride_x + cell.y * stride_y + cell.z * 3u;
        let dx = next.x * stride_x;
        let dy = next.y * stride_y;
        let dl = next.z * 3u;
        let c000 = grid_node(start);
        let c001 = grid_node(start + dl);
        let c010 = grid_node(start + dy);
        let c011 = grid_node(start + dy + dl);
        let c100 = grid_node(start + dx);
        let c101 = grid_node(start + dx + dl);
        let c110 = grid_node(start + dx + dy);
        let c111 = grid_node(start + dx + dy + dl);
        let e00 = c000 + (c001 - c000) * f.z;
        let e01 = c010 + (c011 - c010) * f.z;
        let e10 = c100 + (c101 - c100) * f.z;
        let e11 = c110 + (c111 - c110) * f.z;
        let low = e00 + (e01 - e00) * f.y;
        let high = e10 + (e11 - e10) * f.y;
        value = low + (high - low) * f.x;
        along_x = high - low;
        along_y = (e01 - e00) + ((e11 - e10) - (e01 - e00)) * f.x;
        let r0 = (c001 - c000) + ((c011 - c010) - (c001 - c000)) * f.y;
        let r1 = (c101 - c100) + ((c111 - c110) - (c101 - c100)) * f.y;
        along_v = (r0 + (r1 - r0) * f.x) * scale;
    }
    let unit = model.unit_from_voxel;
    var flat: FlatSample;
    flat.ijk = vec3((p.xy + value.xy) * unit, v + value.z);
    flat.di = (vec3(1.0 + along_x.x, along_y.x, 0.0) + v_slope * along_v.x) * unit.x;
    flat.dj = (vec3(along_x.y, 1.0 + along_y.y, 0.0) + v_slope * along_v.y) * unit.y;
    flat.dk = vec3(along_x.z, along_y.z, 0.0) + v_slope * (1.0 + along_v.z);
    return flat;
}
