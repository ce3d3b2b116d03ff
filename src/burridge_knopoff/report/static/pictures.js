// A figure at its full size, over the page.
function openPicture(event) {
  const name = event.currentTarget.dataset.picture;
  const source = document.querySelector(`#figure-${CSS.escape(name)} img`);
  const viewer = byId("viewer");
  if (!source || !viewer.showModal) return;
  event.preventDefault();
  byId("viewer-title").textContent = source.closest("figure").querySelector("figcaption strong").textContent;
  byId("viewer-picture").replaceChildren(element("img", { src: source.src, alt: source.alt }));
  byId("viewer-pdf").href = `figures/${name}.pdf`;
  viewer.showModal();
}

function startPictures() {
  document.querySelectorAll(".opens-picture, .picture img").forEach((link) => link.addEventListener("click", openPicture));
  const viewer = byId("viewer");
  byId("viewer-close").addEventListener("click", () => viewer.close());
  viewer.addEventListener("click", (event) => { if (event.target === viewer) viewer.close(); });
}
