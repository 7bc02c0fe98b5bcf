#!/usr/bin/env python3
"""Checks a certificate of Tunewright: that no stable controller of its root box keeps |S| <= Ms and |T| <= Mt with an IAE
below its goal. docs/proof.md has the mathematics and the format. Needs Python 3.9 and nothing else; shares no code with
the program that wrote the certificate.

    check_certificate.py FILE      exit code 0: every leaf holds and the leaves tile the root; 1: not

All inequalities are checked in interval arithmetic. Sums, products, quotients and roots of doubles are rounded to the
nearest by IEEE 754, so that the neighbouring double lies beyond the exact value; sin, cos, exp and pi come from integers
of 200 bits."""
import json
import math
import sys
from collections import Counter
from functools import lru_cache

INF = math.inf
N = 10  # Td/Tf of the tied filter

class Refused(Exception):
    """The certificate proves nothing, with the reason."""

# ---- intervals
def down(x): return math.nextafter(x, -INF)
def up(x): return math.nextafter(x, INF)

class I:
    """The real numbers from a to b."""
    __slots__ = ("a", "b")

    def __init__(self, a, b=None):
        self.a = float(a)
        self.b = self.a if b is None else float(b)
        if not self.a <= self.b:  # also if one of them is no number
            self.a, self.b = -INF, INF

    def __add__(self, o): return I(down(self.a + o.a), up(self.b + o.b))
    def __sub__(self, o): return I(down(self.a - o.b), up(self.b - o.a))
    def __neg__(self): return I(-self.b, -self.a)
    def __mul__(self, o):
        p = (self.a * o.a, self.a * o.b, self.b * o.a, self.b * o.b)
        if not math.isfinite(sum(p)):
            return I(-INF, INF)
        return I(down(min(p)), up(max(p)))

    def __truediv__(self, o):
        if o.a <= 0 <= o.b:
            return I(-INF, INF)
        return self * I(down(1 / o.b), up(1 / o.a))

    def square(self):
        x, y = min(abs(self.a), abs(self.b)), max(abs(self.a), abs(self.b))
        return I(0.0 if self.a <= 0 <= self.b else max(0.0, down(x * x)), up(y * y))

    def root(self):
        if self.b < 0 or math.isinf(self.b):
            return I(-INF, INF)
        return I(max(0.0, down(math.sqrt(max(self.a, 0.0)))), up(math.sqrt(self.b)))

    def size(self): return self if self.a >= 0 else -self if self.b <= 0 else I(0, max(-self.a, self.b))

ZERO, ONE, HALF = I(0), I(1), I(0.5)

class Z:
    """A rectangle of complex numbers."""
    __slots__ = ("re", "im")

    def __init__(self, re, im=ZERO):
        self.re, self.im = re, im

    def __add__(self, o): return Z(self.re + o.re, self.im + o.im)
    def __sub__(self, o): return Z(self.re - o.re, self.im - o.im)
    def __mul__(self, o):
        if isinstance(o, I):
            return Z(self.re * o, self.im * o)
        return Z(self.re * o.re - self.im * o.im, self.re * o.im + self.im * o.re)

    def norm(self): return self.re.square() + self.im.square()
    def size(self): return self.norm().root()
    def inverse(self):
        n = self.norm()
        return Z(self.re / n, -self.im / n)

# ---- elementary functions, by fixed-point integers
BITS = 200

def fixed(x):
    """x times 2^BITS, rounded down."""
    n, d = x.as_integer_ratio()
    return (n << BITS) // d

def interval_of(n, error):
    """The numbers within `error` of n, all times 2^-BITS."""
    def nearest(k):
        shift = max(0, abs(k).bit_length() - 60)  # an integer of 60 bits; what is cut off is below half a double's unit
        return math.ldexp(float(k >> shift), shift - BITS)
    return I(down(down(nearest(n - error))), up(up(nearest(n + error))))

