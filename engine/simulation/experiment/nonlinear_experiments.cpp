#include "engine/simulation/experiment/nonlinear_experiments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/number_text.h"
#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/sign_change.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/linear/run_setup.h"
#include "engine/simulation/nonlinear/plant_run.h"
#include "engine/simulation/relay/relay_cycle.h"
#include "engine/simulation/relay/relay_refusal.h"

namespace tunewright {
namespace {

constexpr double kTolerance = 1e-9;
constexpr int kRows = 1001, kRowsAtRest = 100;  // rows, and rows before the step that show the initial y
constexpr int kMaxSteps = 60000;
constexpr double kMaxSettledMovement = 1e-3;  // of the range of y, over the last quarter of the time
constexpr double kSettledFromShare = 0.75;
constexpr double kAtRest = 0.02;               // multiple of the slowest mode's movement: the states are at rest
constexpr double kMaxTimes = 60;               // multiple of the plant's own time in which a stable plant must settle
constexpr double kRampTimes = 12;              // multiple of dead time and lags: length of an integrating plant's test
constexpr double kGrowthTimes = 3;             // multiple of an unstable mode's time constant
constexpr double kMaxRelativeRealPart = 1e-7;  // relative to the fastest pole: a pole with a smaller real part counts
                                               // as an integrator
constexpr double kMinMovement = 1e-12;

/// Times of the plant's modes that decide the length of a step test.
struct Modes {
    double lags = 0;     ///< dead time and sum of the lags of the stable modes
    double slowest = 0;  ///< the slowest stable lag
    double growth = 0;   ///< time constant of the fastest unstable mode; 0: none
    bool settles = true;
};

Modes modes_of(const NonlinearSystem& system) {
    const auto poles = eigenvalues(row_by_row(system.linearised().A), system.order());
    double fastest = 0;
    for (const auto pole : poles) fastest = std::max(fastest, std::abs(pole));
    Modes modes{system.dead_time(), 0, 0, true};
    for (const auto pole : poles) {
        if (pole.real() < -kMaxRelativeRealPart * fastest) {
            modes.lags += 1 / std::abs(pole.real());
            modes.slowest = std::max(modes.slowest, 1 / std::abs(pole.real()));
            continue;
        }
        modes.settles = false;
        if (pole.real() > kMaxRelativeRealPart * fastest) modes.growth = std::max(modes.growth, 1 / pole.real());
    }
    return modes;
}

double cut_to_limits(const NonlinearSystem& system, double du) {
    return std::clamp(du, system.u_min() - system.u_nominal(), system.u_max() - system.u_nominal());
}

/// Records y until it has settled, or for the time that the modes require.
class Record {
public:
    void add(const StepPolynomial& y) {
        steps_.push_back(y);
        for (const double s : kSixPoints) largest_ = std::max(largest_, std::abs(y.at(s)));
    }
    double largest() const { return largest_; }
    double end() const { return steps_.back().end(); }

    /// True if y has stayed near its last value over the last quarter.
    bool settled() const {
        const double last = steps_.back().at(1), from = kSettledFromShare * end();
        for (auto step = steps_.rbegin(); step != steps_.rend() && step->end() > from; ++step)
            for (const double s : kSixPoints)
                if (std::abs(step->at(s) - last) > kMaxSettledMovement * largest_) return false;
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
                         " is not possible: the input's nominal value is at its limit on that side. Step to the other "
                         "side."};
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
                         "A step test needs more than the allowed number of steps: the plant's dead time and modes "
                         "have too different time scales."};
        if (!run.step(longest)) return Error{ErrorKind::unsupported, "plant", "The step test ends early. " + run.why()};
        record.add(run.last());
        settled = modes.settles && !run.nothing_arrived() && run.t() > 4 * system.dead_time() &&
                  run.unrest() * modes.slowest < kAtRest && record.settled();
    }
    if (!(record.largest() > kMinMovement * std::abs(system.y_steady())) || record.largest() == 0)
        return Error{ErrorKind::unsupported, "plant/output",
                     "The output does not move after a step of the input of " + text(test.du) +
                         ", because it does not depend on the input at this operating point."};
    test.settled = settled;
    record.rows(record.end(), test.du, test);
    return test;
}

