//! Lines that are no volumes, as programs write them.

use super::builder::{Built, Trace};

/// Writes the header of one of a line's traces.
type Header<'a> = &'a dyn Fn(i32, &mut Trace);

/// What 2D lines look like in the headers that programs write.
#[test]
fn two_d_lines_of_many_programs() {
    let line = |header: Header| {
        let mut file = Built::grid(&[0], &[0]);
        file.traces = (0..60)
            .map(|n| {
                let mut t = file.trace(0, n);
                [189, 193].iter().for_each(|&byte| t.i32(byte, 0));
                header(n, &mut t);
                t
            })
            .collect();
        file.refusal().1
    };
    let crooked = |n: i32, t: &mut Trace| {
        t.i32(181, 60_000_000 + 2500 * n);
        t.i32(185, 600_000_000 + (30.0 * f64::from(n * n)) as i32);
    };
    let members: [(&str, Header); 12] = [
        ("line and CDP", &|n, t| {
            t.i32(189, 12);
            t.i32(193, 101 + n);
            t.i32(21, 101 + n);
        }),
        ("CDP and 1", &|n, t| {
            t.i32(189, 101 + n);
            t.i32(193, 1);
        }),
        ("trace and trace", &|n, t| {
            t.i32(189, n + 1);
            t.i32(193, n + 1);
        }),
        ("CDP in twos", &|n, t| t.i32(21, 101 + 2 * n)),
        ("CDP with gaps", &|n, t| t.i32(21, 101 + n + i32::from(n > 20) * 7)),
        ("counters alone", &|n, t| {
            t.i32(1, n + 1);
            t.i32(5, n + 1);
        }),
        ("counters alone, crooked", &|n, t| {
            t.i32(1, n + 1);
            t.i32(5, n + 1);
            crooked(n, t);
        }),
        ("nothing, crooked", &crooked),
        ("crossline alone", &|n, t| t.i32(193, n + 1)),
        ("shot points, two traces each", &|n, t| {
            t.i32(17, 100 + n / 2);
            t.i32(25, 1 + n % 2);
            t.i32(21, n + 1);
        }),
        ("field records, and line 7", &|n, t| {
            t.i32(9, n + 1);
            t.i32(189, 7);
            t.i32(193, n + 1);
            t.i32(21, n + 1);
            crooked(n, t);
        }),
        ("CDP, no places", &|n, t| {
            t.i32(21, 5 * n + 3);
            t.i32(181, 0);
            t.i32(185, 0);
        }),
    ];
    let told: Vec<String> = members.iter().map(|(name, header)| format!("{name}: {}", line(header))).collect();
    let missed: Vec<&String> = told.iter().filter(|told| !told.contains("this is a 2D line")).collect();
    assert!(missed.is_empty(), "{missed:#?}");
}
