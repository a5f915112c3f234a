//! A table on a page.

use maud::{Markup, html};

use crate::table::{Align, Table, cell};

impl Table {
    /// An HTML table with a caption; a page's script makes its columns sortable.
    pub fn to_html(&self, caption: &str) -> String {
        self.markup(caption).into_string()
    }

    pub(crate) fn markup(&self, caption: &str) -> Markup {
        // A class for the table instead of one for every cell: `r3` sets the third column to the right.
        let numbers = (0..self.columns()).filter(|&c| self.align(c) == Align::Right);
        let class = numbers.fold("sortable".to_owned(), |class, c| format!("{class} r{}", c + 1));
        html! {
            table class=(class) {
                @if !caption.is_empty() { caption { (caption) } }
                thead { tr { @for c in 0..self.columns() { th scope="col" { (cell(&self.headers, c)) } } } }
                tbody {
                    @for row in &self.rows { tr { @for c in 0..self.columns() { td { (cell(row, c)) } } } }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::new(&["method", "order"], &["order"]);
        table.push(["Störmer–Verlet, θ̇", "2"]);
        table.push(["a|b <i>", "−10⁻³"]);
        table.push(["short"]);
        table
    }

    #[test]
    fn html_escapes_markup_and_marks_numbers() {
        let html = table().to_html("Orders & more");
        assert!(
            html.contains("<caption>Orders &amp; more</caption>") && html.contains("<td>a|b &lt;i&gt;</td>"),
            "{html}"
        );
        assert!(html.starts_with("<table class=\"sortable r2\">") && !html.contains("<i>"), "{html}");
    }
}
