//! The command line that all binaries share: flags, commands beside the run, and how a program ends.

pub mod bounds;
mod color;
pub mod exact;
pub mod front;
mod list;
pub mod loops;
pub mod merge;
mod messages;
pub mod order;
mod program;
pub mod stability;
pub mod tradeoff;

pub use messages::print;
pub use program::{Ending, NoFlags, ProgramInfo, asking, main, report, start, with_tables};
