#include "engine/range/model/range_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "engine/range/design_range.h"

namespace tunewright::range {
namespace {

std::vector<RangePoint> two(const Plant& left, const Plant& right) {
    return {{.at = 0, .family = family_of(left)}, {.at = 4, .family = family_of(right)}};
}

TEST(RangeModel, InterpolatesLogarithmsOfParameters) {
    const auto model = model_of_points(two(Sopdt{1, 10, 2, 0.5}, Sopdt{16, 8, 40, 2}), Between::parameters);
    ASSERT_TRUE(model);
    const auto quarter = (*model)->at(1);
    ASSERT_TRUE(quarter);
    // The slower lags belong together, in whatever order they were given.
    const std::complex<double> s(0, 0.3);
    const double K = std::pow(16, 0.25), T1 = 10 * std::pow(4, 0.25), T2 = 2 * std::pow(4, 0.25),
                 L = 0.5 * std::pow(4, 0.25);
    const auto expected = K * std::exp(-s * L) / ((T1 * s + 1.0) * (T2 * s + 1.0));
    EXPECT_LT(std::abs(quarter->nominal->at(s) - expected), 1e-12 * std::abs(expected));
}

TEST(RangeModel, InterpolatesLinearlyWhereASignOrAZeroForbidsLogarithms) {
    const auto model = model_of_points(two(Fopdt{1, 10, 0}, Fopdt{1, 10, 4}), Between::parameters);
    EXPECT_DOUBLE_EQ((*model)->at(1)->nominal->dead_time(), 1);
    const auto numerator = model_of_points(
        two(TransferFunction{{1, 1}, {1, 2, 1}, 1}, TransferFunction{{-1, 1}, {1, 2, 1}, 1}), Between::parameters);
    ASSERT_TRUE(numerator);
    EXPECT_NEAR((*numerator)->at(1)->nominal->at({0, 2}).imag(),
                LinearPlant::make(TransferFunction{{0.5, 1}, {1, 2, 1}, 1})->at({0, 2}).imag(), 1e-12);
}

TEST(RangeModel, InterpolatesWhatIsUncertainOfBothNeighbours) {
    Fopdt uncertain{1, 10, 2};
    uncertain.uncertainty.K = FactorRange{0.5, 2};
    const auto model = model_of_points(two(uncertain, Fopdt{4, 10, 2}), Between::parameters);
    const auto middle = (*model)->at(2);
    ASSERT_TRUE(middle);
    double min = 99, largest = 0;
    for (const auto& member : middle->members) {
        min = std::min(min, member.low_frequency_gain());
        largest = std::max(largest, member.low_frequency_gain());
    }
    // The right end is not uncertain: halfway, the factors 0.5 and 2, with a ratio of 2 to the centre, have become
    // their roots.
    EXPECT_NEAR(min, 2 / std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(largest, 2 * std::sqrt(2.0), 1e-12);
    Fopdt surer{4, 10, 2};
    surer.uncertainty.K = FactorRange{0.9, 1.1};
    const auto both = model_of_points(two(uncertain, surer), Between::parameters);
    largest = 0;
    const auto middle_of_both = (*both)->at(2);
    ASSERT_TRUE(middle_of_both);
    for (const auto& member : middle_of_both->members) largest = std::max(largest, member.low_frequency_gain());
    EXPECT_NEAR(largest, 2 * std::sqrt(2 * 1.1), 1e-12);
}

/// Gain, lag and dead time of a model's member, from its response.
std::array<double, 3> numbers_of(const LinearPlant& plant) {
    return {plant.low_frequency_gain(), plant.lag_sum(), plant.dead_time()};
}

TEST(RangeModel, EnclosesWhatIsUncertainOfOneNeighbourAlone) {
    Fopdt left{1, 10, 1}, right{2, 5, 1};
    left.uncertainty.L = left.uncertainty.T = FactorRange{0.5, 2};
    right.uncertainty.K = FactorRange{0.5, 2};
    const auto model = model_of_points(two(left, right), Between::parameters);
    const auto middle = (*model)->at(2);
    ASSERT_TRUE(middle);
    const auto nominal = numbers_of(*middle->nominal);
    // Halfway, each factor 0.5 or 2 has become its root, and all eight combinations of them may occur.
    for (int corner = 0; corner < 8; ++corner) {
        const auto there = [&](const LinearPlant& member) {
            const auto numbers = numbers_of(member);
            for (std::size_t i = 0; i < 3; ++i)
                if (std::abs(numbers[i] / nominal[i] - std::pow(2, (corner >> i) & 1 ? 0.5 : -0.5)) > 1e-9)
                    return false;
            return true;
        };
        EXPECT_TRUE(std::ranges::any_of(middle->members, there)) << corner;
    }
    Fopdt alike{2, 5, 1};
    alike.uncertainty.L = alike.uncertainty.T = FactorRange{0.5, 2};
    const auto same = model_of_points(two(left, alike), Between::parameters);
    EXPECT_LE((*same)->at(2)->members.size(), 6u);  // corners interpolated only with their own kind, and centres
}

TEST(RangeModel, InterpolatesResponsesThatLieOnEitherSideOfANegativeRealAxis) {
    for (const double sign : {1.0, -1.0}) {
        const Plant lead = TransferFunction{{sign * 24, sign * 3}, {30, 11, 1}, 2};
        const Plant lag = TransferFunction{{sign * 30, sign * 2}, {30, 11, 1}, 2};
        const auto model = model_of_points(two(lead, lag), Between::frequency_response);
        ASSERT_TRUE(model);
        const auto middle = (*model)->at(2);
        ASSERT_TRUE(middle) << middle.error().message;
        const auto a = LinearPlant::make(lead)->at({0, 0.02}), b = LinearPlant::make(lag)->at({0, 0.02});
        const auto between =
            sign * std::polar(std::sqrt(std::abs(a) * std::abs(b)), 0.5 * (std::arg(sign * a) + std::arg(sign * b)));
        EXPECT_LT(std::abs(middle->measured->at(0.02) - between), 1e-3 * std::abs(between));
        RangeOptions options;
        options.between = Between::frequency_response;
        EXPECT_TRUE(design_range({.scheduling = {}, .model = *model, .options = options}, {}));
    }
}

TEST(RangeModel, InterpolatesFrequencyResponsesOfUnlikeStructures) {
    const Plant left = Fopdt{1, 10, 2}, right = Zpk{3.0 / 8, {}, {-0.5, -0.5, -0.5}, 1};
    EXPECT_FALSE(model_of_points(two(left, right), Between::parameters));
    const auto model = model_of_points(two(left, right), Between::frequency_response);
    ASSERT_TRUE(model) << model.error().message;
    const auto middle = (*model)->at(2);
    ASSERT_TRUE(middle);
    ASSERT_TRUE(middle->measured);
    for (const double omega : {0.02, 0.1, 0.3, 0.6}) {
        const auto a = LinearPlant::make(left)->at({0, omega}), b = LinearPlant::make(right)->at({0, omega});
        // At these frequencies neither phase has passed -180 degrees twice: the principal values are sufficient,
        // unwrapped once.
        const double phase_a = -std::atan(10 * omega) - 2 * omega, phase_b = -3 * std::atan(2 * omega) - omega;
        const auto expected = std::polar(std::sqrt(std::abs(a) * std::abs(b)), 0.5 * (phase_a + phase_b));
        EXPECT_LT(std::abs(middle->measured->at(omega) - expected), 1e-4 * std::abs(expected)) << omega;
    }
}

TEST(RangeModel, OfUnlikeStructuresIsDesignedWithTheIntegratedErrorBetween) {
    const Plant left = Fopdt{1, 10, 2}, right = Zpk{3.0 / 8, {}, {-0.5, -0.5, -0.5}, 1};
    RangeOptions options;
    options.between = Between::frequency_response;
    const auto model = model_of_points(two(left, right), options.between);
    const auto design = design_range({.scheduling = {}, .model = *model, .options = options}, {});
    ASSERT_TRUE(design) << design.error().message;
    ASSERT_TRUE(design->schedule) << design->why_no_schedule;
    EXPECT_TRUE(design->schedule->holds_limits);
    EXPECT_TRUE(design->schedule->within_allowance);
}

std::string fault(const std::vector<RangePoint>& points, Between between = Between::parameters) {
    const auto model = model_of_points(points, between);
    return model ? "" : model.error().where + ": " + model.error().message;
}

TEST(RangeModel, RefusesPointsThatMakeNoRange) {
    auto points = two(Fopdt{1, 10, 2}, Fopdt{2, 10, 2});
    points[1].at = 0;
    EXPECT_EQ(fault(points),
              "points/1/at: at is 0 after 0; the points must be in ascending order, each place once. Sort them, and "
              "keep one of those "
              "at the same place.");
    points.pop_back();
    EXPECT_EQ(fault(points), "points: There are 1 points; give 2 to 20.");
    EXPECT_EQ(fault(two(Fopdt{1, 10, 2}, Fopdt{-1, 10, 2})).substr(0, 55),
              "points/1/plant: The gain changes its sign between 0 and");
    EXPECT_EQ(fault(two(Fopdt{1, 10, -2}, Fopdt{1, 10, 2})).substr(0, 14), "points/0/plant");
    EXPECT_EQ(fault(two(Fopdt{-1, -5, 0.5}, Fopdt{1, 5.6, 0.6})),
              "points/1/plant: The plant's K goes from -1 to 1 between 0 and 4; where it is 0 the input does not move "
              "the output. Split the range there.");
    EXPECT_EQ(
        fault(two(Zpk{2, {}, {-1, -2, -3}, 1}, Zpk{1, {}, {-1, -2, -3}, 1})),
        "points/1/plant: The plants at 0 and 4 are given by zeros and poles or as state spaces, whose numbers are "
        "not interpolated. Give both in one structure of named parameters or coefficients, or set "
        "schedule.between to \"frequency_response\".");
    EXPECT_EQ(fault(two(Ipdt{1, 1}, Fopdt{1, 10, 2}), Between::frequency_response).substr(0, 51),
              "points/1/plant: The plant has 0 integrators and 0 u");
}

TEST(RangeModel, ADesignThatFailsNamesTheFieldThatARangeHas) {
    const auto model = model_of_points(two(Fopdt{1, 5, 0}, Fopdt{1, 5, 1}), Between::parameters);
    const auto design = design_range({.scheduling = {}, .model = *model, .options = {}}, {});
    ASSERT_FALSE(design);
    EXPECT_EQ(design.error().kind, ErrorKind::unbounded_optimum);
    EXPECT_EQ(design.error().where, "options/filter");
    EXPECT_NE(design.error().message.find("at = 0"), std::string::npos) << design.error().message;
}

}  // namespace
}  // namespace tunewright::range
