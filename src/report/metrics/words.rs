use super::unit::Unit;
use super::{Metric, Quantity, SummaryKind, metrics};

/// Short names of the metrics that figures show most often.
const NAMES: [(&str, &str); 6] = [
    ("n", "number of cones"),
    ("density", "cone density"),
    ("nn_mean", "nearest-neighbour distance"),
    ("nn_sd", "SD of nearest-neighbour distances"),
    ("ri", "regularity index"),
    ("spacing_density", "spacing (density)"),
];

/// Returns the quantity in a column of a summary and its unit, in words for the axis of a figure.
///
/// The unit is empty if the quantity has none. A column that is not known keeps its name, with
/// blanks for underscores.
pub fn column_in_words(column: &str) -> (String, String) {
    let Some((metric, unit)) = find(column) else { return (column.replace('_', " "), String::new()) };
    let name =
        NAMES.iter().find(|n| n.0 == metric.column.words.name).map_or(metric.column.words.name, |n| n.1);
    (name.replace('_', " "), unit_in_words(metric, unit).to_owned())
}

/// Returns the metric and the unit of a column; `None` if no summary has it.
fn find(column: &str) -> Option<(&'static Metric, Unit)> {
    let kinds = [SummaryKind::Images, SummaryKind::Coordinates];
    kinds.into_iter().find_map(|kind| {
        metrics().filter(|m| m.is_of(kind)).find_map(|metric| {
            let rest = column.strip_prefix(metric.column.words.name)?;
            let mut units = Unit::all(metric.quantity, kind);
            let unit = units.find(|unit| unit.suffix(metric.quantity) == rest)?;
            Some((metric, unit))
        })
    })
}

/// Returns a unit in words for the axis of a figure; empty for numbers without one.
fn unit_in_words(metric: &Metric, unit: Unit) -> &'static str {
    match (metric.quantity, unit, metric.column.words.unit) {
        (Quantity::Plain, _, "text" | "count" | "ratio" | "0–1") => "",
        (Quantity::Length, Unit::Coordinates, _) => "in the unit of the coordinates",
        (Quantity::Area, Unit::Coordinates, _) => "in the squared unit of the coordinates",
        (Quantity::Density, Unit::Coordinates, _) => "per squared unit of the coordinates",
        (Quantity::Density, Unit::Pixels, _) => "cones/px²",
        (Quantity::Density, Unit::Micrometres, _) => "cones/mm²",
        (Quantity::Density, Unit::Degrees, _) => "cones/degree²",
        (Quantity::Density, Unit::Arcminutes, _) => "cones/arcmin²",
        (quantity, _, plain) => unit.words(quantity, plain),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_become_words_with_units() {
        for (column, quantity, unit) in [
            ("density_per_mm2", "cone density", "cones/mm²"),
            ("density_per_px2", "cone density", "cones/px²"),
            ("nn_mean_um", "nearest-neighbour distance", "µm"),
            ("nn_mean", "nearest-neighbour distance", "in the unit of the coordinates"),
            ("n", "number of cones", ""),
            ("ri", "regularity index", ""),
            ("voronoi_area_mean_mm2", "voronoi area mean", "mm²"),
            ("hand_count", "hand count", ""),
        ] {
            assert_eq!(column_in_words(column), (quantity.to_owned(), unit.to_owned()), "{column}");
        }
    }
}
