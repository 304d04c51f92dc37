"""Drives the real ParaView window: plays Qt events in it on a display of its own, and takes pictures of it.

The window is started with folders of settings of its own, so that it neither sees nor changes the user's.
"""

import os
import shutil
import signal
import struct
import subprocess
import threading
import time
import zlib
from xml.sax.saxutils import quoteattr

SIZE = (1600, 1100)

SETTINGS = f"""[General]
GeneralSettings.ShowWelcomeDialog=false
[MainWindow]
Layout=true
Position=@Point(0 0)
Size=@Size({SIZE[0]} {SIZE[1]})
"""

# The first events of each script do nothing: time to take the picture that the script before left.
IDLE = [("event", "", "comment", "")] * 5


def event(widget, command, arguments=""):
    """Something done to a widget of the main window."""
    return ("event", widget, command, arguments)


def check(widget, qt_property, value):
    """A property that a widget of the main window must have."""
    return ("check", widget, qt_property, value)


class Result:
    """What became of a run."""

    def __init__(self, status, log, pictures):
        self.status = status
        self.log = log
        self.pictures = pictures


class Window:
    """One run of the window; `folder` is emptied and takes scripts, settings, log and pictures."""

    def __init__(self, plugin, folder):
        self.plugin = plugin
        self.folder = folder
        self.scripts = []
        shutil.rmtree(folder, ignore_errors=True)
        for name in ("display", "runtime", "settings/ParaView", "output"):
            os.makedirs(os.path.join(folder, name), mode=0o700)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def stage(self, name, *events):
        """Adds events to play; a picture of the window is taken after the last of them."""
        path = self.path(f"{len(self.scripts):02d}_{name}.xml")
        with open(path, "w", encoding="utf-8") as file:
            file.write("<?xml version=\"1.0\" ?>\n<pqevents>\n")
            file.writelines(as_xml(*item) for item in IDLE + list(events))
            file.write("</pqevents>\n")
        self.scripts.append(path)

    def run(self, timeout):
        """Plays all stages; the status is None where the window had to be killed."""
        self.stage("end")
        self.write_settings()
        process = subprocess.Popen(self.command(), env=self.environment(), stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True)
        killed = []

        def kill():
            killed.append(True)
            self.take_picture(self.path("killed.png"))
            os.killpg(process.pid, signal.SIGKILL)

        timer = threading.Timer(timeout, kill)
        timer.start()
        lines, pictures = self.follow(process.stdout)
        status = process.wait()
        timer.cancel()
        with open(self.path("log.txt"), "w", encoding="utf-8") as file:
            file.writelines(lines)
        return Result(None if killed else status, lines, pictures)

    def follow(self, stream):
        """Reads what the window says; where it begins a script, the one before is pictured."""
        lines, pictures = [], {}
        for line in stream:
            lines.append(line)
            if line.startswith("Playing:"):
                number = sum(line.startswith("Playing:") for line in lines) - 2
                if number >= 0:
                    name = os.path.basename(self.scripts[number])[3:-4]
                    time.sleep(0.1)
                    pictures[name] = self.take_picture(os.path.splitext(self.scripts[number])[0] + ".png")
        return lines, pictures

    def write_settings(self):
        version = subprocess.run(["paraview", "--version"], env={**self.environment(), "QT_QPA_PLATFORM": "offscreen"},
                                 capture_output=True, text=True, timeout=60, check=False)
        number = (version.stdout + version.stderr).strip().split()[-1]
        with open(self.path("settings", "ParaView", f"ParaView{number}.ini"), "w", encoding="utf-8") as file:
            file.write(SETTINGS)

    def command(self):
        folder, name = os.path.split(self.plugin)
        screen = f"-screen 0 {SIZE[0]}x{SIZE[1]}x24 -fbdir {self.path('display')}"
        return ["xvfb-run", "--auto-servernum", "--server-args", screen, "paraview", "--plugin-search-paths", folder,
                "--plugins", os.path.splitext(name)[0], "--test-directory", self.path("output"),
                *[f"--test-script={script}" for script in self.scripts], "--exit"]

    def environment(self):
        return {**os.environ, "HOME": self.path("settings"), "XDG_CONFIG_HOME": self.path("settings"),
                "XDG_RUNTIME_DIR": self.path("runtime"), "QT_QPA_PLATFORM": "xcb", "PQOBJECTNAMING_MATCH_LIMIT": "0",
                "LC_ALL": "C.UTF-8"}

    def take_picture(self, path):
        with open(self.path("display", "Xvfb_screen0"), "rb") as file:
            picture = Picture(file.read())
        picture.save(path)
        return picture


def as_xml(kind, widget, command, arguments):
    widget = quoteattr(f"pqClientMainWindow/{widget}" if widget else "pqClientMainWindow")
    name = "command" if kind == "event" else "property"
    return f"  <pq{kind} object={widget} {name}={quoteattr(command)} arguments={quoteattr(arguments)} />\n"


class Picture:
    """The display's picture (X window dump, 32 bits a pixel)."""

    def __init__(self, dump):
        header = struct.unpack(">25I", dump[:100])
        self.width, self.height, stride = header[4], header[5], header[12]
        if header[11] != 32:
            raise ValueError(f"{header[11]} bits a pixel instead of 32")
        start = header[0] + 12 * header[19]
        self.rows = [dump[start + y * stride:start + y * stride + 4 * self.width] for y in range(self.height)]

    def colors(self, box=None):
        """The number of colours within (left, top, right, bottom)."""
        left, top, right, bottom = box or (0, 0, self.width, self.height)
        return len({row[4 * x:4 * x + 3] for row in self.rows[top:bottom] for x in range(left, right)})

    def save(self, path):
        """Writes a PNG file."""
        lines = bytearray()
        for row in self.rows:
            line = bytearray(3 * self.width)
            line[0::3], line[1::3], line[2::3] = row[2::4], row[1::4], row[0::4]
            lines += b"\0" + line
        header = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        with open(path, "wb") as file:
            file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(lines), 3)) +
                       chunk(b"IEND", b""))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
