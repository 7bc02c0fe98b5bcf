#include "engine/request/check/test_plan.h"

#include <algorithm>
#include <cmath>

#include "engine/check/thresholds.h"

namespace tunewright {
namespace {

constexpr double kGainError = 0.1;       // standard error of the gain, relative
constexpr int kSteps = 4;                // up, down, up, down: a drift then does not count as gain
constexpr double kErrorOfSteps = 0.935;  // sqrt(14)/4
constexpr double kGridSteps = 5;         // least size, of the measurement's or the output's grid
constexpr double kHoldPeriods = 2;       // of an oscillation: the slowest motion that is known
constexpr double kHoldLags = 5;          // of the lag at which the error's correlation has fallen to a third
constexpr double kLeastHoldRows = 20;
constexpr double kHoldIntegralTimes = 10;

/// The slowest motion of the loop that the record shows.
double hold_of(const check::LoopCheck& check) {
    double hold = kLeastHoldRows * check.quality.sample_time;
    if (!check.oscillation.periods.empty())
        hold = std::max(hold, kHoldPeriods * check.oscillation.periods.front().period);
    const check::Curve& r = check.autocorrelation;
    for (std::size_t k = 0; k < r.x.size(); ++k) {
        if (r.y[k] > 1.0 / 3) continue;
        hold = std::max(hold, kHoldLags * r.x[k]);
        break;
    }
    // A loop settles within some integral times; slower motions are moves of the set point or of the load.
    if (check.law.explained >= check::kKnownLaw && std::isfinite(check.law.Ti))
        hold = std::min(hold, std::max(kLeastHoldRows * check.quality.sample_time, kHoldIntegralTimes * check.law.Ti));
    return hold;
}

double range_of(const std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto [low, high] = std::ranges::minmax(values);
    return high - low;
}

}  // namespace

TestPlan plan_test(const check::LoopCheck& check) {
    TestPlan plan;
    plan.kind =
        check.cause.verdict == check::Verdict::manual ? TestPlan::Kind::output_steps : TestPlan::Kind::set_point_steps;
    plan.steps = kSteps;
    plan.hold = hold_of(check);
    plan.duration = (kSteps + 1) * plan.hold;
    // The level after a step is the mean of its second half. The gain follows from levels l1 - 2 l2 + 2 l3 - 2 l4 + l5,
    // over 4: 0.94 of the error of one.
    const double half = 0.5 * plan.hold, rows = std::max(2.0, half / check.quality.sample_time);
    const double independent = std::max(1.0, check.performance.independent * half / check.quality.duration);
    const double level_error =
        std::hypot(check.quality.noise / std::sqrt(rows), check.performance.variability / std::sqrt(independent));
    const double in_y = std::max(kErrorOfSteps * level_error / kGainError, kGridSteps * check.quality.y_step);
    const double y_range = range_of(check.trend.y), u_range = range_of(check.trend.u);
    const bool set_point = plan.kind == TestPlan::Kind::set_point_steps;
    // In manual the gain is unknown: output and measurement are taken to move by like shares of what the record shows.
    plan.size =
        set_point ? in_y : std::max(y_range > 0 ? in_y / y_range * u_range : 0, kGridSteps * check.quality.u_step);
    plan.beyond_seen = plan.size > (set_point ? y_range : u_range);
    plan.detail =
        std::string(set_point ? "In automatic, step the set point by " : "In manual, step the output by ") +
        (set_point ? check.units.y_text(plan.size) : check.units.u_text(plan.size)) + " up and down, " +
        std::to_string(kSteps) + " steps, each held for " + check.units.time_text(plan.hold) +
        ": with the noise and the load of this record the gain then has a standard " + "error of a tenth." +
        (plan.beyond_seen ? " That is more than the record's own range: ask the operator, or take smaller and "
                            "more steps."
                          : "");
    return plan;
}

}  // namespace tunewright
