"""Drives the real ParaView window: plays Qt events in it on a display of its own, and takes pictures of it.

The window is started with folders of settings of its own, so that it neither sees nor changes the user's.
"""

import glob
import itertools
import os
import re
import shutil
import struct
import subprocess
import sys
import threading
from xml.sax.saxutils import quoteattr

import numpy as np
from PIL import Image

SETTINGS = """[General]
GeneralSettings.ShowWelcomeDialog=false
[MainWindow]
Layout=true
Position=@Point(0 0)
Size=@Size({} {})
"""

CONSOLE = "pythonShellDock/pythonShell/consoleWidget"


def event(widget, command, arguments=""):
    """Something done to a widget of the main window; the name of another window's begins with a slash."""
    return ("event", widget, command, arguments)


def check(widget, qt_property, value):
    """A property that a widget of the main window must have."""
    return ("check", widget, qt_property, value)


def python(statement):
    """A statement that the Python of the window executes."""
    return event(CONSOLE, "executeCommand", statement)


class Window:
    """One run of the window; it loads `plugin`, if any, as it starts. `folder` is emptied and takes events, settings,
    log and pictures."""

    def __init__(self, plugin, folder, size=(1600, 1100)):
        self.size = size
        self.plugin = plugin
        self.folder = folder
        self.events = []
        self.meanwhile = None  # What is done in a thread while it runs: a function of this and the display.
        shutil.rmtree(folder, ignore_errors=True)
        for name in ("display", "runtime", "settings/ParaView", "output"):
            os.makedirs(os.path.join(folder, name), mode=0o700)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def play(self, *events):
        """Adds events to play."""
        self.events += events

    def picture(self, name):
        """Has a picture of the whole window taken now, also while a dialog is open."""
        dump = self.path("display", "Xvfb_screen0")
        self.play(event("", "pause", "300"), python(f"import shutil; shutil.copy({dump!r}, {self.dump(name)!r})"))

    def dump(self, name):
        return self.path("output", name + ".xwd")

    def run(self, timeout, *options):
        """Plays the events in a window with these options; returns the exit status, None where the window had to be
        killed."""
        self.write_settings()
        self.write_events()
        with open(self.path("log.txt"), "w", encoding="utf-8") as log, \
                Display(self.path("display"), self.size) as display:
            process = subprocess.Popen(self.command() + list(options), env=self.environment(display), stdout=log,
                                       stderr=subprocess.STDOUT)
            if self.meanwhile:
                threading.Thread(target=self.meanwhile, args=(self, display), daemon=True).start()
            try:
                return process.wait(timeout)
            except subprocess.TimeoutExpired:
                shutil.copy(self.path("display", "Xvfb_screen0"), self.dump("killed"))
                return None
            finally:
                process.kill()
                process.wait()

    def run_well(self, timeout, *options):
        """The same; says what went wrong and exits, where it did. Leaves the pictures as PNG, and returns them."""
        status = self.run(timeout, *options)
        pictures = self.pictures()
        log = self.log()
        if status != 0 or "ERR|" in log or "WARN|" in log:
            print("\n".join(line for line in log.splitlines() if "Available widget" not in line))
            reason = f"still ran after {timeout} s and was ended" if status is None else f"ended with status {status}"
            sys.exit(f"the window {reason}, or reported an error; pictures and log are in {self.folder}")
        return pictures

    def log(self):
        with open(self.path("log.txt"), encoding="utf-8", errors="replace") as file:
            return file.read()

    def pictures(self):
        """The pictures taken, by name; each is also left as PNG."""
        taken = {}
        for path in sorted(glob.glob(self.path("output", "*.xwd"))):
            name = os.path.splitext(os.path.basename(path))[0]
            with open(path, "rb") as file:
                taken[name] = Picture(file.read())
            taken[name].save(self.path(name + ".png"))
            os.remove(path)
        return taken

    def write_events(self):
        with open(self.path("events.xml"), "w", encoding="utf-8") as file:
            file.write("<?xml version=\"1.0\" ?>\n<pqevents>\n")
            file.writelines(as_xml(*item) for item in self.events)
            file.write("</pqevents>\n")

    def write_settings(self):
        said = subprocess.run(["pvserver", "--version"], capture_output=True, text=True, timeout=60, check=True).stdout
        number = re.search(r"\d+\.\d+\.\d+", said).group()
        with open(self.path("settings", "ParaView", f"ParaView{number}.ini"), "w", encoding="utf-8") as file:
            file.write(SETTINGS.format(*self.size))

    def command(self):
        folder, name = os.path.split(self.plugin or "")
        plugins = ["--plugin-search-paths", folder, "--plugins", os.path.splitext(name)[0]] if self.plugin else []
        return ["paraview", *plugins, "--test-directory", self.path("output"), "--test-script",
                self.path("events.xml"), "--exit"]

    def environment(self, display):
        return {**os.environ, "DISPLAY": display.name, "HOME": self.path("settings"),
                "XDG_CONFIG_HOME": self.path("settings"), "XDG_RUNTIME_DIR": self.path("runtime"),
                "QT_QPA_PLATFORM": "xcb", "PQOBJECTNAMING_MATCH_LIMIT": "0", "LC_ALL": "C.UTF-8"}


class Display:
    """An X server whose screen is the file Xvfb_screen0 of a folder. Its number comes from the process's: the lowest
    free one, which Xvfb and xvfb-run would take, may be that of a server that is just ending and takes its socket
    along. It does not start anew when its last client leaves, since the next one might come just then (-noreset)."""

    numbers = itertools.count(100 + os.getpid() % 30000 * 2)

    def __init__(self, folder, size=(1600, 1100)):
        self.name = ""
        while not self.name:
            self.start(f":{next(self.numbers)}", folder, f"{size[0]}x{size[1]}x24")

    def start(self, name, folder, screen):
        """The name stays empty where it is taken."""
        self.server = subprocess.Popen(["Xvfb", name, "-displayfd", "1", "-screen", "0", screen, "-fbdir", folder,
                                        "-nolisten", "tcp", "-noreset"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        if self.server.stdout.readline():
            self.name = name
        else:
            self.server.wait()
            self.server.stdout.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()
        self.server.stdout.close()


def as_xml(kind, widget, command, arguments):
    widget = quoteattr(widget[1:] if widget.startswith("/") else f"pqClientMainWindow/{widget}".rstrip("/"))
    name = "command" if kind == "event" else "property"
    return f"  <pq{kind} object={widget} {name}={quoteattr(command)} arguments={quoteattr(arguments)} />\n"


class Picture:
    """The display's picture (X window dump, 32 bits a pixel): `pixels` has shape (height, width, 3), red first."""

    def __init__(self, dump):
        header = struct.unpack(">25I", dump[:100])
        width, height, stride = header[4], header[5], header[12]
        if header[11] != 32:
            raise ValueError(f"{header[11]} bits a pixel instead of 32")
        rows = np.frombuffer(dump, np.uint8, height * stride, header[0] + 12 * header[19]).reshape(height, stride)
        self.pixels = rows[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1]

    def colors(self, box=None):
        """The number of colours within (left, top, right, bottom)."""
        left, top, right, bottom = box or (0, 0, *self.pixels.shape[1::-1])
        return len(np.unique(self.pixels[top:bottom, left:right].astype(np.uint32) @ (1 << 16, 1 << 8, 1)))

    def save(self, path):
        Image.fromarray(self.pixels).save(path)
