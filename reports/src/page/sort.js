// Sorts a table by a column: numbers as numbers, what is empty last, everything else as text.
(() => {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  const number = text => {
    let plain = text.trim().replace(/−/g, "-");
    plain = plain.replace(/(?:([\d.]+)\s*[×·]\s*|(^|-))10(⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)/, (_, mantissa, sign, power) =>
      (mantissa ?? (sign ?? "") + "1") + "e" + [...power].map(c => c === "⁻" ? "-" : digits.indexOf(c)).join(""));
    return /^[-+]?(\d|\.\d|inf)/i.test(plain) ? (/^[-+]?inf/i.test(plain) ? (plain[0] === "-" ? -Infinity : Infinity) : parseFloat(plain)) : NaN;
  };
  const order = (a, b) => {
    if (!a || !b) return (a ? 0 : 1) - (b ? 0 : 1);
    const x = number(a), y = number(b);
    if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y) || a.localeCompare(b);
    return x === y ? 0 : x < y ? -1 : 1;
  };
  for (const table of document.querySelectorAll("table.sortable")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending";
        heads.forEach(other => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        const text = row => row.cells[column].textContent.trim();
        const rows = [...table.tBodies[0].rows].sort((r, s) => {
          const [a, b] = [text(r), text(s)];
          return a && b && down ? order(b, a) : order(a, b);
        });
        table.tBodies[0].append(...rows);
      });
    });
  }
})();
