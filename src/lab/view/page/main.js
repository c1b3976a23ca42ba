// The page: follows the events of its tab, sends it settings, and hands what it knows to its parts.
import { SIDES, find, short } from "./dom.js";
import { Commands } from "./commands.js";
import { Menus } from "./menus.js";
import { Picture } from "./picture.js";
import { Pictures } from "./pictures.js";
import { followPointer } from "./pointer.js";
import { PixelPanel } from "./pixel.js";
import { drawChart } from "./chart.js";

const random = crypto.getRandomValues(new Uint32Array(4));
const tab = [...random].map((word) => word.toString(16).padStart(8, "0")).join("");
const address = (path, side, more = "") => `${path}?tab=${tab}&side=${SIDES[side]}${more}`;

/** Between two changes of the address, of which browsers take some seven a second, in milliseconds. */
const REST = 200;
/** For how long settings wait for the first picture of those before them, in milliseconds: one sees what each step does while
 *  a slider moves, and what takes longer makes way. */
const PATIENCE = 1000;
/** After a refusal, before events are asked for again, in milliseconds. */
const AGAIN = 2000;

let state = null;
const picture = new Picture(find("picture"), find("wipe"), find("zoom"));
const panel = new PixelPanel(find("pixel-told"), find("pixel-title"), (side, [x, y]) => address("pixel", side, `&x=${x}&y=${y}`));
const commands = new Commands(find("commands"), address);
const pictures = new Pictures(address, (side, image, key) => {
  if (side === 0) frame(image.width, image.height);
  picture.setImage(side, image);
  find("picture").dataset[SIDES[side]] = key;
});
followPointer(picture, find("stage"));
picture.onpixel = () => panel.show(state, picture);

/** Gives the stage the shape of a picture. */
function frame(width, height) {
  find("stage").style.aspectRatio = width / height;
  picture.setFrame(width, height);
}

/** Waits until a film of a side has a picture, or will have none. */
async function seen(side, number) {
  const isDue = () => state?.sides[side].number < number || (state?.sides[side].number === number && state.sides[side].spp === null && !state.sides[side].failure);
  const end = performance.now() + PATIENCE;
  while (isDue() && performance.now() < end) await new Promise((done) => { setTimeout(done, 15); });
}

/** Sends a side's settings; of those that come while others are on their way, the newest. */
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
      const { error, number } = answer.ok ? await answer.json() : { error: `the program answered ${answer.status}` };
      complaint.textContent = error ? `${SIDES[side].toUpperCase()}: ${error}` : "";
      if (!error) await seen(side, number);
    } catch {
      complaint.textContent = "the program does not answer";
    }
    if (sending[side] === now) break;
  }
  sending[side] = null;
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

function show(news) {
  state = news;
  pictures.follow(state);
  const [a, b] = state.sides;
  const isOne = a.number === b.number;
  find("state").textContent = isOne ? progress(0).replace("A:", "A and B:") : `${progress(0)}; ${progress(1)}`;
  [a, b].forEach((side, i) => {
    const box = find(`error-${SIDES[i]}`);
    if (side.failure) box.textContent = `${SIDES[i].toUpperCase()}: ${side.failure}`;
    else if (box.dataset.failure) box.textContent = "";
    box.dataset.failure = side.failure ?? "";
  });
  // Until the first picture is there; a later one brings its own shape.
  if (!picture.images[0]) frame(a.width, a.height);
  find("difference").textContent = difference(isOne);
  drawChart(find("chart"), isOne ? [a] : [a, b]);
  commands.show(state);
  panel.refresh(state, picture);
}

/** Says how far both films are from each other. */
function difference(isOne) {
  const [a, b] = state.sides;
  if (isOne) return a.display === b.display ? "" : "A and B are one film, shown in two ways";
  return state.difference === null ? "" : `A and B differ by an RMSE of ${short(state.difference, 3)} in linear light`;
}

/** When the address was changed last, and the change that waits. */
let keptAt = -Infinity;
let keeping = null;

/** Keeps the settings in the address, so that a reload or a bookmark has them; not as often as a slider moves. */
function keep(menus) {
  clearTimeout(keeping);
  const early = keptAt + REST - performance.now();
  if (early > 0) {
    keeping = setTimeout(() => keep(menus), early);
    return;
  }
  keptAt = performance.now();
  const both = [0, 1].map((side) => menus.settings(side));
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify(both))}`);
}

function kept() {
  try {
    const both = JSON.parse(decodeURIComponent(location.hash.slice(1)));
    const isOwn = (own) => typeof own.options === "object" && own.options && Array.isArray(own.set);
    return both.length === 2 && both.every(isOwn) ? both : null;
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
}, async () => {
  keep(menus);
  // Films change places as they are; settings that were on their way come after it.
  await fetch(`swap?tab=${tab}`, { method: "POST", body: "" }).catch(() => {});
  SIDES.forEach((_, side) => send(side, menus.settings(side)));
});
kept()?.forEach((settings, side) => menus.apply(side, settings));

/** Follows the events of the tab; tells why where the program refuses them, and tries again. */
function follow() {
  const events = new EventSource(`events?tab=${tab}`);
  const end = () => events.close();
  addEventListener("pagehide", end);
  events.addEventListener("open", () => SIDES.forEach((_, side) => send(side, menus.settings(side))));
  events.addEventListener("message", (event) => show(JSON.parse(event.data)));
  events.addEventListener("error", async () => {
    find("state").textContent = "the program does not answer; trying again …";
    // A browser tries again by itself, but not after a refusal.
    if (events.readyState !== EventSource.CLOSED) return;
    removeEventListener("pagehide", end);
    const why = await refusal();
    if (why) find("state").textContent = why;
    setTimeout(follow, AGAIN);
  });
}

/** Returns what the program says instead of events. */
async function refusal() {
  const control = new AbortController();
  try {
    const answer = await fetch(`events?tab=${tab}`, { signal: control.signal });
    if (!answer.ok) return (await answer.text()).trim();
  } catch {
    // It does not answer at all.
  } finally {
    control.abort();
  }
  return "";
}

follow();
