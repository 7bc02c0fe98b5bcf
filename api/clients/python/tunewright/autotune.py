"""A test of a real loop between any two functions, and the settings that follow from it.

    from tunewright import autotune

    tuned = autotune(read=lambda: lab.T1, write=lab.Q1, u=30, sample_time=1, u_step=20, u_min=0, u_max=100, y_max=80)
    print(tuned.controller)

The test is the program that `tunewright code --experiment` writes for controllers. It runs here; the service only sees the
record. Whatever happens (a fault, a lost connection, Ctrl-C), u ends at its safe value.
"""

import contextlib
import signal
import threading
import time
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from . import bump_program, relay_program
from .client import Client

__all__ = ["Autotuned", "TestStopped", "autotune"]

Json = Dict[str, Any]
Reading = Union[float, Tuple[float, bool]]

_TRIES = 3  # of writing the safe value
_MOST_COST = 1.5
_PROGRAMS: Dict[str, Any] = {"relay": (relay_program.TunewrightRelay, relay_program.REASONS),
             "bump": (bump_program.TunewrightBump, bump_program.REASONS)}
_SIGNS = {"reverse": 1.0, "direct": -1.0, "find": 0.0}
_DONE, _STOPPED = 4, 5  # modes of the programs
_BEYOND = "the test cannot begin"


class TestStopped(Exception):
    """The test ended without a complete record. `reason` is the program's code (0 if the program did not end it), `record`
    what was recorded; u is at its safe value unless the message says otherwise."""

    __test__ = False  # for pytest, which takes the name for a test's

    def __init__(self, message: str, reason: int, record: Json) -> None:
        super().__init__(message)
        self.reason = reason
        self.record = record


class Autotuned(NamedTuple):
    """What a test led to. `result` is the job's result: all figures, the verdict, and the model with its errors."""

    controller: Json  #: of the first entry of the ranking
    settings: Optional[Json]  #: for the product, as Client.settings() answers; None without a product
    result: Any  #: Result
    record: Json  #: t, u, y
    enough: bool  #: the design holds on every plant that fits the record, at an acceptable cost
    missing: List[str]  #: sentences of the service: what the record does not determine, and what to do
    ended: str  #: why the test ended


def autotune(read: Callable[[], Reading], write: Callable[[float], Optional[float]], u: float, *, sample_time: float,
             u_step: float, client: Any = None, experiment: str = "relay",
             tune: Optional[Sequence[Mapping[str, Any]]] = None, Ms: float = 1.4, product: Optional[str] = None,
             settings: Optional[Mapping[str, Any]] = None, name: Optional[str] = None, keep: Optional[str] = None,
             most_cost: float = _MOST_COST, show: Optional[Callable[[str], None]] = print, background: bool = True,
             clock: Callable[[], float] = time.monotonic, sleep: Callable[[float], None] = time.sleep,
             **limits: Any) -> Autotuned:
    """Runs a relay test or a bump, and returns settings.

    `read()` returns y, or (y, False) for a bad measurement; `write(u)` sets u and may return, as a float, the u that the
    device has accepted (not the position of a slow valve).
    An exception of either is a fault. `u` is the present u, which the test begins from and gives back. Times are in
    seconds. `limits`: u_min, u_max, y_min, y_max, u_safe, rate_limit, max_time, quiet_time, hysteresis, frozen_time,
    asymmetry, cycles, action, y_move, as POST /v1/experiments/code describes them.

    While the test runs, the record so far is sent after each cycle, and `show` gets the model with its errors. The test
    ends early when a design holds on all plants that fit the record, twice in a row, with at most `most_cost` times the
    load IAE of the design on the model alone. `keep` is a file that gets each row as it comes. `background` false sends
    the record between two samples, for plants that are simulated. `settings` are further arguments of Client.settings()
    for `product`, such as y_span and u_span.

    Raises TestStopped after a fault; KeyboardInterrupt after Ctrl-C; Problem for limits that are not valid, before
    anything is moved. In all these cases u is at `u_safe`, or at `u` if there is none. If the service is lost for longer
    than the client's timeout after a complete test, or refuses the record, the exception has the record in `record`.
    """
    client = client or Client()
    show = show or (lambda line: None)
    asked = dict(limits, experiment=experiment, sample_time=sample_time, u_step=u_step)
    methods = list(tune or [{"method": "robust", "Ms": Ms}])
    # What is not valid is refused before the plant is moved.
    client.experiment(language="python", **asked)
    client.design({"type": "fopdt", "K": 1, "T": 10, "L": 2}, methods[0])
    if product:
        client.get("/v1/controllers/" + product)
    test = _Test(experiment, asked, read, write, float(u), clock, sleep, keep)
    test.refuse_out_of_reach()
    designs = _Designs(client, {"tune": methods, "evaluate": {"points": 0}}, most_cost, show, background)
    with _stops_as_interrupts():
        ended = test.run(designs)
    show("the test is complete (%s): the design follows" % ended)
    try:
        result = client.run(dict(designs.request, record=test.record(), **({"name": name} if name else {})))
        controller = result.best["controller"]
        typed = client.settings(product, controller, **dict({"sample_time": sample_time, "nearest": True},
                                                            **(settings or {}))) if product else None
    except BaseException as fault:
        fault.record = test.record()  # type: ignore[attr-defined]
        raise
    show(_line("complete", result))
    return Autotuned(controller, typed, result, test.record(), _good(result, most_cost), _missing(result, most_cost), ended)


