use super::unit::Unit;
use super::{Metric, Quantity, metrics};
use std::borrow::Cow;

/// Metrics that had another name in earlier versions: the old name and the current one.
const RENAMED: [(&str, &str); 1] = [("spacing", "spacing_density")];

/// Returns the current name of a metric or column; `name` may be its name in an earlier
/// version.
pub(super) fn canonical(name: &str) -> Cow<'_, str> {
    for (old, present) in RENAMED {
        let Some(metric) = metrics().find(|m| m.column.words.name == present) else { continue };
        let suffixes = Unit::SUFFIXED.map(|unit| unit.suffix(metric.quantity));
        let rest = name.strip_prefix(old).filter(|rest| rest.is_empty() || suffixes.contains(rest));
        if let Some(rest) = rest {
            return Cow::Owned(format!("{present}{rest}"));
        }
    }
    Cow::Borrowed(name)
}

/// Names of the column of one metric and unit in the summaries of all commands and versions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnNames {
    /// Current name of the column, which ends in the unit.
    pub name: String,
    /// Names that end in the unit, the current one first.
    pub suffixed: Vec<String>,
    /// Names without a unit, which mean the same column where the coordinates are in px.
    ///
    /// The list is empty for units other than px.
    pub in_pixels: Vec<&'static str>,
}

/// Returns the columns that a name may mean, in the order in which they should be tried.
///
/// A name without a unit means one column per unit; a name with a unit means one column. The list
/// is empty if no length, area or density has this name.
pub fn column_names(asked: &str) -> Vec<ColumnNames> {
    let asked = canonical(asked);
    let measured = metrics().filter(|m| m.quantity != Quantity::Plain);
    let of_metric = |m: &'static Metric| {
        let (base, quantity) = (m.column.words.name, m.quantity);
        let old = RENAMED.into_iter().filter(|(_, present)| *present == base).map(|(old, _)| old);
        let bases: Vec<&'static str> = std::iter::once(base).chain(old).collect();
        let with_unit = move |unit: Unit| {
            let suffix = unit.suffix(quantity);
            ColumnNames {
                name: format!("{base}{suffix}"),
                suffixed: bases.iter().map(|base| format!("{base}{suffix}")).collect(),
                in_pixels: if unit == Unit::Pixels { bases.clone() } else { Vec::new() },
            }
        };
        Unit::SUFFIXED.map(with_unit)
    };
    let all = measured.map(|m| (m.column.words.name, of_metric(m)));
    let fits = |(base, names): (&str, [ColumnNames; 4])| -> Vec<ColumnNames> {
        names.into_iter().filter(|n| *asked == *base || *asked == *n.name).collect()
    };
    all.flat_map(fits).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_without_unit_mean_any_and_old_names_the_present_ones() {
        let names = |asked: &str| column_names(asked).into_iter().map(|c| c.name).collect::<Vec<_>>();
        assert_eq!(
            names("density"),
            ["density_per_px2", "density_per_mm2", "density_per_deg2", "density_per_arcmin2"]
        );
        assert_eq!(names("spacing_um"), ["spacing_density_um"]);
        assert_eq!(column_names("spacing_um")[0].suffixed, ["spacing_density_um", "spacing_um"]);
        assert_eq!(column_names("nn_mean")[0].in_pixels, ["nn_mean"]);
        assert_eq!(names("ri"), Vec::<String>::new());
        assert_eq!(canonical("spacing_ring_px"), "spacing_ring_px");
    }
}
