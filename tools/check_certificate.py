#!/usr/bin/env python3
"""Checks a certificate of Tunewright: that no stable controller of its root box keeps |S| <= Ms and |T| <= Mt with an IAE
below its goal. docs/proof.md has the mathematics and the format. Needs Python 3.9 and nothing else; shares no code with
the program that wrote the certificate.

    check_certificate.py FILE...      exit code 0: in each file every leaf holds and the leaves tile the root; 1: not

Every inequality holds with rounding. Sums, products, quotients and roots of doubles are rounded to the nearest by IEEE 754.
Intervals of real numbers go to the neighbouring double; complex numbers are discs whose radius takes up what is rounded;
sin, cos and exp come from integers of 200 bits."""
import json
import math
import multiprocessing
import os
import sys
from collections import Counter
from functools import lru_cache, reduce

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
        return I(down(min(p)), up(max(p))) if math.isfinite(sum(p)) else I(-INF, INF)

    def __truediv__(self, o):
        return I(-INF, INF) if o.a <= 0 <= o.b else self * I(down(1 / o.b), up(1 / o.a))

    def square(self):
        x, y = min(abs(self.a), abs(self.b)), max(abs(self.a), abs(self.b))
        return I(0.0 if self.a <= 0 <= self.b else max(0.0, down(x * x)), up(y * y))

    def root(self):
        if self.b < 0 or math.isinf(self.b):
            return I(-INF, INF)
        return I(max(0.0, down(math.sqrt(max(self.a, 0.0)))), up(math.sqrt(self.b)))

    def size(self): return self if self.a >= 0 else -self if self.b <= 0 else I(0, max(-self.a, self.b))

ZERO, ONE, HALF = I(0), I(1), I(0.5)

# ---- complex numbers
U = 2.0 ** -53  # largest relative error of a rounded sum, product, quotient or root of doubles
GROW = 1 + 2.0 ** -40  # more than what 8000 roundings take from a sum of products of numbers >= 0
TINY = 1e-150  # more than what underflow takes from such a sum, and from the root of one
HUGE = 1e100  # what is less exact than this is unknown; so a midpoint stays below HUGE/U, and its square is finite

def above(m): return math.sqrt(m.real * m.real + m.imag * m.imag) * GROW + TINY
def below(m): return math.sqrt(m.real * m.real + m.imag * m.imag) / GROW - TINY

class Z:
    """The complex numbers within r of m. With doubles, the error of x + y is at most U |x + y|, of x y at most
    8^(1/2) U |x| |y|, of conj(x)/|x|^2 at most 3U/|x|, to the first order in U (docs/proof.md): 2U, 3U and 4U cover them."""
    __slots__ = ("m", "r")

    def __init__(self, m, r=0.0):
        self.m, self.r = (m, r) if r < HUGE else (0j, INF)  # INF also if r is no number

    def __add__(self, o):
        m = self.m + o.m
        return Z(m, (self.r + o.r + 2 * U * above(m)) * GROW)

    def __sub__(self, o): return self + Z(-o.m, o.r)
    def __mul__(self, o):
        m, n = self.m, o.m
        x, y = above(m), above(n)
        return Z(m * n, (x * o.r + y * self.r + self.r * o.r + 3 * U * (x * y)) * GROW + TINY)

    def inverse(self):
        m, least = self.m, below(self.m)
        left, n = least - self.r, m.real * m.real + m.imag * m.imag
        if not (left > 0 and 1e-200 < n < 1e200):
            return Z(0j, INF)
        return Z(complex(m.real / n, -m.imag / n), (self.r / (least * left) + 4 * U / least) * GROW + TINY)

    def conjugate(self): return Z(self.m.conjugate(), self.r)
    def most(self): return (above(self.m) + self.r) * GROW
    def least(self): return below(self.m) - self.r * GROW
    def size(self): return I(max(0.0, down(self.least())), up(self.most()))
    def re(self): return I(down(self.m.real - self.r), up(self.m.real + self.r))
    def im(self): return I(down(self.m.imag - self.r), up(self.m.imag + self.r))

def ball(re, im=ZERO):
    """The rectangle of two intervals lies within."""
    m = complex(0.5 * re.a + 0.5 * re.b, 0.5 * im.a + 0.5 * im.b)
    return Z(m, ((I(m.real) - re).size() + (I(m.imag) - im).size()).b)

# ---- elementary functions, by fixed-point integers
BITS = 200

def fixed(x): return (x.as_integer_ratio()[0] << BITS) // x.as_integer_ratio()[1]

