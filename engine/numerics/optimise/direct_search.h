// Minimises a function of several unknowns by its values alone: local and global searches. Only its source uses NLopt.
//
//   const auto f = [](const std::vector<double>& x, bool&) { return std::pow(x[0] - 1, 2) + std::abs(x[1]); };
//   const auto best = find_local_minimum(LocalSearch::nelder_mead, f, {0, 1}, {.step = {0.1, 0.1}});   // near (1, 0)
#pragma once

#include <functional>
#include <vector>

namespace tunewright {

enum class LocalSearch {
    nelder_mead,  ///< one simplex: x, and x moved by each step (Nelder and Mead 1965)
    subplex,      ///< simplices in subspaces (Rowan 1990): more robust if the function has kinks
};

struct LocalMinimum {
    std::vector<double> x;
    double value = 0;
};

struct LocalOptions {
    std::vector<double> step;  ///< first step of each unknown
    double tolerance = 1e-7;   ///< of the value (absolute) and of the unknowns (relative)
    int max_evaluations = 400;
};

/// The best point found, from `start`. `f` must be finite everywhere; it ends the search by setting `stop`.
LocalMinimum find_local_minimum(LocalSearch search,
                                const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                std::vector<double> start, const LocalOptions& options);

struct Box {
    std::vector<double> low, high;
};

/// Every evaluated point, in order. DIRECT with a local bias (Jones, Perttunen & Stuckman 1993; Gablonsky & Kelley
/// 2001): deterministic. `f` must be finite everywhere; it ends the search by setting `stop`.
std::vector<LocalMinimum> explore(const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                  const Box& box, int max_evaluations);

}  // namespace tunewright
