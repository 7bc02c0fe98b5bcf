// How one controller serves every plant of a family.
#include "engine/family_figures.h"

#include <gtest/gtest.h>

namespace tunewright {
namespace {

TEST(FamilyFigures, APeakFarBelowOneIsFoundToo) {
    // A plant without dynamics, P = K, under u = 3 (r - y): S = 1/(1 + 3 K) at every frequency, largest at K = 1.6.
    const Plant plant = Fopdt{2, 0, 0, {.K = FactorRange{0.8, 1.2}}};
    const RegionFigures figures = region_figures(family_of(plant), ParallelPid{3, 0, 0});
    EXPECT_EQ(figures.stable_fraction, 1);
    ASSERT_TRUE(figures.worst_Ms);
    EXPECT_NEAR(*figures.worst_Ms, 1 / (1 + 3 * 1.6), 1e-12);
    EXPECT_NEAR(std::get<Fopdt>(figures.worst_plant).K, 1.6, 1e-12);
}

}  // namespace
}  // namespace tunewright
