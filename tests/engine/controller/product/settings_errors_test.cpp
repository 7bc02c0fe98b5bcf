// Errors of the law, carried over to the numbers that are typed.
#include "engine/controller/product/settings_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/controller/product/support.h"

namespace tunewright::product {
namespace {

TEST(SettingsErrors, AreThoseOfTheParametersFormula) {
    // Gain in percent of spans and times in seconds, from a law in minutes: both factors are known by hand.
    Context context = kContext;
    context.seconds_per_time = 60;
    const IdealPid pid{.Kp = 1.5, .Ti = 2, .Td = 0.5, .filter = {FilterType::derivative, 0.05}};
    const auto errors =
        settings_errors(product_of("siemens_fb41_cont_c"), pid, {{"Kp", 0.03}, {"Ti", 0.1}, {"Td", 0.02}}, context);
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_NEAR(errors.at("GAIN"), 0.03 * 200 / 100, 1e-9);
    EXPECT_NEAR(errors.at("TI_s"), 6, 1e-6);
    EXPECT_NEAR(errors.at("TD_s"), 1.2, 1e-6);
}

TEST(SettingsErrors, OfAQuotientAddInSquares) {
    const IdealPid pid{.Kp = 2, .Ti = 50};
    const auto errors = settings_errors(product_of("arduino_pid_v1"), pid, {{"Kp", 0.06}, {"Ti", 2}}, kContext);
    // The library counts u from 0 to 255, the user from 0 to 100.
    EXPECT_NEAR(errors.at("Kp"), 0.06 * 2.55, 1e-9);
    EXPECT_NEAR(errors.at("Ki"), 2.0 / 50 * 2.55 * std::hypot(0.03, 0.04), 1e-6);
    EXPECT_EQ(errors.count("Kd"), 0u) << "0, and without an error";
}

TEST(SettingsErrors, AreFiniteForEveryProduct) {
    const IdealPid pid{.Kp = 1.5, .Ti = 120, .Td = 20, .b = 0.6, .filter = {FilterType::derivative, 2}};
    for (const Product& product : catalogue()) {
        const auto errors = settings_errors(
            product, pid, {{"Kp", 0.5}, {"Ti", 100}, {"Td", 30}, {"Tf", INFINITY}, {"b", 0.1}}, kContext);
        EXPECT_FALSE(errors.empty()) << product.id;
        for (const auto& [name, error] : errors) EXPECT_TRUE(error > 0 && std::isfinite(error)) << product.id << name;
    }
}

}  // namespace
}  // namespace tunewright::product
