#include "engine/tuning/robust/known_start.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tunewright::robust {
namespace {

constexpr double kLowest = -3, kSpacing = 0.5;  // of ln(L/T), the columns of the tables
constexpr std::size_t kColumns = 13;
constexpr std::array<double, 3> kLimits = {1.2, 1.4, 2};  // their rows
constexpr double kLowestLimit = 1.15, kHighestLimit = 2.5;

/// ln of K Kp, Ti/T, Td/T.
using Optima = std::array<std::array<DesignPoint, kColumns>, kLimits.size()>;

constexpr Optima kPid = {{{{{1.67, -1.12, -3.90},
                            {1.18, -0.93, -3.38},
                            {0.69, -0.73, -2.79},
                            {0.22, -0.49, -2.29},
                            {-0.23, -0.30, -1.79},
                            {-0.65, -0.13, -1.29},
                            {-1.03, 0.04, -0.79},
                            {-1.29, 0.31, -0.48},
                            {-1.57, 0.59, -0.21},
                            {-1.80, 0.91, 0.03},
                            {-1.98, 1.26, 0.21},
                            {-2.10, 1.66, 0.34},
                            {-2.18, 2.10, 0.43}}},
                          {{{2.23, -1.68, -3.87},
                            {1.74, -1.35, -3.35},
                            {1.25, -1.04, -2.81},
                            {0.79, -0.73, -2.32},
                            {0.34, -0.46, -1.84},
                            {-0.08, -0.23, -1.37},
                            {-0.45, -0.01, -0.91},
                            {-0.75, 0.24, -0.49},
                            {-1.02, 0.56, -0.22},
                            {-1.28, 0.85, 0.05},
                            {-1.49, 1.18, 0.27},
                            {-1.61, 1.58, 0.40},
                            {-1.69, 2.02, 0.49}}},
                          {{{2.82, -2.08, -3.88},
                            {2.33, -1.62, -3.40},
                            {1.84, -1.18, -2.92},
                            {1.37, -0.78, -2.45},
                            {0.92, -0.42, -1.99},
                            {0.50, -0.09, -1.56},
                            {0.13, 0.20, -1.15},
                            {-0.18, 0.45, -0.66},
                            {-0.41, 0.73, -0.27},
                            {-0.63, 1.06, -0.04},
                            {-0.80, 1.43, 0.13},
                            {-0.90, 1.84, 0.24},
                            {-0.95, 2.31, 0.28}}}}};
constexpr Optima kPi = {{{{{1.25, -0.94, 0},
                           {0.76, -0.65, 0},
                           {0.27, -0.43, 0},
                           {-0.22, -0.28, 0},
                           {-0.70, -0.17, 0},
                           {-1.15, -0.07, 0},
                           {-1.53, 0.05, 0},
                           {-1.84, 0.22, 0},
                           {-2.06, 0.45, 0},
                           {-2.20, 0.76, 0},
                           {-2.28, 1.13, 0},
                           {-2.31, 1.57, 0},
                           {-2.33, 2.03, 0}}},
                         {{{1.81, -1.27, 0},
                           {1.33, -0.92, 0},
                           {0.84, -0.62, 0},
                           {0.37, -0.38, 0},
                           {-0.10, -0.22, 0},
                           {-0.56, -0.10, 0},
                           {-1.01, -0.02, 0},
                           {-1.34, 0.14, 0},
                           {-1.57, 0.37, 0},
                           {-1.71, 0.68, 0},
                           {-1.79, 1.06, 0},
                           {-1.82, 1.50, 0},
                           {-1.83, 1.96, 0}}},
                         {{{2.42, -1.67, 0},
                           {1.93, -1.25, 0},
                           {1.45, -0.87, 0},
                           {0.99, -0.53, 0},
                           {0.55, -0.25, 0},
                           {0.15, 0.00, 0},
                           {-0.21, 0.23, 0},
                           {-0.50, 0.46, 0},
                           {-0.71, 0.73, 0},
                           {-0.84, 1.06, 0},
                           {-0.95, 1.42, 0},
                           {-1.01, 1.83, 0},
                           {-1.05, 2.29, 0}}}}};

bool is_known_kind(const DesignProblem& problem) {
    if (problem.measured != nullptr || !problem.others.empty() || problem.objective != Objective::load_iae ||
        problem.limits.Mks)
        return false;
    const LinearPlant& plant = *problem.plant;
    return plant.poles().size() == 1 && plant.integrators() == 0 && plant.zeros().empty() &&
           plant.poles().front().real() < 0 && plant.dead_time() > 0;
}

DesignPoint between(const DesignPoint& a, const DesignPoint& b, double share) {
    DesignPoint x{};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::lerp(a[i], b[i], share);
    return x;
}

/// The gain of a design grows about as 1 - 1/M.
double place(double M) { return std::log(1 - 1 / M); }

}  // namespace

std::optional<DesignPoint> known_start(const DesignProblem& problem) {
    if (!is_known_kind(problem)) return std::nullopt;
    const LinearPlant& plant = *problem.plant;
    const double T = -1 / plant.poles().front().real(), M = problem.limits.Ms;
    const double column = (std::log(plant.dead_time() / T) - kLowest) / kSpacing;
    if (!(column >= 0 && column <= kColumns - 1 && M >= kLowestLimit && M <= kHighestLimit)) return std::nullopt;
    const auto at = std::min(static_cast<std::size_t>(column), kColumns - 2);
    const Optima& optima = problem.pid ? kPid : kPi;
    const auto of_limit = [&](std::size_t row) {
        return between(optima[row][at], optima[row][at + 1], column - static_cast<double>(at));
    };
    const std::size_t row = M < kLimits[1] ? 0 : 1;
    DesignPoint x = between(of_limit(row), of_limit(row + 1),
                            (place(M) - place(kLimits[row])) / (place(kLimits[row + 1]) - place(kLimits[row])));
    x[0] -= std::log(std::abs(plant.low_frequency_gain()));
    x[1] += std::log(T);
    x[2] = problem.pid ? x[2] + std::log(T) : 0;
    return x;
}

}  // namespace tunewright::robust
