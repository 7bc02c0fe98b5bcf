#include "engine/identification/record/input_limits.h"

#include <cmath>

namespace tunewright {

std::vector<InputLimits> plain_limits(const Record& record) {
    static constexpr InputLimits kUsual[] = {{0, 1},   {-1, 1},     {0, 100},  {-100, 100},
                                             {0, 255}, {-255, 255}, {0, 1023}, {0, 4095}};
    constexpr double kBeyond = 0.05, kMinOutside = 0.02, kMinInside = 0.1;
    std::vector<InputLimits> found;
    for (const InputLimits& limits : kUsual) {
        const auto [low, high] = limits;
        const double margin = kBeyond * (high - low);
        int inside = 0, outside = 0, all = 0;
        for (const double u : record.u) {
            if (!std::isfinite(u)) continue;
            ++all;
            inside += u > low && u < high ? 1 : 0;
            outside += u < low - margin || u > high + margin ? 1 : 0;
        }
        if (inside > kMinInside * all && outside > kMinOutside * all) found.push_back(limits);
    }
    return found;
}

}  // namespace tunewright
