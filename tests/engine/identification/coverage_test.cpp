// The stated errors are correct: joint 95 % regions of many simulated records compared with their plant.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "engine/identification/identify.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using testing::add_noise;
using testing::even_times;
using testing::first_order;
using testing::simulate;

constexpr int kSeeds = 200;
const double kRegion = boost::math::quantile(boost::math::chi_squared(3), 0.95);

struct Truth {
    double K, T, L;
};

/// d' C^-1 d for a 3 x 3 covariance; rows and columns are scaled, because K, T and L have different units.
double squared_distance(const std::vector<std::vector<double>>& C, const std::vector<double>& d) {
    Eigen::Matrix3d M;
    Eigen::Vector3d v;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        v[row] = d[i] / std::sqrt(C[i][i]);
        for (std::size_t j = 0; j < 3; ++j)
            M(row, static_cast<Eigen::Index>(j)) = C[i][j] / std::sqrt(C[i][i] * C[j][j]);
    }
    return v.dot(M.ldlt().solve(v));
}

/// The share of 200 records whose joint 95 % region holds the plant. `disturb` makes the record of one seed.
template <class Disturb>
double coverage(const Truth& plant, int samples, double spacing, double step_time, const Disturb& disturb) {
    int inside = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
        Record record =
            simulate(even_times(samples, spacing), 0, 0, {{step_time, 1}}, first_order(plant.K, plant.T, plant.L));
        disturb(record, seed);
        IdentifyOptions options;
        options.model = ModelChoice::fopdt;
        const auto model = identify(record, options, {});
        if (!model) continue;
        const auto& found = std::get<Fopdt>(model->plant);
        std::vector<double> error;
        for (const std::string& name : model->covariance.names)
            error.push_back(name == "K" ? found.K - plant.K : name == "T" ? found.T - plant.T : found.L - plant.L);
        inside += squared_distance(model->covariance.matrix, error) <= kRegion;
    }
    return static_cast<double>(inside) / kSeeds;
}

TEST(Coverage, WhiteNoiseIsWithin90To99Percent) {
    const auto share = [](double noise, int samples, double spacing) {
        return coverage({1.5, 12, 3}, samples, spacing, 16 * spacing,
                        [=](Record& record, int seed) { add_noise(record, noise, static_cast<unsigned>(seed)); });
    };
    for (const double noise : {0.02, 0.05, 0.2}) {
        EXPECT_GE(share(noise, 400, 0.25), 0.90) << noise;
        EXPECT_LE(share(noise, 400, 0.25), 0.99) << noise;
    }
    // A dead time of five samples.
    EXPECT_GE(share(0.05, 180, 0.6), 0.90);
    EXPECT_LE(share(0.05, 180, 0.6), 0.99);
}

TEST(Coverage, QuantisedRecordsAreAtLeast85Percent) {
    for (const double noise : {0.0, 0.01, 0.03}) {
        const double share = coverage({1.5, 12, 3.1}, 400, 0.25, 10, [=](Record& record, int seed) {
            constexpr double kGrid = 0.05;
            const double offset = kGrid * std::fmod(0.618034 * seed, 1.0);
            if (noise > 0) add_noise(record, noise, static_cast<unsigned>(seed));
            for (double& y : record.y) y = kGrid * std::round((y + offset) / kGrid);
        });
        EXPECT_GE(share, 0.85) << noise;
    }
}

TEST(Coverage, DriftingRecordsAreAtLeast85Percent) {
    for (const double drift : {0.001, 0.002, 0.005}) {
        const double share = coverage({1.5, 12, 3}, 400, 0.25, 25, [=](Record& record, int seed) {
            for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] += drift * record.t[i];
            add_noise(record, 0.03, static_cast<unsigned>(seed));
        });
        EXPECT_GE(share, 0.85) << drift;
    }
}

}  // namespace
}  // namespace tunewright
