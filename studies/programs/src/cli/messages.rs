//! What a program says: results on standard output, errors on standard error, all of these as `error: place: message; remedy`.

use std::error::Error as _;
use std::io::Write;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::color;
use measure::error::Error;

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

/// What the parser of the flags knows of an error.
fn context(error: &clap::Error, kind: ContextKind) -> String {
    match error.get(kind) {
        Some(ContextValue::String(text)) => text.clone(),
        Some(ContextValue::Strings(texts)) => texts.join(", "),
        _ => String::new(),
    }
}

/// The name that was perhaps meant, as a question.
fn meant(error: &clap::Error, kind: ContextKind) -> String {
    let name = context(error, kind);
    if name.is_empty() { name } else { format!("did you mean '{name}'? ") }
}

const HELP: &str = "--help shows what there is";

/// What the parser of the flags found wrong.
pub(super) fn of_flags(error: &clap::Error) -> Error {
    use ContextKind as Kind;
    let (flags, value) = (context(error, Kind::InvalidArg), context(error, Kind::InvalidValue));
    // `--steps <N,N,..>`: the flag is its first word.
    let flag = flags.split_whitespace().next().unwrap_or("arguments");
    let no_such = |kind| format!("no such flag or command; {}{HELP}", meant(error, kind));
    let (place, message) = match error.kind() {
        ErrorKind::ValueValidation => {
            let reason = error.source().map_or_else(|| format!("not allowed; {HELP}"), ToString::to_string);
            (format!("{flag} '{value}'"), reason)
        }
        ErrorKind::InvalidValue if value.is_empty() => (flag.to_owned(), format!("its value is missing; {HELP}")),
        ErrorKind::InvalidValue => {
            let (meant, values) = (meant(error, Kind::SuggestedValue), context(error, Kind::ValidValue));
            (format!("{flag} '{value}'"), format!("not one of its values; {meant}give {values}"))
        }
        ErrorKind::UnknownArgument => (flag.to_owned(), no_such(Kind::SuggestedArg)),
        ErrorKind::InvalidSubcommand => (context(error, Kind::InvalidSubcommand), no_such(Kind::SuggestedSubcommand)),
        ErrorKind::ArgumentConflict => {
            let other = context(error, Kind::PriorArg);
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
