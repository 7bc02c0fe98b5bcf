"""The calls of a service."""

import csv
import io
import json
import os
import random
import socket
import time
import uuid
from contextlib import suppress
from http.client import HTTPException, HTTPResponse
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union
from urllib.error import HTTPError
from urllib.parse import quote, urlencode
from urllib.request import Request, urlopen

from .answers import Answer, Check, Result
from .systems import controller_of, plant_of
from .tables import Table

Json = Dict[str, Any]
Methods = Sequence[Union[str, Mapping[str, Any]]]
Progress = Callable[[int, int], None]

_LONGEST_WAIT = 20  # seconds that one call waits for a job: less than the timeouts of proxies
_LONGEST_PAUSE = 30.0  # seconds between two tries
_MOST_LOST = 6  # connections lost in a row: half a minute, enough for a service that is restarted


class Fault(NamedTuple):
    """One fault in a request."""

    pointer: str  #: JSON Pointer into the request, such as /plant/L
    detail: str


class Problem(Exception):
    """Why something cannot be done (RFC 9457). A job that fails raises it too."""

    def __init__(self, body: Mapping[str, Any], result: "Optional[Result]" = None) -> None:
        self.body = dict(body)
        self.status: int = body.get("status", 0)
        self.type: str = body.get("type", "about:blank")
        self.title: str = body.get("title", "Problem")
        self.detail: str = body.get("detail", "")
        self.errors: List[Fault] = [Fault(each["pointer"], each["detail"]) for each in body.get("errors", [])]
        self.result = result  #: the best design of a job that was stopped during its search, if it had one
        super().__init__(str(self))

    def __str__(self) -> str:
        lines = ["%s: %s" % (self.title, self.detail)]
        lines += ["  %s: %s" % (fault.pointer or "(the request)", fault.detail) for fault in self.errors]
        return "\n".join(lines)


def record(source: Any, **fields: Any) -> Json:
    """A recorded test in the form that a request takes.

    `source` is a dict of lists or arrays (t or dt, u, y), the path of a CSV, its text (known by its line ends), or a
    pandas DataFrame, whose index is a column too if it has a name or holds dates. Further `fields` are added:
    columns={"u": "FIC101.OP"}, time_unit="min", kind="step", u_limits=[0, 100], ...
    """
    if isinstance(source, Mapping):
        return {**source, **fields}
    if hasattr(source, "to_csv"):
        source = _frame_text(source)
    elif isinstance(source, os.PathLike) or "\n" not in source:
        with open(source, "rb") as file:
            source = _text(file.read())
    return {"csv": source, **fields}


