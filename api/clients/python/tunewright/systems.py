"""Models of other libraries as plants and controllers of a request, and back.

Nothing is imported before it is needed: a model is known by its attributes, and only to_control() needs python-control.
"""

import importlib
from typing import Any, Dict, List, Mapping, Optional, Sequence

Json = Dict[str, Any]


def plant_of(source: Any, delay: Optional[float] = None) -> Any:
    """A plant for a request: a dict or a text as it is, or a model of python-control, scipy.signal or another library
    with num and den, with zeros, poles and gain, or with A, B, C and D. `delay` is its dead time, which these models
    do not have."""
    if isinstance(source, (str, Mapping)) or source is None:
        if delay is not None:
            raise TypeError("delay is for models of other libraries; write the dead time into the plant itself.")
        return source
    plant = _system(source)
    if delay is not None:
        plant["L"] = delay
    return plant


def controller_of(source: Any) -> Any:
    """A controller for a request: a dict or a text as it is, or a model with num and den as the text of a transfer
    function, which the service reads as a PID controller with times in s."""
    if isinstance(source, (str, Mapping)) or source is None:
        return source
    model = _system(source)
    if model["type"] != "transfer_function":
        raise TypeError("A controller is a transfer function here; convert the model, as with control.ss2tf.")
    return "tf(%s, %s)" % (model["num"], model["den"])


def to_control(source: Mapping[str, Any], pade: Optional[int] = None, of: str = "measurement") -> Any:
    """A plant or a controller of an answer as a transfer function or a state space of python-control.

    `source` is a plant, a controller, an entry of an answer (its controller), or an answer with an identified model
    (its plant). python-control has no dead time: `pade` is the order of the Pade approximation of a plant with one. A
    controller is C = -u/y, its filter included; with of="setpoint" it is u/r, set-point weights and filter included.
    """
    if "controller" in source:
        source = source["controller"]
    elif "model" in source:
        source = source["model"]["plant"]
    return _plant(source, pade) if "type" in source else _controller(source, of)


# Into a request.

def _system(source: Any) -> Json:
    step = getattr(source, "dt", None)
    if step is not None and (step is True or step != 0):
        raise ValueError("The model is in discrete time (dt = %s); give one in continuous time." % step)
    if hasattr(source, "num") and hasattr(source, "den"):
        return {"type": "transfer_function", "num": _row(source.num), "den": _row(source.den)}
    if all(hasattr(source, name) for name in ("zeros", "poles", "gain")):
        return {"type": "zpk", "zeros": _roots(source.zeros), "poles": _roots(source.poles), "K": float(source.gain)}
    if all(hasattr(source, name) for name in "ABCD"):
        return {"type": "state_space", "A": _rows(source.A), "B": _row(source.B), "C": _row(source.C),
                "D": _row(source.D)[0]}
    raise TypeError("A %s is no model of a plant; it needs num and den, zeros, poles and gain, or A, B, C and D."
                    % type(source).__name__)


def _list(values: Any) -> Any:
    return values.tolist() if hasattr(values, "tolist") else values


def _row(values: Any) -> List[float]:
    """The numbers of a row or a column; lists of one element around them are those of one input and one output."""
    values = _list(values)
    if not isinstance(values, Sequence):
        return [float(values)]
    values = [_list(each) for each in values]
    if values and all(isinstance(each, Sequence) for each in values):
        if len(values) == 1:
            return _row(values[0])
        if all(len(each) == 1 for each in values):
            return [float(_list(each)[0]) for each in values]
        raise ValueError("The model has several inputs or outputs; give the part from one input to one output.")
    return [float(each) for each in values]


def _rows(values: Any) -> List[List[float]]:
    return [[float(each) for each in _list(row)] for row in _list(values)]


def _roots(values: Any) -> List[Any]:
    roots = [complex(each) for each in _list(values() if callable(values) else values)]
    return [root.real if root.imag == 0 else [root.real, root.imag] for root in roots]


