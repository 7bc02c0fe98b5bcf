#include "engine/tuning/robust/sweep/sweep_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "engine/numerics/pair.h"

namespace tunewright::robust {
namespace {

struct Response {
    double re, im;
};

TUNEWRIGHT_INLINED double squared(Response z) { return z.re * z.re + z.im * z.im; }

TUNEWRIGHT_INLINED Response response_of(const LoopGains& c, double w) {
    const double fr = 1 - 0.5 * w * w * c.Tf * c.Tf, fi = w * c.Tf, scale = 1 / (fr * fr + fi * fi);
    const double nr = c.Kp, ni = c.Kd * w - c.Ki / w;
    return {(nr * fr + ni * fi) * scale, (ni * fr - nr * fi) * scale};
}

TUNEWRIGHT_INLINED Response product(Response a, Response b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

template <bool with_CS>
TUNEWRIGHT_INLINED void peak_loop(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits,
                                  double* __restrict S, double* __restrict T, double* __restrict CS) {
    const LoopGains c = gains;
    const InverseLimits limit = limits;
    const double *w = grid.omega.data(), *pr = grid.P_re.data(), *pi = grid.P_im.data();
    const std::size_t n = grid.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Response C = response_of(c, w[i]), L = product({pr[i], pi[i]}, C);
        const double distance = 1 / squared({1 + L.re, L.im});
        S[i] = distance * limit.S;
        T[i] = squared(L) * distance * limit.T;
        if constexpr (with_CS) CS[i] = squared(C) * distance * limit.CS;
    }
}

TUNEWRIGHT_INLINED void peak_loop(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits, double* S,
                                  double* T, double* CS) {
    if (CS == nullptr) return peak_loop<false>(grid, gains, limits, S, T, CS);
    peak_loop<true>(grid, gains, limits, S, T, CS);
}

template <bool with_CS>
TUNEWRIGHT_INLINED void turning_loop(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits,
                                     double* __restrict S, double* __restrict T, double* __restrict CS) {
    const LoopGains c = gains;
    const InverseLimits limit = limits;
    const double *w = grid.omega.data(), *pr = grid.P_re.data(), *pi = grid.P_im.data();
    const std::size_t n = grid.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double C = squared(response_of(c, w[i])), L = C * squared({pr[i], pi[i]}), apart = 1 - std::sqrt(L);
        const double nearest = apart > kMinDistance ? apart : kMinDistance, distance = 1 / (nearest * nearest);
        S[i] = distance * limit.S;
        T[i] = L * distance * limit.T;
        if constexpr (with_CS) CS[i] = C * distance * limit.CS;
    }
}

TUNEWRIGHT_INLINED void turning_loop(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits,
                                     double* S, double* T, double* CS) {
    if (CS == nullptr) return turning_loop<false>(grid, gains, limits, S, T, CS);
    turning_loop<true>(grid, gains, limits, S, T, CS);
}

TUNEWRIGHT_INLINED void circle_loop(const CurveGrid& grid, const LoopGains& gains, const Circle& circle,
                                    double* __restrict level) {
    const LoopGains c = gains;
    const Circle around = circle;
    const double *w = grid.omega.data(), *pr = grid.P_re.data(), *pi = grid.P_im.data();
    const std::size_t n = grid.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Response L = product({pr[i], pi[i]}, response_of(c, w[i]));
        level[i] = around.radius * around.radius / squared({L.re - around.centre, L.im});
    }
}

TUNEWRIGHT_INLINED void open_loop(const CurveGrid& grid, const LoopGains& gains, double* __restrict L_re,
                                  double* __restrict L_im) {
    const LoopGains c = gains;
    const double *w = grid.omega.data(), *pr = grid.P_re.data(), *pi = grid.P_im.data();
    const std::size_t n = grid.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Response L = product({pr[i], pi[i]}, response_of(c, w[i]));
        L_re[i] = L.re;
        L_im[i] = L.im;
    }
}

