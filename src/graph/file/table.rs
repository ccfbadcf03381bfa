//! Buffers as tables for people: a graph names rows and columns.

use super::resource::Path;
use crate::diagnostics::{At, Items, Loc};
use serde::Deserialize;
use std::collections::HashSet;

/// A buffer that may be read as a table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableDecl {
    /// The array of the rows, `buffer.member`.
    pub list: Loc<Path>,
    /// The member that holds the number of rows.
    pub rows: Loc<Path>,
    /// Heading, unique in the graph.
    pub title: String,
    /// One line.
    pub help: String,
    /// Columns in the order shown.
    pub columns: Items<ColumnDecl>,
}

/// A column of a table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnDecl {
    /// Heading, unique in the table.
    pub name: String,
    /// The member of a row; that of the column's name when absent.
    pub of: Option<String>,
    /// Unit, for people.
    #[serde(default)]
    pub unit: String,
}

impl TableDecl {
    /// Mistakes that need no shader, with their places; `at` is the place of the table.
    pub fn mistakes(&self, at: At) -> Vec<(At, String)> {
        let mut list = Vec::new();
        let title = &self.title;
        if self.columns.0.is_empty() {
            list.push((at, format!("table '{title}' has no columns")));
        }
        if self.help.trim().is_empty() || self.help.contains('\n') {
            list.push((at, format!("table '{title}' needs one line of help")));
        }
        let mut names = HashSet::new();
        for Loc { value: column, at } in &self.columns.0 {
            if !names.insert(&column.name) {
                list.push((
                    *at,
                    format!("two columns of '{title}' are named '{}'", column.name),
                ));
            }
        }
        let (rows, buffer) = (&self.rows.value, &self.list.value.buffer);
        if rows.buffer != *buffer {
            list.push((
                self.rows.at,
                format!("'{rows}' is not in '{buffer}', which holds the rows"),
            ));
        }
        list
    }
}
