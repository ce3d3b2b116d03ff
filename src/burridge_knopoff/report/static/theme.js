// Light, dark, or what the system says.
const darkSystem = window.matchMedia("(prefers-color-scheme: dark)");
const memory = {
  get: () => { try { return localStorage.getItem("theme"); } catch { return null; } },
  set: (value) => { try { localStorage.setItem("theme", value); } catch { /* A file need not have a memory. */ } },
};
let theme = "auto";

const isDark = () => theme === "dark" || (theme === "auto" && darkSystem.matches);

function setTheme(value) {
  theme = ["light", "dark"].includes(value) ? value : "auto";
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  document.querySelector(`input[name="theme"][value="${theme}"]`).checked = true;
  drawn.forEach(draw);
}

function startTheme() {
  setTheme(memory.get());
  darkSystem.addEventListener("change", () => { if (theme === "auto") setTheme("auto"); });
  document.querySelectorAll('input[name="theme"]').forEach((input) =>
    input.addEventListener("change", () => { memory.set(input.value); setTheme(input.value); }));
}