TUNEWRIGHT_INLINED void factor_loop(const double* re, const double* im, std::size_t n, const Circle& a, const Circle& b,
                                    double* __restrict lower, double* __restrict upper, double* __restrict other_lower,
                                    double* __restrict other_upper) {
    const double a2 = a.radius * a.radius, ac = a.centre, ac2 = ac * ac;
    const double b2 = b.radius * b.radius, bc = b.centre, bc2 = bc * bc;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = re[i], y2 = im[i] * im[i], size = x * x + y2, inverse = 1 / (size > 0 ? size : 1.0);
        const double a_inside = a2 * size - ac2 * y2, b_inside = b2 * size - bc2 * y2;
        const double a_root = std::sqrt(a_inside > 0 ? a_inside : 0.0),
                     b_root = std::sqrt(b_inside > 0 ? b_inside : 0.0);
        const double a_high = a_inside > 0 ? (ac * x + a_root) * inverse : -1.0,
                     b_high = b_inside > 0 ? (bc * x + b_root) * inverse : -1.0;
        const double a_low = (ac * x - a_root) * inverse, b_low = (bc * x - b_root) * inverse;
        // A single interval stands for both.
        const double low0 = a_high > 0 ? a_low : b_low, high0 = a_high > 0 ? a_high : b_high;
        const double low1 = b_high > 0 ? b_low : a_low, high1 = b_high > 0 ? b_high : a_high;
        const double min = low0 < low1 ? low0 : low1, max = high0 > high1 ? high0 : high1;
        const double between = (low0 > low1 ? low0 : low1) - (high0 < high1 ? high0 : high1);
        lower[i] = between > 0 ? low0 : min;
        upper[i] = between > 0 ? high0 : max;
        other_lower[i] = low1;
        other_upper[i] = between > 0 ? high1 : -1.0;
    }
}

constexpr std::size_t kBlockSize = 64;

/// The largest difference |L_to - L_from|^2 - most^2 |1 + L_from|^2 over at most kBlockSize frequencies: a maximum over
/// all of them would not be vectorised.
template <bool worst>
TUNEWRIGHT_INLINED void change_loop(const CurveGrid& grid, const LoopGains& from, const LoopGains& to, double max,
                                    double* __restrict excess) {
    const LoopGains a = from, b = to;
    const double *w = grid.omega.data(), *pr = grid.P_re.data(), *pi = grid.P_im.data();
    const std::size_t n = grid.size();
    const double max2 = max * max;
    for (std::size_t i = 0; i < n; ++i) {
        const Response P{pr[i], pi[i]}, before = response_of(a, w[i]), after = response_of(b, w[i]);
        const Response L = product(P, before);
        const double change = squared(P) * squared({after.re - before.re, after.im - before.im});
        if constexpr (worst) {
            const double nearest = 1 - std::sqrt(squared(L)), at_worst = change - max2 * nearest * nearest;
            excess[i] = nearest > 0 ? at_worst : 1.0;
        } else {
            excess[i] = change - max2 * squared({1 + L.re, L.im});
        }
    }
}

TUNEWRIGHT_INLINED bool change_within(const CurveGrid& grid, const LoopGains& from, const LoopGains& to, double max,
                                      Phase phase) {
    std::array<double, kBlockSize> excess;
    for (std::size_t at = 0; at < grid.size(); at += kBlockSize) {
        const CurveGrid part = grid.part(at, std::min(at + kBlockSize, grid.size()));
        if (phase == Phase::worst)
            change_loop<true>(part, from, to, max, excess.data());
        else
            change_loop<false>(part, from, to, max, excess.data());
        if (!std::all_of(excess.begin(), excess.begin() + part.size(), [](double x) { return x < 0; })) return false;
    }
    return true;
}

/// True if number i is a local maximum among its neighbours; at the array's ends it may have only one.
TUNEWRIGHT_INLINED bool is_top(std::span<const double> level, double from, std::size_t i) {
    return level[i] >= from && (i == 0 || level[i] >= level[i - 1]) &&
           (i + 1 == level.size() || level[i] > level[i + 1]);
}

/// Checks sixteen numbers at once for a local maximum; mostly there is none.
template <class Block>
TUNEWRIGHT_INLINED void find_tops(std::span<const double> level, double from, std::vector<std::size_t>& found) {
    constexpr std::size_t kAtOnce = 16, kWidth = sizeof(Block) / sizeof(double);
    found.clear();
    const double* at = level.data();
    std::size_t i = 0;
    const auto look = [&](std::size_t to) __attribute__((always_inline)) {
        for (; i < to; ++i)
            if (is_top(level, from, i)) found.push_back(i);
    };
    look(std::min<std::size_t>(1, level.size()));
    while (i + kAtOnce < level.size()) {
        decltype(Block{} < Block{}) any{};
        for (std::size_t k = i; k < i + kAtOnce; k += kWidth) {
            Block left, here, right;
            std::memcpy(&left, at + k - 1, sizeof left);
            std::memcpy(&here, at + k, sizeof here);
            std::memcpy(&right, at + k + 1, sizeof right);
            any |= (here >= from) & (here >= left) & (here > right);
        }
        std::int64_t one = 0;
        for (std::size_t lane = 0; lane < kWidth; ++lane) one |= any[lane];
        if (one != 0)
            look(i + kAtOnce);
        else
            i += kAtOnce;
    }
    look(level.size());
}

