#!/usr/bin/python3
"""Runs the commands of the documentation: the blocks ```bash and ```python of all pages.

Pages run side by side; the blocks of a page run in order in a folder of the page's own, where `build`, `data`, `docs`,
`plugin` and `tests` are those of the repository. Blocks of one language that follow each other run as one program, which
has the page's line numbers. Blocks ```console are for people: they need a window, a cluster, or minutes.

usage: test_commands.py BUILD [[--without] PAGE...]
"""

import concurrent.futures
import itertools
import os
import re
import subprocess
import sys
import tempfile
import time

import pages

sys.path.insert(0, os.path.join(pages.ROOT, "tests", "pvbatch"))
from driver import ENVIRONMENT

PROGRAMS = {"bash": ["bash", "-euo", "pipefail"], "python": ["pvpython"]}
LINKED = ("data", "docs", "plugin", "tests")
TIMEOUT = 400  # Seconds of one program.
SAY_WHERE = """trap 'echo "line $LINENO failed: $BASH_COMMAND"' ERR\n"""  # Read by bash before the script.
ERRORS = re.compile(r"ERR\||^ERROR|^Traceback", re.MULTILINE)


def programs(page):
    """Language and blocks of each program of a page."""
    runnable = [block for block in page.blocks if block.language in PROGRAMS]
    return [(language, list(blocks)) for language, blocks in itertools.groupby(runnable, lambda b: b.language)]


def make_folder(folder, build):
    os.mkdir(os.path.join(folder, "build"))
    os.symlink(build, os.path.join(folder, "build", "release"))
    for name in LINKED:
        os.symlink(os.path.join(pages.ROOT, name), os.path.join(folder, name))


def text_of(blocks):
    """The program, each line at its number in the page."""
    lines = []
    for block in blocks:
        lines += [""] * (block.first - len(lines)) + block.lines
    return "\n".join(lines) + "\n"


def run(page, language, blocks, folder, scripts):
    """What went wrong, or None."""
    script = os.path.join(scripts, page.name.replace(os.sep, "_") + {"bash": ".sh", "python": ".py"}[language])
    with open(script, "w", encoding="utf-8") as file:
        file.write(text_of(blocks))
    say_where = os.path.join(scripts, "say_where")
    with open(say_where, "w", encoding="ascii") as file:
        file.write(SAY_WHERE)
    environment = {**os.environ, **ENVIRONMENT, "BASH_ENV": say_where}
    environment.pop("CADREFINE_PLUGIN", None)  # People do not have it either.
    try:
        result = subprocess.run(PROGRAMS[language] + [script], cwd=folder, env=environment, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, errors="replace", timeout=TIMEOUT,
                                stdin=subprocess.DEVNULL, check=False)
    except subprocess.TimeoutExpired as error:
        return f"still ran after {TIMEOUT} s: {error.output}"
    if result.returncode != 0 or ERRORS.search(result.stdout):
        return f"ended with status {result.returncode}:\n{result.stdout}"
    return None


def run_page(page, build):
    """Failures of a page: the first one ends it."""
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as scripts:
        make_folder(folder, build)
        for language, blocks in programs(page):
            started = time.monotonic()
            failure = run(page, language, blocks, folder, scripts)
            lines = ", ".join(str(block.first) for block in blocks)
            print(f"{page.name}: {language}, lines {lines}: {time.monotonic() - started:.1f} s", flush=True)
            if failure:
                return [f"{page.name}, {language}, lines {lines}: {failure}"]
    return []


def main():
    build = os.path.abspath(sys.argv[1])
    without = sys.argv[2:3] == ["--without"]
    named = {os.path.abspath(path) for path in sys.argv[3 if without else 2:]}
    chosen = [page for page in pages.all_pages() if programs(page) and (not named or (page.path in named) != without)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        failures = list(itertools.chain.from_iterable(pool.map(lambda page: run_page(page, build), chosen)))
    print(*failures, sep="\n")
    if failures or not chosen:
        sys.exit(f"{len(failures)} of {len(chosen)} pages failed")


if __name__ == "__main__":
    main()
