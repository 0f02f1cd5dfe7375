//! What volumes hold along a horizon, as a table.

use interp::reassembly::from_horizon;
use survey::{Horizon, SurveyGeometry, Volume};

/// Writes a horizon's nodes and the values of volumes at them as CSV: inline, crossline, x, y, the vertical value, and a
/// column for each volume; where `window` is more than 0, the mean, the root mean square and the greatest magnitude over so
/// many samples to both sides follow.
///
/// Values between samples are interpolated; outside a volume, and where it has no value, a field is empty.
pub(crate) fn table(
    horizon: &Horizon,
    geometry: &SurveyGeometry,
    volumes: &[(String, Volume<f32>)],
    window: usize,
) -> String {
    use std::fmt::Write;
    let mut text = format!("inline,crossline,x,y,z_{}", geometry.vertical.unit.symbol());
    for (name, _) in volumes {
        let name = name.replace(',', " ");
        let _ = write!(text, ",{name}");
        if window > 0 {
            let _ = write!(text, ",{name} mean,{name} rms,{name} greatest");
        }
    }
    text.push('\n');
    let [_, ny, nz] = geometry.size();
    for sheet in from_horizon(horizon, geometry, &model::FaultNetwork::none()) {
        for (trace, z) in sheet.z.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let voxel = glam::DVec3::new((trace / ny) as f64, (trace % ny) as f64, f64::from(*z));
            let (lines, world) = (geometry.lines_from_voxel(voxel.truncate()), geometry.world_from_voxel(voxel));
            let _ = write!(text, "{},{},{:.2},{:.2},{:.3}", lines.x, lines.y, world.x, world.y, world.z);
            for (_, volume) in volumes {
                let own = volume.trace(trace / ny, trace % ny);
                let inside = *z >= 0.0 && *z <= (nz - 1) as f32;
                let low = (z.max(0.0) as usize).min(nz - 1);
                let share = z - low as f32;
                // What follows a sample does not matter at the sample itself, where it may be unknown.
                let value = match share {
                    _ if !inside => f32::NAN,
                    0.0 => own[low],
                    _ => own[low] + share * (own[(low + 1).min(nz - 1)] - own[low]),
                };
                let field = |value: f32| if value.is_finite() { value.to_string() } else { String::new() };
                let _ = write!(text, ",{}", field(value));
                if window > 0 {
                    let middle = z.round().clamp(0.0, (nz - 1) as f32) as usize;
                    let around = &own[middle.saturating_sub(window)..(middle + window + 1).min(nz)];
                    let known: Vec<f32> = around.iter().copied().filter(|value| value.is_finite() && inside).collect();
                    let count = known.len() as f32;
                    let mean = known.iter().sum::<f32>() / count;
                    let rms = (known.iter().map(|value| value * value).sum::<f32>() / count).sqrt();
                    let greatest = known.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
                    let _ =
                        write!(text, ",{},{},{}", field(mean), field(rms), greatest.map_or_else(String::new, field));
                }
            }
            text.push('\n');
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use interp::reassembly::{VoxelSheet, to_horizon};
    use survey::{Quality, VerticalUnit};

    #[test]
    fn values_along_a_horizon_are_interpolated_and_those_around_it_summed_up() {
        let geometry = SurveyGeometry::regular([2, 1, 6], 25.0, 4.0, VerticalUnit::Milliseconds);
        let samples = vec![0.0, 1.0, 2.0, 3.0, 4.0, f32::NAN, 0.0, -2.0, -4.0, -6.0, -8.0, -10.0];
        let volume = Volume::from_samples([2, 1, 6], samples).unwrap();
        let sheet = VoxelSheet { block: 0, z: vec![4.0, 2.5], quality: vec![Quality::Picked; 2] };
        let horizon = to_horizon("H", &[sheet], &geometry);
        let text = table(&horizon, &geometry, &[("a".to_owned(), volume)], 1);
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(rows[0][4..], ["z_ms", "a", "a mean", "a rms", "a greatest"]);
        assert_eq!(rows[1][4..7], ["16.000", "4", "3.5"]);
        assert_eq!((rows[1][8], rows[2][4], rows[2][5], rows[2][8]), ("4", "10.000", "-5", "-8"));
    }
}
