#include "engine/numerics/log_maximum.h"

#include <cmath>

namespace tunewright {
namespace {

constexpr double kGolden = 0.3819660112501051;  // (3 - sqrt 5)/2
constexpr double kTolerance = 1e-8;             // of ln x: over it f is flat to rounding at a maximum
constexpr double kFlat = 1e-14;                 // of f: a step that changes it by less is the last
constexpr int kMaxIterations = 60;

}  // namespace

// Boost's brent_find_minima is not used: it starts from an end of the interval. Where dead time puts two maxima between
// two points of a grid it ended on the lower one (|C S| of lambda tuning on 2 e^(-3s)/(10 s + 1): 6e-5 too low).
// Starting from the known inner point keeps to its hill, at 1.2 times the time of find_peaks.
Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right) {
    double a = std::log(left), b = std::log(right), x = std::log(known.x), w = x, v = x;
    double fx = -known.value, fw = fx, fv = fx, step = 0, before = 0;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
        const double middle = 0.5 * (a + b);
        if (std::abs(x - middle) <= 2 * kTolerance - 0.5 * (b - a)) break;
        double p = 0, q = 0, r = 0;
        if (std::abs(before) > kTolerance) {
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
            step = kGolden * before;
        }
        const double u = x + (std::abs(step) >= kTolerance ? step : std::copysign(kTolerance, step));
        const double fu = -f(std::exp(u));
        if (fu <= fx) {
            (u < x ? b : a) = x;
            v = w;
            fv = fw;
            w = x;
            fw = fx;
            x = u;
            fx = fu;
            if (std::abs(fw - fx) <= kFlat * std::abs(fx)) break;
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