# Out of an answer.

def _control() -> Any:
    try:
        return importlib.import_module("control")
    except ImportError:
        raise ImportError("to_control() needs python-control: pip install control") from None


def _plant(plant: Mapping[str, Any], pade: Optional[int]) -> Any:
    control = _control()
    kind, L = plant["type"], plant.get("L", 0)
    if L and pade is None:
        raise ValueError("The plant has a dead time of %g, which python-control does not have; give the order of its "
                         "Pade approximation, as in to_control(plant, pade=5)." % L)
    if kind == "state_space":
        model = control.ss(plant["A"], [[b] for b in plant["B"]], [plant["C"]], [[plant.get("D", 0)]])
    elif kind == "zpk":
        model = control.zpk([_complex(root) for root in plant["zeros"]], [_complex(root) for root in plant["poles"]],
                            plant["K"])
    elif kind in _FRACTIONS:
        model = control.tf(*_FRACTIONS[kind](plant))
    else:
        raise ValueError("A plant of type %s has no transfer function." % kind)
    return model * control.tf(*control.pade(L, pade)) if L else model


def _complex(root: Any) -> complex:
    return complex(*root) if isinstance(root, Sequence) else complex(root)


def _lags(K: float, *factors: Sequence[float]) -> Any:
    den: List[float] = [1]
    for factor in factors:
        den = _product(den, factor)
    return [K], den


def _product(a: Sequence[float], b: Sequence[float]) -> List[float]:
    out = [0.0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


_FRACTIONS: Dict[str, Any] = {
    "fopdt": lambda p: _lags(p["K"], [p["T"], 1]),
    "sopdt": lambda p: (_lags(p["K"], [p["T1"], 1], [p["T2"], 1]) if "T1" in p else
                        _lags(p["K"], [p["T"] ** 2, 2 * p["zeta"] * p["T"], 1])),
    "ipdt": lambda p: _lags(p["K"], [1, 0], [p.get("T", 0), 1]),
    "transfer_function": lambda p: (p["num"], p["den"]),
}


def _controller(controller: Mapping[str, Any], of: str) -> Any:
    """The law as numerators and denominators: P + I/s + D s/(1 + Tf s), each with its weight for the set point."""
    if of not in ("measurement", "setpoint"):
        raise ValueError('of is %r; it must be "measurement" or "setpoint".' % of)
    control = _control()
    s = control.tf([1, 0], [1])
    form, setpoint = controller.get("form", "ideal"), of == "setpoint"
    weight_P, weight_D = (controller.get("b", 1), controller.get("c", 0)) if setpoint else (1, 1)
    filtered = controller.get("filter") or {"type": "none"}
    kind, Tf = filtered["type"], filtered.get("Tf", 0)
    if kind == "derivative" and "Tf" not in filtered:
        raise ValueError("The filter has N; give its time Tf.")
    lag = 1 / control.tf([Tf, 1], [1])
    D_lag = lag if kind == "derivative" else control.tf([1], [1])
    if form == "parallel":
        P, I, D = controller.get("Kp", 0), controller.get("Ki", 0), controller.get("Kd", 0)
    elif form in ("ideal", "npid"):
        P, Ti = controller["Kp"], controller.get("Ti")
        I, D = (P / Ti if Ti else 0), P * controller.get("Td", 0)
    else:
        raise ValueError("A controller of the form %s is in equivalents.parallel of its entry; give that." % form)
    law = control.tf([weight_P * P], [1])
    if I:
        law = law + control.tf([I], [1, 0])
    if D and weight_D:
        law = law + weight_D * D * s * D_lag
    if not setpoint and kind.startswith("measurement"):
        law = law * (lag if kind == "measurement_first_order" else control.tf([1], [Tf * Tf / 2, Tf, 1]))
    if setpoint and controller.get("setpoint_filter"):
        law = law * control.tf([1], [controller["setpoint_filter"]["T"], 1])
    return law
