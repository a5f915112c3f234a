//! Ensembles, as a program runs them.

use measure::ensemble::{Ensemble, check, cost, measure};
use measure::error::Error;
use measure::study::{Selection, Study};
use reports::{Block, OutputDir};

use super::{Common, Ending, Format};
use crate::produce::{self, Judged, Product, from_rows};
use crate::provenance::Manifest;
use crate::summary;

/// Runs ensembles of `count` members drawn from `seed` on the chosen scenes that have a rule for it, with the chosen methods
/// that run in lanes, and makes all that follows; with a table of the cost of many bodies, which is a timing.
///
/// # Errors
/// A size or a choice that leaves nothing to be run, named with what would be right.
pub fn ensemble(selection: &mut Selection, count: usize, seed: u64, format: Format) -> Result<Product, Error> {
    check(selection, count, seed)?;
    selection.progress.name(Ensemble::ID);
    let mut product = from_rows::<Ensemble>(&measure(selection, count, seed), format)?;
    let cost = cost::table(selection, count, seed)?;
    let name = format!("{}.csv", cost.name);
    product.files.push((name.clone(), cost.csv.into_bytes()));
    product.section.blocks.push(Block::Table { caption: cost.caption.to_owned(), table: cost.table, csv: Some(name) });
    Ok(product)
}

/// [`ensemble`] as a program does it: writes the files, and prints the tables before the claims.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn run(common: &Common, count: usize, seed: u64) -> Result<Ending, Error> {
    if common.from.is_some() {
        let message = "draws states and runs them; the rows of a directory have none to be drawn: leave --from out";
        return Err(Error::plan("--ensemble", message));
    }
    let mut selection = common.selection()?;
    let out = OutputDir::create(common.out(Ensemble::ID))?;
    let Product { files, section, claims } = ensemble(&mut selection, count, seed, common.format)?;
    let judged = Judged { claims, manifest: Manifest::of(&common.plan) };
    produce::write(&out, common, files, &judged.manifest)?;
    Ending::of(common, &judged, |claims| {
        let tables: String = section.blocks.iter().flat_map(tables).collect();
        format!("{tables}{}", summary::verdicts(claims))
    })
}

/// The tables of a block, also of those within a group, as text.
fn tables(block: &Block) -> Vec<String> {
    match block {
        Block::Table { caption, table, .. } => vec![format!("{caption}\n\n{}\n", table.to_text())],
        Block::Group { blocks, .. } => blocks.iter().flat_map(tables).collect(),
        _ => Vec::new(),
    }
}
