//! What a program says: results on standard output, errors on standard error, all of these as `error: place: message; remedy`.

use std::error::Error as _;
use std::io::Write;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::color;
use crate::error::Error;

/// Prints to stdout. A reader that has gone away (`| head`) is no error; a disk that is full is one.
///
/// # Errors
/// Standard output that cannot be written.
pub fn print(text: &str) -> Result<(), Error> {
    let mut stdout = anstream::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            let message = format!("cannot be written: {error}; free some space, or send it elsewhere");
            Err(Error::plan("standard output", message))
        }
        _ => Ok(()),
    }
}

/// A line on stderr. Nobody is left to be told where standard error is closed too.
pub(super) fn note(text: &str) {
    let _ = writeln!(anstream::stderr(), "{text}");
}

pub(super) fn complain(error: &Error) {
    let style = color::ERROR;
    note(&format!("{style}error:{style:#} {error}"));
}

/// What the parser of the flags found wrong.
pub(super) fn of_flags(error: &clap::Error) -> Error {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.clone(),
        Some(ContextValue::Strings(texts)) => texts.join(", "),
        _ => String::new(),
    };
    let flag = text(ContextKind::InvalidArg);
    // `--steps <N,N,..>`: the flag is its first word.
    let flag = flag.split_whitespace().next().unwrap_or("arguments");
    let value = text(ContextKind::InvalidValue);
    let near =
        |kind| Some(text(kind)).filter(|t| !t.is_empty()).map_or_else(String::new, |t| format!("did you mean '{t}'? "));
    const HELP: &str = "--help shows what there is";
    let (place, message) = match error.kind() {
        ErrorKind::ValueValidation => {
            let reason = error.source().map_or_else(|| "not allowed; see --help".to_owned(), ToString::to_string);
            (format!("{flag} '{value}'"), reason)
        }
        ErrorKind::InvalidValue if value.is_empty() => (flag.to_owned(), format!("its value is missing; {HELP}")),
        ErrorKind::InvalidValue => {
            let message = format!(
                "not one of its values; {}give {}",
                near(ContextKind::SuggestedValue),
                text(ContextKind::ValidValue)
            );
            (format!("{flag} '{value}'"), message)
        }
        ErrorKind::UnknownArgument => {
            (flag.to_owned(), format!("no such flag or command; {}{HELP}", near(ContextKind::SuggestedArg)))
        }
        ErrorKind::InvalidSubcommand => {
            let name = text(ContextKind::InvalidSubcommand);
            (name, format!("no such flag or command; {}{HELP}", near(ContextKind::SuggestedSubcommand)))
        }
        ErrorKind::ArgumentConflict => {
            let other = text(ContextKind::PriorArg);
            let other = other.split_whitespace().next().unwrap_or("the others");
            (flag.to_owned(), format!("cannot stand beside {other}; leave one of them out"))
        }
        ErrorKind::MissingRequiredArgument => (flag.to_owned(), format!("is missing; {HELP}")),
        _ => {
            let said = error.to_string();
            let line = said.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
            (flag.to_owned(), format!("{line}; {HELP}"))
        }
    };
    Error::plan(place, message)
}
