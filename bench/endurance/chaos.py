"""Jobs in their many thousands while whatever computes and keeps them is killed."""

import http.client
import json
import random
import socket
import threading
import time

from figures import Table, peak_memory
from places import SqlitePlace, place_of, plain
from service import Service

VARIANTS = 97
SINGLES = 0.1  # of all jobs: posted one by one
POSTERS = 4
PATIENCE = 3600


def request(variant):
    return {"plant": {"type": "fopdt", "K": 1, "T": 10 + variant, "L": 2}, "tune": [{"method": "simc"}],
            "evaluate": {"points": 0}}


def results_alone():
    """What each request comes to where nothing disturbs it."""
    with Service() as service:
        quiet = SqlitePlace()
        ids = {service.post_job(request(variant), wait=30)["id"]: variant for variant in range(VARIANTS)}
        quiet.path = service.store.removeprefix("sqlite:")
        found = quiet.rows("SELECT j.id, e.result FROM jobs j JOIN ended e ON e.seq = j.seq")
        return {ids[job]: plain(result) for job, result in found}


class Fleet:
    """The processes on one store. A port that is gone is somebody's who is being started again."""

    def __init__(self, place):
        self.place = place
        self.lock = threading.Lock()
        self.peak = 0
        self.services = [self.make() for _ in range(place.replicas)]

    def make(self):
        return Service("--workers", "2", "--lease", "3s", "--log-level", "error", store=self.place.store)

    def port(self):
        return random.choice(self.services).port

    def note_memory(self):
        for service in list(self.services):
            self.peak = max(self.peak, peak_memory(service.process.pid))

    def kill(self, chosen):
        self.note_memory()
        for service in chosen:
            service.kill()
        for service in chosen:
            self.again(service)

    def again(self, service):
        """The database may be away when it starts: then once more."""
        end = time.monotonic() + 120
        while True:
            try:
                return service.start()
            except AssertionError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.2)

    def stop(self):
        self.note_memory()
        for service in self.services:
            service.__exit__()


class Posting:
    """Posts all jobs, each until it is accepted; a key makes what was sent twice one job."""

    def __init__(self, fleet, jobs, batch):
        self.fleet = fleet
        self.lock = threading.Lock()
        self.singles = {}  # id -> variant
        self.batches = {}  # id -> first variant, entries
        singles = int(jobs * SINGLES)
        self.work = [("single", number, 1) for number in range(singles)]
        self.work += [("batch", first, min(batch, jobs - first)) for first in range(singles, jobs, batch)]
        random.shuffle(self.work)
        self.threads = [threading.Thread(target=self.post_all, daemon=True) for _ in range(POSTERS)]
        self.accepted = 0

    def start(self):
        for thread in self.threads:
            thread.start()

    def done(self):
        return not any(thread.is_alive() for thread in self.threads)

    def post_all(self):
        while True:
            with self.lock:
                if not self.work:
                    return
                kind, number, count = self.work.pop()
            path, kind_of_body = ("/v1/jobs", "application/json") if kind == "single" else \
                ("/v1/batches", "application/x-ndjson")
            body = "\n".join(json.dumps(request((number + i) % VARIANTS)) for i in range(count))
            found = self.post(path, body, {"Content-Type": kind_of_body, "Idempotency-Key": "%s-%d" % (kind, number)})
            with self.lock:
                self.accepted += count
                if kind == "single":
                    self.singles[found["id"]] = number % VARIANTS
                else:
                    self.batches[found["id"]] = (number % VARIANTS, count)

    def post(self, path, body, headers):
        while True:
            try:
                connection = http.client.HTTPConnection("127.0.0.1", self.fleet.port(), timeout=120)
                connection.request("POST", path, body, headers)
                answer = connection.getresponse()
                text = answer.read()
                connection.close()
                if answer.status == 202:
                    return json.loads(text)
                if answer.status not in (429, 503, 507):
                    raise SystemExit("%s was answered with %d: %s" % (path, answer.status, text[:300]))
                time.sleep(0.2)
            except (OSError, http.client.HTTPException, socket.timeout):
                time.sleep(0.05)


def ended(fleet):
    """Jobs that have ended; nothing while nobody can say."""
    try:
        connection = http.client.HTTPConnection("127.0.0.1", fleet.port(), timeout=20)
        connection.request("GET", "/v1/queue")
        answer = connection.getresponse()
        queue = json.loads(answer.read())
        connection.close()
        return queue["queued"]["single"] + queue["queued"]["batch"] if answer.status == 200 else None
    except (OSError, http.client.HTTPException, ValueError):
        return None


