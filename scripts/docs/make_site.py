#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Markdown pages of the project and the Python reference as HTML. Usage: make_site.py FOLDER VERSION

Links to pages follow; other files of the project that pages link to are copied, and folders get a page that lists them.
Needs Debian's python3-markdown, and the package eigencrust on the path.
"""

import html
import pathlib
import re
import shutil
import sys

import markdown
import python_reference

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Title of the navigation, and where it leads.
NAVIGATION = [
    ("Start", "README.md"),
    ("Parameters", "docs/parameters.md"),
    ("Formats", "docs/formats.md"),
    ("Report", "docs/report.md"),
    ("Guarantees", "docs/guarantees.md"),
    ("Python", "docs/python.md"),
    ("Python reference", "docs/python-reference.html"),
    ("C++ and C", "api/index.html"),
    ("Algorithm", "docs/algorithm.md"),
    ("Decisions", "docs/decisions"),
    ("Robustness", "docs/robustness.md"),
    ("Speed", "docs/speed.md"),
    ("Other crusts", "docs/crusts.md"),
    ("Development", "docs/development.md"),
    ("Changes", "CHANGELOG.md"),
]
WALKTHROUGHS = ["heritage", "print", "robotics", "survey", "research", "embedding"]

STYLE = """
:root { color-scheme: light dark; --line: #8884; --soft: #8881; }
body { margin: 0; font: 16px/1.55 system-ui, sans-serif; display: flex; flex-wrap: wrap; }
nav { box-sizing: border-box; align-self: flex-start; position: sticky; top: 0; width: 13em; padding: 1.2em; border-right: 1px solid var(--line); }
nav a { display: block; padding: .12em 0; text-decoration: none; }
nav a[aria-current] { font-weight: bold; }
nav b { display: block; margin-top: .9em; }
main { flex: 1 1 30em; min-width: 0; max-width: 62em; padding: 1em 2em 4em; }
pre, code { font: 14px/1.45 ui-monospace, monospace; background: var(--soft); }
pre { padding: .7em 1em; overflow-x: auto; border-radius: 5px; }
pre code { background: none; }
pre.wrapped { white-space: pre-wrap; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
th, td { border: 1px solid var(--line); padding: .25em .6em; text-align: left; vertical-align: top; }
img { max-width: 100%; background: #fff; }
dt { margin-top: .8em; }
"""


def slug(text, separator="-"):
    """The name of a heading's place, as GitHub makes it."""
    text = re.sub(r"[^\w\- ]", "", text.strip().lower())
    return text.replace(" ", separator)


def html_name(source):
    """Where a page or a folder of the project stands in the site."""
    if source == "README.md":
        return "index.html"
    if source.endswith(".md"):
        return source[:-3] + ".html"
    return source if pathlib.PurePath(source).suffix or (ROOT / source).is_file() else source.rstrip("/") + "/index.html"


class Site:
    def __init__(self, folder, version):
        self.folder, self.version = folder, version
        self.listed, self.copied = set(), set()

    def up(self, name):
        return "../" * name.count("/")

    def put(self, name, title, body):
        """Writes a page with the navigation around it."""
        entries = []
        for text, source in NAVIGATION:
            current = ' aria-current="page"' if html_name(source) == name else ""
            entries.append(f'<a href="{self.up(name)}{html_name(source)}"{current}>{html.escape(text)}</a>')
        entries.append("<b>Walkthroughs</b>")
        for walk in WALKTHROUGHS:
            target = f"docs/walkthroughs/{walk}.html"
            current = ' aria-current="page"' if target == name else ""
            entries.append(f'<a href="{self.up(name)}{target}"{current}>{walk}</a>')
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(
            f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n'
            f"<title>{html.escape(title)} - Eigencrust {self.version}</title>\n<style>{STYLE}</style>\n"
            f"<nav>{chr(10).join(entries)}</nav>\n<main>{body}</main>\n</html>\n",
            encoding="utf-8",
        )

    def follow(self, source, target):
        """The link of the site for a link of a page; what it leads to is put there."""
        if re.match(r"[a-z]+:", target) or target.startswith("#"):
            return target
        path, _, place = target.partition("#")
        there = (ROOT / source).parent.joinpath(path).resolve()
        if ROOT not in there.parents or not there.exists():
            return target  # check_links.py tells
        name = there.relative_to(ROOT).as_posix()
        if there.is_dir():
            self.list_folder(name)
        elif not name.endswith(".md"):
            self.copy(name)
        return self.up(html_name(source)) + html_name(name) + ("#" + place if place else "")

    def copy(self, name):
        if name not in self.copied:
            self.copied.add(name)
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, self.folder / name)

    def list_folder(self, name):
        if name in self.listed:
            return
        self.listed.add(name)
        entries = []
        for path in sorted((ROOT / name).iterdir()):
            if path.is_file() and not path.name.startswith("."):
                title = path.name
                if path.suffix == ".md":
                    title = re.sub(r"^# *", "", path.read_text(encoding="utf-8").split("\n", 1)[0])
                else:
                    self.copy(f"{name}/{path.name}")
                entries.append(f'<li><a href="{html_name(path.name)}">{html.escape(title)}</a></li>')
        self.put(f"{name}/index.html", name, f"<h1>{html.escape(name)}</h1><ul>{''.join(entries)}</ul>")

    def page(self, source):
        text = (ROOT / source).read_text(encoding="utf-8")
        converter = markdown.Markdown(extensions=["extra", "toc", "sane_lists"], extension_configs={"toc": {"slugify": slug}})
        body = converter.convert(text)
        body = re.sub(
            r'(href|src)="([^"]*)"',
            lambda found: f'{found[1]}="{html.escape(self.follow(source, html.unescape(found[2])))}"',
            body,
        )
        title = re.search(r"^# (.*)", text, re.MULTILINE)
        self.put(html_name(source), title[1] if title else source, body)


def main():
    site = Site(pathlib.Path(sys.argv[1]), sys.argv[2])
    sources = sorted(path.relative_to(ROOT).as_posix() for path in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
    for source in sources:
        site.page(source)
    site.list_folder("docs/decisions")
    site.put("docs/python-reference.html", "Python reference", python_reference.page())
    print(f"{len(sources)} pages")


if __name__ == "__main__":
    main()
