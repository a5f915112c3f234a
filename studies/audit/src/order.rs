//! Several files of one motion with different steps: how their errors fall.

use serde::Serialize;

use crate::judge::FileReport;

/// The error of one quantity in several files.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Order {
    /// The quantity.
    pub quantity: &'static str,
    /// Steps of the files, largest first, s.
    pub h_s: Vec<f64>,
    /// Largest errors.
    pub error: Vec<f64>,
    /// p of error ~ h^p between neighbouring files.
    pub order: Vec<f64>,
}

impl Order {
    /// For the terminal.
    pub fn line(&self) -> String {
        let orders: Vec<String> = self.order.iter().map(|p| format!("{p:.2}")).collect();
        let errors: Vec<String> = self.error.iter().map(|e| format!("{e:.3e}")).collect();
        format!("order of the {}: {} (errors {})", self.quantity, orders.join(", "), errors.join(", "))
    }
}

/// Orders of all quantities that at least two files with different steps have an error of.
pub fn orders(files: &[FileReport]) -> Vec<Order> {
    let step = |f: &FileReport| f.step.first().map_or(f.time.interval_s, |s| s.candidates[0].h_s);
    let quantities = ["position", "velocity", "attitude", "angular-velocity", "angle", "angle-rate"];
    let of = |quantity: &'static str| {
        let error = |f: &FileReport| f.error.iter().find(|e| e.quantity == quantity).map(|e| (step(f), e.max));
        let mut all: Vec<(f64, f64)> = files.iter().filter_map(error).filter(|(_, e)| *e > 0.0).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.dedup_by(|a, b| (a.0 / b.0 - 1.0).abs() < 1e-6);
        let order: Vec<f64> = all.windows(2).map(|w| (w[0].1 / w[1].1).ln() / (w[0].0 / w[1].0).ln()).collect();
        let (h_s, error) = all.into_iter().unzip();
        (!order.is_empty()).then_some(Order { quantity, h_s, error, order })
    };
    quantities.into_iter().filter_map(of).collect()
}
