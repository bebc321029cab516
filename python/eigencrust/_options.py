# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the method by keyword. Names, defaults and help come from the library's one table."""

from __future__ import annotations

import difflib
import numbers
from typing import Any, Callable, List, Mapping, NamedTuple, TypeVar

import numpy as np

from . import _core
from ._errors import UsageError

_Function = TypeVar("_Function", bound=Callable[..., Any])


class Option(NamedTuple):
    """One option of the method."""

    name: str  #: as a keyword
    kind: str  #: choice, length, number, count, flag, points or bytes
    help: str
    default: str  #: of the preset robust, which is taken where none is named
    paper_default: str  #: of the preset paper


def option_table() -> List[Option]:
    """All options that reconstruct() and its kin take as keywords."""
    return [Option(row[0].replace("-", "_"), *row[1:]) for row in _core.option_table()]


_by_name = {option.name: option for option in option_table()}


def _text(option: Option, value: Any) -> str:
    """The value as the command line would have it."""
    is_flag = isinstance(value, (bool, np.bool_))
    if option.kind == "flag":
        if not is_flag:
            raise UsageError(option.name, f"{value!r} is no flag", "use True or False")
        return "on" if value else "off"
    if isinstance(value, str):
        return value
    if not is_flag and isinstance(value, numbers.Integral):
        return str(int(value))
    if not is_flag and isinstance(value, numbers.Real) and option.kind in ("number", "length"):
        return repr(float(value))
    raise UsageError(option.name, f"{value!r} is no value for it", option.help)


def make_options(options: Mapping[str, Any]) -> _core.Options:
    """The keywords as options of the library. None leaves the default."""
    made = _core.Options()
    for name in options:
        if name not in _by_name:
            near = difflib.get_close_matches(name, _by_name, n=1)
            raise UsageError(
                "options",
                f"there is no option named {name!r}",
                f"did you mean {near[0]}?" if near else "eigencrust.option_table() lists them",
            )
    for name, option in _by_name.items():  # the preset first
        value = options.get(name)
        if value is None:
            continue
        dashed = name.replace("_", "-")
        if option.kind == "points" and not isinstance(value, str):
            made.add_points(dashed, value)
        else:
            made.set(dashed, _text(option, value))
    made.check()
    return made


def _described(option: Option) -> str:
    default = option.default
    if option.paper_default != default and option.name != "preset":
        default += f"; paper: {option.paper_default}"
    form = {
        "choice": "str",
        "length": "float or str",
        "points": "(3,) or (M,3) array",
        "flag": "bool",
        "count": "int",
        "number": "float",
        "bytes": "int or str",
    }
    meaning = option.help
    if option.kind == "points":
        meaning = meaning.replace("x,y,z of a point", "Points").replace("; repeatable", "")
    return f"{option.name}: {form[option.kind]}\n    {meaning} [{default}]"


def documents_options(function: _Function) -> _Function:
    """Puts the options in place of the line OPTIONS of the docstring."""
    lines = [line for option in _by_name.values() for line in _described(option).split("\n")]
    indent = "    "
    assert function.__doc__ is not None and "OPTIONS" in function.__doc__
    function.__doc__ = function.__doc__.replace("OPTIONS", ("\n" + indent).join(lines))
    return function
