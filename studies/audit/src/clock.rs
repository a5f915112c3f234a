//! The times of the rows of a file.

/// What is known of the clock of a file.
#[derive(Clone, Debug, Default)]
pub struct Clock {
    /// The usual time between two rows, s.
    pub interval: f64,
    /// Pairs of rows (i, i + 1) that are no usual interval apart.
    pub irregular: Vec<usize>,
}

impl Clock {
    /// Whether rows i and i + 1 are the usual interval apart.
    pub fn is_regular(&self, i: usize) -> bool {
        self.irregular.binary_search(&i).is_err()
    }
}
