#include "engine/simulation/relay/relay_cycle.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/simulation/relay/relay_refusal.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kMaxCycles = 400;
constexpr double kMaxNearDistance = 0.02;  // of the period: a run this close is converging to the cycle
constexpr double kSteadyTolerance = 1e-3;  // of the period
constexpr double kMinPart = 0.2;           // of a duration that must remain after a Newton step; longer steps are
                                           // halved
constexpr double kMinStep = 1e-6;          // of a Newton step: shorter ones do not help
constexpr int kMaxNewton = 40;
constexpr double kMinRelativeChange = 1e-15;   // relative change of the period: no further improvement is possible
constexpr double kStalledTolerance = 1e-11;    // below it, a change that is not halved is rounding
constexpr double kConvergedTolerance = 1e-10;  // required accuracy of a cycle
constexpr double kSwitchTolerance = 1e-8;      // of the period: the run must switch at the computed times
constexpr double kOnCycleTolerance = 1e-6;     // of the period: closer than this, the distance need not decrease from
                                               // cycle to cycle
constexpr double kMaxDistance = 0.2;           // of the period: the last run has diverged from the cycle
constexpr double kInstantTolerance = 1e-12;    // of the period
constexpr double kMaxTurns = 10'000;  // periods in the dead time; also the most switches in a dead time before the
                                      // relay is too fast

struct Durations {
    double t_plus = 0, t_minus = 0;
};

// Data on a cycle that Newton's method needs.
struct Switching {
    bool minus_at_jump = false, plus_at_jump = false;  ///< true: y jumps over the threshold instead of crossing it
};

// One complete cycle of a run, from u_plus to u_plus.
struct Cycle {
    Durations durations;
    Switching switching;
};

std::optional<Cycle> next_cycle(RelayRun& run, const RunControl& control) {
    Cycle cycle;
    const double start = run.t();
    double middle = start;
    bool first = true;
    while (const auto piece = run.next()) {
        if ((run.steps() & 1023) == 0 && control.stop.stop_requested()) return std::nullopt;
        if (!piece->switched) continue;
        const bool jump = piece->h == 0;
        if (first) {
            middle = piece->t_end;
            cycle.switching.minus_at_jump = jump;
            first = false;
            continue;
        }
        cycle.durations = {middle - start, piece->t_end - middle};
        cycle.switching.plus_at_jump = jump;
        return cycle;
    }
    return std::nullopt;
}

double distance(const Durations& a, const Durations& b) {
    return (std::abs(a.t_plus - b.t_plus) + std::abs(a.t_minus - b.t_minus)) / (b.t_plus + b.t_minus);
}

// The periodicity and switching conditions with their Jacobian at (x, t_plus, t_minus).
class ShootingProblem {
public:
    ShootingProblem(RelayMotion& motion, double dead_time, const RelayLevels& levels, const Switching& switching)
        : motion_(motion), L_(dead_time), levels_(levels), switching_(switching), n_(motion.states()) {}

    struct Point {
        std::vector<double> x;
        Durations durations;
    };

    /// A Newton step; false if the Jacobian is singular.
    bool improve(Point& point, double& relative_change) const {
        const int m = n_ + 2;
        std::vector<double> J(Index(m * m), 0.0), residual(Index(m), 0.0);
        const auto [t_plus, t_minus] = point.durations;
        const Half plus = half(point.x, t_plus, levels_.u_plus);
        const Half minus = half(plus.end, t_minus, levels_.u_minus);
        const std::vector<double> whole = matrix_product(minus.step.Phi, plus.step.Phi, n_);
        std::vector<double> carried(Index(n_), 0.0);
        multiply(minus.step.Phi, plus.end_rate, carried);
        for (int i = 0; i < n_; ++i) {
            for (int j = 0; j < n_; ++j) J[Index(i * m + j)] = whole[Index(i * n_ + j)] - (i == j ? 1 : 0);
            J[Index(i * m + n_)] = carried[Index(i)];
            J[Index(i * m + n_ + 1)] = minus.end_rate[Index(i)];
            residual[Index(i)] = minus.end[Index(i)] - point.x[Index(i)];
        }
        add_switch(point, plus, true, &J[Index(n_ * m)], residual[Index(n_)]);
        add_switch(point, plus, false, &J[Index((n_ + 1) * m)], residual[Index(n_ + 1)]);
        for (double& r : residual) r = -r;
        const auto change = solve(J, residual, m);
        if (!change) return false;
        double scale = 1;
        const double dp = (*change)[Index(n_)], dm = (*change)[Index(n_ + 1)];
        while (t_plus + scale * dp < kMinPart * t_plus || t_minus + scale * dm < kMinPart * t_minus) {
            scale /= 2;
            if (scale < kMinStep) return false;
        }
        for (int i = 0; i < n_; ++i) point.x[Index(i)] += scale * (*change)[Index(i)];
        point.durations.t_plus += scale * dp;
        point.durations.t_minus += scale * dm;
        relative_change = (std::abs(dp) + std::abs(dm)) / (t_plus + t_minus);
        return std::isfinite(relative_change);
    }

private:
    struct Half {
        HeldStep step;
        std::vector<double> end, end_rate;
    };

