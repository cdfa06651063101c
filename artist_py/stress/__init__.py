"""Extreme scenes that every integrator has to render right, or refuse in words; `artist stress` runs them.

`case.py` says what a case is, `cases/` holds them as data. To add one, write a `Case` in the file of `cases/` that it
belongs to.
"""
