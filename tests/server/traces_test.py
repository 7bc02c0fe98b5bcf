"""The traces of a job's result as CSV."""

import csv
import io
import unittest

from service import FOPDT, LONG, QUICK, Service


class TracesTest(unittest.TestCase):
    def test_traces_of_a_job_are_columns(self):
        with Service() as service:
            job = service.post_job({"plant": FOPDT, "units": {"y": "degC"}, "tune": [{"method": "simc"}, {"method": "robust"}],
                                    "evaluate": {"points": 11, "horizon": 50}}, wait=30)
            answer = service.get("/v1/jobs/%s/result.csv" % job["id"])
            self.assertEqual((answer.status, answer.media_type), (200, "text/csv"))
            table = list(csv.reader(io.StringIO(answer.body.decode(), newline="")))
            self.assertEqual(table[0][:3], ["t [s]", "simc setpoint y [degC]", "simc setpoint u"])
            self.assertEqual([float(row[0]) for row in table[1:]], [5.0 * i for i in range(11)])
            robust = job["result"]["controllers"][1]["responses"]["load"]["u"]
            self.assertEqual([float(row[table[0].index("robust load u")]) for row in table[1:]], robust)
            frequency = service.get("/v1/jobs/%s/result.csv?traces=frequency" % job["id"]).body.decode()
            self.assertTrue(frequency.startswith("simc omega [rad/s],simc L re"), frequency[:100])
            for path, status in (("none/result.csv", 404), (job["id"] + "/result.csv?traces=all", 422),
                                 (job["id"] + "/result.csv?traces=model", 404)):
                self.assertEqual(service.get("/v1/jobs/" + path).status, status)
            without = service.post_job(QUICK, wait=30)
            answer = service.get("/v1/jobs/%s/result.csv" % without["id"])
            self.assertEqual(answer.status, 404)
            self.assertIn("evaluate.points 0", answer.json["detail"])
            running = service.post_job(LONG)
            self.assertEqual(service.get("/v1/jobs/%s/result.csv" % running["id"]).status, 409)
            service.post("/v1/jobs/%s/cancel" % running["id"], "")


if __name__ == "__main__":
    unittest.main()
