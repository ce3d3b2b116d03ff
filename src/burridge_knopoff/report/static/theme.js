// Light, dark, or what the system says; charts take their colours from here.
const darkSystem = window.matchMedia("(prefers-color-scheme: dark)");
const memory = {
  get: () => { try { return localStorage.getItem("theme"); } catch { return null; } },
  set: (value) => { try { localStorage.setItem("theme", value); } catch { /* A file need not have a memory. */ } },
};
let theme = "auto";

const isDark = () => theme === "dark" || (theme === "auto" && darkSystem.matches);

/** Return the value of a colour of the style sheet. */
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

const channels = (color) => [1, 3, 5].map((n) => parseInt(color.slice(n, n + 2), 16));

function luminance(color) {
  const [red, green, blue] = channels(color).map((part) => {
    const share = part / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/** Return a colour of the figures, in the dark theme lightened until it stands out from the background. */
function hue(color) {
  if (!isDark()) return color;
  const behind = luminance(ink("background"));
  for (let share = 0; share < 1; share += 0.05) {
    const mixed = "#" + channels(color).map((part) => Math.round(part + share * (255 - part)).toString(16).padStart(2, "0")).join("");
    if ((luminance(mixed) + 0.05) / (behind + 0.05) >= 3) return mixed;
  }
  return "#ffffff";
}

/** Return a colour #rrggbb with an opacity. */
const translucent = (color, opacity) => `rgba(${channels(color).join(",")},${opacity})`;

const themeListeners = [];

function setTheme(value) {
  theme = ["light", "dark"].includes(value) ? value : "auto";
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  document.querySelector(`input[name="theme"][value="${theme}"]`).checked = true;
  themeListeners.forEach((listener) => listener());
}

function startTheme() {
  setTheme(memory.get());
  darkSystem.addEventListener("change", () => { if (theme === "auto") setTheme("auto"); });
  document.querySelectorAll('input[name="theme"]').forEach((input) =>
    input.addEventListener("change", () => { memory.set(input.value); setTheme(input.value); }));
}
