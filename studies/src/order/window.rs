//! The search for the window of steps that show the order.
