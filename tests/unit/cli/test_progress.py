"""What a render says while it runs."""

import sys
import time

import pytest

from artist_py.cli.progress import BarObserver, Budget, LineObserver, Observer, duration_text, make_observer


class TestProgress:
    """Observers."""

    def test_fraction(self):
        """The limit that is nearest counts; without any, nothing is known."""
        assert Budget(10, None, None).fraction(5, 99, None) == 0.5
        assert Budget(None, 60, None).fraction(5, 45, None) == 0.75
        assert Budget(None, None, 0.01).fraction(5, 1, 0.04) == 0.25
        assert Budget(10, 60, 0.01).fraction(1, 30, None) == 0.5
        assert Budget(10, None, None).fraction(11, 1, None) == 1
        assert Budget(None, None, 0.01).fraction(0, 0, None) == 0

    @pytest.mark.parametrize(
        ("seconds", "text"),
        [(4.24, "4.2 s"), (59.94, "59.9 s"), (185, "3 m 05 s"), (3599.6, "1 h 00 m"), (7620, "2 h 07 m")],
    )
    def test_durations(self, seconds, text):
        """As people write them."""
        assert duration_text(seconds) == text

    def test_lines_come_every_two_seconds(self, capsys, monkeypatch):
        """Ten seconds give six lines, however often the sampler reports."""
        now = [100.0]
        monkeypatch.setattr(time, "monotonic", lambda: now[0])
        observer = LineObserver(Budget(100, None, None), None)
        for i in range(101):
            observer.progress(i, 100, 0.1 * i, 10 * i, 1234.0)
            now[0] += 0.1
        lines = capsys.readouterr().err.splitlines()
        assert len(lines) in {5, 6}
        assert lines[0] == "iteration 0 of 100, 0.0%, 1.23 k paths/s, 0.0 s"

    def test_bar(self, capsys):
        """The bar can be drawn, moved, spoken over and taken away."""
        observer = BarObserver(Budget(4, None, None), None)
        observer.started({"threads": 2})
        observer.progress(2, 4, 1.0, 10, 5.0, 0.25)
        observer.warning("[red]not markup[/red]")
        observer.close()
        observer.note("the end")
        err = capsys.readouterr().err
        assert "rendering: threads 2" in err
        assert "warning: [red]not markup[/red]" in err
        assert "the end" in err

    def test_kinds(self, monkeypatch):
        """A bar on a terminal, lines elsewhere, warnings only when quiet."""
        budget = Budget(1, None, None)
        monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
        assert type(make_observer(budget, None)) is BarObserver
        assert type(make_observer(budget, None, quiet=True)) is Observer
        monkeypatch.setattr(sys.stderr, "isatty", lambda: False, raising=False)
        assert type(make_observer(budget, None)) is LineObserver
