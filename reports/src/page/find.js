
// Finds claims by words and verdict, over the whole page: while it does, nothing but the claims found is shown.
(() => {
  const form = document.getElementById("find");
  if (!form) return;
  const [words, verdict, count] = ["find-text", "find-verdict", "find-count"].map(id => document.getElementById(id));
  const groups = [...document.querySelectorAll("details.group")];
  let rows, before;
  const show = () => {
    rows ??= [...document.querySelectorAll(".claims tbody tr")].map(row => ({ row, text: (row.id + " " + row.textContent).toLowerCase(), verdict: row.lastElementChild.textContent.replace(/^\S+ /, "").trim() }));
    const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
    const finding = wanted.length > 0 || verdict.value !== "";
    if (finding) before ??= groups.map(group => group.open);
    document.body.classList.toggle("finding", finding);
    let found = 0;
    for (const one of rows) {
      const fits = (!verdict.value || one.verdict === verdict.value) && wanted.every(word => one.text.includes(word));
      one.row.hidden = finding && !fits;
      found += fits;
    }
    for (const part of document.querySelectorAll("section, details.group, .scroll:has(> .claims)"))
      part.hidden = finding && !part.querySelector(".claims tbody tr:not([hidden])");
    groups.forEach((group, i) => { if (finding) group.open = !group.hidden; else if (before) group.open = before[i]; });
    if (!finding) before = undefined;
    count.textContent = finding ? found + " of " + rows.length + " claims" : "";
  };
  let timer;
  const soon = () => { clearTimeout(timer); timer = setTimeout(show, 120); };
  words.addEventListener("input", soon);
  verdict.addEventListener("input", soon);
  form.addEventListener("submit", event => { event.preventDefault(); show(); });
  form.hidden = false;
})();
