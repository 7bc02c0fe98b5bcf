"""Responses of PID loops by Chebyshev collocation.

The plant is a cascade of complex first-order sections. Time is cut into intervals that repeat from one dead time to the
next, finer after each of its multiples where u may jump; within an interval x' = F x + G v + b is solved by collocation
at 17 Chebyshev-Lobatto points, and v is what u was at the same points one dead time before: no interpolation. Integrals
and extremes come from the polynomials, cut at their roots.
"""
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np  # noqa: E402

N = 16
NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(N + 1) / N)
WEIGHTS = np.array([(-1.0) ** i for i in range(N + 1)])
WEIGHTS[0] *= 0.5
WEIGHTS[-1] *= 0.5
GAUSS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(20)
GAUSS, GAUSS_WEIGHTS = 0.5 + 0.5 * GAUSS, 0.5 * GAUSS_WEIGHTS
FINE = np.linspace(0, 1, 49)


def differentiation():
    D = np.zeros((N + 1, N + 1))
    for i in range(N + 1):
        for j in range(N + 1):
            if i != j:
                D[i, j] = WEIGHTS[j] / WEIGHTS[i] / (NODES[i] - NODES[j])
        D[i, i] = -D[i].sum()
    return D


D = differentiation()


def interpolation(points):
    """Values at the nodes to values at the points, barycentric."""
    rows = []
    for s in np.atleast_1d(points):
        hit = np.flatnonzero(np.abs(s - NODES) < 1e-15)
        row = np.zeros(N + 1)
        if len(hit):
            row[hit[0]] = 1
        else:
            row = WEIGHTS / (s - NODES)
            row /= row.sum()
        rows.append(row)
    return np.array(rows)


TO_FINE = interpolation(FINE)


def at(values, s):
    """Each row's polynomial at its own point s, barycentric."""
    distance = s[:, None] - NODES
    hit = np.abs(distance) < 1e-15
    weights = np.where(hit.any(axis=1)[:, None], hit, WEIGHTS / np.where(hit, 1, distance))
    return (weights * values).sum(axis=1) / weights.sum(axis=1)


def loop_matrices(plant, c):
    """x' = F x + G v + H r, u = M x + Nn v + R r, y = Y x + Z v."""
    poles = [complex(*p) for p in plant["poles"]]
    zeros = [complex(*z) for z in plant["zeros"]]
    n = len(poles)
    A, B, C, Z = np.zeros((n, n), complex), np.zeros(n, complex), np.zeros(n, complex), 1 + 0j
    for k, p in enumerate(poles):
        row = C.copy()
        A[k, :] = row
        B[k] = Z
        A[k, k] += p
        if k < len(zeros):  # (s - z)/(s - p) = 1 + (p - z)/(s - p)
            C[k] = p - zeros[k]
        else:
            C[:], Z = 0, 0
            C[k] = 1
    C, Z = plant["K"] * C, plant["K"] * Z
    filters = {"none": 0, "derivative": 1, "measurement_first_order": 1, "measurement_second_order": 2}[c["filter"]]
    Kp, Ki, Kd, Tf, b, w = c["Kp"], c["Ki"], c["Kd"], c["Tf"], c["b"], c["c"]
    m = n + filters + 1
    F, G, H = np.zeros((m, m), complex), np.zeros(m, complex), np.zeros(m, complex)
    M, Y, R, Nn = np.zeros(m, complex), np.zeros(m, complex), Kp * b, 0j
    F[:n, :n], G[:n], Y[:n] = A, B, C
    integral, f = m - 1, n
    if c["filter"] in ("none", "derivative"):
        M[:n] -= Kp * C
        Nn -= Kp * Z
        F[integral, :n], G[integral] = -C, -Z
        if c["filter"] == "none" and Kd != 0:
            assert abs(Z) == 0
            M[:n] -= Kd * (C @ A)
            Nn -= Kd * (C @ B)
        if c["filter"] == "derivative":  # f is the lagged w r - y
            F[f, :n], F[f, f], G[f], H[f] = -C / Tf, -1 / Tf, -Z / Tf, w / Tf
            M[:n] -= Kd / Tf * C
            M[f] -= Kd / Tf
            Nn -= Kd / Tf * Z
            R += Kd / Tf * w
    elif c["filter"] == "measurement_first_order":
        F[f, :n], F[f, f], G[f] = C / Tf, -1 / Tf, Z / Tf
        M[f] += -Kp + Kd / Tf
        M[:n] -= Kd / Tf * C
        Nn -= Kd / Tf * Z
        F[integral, f] = -1
    else:  # y_f and y_f'
        F[f, f + 1] = 1
        F[f + 1, :n], G[f + 1] = 2 / Tf**2 * C, 2 / Tf**2 * Z
        F[f + 1, f], F[f + 1, f + 1] = -2 / Tf**2, -2 / Tf
        M[f] -= Kp
        M[f + 1] -= Kd
        F[integral, f] = -1
    H[integral] = 1
    M[integral] += Ki
    return F, G, H, M, Nn, R, Y, Z


