# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference of the Python package: signatures from its sources and stubs, descriptions from its docstrings."""

import ast
import html
import inspect
import pathlib
import re

import eigencrust

PACKAGE = pathlib.Path(eigencrust.__file__).parent
SOURCES = ["_core.pyi", "stages.pyi", "_api.py", "_arrays.py", "_options.py", "_errors.py"]


def signature(node):
    """As one would type it: name(arguments) -> type."""
    arguments = ast.unparse(node.args)
    arguments = re.sub(r"^self(, )?", "", arguments).replace("'", '"')
    arguments = re.sub(r'"(ArrayLike|Unpack\[MethodOptions\])"', r"\1", arguments).replace("_core.", "")
    returns = f" -> {ast.unparse(node.returns)}".replace("_core.", "") if node.returns else ""
    return f"{node.name}({arguments}){returns}"


def signatures():
    """Of each function its signature; of each class {member: (signature, is it a property)}."""
    found = {}
    for name in SOURCES:
        for node in ast.parse((PACKAGE / name).read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef):
                found[node.name] = signature(node)
            elif isinstance(node, ast.ClassDef):
                members = found.setdefault(node.name, {})
                for child in node.body:
                    if isinstance(child, ast.FunctionDef):
                        members[child.name] = (signature(child), bool(child.decorator_list))
    return found


def described(thing):
    """Its docstring as HTML, without the signature that pybind11 puts before."""
    text = inspect.getdoc(thing) or ""
    text = re.sub(r"^\w+\(.*\) -> [^\n]*\n+", "", text)
    parts = []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        if "\n " in paragraph or "\n---" in paragraph:
            parts.append(f"<pre class=wrapped>{html.escape(paragraph)}</pre>")
        elif paragraph:
            parts.append(f"<p>{html.escape(paragraph)}</p>")
    return "".join(parts)


def class_entry(name, thing, members):
    parts = [f'<h3 id="{name}">{name}</h3>']
    if "__init__" in members:
        made = members["__init__"][0].replace("__init__", name).replace(" -> None", "")
        parts.append(f"<pre class=wrapped>{html.escape(made)}</pre>")
    parts.append(described(thing))
    rows = []
    for member, (text, is_property) in members.items():
        if member.startswith("_"):
            continue
        shown = f"{member}: {text.split(' -> ')[-1]}" if is_property else text
        about = described(getattr(thing, member, None)) if not is_property else described(getattr(thing, member))
        rows.append(f"<dt><code>{html.escape(shown)}</code></dt><dd>{about}</dd>")
    return "".join(parts) + (f"<dl>{''.join(rows)}</dl>" if rows else "")


def entries(names, home, known, prefix):
    functions, classes, others = [], [], []
    for name in names:
        thing = getattr(home, name)
        if inspect.isclass(thing):
            classes.append(class_entry(name, thing, known.get(name, {})))
        elif inspect.isroutine(thing):
            functions.append(
                f'<h3 id="{prefix}{name}">{name}</h3><pre class=wrapped>{html.escape(known.get(name, name + "(...)"))}</pre>{described(thing)}'
            )
        elif not inspect.ismodule(thing):
            others.append(f"<li><code>{name} = {html.escape(repr(thing))}</code></li>")
    return "".join(functions) + "".join(classes) + (f"<ul>{''.join(others)}</ul>" if others else "")


def page():
    """The whole reference."""
    known = signatures()
    rows = "".join(
        f"<tr><td><code>{o.name}</code></td><td>{o.kind}</td><td>{html.escape(str(o.default))}</td><td>{html.escape(o.help)}</td></tr>"
        for o in eigencrust.option_table()
    )
    return (
        f"<h1>Python reference</h1><p>{html.escape(inspect.getdoc(eigencrust) or '').splitlines()[0]} "
        '<a href="python.html">How it is used</a>.</p><ul><li><a href="#package">The package</a></li>'
        '<li><a href="#options">Options of the method</a></li><li><a href="#stages">Every stage</a></li></ul>'
        f'<h2 id="package">eigencrust</h2>{entries(eigencrust.__all__, eigencrust, known, "")}'
        '<h2 id="options">Options of the method</h2><p>Keywords of reconstruct(), orient(), outliers() and Session; '
        'what they do in full: <a href="parameters.html">parameters</a>.</p>'
        f"<table><tr><th>name</th><th>kind</th><th>default</th><th></th></tr>{rows}</table>"
        f'<h2 id="stages">eigencrust.stages</h2><pre class=wrapped>{html.escape(inspect.getdoc(eigencrust.stages) or "")}</pre>'
        f'{entries(eigencrust.stages.__all__, eigencrust.stages, known, "stages.")}'
    )
