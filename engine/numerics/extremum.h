// Where a function is smallest or largest, by values alone: local and global searches of several unknowns, and the top
// of a hill over one quantity. Its source is the only one that uses NLopt.
//
//   const auto f = [](const std::vector<double>& x, bool&) { return std::pow(x[0] - 1, 2) + std::abs(x[1]); };
//   const auto best = find_local_minimum(LocalSearch::nelder_mead, f, {0, 1}, {.step = {0.1, 0.1}});   // near (1, 0)
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

struct Box {
    std::vector<double> low, high;
};

/// Every point met, in order. DIRECT with a local bias (Jones, Perttunen & Stuckman 1993; Gablonsky & Kelley 2001):
/// deterministic. `f` must be finite everywhere; it ends the search by setting `stop`.
std::vector<LocalMinimum> explore(const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                  const Box& box, int most_evaluations);

struct Maximum {
    double x = 0;
    double value = 0;  ///< f(x)
};

/// Whether a hill with these three points, x ascending and `here` not below its neighbours, may reach above `level`:
/// it does not if the parabola through them, four times as high above `here` as it is, does not.
bool may_exceed(double level, const Maximum& before, const Maximum& here, const Maximum& after);

/// A maximum of f over [left, right], 0 < left < known.x < right, in ln x: Brent's method (Brent, Algorithms for
/// Minimization without Derivatives, 1973, chapter 5) from the known point on, which is not below both ends. ln x is
/// good to about 1e-8, the value to the square of that times f's curvature. The value is never below the known one.
Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right);

}  // namespace tunewright
