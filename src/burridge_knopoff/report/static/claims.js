// Statements: shown by verdict, and all of them if a link leads to one that is hidden.
const shown = { verdict: "", independent: false };

function showClaims() {
  const chosen = Boolean(shown.verdict || shown.independent);
  const cards = [...document.querySelectorAll("[data-verdict]")];
  for (const card of cards)
    card.hidden = Boolean(shown.verdict && card.dataset.verdict !== shown.verdict) || (shown.independent && "dependent" in card.dataset);
  for (const topic of document.querySelectorAll(".topic")) {
    topic.hidden = [...topic.querySelectorAll("[data-verdict]")].every((card) => card.hidden);
    topic.open = chosen;
  }
  byId("shown-count").textContent = chosen ? `${cards.filter((card) => !card.hidden).length} shown` : "";
  document.querySelectorAll("[data-shows]").forEach((button) =>
    button.setAttribute("aria-pressed", button.dataset.shows === shown.verdict));
}

/** Show all statements if this one is hidden. */
function showClaim(place) {
  if (!place.hidden || !("verdict" in place.dataset)) return;
  Object.assign(shown, { verdict: "", independent: false });
  byId("independent-only").checked = false;
  showClaims();
}

function startClaims() {
  if (!byId("independent-only")) return;
  byId("independent-only").addEventListener("change", (event) => { shown.independent = event.target.checked; showClaims(); });
  document.querySelectorAll("[data-shows]").forEach((button) => button.addEventListener("click", () => {
    shown.verdict = button.dataset.shows === shown.verdict ? "" : button.dataset.shows;
    showClaims();
  }));
}
