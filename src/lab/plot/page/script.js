// Entries of a plot's key switch their series off and on, by pointer or keyboard, in all plots at once.
for (const svg of document.querySelectorAll("svg.plot")) svg.setAttribute("role", "group");
const keys = document.querySelectorAll("svg .key");
function toggle(name) {
  const on = !toggle.off.delete(name);
  if (on) toggle.off.add(name);
  for (const part of document.querySelectorAll("svg .series"))
    if (part.dataset.series === name) part.classList.toggle("off", on);
  for (const key of keys) if (key.dataset.series === name) key.setAttribute("aria-pressed", String(!on));
}
toggle.off = new Set();
for (const key of keys) {
  key.setAttribute("tabindex", "0");
  key.setAttribute("role", "button");
  key.setAttribute("aria-pressed", "true");
  key.setAttribute("aria-label", "show " + key.dataset.series);
  key.style.cursor = "pointer";
  key.addEventListener("click", () => toggle(key.dataset.series));
  key.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    toggle(key.dataset.series);
  });
}
