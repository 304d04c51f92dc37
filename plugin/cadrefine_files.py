"""Results are written beside their place, and put there together at the end: a run leaves all of them, or none.

A result FILE is made in the folder FILE.part. Until it is in its place, a failure removes this folder, and so does a
signal that ends the run, on each rank.
"""

import contextlib
import os
import re
import signal

import cadrefine_session as session

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Results:
    """The results that are being made, on the rank that speaks; on the others it does nothing."""

    def __init__(self):
        self.made = {}  # By the place of each result: paths of its files as they are made, after their folders.

    def path(self, place, companions=()):
        """Where to write what shall become `place`. `companions` are names of other files of the result, beside it or
        in a folder beside it, that go along with it."""
        folder = place + ".part"
        files = [os.path.join(folder, name) for name in (*companions, os.path.basename(place))]
        self.made[place] = sorted({os.path.dirname(file) for file in files}, key=len) + files
        session.remove_on_signal(self.made[place])
        if session.speaks():
            remove(self.made[place])
            if os.path.exists(folder):
                raise session.Failure(f"{place}: {folder} is in the way")
            os.mkdir(folder)
        return files[-1]

    def keep(self):
        """Puts all results in their places; the file that names others last. The signals that would end the run come too
        late from here on."""
        if not session.speaks():
            return
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)  # For all threads; a mask would be for this one.
        for place in list(self.made):
            if place.endswith(".pvtu"):
                remove_pieces(place)
            move(place + ".part", os.path.dirname(os.path.abspath(place)), last=os.path.basename(place))
            del self.made[place]

    def discard(self):
        if session.speaks():
            for paths in self.made.values():
                remove(paths)
        self.made = {}


def remove(paths):
    """Removes files, and folders that come before what is in them; what is not there is no matter."""
    for path in reversed(paths):
        with contextlib.suppress(OSError):
            (os.rmdir if os.path.isdir(path) else os.remove)(path)


def move(source, target, last=None):
    """Moves what is in the folder `source` into the folder `target`, over what is there."""
    os.makedirs(target, exist_ok=True)
    for name in sorted(os.listdir(source), key=lambda name: name == last):
        path = os.path.join(source, name)
        if os.path.isdir(path):
            move(path, os.path.join(target, name))
        else:
            os.replace(path, os.path.join(target, name))
    os.rmdir(source)


def remove_pieces(place):
    """Removes the pieces that the .pvtu file at `place`, if there is one, names, and nothing else of the user's."""
    if not os.path.isfile(place):
        return
    with open(place, encoding="utf-8", errors="replace") as file:
        pieces = re.findall(r'<Piece\s+Source="([^"]*)"', file.read())
    folder = os.path.basename(place)[: -len(".pvtu")]
    for piece in pieces:
        path = os.path.join(os.path.dirname(os.path.abspath(place)), piece)
        if re.fullmatch(re.escape(f"{folder}/{folder}_") + r"\d+\.vtu", piece) and os.path.isfile(path):
            os.remove(path)
