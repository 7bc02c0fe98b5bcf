// LinearPlant: factors and realisation describe the same transfer function as the user's numbers.
#include "engine/plant/linear/linear_plant.h"
#include "engine/numerics/matrix/resolvent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/numerics/matrix/eigenvalues.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

LinearPlant made(const Plant& plant) {
    auto result = LinearPlant::make(plant);
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return *result;
}

void expect_same_response(const LinearPlant& plant, auto formula, double tolerance) {
    const auto& r = plant.realisation();
    for (const double omega : {1e-3, 0.1, 0.7, 1.0, 3.0, 40.0, 2e3}) {
        const Complex s(0, omega), expected = formula(s);
        EXPECT_LT(std::abs(plant.rational(s) - expected), tolerance * std::abs(expected)) << "factors at " << omega;
        EXPECT_LT(std::abs(resolvent_response(r.A, r.B, r.C, r.D, r.n, s) - expected), tolerance * std::abs(expected))
            << "realisation at " << omega;
    }
}

TEST(LinearPlant, FopdtIsTakenLiterally) {
    const auto plant = made(Fopdt{.K = -2, .T = -4, .L = 0.5});
    EXPECT_EQ(plant.unstable_poles(), 1);
    EXPECT_DOUBLE_EQ(plant.low_frequency_gain(), -2);
    expect_same_response(
        plant, [](Complex s) { return -2.0 / (-4.0 * s + 1.0); }, 1e-14);
    EXPECT_LT(std::abs(plant.at({0, 3}) - plant.rational({0, 3}) * std::exp(Complex(0, -1.5))), 1e-15);
}

TEST(LinearPlant, PureDeadTimeHasADirectTerm) {
    const auto plant = made(Fopdt{.K = 3, .T = 0, .L = 1});
    EXPECT_EQ(plant.order(), 0);
    EXPECT_EQ(plant.direct_term(), 3);
}

TEST(LinearPlant, OscillatoryAndOverdampedSecondOrderAgreeWithTheirFormula) {
    for (const double zeta : {-0.2, 0.0, 0.1, 0.999, 1.0, 5.0}) {
        const auto plant = made(OscillatorySopdt{.K = 1.5, .T = 2, .zeta = zeta, .L = 0});
        expect_same_response(
            plant, [zeta](Complex s) { return 1.5 / (4.0 * s * s + 4.0 * zeta * s + 1.0); }, 1e-12);
        EXPECT_EQ(plant.unstable_poles(), zeta < 0 ? 2 : 0);
    }
}

TEST(LinearPlant, EightfoldPoleKeepsItsDigits) {
    const auto plant = made(TransferFunction{.num = {1}, .den = {1, 8, 28, 56, 70, 56, 28, 8, 1}, .L = 0});
    expect_same_response(
        plant, [](Complex s) { return std::pow(s + 1.0, -8); }, 1e-11);
    EXPECT_EQ(plant.unstable_poles(), 0);
}

TEST(LinearPlant, PolesFarApartKeepTheirDigits) {
    const auto plant = made(TransferFunction{.num = {1}, .den = {1e-6, 1.111e-3, 0.112110, 1.111, 1}, .L = 0});
    expect_same_response(
        plant, [](Complex s) { return 1.0 / ((((1e-6 * s + 1.111e-3) * s + 0.112110) * s + 1.111) * s + 1.0); }, 1e-12);
}

TEST(LinearPlant, ZerosOfEveryKindFindASection) {
    const auto plant = made(Zpk{.K = 2,
                                .zeros = {{-1, 2}, {-1, -2}, {3, 0}, {0, 0}},
                                .poles = {{-0.5, 0}, {-0.7, 0}, {-2, 1}, {-2, -1}, {-9, 0}, {-4, 0}},
                                .L = 0.1});
    EXPECT_EQ(plant.integrators(), -1);
    EXPECT_TRUE(plant.has_right_half_plane_zero());
    EXPECT_EQ(plant.pole_excess(), 2);
    expect_same_response(
        plant,
        [](Complex s) {
            return 2.0 * (s * s + 2.0 * s + 5.0) * (s - 3.0) * s /
                   ((s + 0.5) * (s + 0.7) * (s * s + 4.0 * s + 5.0) * (s + 9.0) * (s + 4.0));
        },
        1e-12);
}