class Client:
    """A service, its API key if it needs one, and the timeout of calls.

    `timeout` is in seconds and covers a whole call: waiting for the job, and retries while the service is full or
    restarting. A job that takes longer continues; the TimeoutError names it.
    """

    def __init__(self, base_url: str = "http://127.0.0.1:8080", key: Optional[str] = None,
                 timeout: float = 600) -> None:
        self.base_url = base_url.rstrip("/")
        self.key = key
        self.timeout = timeout
        self._reached = False

    # Jobs: stored by the service, available by their id.

    def tune(self, plant: Any = None, record: Any = None, tune: Optional[Methods] = None,
             baseline: Any = None, evaluate: Optional[Mapping[str, Any]] = None, **rest: Any) -> Result:
        """Tunes for a plant or a recorded test, waits for the end, and returns the result.

        `plant` is an object, a text such as "2 e^(-3s)/(10s+1)", or a model of python-control or scipy.signal, whose
        dead time is `delay`; `record` anything that record() takes; `tune` a list of methods, by name or with options;
        `baseline` an object, a text such as "pidstd(1.5, 120, 20, 10)", or a transfer function of python-control. A
        KeyboardInterrupt cancels the job.
        """
        return self.run(_request(plant=plant, record=record, tune=_methods(tune), baseline=baseline, evaluate=evaluate,
                                 **rest))

    def compare(self, plant: Any = None, record: Any = None, methods: Methods = ("all",), **rest: Any) -> Result:
        """Like tune(), with every method that applies, or with those named. `ranking` has the order."""
        return self.tune(plant=plant, record=record, tune=methods, **rest)

    def run(self, request: Mapping[str, Any]) -> Result:
        """Runs a complete tuning request, such as one of GET /v1/examples, and returns the result."""
        end = time.monotonic() + self.timeout
        key = {} if request.get("unique") else {"Idempotency-Key": str(uuid.uuid4())}
        wait = max(1, min(_LONGEST_WAIT, int(self.timeout)))
        job: Optional[Json] = None
        try:
            job = self._json("POST", "/v1/jobs", request, {**key, "Prefer": "wait=%d" % wait}, end + 5)
            return self._ended(job, end)
        except KeyboardInterrupt:
            with suppress(Problem, OSError):
                soon = time.monotonic() + 5
                # Interrupted before the answer came: the same body with the same key, or with unique, gives the same
                # job and so its id.
                job = job or self._json("POST", "/v1/jobs", request, key, soon)
                self._json("POST", _job(job["id"]) + "/cancel", end=soon)
            raise

    def wait(self, job: Union[str, Result]) -> Result:
        """Waits for the end of a job and returns its result."""
        end = time.monotonic() + self.timeout
        return self._ended(self._json("GET", _job(job), end=end), end)

    def job(self, job: Union[str, Result]) -> Json:
        """A job in its current state, with its request, and its result or error once it has ended."""
        return self._json("GET", _job(job))

    def jobs(self, **query: Any) -> Iterator[Json]:
        """The stored jobs, newest first, without requests and results: jobs(q="TIC-101"), jobs(status="failed"), ..."""
        page: Optional[str] = "/v1/jobs" + _query(query)
        while page:
            answer = self._json("GET", page)
            yield from answer["jobs"]
            page = answer.get("next")

    def cancel(self, job: Union[str, Result]) -> Json:
        """Stops a job, usually within a second."""
        return self._json("POST", _job(job) + "/cancel")

    def delete(self, job: Union[str, Result]) -> None:
        """Deletes a job that has ended."""
        self._open("DELETE", _job(job)).close()

    def report_html(self, job: Union[str, Result, Check], controller: Optional[int] = None) -> str:
        """A report of a job's controller, as a page to print, sign and keep; by default of the first of the ranking.
        The report of a check has its work list and a page for each loop."""
        if isinstance(job, Check) and job.job is None:
            return self._body("/v1/batches/%s/report.html" % quote(_batch(job), safe=""))
        return self._body(_job(job) + "/report.html" + _query({"controller": controller}))

    def code(self, job: Union[str, Result], language: str, controller: Optional[int] = None, **options: Any) -> str:
        """A controller of a job as a program: language "st", "c" or "python"; options such as sample_time=0.5. For
        an operating range, the program of the schedule."""
        place = "controllers/%s" % controller
        if controller is None:
            result = job if isinstance(job, Result) else self.job(job)["result"]
            place = "controllers/%d" % result["ranking"][0] if "ranking" in result else "schedule"
        return self._body("%s/%s/code%s" % (_job(job), place, _query({"language": language, **options})))

    def traces(self, job: Union[str, Result], traces: str = "responses") -> Table:
        """The traces of a job as columns with their units: "responses", "frequency", or "model" with the record."""
        return Table.of_csv(self._body("%s/result.csv%s" % (_job(job), _query({"traces": traces}))))

    # Many loops at once.

    def batch(self, requests: Iterable[Mapping[str, Any]], progress: Optional[Progress] = None,
              name: Optional[str] = None) -> Iterator[Json]:
        """Tunes thousands of loops: yields {index, id, name, status, result or error} in the order of the requests,
        each as soon as it has ended. A request that is not valid fails alone.

        The batch is posted at once; `progress(done, total)` is called with each row. Leaving the loop over the rows
        early, also by an interrupt, cancels the remaining jobs. `timeout` is the longest wait for the next row.
        """
        lines = b"".join(_encoded(_with_models(request)) + b"\n" for request in requests)
        headers = {"Content-Type": "application/x-ndjson", "Idempotency-Key": str(uuid.uuid4())}
        batch = self._json("POST", "/v1/batches" + _query({"name": name}), lines, headers)
        return self._rows("/v1/batches/" + batch["id"], batch["total"], progress or (lambda done, total: None))

    # Loops in operation.

    def check(self, source: Any, progress: Optional[Progress] = None, name: Optional[str] = None, loops: Any = None,
              **rest: Any) -> Check:
        """What is wrong with loops in operation, why, and what to do first.

        `source` is the path of a CSV of many loops, of one or of one tag (FIC101.PV.csv); a list of such paths, or the
        path of a folder of them; a pandas DataFrame with the columns of many loops, such as FIC101.PV and FIC101.OP; or
        a list of loops {"tag", "record" or "csv", "kind", ...}. A list of loops becomes one job, anything else a batch
        with a job for each loop, and `progress(done, total)` is called as they end. A KeyboardInterrupt cancels them.

        `loops` has what is known of the loops of files: {"FIC101": {"kind": "flow", "op_low": 0, "op_high": 100, "Kp":
        0.8, "Ti": 20}, ...}, a DataFrame with the tags as its index or in the column tag, or the path of such a CSV.
        Findings about the files are in `notes` of the answer.
        """
        if isinstance(source, (list, tuple)) and not all(isinstance(each, (str, os.PathLike)) for each in source):
            if loops is not None:
                raise TypeError("loops is for files; give its members in each loop of the list.")
            given = [{**loop, "record": record(loop["record"])} if "record" in loop else loop for loop in source]
            result = self.run({"loops": given, **_request(name=name, **rest)})
            return Check(result, job=result.job)
        parts = [("file", "" if hasattr(path, "to_csv") else os.path.basename(str(path)), _file_bytes(path))
                 for path in _paths(source)]
        if loops is not None:
            parts.insert(0, ("loops", "loops.csv", _table_of_loops(loops)))
        units = rest.pop("units", {})
        words = {key: str(value).lower() if isinstance(value, bool) else value for key, value in rest.items()}
        query = {"kind": "check", "name": name, **{"units." + unit: units[unit] for unit in units}, **words}
        boundary = uuid.uuid4().hex
        batch = self._json("POST", "/v1/batches" + _query(query), _form(parts, boundary),
                           {"Content-Type": "multipart/form-data; boundary=" + boundary,
                            "Idempotency-Key": str(uuid.uuid4())})
        for _ in self._rows("/v1/batches/" + batch["id"], batch["total"], progress or (lambda done, total: None)):
            pass
        answer = self.get("/v1/batches/%s/check" % batch["id"])
        return Check({**answer, "notes": batch.get("notes", [])}, batch=batch["id"])

    def changes(self, before: Union[str, Check], after: Union[str, Check]) -> Json:
        """The check `after` with what has changed since the check `before`, loop by loop, as the service answers it.
        Either is a check of a file, a folder or a DataFrame, or the id of its batch."""
        return self.get("/v1/batches/%s/check%s" % (quote(_batch(after), safe=""), _query({"before": _batch(before)})))

    def _rows(self, path: str, total: int, progress: Progress) -> Iterator[Json]:
        done, lost = 0, 0
        try:
            while done < total:
                for row in self._stream("%s/results?follow=true&from=%d" % (path, done)):
                    done, lost = done + 1, 0
                    progress(done, total)
                    yield row
                if done < total:
                    lost += 1
                    if lost > _MOST_LOST:
                        raise ConnectionError("The results of %s ended at row %d of %d." % (path, done, total))
                    _pause(lost)
        except (KeyboardInterrupt, GeneratorExit):
            with suppress(Problem, OSError):
                self._json("POST", path + "/cancel", end=time.monotonic() + 5)
            raise

    def _stream(self, path: str) -> Iterator[Json]:
        """The lines of an answer as they arrive. Ends if the connection is lost, also within a line."""
        with self._open("GET", path) as lines:
            with suppress(ConnectionError, HTTPException, ValueError):
                for line in lines:
                    yield json.loads(line)

    # Calls that are answered at once and store nothing.

    def plant(self, plant: Any, delay: Optional[float] = None, **rest: Any) -> Json:
        """A plant in every form: {"plant", "formula" as MathML, "text", "snippets" for MATLAB, python-control, Julia and
        Modelica}."""
        given = {"text": plant} if isinstance(plant, str) else {"plant": plant_of(plant, delay)}
        return self._json("POST", "/v1/plants/parse", {**given, **rest})

    def identify(self, record: Any, identify: Optional[Mapping[str, Any]] = None, **rest: Any) -> Answer:
        """Finds the plant in a recorded test: {"model": {"plant", "fit_percent", ...}}."""
        return Answer(self._post("/v1/identify", record=record, identify=identify, **rest))

    def evaluate(self, plant: Any, controllers: Sequence[Any], **rest: Any) -> Answer:
        """Evaluates given controllers on a plant: {"controllers": [an entry for each]}."""
        return Answer(self._post("/v1/evaluate", plant=plant, controllers=list(controllers), **rest))

    def design(self, plant: Any, method: Union[str, Mapping[str, Any]] = "robust", **rest: Any) -> Answer:
        """Designs with one method: {"controllers": [its entry, and that of `baseline` if one is given]}."""
        return Answer(self._post("/v1/design", plant=plant, tune=_methods([method]), **rest))

    def frontier(self, plant: Any, **rest: Any) -> Json:
        """The least load IAE under each limit on Ms: {"points": [...], "infeasible_below"}."""
        return self._post("/v1/frontier", plant=plant, **rest)

    def relay_test(self, plant: Any, relay: Optional[Mapping[str, Any]] = None, **rest: Any) -> Json:
        """Simulates and plans a relay test: {"record", "limit_cycle", "plan", ...}."""
        return self._post("/v1/experiments/relay", plant=plant, relay=relay, **rest)

    def experiment(self, experiment: str = "relay", language: str = "python", **rest: Any) -> str:
        """The program of a test that a controller runs by itself, "relay" or "bump": sample_time=0.5, u_step=5, ..."""
        body = _request(experiment=experiment, language=language, **rest)
        with self._open("POST", "/v1/experiments/code", body) as response:
            return response.read().decode()

    def settings(self, product: str, controller: Mapping[str, Any], **rest: Any) -> Json:
        """The settings to type into a product for a controller: {"settings", "units", "as_typed", "realised",
        "notes"}."""
        return self._post("/v1/controllers/%s/settings" % quote(product, safe=""), controller=controller, **rest)

    def get(self, path: str) -> Json:
        """Any other GET, such as get("/v1/methods"), get("/v1/controllers"), get("/v1/examples")."""
        return self._json("GET", path)

    # HTTP calls.

    def _post(self, path: str, **fields: Any) -> Json:
        return self._json("POST", path, _request(**fields))

    def _json(self, method: str, path: str, body: Any = None, headers: Optional[Mapping[str, str]] = None,
              end: Optional[float] = None) -> Json:
        with self._open(method, path, body, headers, end) as response:
            answer: Json = json.load(response)
            return answer

    def _body(self, path: str) -> str:
        with self._open("GET", path) as response:
            return str(response.read(), "utf-8")

    def _open(self, method: str, path: str, body: Any = None, headers: Optional[Mapping[str, str]] = None,
              end: Optional[float] = None) -> HTTPResponse:
        """Sends the request and returns the answer; retries while that is safe and there is time."""
        end = end or time.monotonic() + self.timeout
        data = body if body is None or isinstance(body, bytes) else _encoded(body)
        fields = {"Content-Type": "application/json", **(headers or {})}
        if self.key:
            fields["Authorization"] = "Bearer " + self.key
        tries, lost = 0, 0
        while True:
            left = max(end - time.monotonic(), 0.1)
            request = Request(self.base_url + path, data, fields, method=method)
            try:
                response: HTTPResponse = urlopen(request, timeout=left)
                self._reached = True
                return response
            except HTTPError as error:
                self._reached = True
                problem, seconds = _problem(error), error.headers.get("Retry-After", "")
                if error.code not in (429, 503) or not seconds.isdigit() or not _pause(tries, end, int(seconds)):
                    raise problem from None
            except (OSError, HTTPException) as error:
                reason = getattr(error, "reason", error)
                if isinstance(reason, socket.timeout):
                    raise TimeoutError("%s%s did not answer within %g s." % (self.base_url, path, left)) from error
                lost += 1
                # A service that has answered before may be back in a moment; one that never answered is not running.
                if not self._reached or lost > _MOST_LOST or not _pause(tries, end):
                    raise ConnectionError("No answer from %s (%s). Is the service running there?"
                                          % (self.base_url, reason)) from error
            tries += 1

    def _ended(self, job: Json, end: float) -> Result:
        pause = 0.05
        while job["status"] in ("queued", "running"):
            if time.monotonic() > end:
                raise TimeoutError("Job %s is still %s after %g s and continues; call wait(%r) to wait for it again."
                                   % (job["id"], job["status"], self.timeout, job["id"]))
            time.sleep(min(pause, max(end - time.monotonic(), 0)))
            pause = min(1.5 * pause, 2.0)
            job = self._json("GET", "/v1/jobs/" + job["id"], end=max(end, time.monotonic() + 5))
        result = Result(job) if job.get("result") else None
        if job["status"] == "succeeded" and result is not None:
            return result
        cancelled = {"type": "cancelled", "title": "Cancelled", "detail": "Job %s was cancelled." % job["id"]}
        raise Problem(job.get("error") or cancelled, result)


