//! What is found of faults that were drawn by hand.

use faults::FaultSurface;
use survey::SurveyGeometry;

/// Prints which share of each fault that was drawn by hand lies within two traces of a found surface. Rows are fault,
/// stick, inline, crossline, sample.
pub(crate) fn measure(text: &str, geometry: &SurveyGeometry, found: &[FaultSurface]) {
    let rows: Vec<Vec<&str>> =
        text.lines().filter(|line| !line.starts_with('#')).skip(1).map(|line| line.split(',').collect()).collect();
    let voxel = |row: &[&str]| {
        let [inline, crossline, sample] = [2, 3, 4].map(|n| row[n].parse::<f64>().unwrap());
        let at = geometry.voxel_from_lines(inline, crossline);
        glam::DVec3::new(at.x, at.y, sample)
    };
    // Fault, places, how many of them lie on what is proposed, and on that or what may be a fault.
    let mut faults: Vec<(&str, usize, [usize; 2])> = Vec::new();
    for (n, row) in rows.iter().enumerate() {
        let next = rows.get(n + 1).filter(|next| next[..2] == row[..2]);
        let is_alone = next.is_none() && (n == 0 || rows[n - 1][..2] != row[..2]);
        let (from, to) = (voxel(row), next.map_or_else(|| voxel(row), |next| voxel(next)));
        let places = if is_alone { 1 } else { (to.z - from.z).abs().ceil() as usize };
        if faults.last().is_none_or(|(name, ..)| *name != row[0]) {
            faults.push((row[0], 0, [0; 2]));
        }
        let Some((_, all, hits)) = faults.last_mut() else { continue };
        *all += places;
        for step in 0..places {
            let p = from.lerp(to, step as f64 / places as f64).as_vec3().to_array();
            let is_on = |fault: &FaultSurface| {
                let [u, h] = fault.sheet.frame.place(p);
                fault.sheet.is_there(u, p[2]) && (fault.sheet.height_at(u, p[2]) - h).abs() <= 2.0
            };
            hits[0] += usize::from(found.iter().any(|fault| fault.is_accepted() && is_on(fault)));
            hits[1] += usize::from(found.iter().any(|fault| fault.is_possible() && is_on(fault)));
        }
    }
    for (name, all, hits) in faults {
        let [proposed, possible] = hits.map(|n| 100.0 * n as f64 / all as f64);
        println!("{name}: {proposed:.0} % of it proposed, {possible:.0} % with minor ones");
    }
}
