// A glass over each picture shows the place at which one of them is pointed, or moved to with the arrow keys.
const seen = [...document.querySelectorAll(".seen")];
const ZOOM = 4;
function show(x, y) {
  for (const part of seen) {
    const picture = part.querySelector("img"), glass = part.querySelector(".glass");
    const { width, height } = picture.getBoundingClientRect();
    if (!glass.style.backgroundImage) glass.style.backgroundImage = `url("${picture.src}")`;
    const half = glass.offsetWidth / 2;
    glass.style.backgroundSize = `${width * ZOOM}px ${height * ZOOM}px`;
    glass.style.backgroundPosition = `${half - x * width * ZOOM}px ${half - y * height * ZOOM}px`;
    glass.style.left = `${x * width}px`;
    glass.style.top = `${y * height}px`;
  }
  document.body.classList.add("looking");
}
function hide() {
  document.body.classList.remove("looking");
}
for (const part of seen) {
  let x = 0.5, y = 0.5;
  const keep = (value) => Math.min(1, Math.max(0, value));
  part.addEventListener("pointermove", (event) => {
    const box = part.querySelector("img").getBoundingClientRect();
    x = keep((event.clientX - box.left) / box.width);
    y = keep((event.clientY - box.top) / box.height);
    show(x, y);
  });
  part.addEventListener("pointerleave", hide);
  part.addEventListener("focus", () => part.matches(":focus-visible") && show(x, y));
  part.addEventListener("blur", hide);
  part.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (event.key === "Escape") hide();
    if (!step) return;
    event.preventDefault();
    x = keep(x + step[0] / 64);
    y = keep(y + step[1] / 64);
    show(x, y);
  });
}
