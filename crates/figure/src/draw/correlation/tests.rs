//! Names of tops beside wells.

use super::*;

fn column(name: &str, markers: &[(&str, f64)]) -> Column {
    let marker = |(name, z): &(&str, f64)| Marker { name: (*name).to_owned(), horizon: None, z: *z };
    Column {
        name: name.into(),
        datum_m: 0.0,
        head: DVec2::ZERO,
        span: [0.0, 1000.0],
        intervals: Vec::new(),
        markers: markers.iter().map(marker).collect(),
        is_prognosis: false,
        shift: 0.0,
        logs: Vec::new(),
    }
}

fn drawn(columns: &[Column]) -> Group {
    let panel = CorrelationPanel {
        columns,
        layers: &[],
        library: None,
        horizons: &[],
        axis: "Depth (m)".into(),
        range: [0.0, 1000.0],
        caption: None,
        dpi: 150.0,
    };
    panel.drawn(Rect::sized(DVec2::ZERO, DVec2::new(400.0, 300.0))).unwrap()
}

fn group_of<'a>(group: &'a Group, name: &str) -> Option<&'a Group> {
    let inner = group.items.iter().filter_map(|item| if let Item::Group(inner) = item { Some(inner) } else { None });
    inner.into_iter().find_map(|inner| if inner.name == name { Some(inner) } else { group_of(inner, name) })
}

fn names(group: &Group) -> Vec<&Text> {
    let tops = group_of(group, "tops").expect("names of tops");
    tops.items.iter().filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None }).collect()
}

#[test]
fn a_long_name_takes_several_lines_and_keeps_the_next_off() {
    let long = "Middle North Sea Group of the northern part of the platform";
    let columns = [column("A", &[(long, 400.0), ("Chalk", 405.0)]), column("B", &[]), column("C", &[])];
    let group = drawn(&columns);
    let names = names(&group);
    let said: Vec<&str> = names.iter().map(|text| text.text.as_str()).collect();
    assert!(said.len() > 2, "{said:?}");
    assert_eq!(said.join(" "), format!("{long} Chalk"));
    for pair in names.windows(2) {
        assert!(pair[1].at.y - pair[0].at.y >= 1.2 * pair[0].size, "{said:?}");
    }
}

#[test]
fn room_beside_the_last_well_is_kept_for_its_own_names() {
    let long = "Upper Limburg Group, undivided";
    let right = |columns: &[Column]| {
        let group = drawn(columns);
        let well = group_of(&group, &columns[1].name).expect("a well");
        let bounds = well.items.iter().filter_map(|item| match item {
            Item::Path(path) => path.path.bounds(),
            _ => None,
        });
        bounds.map(|bounds| bounds.max.x).fold(0.0, f64::max)
    };
    let left_alone = right(&[column("A", &[(long, 400.0)]), column("B", &[])]);
    let both = right(&[column("A", &[]), column("B", &[(long, 400.0)])]);
    assert!(left_alone > both + 40.0, "{left_alone} {both}");
}
