"""An answer as HTML for a notebook: its sentences, its table and its responses, without any other library.

Figures and sentences are those of the answer. Every text in the HTML is escaped.
"""

from html import escape
from math import ceil, floor, isfinite, log10
from typing import Any, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from .tables import Table, table

Json = Mapping[str, Any]

_COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd")
_MOST_CURVES = len(_COLOURS)
_WIDTH, _HEIGHT = 340, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 8, 22, 32
_CELL = "padding:2px 8px;text-align:%s"


def html(answer: Json, name: Optional[str] = None) -> str:
    """The answer as a fragment of HTML."""
    parts = ["<div>"]
    if name:
        parts.append("<p><strong>%s</strong></p>" % escape(name))
    parts += [_sentences(answer.get("verdict")), _model(answer)]
    if "controllers" in answer or "loops" in answer:
        parts.append(_table(table(answer)))
    parts += [_warnings(answer), _responses(answer)]
    return "".join(parts) + "</div>"


def _sentences(findings: Any) -> str:
    items = ["<li>%s</li>" % escape(str(each["text"])) for each in findings or [] if each.get("text")]
    return "<ul>%s</ul>" % "".join(items) if items else ""


def _model(answer: Json) -> str:
    model = answer.get("model")
    if not isinstance(model, Mapping) or "plant" not in model:
        return ""
    errors = model.get("standard_errors") or {}
    rows = [[key, value, errors.get(key)] for key, value in model["plant"].items()]
    fit = model.get("fit_percent")
    line = "" if fit is None else "<p>fit %s %%</p>" % _number(fit)
    return _table(Table(["plant", "value", "standard error"], rows)) + line


def _table(of: Table) -> str:
    heads = "".join('<th style="%s">%s</th>' % (_CELL % _side(row[i] for row in of.rows), escape(heading))
                    for i, heading in enumerate(of.columns))
    rows = "".join("<tr>%s</tr>" % "".join(map(_cell, row)) for row in of.rows)
    return ('<div style="overflow-x:auto"><table style="font-size:12px"><thead><tr>%s</tr></thead><tbody>%s</tbody></table>'
            "</div>" % (heads, rows))


def _side(cells: Iterable[Any]) -> str:
    return "right" if any(_is_number(cell) for cell in cells) else "left"


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _cell(value: Any) -> str:
    text = "" if value is None else _number(value) if _is_number(value) else escape(str(value))
    return '<td style="%s">%s</td>' % (_CELL % _side([value]), text)


def _number(value: float) -> str:
    return escape("%.4g" % value)


def _warnings(answer: Json) -> str:
    items = []
    for entry in [answer, *(answer.get("controllers") or [])]:
        for warning in entry.get("warnings") or []:
            sentence = warning.get("detail") or warning.get("text") or warning.get("code")
            title = entry.get("title") or entry.get("method")
            items.append("<li>%s%s</li>" % (escape(title + ": ") if title else "", escape(str(sentence))))
    return "<p>Warnings</p><ul>%s</ul>" % "".join(items) if items else ""


# Plots.

class _Curve(NamedTuple):
    name: str
    x: Sequence[float]
    y: Sequence[float]


def _responses(answer: Json) -> str:
    entries = answer.get("controllers") or []
    order = [*(answer.get("ranking") or []), *range(len(entries))]
    shown = [entries[i] for i in dict.fromkeys(order) if entries[i].get("responses")][:_MOST_CURVES]
    units = answer.get("units") or {}
    plots = []
    for step, title in (("setpoint", "Set-point step"), ("load", "Load step")):
        for signal in "yu":
            curves = [_Curve(str(entry.get("title") or entry.get("method")), entry["responses"][step]["t"],
                             entry["responses"][step][signal])
                      for entry in shown if signal in (entry["responses"].get(step) or {})]
            unit = " [%s]" % units[signal] if units.get(signal) else ""
            if any(len(curve.x) > 1 for curve in curves):
                plots.append(_plot("%s: %s%s" % (title, signal, unit), "t [%s]" % (units.get("time") or "s"), curves))
    return "".join(plots) + (_legend(shown) if plots else "")


def _legend(entries: Sequence[Json]) -> str:
    names = ['<span style="color:%s">&#9632;</span> %s' % (_COLOURS[i], escape(str(entry.get("title") or
                                                                              entry.get("method"))))
             for i, entry in enumerate(entries)]
    return "<p>%s</p>" % " &nbsp; ".join(names)


def _plot(title: str, x_label: str, curves: Sequence[_Curve]) -> str:
    points = [(x, y) for curve in curves for x, y in zip(curve.x, curve.y) if _finite(x) and _finite(y)]
    if not points:
        return ""
    x_low, x_high = _range([x for x, _ in points])
    y_low, y_high = _range([y for _, y in points])

    def across(x: float) -> float:
        return _LEFT + (x - x_low) / (x_high - x_low) * (_WIDTH - _LEFT - _RIGHT)

    def up(y: float) -> float:
        return _HEIGHT - _BOTTOM - (y - y_low) / (y_high - y_low) * (_HEIGHT - _TOP - _BOTTOM)

    shapes = [_text(_LEFT, 14, title, "start")]
    for tick in _ticks(x_low, x_high):
        shapes += [_line(across(tick), _TOP, across(tick), _HEIGHT - _BOTTOM),
                   _text(across(tick), _HEIGHT - _BOTTOM + 13, "%.4g" % tick, "middle")]
    for tick in _ticks(y_low, y_high):
        shapes += [_line(_LEFT, up(tick), _WIDTH - _RIGHT, up(tick)), _text(_LEFT - 4, up(tick) + 4, "%.4g" % tick, "end")]
    shapes.append(_text((_LEFT + _WIDTH - _RIGHT) / 2, _HEIGHT - 4, x_label, "middle"))
    for i, curve in enumerate(curves):
        path = " ".join("%.1f,%.1f" % (across(x), up(y)) for x, y in zip(curve.x, curve.y) if _finite(x) and _finite(y))
        shapes.append('<polyline fill="none" stroke="%s" stroke-width="1.5" points="%s"/>' % (_COLOURS[i], path))
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" role="img" aria-label="%s" '
            'font-family="sans-serif" font-size="11" fill="currentColor">%s</svg>'
            % (_WIDTH, _HEIGHT, escape(title), "".join(shapes)))


def _finite(value: Any) -> bool:
    return _is_number(value) and isfinite(value)


def _range(values: List[float]) -> Tuple[float, float]:
    low, high = min(values), max(values)
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        low, high = low - max(abs(low), 1) / 2, high + max(abs(high), 1) / 2
    return low, high


def _ticks(low: float, high: float) -> List[float]:
    """Three to six round numbers within the range."""
    rough = (high - low) / 4
    power = 10.0 ** floor(log10(rough))
    step = next(power * each for each in (1, 2, 5, 10) if power * each >= rough)
    return [step * i for i in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1)]


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return '<text x="%.1f" y="%.1f" text-anchor="%s">%s</text>' % (x, y, anchor, escape(text))


def _line(x1: float, y1: float, x2: float, y2: float) -> str:
    return ('<line x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f" stroke="currentColor" stroke-opacity="0.15"/>'
            % (x1, y1, x2, y2))
