// Regions of plants: their members, which are reproducible.
#include "engine/plant/plant_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/plant/linear/linear_plant.h"

namespace tunewright {
namespace {

/// Ranges of K, T and L.
Uncertainty ranges(std::optional<FactorRange> K, std::optional<FactorRange> T, std::optional<FactorRange> L) {
    Uncertainty uncertainty;
    uncertainty.K = K;
    uncertainty.T = T;
    uncertainty.L = L;
    return uncertainty;
}

Fopdt with_ranges() {
    return {.K = 2, .T = 10, .L = 3, .uncertainty = ranges(FactorRange{0.8, 1.2}, std::nullopt, FactorRange{0.9, 1.2})};
}

TEST(PlantRegion, CornersOfRangesAreTheProductsOfTheFactors) {
    const auto region = PlantRegion::of_ranges(with_ranges());
    ASSERT_EQ(region.dimension(), 2);
    std::vector<std::pair<double, double>> found;
    for (const auto& end : region.ends()) {
        const auto plant = std::get<Fopdt>(region.at(end));
        EXPECT_EQ(plant.T, 10);
        found.emplace_back(plant.K, plant.L);
    }
    ASSERT_EQ(found.size(), 5u);
    for (const auto& [K, L] : {std::pair{1.6, 2.7}, {2.4, 2.7}, {1.6, 3.6}, {2.4, 3.6}, {2.0, 3.15}})
        EXPECT_TRUE(std::ranges::any_of(
            found, [&](const auto& p) { return std::abs(p.first - K) < 1e-12 && std::abs(p.second - L) < 1e-12; }))
            << K << " " << L;
}

TEST(PlantRegion, GainFactorsScaleEveryPlantType) {
    const Uncertainty gain = ranges(FactorRange{0.5, 2}, std::nullopt, std::nullopt);
    const Plant plants[] = {
        TransferFunction{.num = {1, 3}, .den = {1, 2, 1}, .uncertainty = gain},
        Zpk{.K = 3, .zeros = {-1}, .poles = {-2, -3}, .uncertainty = gain},
        StateSpace{.A = {{-1}}, .B = {1}, .C = {2}, .D = 0.5, .uncertainty = gain},
        Ipdt{.K = 0.1, .L = 1, .uncertainty = gain},
    };
    for (const Plant& plant : plants) {
        const auto region = PlantRegion::of_ranges(plant);
        ASSERT_EQ(region.dimension(), 1);
        const auto nominal = LinearPlant::make(plant), high = LinearPlant::make(region.at({1.0}));
        ASSERT_TRUE(nominal && high);
        const std::complex<double> s(0, 0.7);
        EXPECT_NEAR(std::abs(high->at(s) / nominal->at(s) - 2.0), 0, 1e-12) << plant.index();
    }
}

TEST(PlantRegion, TheEllipsoidHoldsNineteenOfTwentyDrawsOfItsCovariance) {
    // In the coordinates of the covariance's axes a sample is inside if its chi-square is below the 95 % point: the
    // surface points must have exactly that Mahalanobis distance.
    const std::vector<std::vector<double>> V = {{0.04, 0.1, 0.0}, {0.1, 1.0, -0.2}, {0.0, -0.2, 0.09}};
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto region = PlantRegion::of_covariance(plant, {"K", "T", "L"}, V);
    ASSERT_TRUE(region.has_value());
    // Inverse of V by hand: adjugate over determinant.
    const double det = 0.04 * (1.0 * 0.09 - 0.04) - 0.1 * (0.1 * 0.09) + 0;
    const double I[3][3] = {{(0.09 - 0.04) / det, -(0.1 * 0.09) / det, (0.1 * -0.2) / det},
                            {-(0.1 * 0.09) / det, (0.04 * 0.09) / det, (0.04 * 0.2) / det},
                            {(0.1 * -0.2) / det, (0.04 * 0.2) / det, (0.04 * 1.0 - 0.01) / det}};
    for (const auto& end : region->ends()) {
        const auto p = std::get<Fopdt>(region->at(end));
        const double d[3] = {p.K - 2, p.T - 10, p.L - 3};
        double distance = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) distance += d[i] * I[i][j] * d[j];
        EXPECT_NEAR(distance, 7.814728, 1e-6);
    }
}

TEST(PlantRegion, DeadTimesStayPositiveAndTimeConstantsKeepTheirSign) {
    const std::vector<std::vector<double>> V = {{0.01, 0, 0}, {0, 400, 0}, {0, 0, 4}};
    for (const double T : {10.0, -10.0}) {
        const auto region = PlantRegion::of_covariance(Fopdt{.K = 1, .T = T, .L = 1}, {"K", "T", "L"}, V);
        ASSERT_TRUE(region.has_value());
        for (const auto& z : region->spread(200)) {
            const auto plant = std::get<Fopdt>(region->at(z));
            EXPECT_GE(plant.L, 0);
            EXPECT_GE(plant.T / T, 0.05 - 1e-12);
        }
    }
}

TEST(PlantRegion, IdentifiedTransferFunctionsMoveByTheirOwnNames) {
    const Plant plant = TransferFunction{.num = {-2 * 1.5, 2}, .den = {6, 5, 1}, .L = 1};
    EXPECT_DOUBLE_EQ(parameter(plant, "K"), 2);
    EXPECT_DOUBLE_EQ(parameter(plant, "b"), -1.5);
    EXPECT_DOUBLE_EQ(parameter(plant, "a2"), 6);
    Plant moved = plant;
    set_parameter(moved, "K", 4);
    set_parameter(moved, "b", -1);
    set_parameter(moved, "a1", 7);
    const auto& changed = std::get<TransferFunction>(moved);
    EXPECT_EQ(changed.num, (std::vector<double>{-4, 4}));
    EXPECT_EQ(changed.den, (std::vector<double>{6, 7, 1}));
}

TEST(PlantRegion, SpreadPointsFillTheRegionEvenly) {
    const std::vector<std::vector<double>> V = {{1, 0}, {0, 1}};
    const auto ball = PlantRegion::of_covariance(Ipdt{.K = 100, .L = 100}, {"K", "L"}, V);
    ASSERT_TRUE(ball.has_value());
    int inner = 0;
    const auto points = ball->spread(400);
    for (const auto& z : points) {
        EXPECT_LE(std::hypot(z[0], z[1]), 1);
        inner += std::hypot(z[0], z[1]) < std::sqrt(0.5) ? 1 : 0;
    }
    EXPECT_NEAR(inner, 200, 12);
    EXPECT_EQ(points, ball->spread(400));
}

TEST(PlantRegion, WhatIsNoCovarianceIsRefused) {
    const Plant plant = Fopdt{.K = 1, .T = 1, .L = 1};
    for (const auto& matrix : {std::vector<std::vector<double>>{}, {{-1.0}}, {{NAN}}, {{1.0, 0.0}}}) {
        const auto region = PlantRegion::of_covariance(plant, {"K"}, matrix);
        ASSERT_FALSE(region.has_value());
        EXPECT_EQ(region.error().kind, ErrorKind::numerical_failure);
    }
}

}  // namespace
}  // namespace tunewright
