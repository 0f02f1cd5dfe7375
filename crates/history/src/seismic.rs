//! What a survey of the block would hear: reflections where the impedance of the rock changes.

use crate::place::Place;
use crate::rock::impedance;
use crate::stage::Stage;
use glam::DVec2;

/// Impedance of sea water, kg/(m² s).
const WATER: f64 = 1500.0 * 1030.0;

impl Stage<'_> {
    /// Impedance of what is at a place, kg/(m² s); 0 in air.
    pub fn impedance(&self, place: &Place) -> f64 {
        match place {
            Place::Air => 0.0,
            Place::Water => WATER,
            Place::Rock(rock) => impedance(&self.history().units()[rock.altered.unwrap_or(rock.unit)].rock),
        }
    }

    /// Depth in m and reflectivity of every boundary along a vertical line, from the top down; positive where impedance
    /// grows downwards (SEG normal polarity). The ground under air does not count.
    ///
    /// ```
    /// use glam::DVec2;
    /// let history = history::History::from_toml(
    ///     "size = [900, 900, 500]
    ///      [[events]]
    ///      kind = \"beds\"
    ///      beds = [{ rock = \"limestone\", thickness = 300 }, { rock = \"shale\", thickness = 200 }]",
    /// )?;
    /// let found = history.last_stage().reflectors(DVec2::new(450.0, 450.0));
    /// assert_eq!(found.len(), 1);
    /// assert!((found[0].0 - 200.0).abs() < 1e-4 && found[0].1 > 0.2);
    /// # Ok::<(), history::HistoryError>(())
    /// ```
    pub fn reflectors(&self, map: DVec2) -> Vec<(f64, f64)> {
        let column = self.column(map);
        let pairs = column.windows(2).filter(|pair| !matches!(pair[0].place, Place::Air));
        let found = pairs.map(|pair| {
            let [above, below] = [&pair[0], &pair[1]].map(|stretch| self.impedance(&stretch.place));
            (pair[1].depths[0], (below - above) / (below + above).max(1.0))
        });
        found.filter(|(_, reflectivity)| *reflectivity != 0.0).collect()
    }
}
