"""What Ctrl-C and a polite kill do to a render: the first ends it early, the second at once."""

import os
import signal
import threading
from contextlib import contextmanager, suppress

INTERRUPTED = 130  # exit code
CLEANUP_SECONDS = 0.3
SHOW_CURSOR = b"\x1b[?25h"
SIGNALS = (signal.SIGINT, signal.SIGTERM)
MESSAGE = b"\ninterrupted: ending the render and writing what there is; once more to quit at once\n"


def _quit():
    if os.isatty(2):
        os.write(2, SHOW_CURSOR)  # the bar has hidden it
    os._exit(INTERRUPTED)


@contextmanager
def stop_signals():
    """Yield a threading.Event that the first SIGINT or SIGTERM sets; the second raises KeyboardInterrupt.

    What that leaves running, such as a compiler in another thread, is not waited for.
    """
    stop = threading.Event()

    def handle(_number, _frame):
        if stop.is_set():
            end = threading.Timer(CLEANUP_SECONDS, _quit)
            end.daemon = True
            end.start()
            raise KeyboardInterrupt
        stop.set()
        # Python's streams refuse to be entered twice, and the signal may have come in the middle of a print.
        with suppress(OSError):
            os.write(2, MESSAGE)

    before = {number: signal.signal(number, handle) for number in SIGNALS}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
