// The commands that render the same pictures, with their files and warnings. What stays the same is left in place, so that a
// button that has the focus keeps it while the picture refines.
import { SIDES, element } from "./dom.js";

/** For how long a button says what it has done, in milliseconds. */
const TOLD = 1500;

export class Commands {
  constructor(box, address) {
    Object.assign(this, { box, address });
    this.rows = SIDES.map((name, side) => this.row(name, side));
    box.replaceChildren(...this.rows.map(({ row }) => row));
  }

  row(name, side) {
    const key = element("strong", { class: `key ${name}` });
    const code = element("code", { class: "line" });
    const copy = element("button", { type: "button" }, "Copy");
    const save = element("a", {}, "PNG");
    const warnings = element("ul", { class: "warnings" });
    copy.addEventListener("click", () => this.copy(copy, code));
    const row = element("div", { class: "command" }, key, code, copy, " ", save, warnings);
    row.hidden = true;
    return { row, key, code, copy, save, warnings, side };
  }

  show(state) {
    const [a, b] = state.sides;
    const isOne = a.command === b.command;
    for (const { row, key, code, copy, save, warnings, side } of this.rows) {
      const { command, spp, number, warnings: told } = state.sides[side];
      save.href = this.address("picture", side, `&file=1&of=${number}&spp=${spp}`);
      row.hidden = (isOne && side === 1) || (row.hidden && !command);
      // Until the first picture of new settings is there, the command of the last ones stays.
      if (row.hidden || !command) continue;
      const name = isOne ? "A and B" : SIDES[side].toUpperCase();
      key.textContent = name;
      copy.setAttribute("aria-label", `Copy the command of ${name}`);
      save.setAttribute("aria-label", `The picture of ${name} as PNG`);
      save.download = `${SIDES[side]}-${spp}.png`;
      if (code.textContent !== command) code.replaceChildren(...parts(command));
      const text = JSON.stringify(told);
      if (warnings.dataset.text === text) continue;
      warnings.dataset.text = text;
      warnings.replaceChildren(...told.map((own) => element("li", {}, own)));
      warnings.hidden = told.length === 0;
    }
  }

  async copy(button, code) {
    clearTimeout(button.timer);
    try {
      await navigator.clipboard.writeText(code.textContent);
      button.textContent = "Copied";
    } catch {
      // Without the right to the clipboard the text is marked, for the keys of the browser.
      getSelection().selectAllChildren(code);
      button.textContent = "Marked: press Ctrl+C";
    }
    button.timer = setTimeout(() => { button.textContent = "Copy"; }, TOLD);
  }
}

/** Cuts a command between its options, so that no line ends within one. */
function parts(command) {
  const words = command.split(/ (?=--)/);
  return words.map((word, i) => element("span", {}, i + 1 < words.length ? `${word} ` : word));
}
