// Error against time of both sides, both axes logarithmic, as SVG.
import { SIDES, drawn, short } from "./dom.js";

const WIDTH = 400;
const HEIGHT = 240;
const FRAME = { left: 52, right: 388, top: 12, bottom: 204 };

/** Returns the ends of a logarithmic axis around values, and the ticks between them. */
function axis(values) {
  const logs = values.map(Math.log10);
  let [low, high] = [Math.min(...logs), Math.max(...logs)];
  const middle = (low + high) / 2;
  [low, high] = [Math.min(low - 0.08, middle - 0.4), Math.max(high + 0.08, middle + 0.4)];
  const every = Math.max(1, Math.ceil((high - low) / 5));
  const factors = high - low < 1.6 ? [1, 2, 5] : [1];
  const ticks = [];
  for (let decade = Math.floor(low); decade <= high; decade += 1) {
    if (decade % every !== 0) continue;
    for (const factor of factors) {
      const at = decade + Math.log10(factor);
      if (at >= low && at <= high) ticks.push([at, factor * 10 ** decade]);
    }
  }
  return { low, high, ticks };
}

export function drawChart(box, sides) {
  const series = sides.map(({ points, spp }) => ({
    errors: points.filter((point) => point.rmse > 0 && point.seconds > 0).map((point) => [point.seconds, point.rmse, point.spp * 4 > spp, point.spp]),
    estimates: points.filter((point) => point.estimate > 0 && point.seconds > 0).map((point) => [point.seconds, point.estimate]),
  }));
  const all = series.flatMap((own) => [...own.errors, ...own.estimates]);
  const text = JSON.stringify(series);
  if (box.dataset.text === text) return;
  box.dataset.text = text;
  if (all.length === 0) {
    box.replaceChildren("Errors are known from the second picture on.");
    return;
  }
  const [across, up] = [axis(all.map(([seconds]) => seconds)), axis(all.map(([, error]) => error))];
  const x = (at) => FRAME.left + ((at - across.low) / (across.high - across.low)) * (FRAME.right - FRAME.left);
  const y = (at) => FRAME.bottom - ((at - up.low) / (up.high - up.low)) * (FRAME.bottom - FRAME.top);
  const label = (attributes, words) => drawn("text", attributes, words);
  const made = [drawn("title", {}, "RMSE over seconds of rendering")];
  for (const [at, value] of across.ticks) {
    made.push(drawn("line", { class: "axis", x1: x(at), x2: x(at), y1: FRAME.top, y2: FRAME.bottom }));
    made.push(label({ x: x(at), y: FRAME.bottom + 15, "text-anchor": "middle" }, short(value, 2)));
  }
  for (const [at, value] of up.ticks) {
    made.push(drawn("line", { class: "axis", x1: FRAME.left, x2: FRAME.right, y1: y(at), y2: y(at) }));
    made.push(label({ x: FRAME.left - 5, y: y(at) + 4, "text-anchor": "end" }, value < 0.001 ? value.toExponential(0) : short(value, 2)));
  }
  made.push(label({ x: (FRAME.left + FRAME.right) / 2, y: HEIGHT - 4, "text-anchor": "middle" }, "seconds of rendering"));
  made.push(label({ x: 12, y: 110, "text-anchor": "middle", transform: "rotate(-90 12 110)" }, "RMSE"));
  series.forEach(({ errors, estimates }, side) => {
    const path = (points) => points.map(([seconds, error], i) => `${i ? "L" : "M"}${x(Math.log10(seconds)).toFixed(1)} ${y(Math.log10(error)).toFixed(1)}`).join("");
    const name = SIDES[side];
    if (errors.length) made.push(drawn("path", { class: name, d: path(errors) }));
    if (estimates.length) made.push(drawn("path", { class: `${name} estimate`, d: path(estimates) }));
    for (const [seconds, error, isHollow, spp] of errors) {
      const [cx, cy] = [x(Math.log10(seconds)), y(Math.log10(error))];
      const kind = `${name}${isHollow ? " hollow" : ""}`;
      const title = drawn("title", {}, `${name.toUpperCase()}, ${spp} spp: RMSE ${short(error, 3)} in ${short(seconds, 3)} s`);
      made.push(side === 0
        ? drawn("circle", { class: kind, cx, cy, r: 3.5 }, title)
        : drawn("rect", { class: kind, x: cx - 3.2, y: cy - 3.2, width: 6.4, height: 6.4 }, title));
    }
    const last = errors[errors.length - 1] ?? estimates[estimates.length - 1];
    if (last && sides.length > 1) made.push(label({ class: name, x: x(Math.log10(last[0])) - 4, y: y(Math.log10(last[1])) + 16, "text-anchor": "middle", "stroke-width": 0 }, name.toUpperCase()));
  });
  const words = series.map(({ errors }, side) => `${SIDES[side].toUpperCase()}: ${errors.map(([seconds, error, , spp]) => `${spp} spp ${short(error, 2)} in ${short(seconds, 2)} s`).join(", ")}`);
  box.replaceChildren(drawn("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `RMSE over seconds. ${words.join(". ")}` }, ...made));
}
