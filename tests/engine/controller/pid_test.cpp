// Conversions between the PID forms: equal loops, compared as transfer functions, and the stated conditions of
// existence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "engine/controller/pid.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Complex measurement_filter(const Filter& filter, Complex s) {
    const Complex x = s * filter.Tf;
    if (filter.type == FilterType::measurement_first_order) return 1.0 / (1.0 + x);
    if (filter.type == FilterType::measurement_second_order) return 1.0 / (1.0 + x + x * x / 2.0);
    return 1;
}

double derivative_Tf(const Filter& filter) { return filter.type == FilterType::derivative ? filter.Tf : 0; }

// -u/y with r = 0, written from the contract's definitions, independent of the code under test.
Complex law(const IdealPid& pid, Complex s) {
    return pid.Kp * (1.0 + 1.0 / (s * pid.Ti) + s * pid.Td / (1.0 + s * derivative_Tf(pid.filter))) *
           measurement_filter(pid.filter, s);
}
Complex law(const ParallelPid& pid, Complex s) {
    return (pid.Kp + pid.Ki / s + pid.Kd * s / (1.0 + s * derivative_Tf(pid.filter))) *
           measurement_filter(pid.filter, s);
}
Complex law(const SeriesPid& pid, Complex s) {
    return pid.Kp * (1.0 + 1.0 / (s * pid.Ti)) * (1.0 + s * pid.Td) / (1.0 + s * derivative_Tf(pid.filter)) *
           measurement_filter(pid.filter, s);
}

template <class A, class B>
void expect_same_loop(const A& a, const B& b) {
    for (const double omega : {1e-3, 0.1, 1.0, 7.0, 300.0}) {
        const Complex s(0, omega), expected = law(a, s);
        EXPECT_LT(std::abs(law(b, s) - expected), 1e-12 * std::abs(expected)) << "at omega " << omega;
    }
}

const Filter kFilters[] = {{},
                           {FilterType::derivative, 0.08},
                           {FilterType::measurement_first_order, 0.3},
                           {FilterType::measurement_second_order, 0.05}};

TEST(Forms, SeriesOfAnIdealControllerIsTheSameLoopWithEveryFilterAndSign) {
    for (const auto& filter : kFilters) {
        for (const double Kp : {1.7, -0.4}) {
            const IdealPid pid{.Kp = Kp, .Ti = 9, .Td = 1.1, .filter = filter};
            const auto series = to_series(pid);
            ASSERT_TRUE(series) << series.error().message;
            expect_same_loop(pid, *series);
            EXPECT_GT(series->Ti, series->Td);
            EXPECT_NEAR(series->b_equivalent, series->Ti / pid.Ti, 1e-15);
            expect_same_loop(pid, gains(Controller(*series)));
            const auto back = to_ideal(*series);
            ASSERT_TRUE(back);
            EXPECT_NEAR(back->Kp, pid.Kp, 1e-13);
            EXPECT_NEAR(back->Ti, pid.Ti, 1e-12);
            EXPECT_NEAR(back->Td, pid.Td, 1e-13);
            // The series form's b = 1 acts as b_equivalent in the ideal form.
            EXPECT_NEAR(back->b, series->b_equivalent, 1e-14);
        }
    }
}

TEST(Forms, SeriesWithoutFilterObeysSumAndProduct) {
    // Ti' + Td' = Ti, Ti' Td' = Ti Td: Ti = 10, Td = 1.6 gives 8 and 2, Kp' = 0.8 Kp.
    const auto series = to_series(IdealPid{.Kp = 5, .Ti = 10, .Td = 1.6});
    ASSERT_TRUE(series);
    EXPECT_NEAR(series->Ti, 8, 1e-14);
    EXPECT_NEAR(series->Td, 2, 1e-14);
    EXPECT_NEAR(series->Kp, 4, 1e-14);
    EXPECT_NEAR(series->b_equivalent, 0.8, 1e-15);
}

TEST(Forms, SeriesWithDerivativeFilterObeysItsOwnSumAndProduct) {
    const IdealPid pid{.Kp = 1, .Ti = 10, .Td = 1.6, .filter = {FilterType::derivative, 0.2}};
    const auto series = to_series(pid);
    ASSERT_TRUE(series);
    EXPECT_NEAR(series->Ti + series->Td, pid.Ti + 0.2, 1e-13);
    EXPECT_NEAR(series->Ti * series->Td, pid.Ti * (pid.Td + 0.2), 1e-12);
}

