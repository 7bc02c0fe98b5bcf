// The rows of a record at which a controller computed its output, and which of them it computed by its law.
#pragma once

#include <vector>

#include "engine/identification/record/record.h"

namespace tunewright {

/// Samples in time order. t, u, y, row, excluded, limited and still have equal lengths; r is empty or as long. In the
/// record's units.
struct LawSamples {
    std::vector<double> t, u, y, r;
    std::vector<int> row;           ///< of each sample among the rows with numbers
    std::vector<double> rows_y;     ///< y of all rows with numbers
    std::vector<double> rows_r;     ///< the same of r; empty: none
    std::vector<char> excluded;     ///< in manual
    std::vector<char> limited;      ///< at an end of u's range, where u stays
    std::vector<char> still;        ///< no mode, and u stands still for a time: manual, or rounded too coarsely
    double period = 0;              ///< median time from one sample to the next, > 0
    double rows_per_sample = 1;     ///< > 1: u is a staircase over the rows, whose period is the controller's
    double u_step = 0, y_step = 0;  ///< rounding of u and y, 0: none found
    int manual_rows = 0;

    int size() const { return static_cast<int>(t.size()); }
};

/// Rows with numbers in each column and strictly ascending times; r is empty or as long as the others.
struct LawRows {
    std::vector<double> t, u, y, r;
    std::vector<char> manual;
};

/// Each row is a sample; those at the ends of u's range where u stays there are left out.
LawSamples each_row(LawRows rows);

/// 1. Rows without a time, u or y (or r, where there is an r) are left out; of a longer record all but the last 10,000.
/// Rows from the newest to the oldest are reversed.
/// 2. Where u moves once every so many rows only, those are the samples: the period in rows, not always a whole
/// number, is the largest with which (nearly) all moves of u keep step.
/// 3. Left out: rows in manual by the record's mode; rows at the ends of u's range where u stays there. Without a mode
/// stretches in which u stands still are marked.
LawSamples law_samples(const Record& record);

/// The step of the grid on which all values lie, to 2 % of it; 0 where there is none or fewer than 4 different values.
double rounding_step(std::vector<double> values);

}  // namespace tunewright
