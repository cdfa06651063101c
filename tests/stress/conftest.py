"""Lets tests, and the child processes that they start, import `faults`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