def work_through(place, fleet, posting, given):
    """Kills at random numbers of ended jobs until all have ended. Returns how many kills there were."""
    moments = sorted((random.randrange(given.jobs), "process") for _ in range(given.kills))
    if place.replicas > 1:
        moments = sorted(moments + [(random.randrange(given.jobs), "database") for _ in range(given.database_kills)])
    kills = {"process": 0, "database": 0}
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        time.sleep(0.05)
        fleet.note_memory()
        accepted, waiting = posting.accepted, ended(fleet)
        if waiting is None:
            continue
        if moments and accepted - waiting >= moments[0][0]:
            what = moments.pop(0)[1]
            kills[what] += 1
            if what == "database":
                place.crash()
            elif random.random() < 0.2:
                fleet.kill(list(fleet.services))
            else:
                fleet.kill([random.choice(fleet.services)])
        elif waiting == 0 and posting.done() and at_rest(place):
            break
    return kills


def at_rest(place):
    try:
        return all(int(row[0]) == 0 for row in place.rows("SELECT (SELECT count(*) FROM waiting) + "
                                                          "(SELECT count(*) FROM running)"))
    except Exception:  # the database is away
        return False


def judge(table, place, posting, alone):
    expected = dict(posting.singles)
    entries = {batch: first for batch, (first, _) in posting.batches.items()}
    wrong = lost = twice = strange = crashed = 0
    seen = set()
    per_batch = dict.fromkeys(entries, 0)
    for job, batch, index, status, attempts, result in place.rows(
            "SELECT j.id, coalesce(b.id, ''), coalesce(j.batch_index, 0), coalesce(e.status, 'none'), "
            "coalesce(e.attempts, 0), coalesce(e.result, '') FROM jobs j LEFT JOIN ended e ON e.seq = j.seq "
            "LEFT JOIN batches b ON b.seq = j.batch"):
        if batch:
            strange += batch not in entries
            per_batch[batch] = per_batch.get(batch, 0) + 1
            variant = (entries.get(batch, 0) + int(index)) % VARIANTS
        else:
            strange += job not in expected
            variant = expected.get(job, 0)
        twice += job in seen
        seen.add(job)
        lost += status == "none"
        crashed += int(attempts) > 1
        wrong += status != "succeeded" or plain(result) != alone[variant]
    lost += sum(count - per_batch[batch] for batch, (_, count) in posting.batches.items())
    lost += sum(1 for job in expected if job not in seen)
    orphans = sum(int(row[0]) for row in place.rows(
        "SELECT (SELECT count(*) FROM ended e WHERE NOT EXISTS (SELECT 1 FROM jobs j WHERE j.seq = e.seq))"))
    counts = sum(1 for batch, total in place.rows(
        "SELECT b.id, count(*) FROM batches b JOIN jobs j ON j.batch = b.seq WHERE b.ended_at IS NOT NULL GROUP BY b.id"))
    table.row("jobs accepted", posting.accepted, "", posting.accepted)
    table.row("jobs that did not end", lost, "", 0)
    table.row("jobs that ended twice, or were never accepted", twice + strange + orphans, "", 0)
    table.row("results that differ from the job's alone", wrong, "", 0)
    table.row("batches that were not seen to end", len(entries) - counts, "", 0)
    table.row("jobs that were begun more than once", crashed)


def run(store, given, _build):
    random.seed(given.seed)
    table = Table("chaos", store)
    alone = results_alone()
    with place_of(store) as place:
        fleet = Fleet(place)
        posting = Posting(fleet, given.jobs, given.batch)
        begun = time.monotonic()
        posting.start()
        kills = work_through(place, fleet, posting, given)
        seconds = time.monotonic() - begun
        time.sleep(2.5)  # the last batch is settled
        fleet.stop()
        table.row("processes killed", kills["process"], "", given.kills, at_most=False)
        if place.replicas > 1:
            table.row("times that the database was", kills["database"], "", given.database_kills, at_most=False)
        judge(table, place, posting, alone)
        table.row("jobs a second in all", posting.accepted / seconds, "/s")
        table.row("peak memory of a process", fleet.peak, "MiB", 400)
        table.row("bytes of the store for each job", place.bytes() / max(1, posting.accepted), "B", 6000)
    return table.held
