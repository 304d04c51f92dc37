"""Lines on standard output: colours where a terminal shows them, and news of steps that take long."""

import contextlib
import os
import time

import cadrefine_session as session

STYLES = {"bold": "\033[1m", "red": "\033[31m", "yellow": "\033[33m"}
END = "\033[0m"
FIRST_NEWS, NEXT_NEWS = 2.0, 5.0  # Seconds after which a step is told of, and after which again.
LAUNCHERS = ("mpirun", "mpiexec", "orterun", "orted", "prterun", "prted")


class Terminal:
    """`quiet`: nothing is printed. `clock` gives seconds."""

    def __init__(self, quiet=False, clock=time.monotonic):
        self.speaks = not quiet and session.speaks()
        self.coloured = self.speaks and shows_colours(1)
        self.clock = clock

    def say(self, line):
        if self.speaks:
            print(line, flush=True)

    def style(self, text, *names):
        return "".join(STYLES[name] for name in names) + text + END if names and self.coloured else text

    @contextlib.contextmanager
    def following(self, algorithm, title):
        """Tells now and then how far `algorithm`, a vtkAlgorithm, has come with what is done here."""
        if not self.speaks:
            yield
            return
        started = self.clock()
        news = {"due": started + FIRST_NEWS}

        def tell(_caller, _event):
            now = self.clock()
            if now >= news["due"] and algorithm.GetProgress() < 1:
                news["due"] = now + NEXT_NEWS
                self.say(progress_line(title, now - started, algorithm.GetProgressText(), algorithm.GetProgress()))

        tag = algorithm.AddObserver("ProgressEvent", tell)
        try:
            yield
        finally:
            algorithm.RemoveObserver(tag)


def progress_line(title, seconds, text, fraction):
    """'  refining, 12 s: projecting 1.2 of 4.0 million vertices, 31%', at most 100 columns."""
    words = f"{text}, " if text else ""
    return f"  {title}, {seconds:.0f} s: {words}{100 * fraction:.0f}%"[:100]


def shows_colours(number):
    """Whether what goes to this file descriptor (1 or 2) is shown on a terminal, and colours are wanted there."""
    if os.environ.get("NO_COLOR") or os.environ.get("TERM", "dumb") == "dumb":
        return False
    return os.isatty(number) and (launcher() is None or is_terminal(f"/proc/{launcher()}/fd/{number}"))


def launcher():
    """Process number of the mpirun that this process was started by: it gives ranks a terminal even where its own
    output goes to a file. None without it."""
    process = os.getpid()
    while process > 1:
        try:
            with open(f"/proc/{process}/stat", encoding="utf-8", errors="replace") as file:
                name, _, rest = file.read().partition("(")[2].rpartition(")")
        except OSError:
            return None
        if name in LAUNCHERS:
            return process
        process = int(rest.split()[1])
    return None


def is_terminal(path):
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_NOCTTY)
    except OSError:
        return False
    try:
        return os.isatty(descriptor)
    finally:
        os.close(descriptor)
