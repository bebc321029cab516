# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of docs/python.md and README.md run, in their order, and print what the page says they print."""

import contextlib
import io
import os
import re
import shutil
import tempfile
import unittest

from support import REPOSITORY, TEAPOT, sphere

PAGE = REPOSITORY / "docs" / "python.md"
README = REPOSITORY / "README.md"


def blocks(text):
    """(line, code, what it prints or None) of each block of Python; the block of text behind it is its output."""
    found = []
    for match in re.finditer(r"```(python|text)\n(.*?)```", text, re.DOTALL):
        line = text[: match.start()].count("\n") + 2
        if match.group(1) == "python":
            found.append([line, match.group(2), None])
        else:
            found[-1][2] = match.group(2)
    return found


class Docs(unittest.TestCase):
    def test_every_block(self):
        self.run_blocks(PAGE, 8, {})

    def test_readme(self):
        self.run_blocks(README, 0, {"points": sphere(500)})

    def run_blocks(self, page, least, names):
        found = blocks(page.read_text(encoding="utf-8"))
        self.assertGreater(len(found), least)
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(TEAPOT, os.path.join(folder, "scan.ply"))
            os.chdir(folder)
            try:
                for line, code, expected in found:
                    with self.subTest(line=line), contextlib.redirect_stdout(io.StringIO()) as said:
                        exec(compile("\n" * (line - 1) + code, str(page), "exec"), names)
                    if expected is not None:
                        self.assertEqual(said.getvalue(), expected, f"line {line}")
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main(verbosity=2)
