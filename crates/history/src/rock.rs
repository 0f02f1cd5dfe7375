//! What rocks are like to water and to sound: hardness, velocity and density, by words of their names.

/// Words of a rock's name, hardness against erosion (1 middling), velocity (m/s), density (kg/m³). The first line that has
/// a word of the name counts. Round numbers of the middle of what handbooks give for consolidated rock near the surface.
const ROCKS: [(&[&str], f64, f64, f64); 16] = [
    (&["salt", "halite"], 0.5, 4500.0, 2160.0),
    (&["coal", "lignite"], 0.5, 2300.0, 1400.0),
    (&["gypsum", "anhydrite", "evaporite"], 0.7, 5600.0, 2800.0),
    (&["marl", "marlstone"], 0.6, 3100.0, 2400.0),
    (&["shale", "mudstone", "claystone", "clay", "mud"], 0.4, 2800.0, 2350.0),
    (&["siltstone", "silt"], 0.7, 3200.0, 2420.0),
    (&["chalk"], 0.9, 3000.0, 2250.0),
    (&["dolostone", "dolomite"], 1.8, 5600.0, 2700.0),
    (&["limestone", "carbonate", "travertine", "marble"], 1.6, 4800.0, 2620.0),
    (&["conglomerate", "breccia"], 1.3, 3900.0, 2500.0),
    (&["quartzite"], 2.4, 5600.0, 2640.0),
    (&["sandstone", "arkose", "greywacke", "graywacke", "wacke"], 1.2, 3500.0, 2330.0),
    (&["sand", "gravel", "till", "soil", "alluvium", "sediment"], 0.3, 1900.0, 2000.0),
    (&["tuff", "ash"], 0.6, 2900.0, 2100.0),
    (&["basalt", "dolerite", "diabase", "gabbro", "andesite", "peridotite"], 2.0, 5900.0, 2880.0),
    (
        &[
            "granite",
            "granodiorite",
            "diorite",
            "syenite",
            "rhyolite",
            "gneiss",
            "schist",
            "hornfels",
            "slate",
            "phyllite",
        ],
        2.0,
        5300.0,
        2680.0,
    ),
];

fn of(rock: &str) -> (f64, f64, f64) {
    let name = rock.to_lowercase();
    let words = name.split(|c: char| !c.is_alphanumeric());
    let found = ROCKS.iter().find(|(known, ..)| words.clone().any(|word| known.contains(&word)));
    found.map_or((1.0, 3600.0, 2450.0), |(_, hard, velocity, density)| (*hard, *velocity, *density))
}

/// Hardness against erosion, 1 for middling rock.
pub(crate) fn hardness(rock: &str) -> f64 {
    of(rock).0
}

/// Acoustic impedance of a rock, kg/(m² s).
///
/// ```
/// assert!(history::impedance("limestone") > history::impedance("black shale"));
/// ```
pub fn impedance(rock: &str) -> f64 {
    let (_, velocity, density) = of(rock);
    velocity * density
}
