"""Results are written beside their place, and put there together at the end: a run leaves all of them, or none.

A result FILE is made in the folder FILE.part, which is there from the beginning of the run: its file LOCK keeps other
runs from writing the same result. Until the result is in its place, a failure removes this folder. What a run leaves
that was killed, the next one removes.

FILE.part/N holds what was made in step N. A signal that ends the run puts the last whole step in place:
1. The rank that is first to rename the lock does so, even where another one was killed, and removes the step before.
2. Every rank removes what is unfinished, since each may be writing a piece.
3. What has become whole is taken from the unfinished on all ranks before it is put in place by any.
"""

import contextlib
import fcntl
import os
import shutil
import signal

from cadrefine import session
from cadrefine.exchange import carry_out, exchange, folders_of

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
LOCK = "lock"


class Results:
    """The results that are being made. The rank that speaks alone touches files."""

    def __init__(self):
        self.places = []
        self.locks = {}  # By the place of each result: the lock of its folder.
        self.step = 0
        self.folders = {}  # By place: where it was made last.
        self.unfinished = {}  # By place: folders and files that are being made.
        self.whole = []  # Folders and files that were made for what a signal puts in place.
        self.exchange = []  # What puts these in place.
        self.lines = (session.NOTHING_WRITTEN, "")  # What is said then, and where that fails.

    def claim(self, places):
        """Keeps other runs from writing these results, until this one has written or discarded them."""
        self.places = list(places)
        for place in places if session.speaks() else ():
            with failing_for(place):
                self.locks[place] = lock_folder(place)
        self.arm()

    def path(self, place, companions=()):
        """Where to write what shall become `place`, which is claimed. `companions` are names of other files of the
        result, beside it or in a folder beside it, that go along with it."""
        folder = self.folders[place] = os.path.join(folder_of(place), str(self.step))
        files = [os.path.join(folder, name) for name in (*companions, os.path.basename(place))]
        folders = {os.path.join(folder, inside) for name in companions for inside in folders_of(name)}
        self.unfinished[place] = sorted({folder, *folders}, key=len) + files
        self.arm()
        if session.speaks():
            with failing_for(place):
                os.makedirs(folder, exist_ok=True)
        return files[-1]

    def arm(self):
        """Tells all ranks what to do on a signal."""
        if not self.places:
            return
        lock = lock_of(self.places[0])
        inside = [path for paths in self.unfinished.values() for path in paths]
        outside = [path for place in self.places for path in (folder_of(place), lock_of(place))]
        session.on_signal(*self.lines,
                          [(lock, taken(lock)), *self.exchange, *((path, "") for path in reversed(self.whole))],
                          [*reversed(inside), taken(lock), *reversed(outside)])

    def keep_on_signal(self, places, what):
        """What was made for `places` is whole: from now on a signal puts that in place, instead of what was whole
        before. `what` is in the first of them."""
        before = self.whole
        made = [path for place in places for path in self.unfinished.pop(place)]
        self.whole = before + made
        self.arm()  # No rank takes it for unfinished any more.
        with failing_for(places[0]):
            self.exchange = [action for place in places for action in exchange(self.folders[place], place)]
        self.lines = (f"ended by a signal; {places[0]} holds {what}",
                      f"ended by a signal; {places[0]}: could not be replaced; {what} is in {folder_of(places[0])}")
        self.arm()
        self.whole = made
        if session.speaks():
            for path in before:
                shutil.rmtree(path, ignore_errors=True)
        self.step += 1

    def keep(self):
        """Puts all results in their places. The signals that would end the run come too late from here on."""
        for number in SIGNALS if session.speaks() else ():
            signal.signal(number, signal.SIG_IGN)  # For all threads; a mask would be for this one.
        session.on_signal()
        for place in list(self.locks):
            with failing_for(place):
                carry_out(exchange(self.folders[place], place))
            self.release(place)

    def discard(self):
        if self.places:
            session.on_signal()
        for place in list(self.locks):
            self.release(place)

    def release(self, place):
        """Removes the folder, with what is left in it."""
        with contextlib.suppress(OSError):
            empty(folder_of(place))
            os.remove(lock_of(place))
            os.rmdir(folder_of(place))
        os.close(self.locks.pop(place))


def folder_of(place):
    return place + ".part"


def lock_of(place):
    return os.path.join(folder_of(place), LOCK)


def taken(lock):
    return lock + ".taken"


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
