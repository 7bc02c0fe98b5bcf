// The longest sample time of a schedule, compared with the sampled loops of its places.
#include "engine/range/schedule/design_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "engine/loop/peaks.h"
#include "engine/loop/sampled/sampled_loop.h"

namespace tunewright::range {
namespace {

std::shared_ptr<const RangeModel> furnace() {
    std::vector<RangePoint> points;
    for (const auto& [at, T] : {std::pair{0.0, 10.0}, {50.0, 4.0}, {100.0, 1.0}})
        points.push_back({at, family_of(Fopdt{2, T, 0.5})});
    return *model_of_points(points, Between::parameters);
}

/// Ms with the sample time divided by Ms without, for the linear plant at a place.
double raised(const RangeModel& model, double at, const IdealPid& pid, double Ts) {
    const LinearPlant plant = *model.at(at)->nominal;
    const Loop loop = *Loop::make(plant, to_parallel(pid));
    const SampledLoop sampled(plant, {.gains = to_parallel(pid), .Ts = Ts});
    return sampled.sensitivity_peak().value / find_peaks(loop, make_peak_grid(loop)).S.value;
}

TEST(ScheduleSampleTime, KeepsMsWithinFivePerCentWhereItIsTightest) {
    const auto model = furnace();
    const Schedule schedule{.interpolation = Interpolation::linear_in_gains,
                            .hysteresis = 0,
                            .rows = {{.at = 0, .Kp = 4, .Ti = 2, .Td = 0.2, .Tf = 0.02, .b = 1},
                                     {.at = 70, .Kp = 0.8, .Ti = 1.5, .Td = 0.2, .Tf = 0.02, .b = 1},
                                     {.at = 100, .Kp = 0.4, .Ti = 1, .Td = 0.1, .Tf = 0.02, .b = 1}}};
    const auto Ts = longest_sample_time(*model, schedule);
    ASSERT_TRUE(Ts);
    ASSERT_TRUE(*Ts);
    double max = 0;
    for (const double at : {0.0, 50.0, 70.0, 100.0})
        max = std::max(max, raised(*model, at, settings_at(schedule, at), **Ts));
    EXPECT_NEAR(max, 1.05, 2e-3);
}

TEST(ScheduleSampleTime, OfStepsCountsBothRowsInUseAtABorder) {
    const auto model = furnace();
    const ScheduleRow slow{.at = 0, .Kp = 0.4, .Ti = 4, .Td = 0, .Tf = 0, .b = 1};
    ScheduleRow fast = slow;
    fast.at = 50;
    fast.Kp = 1.2;
    Schedule steps{.interpolation = Interpolation::steps, .hysteresis = 10, .rows = {slow, fast}};
    const auto with_both = longest_sample_time(*model, steps);
    steps.rows.pop_back();
    const auto slow_alone = longest_sample_time(*model, steps);
    ASSERT_TRUE(with_both && *with_both && slow_alone && *slow_alone);
    EXPECT_LT(**with_both, 0.9 * **slow_alone);
    EXPECT_LE(raised(*model, 50, controller_of(fast), **with_both), 1.052);
}

}  // namespace
}  // namespace tunewright::range
