//! Which files of a directory were written by whom, so that a smaller report leaves none of a larger one behind.

use super::STATE;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The list, inside the output directory.
pub(super) const NAME: &str = ".reports/files";

/// Names of files and their owners: one line each, owner, tabulator, name.
#[derive(Debug, Default, PartialEq)]
pub(super) struct List(BTreeMap<String, String>);

impl List {
    /// The list of a directory; empty where there is none.
    pub(super) fn read(root: &Path) -> Self {
        debug_assert!(NAME.starts_with(STATE));
        let text = fs::read_to_string(root.join(NAME)).unwrap_or_default();
        let lines = text.lines().filter_map(|line| line.split_once('\t'));
        Self(lines.map(|(owner, name)| (name.to_owned(), owner.to_owned())).collect())
    }

    pub(super) fn text(&self) -> String {
        self.0.iter().map(|(name, owner)| format!("{owner}\t{name}\n")).collect()
    }

    /// Gives the names to an owner; what it had besides is struck out and returned. Without an owner nothing is.
    pub(super) fn replace<'a>(&mut self, owner: Option<&str>, names: impl Iterator<Item = &'a str>) -> Vec<String> {
        let mut stale = std::mem::take(&mut self.0);
        for name in names {
            // A file that is written again without an owner keeps the one it had.
            let before = stale.remove(name).unwrap_or_default();
            self.0.insert(name.to_owned(), owner.map_or(before, str::to_owned));
        }
        let (gone, kept): (BTreeMap<_, _>, _) = stale.into_iter().partition(|(_, by)| owner == Some(by.as_str()));
        self.0.extend(kept);
        gone.into_keys().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_owner_does_not_write_again_is_stale_and_nothing_else() {
        let mut list = List::default();
        assert!(list.replace(Some("report"), ["a", "b", "c"].into_iter()).is_empty());
        assert!(list.replace(Some("drift"), ["c", "d"].into_iter()).is_empty());
        assert!(list.replace(None, ["b", "e"].into_iter()).is_empty());
        assert_eq!(list.text(), "report\ta\nreport\tb\ndrift\tc\ndrift\td\n\te\n");
        assert_eq!(list.replace(Some("report"), ["a"].into_iter()), ["b"]);
        assert_eq!(list.text(), "report\ta\ndrift\tc\ndrift\td\n\te\n");
    }
}
