//! Shared helpers of the tests. The tests themselves are the files of `tests/tests/`.
