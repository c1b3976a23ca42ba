"""Runs the code cells of a notebook in order, without Jupyter: ``python run.py lecture.ipynb``.

A value at the end of a cell is formatted as Jupyter would show it. An exception ends the run with the cell's source.
"""

import ast
import json
import sys


def run(path: str) -> int:
    """Run the cells in one namespace and return how many there are."""
    with open(path, encoding="utf-8") as file:
        cells = [cell for cell in json.load(file)["cells"] if cell["cell_type"] == "code"]
    names: dict = {"__name__": "__main__"}
    for number, cell in enumerate(cells, 1):
        source = "".join(cell["source"])
        try:
            show(source, f"{path}[{number}]", names)
        except BaseException:
            print(f"cell {number}:\n{source}", file=sys.stderr)
            raise
    return len(cells)


def show(source: str, place: str, names: dict) -> None:
    """Run one cell and format the value of its last expression."""
    tree = ast.parse(source, place)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, place, "exec"), names)
    if last is None:
        return
    value = eval(compile(ast.Expression(last.value), place, "eval"), names)
    png = getattr(value, "_repr_png_", None)
    if value is not None:
        print(f"{value!r}" + (f", {len(png())} bytes of PNG" if png else ""))


if __name__ == "__main__":
    print(f"{run(sys.argv[1])} cells ran")
