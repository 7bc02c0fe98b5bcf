"""Random plants of two and three interacting loops: the structured peak within its limit, every subset of the loops
stable, the cost against BLT scaled to the same peak."""

import itertools

import numpy as np
from scipy.optimize import brentq

from client import Tally
from frequency import grid, peak, unstable_zeros
from responses import absolute_integral
from transfer import Pid, Transfer

WITHIN = 1e-5


def log_uniform(random, low, high):
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def two_loops(random):
    """Relative gain of the diagonal 0.3 to 5, all dead times independent."""
    relative = log_uniform(random, 0.3, 5)
    product, share = 1 - 1 / relative, log_uniform(random, 0.3, 3)
    gains = np.array([[1, np.sign(product) * np.sqrt(abs(product)) * share], [np.sqrt(abs(product)) / share, 1]])
    return gains


def three_loops(random):
    """Moderate interaction: the relative gains of the diagonal between 0.4 and 4."""
    while True:
        gains = random.uniform(-0.7, 0.7, (3, 3))
        np.fill_diagonal(gains, 1)
        relative = np.diag(gains * np.linalg.inv(gains).T)
        if relative.min() > 0.4 and relative.max() < 4 and np.linalg.det(gains) > 0.1:
            return gains


def problem(random, n):
    gains = two_loops(random) if n == 2 else three_loops(random)
    gains = gains * np.array([[log_uniform(random, 0.3, 3) * random.choice([-1, 1])] for _ in range(n)])
    plants = [[Transfer(float(gains[i, j]), [log_uniform(random, 3, 30)], log_uniform(random, 0.3, 6))
               for j in range(n)] for i in range(n)]
    request = {"plant": [[p.text() for p in row] for row in plants],
               "controllers": "PI" if random.random() < 0.85 else "PID",
               "limit": {"mu": round(float(random.uniform(1.4, 2)), 3)}}
    if n == 2 and random.random() < 0.5:
        request["pairing"] = [1, 2]
    if random.random() < 0.3:
        request["weights"] = {"y": [round(log_uniform(random, 0.3, 3), 3) for _ in range(n)]}
    return request, plants


class Loops:
    """P and diagonal C over s, paired; arrays of matrices."""

    def __init__(self, plants, pairing, controllers):
        self.P = [[row[j - 1] for j in pairing] for row in plants]
        self.C = controllers
        self.n = len(controllers)
        self.times = [t for row in self.P for p in row for t in p.times()] + [t for c in controllers for t in c.times()]

    def matrix(self, s, of=None):
        of = range(self.n) if of is None else of
        return np.stack([np.stack([self.P[i][j](s) for j in of], -1) for i in of], -2)

    def difference(self, s, of=None):
        of = list(range(self.n)) if of is None else of
        C = np.stack([self.C[j](s) for j in of], -1)
        return np.eye(len(of)) + self.matrix(s, of) * C[..., None, :]

    def determinant(self, of=None):
        return lambda s: np.linalg.det(self.difference(s, of))

    def unstable(self, of=None):
        of = list(range(self.n)) if of is None else of
        return unstable_zeros(self.determinant(of), sum(self.C[i].Ti is not None for i in of), self.times)

    def sensitivity(self, s):
        return np.linalg.inv(self.difference(s))

    def IAE(self, load, output):
        def transform(s):
            return np.einsum("...k,...k->...", self.sensitivity(s)[..., output, :], self.matrix(s)[..., :, load]) / s

        return absolute_integral(transform, sum(self.times), 2 * min(t for row in self.P for p in row for t in p.times()))


def structured(S):
    """mu of matrices for one complex gain in each row, by bisection of the scalings: independent of closed forms.

    Two rows: over the one scaling that matters, on all matrices at once; three: by Newton-like coordinate steps."""
    n = S.shape[-1]
    x = np.zeros(S.shape[:-2] + (n,))

    def size(x):
        scaled = S * np.exp(x[..., :, None] - x[..., None, :])
        return np.linalg.norm(scaled, 2, (-2, -1))

    # Golden section over each coordinate in turn: the function is convex.
    ratio = (np.sqrt(5) - 1) / 2
    rounds = 1 if n == 2 else 6
    width = 8.0
    for round_ in range(rounds):
        for k in range(1, n):
            low, high = x[..., k] - width, x[..., k] + width
            a, b = high - ratio * (high - low), low + ratio * (high - low)

            def at(value):
                moved = x.copy()
                moved[..., k] = value
                return size(moved)

            fa, fb = at(a), at(b)
            for _ in range(45 if n == 2 else 30):
                left = fa < fb
                low, high = np.where(left, low, a), np.where(left, b, high)
                new_a, new_b = high - ratio * (high - low), low + ratio * (high - low)
                fnew = at(np.where(left, new_a, new_b))
                fa, fb = np.where(left, fnew, fb), np.where(left, fa, fnew)
                a, b = new_a, new_b
            x[..., k] = (a + b) / 2
        width = max(width / 3, 0.3)
    return size(x)


def structured_exactly(S, sections=36, width=8.0):
    """The same of three rows, the scaling of one row the best for each of the other's: steps along one coordinate alone
    end at a kink, where two singular values are equal."""
    ratio = (np.sqrt(5) - 1) / 2

    def least(f, shape):
        low, high = np.full(shape, -width), np.full(shape, width)
        for _ in range(sections):
            a, b = high - ratio * (high - low), low + ratio * (high - low)
            left = f(a) < f(b)
            low, high = np.where(left, low, a), np.where(left, b, high)
        return f((low + high) / 2)

    def size(x, y):
        d = np.exp(np.stack([np.zeros_like(x), x, y], -1))
        return np.linalg.norm(S * d[..., :, None] / d[..., None, :], 2, (-2, -1))

    return least(lambda x: least(lambda y: size(x, y), S.shape[:-2]), S.shape[:-2])


