"""CADRefine installed to a folder for a test: outside the build, in which there is one CADRefine.so only."""

import glob
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ["CADREFINE_BUILD"]

sys.path.insert(0, os.path.join(ROOT, "tests", "pvbatch"))
import driver  # noqa: E402


def run(*command, timeout=driver.TIMEOUT, **environment):
    """Runs a command to its good end with these variables set, and without those that name a plugin. Returns its
    output."""
    clean = {name: value for name, value in os.environ.items()
             if name not in ("CADREFINE_PLUGIN", "PV_PLUGIN_PATH", "PV_PLUGIN_CONFIG_FILE", "PYTHONPATH", "DESTDIR")}
    result = subprocess.run([str(part) for part in command], env={**clean, **driver.ENVIRONMENT, **environment},
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, stdin=subprocess.DEVNULL,
                            timeout=timeout, check=False)
    assert result.returncode == 0, f"{command}: exit status {result.returncode}\n{result.stdout}"
    return result.stdout


def files_in(folder):
    """Paths of the files and links below a folder, relative to it."""
    found = glob.glob("**", root_dir=folder, recursive=True, include_hidden=True)
    return sorted(path for path in found
                  if os.path.islink(os.path.join(folder, path)) or not os.path.isdir(os.path.join(folder, path)))


def loaded_libraries(*command, **environment):
    """Paths of the shared libraries that the processes of a command load, and of the programs that they are."""
    with tempfile.TemporaryDirectory() as folder:
        run(*command, LD_DEBUG="files", LD_DEBUG_OUTPUT=os.path.join(folder, "process"), **environment)
        found = set()
        for path in glob.glob(os.path.join(folder, "*")):
            with open(path, encoding="utf-8", errors="replace") as file:
                found.update(re.findall("(?:calling init|initialize program): (.*)", file.read()))
    return {os.path.realpath(path) for path in found}


def cache_entry(name):
    """Value that CMake keeps for the build; empty where there is none."""
    with open(os.path.join(BUILD, "CMakeCache.txt"), encoding="utf-8") as file:
        found = re.search(f"^{name}:[A-Z]+=(.*)$", file.read(), re.MULTILINE)
    return found.group(1) if found else ""


def only_one(pattern):
    """The one path that the pattern stands for."""
    found = glob.glob(pattern, recursive=True)
    assert len(found) == 1, f"{pattern}: {found}"
    return found[0]


class Installation:
    """What `cmake --install` makes of a build, in a folder that goes with the object's cleanup()."""

    def __init__(self, build=BUILD):
        self.folder = tempfile.TemporaryDirectory()
        self.prefix = os.path.join(self.folder.name, "prefix")
        run("cmake", "--install", build, "--prefix", self.prefix)

    def path(self, *parts):
        return os.path.join(self.prefix, *parts)

    def data(self, name):
        return self.path("share", "cadrefine", "data", name)

    def python_path(self):
        return only_one(self.path("lib", "python3*", "dist-packages"))

    def plugin_folder(self):
        return only_one(self.path("lib", "cadrefine"))

    def scratch(self, name):
        return os.path.join(self.folder.name, name)

    def cleanup(self):
        self.folder.cleanup()