def operator(F, G, b, h):
    """States at the nodes from the state at the start, v at the nodes and the constant input."""
    m = len(G)
    K = np.kron(D, np.eye(m)) / h - np.kron(np.eye(N + 1), F)
    K[:m, :] = 0
    K[:m, :m] = np.eye(m)
    start, drive = np.zeros(((N + 1) * m, m), complex), np.kron(np.eye(N + 1), G[:, None])
    start[:m] = np.eye(m)
    drive[:m] = 0
    constant = np.tile(b, N + 1).astype(complex)
    constant[:m] = 0
    solved = np.linalg.solve(K, np.column_stack([start, drive, constant]))
    return solved[:, :m], solved[:, m:-1], solved[:, -1]


def mesh(length, fastest, finest):
    """Intervals over one dead time: short at its start, where jumps and their echoes set fast modes off."""
    h, t, parts = min(length, finest), 0.0, []
    while length - t > 1e-12 * length:
        step = min(h, length - t)
        if length - t - step < 0.3 * step:
            step = length - t
        parts.append(step)
        t += step
        h = min(h * 1.4, fastest)
    return parts


class Response:
    """y and u at the nodes of consecutive intervals."""

    def __init__(self, plant, c, r, d, refine, settled=1e-10, horizon=None, most=40000):
        F, G, H, M, Nn, R, Y, Z = loop_matrices(plant, c)
        L, m = plant["L"], len(G)
        speeds = np.abs(np.linalg.eigvals(F))
        t0, hs, ys, us = [], [], [], []
        x, t, cache = np.zeros(m, complex), 0.0, {}
        if L == 0:
            g = 1 / (1 - Nn)
            F0, b0 = F + np.outer(G, M) * g, H * r + G * g * (R * r + d)
            modes = np.linalg.eigvals(F0)
            if modes.real.max() >= 0:
                raise ValueError("unstable")
            first = 0.5 / np.abs(modes).max() / refine
            h = first
        else:
            fastest = 2.5 / max(speeds.max(), 2.5 / L) / refine
            smooth = 1.0 / max(1e-300, np.sort(speeds)[-1])
            parts = mesh(L, min(L / 2 / refine, max(fastest, L / 60)), min(L / 2, smooth) / refine)
            previous = [np.zeros(N + 1, complex)] * len(parts)
        largest, quiet_since = 0.0, 0.0
        largest_u = 0.0
        A = np.block([[F, G[:, None]], [M[None, :], np.array([[Nn - 1]])]])
        rest_u = np.linalg.solve(A, np.append(-H * r, -(R * r + d)))[-1].real - d
        while True:
            if L == 0:
                alive = np.abs(modes[-modes.real * t < 40])
                if len(alive) == 0:
                    alive = np.abs(modes).min(keepdims=True)
                target = 1.5 / alive.max() / refine
                while h * 1.5 <= target:
                    h *= 1.5
                plan = [(h, None)]
            else:
                plan = list(zip(parts, range(len(parts))))
            for step, k in plan:
                if step not in cache:
                    cache[step] = operator(F0, np.zeros(m), b0, step) if L == 0 else operator(F, G, H * r, step)
                S, V, K = cache[step]
                if L == 0:
                    X = (S @ x + K).reshape(N + 1, m)
                    v = g * (X @ M + R * r + d)
                else:
                    v = previous[k]
                    X = (S @ x + V @ v + K).reshape(N + 1, m)
                u, y = X @ M + Nn * v + R * r, X @ Y + Z * v
                if L > 0:
                    previous = previous[:k] + [u + d] + previous[k + 1:]
                t0.append(t)
                hs.append(step)
                ys.append(y.real)
                us.append(u.real)
                x = X[-1]
                t += step
                worst = np.abs(y - r).max()
                largest = max(largest, worst)
                if not worst <= 1e4 * max(1, abs(plant["K"])) * 1e6:
                    raise ValueError("unstable")
                moving = np.abs(u - rest_u).max()
                largest_u = max(largest_u, moving, 1e-3 * abs(rest_u))
                if worst > settled * largest or moving > settled * largest_u:
                    quiet_since = t
            if horizon is not None and t >= horizon:
                break
            if horizon is None and t > 1.3 * quiet_since + 3 * L and t > 0:
                break
            if len(t0) > most:
                raise ValueError("slow")
        self.t0, self.h = np.array(t0), np.array(hs)
        self.y, self.u, self.r = np.array(ys), np.array(us), r

    def cut(self, horizon):
        """The same up to the horizon."""
        last = int(np.searchsorted(self.t0 + self.h, horizon * (1 - 1e-15)))
        last = min(last, len(self.t0) - 1)
        other = object.__new__(Response)
        other.r = self.r
        other.t0, other.h = self.t0[:last + 1].copy(), self.h[:last + 1].copy()
        other.y, other.u = self.y[:last + 1].copy(), self.u[:last + 1].copy()
        part = (horizon - other.t0[-1]) / other.h[-1]
        there = interpolation(NODES * part)
        other.y[-1], other.u[-1] = there @ other.y[-1], there @ other.u[-1]
        other.h[-1] = horizon - other.t0[-1]
        return other

    @staticmethod
    def roots(values):
        """(row, zero in (0, 1)) of the polynomials through each row's values at the nodes, in order; by bisection."""
        fine = values @ TO_FINE.T
        rows, columns = np.nonzero(np.sign(fine[:, :-1]) * np.sign(fine[:, 1:]) < 0)
        a, b, fa = FINE[columns], FINE[columns + 1], fine[rows, columns]
        for _ in range(52):
            s = 0.5 * (a + b)
            same = (at(values[rows], s) < 0) == (fa < 0)
            a, b = np.where(same, s, a), np.where(same, b, s)
        return rows, 0.5 * (a + b)

    def pieces(self, values):
        """Arrays (interval, from, to) on which the values keep their sign."""
        rows, zeros = self.roots(values)
        count = np.arange(len(values))
        where = np.concatenate([count, rows, count])
        mark = np.concatenate([np.zeros(len(values)), zeros, np.ones(len(values))])
        order = np.lexsort((mark, where))
        where, mark = where[order], mark[order]
        keep = where[1:] == where[:-1]
        return where[:-1][keep], mark[:-1][keep], mark[1:][keep]

    def integrals(self):
        e = self.r - self.y
        i, a, b = self.pieces(e)
        IAE, ISE, ITAE = np.zeros(len(i)), 0.0, np.zeros(len(i))
        for x, w in zip(GAUSS, GAUSS_WEIGHTS):
            s = a + (b - a) * x
            value, h = at(e[i], s), self.h[i] * (b - a) * w
            IAE += h * value
            ISE += float(h @ value**2)
            ITAE += h * value * (self.t0[i] + self.h[i] * s)
        return float(np.abs(IAE).sum()), ISE, float(np.abs(ITAE).sum())

    def variation(self):
        i, a, b = self.pieces(self.u @ D.T)
        jumps = abs(self.u[0, 0]) + float(np.abs(self.u[1:, 0] - self.u[:-1, -1]).sum())
        return jumps + float(np.abs(at(self.u[i], b) - at(self.u[i], a)).sum())

    def extremes(self):
        i, s = self.roots(self.y @ D.T)
        values = np.concatenate([[0.0], self.y[:, 0], self.y[:, -1], at(self.y[i], s)])
        return float(values.min()), float(values.max())

    def last_outside(self, band):
        e = self.y - self.r
        if abs(e[-1, -1]) > band:
            return None
        outside = np.flatnonzero(np.abs(e @ TO_FINE.T).max(axis=1) > band)
        if len(outside) == 0:
            return 0.0
        i = outside[-1]
        marks = np.concatenate([self.roots(e[i:i + 1] - edge)[1] for edge in (band, -band)])
        return float(self.t0[i] + self.h[i] * (marks.max() if len(marks) else 1.0))

    def first_reached(self, level):
        for i in np.flatnonzero((self.y @ TO_FINE.T).max(axis=1) >= level):
            marks = self.roots(self.y[i:i + 1] - level)[1]
            return float(self.t0[i] + self.h[i] * (marks.min() if len(marks) else 0.0))
        return None