def _request(**fields: Any) -> Json:
    """The fields that were given."""
    if fields.get("record") is not None:
        fields["record"] = record(fields["record"])
    return _with_models({name: value for name, value in fields.items() if value is not None})


def _with_models(request: Mapping[str, Any]) -> Json:
    """The request with models of other libraries as plants and controllers of the service."""
    fields = dict(request)
    delay = fields.pop("delay", None)
    if "plant" in fields or delay is not None:
        fields["plant"] = plant_of(fields.get("plant"), delay)
    if "baseline" in fields:
        fields["baseline"] = controller_of(fields["baseline"])
    if "controllers" in fields:
        fields["controllers"] = [controller_of(each) for each in fields["controllers"]]
    return fields


def _methods(methods: Optional[Methods]) -> Optional[List[Any]]:
    if methods is None:
        return None
    return [{"method": each} if isinstance(each, str) else each for each in methods]


def _encoded(value: Any) -> bytes:
    """JSON of a value; NumPy arrays and numbers and pandas columns become lists and numbers."""

    def plain(other: Any) -> Any:
        if hasattr(other, "tolist"):
            return other.tolist()
        raise TypeError("A %s cannot be sent; use dictionaries, lists, texts and numbers." % type(other).__name__)

    return json.dumps(value, default=plain).encode()


