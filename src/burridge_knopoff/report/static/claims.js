// Statements: shown by verdict, and with their details open if a link leads to them.
const shown = { verdict: "", independent: false };

function showClaims() {
  const rows = [...document.querySelectorAll(".verdicts tr[data-verdict]")];
  for (const row of rows)
    row.hidden = (shown.verdict && row.dataset.verdict !== shown.verdict) || (shown.independent && "dependent" in row.dataset);
  for (const body of document.querySelectorAll(".verdicts tbody")) {
    const claims = [...body.querySelectorAll("tr[data-verdict]")];
    if (claims.length) body.hidden = claims.every((row) => row.hidden);
  }
  const count = rows.filter((row) => row.id && !row.hidden).length;
  byId("shown-count").textContent = shown.verdict || shown.independent ? `${count} shown` : "";
  document.querySelectorAll("[data-shows]").forEach((button) => {
    const pressed = button.dataset.shows === shown.verdict;
    button.setAttribute("aria-pressed", pressed);
    button.textContent = pressed ? "Show all" : "Show only";
  });
}

/** Open the details of the statement to which the address leads, which no filter may hide. */
function openLinked() {
  const name = location.hash.startsWith("#claim-") ? location.hash.slice("#claim-".length) : "";
  const row = name && byId(`claim-${name}`);
  if (!row) return;
  if (row.hidden) {
    Object.assign(shown, { verdict: "", independent: false });
    byId("independent-only").checked = false;
    showClaims();
  }
  const details = document.querySelector(`.claim-more[data-claim="${CSS.escape(name)}"]`) ?? row.closest("details");
  if (details) details.open = true;
  row.scrollIntoView();
}

function startClaims() {
  if (!byId("independent-only")) return;
  byId("independent-only").addEventListener("change", (event) => { shown.independent = event.target.checked; showClaims(); });
  document.querySelectorAll("[data-shows]").forEach((button) => button.addEventListener("click", () => {
    shown.verdict = button.dataset.shows === shown.verdict ? "" : button.dataset.shows;
    showClaims();
  }));
  window.addEventListener("hashchange", openLinked);
  openLinked();
}