TEST(Forms, SeriesExistsExactlyAtTheBoundaryDespiteRounding) {
    for (const double Td : {0.1, 0.3, 0.7, 1e-6, 12345.678}) {
        const auto series = to_series(IdealPid{.Kp = 1, .Ti = 4 * Td, .Td = Td});
        ASSERT_TRUE(series) << "Td " << Td;
        EXPECT_NEAR(series->Ti / series->Td, 1, 1e-6);
    }
}

TEST(Forms, SeriesIsRefusedWithTheRuleAndBothNumbers) {
    const auto plain = to_series(IdealPid{.Kp = 1, .Ti = 1, .Td = 0.3});
    ASSERT_FALSE(plain);
    EXPECT_EQ(plain.error().kind, ErrorKind::unsupported);
    EXPECT_THAT(plain.error().message, HasSubstr("Ti = 1 is below 4 Td = 1.2"));

    const auto filtered = to_series(IdealPid{.Kp = 1, .Ti = 1, .Td = 0.3, .filter = {FilterType::derivative, 0.1}});
    ASSERT_FALSE(filtered);
    EXPECT_THAT(filtered.error().message, HasSubstr("(Ti + Tf)^2 = 1.21 is below 4 Ti (Td + Tf) = 1.6"));
}

TEST(Forms, WithoutIntegralActionSeriesAlwaysExists) {
    const IdealPid pd{.Kp = 2, .Td = 3, .filter = {FilterType::derivative, 0.5}};
    const auto series = to_series(pd);
    ASSERT_TRUE(series);
    EXPECT_EQ(series->Ti, kInfinity);
    EXPECT_DOUBLE_EQ(series->Td, 3.5);
    expect_same_loop(pd, *series);
    const auto back = to_ideal(*series);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->Ti, kInfinity);
    EXPECT_DOUBLE_EQ(back->Td, 3);
    EXPECT_EQ(gains(Controller(*series)).Ki, 0);
}

TEST(Forms, ParallelGainsAreProductsAndBack) {
    const IdealPid pid{.Kp = -3, .Ti = 6, .Td = 0.5, .b = 0.4, .filter = {FilterType::measurement_second_order, 0.1}};
    const ParallelPid parallel = to_parallel(pid);
    EXPECT_DOUBLE_EQ(parallel.Ki, -0.5);
    EXPECT_DOUBLE_EQ(parallel.Kd, -1.5);
    expect_same_loop(pid, parallel);
    const auto back = to_ideal(parallel);
    ASSERT_TRUE(back);
    EXPECT_DOUBLE_EQ(back->Ti, 6);
    EXPECT_DOUBLE_EQ(back->Td, 0.5);
    EXPECT_EQ(back->b, 0.4);
    EXPECT_EQ(back->filter.type, FilterType::measurement_second_order);
}

TEST(Forms, InfiniteTiHasNoIntegralGainEitherWay) {
    EXPECT_EQ(to_parallel(IdealPid{.Kp = 2}).Ki, 0);
    const auto back = to_ideal(ParallelPid{.Kp = 2, .Kd = 1});
    ASSERT_TRUE(back);
    EXPECT_FALSE(back->has_integral());
    EXPECT_DOUBLE_EQ(back->Td, 0.5);
}

TEST(Forms, PureIntegralActionHasNoIdealFormButHasGains) {
    const ParallelPid pure{.Ki = 0.3};
    const auto ideal = to_ideal(pure);
    ASSERT_FALSE(ideal);
    EXPECT_THAT(ideal.error().message, HasSubstr("Kp is 0 while Ki = 0.3"));
    EXPECT_EQ(gains(Controller(pure)).Ki, 0.3);
}

TEST(Forms, SeriesWhoseFilterEatsTheProportionalPartIsRefusedAsIdeal) {
    const auto ideal = to_ideal(SeriesPid{.Kp = 1, .Ti = 1, .Td = 0.5, .filter = {FilterType::derivative, 1.5}});
    ASSERT_FALSE(ideal);
    EXPECT_THAT(ideal.error().message, HasSubstr("Ti + Td = Tf = 1.5"));
    const auto zero = to_ideal(SeriesPid{.Kp = 1, .Ti = 0, .Td = 0.5});
    ASSERT_FALSE(zero);
    EXPECT_EQ(zero.error().where, "Ti");
}

}  // namespace
}  // namespace tunewright
