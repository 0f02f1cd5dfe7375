//! A glTF 2.0 file in one piece: a header, JSON, and the bytes that the JSON refers to
//! (Khronos Group, glTF 2.0 specification, section 4).

use glam::{DVec3, Vec3};
use serde_json::{Value, json};

/// Parts of a file under construction.
#[derive(Default)]
pub(super) struct GlbFile {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    textures: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

/// Numbers of glTF.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Triangles with what they are covered by.
pub(super) struct Covered<'a> {
    pub points: &'a [DVec3],
    pub triangles: &'a [[u32; 3]],
    /// Places in the picture, from its upper left corner; empty without one.
    pub uv: Vec<[f32; 2]>,
    pub material: usize,
    /// The material of the variant of raw data.
    pub raw: Option<usize>,
}

impl GlbFile {
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, values: &Accessor) -> usize {
        let view = self.view(&values.bytes, Some(values.target));
        let mut accessor = json!({
            "bufferView": view, "componentType": values.component, "count": values.count, "type": values.kind,
        });
        if let Some([low, high]) = values.range {
            accessor["min"] = json!(low.to_array());
            accessor["max"] = json!(high.to_array());
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds a picture in a file of its own kind and gives the index of its texture.
    pub(super) fn picture(&mut self, name: &str, mime: &str, bytes: &[u8]) -> usize {
        let view = self.view(bytes, None);
        self.images.push(json!({ "name": name, "mimeType": mime, "bufferView": view }));
        self.textures.push(json!({ "source": self.images.len() - 1, "sampler": 0 }));
        self.textures.len() - 1
    }

    /// Adds a material of a colour, or of a texture where there is one. Covered faces are drawn as they are, without light.
    pub(super) fn material(&mut self, name: &str, colour: [f32; 4], texture: Option<usize>) -> usize {
        let mut surface = json!({ "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 1.0 });
        if let Some(texture) = texture {
            surface["baseColorTexture"] = json!({ "index": texture });
        }
        let mut material = json!({ "name": name, "doubleSided": true, "pbrMetallicRoughness": surface });
        if texture.is_some() {
            material["extensions"] = json!({ "KHR_materials_unlit": {} });
        }
        if colour[3] < 1.0 {
            material["alphaMode"] = "BLEND".into();
        }
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a mesh under a node of its own and gives the node's index; `None` of no triangles.
    pub(super) fn mesh(&mut self, name: &str, covered: &Covered, extras: &Value) -> Option<usize> {
        if covered.triangles.is_empty() {
            return None;
        }
        let points: Vec<Vec3> = covered.points.iter().map(|p| p.as_vec3()).collect();
        let low = points.iter().copied().fold(Vec3::MAX, Vec3::min);
        let high = points.iter().copied().fold(Vec3::MIN, Vec3::max);
        let normals = normals(&points, covered.triangles);
        let mut attributes = json!({
            "POSITION": self.accessor(&Accessor { range: Some([low, high]), ..Accessor::vectors(&points) }),
            "NORMAL": self.accessor(&Accessor::vectors(&normals)),
        });
        if !covered.uv.is_empty() {
            let bytes = covered.uv.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
            let values = Accessor {
                kind: "VEC2",
                component: FLOAT,
                count: covered.uv.len(),
                target: ARRAY_BUFFER,
                range: None,
                bytes,
            };
            attributes["TEXCOORD_0"] = self.accessor(&values).into();
        }
        let bytes = covered.triangles.iter().flatten().flat_map(|n| n.to_le_bytes()).collect();
        let count = covered.triangles.len() * 3;
        let indices = Accessor {
            kind: "SCALAR",
            component: UNSIGNED_INT,
            count,
            target: ELEMENT_ARRAY_BUFFER,
            range: None,
            bytes,
        };
        let mut primitive = json!({
            "attributes": attributes, "indices": self.accessor(&indices), "material": covered.material, "mode": 4,
        });
        if let Some(raw) = covered.raw {
            primitive["extensions"] = json!({ "KHR_materials_variants": { "mappings": [
                { "material": covered.material, "variants": [0] }, { "material": raw, "variants": [1] },
            ] } });
        }
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
        let mut node = json!({ "name": name, "mesh": self.meshes.len() - 1 });
        if !extras.is_null() {
            node["extras"] = extras.clone();
        }
        self.nodes.push(node);
        Some(self.nodes.len() - 1)
    }

    /// Adds a node over others and gives its index; `None` over none.
    pub(super) fn group(&mut self, name: &str, children: &[usize]) -> Option<usize> {
        if children.is_empty() {
            return None;
        }
        self.nodes.push(json!({ "name": name, "children": children }));
        Some(self.nodes.len() - 1)
    }

    /// Nodes so far.
    pub(super) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The whole file. The root is scaled along Y.
    pub(super) fn finish(
        mut self,
        root: &str,
        children: &[usize],
        exaggeration: f64,
        extras: &Value,
        has_raw: bool,
    ) -> Vec<u8> {
        self.nodes
            .push(json!({ "name": root, "children": children, "scale": [1.0, exaggeration, 1.0], "extras": extras }));
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        let mut document = json!({
            "asset": { "version": "2.0", "generator": format!("Petroglyph {}", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": root, "nodes": [self.nodes.len() - 1] }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.bytes.len() }],
        });
        let mut used = Vec::new();
        if !self.textures.is_empty() {
            document["images"] = self.images.into();
            document["textures"] = self.textures.into();
            // Linear with mipmaps; clamped to the edge.
            document["samplers"] = json!([{ "magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071 }]);
            used.push("KHR_materials_unlit");
        }
        if has_raw {
            used.push("KHR_materials_variants");
            let variants = json!([{ "name": "illustrated" }, { "name": "raw" }]);
            document["extensions"] = json!({ "KHR_materials_variants": { "variants": variants } });
        }
        if !used.is_empty() {
            document["extensionsUsed"] = json!(used);
        }
        let mut text = document.to_string().into_bytes();
        while !text.len().is_multiple_of(4) {
            text.push(b' ');
        }
        let total = 12 + 8 + text.len() + 8 + self.bytes.len();
        let mut file = Vec::with_capacity(total);
        file.extend_from_slice(b"glTF");
        file.extend_from_slice(&2u32.to_le_bytes());
        file.extend_from_slice(&(total as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &self.bytes)] {
            file.extend_from_slice(&(chunk.len() as u32).to_le_bytes());
            file.extend_from_slice(kind);
            file.extend_from_slice(chunk);
        }
        file
    }
}

/// Values of one kind, as bytes.
struct Accessor {
    kind: &'static str,
    component: u32,
    count: usize,
    target: u32,
    range: Option<[Vec3; 2]>,
    bytes: Vec<u8>,
}

impl Accessor {
    fn vectors(values: &[Vec3]) -> Self {
        let bytes = values.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes).collect();
        Self { kind: "VEC3", component: FLOAT, count: values.len(), target: ARRAY_BUFFER, range: None, bytes }
    }
}

/// Unit normals of corners: of the triangles around each, by their areas.
fn normals(points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; points.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|n| points[n as usize]);
        let turn = (b - a).cross(c - a);
        triangle.iter().for_each(|n| normals[*n as usize] += turn);
    }
    normals.into_iter().map(|normal| normal.normalize_or(Vec3::Y)).collect()
}
