//! One self-contained page: verdicts, findings, tables, claims, figures. No script or style comes from elsewhere.

use crate::{Claim, Figure, Table};

/// A report as one page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Title of the page.
    pub title: String,
    /// Opening paragraph.
    pub lead: String,
    /// What was found, most important first.
    pub findings: Vec<Finding>,
    /// The studies.
    pub sections: Vec<Section>,
    /// Provenance: name and value (version, toolchain, plan), in this order.
    pub footer: Vec<(String, String)>,
}

/// One finding of the summary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finding {
    /// The finding in a few words.
    pub title: String,
    /// What was measured, in one or two sentences.
    pub text: String,
    /// Id of the figure that shows it.
    pub figure: Option<String>,
}

/// One study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Anchor, unique within the page.
    pub id: String,
    /// Heading.
    pub title: String,
    /// Opening paragraph: the question and how it is answered.
    pub intro: String,
    /// What follows, in order.
    pub blocks: Vec<Block>,
}

/// One part of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table.
    Table {
        /// What the table shows.
        caption: String,
        /// Its rows.
        table: Table,
        /// Link to the CSV file with the same numbers.
        csv: Option<String>,
    },
    /// Claims with their verdicts.
    Claims(Vec<Claim>),
    /// A figure with its drawing, as [`crate::plot::svg`] gives it.
    Figure {
        /// The figure: id, caption, command, data.
        figure: Figure,
        /// The drawing.
        svg: String,
    },
}
