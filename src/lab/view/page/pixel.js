// What the pixel under the crosshair is made of: its values on both sides, in the film and as shown, its surface, its samples,
// and what it reads of textures, with the footprint drawn on the texels.
import { SIDES, drawn, element, short } from "./dom.js";

/** Names of gamuts for people. */
const GAMUTS = { srgb: "sRGB", "display-p3": "Display P3" };
/** Colours by which surfaces are told apart. */
const COLORS = 8;

export class PixelPanel {
  constructor(box, title, address) {
    Object.assign(this, { box, title, address });
    this.isAsking = false;
    this.shown = "";
    this.cards = [];
  }

  /** Shows the crosshair's pixel; the newest one while another is asked for. */
  async show(state, picture) {
    if (!picture.cross || !state) return;
    // What a pixel is made of takes time, which a picture that is still to come needs more; it comes back here.
    if (state.sides.some(({ spp, failure }) => spp === null && !failure)) return;
    this.wanted = [state, picture];
    if (this.isAsking) return;
    this.isAsking = true;
    try {
      while (this.wanted) {
        const [now, where] = this.wanted;
        this.wanted = null;
        await this.ask(now, where);
      }
    } catch {
      this.shown = "";
    }
    this.isAsking = false;
  }

  /** Shows the same pixel of newer pictures. */
  refresh(state, picture) {
    if (picture.cross && this.key(state, picture) !== this.shown) this.show(state, picture);
  }

  key(state, picture) {
    return [picture.cross, picture.sideOfCross(), ...state.sides.map((side) => `${side.number}/${side.spp}/${side.display}`)].join();
  }

  async ask(state, picture) {
    this.shown = this.key(state, picture);
    const { cross, frame } = picture;
    const front = picture.sideOfCross();
    const isOne = state.sides[0].number === state.sides[1].number;
    const of = async (side) => {
      const size = [state.sides[side].width, state.sides[side].height];
      const place = cross.map((value, i) => Math.min(Math.floor(((value + 0.5) * size[i]) / frame[i]), size[i] - 1));
      const answer = await fetch(this.address(side, place));
      return answer.ok ? answer.json() : { error: `the program answered ${answer.status}` };
    };
    const isSame = isOne && state.sides[0].display === state.sides[1].display;
    const told = isSame ? [await of(0)] : await Promise.all([of(0), of(1)]);
    await this.draw(told, isSame ? 0 : front, cross, isOne);
  }

  async draw(told, front, cross, isOne) {
    const own = told[front];
    const name = isOne ? "" : ` of ${SIDES[front].toUpperCase()}`;
    this.title.textContent = `Pixel ${cross.join(", ")}${name}`;
    if (own.error) {
      this.place([[own.error, () => element("p", { class: "error" }, own.error)]]);
      return;
    }
    await Promise.all(own.look_ups.map(({ window: seen }) => seen && decoded(seen.png)));
    this.place([
      [[told.map(({ value }) => value), own.surface, isOne], () => this.values(told, own, isOne)],
      ...(own.samples.length ? [[[own.samples, own.surfaces], () => this.samples(own)]] : []),
      ...own.look_ups.map((lookUp) => [lookUp, () => this.lookUp(lookUp)]),
    ]);
  }

  /** Places cards, each with what it is made of; one that is there already stays. */
  place(cards) {
    const texts = cards.map(([of]) => JSON.stringify(of));
    cards.forEach(([, make], i) => {
      if (texts[i] === this.cards[i]) return;
      const old = i < this.cards.length ? this.box.children[i] : null;
      if (old) old.replaceWith(make());
      else if (i === 0) this.box.replaceChildren(make());
      else this.box.append(make());
    });
    while (this.box.children.length > cards.length) this.box.lastChild.remove();
    this.cards = texts;
  }

  values(told, front, isOne) {
    const rows = [];
    told.forEach(({ value }, side) => {
      if (!value) return;
      const of = ` ${SIDES[side].toUpperCase()}`;
      const linear = value.linear.map((channel) => short(channel, 5)).join(" ");
      if (side === 0 || !isOne) rows.push([`film${isOne ? "" : of}, linear`, linear]);
      rows.push([`shown${told.length === 1 ? "" : of}, ${GAMUTS[value.gamut] ?? value.gamut}`, value.shown.join(" ")]);
    });
    const { surface } = front;
    if (surface) {
      rows.push(["surface", surface.shape], ["material", surface.model ? `${surface.material} (${surface.model})` : surface.material]);
      rows.push(["point", surface.point.map((value) => short(value)).join(" ")]);
      rows.push(["normal", surface.normal.map((value) => short(value, 3)).join(" ")], ["depth", short(surface.depth)]);
    } else {
      rows.push(["surface", "background"]);
    }
    const made = card("Value and centre", facts(rows));
    made.classList.add("values");
    return made;
  }

