"""The matrix of cases x integrators: cells as they come in, their verdicts, and a summary."""

from artist_py.stress.case import INTEGRATORS, SameAs
from artist_py.stress.judge import FALSE_ALARM, Verdict, chance_per_comparison, judge


class Matrix:
    """Results of `cases`, of all integrators or of those named."""

    def __init__(self, cases, integrators=None):
        self.cases = list(cases)
        present = {
            name for case in cases for name in case.integrators if integrators is None or name in integrators
        }
        self.integrators = [name for name in INTEGRATORS if name in present]
        self.cells = {}
        self.count = sum(name in self.integrators for case in cases for name in case.integrators)
        self.chance = chance_per_comparison(self.count)

    def add(self, cell):
        """Note a `Cell`."""
        self.cells[cell.case.name, cell.integrator] = cell

    def verdict(self, cell):
        """The `Verdict` of a `Cell`; what it is compared with has to be there."""
        if cell.failure:
            return Verdict(*cell.failure)
        reference = None
        if isinstance(cell.case.expect, SameAs):
            other = self.cells.get((cell.case.name, cell.case.expect.integrator))
            reference = other and other.found
        return judge(cell.case, cell.integrator, cell.found, reference, self.chance)

    def text(self, case, integrator):
        """`(status, text)` of a cell of the table; the text gives standard errors and seconds."""
        cell = self.cells.get((case.name, integrator))
        if cell is None:
            return ("not run", "not run") if integrator in case.integrators else ("left out", "-")
        verdict = self.verdict(cell)
        figures = "" if verdict.z is None else f" {verdict.z:.1f} se"
        seconds = "" if cell.found is None else f" {cell.found.seconds:.1f} s"
        return verdict.status, f"{verdict.status}{figures}{seconds}"

    def faults(self):
        """(case, integrator, `Verdict`) of all that is wrong."""
        verdicts = [(cell.case, cell.integrator, self.verdict(cell)) for cell in self.cells.values()]
        return [each for each in verdicts if not each[2].is_ok]

    @property
    def is_ok(self):
        """Whether nothing is wrong, of at least one cell."""
        return bool(self.cells) and not self.faults()

    @property
    def summary(self):
        """One line."""
        count, wrong = len(self.cells), len(self.faults())
        found = f"{wrong} of {count} cells are wrong" if wrong else f"all {count} cells are right"
        rest = f", {self.count - count} were not run" if count < self.count else ""
        return f"{found}{rest}; a correct program fails such a run with probability {FALSE_ALARM:g}"
