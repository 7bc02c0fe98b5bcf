// Settings typed for a product have a warning if their proportional part is almost zero.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "tests/engine/request/device_cases.h"

namespace tunewright {
namespace {

using namespace test;

bool warns(const TuningEntry& entry) {
    return std::ranges::any_of(entry.evaluation->warnings,
                               [](const Warning& warning) { return warning.code == "degenerate-design"; });
}

// Resonances with dead time, whose optimum often has pure integral and derivative action; if it has not, there is no
// warning.
TEST(DegenerateDevice, EveryTypedDesignWithoutAProportionalPartSaysSo) {
    int degenerate = 0, ordinary = 0;
    for (const std::string product : {"marlin", "esphome_pid", "simple_pid", "klipper"})
        for (const auto& [zeta, L, M] :
             {std::tuple{0.1, 20.0, 1.4}, {0.05, 10.0, 2.0}, {0.4, 3.0, 1.4}, {1.2, 6.0, 1.4}}) {
            const Case c{product, OscillatorySopdt{.K = 1, .T = 10, .zeta = zeta, .L = L}, 10, {0, 100, 0, 1}};
            TuningRequest request = request_of(c, "robust");
            request.tune[0].options.set("Ms", M);
            request.tune[0].options.set("Mt", M);
            request.device = device_of(product, c, 2);
            const auto result = tune(request, {});
            ASSERT_TRUE(result) << product << ": " << result.error().message;
            const TuningEntry& entry = result->controllers.front();
            const IdealPid& typed = entry.on_device->fitted.controller;
            const double omega = *entry.on_device->loop.robustness.omega_Ms;
            const bool expected = typed.Ti * omega < 1e-3 || typed.Td * omega > 1e3;
            EXPECT_EQ(warns(entry), expected) << product << ", zeta " << zeta << ", Ti " << typed.Ti;
            ++(expected ? degenerate : ordinary);
        }
    EXPECT_GE(degenerate, 3);
    EXPECT_GE(ordinary, 6);
}

}  // namespace
}  // namespace tunewright
