#include "engine/numerics/log_root.h"

#include <cmath>

namespace tunewright {

double log_root(const std::function<double(double)>& f, double left, double right, double f_left, double f_right,
                double tolerance) {
    double a = std::log(left), b = std::log(right), last = b;
    for (int i = 0; i < 80; ++i) {
        const bool finite = std::isfinite(f_left) && std::isfinite(f_right);
        const double x = finite && i < 40 ? (a * f_right - b * f_left) / (f_right - f_left) : 0.5 * (a + b);
        if (std::abs(x - last) < tolerance) break;
        last = x;
        const double fx = f(std::exp(x));
        if (fx == 0) break;
        if ((fx < 0) == (f_right < 0)) {
            b = x;
            f_right = fx;
            f_left /= 2;
        } else {
            a = x;
            f_left = fx;
            f_right /= 2;
        }
    }
    return std::exp(last);
}

}  // namespace tunewright
