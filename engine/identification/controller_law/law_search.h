// The structure, filter and delay of a controller's law that a record shows.
#pragma once

#include <vector>

#include "engine/identification/controller_law/law_regression.h"

namespace tunewright {

struct FoundLaw {
    LawShape shape;
    std::vector<int> columns;  ///< of the structure
    double theta = 0;          ///< of the errors
    double criterion = 0;      ///< Bayesian information criterion, smaller is better
    LawFit fit;
    int samples = 0;  ///< whitened rows

    bool has(LawColumn column) const;
};

/// The best law of each kind: filter and structure. The first is the best of all.
using FoundLaws = std::vector<FoundLaw>;

/// The laws over all structures, filters, delays and error models; empty where no structure has the signs of a
/// controller. `least_error`: of u in a row, one standard deviation that rounding leaves.
///
/// `other_reading`: the controller reads y without the noise of the record. u is then off for itself in each row (theta
/// near 1), and a filter would only stand for the missing noise: none is tried.
///
/// `start`: laws of a search before on other rows; only their neighbours are looked at then.
FoundLaws search_law(const LawSamples& samples, const std::vector<char>& used, double least_error,
                     bool other_reading = false, const FoundLaws& start = {});

}  // namespace tunewright
