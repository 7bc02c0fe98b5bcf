"""Answers as tables: rows for CSV with the standard library, for pandas, and for Parquet."""

import csv
import importlib
import io
from typing import Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple

Json = Mapping[str, Any]


class Table:
    """Headings, with the unit in brackets, and rows. An empty cell is None."""

    def __init__(self, columns: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
        self.columns = list(columns)
        self.rows = [list(row) for row in rows]

    def __len__(self) -> int:
        return len(self.rows)

    def column(self, heading: str) -> List[Any]:
        """The cells of a column, by its heading with or without the unit."""
        names = [each if each == heading else each.split(" [")[0] for each in self.columns]
        at = names.index(heading)
        return [row[at] for row in self.rows]

    def to_csv(self, path: Any = None) -> str:
        """The table as CSV, UTF-8, also in a file if `path` is given."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows([["" if cell is None else cell for cell in row] for row in self.rows])
        if path is not None:
            with open(path, "w", encoding="utf-8", newline="") as file:
                file.write(text.getvalue())
        return text.getvalue()

    def frame(self) -> Any:
        """The table as a pandas DataFrame."""
        frame: Any = _module("pandas", "frame()").DataFrame(self.rows, columns=self.columns)
        return frame

    def to_parquet(self, path: Any) -> None:
        """The table as a Parquet file, by pandas and pyarrow."""
        _module("pyarrow", "to_parquet()")
        self.frame().to_parquet(path, index=False)

    @classmethod
    def of_csv(cls, text: str) -> "Table":
        """A table of the service: numbers become floats, empty cells None."""
        rows = list(csv.reader(io.StringIO(text)))
        return cls(rows[0], [[_cell(cell) for cell in row] for row in rows[1:]])


class _Column(NamedTuple):
    name: str
    path: Tuple[str, ...]
    unit: str = ""  #: in the words of _units


# The names are those of the service's CSV of a batch.
_FIGURES = [
    _Column("Kp", ("controller", "Kp"), "u/y"),
    _Column("Ti", ("controller", "Ti"), "time"),
    _Column("Td", ("controller", "Td"), "time"),
    _Column("filter", ("controller", "filter", "type")),
    _Column("Tf", ("controller", "filter", "Tf"), "time"),
    _Column("b", ("controller", "b")),
    _Column("c", ("controller", "c")),
    _Column("setpoint_filter_T", ("controller", "setpoint_filter", "T"), "time"),
    _Column("Ki", ("controller", "Ki"), "u/(y time)"),
    _Column("Kd", ("controller", "Kd"), "u time/y"),
    _Column("Ms", ("robustness", "Ms")),
    _Column("Mt", ("robustness", "Mt")),
    _Column("gain_margin", ("robustness", "gain_margin")),
    _Column("phase_margin", ("robustness", "phase_margin_deg"), "deg"),
    _Column("delay_margin", ("robustness", "delay_margin"), "time"),
    _Column("load_IAE", ("performance", "load", "IAE"), "y time"),
    _Column("setpoint_IAE", ("performance", "setpoint", "IAE"), "y time"),
    _Column("overshoot", ("performance", "setpoint", "overshoot_percent"), "%"),
    _Column("settling_time", ("performance", "setpoint", "settling_time"), "time"),
]
_LOOP_FIGURES = [
    _Column("tag", ("tag",)),
    _Column("verdict", ("cause", "verdict")),
    _Column("confidence", ("cause", "confidence")),
    _Column("period", ("oscillation", "period"), "time"),
    _Column("automatic", ("service", "automatic")),
    _Column("harris_low", ("performance", "harris", "low")),
    _Column("harris_high", ("performance", "harris", "high")),
    _Column("action", ("action", "detail")),
]


def table(source: Any) -> Table:
    """A table of an answer with controllers (a row for each), of a check (a row for each loop, in the order of its work
    list), or of the rows of a batch (a row for each controller, and one for each job without a result)."""
    if isinstance(source, Mapping):
        if "loops" in source:
            return _of_loops(source)
        if "controllers" in source:
            return _of_entries(source)
        raise TypeError("This answer has neither controllers nor loops.")
    return _of_batch(list(source))


def _of_entries(answer: Json) -> Table:
    columns = _known_columns(answer["controllers"])
    units = answer.get("units") or {}
    places = {entry: place + 1 for place, entry in enumerate(answer.get("ranking") or [])}
    rows = [[entry.get("method"), entry.get("title"), places.get(i), *_cells(entry, columns)]
            for i, entry in enumerate(answer["controllers"])]
    return Table(["method", "title", "rank", *_headings(columns, units)], rows)


def _of_loops(check: Json) -> Table:
    loops = [check["loops"][rank["loop"]] for rank in check.get("ranking") or []] or check["loops"]
    return Table(_headings(_LOOP_FIGURES, check.get("units") or {}), [_cells(loop, _LOOP_FIGURES) for loop in loops])


def _of_batch(batch: Sequence[Json]) -> Table:
    results = [row.get("result") or {} for row in batch]
    columns = _known_columns([entry for result in results for entry in result.get("controllers") or []])
    given = [result.get("units") or {} for result in results if result]
    same = all(units == given[0] for units in given)
    headings = ["index", "id", "name", "status", "method", *_headings(columns, given[0] if given and same else
                                                                     {} if same else None), "error"]
    rows = []
    for row, result in zip(batch, results):
        first = [row.get("index"), row.get("id"), row.get("name"), row.get("status")]
        error = (row.get("error") or {}).get("detail")
        units = result.get("units") or {}
        labels = [] if same else [units.get("time", "s"), units.get("u"), units.get("y")]
        entries = result.get("controllers") or [{}]
        rows += [[*first, entry.get("method"), *_cells(entry, columns), error, *labels] for entry in entries]
    return Table(headings + ([] if same else ["time_unit", "u_unit", "y_unit"]), rows)


def _known_columns(entries: Sequence[Json]) -> List[_Column]:
    """The columns in which an entry has a value."""
    return [column for column in _FIGURES if any(_at(entry, column.path) is not None for entry in entries)]


def _cells(entry: Json, columns: Sequence[_Column]) -> List[Any]:
    return [_at(entry, column.path) for column in columns]


def _at(value: Any, path: Sequence[str]) -> Any:
    for name in path:
        value = value.get(name) if isinstance(value, Mapping) else None
    return value


def _headings(columns: Sequence[_Column], units: Optional[Json]) -> List[str]:
    """The names with their units; `units` is None if the rows have different ones."""
    out = []
    for column in columns:
        unit = column.unit if units is None and column.unit in ("deg", "%") else _unit(column.unit, units or {})
        out.append("%s [%s]" % (column.name, unit) if unit and units is not None or unit in ("deg", "%") else
                   column.name)
    return out


def _unit(words: str, units: Json) -> str:
    """The unit with the request's labels; "" if one that it needs is not known."""
    if words in ("", "deg", "%"):
        return words
    labels: Dict[str, Optional[str]] = {"time": units.get("time") or "s", "u": units.get("u"), "y": units.get("y")}
    if words == "time":
        return str(labels["time"])
    needed = [name for name in ("time", "u", "y") if name in words.replace("(", " ").replace("/", " ").split()
              or name + ")" in words.split()]
    if any(not labels[name] for name in needed):
        return ""
    out = words
    for name, mark in (("time", "\0"), ("u", "\1"), ("y", "\2")):
        out = out.replace(name, mark)
    for name, mark in (("time", "\0"), ("u", "\1"), ("y", "\2")):
        out = out.replace(mark, labels[name] or "")
    return out


def _cell(text: str) -> Any:
    if text == "":
        return None
    try:
        return float(text)
    except ValueError:
        return text


def _module(name: str, call: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ImportError("%s needs %s: pip install %s" % (call, name, name)) from None
