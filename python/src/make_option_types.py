# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the types of the options, for type checkers, out of the library's table. Usage: make_option_types.py FILE"""

import sys

from eigencrust import option_table

TYPES = {
    "choice": "Union[str, int]",
    "length": "Union[float, str]",
    "number": "float",
    "count": "int",
    "flag": "bool",
    "points": "ArrayLike",
    "bytes": "Union[int, str]",
}


def main(path: str) -> None:
    lines = [
        "# Made by make_option_types.py from the table of options.",
        "from typing import Optional, Union",
        "",
        "from numpy.typing import ArrayLike",
        "from typing_extensions import TypedDict",
        "",
        "class MethodOptions(TypedDict, total=False):",
    ]
    for option in option_table():
        lines.append(f"    {option.name}: Optional[{TYPES[option.kind]}]  # {option.help} [{option.default}]")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


main(sys.argv[1])