namespace {

constexpr int kMinCycles = 6, kMaxCycles = 40, kSteadyCycles = 2;
constexpr double kSteadyTolerance = 1e-6;        // relative change of period and swing between two cycles
constexpr double kNearlySteadyTolerance = 1e-2;  // after the largest number of cycles
constexpr int kRelayRows = 1600;
constexpr int kProbesPerStep = 16;                 // evaluations for the extremes of y within a step
constexpr double kMinSwingOverHysteresis = 1.001;  // multiple of the hysteresis: larger swings depend on the plant
constexpr double kMaxTimesWithoutSwitch = 100;     // multiple of the plant's own time without a switch
constexpr double kRowTolerance = 1e-9;             // of the rows' spacing: closer times are one row
constexpr double kCrossingRounding =
    1e-13;  // of the output's own size: smaller crossings of the threshold are rounding

Error unsupported(std::string message) { return {ErrorKind::unsupported, "plant", std::move(message)}; }

/// One test: the plant's run and the relay.
class RelayTest {
public:
    RelayTest(const NonlinearSystem& system, const LinearPlant& plant, const RelayLevels& levels, double direction)
        : system_(system),
          levels_(levels),
          direction_(direction),
          patience_(kMaxTimesWithoutSwitch * own_time(plant)),
          held_(held_start(plant, levels)),
          noise_(kCrossingRounding * (std::abs(system.y_steady()) + levels.hysteresis)),
          run_(system, kTolerance) {}