def balanced(S):
    """mu of two rows with the scaling that makes both off-diagonals equal in size."""
    ratio = np.sqrt(np.abs(S[..., 0, 1]) / np.abs(S[..., 1, 0]))
    scaled = S.copy()
    scaled[..., 0, 1], scaled[..., 1, 0] = S[..., 0, 1] / ratio, S[..., 1, 0] * ratio
    return np.linalg.norm(scaled, 2, (-2, -1))


def mu_peak(loops, per_decade=2000, exactly=False):
    """Coarse on all frequencies, fine near the largest; `exactly`: at the frequency found, too, of three rows."""
    value = balanced if loops.n == 2 else structured
    omega = grid(loops.times, per_decade if loops.n == 2 else 60, 1e-2, 1e2)
    if loops.n == 2:
        return peak(lambda s: value(loops.sensitivity(s)), omega, 60)
    coarse = value(loops.sensitivity(1j * omega))
    best = (0.0, 0.0)
    tops = np.flatnonzero((coarse[1:-1] >= coarse[:-2]) & (coarse[1:-1] >= coarse[2:])) + 1
    for k in tops[coarse[tops] > 0.9 * coarse.max()]:
        best = max(best, peak(lambda s: value(loops.sensitivity(s)), np.linspace(omega[k - 1], omega[k + 1], 60), 30, 2))
    if not exactly:
        return best
    near = best[1] * np.linspace(0.99, 1.01, 81)
    exact = structured_exactly(loops.sensitivity(1j * near))
    return float(exact.max()), float(near[exact.argmax()])


def ultimate(plant):
    """Gain and period at which proportional action oscillates: the phase, continuous from the closed form, is -pi."""
    def phase(omega):
        return sum(np.arctan(omega * lag) for lag in plant.lags) + omega * plant.L - np.pi

    omega = brentq(phase, 1e-9 / max(plant.times()), np.pi / plant.L)
    return np.sign(plant.K) / abs(plant(1j * omega)), 2 * np.pi / omega


def blt_within(plants, pairing, mu):
    """Luyben's settings with the factor F at which mu is the limit; None: at no factor."""
    points = [ultimate(plants[i][pairing[i] - 1]) for i in range(len(pairing))]

    def loops(F):
        return Loops(plants, pairing, [Pid.pi(Ku / (2.2 * F), Pu * F / 1.2) for Ku, Pu in points])

    def holds(F):
        one = loops(F)
        return one.unstable() == 0 and mu_peak(one, 200)[0] <= mu

    factors = np.geomspace(0.5, 200, 40)
    for k, F in enumerate(factors):
        if holds(F):
            low, high = np.log(factors[max(k - 1, 0)]), np.log(F)
            for _ in range(14):
                middle = (low + high) / 2
                low, high = (low, middle) if holds(np.exp(middle)) else (middle, high)
            return loops(np.exp(high))
    return None


def cost_of(loops, weights):
    return sum(weights[i] * loops.IAE(j, i) for i in range(loops.n) for j in range(loops.n))


def check_one(tally, request, answer, plants, compare):
    n = len(plants)
    weights = request.get("weights", {}).get("y", [1] * n)
    loops = Loops(plants, answer["pairing"], [Pid(c) for c in answer["controllers"]])
    tally.expect(answer["stable"], "answered as not stable", request)
    for size in range(1, n + 1):
        for of in itertools.combinations(range(n), size):
            tally.expect(loops.unstable(list(of)) == 0, f"loops {of} are not stable together", request)
    value, omega = mu_peak(loops, exactly=True)
    limit = request["limit"]["mu"]
    tally.expect(value <= limit * (1 + WITHIN), f"mu is {value} at {omega}, limit {limit}", request)
    tally.expect(abs(answer["mu"] / value - 1) < 1e-4, f"mu is {value}, answered {answer['mu']}", request)
    if not compare:
        return
    cost = cost_of(loops, weights)
    tally.note("cost error", abs(answer["cost"] / cost - 1))
    tally.expect(abs(answer["cost"] / cost - 1) < 1e-3, f"cost is {cost}, answered {answer['cost']}", request)
    for i, j in itertools.product(range(n), range(n)):
        told = answer["IAE_load"][j][i]
        if told * weights[i] > 0.02 * cost:
            found = loops.IAE(j, i)
            tally.expect(abs(told / found - 1) < 1e-3, f"IAE of y{i} after u{j} is {found}, answered {told}", request)
    scaled = blt_within(plants, answer["pairing"], limit)
    if scaled is None:
        tally.note("no BLT within the limit", 1)
        return
    ratio = cost / cost_of(scaled, weights)
    tally.note("cost over that of scaled BLT", ratio)
    tally.expect(ratio <= 1 + 1e-3, f"worse than scaled BLT: {ratio}", request)
    tally.better = getattr(tally, "better", 0) + (ratio <= 0.9)
    tally.compared = getattr(tally, "compared", 0) + 1


def check(client, seed, count, n):
    random = np.random.default_rng(seed)
    tally = Tally(f"interaction {n}x{n}", 2 if n == 2 else 10)
    for _ in range(count):
        request, plants = problem(random, n)
        tally.cases += 1
        status, answer, seconds = client.ask("interaction", request)
        tally.time(seconds, request)
        if status != 200:
            tally.refuse(answer)
            print("refused", request, answer, flush=True)
            continue
        check_one(tally, request, answer, plants, n == 2 or count < 30)
    if getattr(tally, "compared", 0):
        tally.note("share of costs at most 0.9 of scaled BLT", tally.better / tally.compared)
    return [tally]
