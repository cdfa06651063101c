"""What a case does in its process where it should write a file: to see how that is reported."""

import os
import time


def crash(_path):
    """End the process as a fault in native code would."""
    os.abort()


def hang(_path):
    """Take for ever."""
    time.sleep(3600)


def fail(_path):
    """Raise what nobody expects."""
    raise ZeroDivisionError("on purpose")
