// The menus of both sides, from the program's own table of options, sliders beside some, and the text fields for keys of the
// scene.
import { SIDES, element, find } from "./dom.js";

/** After the last key in a text field, before it is sent, in milliseconds. */
const REST = 500;

export class Menus {
  /** `changed` is called with a side whose settings have changed, `swapped` once both have changed places. */
  constructor(page, changed, swapped) {
    this.first = page.first;
    this.changed = changed;
    this.swapped = swapped;
    this.fields = [new Map(), new Map()];
    const [film, display] = find("menus").tBodies;
    for (const choice of page.choices) {
      const row = element("tr", {}, element("th", { scope: "row", title: choice.help }, choice.name.replace("sampler.*.", "sampler ")));
      SIDES.forEach((name, side) => {
        const field = choice.values.length ? this.menu(choice) : this.text(choice);
        field.setAttribute("aria-label", `${choice.name} of ${name.toUpperCase()}: ${choice.help}`);
        field.dataset.option = choice.name;
        field.dataset.side = name;
        field.addEventListener("change", () => this.note(side));
        this.fields[side].set(choice.name, field);
        row.append(element("td", {}, this.slid(choice, side, field)));
      });
      (choice.is_display ? display : film).append(row);
    }
    SIDES.forEach((name, side) => {
      const area = find(`set-${name}`);
      area.addEventListener("input", () => {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.note(side), REST);
      });
      area.addEventListener("change", () => this.note(side));
      this.apply(side, this.first);
    });
    const copy = (from, to) => { this.apply(to, this.settings(from)); this.note(to); };
    find("copy-ab").addEventListener("click", () => copy(0, 1));
    find("copy-ba").addEventListener("click", () => copy(1, 0));
    find("swap").addEventListener("click", () => {
      const [a, b] = [0, 1].map((side) => this.settings(side));
      this.apply(0, b);
      this.apply(1, a);
      this.swapped();
    });
    find("reset").addEventListener("click", () => [0, 1].forEach((side) => {
      this.apply(side, { options: {}, set: [] });
      this.note(side);
    }));
  }

  menu({ values, own }) {
    const words = values.map((value) => element("option", { value }, value));
    const scenes = own === null ? "(scene's)" : `(${own})`;
    return element("select", { title: scenes }, element("option", { value: "" }, scenes), ...words);
  }

  text({ name, own }) {
    const kind = name === "size" ? { inputmode: "text" } : { inputmode: "decimal" };
    return element("input", { type: "text", placeholder: own ?? "", autocomplete: "off", ...kind });
  }

  /** Returns a field with the slider beside it, where the option has one: its neutral place is the empty field. */
  slid({ name, help, slider, own }, side, field) {
    if (!slider) return field;
    const [min, max, step, neutral] = slider;
    const label = `${name} of ${SIDES[side].toUpperCase()} as a slider: ${help}`;
    const made = element("input", { type: "range", min, max, step, "aria-label": label, "data-slider": name, "data-side": SIDES[side] });
    const isNumber = (text) => text !== "" && Number.isFinite(Number(text));
    field.show = () => {
      made.value = isNumber(field.value.trim()) ? field.value.trim() : neutral;
      made.setAttribute("aria-valuetext", field.value.trim() || own);
    };
    made.addEventListener("input", () => {
      field.value = made.value === own ? "" : made.value;
      this.note(side);
    });
    made.addEventListener("dblclick", () => {
      field.value = "";
      this.note(side);
    });
    return element("div", { class: "slid" }, field, made);
  }

  /** Marks what differs from the scene, and tells that a side has changed. */
  note(side) {
    clearTimeout(this.timer);
    this.mark(side);
    this.changed(side);
  }

  mark(side) {
    for (const field of this.fields[side].values()) {
      field.classList.toggle("chosen", field.value.trim() !== "");
      // What is too long for its menu is told whole.
      if (field.selectedOptions) field.title = field.selectedOptions[0]?.text ?? "";
      field.show?.();
    }
  }

  /** Returns a side's settings as the program takes them. */
  settings(side) {
    const options = {};
    for (const [name, field] of this.fields[side]) {
      const value = field.value.trim();
      if (value !== "") options[name] = value;
    }
    const lines = find(`set-${SIDES[side]}`).value.split("\n").map((line) => line.trim());
    return { options, set: lines.filter((line) => line !== "") };
  }

  /** Shows settings in the fields of a side. */
  apply(side, { options, set }) {
    for (const [name, field] of this.fields[side]) field.value = options[name] ?? "";
    find(`set-${SIDES[side]}`).value = set.join("\n");
    this.mark(side);
  }
}
