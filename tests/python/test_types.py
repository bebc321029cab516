# SPDX-License-Identifier: GPL-3.0-or-later
"""The package is typed: the stubs name what there is, and the options' types come from the table."""

import ast
import importlib.util
import inspect
import pathlib
import subprocess
import sys
import unittest

import eigencrust
from eigencrust import _core, stages

PACKAGE = pathlib.Path(eigencrust.__file__).parent


def names_of(stub):
    """Functions, variables and classes of a stub; of classes the members."""
    found = {}
    for node in ast.parse((PACKAGE / stub).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            found[node.name] = {child.name for child in node.body if isinstance(child, ast.FunctionDef)}
        elif isinstance(node, ast.FunctionDef):
            found[node.name] = None
        elif isinstance(node, ast.AnnAssign):
            found[node.target.id] = None
    return {name: members for name, members in found.items() if not name.startswith("_")}


def public(thing):
    return {name for name in vars(thing) if not name.startswith("_")}


class Stubs(unittest.TestCase):
    def compare(self, module, stub, further=()):
        typed = names_of(stub)
        self.assertEqual(set(typed), public(module) - set(further))
        for name, members in typed.items():
            if members is not None:
                cls = getattr(module, name)
                members = {m for m in members if not m.startswith("_")}
                self.assertEqual(members, public(cls), name)

    def test_extension(self):
        self.compare(_core, "_core.pyi", further=["stages"])

    def test_stages(self):
        exported = set(eigencrust.stages.__all__)
        self.assertEqual(set(names_of("stages.pyi")), exported)
        for name, members in names_of("stages.pyi").items():
            if members is not None:
                members = {m for m in members if not m.startswith("_")}
                self.assertEqual(members, public(getattr(eigencrust.stages, name)), name)
        self.assertEqual({name for name in public(_core.stages)} - exported, set())

    def test_options(self):
        tree = ast.parse((PACKAGE / "_option_types.pyi").read_text(encoding="utf-8"))
        (options,) = [node for node in tree.body if isinstance(node, ast.ClassDef)]
        self.assertEqual([field.target.id for field in options.body], [option.name for option in eigencrust.option_table()])

    def test_marked_as_typed(self):
        self.assertTrue((PACKAGE / "py.typed").exists())

    def test_everything_public_is_exported(self):
        self.assertEqual(eigencrust.__all__, sorted(public(eigencrust) - {"annotations"}))

    def test_everything_public_has_a_docstring(self):
        for name in stages.__all__:
            thing = getattr(stages, name)
            if inspect.isroutine(thing):
                self.assertTrue(inspect.getdoc(thing), name)
        for name in eigencrust.__all__:
            thing = getattr(eigencrust, name)
            if inspect.isroutine(thing) or inspect.isclass(thing):
                self.assertTrue(inspect.getdoc(thing), name)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_mypy(self):
        program = "import eigencrust, numpy as np\nr = eigencrust.reconstruct(np.zeros((9, 3)), noise=0.1, smooth=2)\nreveal_type(r.vertices)\nreveal_type(eigencrust.measure(r))\neigencrust.reconstruct([], progress=3)\n"
        # An installed package is found as it is, and mypy refuses to be told of its folder.
        where = {} if PACKAGE.parent.name.endswith("-packages") else {"MYPYPATH": str(PACKAGE.parent)}
        run = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--no-incremental", "--cache-dir=/dev/null", "--follow-imports=silent", "-c", program],
            capture_output=True, text=True, check=False, env={"PATH": "/usr/bin:/bin"} | where,
        )  # fmt: skip
        self.assertRegex(run.stdout, "(float64|_64Bit)", run.stdout + run.stderr)
        self.assertIn("MeshMeasures", run.stdout)
        self.assertIn('Argument "progress" to "reconstruct" has incompatible type', run.stdout)
        self.assertNotIn("does not explicitly export", run.stdout)
        self.assertNotIn("error: Unexpected keyword", run.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