def turned(x):
    """e^(jx), as two integers with their error: the series at x/2^k < 1/16, squared k times."""
    k = max(0, math.frexp(x)[1] + 4)
    if k > 60:
        raise Refused("a frequency is too large")
    z = fixed(x) >> k
    re, im, term_re, term_im, n = 1 << BITS, 0, 1 << BITS, 0, 0
    while term_re or term_im:
        n += 1
        term_re, term_im = (-term_im * z >> BITS) // n, (term_re * z >> BITS) // n
        if n > 200 or (abs(term_re) <= 1 and abs(term_im) <= 1):
            break
        re, im = re + term_re, im + term_im
    for _ in range(k):
        re, im = (re * re - im * im) >> BITS, (2 * re * im) >> BITS
    return re, im, 1 << (k + 20)  # each step adds a few units and doubles what was there

@lru_cache(maxsize=None)
def cos_sin_of(x):
    re, im, error = turned(x)
    return interval_of(re, error), interval_of(im, error)

def cos_sin(x):
    """Both, of an interval: those of its middle, which change by no more than the argument."""
    middle = 0.5 * (x.a + x.b)
    c, s = cos_sin_of(middle)
    around = I(-1, 1) * I(max((x - I(middle)).b, (I(middle) - x).b))
    return c + around, s + around

@lru_cache(maxsize=None)
def exp_of(x):
    k = max(0, math.frexp(x)[1] + 4)
    if k > 14:
        return I(0, INF)
    z, sum_, term, n = fixed(x) >> k, 1 << BITS, 1 << BITS, 0
    while abs(term) > 1 and n < 200:
        n += 1
        term = (term * z >> BITS) // n
        sum_ += term
    value = interval_of(sum_, 1 << 8)
    for _ in range(k):
        value = value.square()
    return value

def exp(x):
    return I(exp_of(x.a).a, exp_of(x.b).b)

