#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Do all links inside a site lead to a file of it, and to a place in it? Usage: check_links.py FOLDER

Prints the links that do not and how many there are; the exit status is 1 where one leads nowhere.
"""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """Links and named places of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.places = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if value is None:
                continue
            if name == "id" or (tag == "a" and name == "name"):
                self.places.add(value)
            elif name in ("href", "src"):
                self.links.append(value)


def check(folder):
    """(number of links, complaints)"""
    pages = {path.resolve(): Page(path) for path in sorted(folder.rglob("*.html"))}
    count, complaints = 0, []
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            where = path.relative_to(folder.resolve())
            place = urllib.parse.unquote(parts.fragment)
            if not target.is_file():
                complaints.append(f"{where}: {link} is not there")
            elif place and target in pages and place not in pages[target].places:
                complaints.append(f"{where}: {link} has no such place")
            elif folder.resolve() not in target.parents:
                complaints.append(f"{where}: {link} leads out of the site")
    return count, complaints


if __name__ == "__main__":
    links, wrong = check(pathlib.Path(sys.argv[1]))
    print("\n".join(wrong + [f"{links} links, {len(wrong)} lead nowhere"]))
    sys.exit(1 if wrong else 0)
