use super::canvas::{Anchor, Area, Canvas, PAGE_WIDTH, Style, fit};
use super::page::{AXIS_ROOM, LEFT_EDGE, LETTER_RISE, TITLE_BASELINE};

/// Room for the title and the letters above the plots, in canvas units.
const HEAD: f64 = 36.;
/// Height of the plots, in canvas units.
const HEIGHT: f64 = 190.;
/// Room for tick labels and the axis title below a plot, in canvas units.
const AXIS_DEPTH: f64 = 34.;
/// Gap between the first plot and the labels of the second, in canvas units.
const GAP: f64 = 30.;
/// Room at the right edge of the page for half a tick label, in canvas units.
const RIGHT_EDGE: f64 = 10.;
/// Room for wide tick labels left of a plot, in canvas units, in addition to `AXIS_ROOM`, the room
/// of every axis.
const TICK_ROOM: f64 = 12.;

/// Returns the areas of two plots side by side, without tick labels and axis titles.
pub(super) fn two_areas() -> [Area; 2] {
    let room = AXIS_ROOM + TICK_ROOM;
    let width = (PAGE_WIDTH - LEFT_EDGE - RIGHT_EDGE - GAP) / 2. - room;
    let area = |x: f64| Area { x, y: HEAD, width, height: HEIGHT };
    [area(LEFT_EDGE + room), area(LEFT_EDGE + 2. * room + width + GAP)]
}

/// Returns a page for two plots, with its title and the letters a and b.
pub(super) fn two_panels(title: &str) -> Canvas {
    let mut canvas = Canvas::new(HEAD + HEIGHT + AXIS_DEPTH);
    let title = fit(title, Style::Title, PAGE_WIDTH - 2. * LEFT_EDGE);
    canvas.text(LEFT_EDGE, TITLE_BASELINE, &title, Style::Title, Anchor::Start);
    for (area, letter) in two_areas().into_iter().zip(["a", "b"]) {
        let x = area.x - AXIS_ROOM - TICK_ROOM;
        canvas.text(x, area.y - LETTER_RISE, letter, Style::Letter, Anchor::Start);
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_stand_side_by_side_on_the_page() {
        let [a, b] = two_areas();
        assert!(a.right() + AXIS_ROOM < b.x && b.right() < PAGE_WIDTH && a.width > 250.);
    }
}
