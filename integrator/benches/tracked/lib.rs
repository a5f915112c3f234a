//! Nothing but a package for the benchmark beside it.
