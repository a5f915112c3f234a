//! The integrator in a web page: a question as text goes in, numbers come out.
//!
//! A question is lines of `key value`, the first a command ([`question`]); what is named is named as in the report's tables.
//! The page writes it where [`input`] says, calls [`ask`], and reads the numbers at [`numbers`] or the message at [`message`].
//! The same code compiled for the machine at hand answers the same bits: that is what the tests hold the module to.
//!
//! Architecture invariant: no physics and no method here, only `studies`' scenes and runs.

pub mod answer;
mod loops;
pub mod question;

use std::cell::RefCell;

use answer::Desk;

/// What the page and the module hand each other.
#[derive(Default)]
struct Exchange {
    desk: Desk,
    input: Vec<u8>,
    numbers: Vec<f64>,
    message: String,
}

thread_local! {
    // A page runs the module on one thread; the tests ask through `Desk`.
    static EXCHANGE: RefCell<Exchange> = RefCell::default();
}

/// Where to write a question of that many bytes.
#[allow(unsafe_code)]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn input(length: usize) -> *mut u8 {
    EXCHANGE.with_borrow_mut(|exchange| {
        exchange.input.resize(length, 0);
        exchange.input.as_mut_ptr()
    })
}

/// Answers the question: how many numbers there are, or -1 and a message.
#[allow(unsafe_code)]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn ask() -> i32 {
    EXCHANGE.with_borrow_mut(|exchange| {
        let text = String::from_utf8_lossy(&exchange.input);
        exchange.message.clear();
        match exchange.desk.answer(&text, &mut exchange.message) {
            Ok(numbers) => exchange.numbers = numbers,
            Err(error) => {
                exchange.message = error.to_string();
                return -1;
            }
        }
        i32::try_from(exchange.numbers.len()).unwrap_or(-1)
    })
}

/// The numbers of the answer.
#[allow(unsafe_code)]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn numbers() -> *const f64 {
    EXCHANGE.with_borrow(|exchange| exchange.numbers.as_ptr())
}

/// The text of the answer: what the numbers are, or what was wrong.
#[allow(unsafe_code)]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn message() -> *const u8 {
    EXCHANGE.with_borrow(|exchange| exchange.message.as_ptr())
}

/// Its bytes.
#[allow(unsafe_code)]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn message_length() -> usize {
    EXCHANGE.with_borrow(|exchange| exchange.message.len())
}
