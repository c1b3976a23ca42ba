// The page: follows the events of its tab, fetches pictures as they refine, and hands what it knows to its parts.
import { SIDES, element, find, short } from "./dom.js";
import { Menus } from "./menus.js";
import { Picture } from "./picture.js";
import { followPointer } from "./pointer.js";
import { PixelPanel } from "./pixel.js";
import { drawChart } from "./chart.js";

const random = crypto.getRandomValues(new Uint32Array(4));
const tab = [...random].map((word) => word.toString(16).padStart(8, "0")).join("");
const address = (path, side, more = "") => `${path}?tab=${tab}&side=${SIDES[side]}${more}`;

let state = null;
const shown = [null, null];
const picture = new Picture(find("picture"), find("wipe"), find("zoom"));
const panel = new PixelPanel(find("pixel-told"), find("pixel-title"), (side, [x, y]) => address("pixel", side, `&x=${x}&y=${y}`));
followPointer(picture, find("stage"));
picture.onpixel = () => panel.show(state, picture);

/** Sends a side's settings; the newest while another is on its way. */
const sending = [null, null];
async function send(side, settings) {
  const isFirst = sending[side] === null;
  sending[side] = settings;
  if (!isFirst) return;
  while (sending[side]) {
    const now = sending[side];
    const complaint = find(`error-${SIDES[side]}`);
    try {
      const answer = await fetch(address("set", side), { method: "POST", body: JSON.stringify(now) });
      const { error } = answer.ok ? await answer.json() : { error: `the program answered ${answer.status}` };
      complaint.textContent = error ? `${SIDES[side].toUpperCase()}: ${error}` : "";
    } catch {
      complaint.textContent = "the program does not answer";
    }
    if (sending[side] === now) break;
  }
  sending[side] = null;
}

/** Fetches the pictures that are new. */
async function fetchPicture(side) {
  const { number, spp } = state.sides[side];
  const key = `${number}/${spp}`;
  if (spp === null || shown[side] === key) return;
  // Both sides are one picture where their settings are equal.
  shown[side] = key;
  const answer = await fetch(address("picture", side, `&of=${number}&spp=${spp}`));
  if (shown[side] !== key) return;
  if (answer.status !== 200) {
    shown[side] = null;
    return;
  }
  const blob = await answer.blob();
  const image = await createImageBitmap(blob);
  if (shown[side] !== key) return;
  picture.setImage(side, image);
  find("picture").dataset[SIDES[side]] = `${key}/${blob.size}`;
}

/** Says how far a side is. */
function progress(side) {
  const { spp, next, last, failure, points } = state.sides[side];
  const name = SIDES[side].toUpperCase();
  if (failure) return `${name}: failed`;
  if (spp === null) return `${name}: loading …`;
  const mean = points[points.length - 1].samples;
  const samples = mean === spp ? `${spp}` : `${short(mean, 3)} of ${spp}`;
  return next === null ? `${name}: ${samples} spp, done` : `${name}: ${samples} spp, then ${next} (up to ${last})`;
}

/** Shows the commands that render the same pictures, their files and warnings. */
function showCommands() {
  const sides = state.sides[0].number === state.sides[1].number ? [0] : [0, 1];
  const box = find("commands");
  const made = sides.filter((side) => state.sides[side].command).map((side) => {
    const { command, warnings, spp, number } = state.sides[side];
    const name = sides.length === 1 ? "A and B" : SIDES[side].toUpperCase();
    const copy = element("button", { type: "button", "aria-label": `Copy the command of ${name}` }, "Copy");
    copy.addEventListener("click", () => copyText(copy, command));
    const save = element("a", { href: address("picture", side, `&of=${number}&spp=${spp}`), download: `${SIDES[side]}-${spp}.png` }, "PNG");
    const list = element("ul", { class: "warnings" }, ...warnings.map((text) => element("li", {}, text)));
    return element("div", { class: "command" },
      element("strong", { class: `key ${SIDES[side]}` }, name),
      element("code", { class: "line" }, command),
      copy, " ", save, ...(warnings.length ? [list] : []));
  });
  const text = JSON.stringify(sides.map((side) => [state.sides[side].command, state.sides[side].warnings]));
  if (box.dataset.text === text) return;
  box.dataset.text = text;
  box.replaceChildren(...made);
}

async function copyText(button, text) {
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    // Without the right to the clipboard the text is marked, for the keys of the browser.
    getSelection().selectAllChildren(button.parentElement.querySelector("code"));
    button.textContent = "Marked";
  }
  setTimeout(() => { button.textContent = "Copy"; }, 1500);
}

function show(news) {
  state = news;
  SIDES.forEach((_, side) => fetchPicture(side).catch(() => { shown[side] = null; }));
  const [a, b] = state.sides;
  const isOne = a.number === b.number;
  find("state").textContent = isOne ? progress(0).replace("A:", "A and B:") : `${progress(0)}; ${progress(1)}`;
  [a, b].forEach((side, i) => {
    const box = find(`error-${SIDES[i]}`);
    if (side.failure) box.textContent = `${SIDES[i].toUpperCase()}: ${side.failure}`;
    else if (box.dataset.failure) box.textContent = "";
    box.dataset.failure = side.failure ?? "";
  });
  find("stage").style.aspectRatio = a.width / a.height;
  picture.setFrame(a.width, a.height);
  find("difference").textContent = state.difference === null ? "" : `A and B differ by an RMSE of ${short(state.difference, 3)}`;
  drawChart(find("chart"), isOne ? [a] : [a, b]);
  showCommands();
  panel.refresh(state, picture);
}

/** Keeps the settings in the address, so that a reload or a bookmark has them. */
function keep(menus) {
  const both = [0, 1].map((side) => menus.settings(side));
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify(both))}`);
}

function kept() {
  try {
    const both = JSON.parse(decodeURIComponent(location.hash.slice(1)));
    return both.length === 2 && both.every((own) => own.options && own.set) ? both : null;
  } catch {
    return null;
  }
}

const page = await (await fetch("page")).json();
document.title = `${page.scene} – moire view`;
find("scene").textContent = `${page.scene} on ${page.device}`;
const menus = new Menus(page, (side) => {
  keep(menus);
  return send(side, menus.settings(side));
});
kept()?.forEach((settings, side) => menus.apply(side, settings));

const events = new EventSource(`events?tab=${tab}`);
events.addEventListener("open", () => [0, 1].forEach((side) => send(side, menus.settings(side))));
events.addEventListener("message", (event) => show(JSON.parse(event.data)));
events.addEventListener("error", () => { find("state").textContent = "the program does not answer; trying again …"; });
addEventListener("pagehide", () => events.close());
