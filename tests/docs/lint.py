#!/usr/bin/python3
"""The format of the pages: lines of at most 120 columns, fenced code in known languages, small pictures. Prints what is
amiss, a line each, and ends with 1 where there is anything."""

import os
import sys

import pages

LANGUAGES = {"bash", "python", "console", "text", "json", "xml", "cmake", "cpp", "c", "yaml", "make"}
LARGEST_PICTURE = 600_000  # Bytes; in full colours.
WIDTH = 120


def large_pictures():
    for path in sorted(pages.pictures()):
        size = os.path.getsize(path)
        if size > LARGEST_PICTURE:
            yield f"{os.path.relpath(path, pages.ROOT)}: {size} bytes"


def indented_code(page):
    previous, in_list = "", False
    for number, line in page.prose:
        if line and not line.startswith(" "):
            in_list = line.startswith(("* ", "- ")) or line[0].isdigit()
        if line.startswith("    ") and not previous.strip() and not in_list:
            yield f"{page.name}:{number}: indented code; put it into a fence"
        previous = line


def unknown_languages(page):
    for block in page.blocks:
        if block.language not in LANGUAGES:
            yield f"{page.name}:{block.first}: {block.language or 'no language'}"


def long_lines(page):
    """But for tables, addresses, and what a program printed."""
    printed = {block.first + i for block in page.blocks if block.language == "text"
               for i in range(1, len(block.lines) + 1)}
    for number, line in enumerate(page.lines, 1):
        if len(line) > WIDTH and number not in printed and not line.startswith("|") and "://" not in line:
            yield f"{page.name}:{number}: {len(line)} columns"


def main():
    found = [*large_pictures()]
    for page in pages.all_pages():
        found += [*indented_code(page), *unknown_languages(page), *long_lines(page)]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
