#include "engine/numerics/cubic.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/numerics/sign_change.h"

namespace tunewright {

std::optional<double> first_rise(const Cubic& c, double h, double noise) {
    std::array<double, 4> mark = {0, h, h, h};
    int n = 1;
    // Turning points: c1 + c2 s + c3/2 s^2 = 0, by the formula without cancellation.
    const double discriminant = c[2] * c[2] - 2 * c[1] * c[3];
    if (discriminant >= 0) {
        const double q = -(c[2] + std::copysign(std::sqrt(discriminant), c[2]));
        std::array<double, 2> root = {q / c[3], 2 * c[1] / q};
        if (!(root[0] <= root[1])) std::swap(root[0], root[1]);
        for (const double s : root)
            if (s > 0 && s < h) mark[std::size_t(n++)] = s;
    }
    mark[std::size_t(n++)] = h;
    for (int i = 0; i < n; ++i) {
        if (!(value_at(c, mark[std::size_t(i)]) > noise)) continue;
        if (i == 0) return 0;
        const double low = mark[std::size_t(i - 1)], high = mark[std::size_t(i)];
        if (value_at(c, low) > 0) return low;
        return first_positive([&c](double s) { return value_at(c, s); }, low, high, value_at(c, low),
                              value_at(c, high));
    }
    return std::nullopt;
}

}  // namespace tunewright
