// Plain statistics of a record's samples: one or two passes over the values, without weights. No value may be NaN.
#pragma once

#include <span>
#include <vector>

namespace tunewright {

/// The arithmetic mean; 0 for no values.
double mean(std::span<const double> values);

/// Standard deviation of a sample, with n - 1 in the denominator; 0 for fewer than two values. Summed about the mean,
/// so that a large offset of the values costs no digits.
double deviation(std::span<const double> values);

/// The median; for an even number of values the upper of the two middle ones. Needs at least one value; O(n).
double median(std::vector<double> values);

/// Least squares of y on t. The slope's standard error assumes white residuals; with two points it is 0.
struct Line {
    double t_mean = 0, y_mean = 0;
    double slope = 0, slope_std = 0;
};

/// The line y_mean + slope (t - t_mean), of as many t as y; slope and error are 0 for fewer than two points or if all t
/// are equal.
Line straight_line(std::span<const double> t, std::span<const double> y);

/// The residual of each y from the line.
std::vector<double> residuals(const Line& line, std::span<const double> t, std::span<const double> y);

}  // namespace tunewright
