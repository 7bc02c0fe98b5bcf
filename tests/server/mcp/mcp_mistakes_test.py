"""The mistakes that agents make, each with a cure that an agent can act on."""

import unittest

from mcp_clients import StdioClient, call, text_of

FOPDT = {"type": "fopdt", "K": 2, "T": 10, "L": 3}
PID = {"form": "ideal", "Kp": 0.8, "Ti": 6, "Td": 1}
STEP = "t,u,y\n" + "".join("%d,%d,%g\n" % (t, 50 if t >= 10 else 40, 20 + 2 * (1 - 0.9 ** max(0, t - 13))) for t in range(90))

# tool, arguments, place of the fault, words of its sentence
MISTAKES = [
    ("tune", {"plant": {**FOPDT, "T": "10 s"}}, "/plant/T", ["10 s", "must be a number"]),
    ("tune", {"plant": {"type": "fopdt", "K": 2, "tau": 10, "theta": 3}}, "/plant/tau", ["did you mean T"]),
    ("tune", {"plant": {"K": 2, "T": 10, "L": 3}}, "/plant/type", ["type is missing", "fopdt"]),
    ("tune", {"plant": "2/(10s+1"}, "/plant", ["bracket", "close it"]),
    ("tune", {"plan": FOPDT}, "/plan", ["did you mean plant"]),
    ("tune", {}, "", ["plant"]),
    ("tune", None, "", ["plant"]),
    ("tune", '{"plant": "2/(10s+1)"}', "", ["arguments is a string", "must be an object"]),
    ("tune", {"plant": FOPDT, "tune": [{"method": "robust", "Ms": 0.5}]}, "/tune/0/Ms", ["0.5", "1"]),
    ("tune", {"plant": FOPDT, "tune": [{"method": "robust", "Ms": 14}]}, "/tune/0/Ms", ["14", "4"]),
    ("tune", {"plant": FOPDT, "tune": [{"method": "Ziegler-Nichols"}]}, "/tune/0/method", ["ziegler_nichols"]),
    ("tune", {"plant": FOPDT, "tune": [{"method": "IMC"}]}, "/tune/0/method", ["Did you mean imc"]),
    ("tune", {"plant": FOPDT, "method": "simc"}, "/method", ["tune"]),
    ("tune", {"plant": FOPDT, "notify": {"url": "https://example.com"}}, "/notify", ["Leave it out"]),
    ("tune", {"plant": FOPDT, "implement": {"product": "deltav", "y_span": [0, 1], "u_span": [0, 1]}},
     "/implement/product", ["emerson_deltav_standard"]),
    ("evaluate", {"plant": FOPDT, "controllers": [{**PID, "Kp": "0.8"}]}, "/controllers/0/Kp", ["must be a number"]),
    ("evaluate", {"plant": FOPDT, "controller": PID}, "/controller", ["did you mean controllers"]),
    ("evaluate", {"plant": FOPDT, "controllers": PID}, "/controllers", ["an array"]),
    ("identify", {"record": "/home/me/step.csv"}, "/record", ["must be an object"]),
    ("identify", {"record": {"csv": "/home/me/step.csv"}}, "/record/csv", ["file", "content"]),
    ("identify", {"record": {"csv": ""}}, "/record/csv", ["empty"]),
    ("identify", {"record": {}}, "/record/u", ["csv"]),
    ("identify", {"record": {"csv": "t,y\n" + "".join("%d,%d\n" % (i, i % 7) for i in range(50))}}, "/record/columns/u", ["controller output"]),
    ("identify", {"csv": STEP}, "/csv", ["record"]),
    ("check_record", {"record": {"csv": STEP}}, "/record", ["loops"]),
    ("settings", {"product": "delta_v", "controller": PID}, "", ["emerson_deltav_standard"]),
    ("settings", {"product": "emerson_deltav_standard", "controler": PID}, "/controler", ["did you mean controller"]),
    ("settings", {"product": "emerson_deltav_standard", "controller": PID}, "/y_span", ["y_span is missing"]),
    ("settings", {"product": "emerson_deltav_standard"}, "/controller", ["controller is missing"]),
    ("settings", {"controller": PID}, "/product", ["product is missing"]),
    ("settings", {"product": "matlab_pid", "settings": {"Kq": 1}}, "/settings/Kq", ["Kp"]),
    ("plan_relay_test", {"plant": FOPDT, "relay": {"hysteresis": "5 %"}}, "/relay/hysteresis", ["must be a number"]),
    ("code", {"controller": PID, "language": "matlab"}, "/language", ["st, c, python or arduino"]),
    ("code", {"controller": PID}, "/language", ["language is missing"]),
    ("code", {"language": "st"}, "/job", ["job is missing"]),
    ("code", {"job": "99", "language": "st"}, "", ["There is no job 99"]),
    ("code", {"contoller": PID, "language": "st"}, "/contoller", ["did you mean controller"]),
    ("job_status", {"job": "99"}, "", ["There is no job 99"]),
    ("job_status", {"id": "99"}, "/id", ["job"]),
    ("list_methods", {"method": "Ziegler"}, "", ["ziegler_nichols_step"]),
    ("list_products", {"product": "siemens"}, "", ["siemens_pid_compact"]),
]


class MistakesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = StdioClient()
        cls.tools = {tool["name"]: tool for tool in cls.client.request("tools/list")["result"]["tools"]}

    @classmethod
    def tearDownClass(cls):
        cls.client.close()

    def test_each_mistake_has_a_place_and_a_cure(self):
        for tool, arguments, place, words in MISTAKES:
            with self.subTest(tool=tool, arguments=str(arguments)[:100]):
                result = call(self.client, tool, arguments)
                self.assertTrue(result.get("isError"), text_of(result)[:300])
                error = result["structuredContent"]["error"]
                faults = {fault["pointer"]: fault["detail"] for fault in error.get("errors", [])}
                sentence = faults.get(place) or (text_of(result) if place == "" else "")
                self.assertTrue(sentence, "no fault at %s but %s" % (place, faults or error))
                for word in words:
                    self.assertIn(word, sentence)
                self.assertIn(sentence.strip(), text_of(result))
                self.assertLess(len(text_of(result)), 3000)

    def test_an_unknown_tool_or_method_gets_the_near_ones(self):
        for name, meant in (("tune_pid", "tune"), ("Tune", "Did you mean tune"), ("identfy", "Did you mean identify"),
                            ("list_product", "Did you mean list_products"), ("get_weather", "The tools are tune")):
            error = self.client.request("tools/call", {"name": name, "arguments": {}})["error"]
            self.assertEqual(error["code"], -32602)
            self.assertIn(meant, error["message"])
        self.assertEqual(self.client.request("tools/tune")["error"]["code"], -32601)
        self.assertEqual(self.client.request("tools/call")["error"]["code"], -32602)

    def test_every_refusal_of_arguments_shows_a_right_call(self):
        for name in self.tools:
            result = call(self.client, name, {"nonsense": 1})
            self.assertTrue(result["isError"], name)
            self.assertIn("A right call of %s: {" % name, text_of(result))

    def test_a_plant_in_another_notation_is_understood(self):
        for plant in ("tf([2],[10 1],'InputDelay',3)", "2*exp(-3*s)/(10*s+1)", "K=2 T=10 L=3", "2 e^{-3s}/(10 s + 1)"):
            result = call(self.client, "evaluate", {"plant": plant, "controllers": [PID]})
            self.assertNotIn("isError", result, text_of(result))

    def test_a_product_is_found_by_its_usual_name(self):
        for word in ("DeltaV", "s7", "controllogix", "Marlin"):
            products = call(self.client, "list_products", {"search": word})["structuredContent"]["products"]
            self.assertTrue(products, word)


if __name__ == "__main__":
    unittest.main()
