"""Transfer functions with an exact dead time, and PID controllers as the service answers them."""

import numpy as np


class Transfer:
    """K (z1 s + 1).../((T1 s + 1)...) e^(-L s), a lag may be negative; `integrators` more poles at 0."""

    def __init__(self, K, lags=(), L=0.0, leads=(), integrators=0):
        self.K, self.lags, self.L, self.leads, self.integrators = K, list(lags), L, list(leads), integrators

    def __call__(self, s):
        out = self.K * np.exp(-self.L * s)
        for lead in self.leads:
            out = out * (lead * s + 1)
        for lag in self.lags:
            out = out / (lag * s + 1)
        return out / s ** self.integrators

    def unstable_poles(self):
        return sum(lag < 0 for lag in self.lags)

    def times(self):
        return [abs(t) for t in self.lags + self.leads + [self.L] if t != 0]

    def text(self):
        def factor(t):
            return f"({t!r}s{'+' if t >= 0 else ''}1)".replace("s1)", "s+1)")

        above = "".join(factor(lead) for lead in self.leads)
        below = "s" * (self.integrators > 0) + "".join(factor(lag) for lag in self.lags)
        return f"{self.K!r} {above} e^(-{self.L!r}s)" + (f"/({below})" if below else "")

    def changed(self, gain=1.0, dead_time=0.0):
        return Transfer(self.K * gain, self.lags, self.L + dead_time, self.leads, self.integrators)


class Pid:
    """The answer's form ideal: Kp (1 + 1/(s Ti) + s Td)/(1 + s Tf + (s Tf)^2/2) on the measurement, and on the set
    point Kp (b + 1/(s Ti) + c s Td) without the filter, which is in the measurement."""

    def __init__(self, answer):
        assert answer["form"] == "ideal" and answer["filter"]["type"] in ("none", "measurement_second_order"), answer
        self.Kp, self.Ti, self.Td = answer["Kp"], answer.get("Ti"), answer.get("Td") or 0.0
        self.Tf = answer["filter"].get("Tf", 0.0)
        self.b, self.c = answer.get("b", 1.0), answer.get("c", 0.0)

    @staticmethod
    def pi(Kp, Ti):
        return Pid({"form": "ideal", "Kp": Kp, "Ti": Ti, "Td": 0, "filter": {"type": "none"}})

    def __call__(self, s):
        integral = 1 / (self.Ti * s) if self.Ti else 0
        return self.Kp * (1 + integral + self.Td * s) / (1 + self.Tf * s + (self.Tf * s) ** 2 / 2)

    def of_setpoint(self, s):
        return self.Kp * (self.b + (1 / (self.Ti * s) if self.Ti else 0) + self.c * self.Td * s)

    def times(self):
        return [t for t in (self.Ti, self.Td, self.Tf) if t]


class Rational:
    """num/den in descending powers of s."""

    def __init__(self, answer):
        self.num, self.den = answer["num"], answer["den"]

    def __call__(self, s):
        return np.polyval(self.num, s) / np.polyval(self.den, s)
