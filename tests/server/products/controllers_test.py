"""Products over HTTP: the catalogue, both conversions, and their refusals."""

import unittest

from service import Service

DESIGN = {"form": "ideal", "Kp": 1.5, "Ti": 120, "Td": 20, "b": 0.6, "filter": {"type": "derivative", "Tf": 2}}
REQUEST = {"controller": DESIGN, "y_span": [0, 200], "u_span": [0, 100], "sample_time": 0.25}


class ControllersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(cls.service.__exit__)

    def settings(self, product, **more):
        return self.service.post(f"/v1/controllers/{product}/settings", REQUEST | more)

    def test_the_list_leads_to_every_entry(self):
        entries = self.service.get("/v1/controllers").json["controllers"]
        self.assertEqual(len(entries), 64)
        self.assertEqual(len({entry["id"] for entry in entries}), 64)
        for entry in entries:
            answer = self.service.get("/v1/controllers/" + entry["id"])
            self.assertEqual((answer.status, answer.media_type), (200, "application/json"))
            self.assertEqual([parameter["name"] for parameter in answer.json["parameters"]], entry["parameters"])

    def test_settings_go_in_and_the_controller_comes_back(self):
        answer = self.settings("emerson_deltav_series")
        self.assertEqual(answer.status, 200, answer.body)
        self.assertIn("Server-Timing", answer.headers)
        body = answer.json
        for name, expected in (("GAIN", 2.32793), ("RESET", 93.1174), ("RATE", 30.723), ("ALPHA", 0.125)):
            self.assertAlmostEqual(body["settings"][name] / expected, 1, places=5)
        self.assertEqual(body["as_typed"]["GAIN"], "2.328")
        self.assertEqual(body["units"]["RESET"], "s")
        request = {name: REQUEST[name] for name in ("y_span", "u_span")} | {"settings": body["settings"]}
        twin = self.service.post("/v1/controllers/emerson_deltav_series/controller", request).json["controller"]
        for name in ("Kp", "Ti", "Td"):
            self.assertAlmostEqual(twin[name], DESIGN[name], places=9)
        self.assertEqual(twin, body["realised"])

    def test_rows_of_a_schedule_are_typed_one_by_one(self):
        row = {name: DESIGN[name] for name in ("Kp", "Ti", "Td", "b")}
        request = {name: REQUEST[name] for name in ("y_span", "u_span")}
        request |= {"rows": [row | {"at": 20}, row | {"at": 60, "Kp": 3}], "interpolation": "steps"}
        answer = self.service.post("/v1/controllers/emerson_deltav_standard/schedule", request)
        self.assertEqual(answer.status, 200, answer.body)
        self.assertEqual([(row["at"], row["typing"]["settings"]["GAIN"]) for row in answer.json["rows"]],
                         [(20, 3), (60, 6)])

    def test_every_published_example_is_answered(self):
        for entry in self.service.get("/v1/controllers").json["controllers"]:
            example = self.service.get("/v1/controllers/" + entry["id"]).json["example"]
            expected = example.pop("settings")
            body = self.service.post(f"/v1/controllers/{entry['id']}/settings", example).json
            self.assertEqual(set(body["settings"]), set(expected), entry["id"])

    def test_complex_zeros_are_422_and_nearest_answers(self):
        controller = DESIGN | {"Ti": 60}
        answer = self.settings("emerson_deltav_series", controller=controller)
        self.assertEqual((answer.status, answer.json["type"]), (422, "not-representable"))
        self.assertIn("The nearest", answer.json["detail"])
        answer = self.settings("emerson_deltav_series", controller=controller, nearest=True)
        self.assertEqual(answer.status, 200)
        self.assertEqual(answer.json["notes"][0]["code"], "nearest")

    def test_weights_come_with_the_structure_that_they_need(self):
        structures = {}
        for b in (0, 0.6, 1):
            answer = self.settings("emerson_deltav_standard", controller=DESIGN | {"b": b, "c": 0})
            self.assertEqual(answer.status, 200, answer.body)
            typed = answer.json["as_typed"]
            structures[b] = typed["STRUCTURE"]
            self.assertEqual("BETA" in typed, b == 0.6)
            self.assertEqual(answer.json["realised"]["b"], b)
        self.assertEqual(structures, {0: "I action on error, PD action on PV", 0.6: "Two degrees of freedom controller",
                                      1: "PI action on error, D action on PV"})

    def test_what_is_missing_is_named(self):
        for product, missing in (("emerson_deltav_series", "y_span"), ("klipper", "u_span"),
                                 ("esphome_pid", "sample_time")):
            request = {name: value for name, value in REQUEST.items() if name != missing}
            answer = self.service.post(f"/v1/controllers/{product}/settings", request)
            self.assertEqual(answer.status, 422)
            self.assertEqual([error["pointer"] for error in answer.json["errors"]], ["/" + missing])

    def test_unknown_products_and_wrong_bodies(self):
        for answer in (self.service.get("/v1/controllers/klippr"), self.settings("klippr")):
            self.assertEqual((answer.status, answer.media_type), (404, "application/problem+json"))
            self.assertIn("klipper", answer.json["detail"])
        self.assertEqual(self.service.post("/v1/controllers/klipper/settings", "{").status, 400)
        answer = self.service.post("/v1/controllers/klipper/settings", {"controler": DESIGN})
        self.assertEqual({error["pointer"] for error in answer.json["errors"]}, {"/controler", "/controller"})
        self.assertEqual(self.service.get("/v1/controllers/klipper/settings").status, 405)


if __name__ == "__main__":
    unittest.main()
