// Colours of leaves, and horizon candidates on faces: the twin of `leaves`.

// What faces show: 0 rock, 1 leaves, 2 distances.
override face_data: u32 = 0u;
const FACES_LEAVES: u32 = 1u;
const FACES_DISTANCE: u32 = 2u;

const HALF_WIDTH: f32 = 0.8;
const FADE: f32 = 0.5;
const BLACK_AT: f32 = 10.0;
const BORDER: f32 = 0.75;
const BORDER_REACH: f32 = 0.75;
const BORDER_STEP: u32 = 1u;
const BORDER_TONE: f32 = 0.35;

fn leaf_colour(id: u32) -> vec3<f32> {
    let hash = id * 0x9e3779b9u;
    let hue = f32(hash >> 8u) / 16777216.0 * 6.0;
    let saturation = 0.5 + 0.15 * f32(hash % 3u);
    let value = 0.98 - 0.12 * f32(hash / 3u % 3u);
    let k = (vec3(5.0, 3.0, 1.0) + hue) % 6.0;
    return value - value * saturation * clamp(min(k, 4.0 - k), vec3(0.0), vec3(1.0));
}

// The group of a leaf; 0 if it is not shown.
fn leaf_group(leaf: u32) -> u32 {
    if media.leaves.w == NONE {
        return leaf;
    }
    if leaf >= media.groups {
        return 0u;
    }
    return relief_map[media.leaves.w + leaf];
}

const NO_GROUP: vec2<u32> = vec2(NONE, 0u);

fn sample_at(p: vec3<f32>) -> vec3<u32> {
    return min(vec3<u32>(max(p + 0.5, vec3(0.0))), media.candidates.xyz - 1u);
}

// The sample of a trace that is nearest to its surface, and the group of that surface; NO_GROUP if all
// samples are too far from their surfaces. Considers samples at most `reach` above and below z, and one group
// unless `only` is NONE.
fn surface_sample(place: vec3<u32>, reach: u32, only: u32) -> vec2<u32> {
    var nearest = BORDER_REACH;
    var found = NO_GROUP;
    let last = min(place.z + reach, media.candidates.z - 1u);
    for (var z = place.z - min(place.z, reach); z <= last; z++) {
        let at = vec3(z, place.y, place.x);
        let distance = textureLoad(distances, at, 0).r * 255.0 * media.scales.w;
        let group = leaf_group(textureLoad(leaf_ids, at, 0).r);
        if distance < nearest && (only == NONE || only == group) {
            nearest = distance;
            found = vec2(z, group);
        }
    }
    return found;
}

// The group as which a surface continues on a neighbouring trace: its own if possible, else another.
fn group_aside(p: vec3<f32>, z: u32, own: u32) -> u32 {
    let place = vec3(sample_at(p).xy, z);
    let goes_on = surface_sample(place, 2u * BORDER_STEP, own);
    if goes_on.x != NONE {
        return goes_on.y;
    }
    return surface_sample(place, BORDER_STEP, NONE).y;
}

fn differ(a: u32, b: u32) -> bool {
    return a != b && a != 0u && b != 0u;
}

fn is_border(p: vec3<f32>) -> bool {
    let place = sample_at(p);
    let own = leaf_group(textureLoad(leaf_ids, place.zyx, 0).r);
    let sample = surface_sample(place, u32(1.5 * distance_at(p)) + 1u, own);
    let z = select(sample.x, place.z, sample.x == NONE);
    let x = vec3(BORDER, 0.0, 0.0);
    let y = vec3(0.0, BORDER, 0.0);
    return differ(group_aside(p + x, z, own), group_aside(p - x, z, own))
        || differ(group_aside(p + y, z, own), group_aside(p - y, z, own));
}

// The colour of a face, with horizon candidates if the scene shows them.
fn with_candidates(p: vec3<f32>, rock: vec3<f32>) -> vec3<f32> {
    if face_data == FACES_DISTANCE {
        return vec3(clamp(1.0 - distance_at(p) / BLACK_AT, 0.0, 1.0));
    }
    if face_data == FACES_LEAVES {
        let group = leaf_group(leaf_at(p));
        if group != 0u {
            return mix(rock, leaf_colour(group), clamp((HALF_WIDTH - distance_at(p)) / FADE + 0.5, 0.0, 1.0));
        }
    }
    return rock;
}
