// The address: a run, as #run=law/initial state/a, or a place of the page, which opens if it is folded.
function follow() {
  const address = location.hash.slice(1);
  if (!runs || (address && !address.startsWith("run="))) openPlace(byId(decodeURIComponent(address)));
  // An address that is older than the last choice of the reader does not undo it.
  else if (!picked.timer && pickFrom(address.slice("run=".length))) {
    // All of it is shown, or its top in a small window.
    const panel = byId("run");
    panel.scrollIntoView({ block: panel.offsetHeight > window.innerHeight ? "start" : "nearest" });
  }
}

/** Open all folds around an element and its own, and show it. */
function openPlace(place) {
  if (!place) return;
  showClaim(place);
  const own = place.querySelector(":scope > details");
  if (own) own.open = true;
  for (let fold = place.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
  place.scrollIntoView();
}

function startAddress() {
  window.addEventListener("hashchange", follow);
  // A link to the place that the address has already opens it again.
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a[href^='#']");
    if (link && !event.defaultPrevented && link.hash === location.hash) follow();
  });
  if (runs) pick(...runs.first);
  if (location.hash) follow();
}
