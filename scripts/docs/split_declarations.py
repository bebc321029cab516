#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Filter for Doxygen: `double a = 0, b = 0; ///< what` becomes two declarations, each with the comment.

Doxygen gives the comment to one of them only. Lines keep their numbers. Usage: split_declarations.py FILE
"""

import re
import sys

# A type, and names that may have an initializer: no call, no function, no template head.
DECLARATION = re.compile(r"^(?P<indent> +)(?P<type>(?:const )?[A-Za-z_][\w:]*(?:<[^;()]*>)?) (?P<names>[a-z_]\w*[^;()]*);(?P<end>.*)$")


def split(names):
    """The parts between commas that no bracket holds."""
    parts, depth, begin = [], 0, 0
    for i, letter in enumerate(names):
        depth += letter in "{<["
        depth -= letter in "}>]"
        if letter == "," and depth == 0:
            parts.append(names[begin:i].strip())
            begin = i + 1
    return parts + [names[begin:].strip()]


def filtered(lines):
    """The lines with declarations of several names taken apart; a statement may run over two lines."""
    before = []  # the text of the comment above
    held = None  # the beginning of a declaration that goes on
    for line in lines:
        stripped = line.strip()
        if held is not None:
            line, held, broken = held + " " + stripped, None, "\n"
        else:
            broken = ""
        found = DECLARATION.match(line)
        names = split(found["names"]) if found else []
        if not found and re.match(r"^ +(?:const )?[A-Za-z_][\w:<>]* [a-z_]\w*( = [^,;(){]+)?,.*,$", line):
            held = line
            continue
        if len(names) > 1 and found["type"] not in ("return", "using", "case", "goto"):
            end = found["end"].strip()
            comment = end[4:].strip() if end.startswith("///<") else " ".join(before)
            line = found["indent"] + " ".join(f"{found['type']} {name}; /**< {comment} */" if comment else f"{found['type']} {name};" for name in names)
        before = before + [stripped[3:].strip()] if stripped.startswith("///") and not stripped.startswith("///<") else []
        yield line + broken


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(filtered(file.read().split("\n"))))
