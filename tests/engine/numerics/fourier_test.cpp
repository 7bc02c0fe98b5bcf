// The transform against its defining sums, correlations against sums over pairs.
#include "engine/numerics/fourier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/numerics/statistics.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright {
namespace {

std::vector<double> drawn(std::size_t n, std::uint64_t seed) {
    test::Random random(seed);
    std::vector<double> x(n);
    for (double& value : x) value = random.uniform(-1, 3);
    return x;
}

TEST(Fourier, AgreesWithItsDefinition) {
    for (const std::size_t n : {1U, 2U, 7U, 60U, 97U, 128U}) {
        const auto x = drawn(n, n);
        const auto X = half_spectrum(x);
        ASSERT_EQ(X.size(), n / 2 + 1) << n;
        for (std::size_t k = 0; k < X.size(); ++k) {
            std::complex<double> sum = 0;
            for (std::size_t j = 0; j < n; ++j)
                sum += x[j] * std::polar(1.0, -2 * std::numbers::pi * double(j * k % n) / double(n));
            EXPECT_LT(std::abs(X[k] - sum), 1e-11 * double(n)) << n << " " << k;
        }
        const auto back = series_of(X, n);
        for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(back[j], x[j], 1e-12) << n << " " << j;
    }
}

TEST(Fourier, QuickLengthsHaveSmallFactors) {
    EXPECT_EQ(quick_length(1), 1U);
    EXPECT_EQ(quick_length(7), 8U);
    EXPECT_EQ(quick_length(97), 100U);
    EXPECT_EQ(quick_length(8640), 8640U);
}

TEST(Correlation, AgreesWithSumsOverPairs) {
    const auto a = drawn(150, 3), b = drawn(150, 4);
    const std::size_t longest = 40;
    const auto r = autocorrelation(a, longest);
    const auto c = crosscorrelation(a, b, longest);
    const double ma = mean(a), mb = mean(b);
    double aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        aa += (a[i] - ma) * (a[i] - ma);
        bb += (b[i] - mb) * (b[i] - mb);
    }
    for (std::size_t k = 0; k <= longest; ++k) {
        double own = 0, later = 0, earlier = 0;
        for (std::size_t i = 0; i + k < a.size(); ++i) {
            own += (a[i] - ma) * (a[i + k] - ma);
            later += (a[i] - ma) * (b[i + k] - mb);
            earlier += (a[i + k] - ma) * (b[i] - mb);
        }
        EXPECT_NEAR(r[k], own / aa, 1e-12);
        EXPECT_NEAR(c[longest + k], later / std::sqrt(aa * bb), 1e-12);
        EXPECT_NEAR(c[longest - k], earlier / std::sqrt(aa * bb), 1e-12);
    }
}

TEST(Correlation, OfAConstantSeriesIsDefined) {
    const std::vector<double> x(20, 5.0);
    EXPECT_EQ(autocorrelation(x, 3), (std::vector<double>{1, 0, 0, 0}));
    for (const double value : crosscorrelation(x, drawn(20, 1), 3)) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace tunewright
