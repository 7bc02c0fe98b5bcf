"""Calls to a running service, with the processor time that they take."""

import http.client
import json
import os
import time
import urllib.parse


class Client:
    """`process`: the service's id on this machine, if its processor time is wanted."""

    def __init__(self, address, process=None):
        self.host = urllib.parse.urlsplit(address).netloc
        self.process = process

    def processor_seconds(self):
        if self.process is None:
            return time.monotonic()
        with open(f"/proc/{self.process}/stat", encoding="ascii") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def ask(self, call, request):
        """The answer's status, its content, and the seconds."""
        before = self.processor_seconds()
        connection = http.client.HTTPConnection(self.host, timeout=120)
        connection.request("POST", "/v1/" + call, json.dumps(request), {"Content-Type": "application/json"})
        response = connection.getresponse()
        body = json.loads(response.read())
        connection.close()
        return response.status, body, self.processor_seconds() - before


class Tally:
    """What was found in the cases of one kind."""

    def __init__(self, name, wanted_seconds):
        self.name, self.wanted = name, wanted_seconds
        self.cases, self.failed, self.refused, self.seconds, self.notes = 0, [], {}, [], {}
        self.slowest = None

    def expect(self, holds, sentence, request):
        if not holds:
            self.failed.append((sentence, request))
            print(f"FAILED {self.name}: {sentence}\n    {json.dumps(request)}", flush=True)

    def time(self, seconds, request):
        if not self.seconds or seconds > max(self.seconds):
            self.slowest = request
        self.seconds.append(seconds)

    def refuse(self, body):
        message = json.dumps(body)[:200]
        self.refused[message] = self.refused.get(message, 0) + 1

    def note(self, name, value):
        self.notes.setdefault(name, []).append(value)

    def report(self):
        times = sorted(self.seconds) or [0]
        print(f"{self.name}: {self.cases} cases, {len(self.failed)} failures; seconds median "
              f"{times[len(times) // 2]:.3f}, 90 % {times[len(times) * 9 // 10]:.3f}, largest {times[-1]:.3f}, wanted "
              f"{self.wanted}")
        if times[-1] > 2 * self.wanted:
            print(f"    slowest: {json.dumps(self.slowest)}")
        for message, count in self.refused.items():
            print(f"    refused {count}: {message}")
        for name, values in self.notes.items():
            values = sorted(values)
            print(f"    {name}: {values[0]:.6g} .. median {values[len(values) // 2]:.6g} .. {values[-1]:.6g}")