def interval_of(n, error):
    """The numbers within `error` of n, all times 2^-BITS. Python rounds the quotient of two integers to the nearest."""
    return I(down((n - error) / (1 << BITS)), up((n + error) / (1 << BITS)))

@lru_cache(maxsize=None)
def cos_sin_of(x):
    """Of a double: the series at x/2^k < 1/16, squared k times."""
    k = max(0, math.frexp(x)[1] + 4)
    if k > 60:
        raise Refused("a frequency is too large")
    z = fixed(x) >> k
    re, im, term_re, term_im = 1 << BITS, 0, 1 << BITS, 0
    for n in range(1, 60):  # 16^-n/n! falls below 2^-BITS
        term_re, term_im = (-term_im * z >> BITS) // n, (term_re * z >> BITS) // n
        if abs(term_re) <= 1 and abs(term_im) <= 1:
            break
        re, im = re + term_re, im + term_im
    for _ in range(k):
        re, im = (re * re - im * im) >> BITS, (2 * re * im) >> BITS
    error = 1 << (k + 20)  # each step adds a few units and doubles what was there
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
    z, sum_, term = fixed(x) >> k, 1 << BITS, 1 << BITS
    for n in range(1, 60):
        term = (term * z >> BITS) // n
        sum_ += term
    value = interval_of(sum_, 1 << 8)
    for _ in range(k):
        value = value.square()
    return value

def exp(x): return I(exp_of(x.a).a, exp_of(x.b).b)

PI = I(math.pi, up(math.pi))  # neighbours: 3.1415926535897931 and 3.1415926535897936, of 3.14159265358979323846...

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
        self.structure, self.num, self.den = head["structure"], numbers(head["plant"]["num"]), numbers(head["plant"]["den"])
        self.L, self.Tf = number(head["plant"]["L"]), number(head["Tf"])
        self.Ms, self.Mt, self.goal, self.w0 = (number(head[name]) for name in ("Ms", "Mt", "goal", "w0"))
        self.low, self.high = numbers(head["root"]["low"], 3), numbers(head["root"]["high"], 3)
        for holds, fault in (
                (head["certificate"] == 1, "this is not a certificate of version 1"),
                (self.structure in ("pi", "pid_fixed", "pid_tied"), "the structure is unknown"),
                (self.num[0] and self.den[0] and len(self.num) <= len(self.den), "the plant is not proper"),
                (self.num[-1], "the plant has a zero at s = 0"),
                (self.L >= 0 and self.Tf >= 0, "a time is negative"),
                (self.Ms > 1 and self.Mt > 1 and self.goal > 0 and self.w0 > 0, "a limit, the goal or w0 is out of range"),
                (self.low[1] > 0 and self.low[2] >= 0, "ki of the root is not above 0, or its third gain is negative"),
                ((ONE / I(self.low[1])).a >= self.goal, "1/ki at the root's low end is below the goal")):
            if not holds:
                raise Refused(fault)
        means = [self.coefficients(phi, head["harmonics"]) for phi in head["phis"]]
        self.phis, self.points = [[(ball(x), x.size().b) for x in mean] for mean in means], {}

    @staticmethod
    @lru_cache(maxsize=None)
    def jackson(K):
        weight = [cos_sin(PI * I(v + 1) / I(K + 1))[1] for v in range(K)]
        sums = [sum((weight[v] * weight[v + m] for v in range(K - m)), ZERO) for m in range(K)]
        return [ONE] + [x / sums[0] for x in sums[1:]]

    def coefficients(self, phi, K):
        """The Fourier coefficients of a function of values +-1, times those of Jackson's positive kernel."""
        changes = numbers(phi["changes"])
        if not (isinstance(K, int) and 1 <= K <= 4096 and phi["first"] in (1, -1) and all(0 < x < PI.a for x in changes)
                and all(x < y for x, y in zip(changes, changes[1:]))):
            raise Refused("a sign function is malformed, or its changes do not ascend within (0, pi)")
        ends, a = [ZERO] + [I(x) for x in changes] + [PI], []
        for m in range(K):
            total, sign = ZERO, phi["first"]
            at = ends if m == 0 else [sin_multiple(m, x) for x in ends]
            for x, y in zip(at, at[1:]):
                total, sign = total + (y - x) * I(sign), -sign
            a.append(total / PI if m == 0 else total * I(2) * self.jackson(K)[m] / (PI * I(m)))
        return a

    def at(self, re, im):
        """s, Q = s/P(s), and what the gains are multiplied by in s C if the filter is fixed."""
        key = (re.a, re.b, im.a, im.b)
        if key not in self.points:
            s = ball(re, im)
            num, den = (reduce(lambda z, a: z * s + Z(complex(a)), of, Z(0j)) for of in (self.num, self.den))
            Q = s * den * num.inverse() * ball(*cos_sin(im * I(self.L))) * ball(exp(re * I(self.L)))
            F = low_pass(s * Z(complex(self.Tf))).inverse()
            self.points[key] = s, Q, [s * F, F] + [s * s * F] * (self.structure == "pid_fixed")
        return self.points[key]

