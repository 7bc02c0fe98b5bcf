#include "engine/tuning/emulation/search/flatness.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/linear_algebra.h"

namespace tunewright::emulation {
namespace {

constexpr double kFirstStep = 1e-3;   // relative to the unknown
constexpr double kRiseSought = 2e-3;  // of J, relative, at the steps of the differences
constexpr double kMaxStep = 0.3;
constexpr int kStepRounds = 8;

// Steps to either side at which the curvature of J stands out and is still that of the optimum.
struct Differences {
    SettingsPoint step, curvature;
};

double second_difference(const std::function<double(const SettingsPoint&)>& J, const SettingsPoint& at, double J0,
                         std::size_t i, double step) {
    SettingsPoint up = at, down = at;
    up[i] += step;
    down[i] -= step;
    return (J(up) - 2 * J0 + J(down)) / (step * step);
}

std::optional<Differences> measure(const std::function<double(const SettingsPoint&)>& J, const SettingsPoint& at,
                                   const SettingsPoint& sizes, double J0) {
    Differences found{SettingsPoint(at.size()), SettingsPoint(at.size())};
    for (std::size_t i = 0; i < at.size(); ++i) {
        double step = kFirstStep * sizes[i];
        for (int round = 0; round < kStepRounds; ++round) {
            found.step[i] = step;
            found.curvature[i] = second_difference(J, at, J0, i, step);
            const double rise = 0.5 * found.curvature[i] * step * step / J0;
            if (rise > kRiseSought / 4 && rise < kRiseSought * 4) break;
            const double factor = rise > 0 ? std::sqrt(kRiseSought / rise) : 10;
            step = std::min(step * std::clamp(factor, 0.01, 30.0), kMaxStep * sizes[i]);
        }
        if (!(found.curvature[i] > 0)) return std::nullopt;
    }
    return found;
}

}  // namespace

std::optional<Flatness> flatness(const std::function<double(const SettingsPoint&)>& J, const SettingsPoint& optimum,
                                 const SettingsPoint& sizes) {
    const std::size_t n = optimum.size();
    const double J0 = J(optimum);
    if (!(J0 > 0)) return std::nullopt;
    const auto found = measure(J, optimum, sizes, J0);
    if (!found) return std::nullopt;
    std::vector<double> H(n * n, 0);  // in units of the steps
    for (std::size_t i = 0; i < n; ++i) H[i * n + i] = found->curvature[i] * found->step[i] * found->step[i];
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            double mixed = 0;
            for (const int a : {1, -1})
                for (const int b : {1, -1}) {
                    SettingsPoint moved = optimum;
                    moved[i] += a * found->step[i];
                    moved[j] += b * found->step[j];
                    mixed += a * b * J(moved);
                }
            H[i * n + j] = H[j * n + i] = mixed / 4;
        }
    Flatness flat;
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<double> unit(n, 0);
        unit[i] = 1;
        const auto column = solve(H, unit, static_cast<int>(n));
        if (!column || !((*column)[i] > 0)) return std::nullopt;
        flat.reoptimised.push_back(found->step[i] * std::sqrt(2 * kRise * J0 * (*column)[i]));
        flat.alone.push_back(std::sqrt(2 * kRise * J0 / found->curvature[i]));
    }
    return flat;
}

}  // namespace tunewright::emulation