def pi():
    """Machin: pi = 16 atan(1/5) - 4 atan(1/239)."""
    def atan_inverse(m):
        total, power, n = 0, (1 << BITS) // m, 0
        while power:
            total += (-1) ** n * (power // (2 * n + 1))
            power, n = power // (m * m), n + 1
        return total
    return interval_of(16 * atan_inverse(5) - 4 * atan_inverse(239), 1 << 20)

PI = pi()

# ---- the loop
def number(x):
    if isinstance(x, bool) or not isinstance(x, (int, float)) or not math.isfinite(x):
        raise Refused(f"{x!r} is not a finite number")
    return float(x)

def numbers(values, count=None):
    if not isinstance(values, list) or count not in (None, len(values)):
        raise Refused("a list has the wrong length")
    return [number(x) for x in values]

class Problem:
    """The first line of a certificate."""

    def __init__(self, head):
        if head.get("certificate") != 1:
            raise Refused("this is not a certificate of version 1")
        self.num, self.den = numbers(head["plant"]["num"]), numbers(head["plant"]["den"])
        self.L, self.Tf = number(head["plant"]["L"]), number(head["Tf"])
        self.structure = head["structure"]
        if self.structure not in ("pi", "pid_fixed", "pid_tied"):
            raise Refused("the structure is unknown")
        if not self.num or not self.den or not self.num[0] or not self.den[0] or len(self.num) > len(self.den):
            raise Refused("the plant is not proper")
        if not self.num[-1]:
            raise Refused("the plant has a zero at s = 0")
        if self.L < 0 or self.Tf < 0:
            raise Refused("a time is negative")
        self.Ms, self.Mt, self.goal, self.w0 = (number(head[name]) for name in ("Ms", "Mt", "goal", "w0"))
        if self.Ms <= 1 or self.Mt <= 1 or self.goal <= 0 or self.w0 <= 0:
            raise Refused("a limit, the goal or w0 is out of range")
        self.low, self.high = numbers(head["root"]["low"], 3), numbers(head["root"]["high"], 3)
        if self.low[1] <= 0 or self.low[2] < 0:
            raise Refused("ki of the root is not above 0, or its third gain is negative")
        if not (ONE / I(self.low[1])).a >= self.goal:
            raise Refused("1/ki at the root's low end is below the goal")
        self.phis = [self.coefficients(phi, head["harmonics"]) for phi in head["phis"]]
        self.points = {}

    @staticmethod
    @lru_cache(maxsize=None)
    def jackson(K):
        weight = [cos_sin(PI * I(v + 1) / I(K + 1))[1] for v in range(K)]
        sums = []
        for m in range(K):
            total = ZERO
            for v in range(K - m):
                total = total + weight[v] * weight[v + m]
            sums.append(total)
        return [ONE] + [x / sums[0] for x in sums[1:]]

    def coefficients(self, phi, K):
        """The Fourier coefficients of a function of values +-1, times those of Jackson's positive kernel."""
        if not isinstance(K, int) or not 1 <= K <= 4096 or phi["first"] not in (1, -1):
            raise Refused("a sign function is malformed")
        changes = numbers(phi["changes"])
        if any(not 0 < x < PI.a for x in changes) or any(x >= y for x, y in zip(changes, changes[1:])):
            raise Refused("the changes of a sign function do not ascend within (0, pi)")
        ends, a = [ZERO] + [I(x) for x in changes] + [PI], []
        for m in range(K):
            total, sign = ZERO, phi["first"]
            for x, y in zip(ends, ends[1:]):
                part = y - x if m == 0 else sin_multiple(m, y) - sin_multiple(m, x)
                total, sign = total + part * I(sign), -sign
            a.append(total / PI if m == 0 else total * I(2) * self.jackson(K)[m] / (PI * I(m)))
        return a

    def at(self, re, im):
        """s, Q = s/P(s) and the fixed filter there."""
        key = (re.a, re.b, im.a, im.b)
        if key not in self.points:
            s = Z(re, im)
            num, den = Z(ZERO), Z(ZERO)
            for b in self.num:
                num = num * s + Z(I(b))
            for a in self.den:
                den = den * s + Z(I(a))
            c, w = cos_sin(im * I(self.L))
            grown = exp(re * I(self.L))
            self.points[key] = s, s * den * num.inverse() * Z(grown * c, grown * w), low_pass(s * I(self.Tf)).inverse()
        return self.points[key]

def sin_multiple(m, x): return ZERO if x is ZERO or x is PI else cos_sin(I(m) * x)[1]
def low_pass(y): return Z(ONE) + y + y * y * HALF

class Box:
    """A leaf's box: centre and half-widths, both as intervals; the third is 0 for a PI."""

    def __init__(self, problem, leaf, point=False):
        self.problem = problem
        self.low, self.high = numbers(leaf["low"], 3), numbers(leaf["high"], 3)
        self.c = [(I(a) + I(b)) * HALF for a, b in zip(self.low, self.high)]
        self.h = [ZERO if point else (I(b) - I(a)) * HALF for a, b in zip(self.low, self.high)]
        self.most = [c.size() + h for c, h in zip(self.c, self.h)]

    def terms(self, where):
        """D = centre + sum d_i g_i + rho with |d_i| <= 1 and |rho| <= rest."""
        s, Q, F = where
        k, ki, third = self.c
        hk, hi, ht = self.h
        if self.problem.structure != "pid_tied":
            centre, g = Q + s * F * k + F * ki, [s * F * hk, F * hi]
            if self.problem.structure == "pid_fixed":
                centre, g = centre + s * s * F * third, g + [s * s * F * ht]
            return centre, g, ZERO
        y = s * (third / I(N))
        step, bend = s.size() * ht / I(N), (s.size() * ht / I(N)).square()
        b = low_pass(y).inverse()
        a = (Z(ONE) + y * I(N)) * b
        a1_top, b1_top = Z(I(9)) - y - y * y * I(5), Z(ONE) + y
        a1, b1 = a1_top * b * b, Z(ZERO) - b1_top * b * b
        over = ONE / low_pass(s * ((third - ht) / I(N))).norm()  # the largest 1/|p|^2 over the box
        over3 = over * over.root()
        A1 = step * over * (a1_top.size() + (Z(ONE) + y * I(10)).size() * step + I(5) * bend)
        B1 = step * over * (b1_top.size() + step)
        A2 = bend * HALF * over3 * ((Z(I(-19)) - y * I(27) + y * y * I(1.5) + y * y * y * I(5)).size()
                                    + (Z(I(-27)) + y * I(3) + y * y * I(15)).size() * step
                                    + (Z(I(1.5)) + y * I(15)).size() * bend + I(5) * bend * step)
        B2 = bend * HALF * over3 * ((Z(ONE) + y * I(3) + y * y * I(1.5)).size()
                                    + (Z(I(3)) + y * I(3)).size() * step + I(1.5) * bend)
        centre, w = Q + s * a * k + b * ki, s.size()
        g = [s * a * hk, b * hi, (s * a1 * k + b1 * ki) * (s * (ht / I(N)))]
        rest = w * (hk * A1 + k.size() * A2) + hi * B1 + ki.size() * B2
        rough = w * self.most[0] * A1 + self.most[1] * B1
        if rough.b < (rest + g[2].size()).b:
            return centre, g[:2], rough
        return centre, g, rest

def corners(g):
    sums = [Z(ZERO)]
    for x in g:
        sums = [z + x for z in sums] + [z - x for z in sums]
    return sums

def most(z, g, rest):
    """An upper bound of |z + sum d_i g_i + rho|: a convex function is largest at a corner."""
    return (I(max((z + x).norm().b for x in corners(g))).root() + rest).b

def disc(problem, Q, of_T):
    """A limit demands |D + shift| >= radius."""
    if not of_T:
        return Z(ZERO), Q.size() / I(problem.Ms)
    excess = I(problem.Mt).square() - ONE
    return Q * (ONE / excess), Q.size() * (I(problem.Mt) / excess)

# ---- the reasons
def exceeds_limit(problem, box, leaf):
    omega = number(leaf["omega"])
    if omega <= 0:
        return False
    where = problem.at(ZERO, I(omega))
    centre, g, rest = box.terms(where)
    shift, radius = disc(problem, where[1], leaf["reason"] == "complementary")
    return most(centre + shift, g, rest) < radius.a

def error_is_large(problem, box, leaf):
    re, im = numbers(leaf["s"], 2)
    return re >= 0 and (ONE / I(most(*box.terms(problem.at(I(re), I(im)))))).a >= problem.goal

def sum_of_cuts(problem, box, cuts):
    """The weighted half-planes: row d >= least for every controller of the box within the limits."""
    row, least = [ZERO] * 3, ZERO
    for cut in cuts:
        omega, weight = number(cut["omega"]), number(cut["multiplier"])
        if omega <= 0 or weight < 0 or cut["of"] not in ("S", "T"):
            raise Refused("a cut is malformed")
        where = problem.at(ZERO, I(omega))
        centre, g, rest = box.terms(where)
        shift, radius = disc(problem, where[1], cut["of"] == "T")
        z = centre + shift
        far = z.size()
        n = z * (ONE / far)
        along = [n.re * x.re + n.im * x.im for x in g]
        across = [n.re * x.im - n.im * x.re for x in g]
        reach = sum((x.size() for x in along), rest)
        aside = sum((x.size() for x in across), rest)
        if not far.a > reach.b or not radius.a > aside.b:
            raise Refused("a half-plane does not exist")
        row = [x + y * I(weight) for x, y in zip(row, along + [ZERO])]
        least = least + ((radius.square() - aside.square()).root() - far - rest) * I(weight)
    return row, least

def nothing_is_left(problem, box, leaf):
    row, least = sum_of_cuts(problem, box, leaf["cuts"])
    return (least - sum((x.size() for x in row), ZERO)).a > 0

def mean_is_large(problem, box, leaf):
    if not isinstance(leaf["phi"], int) or not 0 <= leaf["phi"] < len(problem.phis):
        return False
    bound, slope = ZERO, [ZERO] * 3
    for m, a in enumerate(problem.phis[leaf["phi"]]):
        centre, g, rest = box.terms(problem.at(ZERO, I(m) * I(problem.w0)))
        radius = I(max(z.norm().b for z in corners(g))).root() + rest
        squared, far = centre.norm(), centre.size()
        if not (far - radius).a > 0:
            return False
        inverse = centre.inverse()
        bound = bound + a * inverse.re - a.size() * ((radius.square() / (far - radius) + rest) / squared)
        slope = [x - a * (inverse * inverse * y).re for x, y in zip(slope, g + [Z(ZERO)])]
    row, least = sum_of_cuts(problem, box, leaf["cuts"])
    return (bound + least - sum(((x - y).size() for x, y in zip(slope, row)), ZERO)).a >= problem.goal

def taylor_radius(descending, s, half):
    """How far a polynomial gets from its value at s within `half` of it, and that value."""
    a = [Z(I(x)) for x in descending]
    for done in range(len(a) - 1):
        for i in range(1, len(a) - done):
            a[i] = a[i] + a[i - 1] * s
    radius, power = ZERO, ONE
    for x in reversed(a[:-1]):
        power = power * half
        radius = radius + x.size() * power
    return radius, a[-1]

def controller_slope(problem, box, first, last):
    """A bound of |d(sC)/ds| over the box, from j first to j last."""
    k, ki, third = box.most

    def over(v):  # the largest 1/|p(jv)|^2 from v on
        return ONE / (ONE + v.square().square() * I(0.25))
    if problem.structure == "pid_tied":
        least = first * (box.c[2] - box.h[2]) / I(N)
        inverse, v = over(I(max(0.0, least.a))), last * third / I(N)
        a = ((ONE + (v * I(N)).square()) * inverse).root()
        a1 = ((I(9) + I(5) * v.square()).square() + v.square()).root() * inverse
        return k * a + (k * last * a1 + ki * (ONE + v.square()).root() * inverse) * third / I(N)
    inverse, v = over(first * I(problem.Tf)), last * I(problem.Tf)
    slope_of_F = I(problem.Tf) * (ONE + v.square()).root() * inverse
    return slope_of_F * (k * last + ki + third * last.square()) + inverse.root() * (k + third * last * I(2))

def least_between(problem, box, first, last):
    """A lower bound of |D| over the box from j first to j last."""
    w = I(0.5 * (first + last))
    half = I(max((I(last) - w).b, (w - I(first)).b))
    s, Q, F = problem.at(ZERO, w)
    u_radius, u = taylor_radius(problem.den + [0.0], s, half)
    n_radius, n = taylor_radius(problem.num, s, half)
    left = n.size() - n_radius
    if not left.a > 0:
        return -INF
    radius = (u_radius + u.size() * half * I(problem.L) + Q.size() * n_radius) / left
    centre, g, rest = box.terms((s, Q, F))
    far = centre.size()
    n = centre * (ONE / far)
    reach = sum(((n.re * x.re + n.im * x.im).size() for x in g), rest + radius)
    return (far - reach - controller_slope(problem, box, I(first), I(last)) * half).a

def least_beyond(problem, box, w):
    """A lower bound of |D| over the box for |s| >= w, Re s >= 0; 0 if the plant does not dominate there."""
    excess, w = len(problem.den) - len(problem.num), I(w)
    top, bottom, power = I(abs(problem.num[0])), I(abs(problem.den[0])), ONE
    for i in range(1, len(problem.den)):
        power = power / w
        bottom = bottom - I(abs(problem.den[i])) * power
        if i < len(problem.num):
            top = top + I(abs(problem.num[i])) * power
    plant = bottom / top * w
    for _ in range(excess):
        plant = plant * w
    k, ki, third = box.most
    law = k * w + ki
    if problem.structure == "pid_tied":  # |w Td F| <= sqrt(2) N
        law = law + k * w * I(14.143 if excess == 0 else min(14.143, (w * third).b))
    elif problem.structure == "pid_fixed":
        filtered = (I(2) / I(problem.Tf).square()).b if problem.Tf > 0 else INF
        law = law + third * I(filtered if excess == 0 else min(filtered, w.square().b))
    return 0.5 * plant.a if plant.a > 0 and (law + law).b <= plant.a else 0.0

def all_unstable(problem, box, leaf):
    """|D| stays above |D(s0)| of the centre on the axis and far out, for the whole box: see docs/proof.md."""
    re, im = numbers(leaf["s"], 2)
    if re <= 0:
        return False
    centre, _, rest = Box(problem, leaf, point=True).terms(problem.at(I(re), I(im)))
    needed = (centre.size() + rest).b
    w, ratio = 0.0, 1.02
    for _ in range(20000):
        if w > 0 and least_beyond(problem, box, w) > needed:
            return True
        end = w * ratio if w > 0 else 1e-2 * problem.w0
        if least_between(problem, box, w, end) > needed:
            w, ratio = end, min(1.02, 1 + (ratio - 1) * 1.5)
        elif w == 0 or ratio < 1.0005:
            return False
        else:
            ratio = 1 + (ratio - 1) / 2
    return False

REASONS = {"sensitivity": exceeds_limit, "complementary": exceeds_limit, "error": error_is_large, "bound": mean_is_large,
           "empty": nothing_is_left, "unstable": all_unstable}

# ---- the tiling
def tile(problem, boxes):
    """Joins each box with those before it that share a whole face with it; in the order of the file one box is left."""
    stack = []
    for box in boxes:
        if any(not a < b for a, b in zip(box.low[:2], box.high[:2])) or not box.low[2] <= box.high[2]:
            raise Refused("a box has no width")
        stack.append((box.low, box.high))
        while len(stack) > 1:
            (low, high), (next_low, next_high) = stack[-2:]
            differ = [i for i in range(3) if low[i] != next_low[i] or high[i] != next_high[i]]
            if len(differ) != 1 or high[differ[0]] != next_low[differ[0]]:
                break
            stack[-2:] = [(low, next_high)]
    return stack == [(problem.low, problem.high)]

def check(lines):
    """Counts of leaves by reason; raises Refused."""
    head = json.loads(lines[0])
    problem = Problem(head)
    leaves = [json.loads(line) for line in lines[1:] if line.strip()]
    if len(leaves) != head["leaves"]:
        raise Refused(f"the certificate announces {head['leaves']} leaves and has {len(leaves)}")
    boxes = [Box(problem, leaf) for leaf in leaves]
    if not tile(problem, boxes):
        raise Refused("the leaves do not tile the root")
    for i, (leaf, box) in enumerate(zip(leaves, boxes), 1):
        try:
            holds = leaf["reason"] in REASONS and REASONS[leaf["reason"]](problem, box, leaf)
        except Refused as refused:
            raise Refused(f"leaf {i} ({leaf['reason']}): {refused}") from refused
        if not holds:
            raise Refused(f"leaf {i} ({leaf['reason']}) does not hold")
    return problem, Counter(leaf["reason"] for leaf in leaves)

def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        with open(sys.argv[1], encoding="utf-8") as file:
            problem, reasons = check(file.read().splitlines())
    except (Refused, KeyError, TypeError, ValueError, IndexError, ArithmeticError) as fault:
        print(f"refused: {fault}")
        return 1
    print(f"{sum(reasons.values())} leaves hold and tile the root: " + ", ".join(f"{n} {r}" for r, n in reasons.items()))
    print(f"No stable {problem.structure} controller of the root box within Ms = {problem.Ms:g}, Mt = {problem.Mt:g} has an "
          f"IAE below {problem.goal!r}.")
    return 0

if __name__ == "__main__":
    sys.exit(main())