TUNEWRIGHT_FOR_AVX2 void find_tops_avx2(std::span<const double> level, double from, std::vector<std::size_t>& found) {
    find_tops<Quad>(level, from, found);
}

TUNEWRIGHT_FOR_AVX2 void peak_loop_avx2(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits,
                                        double* S, double* T, double* CS) {
    peak_loop(grid, gains, limits, S, T, CS);
}

TUNEWRIGHT_FOR_AVX2 void turning_loop_avx2(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits,
                                           double* S, double* T, double* CS) {
    turning_loop(grid, gains, limits, S, T, CS);
}

TUNEWRIGHT_FOR_AVX2 void circle_loop_avx2(const CurveGrid& grid, const LoopGains& gains, const Circle& circle,
                                          double* level) {
    circle_loop(grid, gains, circle, level);
}

TUNEWRIGHT_FOR_AVX2 void open_loop_avx2(const CurveGrid& grid, const LoopGains& gains, double* L_re, double* L_im) {
    open_loop(grid, gains, L_re, L_im);
}

TUNEWRIGHT_FOR_AVX2 void factor_loop_avx2(const double* re, const double* im, std::size_t n, const Circle& a,
                                          const Circle& b, const Intervals& first, const Intervals& second) {
    factor_loop(re, im, n, a, b, first.lower.data(), first.upper.data(), second.lower.data(), second.upper.data());
}

TUNEWRIGHT_FOR_AVX2 bool change_within_avx2(const CurveGrid& grid, const LoopGains& from, const LoopGains& to,
                                            double max, Phase phase) {
    return change_within(grid, from, to, max, phase);
}

}  // namespace

std::complex<double> controller_response(const LoopGains& gains, double omega) {
    const Response C = response_of(gains, omega);
    return {C.re, C.im};
}

void peak_levels(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits, double* S, double* T,
                 double* CS, Registers registers) {
    if (registers == Registers::avx2) return peak_loop_avx2(grid, gains, limits, S, T, CS);
    peak_loop(grid, gains, limits, S, T, CS);
}

void turning_levels(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits, double* S, double* T,
                    double* CS, Registers registers) {
    if (registers == Registers::avx2) return turning_loop_avx2(grid, gains, limits, S, T, CS);
    turning_loop(grid, gains, limits, S, T, CS);
}

void local_maxima(std::span<const double> level, double from, std::vector<std::size_t>& found, Registers registers) {
    if (registers == Registers::avx2) return find_tops_avx2(level, from, found);
    find_tops<Pair>(level, from, found);
}

void circle_levels(const CurveGrid& grid, const LoopGains& gains, const Circle& circle, double* level,
                   Registers registers) {
    if (registers == Registers::avx2) return circle_loop_avx2(grid, gains, circle, level);
    circle_loop(grid, gains, circle, level);
}

void open_loops(const CurveGrid& grid, const LoopGains& gains, Phase phase, double* L_re, double* L_im,
                Registers registers) {
    if (registers == Registers::avx2)
        open_loop_avx2(grid, gains, L_re, L_im);
    else
        open_loop(grid, gains, L_re, L_im);
    for (std::size_t i = 0; phase == Phase::worst && i < grid.size(); ++i) {
        L_re[i] = -std::hypot(L_re[i], L_im[i]);
        L_im[i] = 0;
    }
}

void forbidden_factors(std::span<const double> L_re, std::span<const double> L_im, const Circle& a, const Circle& b,
                       Intervals first, Intervals second, Registers registers) {
    const double *re = L_re.data(), *im = L_im.data();
    if (registers == Registers::avx2) return factor_loop_avx2(re, im, L_re.size(), a, b, first, second);
    factor_loop(re, im, L_re.size(), a, b, first.lower.data(), first.upper.data(), second.lower.data(),
                second.upper.data());
}

bool moves_less(const CurveGrid& grid, const LoopGains& from, const LoopGains& to, double max, Phase phase,
                Registers registers) {
    if (registers == Registers::avx2) return change_within_avx2(grid, from, to, max, phase);
    return change_within(grid, from, to, max, phase);
}

}  // namespace tunewright::robust
