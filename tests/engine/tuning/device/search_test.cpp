
#include <gtest/gtest.h>

#include <cmath>

#include "engine/progress.h"
#include "engine/tuning/device/settings_search.h"

namespace tunewright::device {
namespace {

LinearPlant fopdt(double K, double T, double L) { return *LinearPlant::make(Fopdt{.K = K, .T = T, .L = L}); }

Shape sampled_pid(double Ts, bool derivative) {
    Shape shape;
    shape.has_derivative = derivative;
    shape.law = [Ts, derivative](double gain, double Ti, double Td) {
        IdealPid pid{.Kp = gain, .Ti = Ti, .Td = derivative ? Td : 0};
        if (derivative) pid.filter = {FilterType::derivative, 0.1 * Td};
        return SampledPid{.gains = to_parallel(pid), .Ts = Ts};
    };
    return shape;
}

TEST(DeviceSearch, AGridOverGainAndTimesFindsNothingBetter) {
    for (const double L : {0.1, 0.5, 2.0})
        for (const double Ts : {0.02, 0.2}) {
            const LinearPlant plant = fopdt(1, 1, L);
            const Shape shape = sampled_pid(Ts, true);
            const PeakLimits limits{.Ms = 1.4, .Mt = 1.4, .Mks = {}};
            const auto found = search({&plant}, shape, limits, {{0.3 / L, 0.5 * L + 0.5, 0.3 * L, 0}}, {});
            ASSERT_TRUE(found);
            double best = INFINITY;
            for (int i = -4; i <= 4; i++)
                for (int j = -4; j <= 4; j++) {
                    const double Ti = found->Ti * std::pow(1.08, i), Td = found->Td * std::pow(1.08, j);
                    for (int k = -4; k <= 4; k++) {
                        const double gain = found->gain * std::pow(1.04, k);
                        const Law law = shape.law(gain, Ti, Td);
                        if (excess_on(plant, law, limits) > 1e-4) continue;
                        best = std::min(best, load_iae_of(plant, law));
                    }
                }
            EXPECT_LE(excess_on(plant, shape.law(found->gain, found->Ti, found->Td), limits), 1e-6);
            EXPECT_LE(found->load_IAE, 1.002 * best);
        }
}

}  // namespace
}  // namespace tunewright::device