    Half half(const std::vector<double>& from, double t, double v) const {
        Half out{motion_.step(t), from, {}};
        motion_.advance(out.step, v, out.end);
        out.end_rate = motion_.rate(out.end, v);
        return out;
    }

    // The time of the relay's switch on the clock of the delayed input (0: u_plus arrives; t_plus: u_minus arrives), in
    // (0, P], with its derivatives.
    struct Phase {
        double s = 0, by_plus = 0, by_minus = 0;
    };
    Phase phase(const Durations& d, bool to_minus) const {
        const double P = d.t_plus + d.t_minus;
        const double raw = (to_minus ? d.t_plus : 0) - L_;
        double turns = std::ceil(-raw / P);
        if (raw + turns * P <= 0) turns += 1;
        return {raw + turns * P, turns + (to_minus ? 1 : 0), turns};
    }

    void add_switch(const Point& point, const Half& plus, bool to_minus, double* row, double& residual) const {
        const Phase at = phase(point.durations, to_minus);
        const double t_plus = point.durations.t_plus, P = t_plus + point.durations.t_minus;
        if (to_minus ? switching_.minus_at_jump : switching_.plus_at_jump) {
            const bool early = at.s<t_plus / 2, late = at.s>(t_plus + P) / 2;
            const double target = early ? 0 : late ? P : t_plus;
            residual = at.s - target;
            row[n_] = at.by_plus - (early ? 0 : 1);
            row[n_ + 1] = at.by_minus - (late ? 1 : 0);
            return;
        }
        const bool in_plus = at.s <= t_plus;
        const double v = in_plus ? levels_.u_plus : levels_.u_minus;
        const Half here = half(in_plus ? point.x : plus.end, in_plus ? at.s : at.s - t_plus, v);
        const OutputMotion y = motion_.output(here.end, v);
        residual = y.y - (to_minus ? levels_.hysteresis : -levels_.hysteresis);
        std::vector<double> by_state = row_times(motion_.C(), here.step.Phi);
        row[n_] = y.slope * at.by_plus;
        row[n_ + 1] = y.slope * at.by_minus;
        if (!in_plus) {
            row[n_] += dot(by_state, plus.end_rate) - y.slope;
            by_state = row_times(by_state, plus.step.Phi);
        }
        for (int j = 0; j < n_; ++j) row[j] = by_state[Index(j)];
    }

    RelayMotion& motion_;
    double L_;
    RelayLevels levels_;
    Switching switching_;
    int n_;
};

std::optional<ShootingProblem::Point> fixed_point(const ShootingProblem& problem, ShootingProblem::Point point) {
    double change = 1;
    for (int i = 0; i < kMaxNewton && change > kMinRelativeChange; ++i) {
        const double before = change;
        if (!problem.improve(point, change)) return std::nullopt;
        if (change < kStalledTolerance && change >= before / 2) break;
    }
    if (change > kConvergedTolerance) return std::nullopt;
    return point;
}

// Runs one period from the fixed point, which must switch at the computed times. Adds the extremes of y.
bool verify(RelayMotion& motion, double L, const RelayLevels& levels, const RunControl& control,
            SteadyRelayCycle& cycle) {
    RelayRun run(motion, L, levels, state_at_switch(motion, L, levels, cycle));
    const double tolerance = kSwitchTolerance * cycle.Pu();
    double top = run.y(), bottom = top;
    int switches = 0;
    while (const auto piece = run.next()) {
        if ((run.steps() & 1023) == 0 && control.stop.stop_requested()) return false;
        for (const double y : {piece->y.at(0), piece->y.at(piece->h)}) {
            top = std::max(top, y);
            bottom = std::min(bottom, y);
        }
        if (const auto at = piece->y.extremum(); at && *at < piece->h) {
            top = std::max(top, piece->y.at(*at));
            bottom = std::min(bottom, piece->y.at(*at));
        }
        if (!piece->switched) continue;
        ++switches;
        const double expected = switches == 1 ? cycle.t_plus : cycle.Pu();
        if (std::abs(piece->t_end - expected) > tolerance) return false;
        if (switches == 2) break;
    }
    cycle.y_max = cycle.direction > 0 ? top : -bottom;
    cycle.y_min = cycle.direction > 0 ? bottom : -top;
    return switches == 2;
}

// Lets a run from rest settle, and solves for the cycle as soon as the run is close to it.
class Settling {
public:
    Settling(const LinearPlant& plant, const RelayLevels& levels, double direction, const RunControl& control)
        : plant_(plant),
          levels_(levels),
          control_(control),
          motion_(plant, direction),
          direction_(direction),
          run_(motion_, plant.dead_time(), levels, held_start(plant, levels)) {}

