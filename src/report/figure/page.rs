use super::canvas::{Area, PAGE_WIDTH};

/// Distance of the baseline of the title from the top of the page, in canvas units.
pub(super) const TITLE_BASELINE: f64 = 11.;
/// Height of the baseline of a letter above the top of its panel.
pub(super) const LETTER_RISE: f64 = 6.;
/// Room for tick labels and the axis title, left of a plot.
pub(super) const AXIS_ROOM: f64 = 40.;
/// Room for tick labels and the axis title, below a plot.
const AXIS_DEPTH: f64 = 34.;
/// Room for title and letters above the first row.
const HEAD: f64 = 36.;
/// Room for a letter above a lower row.
const LETTER_ROOM: f64 = 22.;
/// Room for a scale bar below a field.
const SCALE_BAR_ROOM: f64 = 18.;
/// Gap between two panels of a row, in canvas units.
const GAP: f64 = 14.;
/// Room at the right edge of the page, for half a tick label.
const RIGHT_EDGE: f64 = 8.;
/// Room at the left edge of the page, for half a dot.
pub(super) const LEFT_EDGE: f64 = 2.;
/// Height of the plots, in canvas units, unless the fields beside them are higher.
const PLOT_HEIGHT: f64 = 160.;
/// Largest height of a field beside the plots, in canvas units.
const TALLEST: f64 = 200.;
/// Share of the combined width of the two plots that the histogram gets; the pair correlation
/// function has more to show.
const HISTOGRAM_SHARE: f64 = 0.4;
/// Width over height of a field above which fields are stacked beside the plots.
const WIDE: f64 = 1.7;
/// Width over height of a field above which fields are stacked above the plots.
const VERY_WIDE: f64 = 4.;

/// Areas of all panels, in canvas units from the top left of the page.
///
/// The “fields” are the picture and the points; the “plots” are the histogram of neighbours and the
/// pair correlation function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Page {
    pub(super) height: f64,
    pub(super) picture: Option<Area>,
    pub(super) points: Area,
    /// Area of the axes, without tick labels and titles.
    pub(super) neighbours: Area,
    /// Area of the axes, without tick labels and titles.
    pub(super) correlation: Area,
}

impl Page {
    /// Arranges a page for fields whose width over height is `aspect`: the points and, if
    /// `with_picture`, the picture.
    pub(super) fn arrange(aspect: f64, with_picture: bool) -> Self {
        if aspect <= WIDE {
            Self::row(aspect, with_picture)
        } else if aspect <= VERY_WIDE {
            Self::stacked_beside(aspect, with_picture)
        } else {
            Self::stacked_above(aspect, with_picture)
        }
    }

    /// Arranges all panels side by side.
    fn row(aspect: f64, with_picture: bool) -> Self {
        let widest = if with_picture { 140. } else { 180. };
        let width = f64::min(widest, TALLEST * aspect);
        let height = width / aspect;
        let plot_height = PLOT_HEIGHT.max(height.min(190.));
        // A narrow strip still needs room for its letter and its scale bar.
        let column = width.max(56.) + GAP;
        let picture = with_picture.then_some(Area { x: LEFT_EDGE, y: HEAD, width, height });
        let points = Area { x: LEFT_EDGE + if with_picture { column } else { 0. }, y: HEAD, width, height };
        let (neighbours, correlation) = plots(points.x + column, HEAD, plot_height);
        let bottom = (height + SCALE_BAR_ROOM).max(plot_height + AXIS_DEPTH);
        Self { height: HEAD + bottom, picture, points, neighbours, correlation }
    }

    /// Arranges the fields one above the other on the left, and the plots on the right.
    fn stacked_beside(aspect: f64, with_picture: bool) -> Self {
        let width = f64::min(270., if with_picture { 88. } else { 130. } * aspect);
        let height = width / aspect;
        let picture = with_picture.then_some(Area { x: LEFT_EDGE, y: HEAD, width, height });
        let top = HEAD + if with_picture { height + SCALE_BAR_ROOM + LETTER_ROOM } else { 0. };
        let points = Area { x: LEFT_EDGE, y: top, width, height };
        // The axes end where the lower field ends.
        let plot_height = PLOT_HEIGHT.max(top + height - HEAD);
        let (neighbours, correlation) = plots(LEFT_EDGE + width + GAP, HEAD, plot_height);
        let bottom = (top - HEAD + height + SCALE_BAR_ROOM).max(plot_height + AXIS_DEPTH);
        Self { height: HEAD + bottom, picture, points, neighbours, correlation }
    }

    /// Arranges the fields one above the other over the full width of the page, and the plots
    /// below.
    fn stacked_above(aspect: f64, with_picture: bool) -> Self {
        let width = PAGE_WIDTH - 2. * LEFT_EDGE;
        let height = width / aspect;
        let step = height + SCALE_BAR_ROOM + LETTER_ROOM;
        let picture = with_picture.then_some(Area { x: LEFT_EDGE, y: HEAD, width, height });
        let points = Area { y: HEAD + if with_picture { step } else { 0. }, x: LEFT_EDGE, width, height };
        let top = points.y + step;
        let (neighbours, correlation) = plots(LEFT_EDGE, top, PLOT_HEIGHT);
        Self { height: top + PLOT_HEIGHT + AXIS_DEPTH, picture, points, neighbours, correlation }
    }
}

/// Returns the axes of histogram and PCF, from `left` to the edge of the page.
fn plots(left: f64, y: f64, height: f64) -> (Area, Area) {
    let width = PAGE_WIDTH - RIGHT_EDGE - left - 2. * AXIS_ROOM - GAP;
    let first = Area { x: left + AXIS_ROOM, y, width: width * HISTOGRAM_SHARE, height };
    let second =
        Area { x: first.right() + GAP + AXIS_ROOM, y, width: width * (1. - HISTOGRAM_SHARE), height };
    (first, second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_never_overlap_nor_leave_the_page() {
        for aspect in [0.02, 0.3, 0.7, 1., 1.5, 1.75, 2.67, 3.9, 4.1, 12., 60.] {
            for with_picture in [true, false] {
                let page = Page::arrange(aspect, with_picture);
                let areas: Vec<_> = page
                    .picture
                    .into_iter()
                    .chain([page.points, page.neighbours, page.correlation])
                    .collect();
                for (i, a) in areas.iter().enumerate() {
                    assert!(
                        a.x >= 0. && a.right() <= PAGE_WIDTH && a.bottom() <= page.height,
                        "{aspect}: {a:?}"
                    );
                    assert!(a.width > 0. && a.height > 0.);
                    for b in &areas[i + 1..] {
                        let apart =
                            a.right() <= b.x || b.right() <= a.x || a.bottom() <= b.y || b.bottom() <= a.y;
                        assert!(apart, "{aspect}: {a:?} {b:?}");
                    }
                }
                assert!(page.neighbours.width > 90., "{aspect}: {}", page.neighbours.width);
                assert!((page.points.width / page.points.height / aspect - 1.).abs() < 1e-9);
            }
        }
    }
}
