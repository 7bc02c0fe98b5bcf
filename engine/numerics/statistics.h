// Plain statistics of a record's samples.
#pragma once

#include <span>
#include <vector>

namespace tunewright {

/// Of no values: 0.
double mean(std::span<const double> values);

/// Standard deviation of a sample, n - 1 in the denominator; of fewer than two values: 0.
double deviation(std::span<const double> values);

/// The upper of the two middle ones of an even number. Of at least one value.
double median(std::vector<double> values);

/// Least squares of y on t. The slope's standard error takes the residuals as white; with two points it is 0.
struct Line {
    double t_mean = 0, y_mean = 0;
    double slope = 0, slope_std = 0;
};

/// Of as many t as y; slope and error are 0 for fewer than two points or where all t are equal.
Line straight_line(std::span<const double> t, std::span<const double> y);

}  // namespace tunewright
