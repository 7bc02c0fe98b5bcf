// Checks of every case in the tests of products.
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>

#include "tests/engine/request/device_cases.h"

namespace tunewright::test {

/// A refusal is informative: a sentence, never a word or a code.
inline void expect_sentence(const std::string& text) {
    ASSERT_GT(text.size(), 30u) << text;
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(text.front()))) << text;
    EXPECT_EQ(text.back(), '.') << text;
}

/// Load IAE, ISE and peak to 0.1 %, the accuracy of a simulation in steps of the sample time; Ms and Mt to 1e-4.
inline void expect_figures_of_own_program(const DeviceEntry& on_device, const std::string& product, const Case& c) {
    const double Ts = on_device.fitted.law.Ts;
    const Typed typed = typed_of(on_device.fitted, c, Ts);
    SCOPED_TRACE(product + " on " + c.name + ":" + words_of(typed));
    OwnLoopPlant plant(c.plant, Ts, 1);
    const double IAE = own_load_iae(plant, own_program(product, typed));
    const LoadPerformance& load = on_device.loop.performance.load;
    if (!std::isfinite(IAE)) {
        EXPECT_FALSE(load.IAE);
        expect_sentence(load.IAE.why);
        return;
    }
    ASSERT_TRUE(load.IAE && load.ISE && load.peak);
    EXPECT_NEAR(*load.IAE, IAE, 1e-3 * IAE);
    EXPECT_NEAR(*load.ISE, plant.ise(), 1e-3 * plant.ise());
    EXPECT_NEAR(std::abs(*load.peak), plant.peak(), 1e-3 * plant.peak());
    const OwnPeaks peaks = own_peaks(OwnLoopPlant(c.plant, Ts, 0), own_program(product, typed), Ts);
    ASSERT_TRUE(on_device.loop.robustness.Ms && on_device.loop.robustness.Mt);
    EXPECT_NEAR(*on_device.loop.robustness.Ms, peaks.Ms, 1e-4 * peaks.Ms);
    EXPECT_NEAR(*on_device.loop.robustness.Mt, peaks.Mt, 1e-4 * peaks.Mt);
}

/// The name of a test from its product.
inline std::string name_of_case(const testing::TestParamInfo<std::string>& info) { return info.param; }

}  // namespace tunewright::test
