// Conclusions: their names, and both sides of their thresholds.
#include "engine/structure/conclusions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

namespace tunewright::structure {
namespace {

bool has(const Conclusions& conclusions, ConclusionCode code) {
    return std::ranges::find(conclusions, code, &Conclusion::code) != conclusions.end();
}

TEST(Conclusions, EachCodeHasANameOfItsOwn) {
    std::set<std::string> names;
    for (const ConclusionCode code : all_conclusion_codes()) names.insert(to_string(code));
    EXPECT_EQ(names.size(), all_conclusion_codes().size());
    EXPECT_EQ(all_conclusion_codes().size(), std::size_t(ConclusionCode::decoupler_fragile) + 1);
}

TEST(Conclusions, ACascadePaysFromOneAndAHalfTimesLessIaeOn) {
    CascadeFigures figures;
    figures.stable = true;
    figures.inner_load.IAE = figures.outer_load.IAE = 1;
    SingleLoop single;
    single.stable = true;
    single.outer_load.IAE = 1;
    for (const double IAE : {1.49, 1.51}) {
        single.inner_load.IAE = IAE;
        const auto found = conclusions_on(figures, CascadeDesign{}, &single);
        EXPECT_EQ(has(found, ConclusionCode::cascade_pays), IAE > 1.5);
        EXPECT_EQ(has(found, ConclusionCode::cascade_gains_little), IAE < 1.5);
    }
}

TEST(Conclusions, AJointDesignPaysByTheSumThatItWeighs) {
    CascadeFigures figures;
    figures.stable = true;
    figures.inner_load.IAE = figures.outer_load.IAE = figures.setpoint.IAE = 1;
    SingleLoop single;
    single.stable = true;
    single.inner_load.IAE = 4;
    single.outer_load.IAE = 0.9;
    single.setpoint.IAE = 0.8;
    CascadeDesign design;
    const auto pays = [&] { return has(conclusions_on(figures, design, &single), ConclusionCode::cascade_pays); };
    EXPECT_TRUE(pays());
    const Conclusion found = conclusions_on(figures, design, &single).front();
    EXPECT_DOUBLE_EQ(*found.figures.at("gain_outer"), 0.9);
    EXPECT_DOUBLE_EQ(*found.figures.at("gain_setpoint"), 0.8);
    design.joint = true;
    EXPECT_TRUE(pays()) << "4.9 over 2";
    design.weight_outer = 9;
    EXPECT_FALSE(pays()) << "12.1 over 10";
    design.joint = false;
    EXPECT_TRUE(pays());
}

TEST(Conclusions, AnInfiniteIaeIsComparedAsSuchAndGivesItsReason) {
    CascadeFigures figures;
    figures.stable = true;
    figures.inner_load.IAE = no_figure("infinite");
    SingleLoop single;
    single.stable = true;
    single.inner_load.IAE = 1;
    const Conclusion found = conclusions_on(figures, {}, &single).front();
    EXPECT_EQ(found.code, ConclusionCode::cascade_gains_little);
    EXPECT_EQ(found.figures.at("gain_inner").why, "infinite");
    single.inner_load.IAE = no_figure("infinite");
    EXPECT_TRUE(conclusions_on(figures, {}, &single).empty()) << "neither is less than the other";
}

TEST(Conclusions, LoopsThatAreNotStableAreNotCalledHardlyInteracting) {
    GainAnalysis gains;
    gains.pairings = {{.input_of = {0, 1}, .niederlinski = 1.0, .relative = {1, 1}, .at_crossover = {1, 1}}};
    InteractionFigures figures;
    figures.mu = 1.5;
    for (const bool stable : {true, false}) {
        figures.stable = stable;
        const auto found = conclusions_on(figures, gains, 0, 1.8, 1, 2);
        EXPECT_EQ(has(found, ConclusionCode::hardly_interacting), stable);
        EXPECT_EQ(has(found, ConclusionCode::better_than_blt), stable);
        EXPECT_EQ(has(found, ConclusionCode::unstable), !stable);
    }
}

TEST(Conclusions, PeaksAndSpeedAreComparedWithTheirLimits) {
    CascadeFigures figures;
    figures.stable = true;
    CascadeDesign design;
    design.Ms_valve = 1.5;
    figures.Ms_valve = 1.502;
    figures.speed_ratio = 3.01;
    EXPECT_TRUE(conclusions_on(figures, design, nullptr).empty()) << "a peak that prints as its limit holds it";
    figures.Ms_valve = 1.51;
    figures.speed_ratio = 2.99;
    const auto found = conclusions_on(figures, design, nullptr);
    ASSERT_TRUE(has(found, ConclusionCode::valve_peak_above) && has(found, ConclusionCode::inner_too_slow));
    EXPECT_EQ(*found.back().figures.at("limit"), 1.5);
    EXPECT_EQ(*found.back().figures.at("Ms"), 1.51);
}

TEST(Conclusions, APidDoesAsWellUpToTwoPercentMoreIae) {
    PredictorFigures figures;
    figures.stable = true;
    figures.load = StepFigures{.IAE = 1};
    for (const double IAE : {1.019, 1.021}) {
        const auto found = conclusions_on(figures, Figure(IAE), false, 1);
        EXPECT_EQ(has(found, ConclusionCode::pid_does_as_well), IAE < 1.02);
        EXPECT_EQ(has(found, ConclusionCode::predictor_pays), IAE > 1.02);
    }
    figures.dead_time_down = 0.24;
    EXPECT_TRUE(has(conclusions_on(figures, {}, false, 1), ConclusionCode::narrow_dead_time_window));
    figures.dead_time_down = 0.26;
    EXPECT_FALSE(has(conclusions_on(figures, {}, false, 1), ConclusionCode::narrow_dead_time_window));
}

TEST(Conclusions, UnstableLoopsHaveNoOtherConclusion) {
    const auto found = conclusions_on(CascadeFigures{}, CascadeDesign{}, nullptr);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(to_string(found[0].code), "unstable");
}

}  // namespace
}  // namespace tunewright::structure
