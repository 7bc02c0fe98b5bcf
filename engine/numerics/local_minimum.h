// Local searches without derivatives. With global_minimum.h the one place that knows NLopt.
#pragma once

#include <functional>
#include <vector>

namespace tunewright {

enum class LocalSearch {
    nelder_mead,  ///< one simplex: x, and x moved by each step (Nelder and Mead 1965)
    subplex,      ///< simplices in subspaces (Rowan 1990): sturdier where the function has kinks
};

struct LocalMinimum {
    std::vector<double> x;
    double value = 0;
};

struct LocalOptions {
    std::vector<double> step;  ///< first step of each unknown
    double tolerance = 1e-7;   ///< of the value (absolute) and of the unknowns (relative)
    int most_evaluations = 400;
};

/// The best point met, from `start`. `f` must be finite everywhere; it ends the search by setting `stop`.
LocalMinimum find_local_minimum(LocalSearch search,
                                const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                std::vector<double> start, const LocalOptions& options);

}  // namespace tunewright
