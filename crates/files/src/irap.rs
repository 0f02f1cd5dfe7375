//! Irap classic ASCII: a rotated regular grid.
//!
//! Header of 19 tokens: `-996 NROW XINC YINC / XMIN XMAX YMIN YMAX / NCOL ROTATION X0 Y0 / 0 0 0 0 0 0 0`, then
//! NCOL·NROW values, i (along XINC) fastest. Node (i, j) lies at (X0, Y0) + i·XINC·(cos, sin) + j·YINC·(−sin, cos) of
//! the rotation in degrees anticlockwise; a negative YINC mirrors. XMAX and YMAX are those of the unrotated grid and
//! not used. Values from 9999900 on are undefined. The format states neither unit nor sign.

use super::grid::{self, GridHeader, NodeOrder};
use super::raw::{RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::write::WriteFailure;
use super::{Codec, Format, FormatError, HorizonWriter};
use crate::number;
use glam::DVec2;
use std::borrow::Cow;
use std::io::Write;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, NodeGrid, Sheet};

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    write_horizon: Some(HorizonWriter::of(write_horizon)),
    ..Codec::of(Format::Irap, "irap", "irap", detect)
};

/// Values from here on are undefined.
const UNDEFINED: f64 = 9_999_900.0;

fn detect(source: &SourceFile) -> Option<String> {
    let start = &source.bytes[..source.bytes.len().min(200)];
    let text = String::from_utf8_lossy(start);
    (text.split_whitespace().next()? == "-996").then(|| "it begins with -996".to_string())
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut tokens =
        text::lines(&text).flat_map(|line| line.text.split_whitespace().map(move |token| (line.number, token)));
    let mut header = [0.0; 19];
    for (n, slot) in header.iter_mut().enumerate() {
        let (line, token) = tokens.next().ok_or_else(|| source.length("header numbers", 19, n))?;
        *slot = number::plain(token).ok_or_else(|| source.syntax(line, "a header number", token))?;
    }
    if header[0] != -996.0 {
        return Err(source.syntax(1, "-996, the mark of an Irap grid", &header[0].to_string()));
    }
    let header = GridHeader {
        count: [header[8], header[1]],
        step: [header[2], header[3]],
        rotation_deg: header[9],
        origin: DVec2::new(header[10], header[11]),
    };
    let grid = header.grid(source)?;
    let mut values = Vec::new();
    for (line, token) in tokens {
        values.push(source.grid_value(line, token)?);
    }
    Ok(vec![grid::surface(source, None, grid, (values, NodeOrder::Rows), |v| v.abs() >= UNDEFINED)?])
}

/// All sheets as one, which is possible if they lie on one grid and no node has two depths.
pub(super) fn one_sheet(horizon: &Horizon) -> Result<Cow<'_, Sheet>, WriteFailure> {
    let several = |why: String| {
        WriteFailure::NotRepresentable(
            format!("it has {} sheets, {why}, and the format holds one depth a node", horizon.sheets.len()),
            "write csv, opendtect or tsurf, which hold several",
        )
    };
    let Some((first, others)) = horizon.sheets.split_first() else { return Err(several("so no depth at all".into())) };
    let mut merged = Cow::Borrowed(first);
    for sheet in others {
        if sheet.grid != first.grid {
            return Err(several("on different grids".into()));
        }
        let target = merged.to_mut();
        for (n, z) in sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            if target.depth[n].is_finite() {
                return Err(several("two of them over one node".into()));
            }
            target.depth[n] = *z;
            target.quality[n] = sheet.quality[n];
        }
    }
    Ok(merged)
}

/// The single sheet a one-depth grid format can hold, on an orthogonal grid.
pub(super) fn only_sheet(horizon: &Horizon) -> Result<Cow<'_, Sheet>, WriteFailure> {
    let sheet = one_sheet(horizon)?;
    let (u, v) = (sheet.grid.u_step, sheet.grid.v_step);
    if u.dot(v).abs() > 1e-4 * u.length() * v.length() {
        return Err(WriteFailure::NotRepresentable(
            "its grid is not orthogonal".into(),
            "write csv, opendtect or tsurf, which hold any grid",
        ));
    }
    Ok(sheet)
}

fn write_horizon(out: &mut dyn Write, horizon: &Horizon, _: &SurveyGeometry) -> Result<(), WriteFailure> {
    let sheet = only_sheet(horizon)?;
    let NodeGrid { origin, u_step, v_step, count: [nu, nv] } = sheet.grid;
    let (xinc, mirrored) = (u_step.length(), u_step.perp_dot(v_step) < 0.0);
    let yinc = if mirrored { -v_step.length() } else { v_step.length() };
    let rotation = u_step.to_angle().to_degrees().rem_euclid(360.0);
    let (xmax, ymax) = (origin.x + xinc * (nu as f64 - 1.0), origin.y + yinc * (nv as f64 - 1.0));
    writeln!(out, "-996 {nv} {xinc:.8} {yinc:.8}")?;
    writeln!(out, "{:.6} {xmax:.6} {:.6} {ymax:.6}", origin.x, origin.y)?;
    writeln!(out, "{nu} {rotation:.10} {:.6} {:.6}", origin.x, origin.y)?;
    writeln!(out, "0 0 0 0 0 0 0")?;
    for v in 0..nv {
        for u in 0..nu {
            let z = sheet.depth[u * nv + v];
            let end = if (u + 1) % 6 == 0 || u + 1 == nu { '\n' } else { ' ' };
            if z.is_finite() { write!(out, "{z}{end}")? } else { write!(out, "9999900.000000{end}")? }
        }
    }
    Ok(())
}
