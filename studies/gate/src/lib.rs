//! Do the errors stay where they were? Committed two-sided bounds: checked, audited, and held against wrong methods.
//!
//! A [`Row`] bounds one number of one run. [`Bounds::check`] runs what the rows ask for; [`Bounds::hold`] puts a method from
//! outside in the place of a built-in one and holds it to the same rows:
//!
//! ```no_run
//! use gate::{Bounds, Flat};
//! # use integrator::{Method, Model, Real, Space, State, Vector};
//! # struct Mine;
//! # impl<T: Real, M: Model<T>> Method<T, M> for Mine {
//! #     fn step(&self, _: &M, _: T, _: T, s: State<M::Config>) -> State<M::Config> { s }
//! # }
//! Bounds::committed()?.hold("semi-implicit-euler", &Flat(Mine))?.assert();
//! # Ok::<(), measure::error::Error>(())
//! ```
//!
//! Architecture invariants: no row is skipped in silence; a run that fails and a number that is none break their row; a file
//! that is not wholly understood is not used at all.

pub mod audit;
pub mod baseline;
pub mod candidate;
pub mod check;
pub mod deaths;
pub mod format;
pub mod known;
pub mod mutants;
pub mod numbers;
pub mod propose;
pub mod read;
pub mod row;
pub mod stepper;
pub mod update;

use std::path::Path;

pub use candidate::{Candidate, Flat, InBody, InWorld};
pub use check::Judged;
pub use row::Row;

use known::Known;
use measure::error::Error;
use measure::sweep::Progress;
use scenes::run::Precision;
use stepper::Ask;

/// The rows of a file, and the catalogue they speak of.
pub struct Bounds {
    /// Sorted.
    pub rows: Vec<Row>,
    /// The catalogue.
    pub known: Known,
}

impl Bounds {
    /// The bounds that are committed with this crate, wherever it is used.
    ///
    /// # Errors
    /// None in a release: a test reads them.
    pub fn committed() -> Result<Self, Error> {
        Self::parse(include_bytes!("../data/bounds.csv"), "the committed bounds")
    }

    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read or that is not wholly understood, with line and column.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let place = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|error| {
            let message = format!("cannot be read: {error}; give the file of bounds with --bounds FILE");
            Error::plan(place.as_str(), message)
        })?;
        Self::parse(&bytes, &place)
    }

    /// The same from memory; `place` is named in errors.
    ///
    /// # Errors
    /// What is not wholly understood, with line and column.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Self, Error> {
        let (rows, known) = read::read(bytes, place)?;
        Ok(Bounds { rows, known })
    }

    /// Judges rows by the methods that they name.
    ///
    /// # Errors
    /// A row that names no run; rows that were read do.
    pub fn check(&self, rows: &[&Row], progress: &Progress) -> Result<Vec<Judged>, Error> {
        check::judge(&self.known, rows, progress, |stepper| Box::new(stepper))
    }

    /// Holds a candidate to the f64 rows of the method of that name. On rigid bodies the rows' name says what is stored,
    /// `semi-implicit-euler/body-omega`; [`InWorld`] and [`InBody`] add it to a plain one.
    ///
    /// # Errors
    /// An unknown name where no row is of that method; a candidate that can run none of the rows, as `Flat` none of a rigid body.
    pub fn hold(&self, method: &str, candidate: &dyn Candidate) -> Result<Held, Error> {
        let method = &candidate.rows_of(method);
        let rows: Vec<&Row> =
            self.rows.iter().filter(|row| row.method == *method && row.precision == Precision::F64).collect();
        if rows.is_empty() {
            let known = measure::study::distinct(self.rows.iter().map(|row| row.method.clone()));
            return Err(Error::unknown("method with bounds", method, known));
        }
        let judged = check::judge(&self.known, &rows, &Progress::silent(), |_| Box::new(Borrowed(candidate)))?;
        if judged.iter().all(|one| one.verdict() == reports::Verdict::NotTested) {
            let wrapper = match method.split_once('/') {
                None => "Flat",
                Some((_, stored)) if stored.starts_with("body-omega") => "InBody",
                Some(_) => "InWorld",
            };
            let message = format!("the candidate can run none of its {} rows; wrap it in {wrapper}(..)", judged.len());
            return Err(Error::plan(method.as_str(), message));
        }
        Ok(Held { method: method.to_owned(), judged })
    }
}

struct Borrowed<'a>(&'a dyn Candidate);

impl Candidate for Borrowed<'_> {
    fn run(&self, ask: &Ask<'_>) -> Option<scenes::run::Trajectory> {
        self.0.run(ask)
    }
    fn rows_of(&self, method: &str) -> String {
        self.0.rows_of(method)
    }
    fn limit(
        &self,
        scene: &dyn scenes::any::AnyScene,
        precision: Precision,
    ) -> Option<measure::stability::bisect::Found> {
        self.0.limit(scene, precision)
    }
}

/// A candidate, judged.
#[derive(Clone, Debug)]
pub struct Held {
    /// The method it was held to.
    pub method: String,
    /// Every row of the method it was held to.
    pub judged: Vec<Judged>,
}

impl Held {
    /// The broken rows.
    pub fn broken(&self) -> Vec<&Judged> {
        self.judged.iter().filter(|one| one.is_broken()).collect()
    }

    /// What there is to say in a few lines: the counts, the wrong methods that break the same rows, the rows that are broken by most.
    pub fn summary(&self) -> String {
        format!("{}: {}", self.method, check::message(&self.judged))
    }

    /// For a test.
    ///
    /// # Panics
    /// With [`Held::summary`], if a row is broken.
    #[track_caller]
    pub fn assert(&self) {
        assert!(self.broken().is_empty(), "{}", self.summary());
    }
}