def _text(data: bytes) -> str:
    """The text of a file: UTF-16 if it begins with a byte order mark of UTF-16, else UTF-8, else Windows-1252."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _frame_text(frame: Any) -> str:
    """A pandas DataFrame as CSV; its index is a column too if it has a name or holds dates."""
    dates = type(frame.index).__name__ == "DatetimeIndex"
    name = frame.index.name or ("time" if dates else None)
    return str(frame.to_csv(index=name is not None, index_label=name))


def _file_bytes(source: Any) -> bytes:
    """The bytes of a file, or a DataFrame as CSV."""
    if hasattr(source, "to_csv"):
        return _frame_text(source).encode()
    with open(source, "rb") as file:
        return file.read()


def _paths(source: Any) -> List[Any]:
    """The files of a source: those of a folder that may hold records, several, or one."""
    if isinstance(source, (list, tuple)):
        return list(source)
    if hasattr(source, "to_csv") or not os.path.isdir(source):
        return [source]
    endings = (".csv", ".tsv", ".txt", ".dat")
    files = sorted(each for each in os.listdir(source) if each.lower().endswith(endings))
    if not files:
        raise FileNotFoundError("The folder %s has no file that ends in %s." % (source, ", ".join(endings)))
    return [os.path.join(source, each) for each in files]


def _table_of_loops(loops: Any) -> bytes:
    """What is known of loops as CSV."""
    if hasattr(loops, "to_csv"):
        return str(loops.to_csv(index=False) if "tag" in loops.columns else loops.to_csv(index_label="tag")).encode()
    if not isinstance(loops, Mapping):
        return _file_bytes(loops)
    columns = list(dict.fromkeys(column for known in loops.values() for column in known))
    table = io.StringIO()
    writer = csv.writer(table)
    writer.writerow(["tag", *columns])
    for tag, known in loops.items():
        writer.writerow([tag, *("" if known.get(column) is None else known[column] for column in columns)])
    return table.getvalue().encode()


def _form(parts: Iterable[Tuple[str, str, bytes]], boundary: str) -> bytes:
    """multipart/form-data of parts with name, file name and bytes."""
    body = []
    for name, file, content in parts:
        head = 'Content-Disposition: form-data; name="%s"' % name
        head += '; filename="%s"' % file.replace('"', "%22") if file else ""
        body += [("--%s\r\n%s\r\n\r\n" % (boundary, head)).encode(), content, b"\r\n"]
    return b"".join(body) + ("--%s--\r\n" % boundary).encode()


def _job(job: Union[str, Result, Check]) -> str:
    if isinstance(job, Check) and job.job is None:
        raise LookupError("This check is a batch, %s; its loops are the jobs of that batch." % job.batch)
    known = job if isinstance(job, str) else job.job
    return "/v1/jobs/" + quote(known if isinstance(known, str) else str((known or {})["id"]), safe="")


def _batch(check: Union[str, Check]) -> str:
    batch = check.batch if isinstance(check, Check) else check
    if batch is None:
        raise LookupError("This check is no batch; check a file, a folder or a DataFrame to compare it later.")
    return batch


def _query(fields: Mapping[str, Any]) -> str:
    given = urlencode({name: value for name, value in fields.items() if value is not None})
    return "?" + given if given else ""


def _problem(error: HTTPError) -> Problem:
    with error:
        try:
            return Problem({"status": error.code, **json.load(error)})
        except (ValueError, TypeError):  # not from the service: the page of a proxy
            return Problem({"status": error.code, "title": str(error.reason), "detail": error.url})


def _pause(tries: int, end: float = float("inf"), least: float = 0) -> bool:
    """Sleeps longer with each attempt, by a random time. False if `end` comes before."""
    pause = max(least, min(0.5 * 2 ** tries, _LONGEST_PAUSE)) * random.uniform(1, 1.2)
    if time.monotonic() + pause > end:
        return False
    time.sleep(pause)
    return True