def sin_multiple(m, x): return ZERO if x is ZERO or x is PI else cos_sin(I(m) * x)[1]
def halved(z): return Z(0.5 * z.m, 0.5 * z.r)
def low_pass(y): return ONE_Z + y + halved(y * y)

ONE_Z, FIVE_Z, NINE_Z, TEN_Z = (Z(complex(x)) for x in (1, 5, 9, 10))

def top(coefficients, y):
    """An upper bound of |a0 + a1 y + ...|, of at most four terms: Horner's scheme at the midpoint rounds each step by less than
    8 U of the polynomial of sizes; over the ball it changes by the radius times the derivative of that polynomial."""
    value, sizes, slope, t = 0j, 0.0, 0.0, y.most()
    for a in reversed(coefficients):
        value, slope, sizes = value * y.m + a, slope * t + sizes, sizes * t + abs(a)
    return (above(value) + y.r * slope + 32 * U * sizes) * GROW + TINY

class Box:
    """A leaf's box: centre and half-widths; the third is 0 for a PI."""

    def __init__(self, problem, leaf):
        self.problem = problem
        self.low, self.high = numbers(leaf["low"], 3), numbers(leaf["high"], 3)
        centre = [(I(a) + I(b)) * HALF for a, b in zip(self.low, self.high)]
        half = [(I(b) - I(a)) * HALF for a, b in zip(self.low, self.high)]
        self.c, self.h = [ball(x) for x in centre], [ball(x) for x in half]
        self.most = [max(abs(a), abs(b)) for a, b in zip(self.low, self.high)]
        self.lags = [ball(x / I(N)) for x in (centre[2], half[2], (centre[2] - half[2]))]

    def terms(self, where):
        """D = centre + sum d_i g_i + rho with |d_i| <= 1 and |rho| <= rest."""
        s, Q, loads = where
        if self.problem.structure != "pid_tied":
            centre = sum((load * c for load, c in zip(loads, self.c)), Q)
            return centre, [load * h for load, h in zip(loads, self.h)], 0.0
        k, ki, _ = self.c
        k_top, ki_top, hk, hi = k.most(), ki.most(), self.h[0].most(), self.h[1].most()
        lag, half_lag, least_lag = self.lags
        y, stride = s * lag, s * half_lag
        step, y2, ten_y, b1_top = stride.most(), y * y, y * TEN_Z, ONE_Z + y
        b, a_top, a1_top, bend = (b1_top + halved(y2)).inverse(), ONE_Z + ten_y, NINE_Z - y - y2 * FIVE_Z, step * step
        b2, a = b * b, a_top * b
        least = max(0.0, low_pass(s * least_lag).least())  # of |p| over the box; if unknown, a division by zero follows
        over, over3 = 1 / (least * least), 1 / (least * least * least)
        A1 = step * over * (a1_top.most() + a_top.most() * step + 5 * bend)
        B1 = step * over * (b1_top.most() + step)
        A2 = 0.5 * bend * over3 * (top((-19, -27, 1.5, 5), y) + top((-27, 3, 15), y) * step + top((1.5, 15), y) * bend
                                   + 5 * bend * step)
        B2 = 0.5 * bend * over3 * (top((1, 3, 1.5), y) + top((3, 3), y) * step + 1.5 * bend)
        w, sk, b_ki = s.most(), s * k, b * ki
        centre = Q + sk * a + b_ki
        g = [s * a * self.h[0], b * self.h[1], (sk * a1_top - b1_top * ki) * b2 * stride]
        rest = (w * (hk * A1 + k_top * A2) + hi * B1 + ki_top * B2) * GROW + TINY
        rough = (w * self.most[0] * A1 + self.most[1] * B1) * GROW + TINY
        return (centre, g[:2], rough) if rough < rest + g[2].most() else (centre, g, rest)

def farthest(parts, rest):
    """An upper bound of |parts[0] +- parts[1] +- ... + rho|: a convex function is largest at a corner. The sum of at most four
    sizes is at most twice the root of their squares' sum, which is a mean over the corners, so GROW covers the rounding."""
    sums = [parts[0].m]
    for part in parts[1:]:
        sums = [z + part.m for z in sums] + [z - part.m for z in sums]
    return (max(map(above, sums)) + sum([part.r for part in parts], rest)) * GROW

