//! Tables of words and rounded numbers, for a terminal or a page.

mod table;
mod validation;

pub use table::{counted, significant, table};
pub use validation::{
    TextTable, accuracy_table, agreement_table, comparison_table, group_table, threshold_table,
};
