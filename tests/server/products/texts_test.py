"""Plants and controllers as text of control software, over HTTP: the frequency response of the answered plant is that of
the numbers in the text, computed with NumPy; damaged texts are answered and never break the service."""

import random
import unittest

import numpy as np

from service import FOPDT, Service

S = 1j * np.logspace(-3, 2, 41)
SEED = 5


def fraction(num, den, delay=0):
    return np.polyval(num, S) / np.polyval(den, S) * np.exp(-delay * S)


def response(plant):
    """P of a plant of an answer at S."""
    delay = np.exp(-plant.get("L", 0) * S)
    kind = plant["type"]
    if kind == "fopdt":
        return plant["K"] / (plant["T"] * S + 1) * delay
    if kind == "sopdt" and "zeta" in plant:
        return plant["K"] / (plant["T"] ** 2 * S ** 2 + 2 * plant["zeta"] * plant["T"] * S + 1) * delay
    if kind == "sopdt":
        return plant["K"] / ((plant["T1"] * S + 1) * (plant["T2"] * S + 1)) * delay
    if kind == "ipdt":
        return plant["K"] / (S * (plant.get("T", 0) * S + 1)) * delay
    if kind == "transfer_function":
        return np.polyval(plant["num"], S) / np.polyval(plant["den"], S) * delay
    if kind == "zpk":
        return of_roots(*([complex(*root) if isinstance(root, list) else root for root in plant[name]]
                          for name in ("zeros", "poles")), plant["K"]) * delay
    return of_states(*(np.array(plant[name]) for name in "ABC"), plant.get("D", 0)) * delay


def of_roots(zeros, poles, K):
    out = K * np.ones_like(S)
    for zero in zeros:
        out = out * (S - zero)
    for pole in poles:
        out = out / (S - pole)
    return out


def of_states(A, B, C, D):
    n = len(A)
    return np.array([C.reshape(1, n) @ np.linalg.solve(s * np.eye(n) - A, B.reshape(n, 1)) for s in S]).ravel() + D


def words(numbers, separator):
    return separator.join(repr(float(number)) for number in numbers)


def root(number, unit):
    number = complex(number)
    return repr(number.real) + (f"{number.imag:+}{unit}" if number.imag else "")


class Texts:
    """Random numbers and the texts that the programs' users write with them; (text, response) each."""

    def __init__(self, chance):
        self.chance = chance

    def number(self, sign=False):
        value = round(10 ** self.chance.uniform(-2, 2), self.chance.randrange(2, 5)) + 0.001
        return -value if sign and self.chance.random() < 0.3 else value

    def fractions(self):
        den = [self.number() for _ in range(self.chance.randrange(2, 5))]
        num = [self.number(True) for _ in range(self.chance.randrange(1, len(den)))]
        L = self.number()
        wanted = fraction(num, den, L)
        blank, comma = (f"[{words(num, s)}], [{words(den, s)}]" for s in (" ", ", "))
        sum_of = " + ".join(f"{c!r}*s^{len(den) - 1 - i}" for i, c in enumerate(den))
        top = " + ".join(f"({c!r})*s^{len(num) - 1 - i}" for i, c in enumerate(num))
        braces = f"b={{{words(num, ', ')}}}, a={{{words(den, ', ')}}}"
        for text in (f"G = tf({blank}, 'InputDelay', {L!r});", f"tf({comma}, 'OutputDelay', {L!r})",
                     f"tf({blank},'IODelay',{L!r})", f"delay({L!r})*tf({comma})", f"tf({comma})*delay({L!r})",
                     f"num = [{words(num, ' ')}]; den = [{words(den, ' ')}];\ns = tf('s');\nG = tf(num,den)*exp(-{L!r}*s);",
                     f"s = tf('s'); G = exp(-{L!r}*s)*({top})/({sum_of})",
                     f"import control as ct\ns = ct.tf('s')\nP = ct.TransferFunction({comma})*exp(-{L!r}*s)",
                     f"Modelica.Blocks.Continuous.TransferFunction p({braces});\nModelica.Blocks.Nonlinear.FixedDelay "
                     f"d(delayTime={L!r});\nequation\n  connect(d.y, p.u);", f"TransferFunction({braces})*exp(-{L!r} s)"):
            yield text, wanted

    def roots(self):
        pair = complex(-self.number(), self.number())
        zeros, poles, K, L = [-self.number(True)], [-self.number(), pair, pair.conjugate()], self.number(True), self.number()
        wanted = of_roots(zeros, poles, K) * np.exp(-L * S)
        for unit, separator, form in (("i", " ", "zpk([%s], [%s], %r, 'InputDelay', %r)"),
                                      ("j", ", ", "ct.zpk([%s], [%s], gain=%r)*exp(-%r*s)"),
                                      ("im", ", ", "zpk([%s], [%s], %r)*delay(%r)"),
                                      ("*1i", "; ", "zpk([%s],[%s],%r,'OutputDelay',%r)")):
            lists = [separator.join(root(each, unit) for each in each_list) for each_list in (zeros, poles)]
            yield form % (*lists, K, L), wanted

    def states(self):
        A = np.array([[self.number(True) - 50 * (i == j) for j in range(2)] for i in range(2)])
        B, C = (np.array([self.number(True), self.number()]) for _ in range(2))
        D, L = self.number(), self.number()
        wanted = of_states(A, B, C, D) * np.exp(-L * S)
        rows = [words(row, " ") for row in A]
        nested = ", ".join(f"[{words(row, ', ')}]" for row in A)
        yield f"ss([{rows[0]}; {rows[1]}], [{words(B, '; ')}], [{words(C, ' ')}], {D!r}, 'InputDelay', {L!r})", wanted
        yield (f"A = [{rows[0]}\n{rows[1]}]; B = [{words(B, ' ')}]'; C = [{words(C, ' ')}]; G = ss(A,B,C,{D!r}); "
               f"G.InputDelay = {L!r};", wanted)
        yield (f"ct.ss([{nested}], [[{words(B[:1], '')}], [{words(B[1:], '')}]], [[{words(C, ', ')}]], [[{D!r}]])"
               f"*exp(-{L!r}*s)", wanted)
        yield f"ss([{rows[0]}; {rows[1]}], [{words(B, '; ')}], [{words(C, ' ')}], {D!r})*delay({L!r})", wanted

    def blocks(self):
        k, T, w, D, L = (self.number() for _ in range(5))
        yield f"FirstOrder(k={k!r}, T={T!r})*FixedDelay(delayTime={L!r})", fraction([k], [T, 1], L)
        yield (f"Modelica.Blocks.Continuous.SecondOrder(k={k!r}, w={w!r}, D={D!r})",
               fraction([k], [1 / w ** 2, 2 * D / w, 1]))
        yield f"Modelica.Blocks.Continuous.Integrator(k={k!r})", fraction([k], [1, 0])
        yield f"K = {k!r}; T = {T!r}; L = {L!r}; s = tf('s'); G = K*exp(-L*s)/(T*s + 1)", fraction([k], [T, 1], L)

    def all(self):
        for kind in (self.fractions, self.roots, self.states, self.blocks):
            yield from kind()


class TextsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(cls.service.__exit__)

    def parsed(self, text):
        answer = self.service.post("/v1/plants/parse", {"text": text})
        self.assertEqual(answer.status, 200, (text, answer.body))
        return answer.json

    def test_a_text_is_the_plant_of_its_numbers(self):
        texts, worst = 0, 0
        chance = random.Random(SEED)
        for _ in range(25):
            for text, wanted in Texts(chance).all():
                found = response(self.parsed(text)["plant"])
                difference = np.max(np.abs(found / wanted - 1))
                self.assertLess(difference, 1e-9, text)
                texts, worst = texts + 1, max(worst, difference)
        self.assertEqual(texts, 25 * 22)
        print(f"{texts} texts, the worst difference is {worst:.2g}", end=" ")

    def test_what_the_service_writes_it_reads(self):
        chance = random.Random(SEED)
        for text, wanted in Texts(chance).all():
            for snippet in self.parsed(text)["snippets"]:
                if "pade" not in snippet["text"]:
                    again = response(self.parsed(snippet["text"])["plant"])
                    self.assertLess(np.max(np.abs(again / wanted - 1)), 1e-9, snippet["text"])

    def test_a_controller_as_text_is_evaluated_as_its_settings(self):
        given = {"pidstd(0.8, 6, 1, 10)": ("matlab_pidstd", {"Kp": 0.8, "Ti": 6, "Td": 1, "N": 10}),
                 "pid(0.8, 0.13, 0.8, 0.1)": ("matlab_pid", {"Kp": 0.8, "Ki": 0.13, "Kd": 0.8, "Tf": 0.1}),
                 "LimPID(k=0.8, Ti=6, Td=1, wp=0.6)": ("modelica_limpid", {"k": 0.8, "Ti": 6, "Td": 1, "wp": 0.6})}
        answers = [self.service.post("/v1/evaluate", {"plant": FOPDT, "controllers": controllers,
                                                      "evaluate": {"points": 0}}).json["controllers"]
                   for controllers in (list(given), [{"product": product, "settings": settings}
                                                     for product, settings in given.values()])]
        for text, settings in zip(*answers):
            for part in ("controller", "robustness", "performance"):
                self.assertEqual(text[part], settings[part])

    def test_a_controller_as_text_needs_seconds(self):
        request = {"plant": FOPDT, "controllers": ["pidstd(0.8, 6)"], "units": {"time": "min"}}
        answer = self.service.post("/v1/evaluate", request)
        self.assertEqual((answer.status, answer.json["errors"][0]["pointer"]), (422, "/controllers/0"))

    def test_a_job_keeps_the_settings_of_the_text(self):
        request = {"plant": "tf([2],[10 1],'InputDelay',3)", "baseline": "pidstd(0.5, 10)", "tune": [{"method": "simc"}]}
        job = self.service.post("/v1/jobs", request, {"Prefer": "wait=30"}).json
        self.assertEqual(job["request"]["plant"], FOPDT)
        self.assertEqual(job["request"]["baseline"], {"product": "matlab_pidstd", "settings": {"Kp": 0.5, "Ti": 10}})
        self.assertEqual(job["result"]["controllers"][-1]["controller"]["Kp"], 0.5)

    def test_damaged_texts_are_answered(self):
        chance = random.Random(SEED)
        texts = [text for text, _ in Texts(chance).all()] + ["pidstd(0.8, 6, 1, 10)", "LimPID(k=0.8, Ti=6)"]
        for _ in range(1500):
            text = list(chance.choice(texts))
            for _ in range(chance.randrange(1, 5)):
                at = chance.randrange(len(text))
                text[at:at + chance.randrange(3)] = chance.choice(["", "(", "[", "]'", ",", ";\n", "ss(", "=", "\0", "é", "1e9",
                                                                  "pade(", "connect(", "{", "%", "#", "*", " -"])
            text = "".join(text)
            for path, body in (("/v1/plants/parse", {"text": text}),
                               ("/v1/evaluate", {"plant": FOPDT, "controllers": [text], "evaluate": {"points": 0}})):
                answer = self.service.post(path, body)
                self.assertIn(answer.status, (200, 422), (text, answer.body))


if __name__ == "__main__":
    unittest.main()
