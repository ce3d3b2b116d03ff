// Statements: shown by verdict, and all of them if a link leads to one that is hidden.
let shownVerdict = "";

/** Hide what is not chosen; the style sheet hides the statements that depend on others. */
function showClaims() {
  document.querySelectorAll("[data-verdict]").forEach((card) => {
    card.hidden = Boolean(shownVerdict) && card.dataset.verdict !== shownVerdict;
  });
  const shown = `[data-verdict]:not([hidden]${byId("independent-only").checked ? ", [data-dependent]" : ""})`;
  document.querySelectorAll(".topic").forEach((topic) => { topic.hidden = !topic.querySelector(shown); });
  byId("shown-count").textContent = shownVerdict ? `${document.querySelectorAll(shown).length} shown` : "";
  document.querySelectorAll("[data-shows]").forEach((button) =>
    button.setAttribute("aria-pressed", button.dataset.shows === shownVerdict));
}

/** Show the statements with one verdict in open topics, or those with any in closed ones. */
function chooseVerdict(verdict) {
  shownVerdict = verdict;
  document.querySelectorAll(".topic").forEach((topic) => { topic.open = Boolean(verdict); });
  showClaims();
}

/** Show all statements if this one is hidden. */
function showClaim(place) {
  if (!("verdict" in place.dataset)) return;
  if ("dependent" in place.dataset) byId("independent-only").checked = false;
  if (place.hidden) chooseVerdict("");
  else showClaims();
}

function startClaims() {
  byId("independent-only")?.addEventListener("change", showClaims);
  document.querySelectorAll("[data-shows]").forEach((button) => button.addEventListener("click", () =>
    chooseVerdict(button.dataset.shows === shownVerdict ? "" : button.dataset.shows)));
}