    std::optional<Error> oscillate(const RunControl& control) {
        run_.give(levels_.u_plus);
        inputs_.push_back({0, levels_.u_plus});
        for (int steps = 0; steps < kMaxSteps; ++steps) {
            if (control.stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The relay test was stopped."};
            if (run_.t() - inputs_.back().t > patience_) return latched();
            if (!run_.step(HUGE_VAL)) return unsupported("The relay test ends early. " + run_.why());
            if (!look()) return unsupported("The relay test ends early. " + run_.why());
            if (cycles() >= kMinCycles && steady(kSteadyTolerance)) return std::nullopt;
            if (cycles() >= kMaxCycles)
                return steady(kNearlySteadyTolerance)
                           ? std::nullopt
                           : std::optional(unsupported("After " + std::to_string(kMaxCycles) +
                                                       " cycles the oscillation is still not steady. Try another "
                                                       "hysteresis or amplitude."));
        }
        return unsupported("The relay switches too fast for the allowed number of steps. Give a larger hysteresis.");
    }

    Expected<NonlinearRelayTest> result() const {
        NonlinearRelayTest test;
        const auto last = std::size_t(cycles() - 1);
        test.Pu = periods_[last];
        const double a = swings_[last], d = 0.5 * (levels_.u_plus - levels_.u_minus), h = levels_.hysteresis;
        if (a < kMinSwingOverHysteresis * h)
            return unsupported("The output reverses as soon as the relay switches, at y = " + text(h) +
                               ", so only the hysteresis determines the period, and the test shows no ultimate gain. "
                               "Plants that respond at once, without dead time, have none.");
        test.Ku = 4 * d / (std::numbers::pi * std::sqrt(a * a - h * h));
        test.reversed = direction_ < 0;
        record(test.record);
        return test;
    }

private:
    struct Input {
        double t = 0, u = 0;
    };

    int cycles() const { return int(periods_.size()); }

    /// Finds the relay's switches within the last step.
    bool look() {
        double from = 0;
        while (!run_.nothing_arrived() && run_.t() > held_) {
            const bool high = run_.u() == levels_.u_plus;
            const StepPolynomial& y = run_.last();
            const double sign = high ? direction_ : -direction_;
            const auto s =
                first_crossing([&](double at) { return sign * y.at(at) - levels_.hysteresis - noise_; }, from, 1);
            if (!s) break;
            const double t = *s < 1 ? y.t + *s * y.h : run_.t();
            // The switch would reach the plant within this step.
            const bool at_once = t + system_.dead_time() <= run_.t();
            if (at_once && t < run_.t() && !run_.shorten(t)) return false;
            note_extremes(from, at_once ? 1 : *s);
            change(t, high ? levels_.u_minus : levels_.u_plus);
            if (at_once) {
                y_.push_back(run_.last());
                return true;
            }
            from = *s;
        }
        y_.push_back(run_.last());
        note_extremes(from, 1);
        return true;
    }

    void note_extremes(double from, double to) {
        for (int i = 0; i <= kProbesPerStep; ++i) {
            const double y = run_.last().at(from + (to - from) * i / kProbesPerStep);
            top_ = std::max(top_, y);
            bottom_ = std::min(bottom_, y);
        }
    }

    void change(double t, double u) {
        run_.give_at(t, u);
        inputs_.push_back({t, u});
        if (u != levels_.u_plus) return;
        if (rise_ >= 0) {
            periods_.push_back(t - rise_);
            swings_.push_back(0.5 * (top_ - bottom_));
        }
        rise_ = t;
        top_ = -HUGE_VAL;
        bottom_ = HUGE_VAL;
    }

    bool steady(double tolerance) const {
        const auto n = periods_.size();
        if (n < kSteadyCycles + 1) return false;
        for (std::size_t i = n - kSteadyCycles; i < n; ++i)
            if (std::abs(periods_[i] - periods_[i - 1]) > tolerance * periods_[i] ||
                std::abs(swings_[i] - swings_[i - 1]) > tolerance * swings_[i])
                return false;
        return true;
    }

    Error latched() const {
        const double y = direction_ * run_.y();
        return unsupported("With u at " + text(run_.u()) + " from its nominal value y is " + text(y) + " after " +
                           text(run_.t() - inputs_.back().t) +
                           " and the relay has not switched again, so there is no oscillation. " +
                           (std::abs(y) < levels_.hysteresis
                                ? "Lower the hysteresis below " + text(0.8 * std::abs(y)) + ", or raise the amplitude."
                                : "This relay cannot stabilise the plant."));
    }

    /// Rows at equal distances and at every switch, up to the last switch.
    void record(RelayRecord& out) const {
        const double end = inputs_.back().t;
        std::size_t step = 0, input = 0;
        const auto add = [&](double t) {
            while (step + 1 < y_.size() && y_[step].end() < t) ++step;
            while (input + 1 < inputs_.size() && inputs_[input + 1].t <= t) ++input;
            out.t.push_back(t);
            out.u.push_back(inputs_[input].u);
            out.y.push_back(y_[step].at((t - y_[step].t) / y_[step].h));
        };
        const double spacing = end / kRelayRows;
        std::size_t next = 1;
        for (int i = 0; i <= kRelayRows; ++i) {
            const double t = i == kRelayRows ? end : i * spacing;
            while (next < inputs_.size() && inputs_[next].t < t) {
                if (inputs_[next].t > out.t.back() + kRowTolerance * spacing) add(inputs_[next].t);
                ++next;
            }
            if (out.t.empty() || t > out.t.back() + kRowTolerance * spacing) add(t);
        }
    }

    const NonlinearSystem& system_;
    RelayLevels levels_;
    double direction_, patience_, held_, noise_;
    PlantRun run_;
    std::vector<StepPolynomial> y_;
    std::vector<Input> inputs_;
    std::vector<double> periods_, swings_;
    double rise_ = -1, top_ = -HUGE_VAL, bottom_ = HUGE_VAL;
};

}  // namespace

Expected<NonlinearRelayTest> simulate_relay_test(const NonlinearSystem& system, double amplitude, double hysteresis,
                                                 const RunControl& control) {
    const auto plant = LinearPlant::make(system.linearised());
    if (!plant) return plant.error();
    const RelayLevels levels{std::min(std::abs(amplitude), system.u_max() - system.u_nominal()),
                             std::max(-std::abs(amplitude), system.u_min() - system.u_nominal()), std::abs(hysteresis)};
    if (!(levels.u_plus > 0 && levels.u_minus < 0))
        return Error{ErrorKind::unsupported, "plant/input",
                     "A relay test changes the input to both sides of its nominal value, which is at a limit."};
    const double direction = relay_direction(*plant);
    if (auto error = switches_without_end(*plant, levels, direction)) {
        error->kind = ErrorKind::unsupported;
        error->where = "plant";
        error->message = "Without dead time a relay on this plant switches infinitely fast. Give it a hysteresis.";
        return *error;
    }
    RelayTest test(system, *plant, levels, direction);
    if (auto error = test.oscillate(control)) return *error;
    return test.result();
}

}  // namespace tunewright
