//! What can be wrong with the input of a run, named with its place and its remedy.

/// Every error of this crate.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A name that is not on the list.
    #[error("{kind} '{name}': unknown; {}known: {}", suggestion(.nearest.as_deref()), known.join(", "))]
    UnknownName {
        /// What was looked for: scene, method, precision.
        kind: &'static str,
        /// What was given.
        name: String,
        /// The nearest name on the list, if any is near.
        nearest: Option<String>,
        /// The list.
        known: Vec<String>,
    },
    /// A parameter outside its range.
    #[error("scene '{scene}': parameter '{parameter}' = {value}: {expected}")]
    Parameter {
        /// The scene.
        scene: String,
        /// The parameter.
        parameter: String,
        /// What was given.
        value: String,
        /// The allowed range or form.
        expected: String,
    },
    /// A plan that cannot be run.
    #[error("{place}: {message}")]
    Plan {
        /// The flag or field.
        place: String,
        /// What was found and what would be right.
        message: String,
    },
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("did you mean '{name}'? "))
}

impl Error {
    /// The error at a place of the input, with what was found there and what would be right.
    pub fn plan(place: impl Into<String>, message: impl Into<String>) -> Self {
        Error::Plan { place: place.into(), message: message.into() }
    }

    /// The error for a name that is not among `known`.
    pub fn unknown(kind: &'static str, name: &str, known: impl IntoIterator<Item = String>) -> Self {
        let known: Vec<String> = known.into_iter().collect();
        let nearest = known
            .iter()
            .map(|candidate| (edit_distance(name, candidate), candidate))
            .min()
            .filter(|(distance, _)| *distance <= 1 + name.len() / 3)
            .map(|(_, candidate)| candidate.clone());
        Error::UnknownName { kind, name: name.to_owned(), nearest, known }
    }
}

/// Levenshtein's distance: insertions, deletions and substitutions.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edit_distance_counts_single_letter_edits() {
        assert_eq!(edit_distance("oscilator", "oscillator"), 1);
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
        assert_eq!(edit_distance("abc", ""), 3);
        assert_eq!(edit_distance("rk4", "rk4"), 0);
    }

    #[test]
    fn a_near_name_is_suggested_and_a_far_one_is_not() {
        let known = || ["oscillator".to_owned(), "kepler".to_owned()];
        let text = Error::unknown("scene", "oscilator", known()).to_string();
        assert!(text.contains("did you mean 'oscillator'?") && text.contains("kepler"), "{text}");
        let text = Error::unknown("scene", "zzzzzz", known()).to_string();
        assert!(!text.contains("did you mean"), "{text}");
    }
}
