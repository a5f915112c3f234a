//! Colour where it is wanted: on a terminal, and not where NO_COLOR is set. All text is made with colour and stripped on
//! its way out.

use anstyle::{AnsiColor, Style};
use reports::Verdict;

/// Takes the choice of `--color` for all that is printed, help and errors about the flags included.
pub(super) fn choose(arguments: &[String]) {
    use anstream::ColorChoice::{Always, Auto, Never};
    let value = |(i, argument): (usize, &String)| match argument.strip_prefix("--color") {
        Some("") => arguments.get(i + 1).cloned(),
        Some(rest) => rest.strip_prefix('=').map(str::to_owned),
        None => None,
    };
    let choice = match arguments.iter().enumerate().find_map(value).as_deref() {
        Some("always") => Always,
        Some("never") => Never,
        _ => Auto,
    };
    choice.write_global();
}

/// The word that opens an error.
pub(super) const ERROR: Style = AnsiColor::Red.on_default().bold();

/// The verdicts in a text for a terminal in their colours.
pub(crate) fn painted(text: &str) -> String {
    let marks = [
        (Verdict::Holds, AnsiColor::Green),
        (Verdict::Broken, AnsiColor::Red),
        (Verdict::NotTested, AnsiColor::Yellow),
    ];
    marks.into_iter().fold(text.to_owned(), |text, (verdict, color)| {
        let (mark, style) = (format!("{} {verdict}", verdict.sign()), color.on_default());
        text.replace(&mark, &format!("{style}{mark}{style:#}"))
    })
}
