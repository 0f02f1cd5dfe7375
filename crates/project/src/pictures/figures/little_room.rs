//! Figures on pages without room for all that is asked: what is written beside and on them is left out, and said, so that
//! a page of a centimetre still shows its block.

use figure::{Figure, FigureError};
use survey::Progress;

/// What takes a part out of a figure.
type Omission = fn(&mut Figure);

/// What is left out, in this order, and how.
const LEFT_OUT: [(&str, Omission); 3] = [
    ("the legend", |figure| figure.legend = false),
    ("title, caption, scale bars and north arrow", |figure| {
        (figure.title, figure.caption) = (None, None);
        (figure.scale_bar, figure.north_arrow) = (false, false);
    }),
    ("what is written on the figure", |figure| figure.annotate.clear()),
];

/// The page of a figure, or of as much of it as there is room for.
///
/// # Errors
/// What `make` says; where there is no room for the figure alone either, what it said first.
pub(super) fn made<T>(
    figure: &Figure,
    progress: &Progress,
    mut make: impl FnMut(&Figure) -> Result<T, FigureError>,
) -> Result<T, FigureError> {
    let first = match make(figure) {
        Err(error @ FigureError::NoRoom { .. }) => error,
        made => return made,
    };
    let (mut less, mut left_out) = (figure.clone(), Vec::new());
    for (what, leave_out) in LEFT_OUT {
        let before = less.clone();
        leave_out(&mut less);
        if less == before {
            continue;
        }
        left_out.push(what);
        match make(&less) {
            Err(FigureError::NoRoom { .. }) => {}
            Ok(page) => {
                let said = left_out.join("; ");
                progress.warn(format!("the page has no room for all of it, and lacks: {said}; make the page larger"));
                return Ok(page);
            }
            error => return error,
        }
    }
    Err(first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use page::DisplayList;

    #[test]
    fn what_has_no_room_is_left_out_from_the_legend_on() {
        let figure = Figure { legend: true, scale_bar: true, ..Figure::default() };
        let full = || Err(FigureError::NoRoom { what: "the figure", size_cm: [1.0; 2] });
        let page = || Ok(DisplayList::new(DVec2::ONE));
        let progress = Progress::silent();
        let mut asked = Vec::new();
        let made_page = made(&figure, &progress, |figure| {
            asked.push((figure.legend, figure.scale_bar));
            if figure.scale_bar { full() } else { page() }
        });
        assert!(made_page.is_ok());
        assert_eq!(asked, [(true, true), (false, true), (false, false)]);
        let refused = made(&figure, &progress, |_| full());
        assert!(matches!(refused, Err(FigureError::NoRoom { .. })));
    }
}