TEST(LinearPlant, TwoComplexZeroPairsOverRealPolesAreRealised) {
    const auto plant = made(Zpk{.K = 1,
                                .zeros = {{-1, 2}, {-1, -2}, {0, 3.5}, {0, -3.5}},
                                .poles = {{-1, 0}, {-2, 0}, {-3, 0}, {-4, 0}},
                                .L = 0});
    EXPECT_DOUBLE_EQ(plant.direct_term(), 1);
    expect_same_response(
        plant,
        [](Complex s) {
            return (s * s + 2.0 * s + 5.0) * (s * s + 12.25) / ((s + 1.0) * (s + 2.0) * (s + 3.0) * (s + 4.0));
        },
        1e-12);
}

TEST(LinearPlant, DoubleIntegratorIsCounted) {
    const auto plant = made(TransferFunction{.num = {2, 1}, .den = {1, 1, 0, 0}, .L = 0});
    EXPECT_EQ(plant.integrators(), 2);
    expect_same_response(
        plant, [](Complex s) { return (2.0 * s + 1.0) / (s * s * (s + 1.0)); }, 1e-13);
}

TEST(LinearPlant, StateSpaceGivesItsTransferFunction) {
    // x1' = -x1 + x2, x2' = -2 x2 + u, y = x1 + 0.5 x2: (0.5 s + 1.5)/((s+1)(s+2)).
    const auto plant = made(StateSpace{.A = {{-1, 1}, {0, -2}}, .B = {0, 1}, .C = {1, 0.5}, .D = 0, .L = 2});
    ASSERT_EQ(plant.zeros().size(), 1u);
    EXPECT_NEAR(plant.zeros()[0].real(), -3, 1e-9);
    expect_same_response(
        plant, [](Complex s) { return (0.5 * s + 1.5) / ((s + 1.0) * (s + 2.0)); }, 1e-9);
}

TEST(LinearPlant, HiddenStableModeCancelsAndHiddenUnstableModeIsRefused) {
    const auto plant = made(StateSpace{.A = {{-1, 0}, {0, -3}}, .B = {1, 0}, .C = {1, 1}, .D = 0, .L = 0});
    EXPECT_EQ(plant.poles().size(), 1u);
    const auto refused =
        LinearPlant::make(StateSpace{.A = {{-1, 0}, {0, 3}}, .B = {1, 0}, .C = {1, 1}, .D = 0, .L = 0});
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().kind, ErrorKind::unsupported);
}

TEST(LinearPlant, FaultsNameTheirField) {
    const auto where = [](const Plant& plant) {
        const auto result = LinearPlant::make(plant);
        return result ? std::string("accepted") : result.error().where;
    };
    EXPECT_EQ(where(Fopdt{.K = 0, .T = 1, .L = 1}), "plant/K");
    EXPECT_EQ(where(Fopdt{.K = 1, .T = NAN, .L = 1}), "plant/T");
    EXPECT_EQ(where(Fopdt{.K = 1, .T = 1, .L = -1}), "plant/L");
    EXPECT_EQ(where(TransferFunction{.num = {1, 0, 0}, .den = {1, 1}, .L = 0}), "plant/num");
    EXPECT_EQ(where(TransferFunction{.num = {1}, .den = {0, 0}, .L = 0}), "plant/den");
    EXPECT_EQ(where(TransferFunction{.num = {1}, .den = {}, .L = 0}), "plant/den");
    EXPECT_EQ(where(Zpk{.K = 1, .zeros = {}, .poles = {{-1, 1}}, .L = 0}), "plant/poles/0");
    EXPECT_EQ(where(Zpk{.K = 1, .zeros = {{-1, 0}}, .poles = {}, .L = 0}), "plant/zeros");
    EXPECT_EQ(where(StateSpace{.A = {{-1, 0}}, .B = {1}, .C = {1}, .D = 0, .L = 0}), "plant/A/0");
    EXPECT_EQ(where(StateSpace{.A = {{-1}}, .B = {1}, .C = {0}, .D = 0, .L = 0}), "plant/C");
}

}  // namespace
}  // namespace tunewright
