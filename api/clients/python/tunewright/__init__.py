"""Tunes PID controllers with a Tunewright service. It needs only Python's standard library.

    from tunewright import Client

    result = Client().tune(plant="2 e^(-3s)/(10s+1)", tune=[{"method": "robust", "Ms": 1.4, "Mt": 1.4}])
    print(result.best["controller"])

Requests and answers are those of the service's own description, GET /openapi.json, as dictionaries: that description
has the names, units and meanings of all fields, and they are not repeated here. Further keyword arguments of a call go
into its request unchanged, so that a newer service needs no newer client.

The modules, whose public names are all here:

    client     the calls of a service
    answers    answers as dictionaries that show themselves in a notebook (notebook)
    autotune   a test of a real loop between two functions, and the settings that follow
    tables     answers and rows of batches as CSV, pandas and Parquet
    systems    models of python-control and scipy.signal as plants and controllers, and back

pandas, pyarrow and python-control are imported by the calls that need them, and by no others.
"""

from .answers import Answer, Check, Result
from .autotune import Autotuned, TestStopped, autotune
from .client import Client, Fault, Problem, record
from .systems import controller_of, plant_of, to_control
from .tables import Table, table

__all__ = [
    "Answer", "Autotuned", "Check", "Client", "Fault", "Problem", "Result", "Table", "TestStopped",
    "autotune", "controller_of", "plant_of", "record", "table", "to_control",
]