def disc(problem, Q, of_T):
    """A limit demands |D + shift| >= radius."""
    excess = I(problem.Mt).square() - ONE
    return (Q * ball(ONE / excess), Q.size() * (I(problem.Mt) / excess)) if of_T else (Z(0j), Q.size() / I(problem.Ms))

# ---- the reasons
def exceeds_limit(problem, box, leaf):
    omega = number(leaf["omega"])
    where = problem.at(ZERO, I(omega))
    centre, g, rest = box.terms(where)
    shift, radius = disc(problem, where[1], leaf["reason"] == "complementary")
    return omega > 0 and farthest([centre + shift, *g], rest) < radius.a

def error_is_large(problem, box, leaf):
    re, im = numbers(leaf["s"], 2)
    centre, g, rest = box.terms(problem.at(I(re), I(im)))
    return re >= 0 and (ONE / I(farthest([centre, *g], rest))).a >= problem.goal

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
        z, rest = centre + shift, I(rest)
        far = z.size()
        turned = [z.conjugate() * ball(ONE / far) * x for x in g]
        along = [x.re() for x in turned]
        reach, aside = sum((x.size() for x in along), rest), sum((x.im().size() for x in turned), rest)
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
    bound, slope, loss = Z(0j), [Z(0j)] * 3, 0.0
    for m, (a, size) in enumerate(problem.phis[leaf["phi"]]):
        centre, g, rest = box.terms(problem.at(ZERO, I(m) * I(problem.w0)))
        far, radius = centre.least(), farthest(g, rest)
        if not far > radius:
            return False
        inverse = centre.inverse()
        part = inverse * a
        bound, loss = bound + part, loss + size * (radius * radius / (far - radius) + rest) / (far * far)
        part = part * inverse
        slope = [x - part * y for x, y in zip(slope, g)] + slope[len(g):]
    row, least = sum_of_cuts(problem, box, leaf["cuts"])
    bound = bound.re() - I(loss * GROW + TINY) + least
    return (bound - sum(((x.re() - y).size() for x, y in zip(slope, row)), ZERO)).a >= problem.goal

def taylor_radius(descending, s, half):
    """How far a polynomial gets from its value at s within `half` of it, and that value."""
    a = [Z(complex(x)) for x in descending]
    for done in range(len(a) - 1):
        for i in range(1, len(a) - done):
            a[i] = a[i] + a[i - 1] * s
    radius, power = 0.0, 1.0
    for x in reversed(a[:-1]):
        power *= half
        radius += x.most() * power
    return radius * GROW + TINY, a[-1]

@lru_cache(maxsize=None)
def stretch(problem, first, last):
    """Of an interval of the axis, for every box: its middle, half its length, and how far Q gets from the middle."""
    w = I(0.5 * (first + last))
    half, where = max((I(last) - w).b, (w - I(first)).b), problem.at(ZERO, w)
    u_radius, u = taylor_radius(problem.den + [0.0], where[0], half)
    n_radius, n = taylor_radius(problem.num, where[0], half)
    left = n.least() - n_radius
    radius = (u_radius + u.most() * half * problem.L + where[1].most() * n_radius) / left * GROW if left > 0 else INF
    return where, half, radius

def over(v): return 1 / (1 + 0.25 * v * v * v * v)  # the largest 1/|p(jv)|^2 from v on

def controller_slope(problem, box, first, last):
    """A bound of |d(sC)/ds| over the box, from j first to j last."""
    k, ki, third = box.most
    if problem.structure == "pid_tied":
        inverse, v = over(first * box.low[2] / N), last * third / N
        a = math.sqrt((1 + N * N * v * v) * inverse)
        a1 = math.sqrt((9 + 5 * v * v) * (9 + 5 * v * v) + v * v) * inverse
        return (k * a + (k * last * a1 + ki * math.sqrt(1 + v * v) * inverse) * third / N) * GROW + TINY
    inverse, v = over(first * problem.Tf), last * problem.Tf
    slope_of_F = problem.Tf * math.sqrt(1 + v * v) * inverse
    return (slope_of_F * (k * last + ki + third * last * last) + math.sqrt(inverse) * (k + 2 * third * last)) * GROW + TINY

