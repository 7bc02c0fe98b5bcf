#include "engine/numerics/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tunewright {

double mean(std::span<const double> values) {
    if (values.empty()) return 0;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(std::span<const double> values) {
    if (values.size() < 2) return 0;
    const double middle = mean(values);
    double squares = 0;
    for (const double value : values) squares += (value - middle) * (value - middle);
    return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Line straight_line(std::span<const double> t, std::span<const double> y) {
    Line line{mean(t), mean(y), 0, 0};
    double tt = 0, ty = 0, yy = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double from_t = t[i] - line.t_mean, from_y = y[i] - line.y_mean;
        tt += from_t * from_t, ty += from_t * from_y, yy += from_y * from_y;
    }
    if (!(tt > 0)) return line;
    line.slope = ty / tt;
    if (t.size() > 2)
        line.slope_std = std::sqrt(std::max(0.0, yy - line.slope * ty) / static_cast<double>(t.size() - 2) / tt);
    return line;
}

std::vector<double> residuals(const Line& line, std::span<const double> t, std::span<const double> y) {
    std::vector<double> left(t.size());
    for (std::size_t i = 0; i < t.size(); ++i) left[i] = y[i] - line.y_mean - line.slope * (t[i] - line.t_mean);
    return left;
}

}  // namespace tunewright
