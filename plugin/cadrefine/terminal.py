"""Lines on standard output: colours where a terminal shows them, and news of steps that take long."""

import contextlib
import os
import time

from cadrefine import session

STYLES = {"bold": "\033[1m", "red": "\033[31m", "yellow": "\033[33m"}
END = "\033[0m"
FIRST_NEWS, NEXT_NEWS = 2.0, 5.0  # Seconds after which a step is told of, and after which again.


class Terminal:
    """`quiet`: nothing is printed. `clock` gives seconds."""

    def __init__(self, quiet=False, clock=time.monotonic):
        self.speaks = not quiet and session.speaks()
        self.coloured = self.speaks and shows_colours(1)
        self.clock = clock

    def say(self, line):
        if self.speaks:
            print(line)
            session.flush()

    def style(self, text, *names):
        return "".join(STYLES[name] for name in names) + text + END if names and self.coloured else text

    @contextlib.contextmanager
    def following(self, algorithm, title="", parts=0):
        """Tells now and then how far `algorithm`, a vtkAlgorithm, has come with what is done here; with `parts`, how
        far it is with one of so many, which its texts begin with, as in "Step 2: splitting cells"."""
        if not self.speaks:
            yield
            return
        news = News(self.clock(), title)

        def tell(_caller, _event):
            text, progress = algorithm.GetProgressText(), algorithm.GetProgress()
            line = news.line(self.clock(), text, progress, parts) if progress < 1 else None
            if line:
                self.say(line)

        tag = algorithm.AddObserver("ProgressEvent", tell)
        try:
            yield
        finally:
            algorithm.RemoveObserver(tag)


class News:
    """Of what has begun at the second `now`."""

    def __init__(self, now, title):
        self.begin(now, title, 0.0)

    def begin(self, now, title, progress):
        self.title, self.started, self.progress, self.due = title, now, progress, now + FIRST_NEWS

    def line(self, now, text, progress, parts):
        """What to tell now, or None."""
        if parts:
            title, _, text = (text or "").partition(": ")
            if title.lower() != self.title:
                self.begin(now, title.lower(), progress)
            progress = (progress - self.progress) * parts
        if now < self.due:
            return None
        self.due = now + NEXT_NEWS
        return progress_line(self.title, now - self.started, text, progress)


def progress_line(title, seconds, text, fraction):
    """'  refining, 12 s: projecting 1.2 of 4.0 million vertices, 31%', at most 100 columns."""
    words = f"{text}, " if text else ""
    return f"  {title}, {seconds:.0f} s: {words}{100 * fraction:.0f}%"[:100]


def shows_colours(number):
    """Whether what goes to this file descriptor (1 or 2) is shown on a terminal, and colours are wanted there."""
    if os.environ.get("NO_COLOR") or os.environ.get("TERM", "dumb") == "dumb":
        return False
    # mpirun gives its ranks a terminal even where its own output goes to a file. (Open MPI sets the variable.)
    by_mpirun = "OMPI_COMM_WORLD_SIZE" in os.environ
    return os.isatty(number) and (not by_mpirun or is_terminal(f"/proc/{os.getppid()}/fd/{number}"))


def is_terminal(path):
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_NOCTTY)
    except OSError:
        return False
    try:
        return os.isatty(descriptor)
    finally:
        os.close(descriptor)