    Expected<SteadyRelayCycle> solve() {
        double previous = 1;
        int next_attempt = 2;
        for (int count = 1; count <= kMaxCycles; ++count) {
            const auto cycle = next_cycle(run_, control_);
            if (!cycle) return refusal();
            history_.push_back(cycle->durations);
            if (count < next_attempt) continue;
            next_attempt = count + std::max(1, count / 4);
            auto steady = attempt(*cycle);
            if (!steady) continue;
            const double now = distance(cycle->durations, {steady->t_plus, steady->t_minus});
            const bool arrived = now <= kMaxNearDistance && (now <= previous || now < kOnCycleTolerance);
            previous = now;
            if (!arrived && count + count / 4 < kMaxCycles) continue;
            if (!arrived && now > kMaxDistance) break;
            steady->settling_cycles = count_settling(*steady);
            return *steady;
        }
        return no_steady_cycle(plant_, kMaxCycles);
    }

private:
    Error refusal() const {
        if (control_.stop.stop_requested()) return {ErrorKind::cancelled, {}, "The simulation was stopped."};
        return no_oscillation({plant_, levels_, direction_, run_.end(), run_.u(), run_.y()});
    }

    std::optional<SteadyRelayCycle> attempt(const Cycle& last) {
        const ShootingProblem problem(motion_, plant_.dead_time(), levels_, last.switching);
        const auto point = fixed_point(problem, {run_.state_at_rise(), last.durations});
        if (!point) return std::nullopt;
        const double period = point->durations.t_plus + point->durations.t_minus;
        if (plant_.dead_time() > kMaxTurns * period) return std::nullopt;
        SteadyRelayCycle cycle;
        cycle.direction = direction_;
        cycle.t_plus = point->durations.t_plus;
        cycle.t_minus = point->durations.t_minus;
        cycle.x = point->x;
        if (!verify(motion_, plant_.dead_time(), levels_, control_, cycle)) return std::nullopt;
        return cycle;
    }

    int count_settling(const SteadyRelayCycle& steady) {
        const Durations target{steady.t_plus, steady.t_minus};
        while (static_cast<int>(history_.size()) < kMaxCycles && distance(history_.back(), target) > kSteadyTolerance) {
            const auto cycle = next_cycle(run_, control_);
            if (!cycle) break;
            history_.push_back(cycle->durations);
        }
        int count = static_cast<int>(history_.size());
        while (count > 0 && distance(history_[Index(count - 1)], target) <= kSteadyTolerance) --count;
        return count;
    }

    const LinearPlant& plant_;
    RelayLevels levels_;
    const RunControl& control_;
    RelayMotion motion_;
    double direction_;
    RelayRun run_;
    std::vector<Durations> history_;
};

}  // namespace

double relay_direction(const LinearPlant& plant) {
    const double sign = plant.low_frequency_gain() < 0 ? -1 : 1;
    return plant.unstable_poles() % 2 == 1 ? -sign : sign;
}

RelayState state_at_switch(RelayMotion& motion, double dead_time, const RelayLevels& levels,
                           const SteadyRelayCycle& cycle) {
    const double P = cycle.Pu(), L = dead_time;
    RelayState state;
    state.x = cycle.x;
    state.u = levels.u_plus;
    // The delayed input is later by L: it is s after the arrival of u_plus. A change that arrives at this very time is
    // still pending.
    const double now = kInstantTolerance * P;
    double s = std::ceil(L / P) * P - L;
    if (s <= now) s += P;
    motion.advance(motion.step(std::min(s, cycle.t_plus)), levels.u_plus, state.x);
    state.v = levels.u_plus;
    if (s > cycle.t_plus + now) {
        motion.advance(motion.step(s - cycle.t_plus), levels.u_minus, state.x);
        state.v = levels.u_minus;
    }
    for (int k = static_cast<int>(std::ceil(L / P)) + 1; k >= 0; --k) {
        const double arrives = L - k * P;
        if (arrives >= -now) state.pending.push_back({std::max(arrives, 0.0), levels.u_plus});
        if (k > 0 && arrives + cycle.t_plus >= -now)
            state.pending.push_back({std::max(arrives + cycle.t_plus, 0.0), levels.u_minus});
    }
    return state;
}

Expected<SteadyRelayCycle> steady_relay_cycle(const LinearPlant& plant, const RelayLevels& levels,
                                              const RunControl& control) {
    const double direction = relay_direction(plant);
    const bool both = plant.unstable_poles() > 0 || plant.integrators() < 0;
    const auto try_one = [&](double which) -> Expected<SteadyRelayCycle> {
        if (auto error = switches_without_end(plant, levels, which)) return *error;
        return Settling(plant, levels, which, control).solve();
    };
    auto first = try_one(direction);
    if (first || !both || first.error().kind == ErrorKind::cancelled) return first;
    auto second = try_one(-direction);
    return second ? second : first;
}

}  // namespace tunewright