def least_between(problem, box, first, last):
    """A lower bound of |D| over the box from j first to j last: of its part in the direction of the centre."""
    where, half, radius = stretch(problem, first, last)
    centre, g, rest = box.terms(where)
    far = centre.least()
    turned = [centre.conjugate() * x for x in g]
    reach = sum(abs(x.m.real) + x.r for x in turned) / far if far > 0 else INF
    return far - (reach + rest + radius + controller_slope(problem, box, first, last) * half) * GROW

@lru_cache(maxsize=None)
def plant_beyond(problem, w):
    """A lower bound of |Q| for |s| >= w, Re s >= 0."""
    (top, *num), (bottom, *den), power, w = *([I(abs(x)) for x in of] for of in (problem.num, problem.den)), ONE, I(w)
    for i, a in enumerate(den):
        power = power / w
        bottom = bottom - a * power
        top = top + num[i] * power if i < len(num) else top
    plant = bottom / top * w
    for _ in range(len(den) - len(num)):
        plant = plant * w
    return plant.a

def least_beyond(problem, box, w):
    """A lower bound of |D| over the box for |s| >= w, Re s >= 0; 0 if the plant does not dominate there."""
    biproper, (k, ki, third) = len(problem.den) == len(problem.num), box.most
    law = k * w + ki
    if problem.structure == "pid_tied":  # |w Td F| <= sqrt(2) N
        law += k * w * (14.143 if biproper else min(14.143, w * third))
    elif problem.structure == "pid_fixed":
        filtered = 2 / (problem.Tf * problem.Tf) if problem.Tf > 0 else INF
        law += third * (filtered if biproper else min(filtered, w * w))
    plant = plant_beyond(problem, w)
    return 0.5 * plant if 2 * law * GROW + TINY <= plant else 0.0

def all_unstable(problem, box, leaf):
    """|D| stays above |D(s0)| of the centre on the axis and far out, for the whole box: see docs/proof.md. The intervals of the
    axis are steps of a grid, the same for all boxes."""
    re, im = numbers(leaf["s"], 2)
    needed = box.terms(problem.at(I(re), I(im)))[0].most()
    place, step, w = 0, 64, 1e-2 * problem.w0
    if not (re > 0 and least_between(problem, box, 0.0, w) > needed):
        return False
    while place < 100000 and not least_beyond(problem, box, w) > needed:
        end = 1e-2 * problem.w0 * 1.02 ** ((place + step) / 64)
        if least_between(problem, box, w, end) > needed:
            w, place = end, place + step
            step = 2 * step if step < 64 and place % (2 * step) == 0 else step
        elif step == 1:
            return False
        else:
            step //= 2
    return place < 100000

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
    head, *leaves = [json.loads(line, parse_constant=number) for line in lines if line.strip()]
    problem = Problem(head)
    if len(leaves) != head["leaves"]:
        raise Refused(f"the certificate announces {head['leaves']} leaves and has {len(leaves)}")
    boxes = [Box(problem, leaf) for leaf in leaves]
    if not tile(problem, boxes):
        raise Refused("the leaves do not tile the root")
    for i, (leaf, box) in enumerate(zip(leaves, boxes), 1):
        try:
            if not (leaf["reason"] in REASONS and REASONS[leaf["reason"]](problem, box, leaf)):
                raise Refused("does not hold")
        except Refused as refused:
            raise Refused(f"leaf {i} ({leaf['reason']}): {refused}") from refused
    return problem, Counter(leaf["reason"] for leaf in leaves)

def verdict(path):
    """Whether the file holds, and the sentences to print."""
    try:
        with open(path, encoding="utf-8") as file:
            problem, reasons = check(file.read().splitlines())
    except (Refused, KeyError, TypeError, ValueError, IndexError, AttributeError, ArithmeticError, OSError) as fault:
        return False, f"{path}: refused: {fault}"
    counts = ", ".join(f"{n} {reason}" for reason, n in reasons.items())
    return True, (f"{path}: {sum(reasons.values())} leaves hold and tile the root: {counts}.\n"
                  f"No stable {problem.structure} controller of the root box within Ms = {problem.Ms:g}, Mt = {problem.Mt:g} "
                  f"has an IAE below {problem.goal!r}.")

def main():
    paths = sys.argv[1:]
    if not paths:
        print(__doc__, file=sys.stderr)
        return 2
    accepted = 0
    with multiprocessing.Pool(min(len(paths), os.cpu_count()), maxtasksperchild=1) as pool:
        for holds, sentences in pool.imap(verdict, paths):
            accepted += holds
            print(sentences, flush=True)
    print(f"{accepted} of {len(paths)} certificates hold.")
    return 0 if accepted == len(paths) else 1

if __name__ == "__main__":
    sys.exit(main())