  samples({ samples, surfaces }) {
    const reach = Math.max(0.06, ...samples.flatMap(([x, y]) => [-x, -y, x - 1, y - 1]));
    const side = 1 + 2 * reach;
    const dots = samples.map(([x, y, surface]) => drawn("circle", {
      cx: x, cy: y, r: (side * 0.022 * Math.min(1, 8 / Math.sqrt(samples.length))).toFixed(4), class: `k${surface % COLORS}`,
    }));
    const drawing = drawn("svg", { class: "drawing", viewBox: `${-reach} ${-reach} ${side} ${side}`, role: "img", "aria-label": `${samples.length} samples in the pixel` },
      drawn("rect", { x: 0, y: 0, width: 1, height: 1, class: "square" }), ...dots);
    const list = surfaces.map((surface, i) => element("li", {},
      element("span", { class: `swatch k${i % COLORS}` }), ` ${surface.shape}${surface.material ? `, ${surface.material}` : ""}: ${surface.samples} of ${samples.length}`));
    const found = surfaces.length === 1 ? "1 surface" : `${surfaces.length} surfaces`;
    return card(`Samples: ${found}`, drawing, element("ul", { class: "surfaces" }, ...list));
  }

  lookUp(own) {
    const [u, v, w] = own.uv.map((value) => short(value, 5));
    const rows = [own.depth || !own.size ? ["uvw", `${u} ${v} ${w}`] : ["uv", `${u} ${v}`]];
    if (own.face) rows.unshift(["face", own.face]);
    if (own.size) {
      const size = own.depth ? [...own.size, own.depth] : own.size;
      rows.push(["texel", own.texel ? `${own.texel.join(", ")} of ${size.join(" × ")}` : "none: the border's colour"]);
      if (own.in_file) {
        const { tile, texel, size: of } = own.in_file;
        rows.push(["in the file", `${tile ? `tile ${tile}, ` : ""}${texel.join(", ")} of ${of.join(" × ")}`]);
      }
      rows.push(["level", `${short(own.level, 3)} of 0 to ${own.levels - 1}`]);
      if (own.window) rows.push(["drawn", drawnTexels(own.window)]);
      rows.push(["footprint", `${own.texels.map((value) => short(value, 3)).join(" × ")} texels`]);
      rows.push(["filter", `${own.filter}, mip ${own.mip}`], ["address", own.address.join(", ")]);
    } else {
      rows.push(["texels", "none: it is computed"]);
    }
    const title = `${own.use}: ${own.texture}`;
    return card(title, ...(own.window ? [footprint(own.window)] : []), facts(rows));
  }
}

function card(title, ...content) {
  return element("div", { class: "card" }, element("h3", {}, title), ...content);
}

function facts(rows) {
  return element("dl", { class: "facts" }, ...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, String(value))]));
}

/** Waits until the browser has decoded a picture, so that it is not empty at first. */
function decoded(png) {
  const image = new Image();
  image.src = data(png);
  return image.decode().catch(() => {});
}

const data = (png) => `data:image/png;base64,${png}`;

/** Says what a pixel of a window is: a texel, or the mean of many. */
function drawnTexels({ level, read, mean }) {
  const texels = mean ? `each square the mean of ${mean.map((own) => short(own, 3)).join(" × ")} texels` : "texels";
  return level === read ? `${texels} of level ${level}` : `${texels} of level ${level}, as level ${read} is too fine for a footprint so large`;
}

/** Draws texels with the parallelogram of the pixel's footprint, the ellipse within it, and the look-ups of its samples. */
function footprint({ png, side, level, read, mean, centre: [x, y], axes: [[ax, ay], [bx, by]], samples }) {
  const corner = (s, t) => `${x + (s * ax + t * bx) / 2},${y + (s * ay + t * by) / 2}`;
  const around = Array.from({ length: 49 }, (_, i) => (i * Math.PI) / 24).map((angle) => corner(Math.cos(angle), Math.sin(angle)));
  const square = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)].join(" ");
  const shapes = ["outline", "outline in"].flatMap((name) => [
    drawn("polygon", { points: square, class: name }),
    drawn("polygon", { points: around.join(" "), class: name }),
  ]);
  const r = side * 0.013 * Math.min(1, 8 / Math.sqrt(samples.length));
  const marks = samples.map(([cx, cy]) => drawn("circle", { cx, cy, r: r.toFixed(4), class: "mark" }));
  const of = level === null ? "The texture" : drawnTexels({ level, read, mean });
  const what = `${of[0].toUpperCase()}${of.slice(1)}, around the pixel's footprint, with the look-ups of its samples`;
  return drawn("svg", { class: "drawing", viewBox: `0 0 ${side} ${side}`, role: "img", "aria-label": what },
    drawn("title", {}, what), drawn("image", { href: data(png), width: side, height: side }), ...shapes, ...marks);
}
