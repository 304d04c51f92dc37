"""Results are written beside their place, and put there together at the end: a run leaves all of them, or none.

A result FILE is made in the folder FILE.part, which is there from the beginning of the run: its file LOCK keeps other
runs from writing the same result. Until the result is in its place, a failure removes this folder, and so does a signal
that ends the run, on each rank. What a run leaves that was killed, the next one removes.
"""

import contextlib
import fcntl
import os
import re
import signal

import cadrefine_session as session

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
LOCK = "lock"


class Results:
    """The results that are being made, on the rank that speaks; on the others it does nothing."""

    def __init__(self):
        self.claimed = False
        self.locks = {}  # By the place of each result: the lock of its folder.

    def claim(self, places):
        """Keeps other runs from writing these results, until this one has written or discarded them."""
        self.claimed = True
        for place in places if session.speaks() else ():
            with failing_for(place):
                self.locks[place] = lock_folder(place)
        session.remove_on_signal([path for place in places for path in (folder_of(place), lock_of(place))])

    def path(self, place, companions=()):
        """Where to write what shall become `place`, which is claimed. `companions` are names of other files of the
        result, beside it or in a folder beside it, that go along with it."""
        folder = folder_of(place)
        files = [os.path.join(folder, name) for name in (*companions, os.path.basename(place))]
        session.remove_on_signal(sorted({os.path.dirname(file) for file in files} - {folder}, key=len) + files)
        return files[-1]

    def keep(self):
        """Puts all results in their places. The signals that would end the run come too late from here on."""
        session.remove_nothing_on_signal()
        if not session.speaks():
            return
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)  # For all threads; a mask would be for this one.
        for place in list(self.locks):
            with failing_for(place):
                put_in_place(place)
            self.release(place)

    def discard(self):
        if self.claimed:
            session.remove_nothing_on_signal()
        for place in list(self.locks):
            with contextlib.suppress(OSError):
                empty(folder_of(place))
            self.release(place)

    def release(self, place):
        """Removes the folder, where nothing is left in it but the lock."""
        with contextlib.suppress(OSError):
            os.remove(lock_of(place))
            os.rmdir(folder_of(place))
        os.close(self.locks.pop(place))


def folder_of(place):
    return place + ".part"


def lock_of(place):
    return os.path.join(folder_of(place), LOCK)


@contextlib.contextmanager
def failing_for(place):
    """Errors of the operating system become failures that name the result."""
    try:
        yield
    except OSError as error:
        raise session.Failure(f"{place}: {error.strerror}") from None


def lock_folder(place):
    """Makes the folder, empty but for its lock; returns the lock. What a killed run left there goes."""
    folder, lock = folder_of(place), lock_of(place)
    while True:
        is_new = not os.path.lexists(folder)
        with contextlib.suppress(FileExistsError):
            os.mkdir(folder)
        with contextlib.suppress(FileNotFoundError):  # Where another run ends just now.
            if not os.path.isdir(folder) or (os.listdir(folder) and not os.path.exists(lock)):
                raise session.Failure(f"{place}: {folder} is in the way")
            descriptor = os.open(lock, os.O_RDWR | os.O_CREAT, 0o600)
            try:
                take_lock(descriptor, place, is_new)
                if is_open_file(descriptor, lock):
                    empty(folder)
                    return descriptor
            except BaseException:
                os.close(descriptor)
                raise
            os.close(descriptor)


def take_lock(descriptor, place, is_new):
    """Where the file system has no locks, a folder that is there already tells of another run."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise session.Failure(f"{place}: another run is writing it") from None
    except OSError:
        if not is_new:
            raise session.Failure(f"{place}: another run is writing it, or has left {folder_of(place)}") from None


def is_open_file(descriptor, path):
    """False where another run has ended meanwhile, and removed it."""
    with contextlib.suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(descriptor), os.stat(path))
    return False


def empty(folder):
    """Removes all from a folder of results but its lock."""
    for inside, folders, files in os.walk(folder, topdown=False):
        for name in files:
            if (inside, name) != (folder, LOCK):
                os.remove(os.path.join(inside, name))
        for name in folders:
            os.rmdir(os.path.join(inside, name))


def put_in_place(place):
    """From its folder, over what is there. Where the result is several files, the one that names the others goes first
    and comes last, so that it never names files of two runs."""
    folder = folder_of(place)
    if len(os.listdir(folder)) > 2 and os.path.exists(place):  # The lock and the result itself.
        if place.endswith(".pvtu"):
            remove_pieces(place)
        os.remove(place)
    move(folder, os.path.dirname(os.path.abspath(place)), last=os.path.basename(place))


def move(source, target, last=None):
    """Moves what is in the folder `source`, but for the lock, into the folder `target`, over what is there."""
    os.makedirs(target, exist_ok=True)
    for name in sorted(os.listdir(source), key=lambda name: name == last):
        path = os.path.join(source, name)
        if os.path.isdir(path):
            move(path, os.path.join(target, name))
            os.rmdir(path)
        elif name != LOCK:
            os.replace(path, os.path.join(target, name))


def remove_pieces(place):
    """Removes the pieces that the .pvtu file at `place` names, and nothing else of the user's."""
    with open(place, encoding="utf-8", errors="replace") as file:
        pieces = re.findall(r'<Piece\s+Source="([^"]*)"', file.read())
    folder = os.path.basename(place)[: -len(".pvtu")]
    for piece in pieces:
        path = os.path.join(os.path.dirname(os.path.abspath(place)), piece)
        if re.fullmatch(re.escape(f"{folder}/{folder}_") + r"\d+\.vtu", piece) and os.path.isfile(path):
            os.remove(path)
