"""Lets the tests of this folder import `rendering`, which those of several folders share."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))
