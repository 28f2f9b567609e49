use crate::report::Cell;

/// The source of one row of a table.
///
/// The type may borrow: `Of<'a>` is the type with its lifetime, so that tables can be statics.
pub trait Row {
    /// A row that lives for `'a`.
    type Of<'a>;
}

/// Treatment of points whose neighbours may lie beyond the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeRule {
    /// No treatment, because the border does not affect the value.
    NotAffected,
    /// No treatment, although neighbours beyond the border are missing: all points count.
    All,
    /// Restriction to points at least as far from the border as from their nearest neighbour.
    Interior,
    /// Restriction to points whose Voronoi cell is finite and has every vertex strictly inside the
    /// window (Cooper et al. 2016, <https://doi.org/10.1167/iovs.16-19072>).
    Bound,
    /// Rule of the column's own, which the definition of the column states.
    Own,
}

impl EdgeRule {
    /// Returns the name of the rule, as the data dictionary shows it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotAffected => "–",
            Self::All => "all",
            Self::Interior => "interior",
            Self::Bound => "bound",
            Self::Own => "see definition",
        }
    }
}

/// A set of columns that only some files of a kind have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Columns of files whose scale is known.
    Scaled,
    /// Columns of files of mosaics whose density varies across the window.
    Varying,
    /// Columns of files that compare two detectors or graders.
    Versus,
    /// Columns of summaries of images (`run`).
    Images,
    /// Columns of summaries of coordinates (`measure`).
    Coordinates,
}

/// The function that makes a cell from a row.
pub enum Value<R: Row> {
    /// The value of a single column.
    One(for<'a, 'b> fn(&'b R::Of<'a>) -> Cell),
    /// The value of one column per sampler; the second argument is the sampler's name.
    PerSampler(for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell),
    /// The value of a single column, looked up by the column's own name among named series.
    Named(for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell),
}

impl<R: Row> Clone for Value<R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R: Row> Copy for Value<R> {}

/// A column without its value: name, unit and meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnWords {
    /// Name in the header; `SAMPLER` stands for the name of each sampler.
    pub name: &'static str,
    /// Unit of the value; “unit” is the unit of the coordinates.
    pub unit: &'static str,
    /// Edge rule of the value.
    pub edge: EdgeRule,
    /// Definition of the value, with the cases in which it is missing.
    pub definition: &'static str,
    /// Author and year of the definition; empty where none is needed.
    pub source: &'static str,
    /// Part to which the column belongs; `None` if all files have the column.
    pub part: Option<Part>,
}

/// A column of a table: what it means, and its value.
///
/// Header, data dictionary and cells are all made from it.
pub struct Column<R: Row> {
    /// Name and meaning of the column.
    pub words: ColumnWords,
    /// Function that makes the cell from a row.
    pub value: Value<R>,
}

/// Begins the description of a column, for example:
///
/// `column("nn_mean", "unit", "Mean distance.").edge(All).of(|row| row.mean.into())`
///
/// Unless set, the edge rule is [`EdgeRule::NotAffected`], there is no source, and all files have
/// the column.
pub const fn column(name: &'static str, unit: &'static str, definition: &'static str) -> ColumnWords {
    ColumnWords { name, unit, edge: EdgeRule::NotAffected, definition, source: "", part: None }
}

impl ColumnWords {
    /// Sets the edge rule.
    #[must_use]
    pub const fn edge(self, edge: EdgeRule) -> Self {
        Self { edge, ..self }
    }

    /// Sets the source: author and year of the definition.
    #[must_use]
    pub const fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// Restricts the column to files that have this part.
    #[must_use]
    pub const fn only(self, part: Part) -> Self {
        Self { part: Some(part), ..self }
    }

    /// Completes a column with one value per row.
    pub const fn of<R: Row>(self, value: for<'a, 'b> fn(&'b R::Of<'a>) -> Cell) -> Column<R> {
        Column { words: self, value: Value::One(value) }
    }

    /// Completes a column that is repeated for each sampler.
    ///
    /// The sampler's name replaces `SAMPLER` in the name of the column.
    pub const fn per_sampler<R: Row>(
        self,
        value: for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell,
    ) -> Column<R> {
        Column { words: self, value: Value::PerSampler(value) }
    }

    /// Completes a column whose value is looked up by the column's own name.
    pub const fn by_name<R: Row>(
        self,
        value: for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell,
    ) -> Column<R> {
        Column { words: self, value: Value::Named(value) }
    }
}

impl<R: Row> Column<R> {
    /// Returns the name of the column for a sampler.
    ///
    /// Hyphens of the sampler become underscores, unless the complete name is `SAMPLER`.
    pub(in crate::report) fn name_for(&self, sampler: &str) -> String {
        match self.words.name {
            "SAMPLER" => sampler.to_owned(),
            name => name.replace("SAMPLER", &sampler.replace('-', "_")),
        }
    }

    /// Returns the cell of a row; `sampler` matters for repeated columns only.
    pub(in crate::report) fn cell(&self, row: &R::Of<'_>, sampler: &str) -> Cell {
        match self.value {
            Value::One(of) => of(row),
            Value::PerSampler(of) => of(row, sampler),
            Value::Named(of) => of(row, self.words.name),
        }
    }
}
