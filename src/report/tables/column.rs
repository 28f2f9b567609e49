use crate::report::Cell;

/// Says what one row of a table is made from. The type may borrow: `Of<'a>` is that type with its
/// lifetime, so that tables can be statics.
pub trait Row {
    /// A row that lives for `'a`.
    type Of<'a>;
}

/// Treatment of points whose neighbours may lie beyond the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeRule {
    /// The border does not matter.
    NotAffected,
    /// Nothing: all points count.
    All,
    /// Only points at least as far from the border as from their nearest neighbour.
    Interior,
    /// Only points whose Voronoi cell is finite and has every vertex strictly inside the window
    /// (Cooper et al. 2016, <https://doi.org/10.1167/iovs.16-19072>).
    Bound,
    /// One of the column's own, which the definition names.
    Own,
}

impl EdgeRule {
    /// Returns the rule in a word.
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

/// Columns that only some files of a kind have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Files whose scale is known.
    Scaled,
    /// Files of mosaics whose density varies across the window.
    Varying,
    /// Files that compare two detectors or graders.
    Versus,
    /// Summaries of images (`run`).
    Images,
    /// Summaries of coordinates (`measure`).
    Coordinates,
}

/// The way from a row to a cell.
pub enum Value<R: Row> {
    /// One column.
    One(for<'a, 'b> fn(&'b R::Of<'a>) -> Cell),
    /// One column per sampler; the second argument is the sampler's name.
    PerSampler(for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell),
    /// One column, looked up by its own name among named series.
    Named(for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell),
}

impl<R: Row> Clone for Value<R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R: Row> Copy for Value<R> {}

/// A column without its value: its name and what it means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnWords {
    /// Name in the header; `SAMPLER` stands for that of each sampler.
    pub name: &'static str,
    /// Unit of the value; “unit” is that of the coordinates.
    pub unit: &'static str,
    /// Edge rule.
    pub edge: EdgeRule,
    /// Definition of the value, and when there is none.
    pub definition: &'static str,
    /// Author and year of the definition; empty where it needs none.
    pub source: &'static str,
    /// The only files that have it; `None`: all.
    pub part: Option<Part>,
}

/// A column of a table: what it means, and its value. Header, data dictionary and cells all come from here.
pub struct Column<R: Row> {
    /// Name and meaning.
    pub words: ColumnWords,
    /// The way from a row to its cell.
    pub value: Value<R>,
}

/// Begins a column: `column("nn_mean", "unit", "Mean distance.").edge(All).of(|row| row.mean.into())`.
pub const fn column(name: &'static str, unit: &'static str, definition: &'static str) -> ColumnWords {
    ColumnWords { name, unit, edge: EdgeRule::NotAffected, definition, source: "", part: None }
}

impl ColumnWords {
    /// Sets the edge rule.
    #[must_use]
    pub const fn edge(self, edge: EdgeRule) -> Self {
        Self { edge, ..self }
    }

    /// Sets who defined it.
    #[must_use]
    pub const fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// Sets which files alone have it.
    #[must_use]
    pub const fn only(self, part: Part) -> Self {
        Self { part: Some(part), ..self }
    }

    /// Completes a column of one value per row.
    pub const fn of<R: Row>(self, value: for<'a, 'b> fn(&'b R::Of<'a>) -> Cell) -> Column<R> {
        Column { words: self, value: Value::One(value) }
    }

    /// Completes a column that is repeated for each sampler, whose name stands where this one says
    /// `SAMPLER`.
    pub const fn per_sampler<R: Row>(
        self,
        value: for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell,
    ) -> Column<R> {
        Column { words: self, value: Value::PerSampler(value) }
    }

    /// Completes a column whose value is found by the column's own name.
    pub const fn by_name<R: Row>(
        self,
        value: for<'a, 'b, 'c> fn(&'b R::Of<'a>, &'c str) -> Cell,
    ) -> Column<R> {
        Column { words: self, value: Value::Named(value) }
    }
}

impl<R: Row> Column<R> {
    /// Returns the name that the column has for a sampler: hyphens of the sampler become underscores,
    /// unless its name is all of the column's.
    pub(in crate::report) fn name_for(&self, sampler: &str) -> String {
        match self.words.name {
            "SAMPLER" => sampler.to_owned(),
            name => name.replace("SAMPLER", &sampler.replace('-', "_")),
        }
    }

    /// Returns the cell of a row; `sampler` counts for repeated columns only.
    pub(in crate::report) fn cell(&self, row: &R::Of<'_>, sampler: &str) -> Cell {
        match self.value {
            Value::One(of) => of(row),
            Value::PerSampler(of) => of(row, sampler),
            Value::Named(of) => of(row, self.words.name),
        }
    }
}
