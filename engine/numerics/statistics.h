// Plain statistics of a record's samples: one pass or two over the values, without weights. No value may be NaN.
#pragma once

#include <span>
#include <vector>

namespace tunewright {

/// The arithmetic mean; of no values: 0.
double mean(std::span<const double> values);

/// Standard deviation of a sample, n - 1 in the denominator; of fewer than two values: 0. Summed about the mean, so
/// that a large offset of the values costs no digits.
double deviation(std::span<const double> values);

/// The middle one; the upper of the two middle ones of an even number. Of at least one value, in O(n).
double median(std::vector<double> values);

/// Least squares of y on t. The slope's standard error takes the residuals as white; with two points it is 0.
struct Line {
    double t_mean = 0, y_mean = 0;
    double slope = 0, slope_std = 0;
};

/// The line y_mean + slope (t - t_mean), of as many t as y; slope and error are 0 for fewer than two points or where
/// all t are equal.
Line straight_line(std::span<const double> t, std::span<const double> y);

/// What the line leaves of each y.
std::vector<double> residuals(const Line& line, std::span<const double> t, std::span<const double> y);

}  // namespace tunewright
