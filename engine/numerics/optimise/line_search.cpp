#include "engine/numerics/optimise/line_search.h"

#include <algorithm>

namespace tunewright {
namespace {

struct BrentConstants {
    double golden = 0.3819660112501051;  ///< (3 - sqrt 5)/2
    double tolerance = 1e-8;             ///< of ln x: the root of the rounding; within it f is flat at a maximum
    double flat = 1e-14;                 ///< relative to f: the search ends at a step that changes f by less
    int max_iterations = 60;             ///< ten are usual; golden sections alone would need 40
};

constexpr double kMaxRise =
    4;  // multiple of a parabola's height: a sharper maximum between two points of a grid is not found

}  // namespace

bool may_exceed(double level, const Maximum& before, const Maximum& here, const Maximum& after) {
    if (here.value > level) return true;
    const double left = here.x - before.x, right = after.x - here.x;
    const double up = (here.value - before.value) / left, down = (here.value - after.value) / right;
    const double bend = (up + down) / (left + right), slope = up - bend * left;
    const double rise = bend > 0 ? 0.25 * slope * slope / bend : 0;
    return here.value + kMaxRise * rise > level;
}

// Boost's brent_find_minima is not used: it starts from an end of the interval. With two maxima between two points of a
// grid, as a dead time causes, it ended on the lower one (|C S| of lambda tuning on 2 e^(-3s)/(10 s + 1): 6e-5 too
// low). A start from the known inner point stays at its maximum, but find_peaks takes 1.2 times as long.
//
//  1. x is the best point, w the second and v the one before w; [a, b] encloses the maximum.
//  2. A parabola through the three gives the step, if it ends inside and is shorter than half of the step before last.
//  3. Otherwise the step is a golden section of the longer part.
//  4. f is computed at the step's end, at least `tolerance` away; the interval and the three points are updated.
//  5. It ends when the interval is within two tolerances, or a better point is better only by rounding.
Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right) {
    constexpr BrentConstants k;
    double a = std::log(left), b = std::log(right), x = std::log(known.x), w = x, v = x;
    double fx = -known.value, fw = fx, fv = fx, step = 0, before = 0;
    for (int iteration = 0; iteration < k.max_iterations; ++iteration) {
        const double middle = 0.5 * (a + b);
        if (std::abs(x - middle) <= 2 * k.tolerance - 0.5 * (b - a)) break;
        double p = 0, q = 0, r = 0;
        if (std::abs(before) > k.tolerance) {
            r = (x - w) * (fx - fv);
            q = (x - v) * (fx - fw);
            p = (x - v) * q - (x - w) * r;
            q = 2 * (q - r);
            if (q > 0) p = -p;
            q = std::abs(q);
        }
        if (std::abs(p) < std::abs(0.5 * q * before) && p > q * (a - x) && p < q * (b - x)) {
            before = step;
            step = p / q;
        } else {
            before = (x < middle ? b : a) - x;
            step = k.golden * before;
        }
        const double u = x + (std::abs(step) >= k.tolerance ? step : std::copysign(k.tolerance, step));
        const double fu = -f(std::exp(u));
        if (fu <= fx) {
            (u < x ? b : a) = x;
            v = w;
            fv = fw;
            w = x;
            fw = fx;
            x = u;
            fx = fu;
            if (std::abs(fw - fx) <= k.flat * std::abs(fx)) break;
        } else {
            (u < x ? a : b) = u;
            if (fu <= fw || w == x) {
                v = w;
                fv = fw;
                w = u;
                fw = fu;
            } else if (fu <= fv || v == x || v == w) {
                v = u;
                fv = fu;
            }
        }
    }
    return {std::exp(x), -fx};
}

}  // namespace tunewright