@contextlib.contextmanager
def _stops_as_interrupts() -> Iterator[None]:
    """A program that is asked to end (SIGTERM, SIGHUP) ends like by Ctrl-C: with u at its safe value."""
    asked = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    if threading.current_thread() is not threading.main_thread():
        asked = []

    def end(number: int, frame: Any) -> None:
        raise SystemExit(128 + number)

    before = {number: signal.signal(number, end) for number in asked}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def _undisturbed() -> Iterator[None]:
    """A second Ctrl-C waits until the safe value is written."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {number: signal.signal(number, signal.SIG_IGN) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


class _Test:
    """The program, the two functions, and the rows."""

    def __init__(self, experiment: str, asked: Mapping[str, Any], read: Callable[[], Reading],
                 write: Callable[[float], Optional[float]], u: float, clock: Callable[[], float],
                 sleep: Callable[[float], None], keep: Optional[str]) -> None:
        make, reasons = _PROGRAMS[experiment]
        self.program: Any = make()
        self.reasons: Dict[int, str] = reasons
        self.read, self.write, self.u, self.clock, self.sleep, self.keep = read, write, u, clock, sleep, keep
        self.rows: List[Tuple[float, float, float]] = []
        self.lost: Optional[Exception] = None  #: that of the last read()
        self.asked = dict(asked)
        self._configure(self.program, dict(asked))

    def refuse_out_of_reach(self) -> None:
        """A step that u cannot make is a mistake, not a fault of the plant: nothing is written."""
        trial: Any = type(self.program)()
        self._configure(trial, dict(self.asked))
        trial.step(0.0, self.u, False)
        reason = trial.step(0.0, self.u, True)[2]
        if self.reasons[reason].startswith(_BEYOND):
            raise ValueError("u is %g: %s." % (self.u, self.reasons[reason]))

    def _configure(self, program: Any, asked: Dict[str, Any]) -> None:
        """The settings of the program that follow from the members of the request."""
        Ts = float(asked.pop("sample_time"))
        del asked["experiment"]
        given = {"Ts": Ts, "longest_gap": 5 * Ts, "u_tolerance": abs(float(asked["u_step"])) / 10,
                 "sign": _SIGNS[asked.pop("action", "find")], "hysteresis_min": float(asked.pop("hysteresis", None) or 0),
                 "quiet_time": float(asked.pop("quiet_time", None) or 30 * Ts),
                 "max_time": float(asked.pop("max_time", None) or 5000 * Ts)}
        given.update({name: float(value) for name, value in asked.items() if value is not None})
        for name, value in given.items():
            setattr(program, name, value)

    def record(self) -> Json:
        return {name: [row[i] for row in self.rows] for i, name in enumerate(("t", "u", "y"))}

    @property
    def safe(self) -> float:
        return float(self.program.u_safe) if self.program.u_safe < 1e30 else self.u

    def run(self, designs: "_Designs") -> str:
        """Why it ended. Raises TestStopped, or what the user raised, with u at its safe value."""
        with contextlib.ExitStack() as stack:
            file = stack.enter_context(open(self.keep, "w", encoding="ascii")) if self.keep else None
            if file:
                file.write("t,u,y\n")
            try:
                return self._calls(designs, file)
            except TestStopped:
                raise
            except BaseException as fault:
                fault.record = self.record()  # type: ignore[attr-defined]
                self._make_safe()
                raise
            finally:
                designs.stop()
        raise AssertionError("unreachable")

    def _calls(self, designs: "_Designs", file: Any) -> str:
        start = self.clock()
        self.program.step(0.0, self.u, False)
        accepted: Optional[float] = None
        enough = False
        for k in range(1, 1_000_000_000):
            y, ok = self._measured()
            now = self.clock() - start
            u, mode, reason, recording = self.program.step(y, self.u, not enough, ok, now,
                                                           1e30 if accepted is None else accepted)
            accepted = self._written(u, mode, reason)
            if recording:
                self.rows.append((self.program.t, u, y))
                if file:
                    file.write(self.program.row() + "\n")
                    file.flush()
            if mode == _STOPPED:
                why = " (%s: %s)" % (type(self.lost).__name__, self.lost) if self.lost else ""
                raise TestStopped("The test was stopped: %s%s." % (self.reasons[reason], why), reason,
                                  self.record()) from self.lost
            if mode == _DONE and u == self.u:
                return "the design is good enough" if enough else self.reasons[reason]
            enough = enough or (mode != _DONE and designs.look(self))
            pause = start + k * self.program.Ts - self.clock()
            if pause > 0:
                self.sleep(pause)
        raise AssertionError("unreachable")

    def _measured(self) -> Tuple[float, bool]:
        """An exception is a bad measurement: the program then sets the safe value and says so."""
        self.lost = None
        try:
            given = self.read()
            y, ok = given if isinstance(given, tuple) else (given, True)
            return float(y), bool(ok)
        except Exception as fault:
            self.lost = fault
            return 0.0, False

    def _written(self, u: float, mode: int, reason: int) -> Optional[float]:
        if mode == _STOPPED:
            self._make_safe()
            return None
        try:
            accepted = self.write(u)
        except Exception as fault:
            self._make_safe()
            raise TestStopped("The test was stopped: u could not be written (%s)." % fault, 0, self.record()) from fault
        return float(accepted) if isinstance(accepted, float) else None  # others are counts of bytes and the like

    def _make_safe(self) -> None:
        with _undisturbed():
            for left in range(_TRIES - 1, -1, -1):
                try:
                    accepted = self.write(self.safe)
                    if isinstance(accepted, float) and abs(accepted - self.safe) > self.program.u_tolerance:
                        raise ConnectionError("the actuator reads back %g" % accepted)
                    return
                except Exception as fault:
                    if left == 0:
                        raise TestStopped("The test was stopped, and u could NOT be set to its safe value %g: %s. Set it "
                                          "by hand now." % (self.safe, fault), 0, self.record()) from fault
                    self.sleep(min(self.program.Ts, 1.0))


class _Designs:
    """Designs from the record so far, beside the test: one at a time."""

    def __init__(self, client: Any, request: Json, most_cost: float, show: Callable[[str], None], background: bool) -> None:
        self.client, self.request, self.most_cost, self.show, self.background = client, request, most_cost, show, background
        self.seen = 0  # cycles, or quarters of growth of a bump's record
        self.good = 0  # answers in a row that are good enough
        self.thread: Optional[threading.Thread] = None
        self.stopped = False

    def look(self, test: _Test) -> bool:
        """True if the design is good enough. Starts another if the record has grown by a cycle."""
        if self.good >= 2:
            return True
        grown = int(getattr(test.program, "cycles_done", 0))
        if grown > self.seen and not (self.thread and self.thread.is_alive()):
            self.seen = grown
            words = "after %d cycle%s" % (grown, "" if grown == 1 else "s")
            record = test.record()
            if not self.background:
                self._design(record, words)
                return self.good >= 2
            self.thread = threading.Thread(target=self._design, args=(record, words), daemon=True)
            self.thread.start()
        return False

    def stop(self) -> None:
        self.stopped = True

    def _design(self, record: Json, words: str) -> None:
        """A service that does not answer is no reason to end the test."""
        try:
            result = self.client.run(dict(self.request, record=record))
        except Exception as fault:
            self.good = 0
            if not self.stopped:
                self.show("%s: no design yet (%s)" % (words, str(fault).split("\n")[0]))
            return
        if self.stopped:
            return
        self.good = self.good + 1 if _good(result, self.most_cost) else 0
        self.show(_line(words, result))


def _first(result: Any) -> Json:
    entry: Json = result.best
    return entry


def _good(result: Any, most_cost: float) -> bool:
    """The design holds on all plants that fit the record (the service says so by its codes), and this costs little."""
    entry = _first(result)
    bad = [each for each in (*entry.get("verdict", ()), *entry.get("warnings", ()), *result["model"].get("warnings", ()))
           if each.get("level") == "bad"]
    return not bad and result["model"]["grade"] in ("good", "usable") and (entry.get("region_cost") or 1) <= most_cost


def _missing(result: Any, most_cost: float) -> List[str]:
    if _good(result, most_cost):
        return []
    entry = _first(result)
    found = [each for each in (*result["model"].get("warnings", ()), *entry.get("verdict", ()), *entry.get("warnings", ()))
             if each.get("level") in ("bad", "warning")]
    return [each.get("detail") or each.get("text", "") for each in found]


def _line(words: str, result: Any) -> str:
    """The model with its standard errors, and the design's figures."""
    model, entry = result["model"], _first(result)
    errors = model.get("standard_errors", {})
    values = ["%s %.4g" % (name, value) + (" +- %.2g" % errors[name] if name in errors else "")
              for name, value in model["plant"].items() if isinstance(value, (int, float))]
    region = entry.get("region") or {}
    line = "%s: %s (%s), fit %.1f %%, grade %s" % (words, model["plant"]["type"], ", ".join(values), model["fit_percent"],
                                                   model["grade"])
    if region.get("worst_Ms"):
        line += "; Ms %.2f at worst" % region["worst_Ms"]
    if entry.get("region_cost"):
        line += ", at %.2f times the load IAE of the model alone" % entry["region_cost"]
    return line
