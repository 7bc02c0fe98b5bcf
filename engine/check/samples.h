// The samples of a record in operation: in the order of time, on an even grid, without repair of what a check must see.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/identification/record/record.h"

namespace tunewright::check {

/// Every row of the record that has a time, in the order of time; of rows of equal time the last. A measurement or an
/// output that is missing is NaN where no row before has one, else it is held and marked.
struct Rows {
    std::vector<double> t, y, u;
    std::vector<double> r;        ///< empty: no set point
    std::vector<char> automatic;  ///< empty: not recorded
    std::vector<char> measured;   ///< 1: this row has a measurement of its own
    std::vector<char> moved;      ///< 1: this row has an output of its own
    double step = 0;              ///< the median time from row to row; 0: fewer than two rows
};

Rows rows_of(const Record& record);

/// An even series: the longest part of the rows without a gap of more than kLongestGap steps in the measurement.
/// Shorter gaps keep the last values, and so do gaps of the output, which many historians store only when it changes.
struct Samples {
    double start = 0, step = 1;  ///< time
    std::vector<double> y, u;
    std::vector<double> r;        ///< empty: no set point
    std::vector<char> automatic;  ///< empty: not recorded
    std::vector<char> moved;      ///< 1: the output was recorded here, 0: it is held

    std::size_t size() const { return y.size(); }
    double duration() const { return step * static_cast<double>(y.size()); }
    double time(std::size_t i) const { return start + step * static_cast<double>(i); }
    /// Set point minus measurement; without a set point the mean of the measurement minus it.
    std::vector<double> error() const;
};

inline constexpr int kLongestGap = 20;                  ///< steps
inline constexpr std::size_t kMostSamples = 2'000'000;  ///< a longer record has longer steps

Samples even_samples(const Rows& rows);

/// A run of equal successive values: from `begin`, `length` of them.
struct EqualRun {
    std::size_t begin = 0, length = 0;
};
std::vector<EqualRun> equal_runs(std::span<const double> values);

/// The mean of each `count` successive values; an incomplete last block is left out.
std::vector<double> block_means(std::span<const double> values, std::size_t count);

}  // namespace tunewright::check
