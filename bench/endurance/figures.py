"""The lines of the table: what was measured, what was wanted, whether it held; and what a process takes."""


class Table:
    def __init__(self, part, store):
        self.part = part
        self.store = store
        self.held = True

    def row(self, name, value, unit="", wanted=None, at_most=True):
        verdict = ""
        if wanted is not None:
            held = value <= wanted if at_most else value >= wanted
            self.held &= held
            verdict = "%s %g %s  %s" % ("<=" if at_most else ">=", wanted, unit, "held" if held else "MISSED")
        print("%-6s %-11s %-44s %12g %-7s %s" % (self.part, self.store, name, value, unit, verdict), flush=True)


def peak_memory(pid):
    """MiB that the process has had at most; 0 where it has gone."""
    try:
        with open("/proc/%d/status" % pid) as file:
            lines = dict(line.split(":", 1) for line in file)
        return int(lines["VmHWM"].split()[0]) / 1024
    except (OSError, KeyError):
        return 0
