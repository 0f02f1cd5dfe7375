//! Writes the measured model as NumPy files, so that other programs can be timed on it.
//!
//! `region.npy` uint16 `[inline][crossline][sample]`: layer + layers · block. `sheets.npy` float32
//! `[horizon][block][x][y]`: voxel z of the extended sheets. `meta.json`: `size`, `margin` (nodes around the survey),
//! `metric_m` (metres per voxel along x, y, z), `layers`, `blocks`.

use glam::Vec3;
use model::StructuralModel;
use project::error::ProjectError;
use rayon::prelude::*;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use survey::Progress;
use system::file::FileAction;

/// Writes the three files.
///
/// # Errors
/// The files could not be written, or the user cancelled.
pub(super) fn write(folder: &Path, model: &StructuralModel, progress: &Progress) -> Result<(), ProjectError> {
    let fail = |source| ProjectError::io(FileAction::Written, folder, source);
    fs::create_dir_all(folder).map_err(fail)?;
    let [nx, ny, nz] = model.size();
    let layers = model.layer_count();
    progress.begin("dumping regions", nx as u64);
    let slabs: Vec<Vec<u16>> = (0..nx)
        .into_par_iter()
        .map(|x| {
            let region = |y: usize, z: usize| {
                let region = model.region_at(Vec3::new(x as f32, y as f32, z as f32));
                region.layer + layers as u16 * region.block
            };
            progress.step(1)?;
            Ok((0..ny).flat_map(|y| (0..nz).map(move |z| region(y, z))).collect())
        })
        .collect::<Result<_, ProjectError>>()?;
    write_npy(&folder.join("region.npy"), "<u2", &[nx, ny, nz], slabs.iter().map(|slab| bytemuck::cast_slice(slab)))
        .map_err(fail)?;
    let (horizons, blocks) = (layers - 1, model.block_count());
    let sheets = (0..horizons).flat_map(|h| (0..blocks).map(move |b| model.sheet(h, b as u16)));
    let [width, height] = model.sheet(0, 0).size;
    let margin = -model.sheet(0, 0).origin[0];
    write_npy(
        &folder.join("sheets.npy"),
        "<f4",
        &[horizons, blocks, width, height],
        sheets.map(|sheet| bytemuck::cast_slice(&sheet.z)),
    )
    .map_err(fail)?;
    let metric = model.metric();
    let meta = serde_json::json!({
        "size": [nx, ny, nz],
        "margin": margin,
        "metric_m": [metric.x_axis.length(), metric.y_axis.length(), metric.z_axis.length()],
        "layers": layers,
        "blocks": blocks,
    });
    fs::write(folder.join("meta.json"), meta.to_string()).map_err(fail)
}

/// Writes version 1.0 of the NumPy format: magic, length of the header, a Python literal padded to 64 bytes, the values
/// in C order.
pub(super) fn write_npy<'a>(
    path: &Path,
    kind: &str,
    shape: &[usize],
    parts: impl Iterator<Item = &'a [u8]>,
) -> io::Result<()> {
    let shape: String = shape.iter().map(|count| format!("{count}, ")).collect();
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({shape}), }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut out = BufWriter::new(File::create(path)?);
    out.write_all(b"\x93NUMPY\x01\x00")?;
    out.write_all(&(header.len() as u16).to_le_bytes())?;
    out.write_all(header.as_bytes())?;
    for part in parts {
        out.write_all(part)?;
    }
    out.flush()
}
