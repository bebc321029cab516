#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists the numbers in the sources of the method: every numeric literal but 0, 1 and 2, with its place, the name of
its constant and its comment, which should say the unit and why it is that number.

Usage: scripts/numbers.py [--bare] [FILE or FOLDER...]
  --bare  only those without a comment
Without arguments: the chapters of the method under src, those that exist.

Comments, strings and character literals are not looked into. Four forms are skipped, because they say no more than
that a triangle has three corners and a tetrahedron four; the last line says how often:
  % 3, % 4, (k + 3) % 4     the next corner
  < 3, < 4                  the bound of a for loop
  std::array<T, 3> (or 4)   one value per corner, face or coordinate
  name[3]                   the fourth corner
"""
import bisect
import os
import re
import sys

CHAPTERS = ("samples", "tetrahedra", "evidence", "poles", "settle", "repair", "surface", "fit", "points", "stages",
            "sample_measures.h", "sample_measures.cpp", "sample_rows.h", "sample_rows.cpp")

TOKEN = re.compile(
    r'(?P<comment>//[^\n]*|/\*.*?\*/)'
    r'|(?P<text>R"(?P<end>[^(\s]*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*")'
    r"|(?P<number>(?<![\w.])(?:0[xX][\da-fA-F'.]+(?:[pP][+-]?\d+)?|0[bB][01']+|(?:\d[\d']*)?\.?\d[\d']*\.?(?:[eE][+-]?\d+)?)\w*)"
    r"|(?P<character>(?<!\w)(?:u8|[uUL])?'(?:\\.[^']*|[^'\\\n])')"
    r"|(?P<word>[A-Za-z_]\w*)", re.S)
DECLARATION = re.compile(r"^\s*(?:static|inline|constexpr|const|double|float|int|unsigned|bool|auto|std::\w+|enum)\b")
CONTROL = re.compile(r"^\s*(?:for|if|while|switch|return|else|case|do|throw)\b")
STRUCTURAL = (re.compile(r"%\s*$"), re.compile(r"\bfor\s*\([^;]*;[^;]*<\s*$"), re.compile(r"\barray<[^;(){}]*,\s*$"))


def value_of(literal):
    """The number, or None where it cannot be told."""
    text = literal.replace("'", "").lower()
    hexadecimal = text.startswith("0x")
    text = re.sub(r"(?:u|l|z)+$" if hexadecimal else r"(?:u|l|z|f)+$", "", text)
    try:
        if hexadecimal:
            return float.fromhex(text)
        return float(int(text, 2)) if text.startswith("0b") else float(text)
    except ValueError:
        return None


class Source:
    def __init__(self, path):
        self.path = path
        self.text = open(path, encoding="utf-8").read()
        self.starts = [0] + [m.end() for m in re.finditer("\n", self.text)]
        code = list(self.text)
        self.comments, self.numbers = {}, []  # comments: line -> words
        for m in TOKEN.finditer(self.text):
            if m.lastgroup in ("comment", "text", "end", "character"):
                for i in range(*m.span()):
                    if code[i] != "\n":
                        code[i] = " "
            if m.group("comment"):
                for k, line in enumerate(m.group().split("\n")):
                    self.comments[self.line(m.start()) + k] = re.sub(r"^\s*(?://+<?|/\*+|\*+/?)\s?|\*/\s*$", "", line)
            elif m.group("number"):
                self.numbers.append((m.start(), m.group()))
        self.code = "".join(code)

    def line(self, place):
        return bisect.bisect_right(self.starts, place)

    def code_of(self, line):
        end = self.starts[line] if line < len(self.starts) else len(self.code)
        return self.code[self.starts[line - 1]:end]

    def statement(self, place):
        """Where the statement (or the entry of a list) around the place begins."""
        start = max(self.code.rfind(c, 0, place) for c in ";{}") + 1
        return start + len(self.code[start:place]) - len(self.code[start:place].lstrip())

    def is_structural(self, place, literal):
        if value_of(literal) not in (3, 4):
            return False
        before = self.code[max(0, place - 200):place]
        after = self.code[place + len(literal):place + len(literal) + 5]
        turned = re.search(r"\(\w+ \+ $", before) and after == ") % 4"
        subscript = before[-1:] == "[" and after[:1] == "]" and literal == "3"
        return bool(turned) or subscript or any(form.search(before) for form in STRUCTURAL)

    def name(self, place):
        """What is being defined where the number stands."""
        start = max(self.code.rfind(c, 0, place) for c in ";}") + 1
        text = self.code[start:place]
        while "{" in text and not re.search(r"(?:=\s*|\w)\{[^{]*$", text):  # past the heads of blocks
            text = text[text.index("{") + 1:]
        text = re.sub(r"\b(?:public|private|protected)\s*:", "", text)
        if CONTROL.match(text) or not DECLARATION.match(text):
            return ""
        names = re.findall(r"(\w+)(?:\[\w*\])?\s*(?:=(?!=)|\{)", text)
        return names[-1] if names else ""

    def comment(self, place):
        """At the end of the line, else right above the statement."""
        here = self.line(place)
        if here in self.comments:
            words, line = [self.comments[here]], here + 1
            while line in self.comments and not self.code_of(line).strip():  # it goes on below
                words.append(self.comments[line])
                line += 1
            return " ".join(words).strip()
        line, words = self.line(self.statement(place)) - 1, []
        while line in self.comments and not self.code_of(line).strip():
            words.insert(0, self.comments[line])
            line -= 1
        return " ".join(words).strip()


def files_of(arguments):
    for argument in arguments:
        if os.path.isfile(argument):
            yield argument
        elif os.path.isdir(argument):
            for folder, folders, names in os.walk(argument):
                folders.sort()
                yield from (os.path.join(folder, n) for n in sorted(names) if n.endswith((".cpp", ".h")))
        else:
            sys.exit("numbers.py: error: there is no " + argument)


def main(arguments):
    if "-h" in arguments or "--help" in arguments:
        print(__doc__)
        return
    bare = "--bare" in arguments
    places = [a for a in arguments if a != "--bare"]
    if not places:
        os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
        places = [p for p in ("src/" + c for c in CHAPTERS) if os.path.exists(p)]
    files = list(files_of(places))
    count = named = commented = structural = 0
    for path in files:
        source = Source(path)
        for place, literal in source.numbers:
            if value_of(literal) in (0, 1, 2):
                continue
            if source.is_structural(place, literal):
                structural += 1
                continue
            name, comment = source.name(place), source.comment(place)
            count += 1
            named += bool(name)
            commented += bool(comment)
            if not (bare and comment):
                print("%s:%d: %s  %s  %s" % (path, source.line(place), literal, name or "-", comment or "(no comment)"))
    print("%d numbers in %d files of %s: %d with a name, %d with a comment; %d structural ones skipped" %
          (count, len(files), " ".join(places), named, commented, structural))


if __name__ == "__main__":
    main(sys.argv[1:])
