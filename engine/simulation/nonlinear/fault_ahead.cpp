#include "engine/simulation/nonlinear/fault_ahead.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tunewright {

std::string fault_ahead(const NonlinearSystem& system, std::span<const double> x, std::span<const double> dx, double u,
                        double t) {
    constexpr double kFirst = std::numeric_limits<double>::epsilon(), kFar = 1e3, kGrowth = 4;
    std::vector<double> ahead(x.size());
    double length = 0;
    while (length < kFar) {
        for (std::size_t i = 0; i < x.size(); ++i) ahead[i] = x[i] + length * dx[i];
        if (std::string sentence = system.domain_fault(ahead, u); !sentence.empty()) return sentence;
        length = std::max(kGrowth * length, kFirst * std::max(t, 1e-9));
    }
    return "Their rates of change do not exist there.";
}

}  // namespace tunewright
