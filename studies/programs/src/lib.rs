//! The programs: command line, plans, files, the report's page and the teaching page.

pub mod cli;
mod engines;
pub mod exact;
mod findings;
pub mod options;
pub mod page;
mod parts;
pub mod plan;
pub mod produce;
pub mod provenance;
mod reference;
mod shards;
pub mod summary;
pub mod teach;
pub mod units;
