// Global search without derivatives over a box. With local_minimum.h the one place that knows NLopt.
#pragma once

#include <functional>
#include <vector>

#include "engine/numerics/local_minimum.h"

namespace tunewright {

struct Box {
    std::vector<double> low, high;
};

/// Every point met, in order. DIRECT with a local bias (Jones, Perttunen & Stuckman 1993; Gablonsky & Kelley 2001):
/// deterministic. `f` must be finite everywhere; it ends the search by setting `stop`.
std::vector<LocalMinimum> explore(const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                  const Box& box, int most_evaluations);

}  // namespace tunewright
