"""The part of python-control that the client uses, with the same names and attributes, for machines without it: Debian
has no package of it. Polynomials have descending powers of s; a state space is evaluated, not converted."""

import math


def product(a, b):
    out = [0.0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def plus(a, b):
    size = max(len(a), len(b))
    a, b = [0.0] * (size - len(a)) + list(a), [0.0] * (size - len(b)) + list(b)
    return [x + y for x, y in zip(a, b)]


def value(polynomial, s):
    out = 0
    for coefficient in polynomial:
        out = out * s + coefficient
    return out


class TransferFunction:
    def __init__(self, num, den, dt=0):
        self.num, self.den, self.dt = [[list(num)]], [[list(den)]], dt

    def __call__(self, s):
        return value(self.num[0][0], s) / value(self.den[0][0], s)

    def _of(self, other):
        return other if isinstance(other, (TransferFunction, StateSpace)) else TransferFunction([other], [1])

    def __mul__(self, other):
        other = self._of(other)
        if isinstance(other, StateSpace):
            return other * self
        return TransferFunction(product(self.num[0][0], other.num[0][0]), product(self.den[0][0], other.den[0][0]))

    def __rmul__(self, other):
        return self._of(other) * self

    def __rtruediv__(self, other):
        return self._of(other) * TransferFunction(self.den[0][0], self.num[0][0])

    def __add__(self, other):
        other = self._of(other)
        a, b, c, d = self.num[0][0], self.den[0][0], other.num[0][0], other.den[0][0]
        return TransferFunction(plus(product(a, d), product(c, b)), product(b, d))


class StateSpace:
    """y = C (s - A)^-1 B + D by Cramer's rule, times a transfer function."""

    def __init__(self, A, B, C, D, dt=0, times=None):
        self.A, self.B, self.C, self.D, self.dt, self.times = A, B, C, D, dt, times

    def __call__(self, s):
        n = len(self.A)
        rows = [[(s if i == j else 0) - self.A[i][j] for j in range(n)] + [self.B[i][0]] for i in range(n)]
        for i in range(n):
            pivot = max(range(i, n), key=lambda row: abs(rows[row][i]))
            rows[i], rows[pivot] = rows[pivot], rows[i]
            for k in range(n):
                if k != i:
                    factor = rows[k][i] / rows[i][i]
                    rows[k] = [x - factor * y for x, y in zip(rows[k], rows[i])]
        out = self.D[0][0] + sum(self.C[0][i] * rows[i][n] / rows[i][i] for i in range(n))
        return out * (self.times(s) if self.times else 1)

    def __mul__(self, other):
        return StateSpace(self.A, self.B, self.C, self.D, self.dt, other)


def tf(num, den):
    return TransferFunction(num, den)


def ss(A, B, C, D):
    return StateSpace(A, B, C, D)


def zpk(zeros, poles, gain):
    num, den = [complex(gain)], [1 + 0j]
    for zero in zeros:
        num = product(num, [1, -zero])
    for pole in poles:
        den = product(den, [1, -pole])
    return TransferFunction([c.real for c in num], [c.real for c in den])


def pade(T, n):
    """exp(-T s) = q(-T s)/q(T s), q's coefficient of x^k (2n - k)! n!/((2n)! k! (n - k)!)."""
    q = [math.factorial(2 * n - k) * math.factorial(n) / (math.factorial(2 * n) * math.factorial(k) *
                                                          math.factorial(n - k)) for k in range(n, -1, -1)]
    powers = range(n, -1, -1)
    return [c * (-T) ** k for c, k in zip(q, powers)], [c * T ** k for c, k in zip(q, powers)]
