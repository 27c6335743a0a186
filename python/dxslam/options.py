# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""The options of a System, with the names and checks of configuration files."""
import json
import os
from collections.abc import Iterator, Mapping
from typing import Any

from ._dxslam import InputError, OptionsBase


def _plain(value: Any) -> Any:
    """Numbers of NumPy and groups as what JSON has."""
    if isinstance(value, (OptionGroup, Options)):
        return value.to_dict()
    return value.item() if hasattr(value, "item") else str(value)


def _change(root: OptionsBase, path: tuple[str, ...], values: Any) -> None:
    """Every JSON text is YAML, so the reader of configuration files has the last word."""
    for name in reversed(path):
        values = {name: values}
    OptionsBase.read_yaml(root, json.dumps(values, default=_plain, ensure_ascii=False), "options")


class _Group:
    """Attributes for the options of one group."""

    __slots__ = ()

    def _at(self) -> tuple[OptionsBase, tuple[str, ...]]:
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """All options by name; groups are dictionaries in it."""
        root, path = self._at()
        values = OptionsBase.to_dict(root)
        for name in path:
            values = values[name]
        return values

    def __getattr__(self, name: str) -> Any:
        values = {} if name.startswith("_") else self.to_dict()
        if name not in values:
            raise AttributeError(f"there is no option {name!r}, see dir() or Options.to_yaml()")
        if not isinstance(values[name], dict):
            return values[name]
        root, path = self._at()
        return OptionGroup(root, (*path, name))

    def __setattr__(self, name: str, value: Any) -> None:
        root, path = self._at()
        _change(root, (*path, name), value)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.to_dict()]

    def __iter__(self) -> Iterator[str]:
        return iter(self.to_dict())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Group) and self.to_dict() == other.to_dict()

    __hash__ = None  # type: ignore[assignment]


class OptionGroup(_Group):
    """A group of options, e.g. `options.tracking`; changes are those of the whole."""

    __slots__ = ("_root", "_path")

    def __init__(self, root: OptionsBase, path: tuple[str, ...]) -> None:
        object.__setattr__(self, "_root", root)
        object.__setattr__(self, "_path", path)

    def _at(self) -> tuple[OptionsBase, tuple[str, ...]]:
        return self._root, self._path

    def __repr__(self) -> str:
        return f"OptionGroup({'.'.join(self._path)}: {self.to_dict()})"


class Options(_Group, OptionsBase):
    """The options of a System; all that is not said keeps its default.

        options = dxslam.Options(final_bundle=False, tracking={"min_inliers": 20})
        options.tracking.min_inliers = 25
        print(options.to_yaml())  # with meaning, unit and range of each

    Names, ranges and messages are those of `dxslam run --config`: InputError for unknown names, wrong
    types and values out of range.
    """

    def __init__(self, values: Mapping[str, Any] | OptionsBase | None = None, /,
                 **named: Any) -> None:
        if isinstance(values, OptionsBase):
            super().__init__(values)
        else:
            super().__init__()
            _change(self, (), dict(values or {}))
        _change(self, (), named)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> "Options":
        """Reads a configuration file over the defaults."""
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path}: {error}, expected a YAML configuration") from error
        return cls.from_yaml(text, os.fspath(path))

    @classmethod
    def from_yaml(cls, text: str, where: str = "options") -> "Options":
        """Reads a configuration over the defaults; `where` names it in messages."""
        options = cls()
        options.read_yaml(text, where)
        return options

    def copy(self) -> "Options":
        """Options of their own with the same values."""
        return Options(self)

    def _at(self) -> tuple[OptionsBase, tuple[str, ...]]:
        return self, ()

    def __repr__(self) -> str:
        changed = _differences(self.to_dict(), Options().to_dict())
        return f"Options({changed or ''})"


def _differences(values: dict[str, Any], others: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            value = _differences(value, others[name])
            if value:
                found[name] = value
        elif value != others[name]:
            found[name] = value
    return found
