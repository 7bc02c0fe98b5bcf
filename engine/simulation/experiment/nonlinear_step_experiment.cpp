#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/simulation/experiment/nonlinear_experiments.h"
#include "engine/simulation/nonlinear/plant_run.h"

namespace tunewright {
namespace {

constexpr double kTolerance = 1e-9;
constexpr int kRows = 1001, kRowsAtRest = 100;  // before the step: they tell where y was
constexpr int kMaxSteps = 60000;
constexpr double kSettled = 1e-3;  // of y's movement, over the last quarter of the time
constexpr double kQuarter = 0.75;
constexpr double kAtRest = 0.02;     // times the slowest mode: what the states still move
constexpr double kMaxTimes = 60;     // of the plant's own time, until a stable plant must have settled
constexpr double kRampTimes = 12;    // of the dead time and the lags: an integrating plant's test
constexpr double kGrowthTimes = 3;   // of an unstable mode's time
constexpr double kOnTheAxis = 1e-7;  // of the fastest pole: an integrator
constexpr double kNoMovement = 1e-12;

/// What the plant's modes ask of a step test.
struct Modes {
    double lags = 0;     ///< dead time and lags of the stable modes, summed
    double slowest = 0;  ///< the longest of them
    double growth = 0;   ///< time constant of the fastest unstable mode; 0: none
    bool settles = true;
};

Modes modes_of(const NonlinearSystem& system) {
    const auto poles = eigenvalues(row_by_row(system.linearised().A), system.order());
    double fastest = 0;
    for (const auto pole : poles) fastest = std::max(fastest, std::abs(pole));
    Modes modes{system.dead_time(), 0, 0, true};
    for (const auto pole : poles) {
        if (pole.real() < -kOnTheAxis * fastest) {
            modes.lags += 1 / std::abs(pole.real());
            modes.slowest = std::max(modes.slowest, 1 / std::abs(pole.real()));
            continue;
        }
        modes.settles = false;
        if (pole.real() > kOnTheAxis * fastest) modes.growth = std::max(modes.growth, 1 / pole.real());
    }
    return modes;
}

double cut_to_limits(const NonlinearSystem& system, double du) {
    return std::clamp(du, system.u_min() - system.u_nominal(), system.u_max() - system.u_nominal());
}

/// y, recorded until it has settled or for as long as the modes ask.
class Record {
public:
    void add(const StepPolynomial& y) {
        steps_.push_back(y);
        for (const double s : kSixPoints) largest_ = std::max(largest_, std::abs(y.at(s)));
    }
    double largest() const { return largest_; }
    double end() const { return steps_.back().end(); }

    /// y has stayed near its last value over the last quarter.
    bool settled() const {
        const double last = steps_.back().at(1), from = kQuarter * end();
        for (auto step = steps_.rbegin(); step != steps_.rend() && step->end() > from; ++step)
            for (const double s : kSixPoints)
                if (std::abs(step->at(s) - last) > kSettled * largest_) return false;
        return true;
    }

    void rows(double t_end, double du, StepTest& test) const {
        std::size_t at = 0;
        for (int i = -kRowsAtRest; i < kRows; ++i) {
            const double t = t_end * i / (kRows - 1);
            if (i < 0) {
                test.t.push_back(t);
                test.u.push_back(0);
                test.y.push_back(0);
                continue;
            }
            while (at + 1 < steps_.size() && steps_[at].end() < t) ++at;
            test.t.push_back(t);
            test.u.push_back(du);
            test.y.push_back(steps_[at].at((t - steps_[at].t) / steps_[at].h));
        }
    }

private:
    std::vector<StepPolynomial> steps_;
    double largest_ = 0;
};

}  // namespace

Expected<StepTest> simulate_step_test(const NonlinearSystem& system, double du, const RunControl& control) {
    StepTest test;
    test.du = cut_to_limits(system, du);
    if (test.du == 0 || !std::isfinite(test.du))
        return Error{ErrorKind::unsupported, "plant/input",
                     "A step test of " + text(du) +
                         " cannot be made: the input's limits leave no room on that side of its nominal value. Step to "
                         "the other side."};
    const Modes modes = modes_of(system);
    const double longest = modes.settles      ? kMaxTimes * std::max(modes.lags, system.dead_time())
                           : modes.growth > 0 ? system.dead_time() + kGrowthTimes * (modes.growth + modes.lags)
                           : modes.lags > 0   ? kRampTimes * modes.lags
                                              : 1;
    PlantRun run(system, kTolerance);
    run.give(test.du);
    Record record;
    bool settled = false;
    for (int steps = 0; !settled && run.t() < longest; ++steps) {
        if (control.stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The step test was stopped."};
        if (steps == kMaxSteps)
            return Error{ErrorKind::unsupported, "plant",
                         "A step test needs more steps than are allowed: the plant's "
                         "dead time and modes are too far apart."};
        if (!run.step(longest)) return Error{ErrorKind::unsupported, "plant", "The step test ends early. " + run.why()};
        record.add(run.last());
        settled = modes.settles && !run.nothing_arrived() && run.t() > 4 * system.dead_time() &&
                  run.unrest() * modes.slowest < kAtRest && record.settled();
    }
    if (!(record.largest() > kNoMovement * std::abs(system.y_steady())) || record.largest() == 0)
        return Error{ErrorKind::unsupported, "plant/output",
                     "The output does not move after a step of the input of " + text(test.du) +
                         ": it does not depend on the input at this operating point."};
    test.settled = settled;
    record.rows(record.end(), test.du, test);
    return test;
}

}  // namespace tunewright
