"""Writes values of Python as TOML: those of settings, and whole scenes."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

from ._errors import OptionsError


def value(item: Any, where: str) -> str:
    """Return a value as TOML. ``where`` names it in errors."""
    if hasattr(item, "tolist"):  # an array or a number of NumPy
        item = item.tolist()
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, int):
        return str(item)
    if isinstance(item, float):
        return repr(item) if math.isfinite(item) else str(item)
    if isinstance(item, (str, os.PathLike)):
        # A string of JSON is one of TOML, but for the character that JSON does not escape.
        return json.dumps(os.fspath(item), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(item, Mapping):
        inner = (f"{key(name)} = {value(own, f'{where}.{name}')}" for name, own in item.items())
        return "{ " + ", ".join(inner) + " }" if item else "{}"
    if isinstance(item, Sequence):
        return "[" + ", ".join(value(own, where) for own in item) + "]"
    raise OptionsError(f"{where}: a scene has no values of type {type(item).__name__}")


def key(name: Any) -> str:
    """Return a key as TOML."""
    text = str(name)
    is_bare = text.isascii() and text.replace("-", "a").replace("_", "a").isalnum()
    return text if is_bare else json.dumps(text, ensure_ascii=False)


def document(scene: Mapping[str, Any]) -> str:
    """Return a whole scene: mappings become tables, lists of mappings arrays of tables."""
    lines = []
    for name, section in scene.items():
        if isinstance(section, Mapping):
            lines += [f"[{key(name)}]", *_entries(section, str(name)), ""]
        elif isinstance(section, Sequence) and section and all(isinstance(own, Mapping) for own in section):
            for own in section:
                lines += [f"[[{key(name)}]]", *_entries(own, str(name)), ""]
        else:
            lines.insert(0, f"{key(name)} = {value(section, str(name))}")
    return "\n".join(lines) + "\n"


def _entries(section: Mapping[str, Any], where: str) -> list[str]:
    return [f"{key(name)} = {value(item, f'{where}.{name}')}" for name, item in section.items()]
