"""Answers: dictionaries as the service sends them, which also show themselves in a notebook."""

from typing import Any, Dict, List, Mapping, Optional

from . import notebook
from .tables import Table, table

Json = Dict[str, Any]


class Answer(Dict[str, Any]):
    """An answer of the service."""

    def table(self) -> Table:
        """A row for each controller or loop; to_csv(), frame() and to_parquet() are its forms."""
        return table(self)

    def frame(self) -> Any:
        """The table as a pandas DataFrame."""
        return self.table().frame()

    def _repr_html_(self) -> str:
        return notebook.html(self)


class Result(Answer):
    """The result of a job (TuningResult); `job` holds the job without its result."""

    def __init__(self, job: Mapping[str, Any]) -> None:
        super().__init__(job["result"])
        self.job: Json = {name: value for name, value in job.items() if name != "result"}

    @property
    def best(self) -> Json:
        """The entry that ranks first. An operating range has no ranking: its answer is in result["range"]."""
        if "loops" in self:
            raise LookupError('This result is a check of loops: its work list is in result["ranking"], its loops in '
                              'result["loops"].')
        if "ranking" not in self:
            raise LookupError('This result has no ranking: an operating range is answered in result["range"], with '
                              'its one setting ("one") and its rows ("schedule").')
        entry: Json = self["controllers"][self["ranking"][0]]
        return entry

    def _repr_html_(self) -> str:
        return notebook.html(self, self.job.get("name"))


class Check(Answer):
    """The answer of a check: {loops, clusters, cascades, ranking, ...}. `batch` is the id of its batch, for changes();
    `job` the job of a check of given loops, for report_html(). The other of the two is None."""

    def __init__(self, answer: Mapping[str, Any], batch: Optional[str] = None, job: Optional[Json] = None) -> None:
        super().__init__(answer)
        self.batch = batch
        self.job = job

    @property
    def work_list(self) -> List[Json]:
        """The loops in the order in which to work on them."""
        return [self["loops"][rank["loop"]] for rank in self["ranking"]]
