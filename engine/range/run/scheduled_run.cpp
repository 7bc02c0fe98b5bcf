#include "engine/range/run/scheduled_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/number_text.h"
#include "engine/numerics/ode_integrator.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/step_polynomial.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/range/run/profile.h"
#include "engine/range/run/scheduled_law.h"
#include "engine/simulation/nonlinear/linearising_response.h"
#include "engine/simulation/nonlinear/plant_run.h"
#include "engine/simulation/run/delayed_input.h"

namespace tunewright::range {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMinShare = 1e-3;            // of a state's range: its least size for relative errors
constexpr int kEchoes = 4;                    // passages of a jump through the dead time at which steps end
constexpr double kSettledShare = 0.01;        // relative to the profile's size
constexpr double kMinReportedCoupling = 0.3;  // relative change of the gain from y to u by the moving settings
constexpr double kTimeTolerance = 1e-12;      // relative to the time: two times within it are equal

/// Sizes of the plant's states, u and y over the range.
struct Sizes {
    std::vector<double> x;
    double u = 0, y = 0;
};

Sizes sizes_over(const SteadyBranch& branch) {
    Sizes sizes;
    const auto& states = branch.states();
    sizes.x.assign(states.front().x.size(), 0.0);
    for (const SteadyState& state : states) {
        for (std::size_t i = 0; i < sizes.x.size(); ++i)
            sizes.x[i] = std::max(sizes.x[i], std::abs(state.x[i] - states.front().x[i]));
        sizes.u = std::max(sizes.u, std::abs(state.u - states.front().u));
        sizes.y = std::max(sizes.y, std::abs(state.y - states.front().y));
    }
    return sizes;
}

class ScheduleRunner {
public:
    ScheduleRunner(const SteadyBranch& branch, const Schedule& schedule, const Profile& profile,
                   const RunOptions& options, const SteadyState& start)
        : system_(branch.system()),
          along_parameter_(branch.range().along == Along::parameter),
          n_(start.x.size()),
          L_(system_.dead_time()),
          start_(start),
          profile_(profile),
          reader_(profile),
          options_(options),
          law_(schedule, branch.range().along),
          schedule_(schedule),
          integrator_(
              {.order = int(n_) + ScheduledLaw::kStates + 1,
               .rates = [this](double t, std::span<const double> z, std::span<double> dz) { return rates(t, z, dz); }},
              options.tolerance),
          echoes_(kEchoes),
          x_(std::size_t(system_.order())) {
        const Sizes sizes = sizes_over(branch);
        for (std::size_t i = 0; i < n_; ++i) integrator_.set_least_size(int(i), kMinShare * sizes.x[i]);
        integrator_.set_least_size(int(n_), kMinShare * std::max(sizes.u, 1e-6 * std::abs(start.u)));
        const double y = std::max({sizes.y, reader_.size(), 1e-6 * std::abs(start.y)});
        for (int i = 1; i < ScheduledLaw::kStates; ++i) integrator_.set_least_size(int(n_) + i, kMinShare * y);
        integrator_.set_least_size(int(n_) + ScheduledLaw::kStates, kInfinity);
    }

    ScheduledRun run() {
        std::vector<double> z = start_.x;
        z.insert(z.end(), {start_.u, start_.y, 0.0, 0.0});
        // At a jump at t = 0 the loop was at rest before.
        law_.begin_at(law_.place(std::span<const double>(z).subspan(n_), start_.y, start_.p));
        for (const ProfilePoint& point : profile_) echoes_.add(point.t, 0, slack(point.t));
        jump(z, 0);
        (void)echoes_.pass(slack(0));
        add_echo(0, 1);
        if (!integrator_.start(0, z)) return left_domain();
        sample();
        for (int steps = 0; integrator_.t() < options_.horizon; ++steps) {
            if (options_.stop.stop_requested()) return ended("The simulation was stopped.");
            if (steps == options_.max_steps)
                return ended("At t = " + text(integrator_.t()) + " the run has reached the limit of " +
                             std::to_string(options_.max_steps) + " steps.");
            if (!advance()) return std::move(result_);
        }
        return finish();
    }

private:
    static double slack(double t) { return kTimeTolerance * std::max(std::abs(t), 1e-300); }

    double set_point(double t, bool before) const { return along_parameter_ ? start_.y : reader_.at(t, before); }
    double set_point_slope(double t, bool before) const { return along_parameter_ ? 0 : reader_.slope(t, before); }
    double parameter(double t, bool before) const { return along_parameter_ ? reader_.at(t, before) : 0; }
    bool at_end(double t) const { return t >= step_end_; }

    std::span<const double> plant(std::span<const double> z, double t) {
        std::copy_n(z.begin(), n_, x_.begin());
        if (along_parameter_) x_[n_] = parameter(t, at_end(t));
        return x_;
    }

    struct Signals {
        double y = 0, place = 0, r = 0, command = 0, u = 0;
        IdealPid pid;
    };

    Signals signals(double t, std::span<const double> z) {
        Signals s;
        s.y = system_.output(plant(z, t));
        const auto law = z.subspan(n_, ScheduledLaw::kStates);
        s.r = set_point(t, at_end(t));
        s.place = law_.place(law, s.y, parameter(t, at_end(t)));
        s.pid = law_.settings(s.place);
        s.command = law_.command(s.pid, s.r, s.y, law);
        s.u = std::clamp(s.command, system_.u_min(), system_.u_max());
        return s;
    }

    bool rates(double t, std::span<const double> z, std::span<double> dz) {
        const Signals s = signals(t, z);
        if (!std::isfinite(s.command)) return false;
        const double w = L_ > 0 ? start_.u + history_.at(t - L_, at_end(t)) : s.u;
        rates_.resize(x_.size());
        if (!system_.rates(plant(z, t), w, rates_)) return false;
        std::copy_n(rates_.begin(), n_, dz.begin());
        law_.rates(s.pid, s.r, set_point_slope(t, at_end(t)), s.y, s.u - s.command,
                   z.subspan(n_, ScheduledLaw::kStates), dz.subspan(n_, ScheduledLaw::kStates));
        dz[n_ + ScheduledLaw::kStates] = std::abs(s.r - s.y);
        return true;
    }

    /// At a jump of the set point at t, I moves by the part that its weight leaves out.
    void jump(std::vector<double>& z, double t) {
        const double step = set_point(t, false) - (t > 0 ? set_point(t, true) : profile_start());
        if (step == 0) return;
        const double y = system_.output(plant(z, t));
        const IdealPid pid = law_.settings(law_.place(std::span<const double>(z).subspan(n_), y, parameter(t, true)));
        z[n_] -= (1 - pid.b) * pid.Kp * step;
    }
    double profile_start() const { return along_parameter_ ? start_.y : profile_.front().value; }

    void add_echo(double t, int passages) {
        if (L_ > 0) echoes_.add(t + L_, passages, slack(t + L_));
    }

    bool advance() {
        const double t = integrator_.t();
        double stop = options_.horizon;
        if (const auto next = echoes_.next()) stop = std::min(stop, *next);
        if (L_ > 0) stop = std::min(stop, t + L_);
        step_end_ = stop - slack(stop);
        const OdeStep outcome = integrator_.step(stop);
        if (outcome != OdeStep::made) return fail(outcome);
        const auto switched = switch_time();
        if (switched && integrator_.shorten(*switched) != OdeStep::made) return fail(OdeStep::stalled);
        keep_step();
        std::vector<double> z(integrator_.x().begin(), integrator_.x().end());
        bool again = false;
        if (switched) {
            change_row(z);
            again = true;
        }
        const double now = integrator_.t();
        if (const auto passages = echoes_.pass(now + slack(now))) {
            jump(z, now);
            add_echo(now, *passages + 1);
            again = true;
        }
        step_end_ = kInfinity;
        if (again && !integrator_.start(now, z)) return fail(OdeStep::left_domain);
        return true;
    }

    /// The first time in the last step at which the row is left.
    std::optional<double> switch_time() {
        std::vector<double> z(integrator_.x().begin(), integrator_.x().end());
        const auto leaves = [&](double t) {
            integrator_.at(t, z);
            return law_.leaves_row(signals(t, z).place);
        };
        if (!law_.leaves_row(signals(integrator_.t(), integrator_.x()).place)) return std::nullopt;
        const auto close = [](double before, double after) { return after - before <= slack(after); };
        const auto stays = [&](double t) { return !leaves(t); };
        return bisect({integrator_.t_before(), integrator_.t()}, stays, close).outside;
    }

    /// I changes by as much as the other parts, in the other direction.
    void change_row(std::vector<double>& z) {
        const Signals before = signals(integrator_.t(), z);
        law_.enter_row(before.place);
        const Signals after = signals(integrator_.t(), z);
        z[n_] += before.command - after.command;
        const double bump = std::abs(signals(integrator_.t(), z).command - before.command);
        result_.largest_bump = std::max(result_.largest_bump, bump);
        ++result_.switches;
        add_echo(integrator_.t(), 1);
    }

    void keep_step() {
        const double from = integrator_.t_before(), h = integrator_.t() - from;
        std::vector<double> z(integrator_.x().begin(), integrator_.x().end());
        std::array<double, 6> u{};
        for (std::size_t k = 0; k < 6; ++k) {
            const double t = k == 5 ? integrator_.t() : from + kSixPoints[k] * h;
            integrator_.at(t, z);
            const Signals s = signals(t, z);
            u[k] = s.u - start_.u;
            result_.limited = result_.limited || s.u != s.command;
            note_coupling(s);
        }
        if (L_ > 0) history_.add(StepPolynomial::through(from, h, u));
        sample();
    }

    /// Change of the gain from y to u by the moving settings, relative to that gain: Kp'(y) e/Kp.
    void note_coupling(const Signals& s) {
        if (schedule_.interpolation == Interpolation::steps || schedule_.rows.size() < 2 || along_parameter_) return;
        const double span = schedule_.rows.back().at - schedule_.rows.front().at, d = 1e-4 * span;
        const double slope = (law_.settings(s.place + d).Kp - law_.settings(s.place - d).Kp) / (2 * d);
        const double part = std::abs(slope * (s.r - s.y) / s.pid.Kp);
        if (part > coupling_) {
            coupling_ = part;
            coupled_at_ = s.place;
        }
    }

    void sample() {
        std::vector<double> z(integrator_.x().begin(), integrator_.x().end());
        const double step = options_.horizon / (options_.samples - 1);
        for (std::size_t k = result_.t.size(); int(k) < options_.samples; ++k) {
            const double t = int(k) + 1 == options_.samples ? options_.horizon : step * double(k);
            if (t > integrator_.t()) break;
            if (t < integrator_.t()) integrator_.at(t, z);
            const Signals s = signals(t, z);
            result_.t.push_back(t);
            result_.target.push_back(s.r);
            result_.y.push_back(s.y);
            result_.u.push_back(s.u);
            result_.at.push_back(s.place);
            result_.Kp.push_back(s.pid.Kp);
            result_.largest_error = std::max(result_.largest_error, std::abs(s.r - s.y));
            std::copy(integrator_.x().begin(), integrator_.x().end(), z.begin());
        }
    }

    bool fail(OdeStep outcome) {
        if (outcome == OdeStep::left_domain) {
            (void)left_domain();
            return false;
        }
        (void)ended("At t = " + text(integrator_.t()) + " the required steps are too short to continue.");
        return false;
    }

    ScheduledRun& left_domain() {
        const double t = integrator_.t();
        const double w = L_ > 0 ? start_.u + history_.at(t - L_, true) : start_.u;
        const auto x = plant(integrator_.x(), t);
        return ended("At t = " + text(t) + " the states leave the model's domain. " +
                     fault_ahead(system_, x, std::vector<double>(x.size(), 0.0), w, t));
    }

    ScheduledRun& ended(std::string why) {
        result_.ended = std::move(why);
        finish_figures();
        return result_;
    }

    void finish_figures() {
        result_.IAE = integrator_.x()[n_ + ScheduledLaw::kStates];
        if (coupling_ > kMinReportedCoupling)
            result_.warnings.push_back(
                {"schedule-coupling",
                 "The scheduling variable is a variable of the loop itself. In steady state the loop is as designed, "
                 "but during changes the moving settings change the gain from y to u by up to " +
                     figure_text(100 * coupling_, 2) + " %, at " + text(coupled_at_) +
                     ". The limits hold for slow changes; replace large steps by ramps."});
    }

    ScheduledRun finish() {
        finish_figures();
        if (!result_.y.empty())
            result_.settled = std::abs(result_.target.back() - result_.y.back()) <=
                              kSettledShare * std::max(reader_.size(), std::abs(start_.y) * 1e-12);
        return std::move(result_);
    }

    const NonlinearSystem& system_;
    bool along_parameter_;
    std::size_t n_;
    double L_;
    SteadyState start_;
    const Profile& profile_;
    ProfileReader reader_;
    const RunOptions& options_;
    ScheduledLaw law_;
    const Schedule& schedule_;
    OdeIntegrator integrator_;
    SignalHistory history_;  // of u - u(0)
    Echoes echoes_;
    std::vector<double> x_, rates_;
    double step_end_ = kInfinity, coupling_ = 0, coupled_at_ = 0;
    ScheduledRun result_;
};

}  // namespace

Expected<ScheduledRun> run_schedule(const SteadyBranch& branch, const Schedule& schedule, const Profile& profile,
                                    const RunOptions& options) {
    if (auto fault = profile_fault(profile)) return *fault;
    const auto start = rest_at(branch, profile.front().value);
    if (!start) return start.error();
    return ScheduleRunner(branch, schedule, profile, options, *start).run();
}

namespace {

constexpr double kSettledStepShare = 0.01;  // share of the step

Error none(std::string why) { return {ErrorKind::unsupported, "", std::move(why)}; }

Expected<double> slowest_loop(const SteadyBranch& branch, const Schedule& schedule) {
    double slowest = 0;
    for (const ScheduleRow& row : schedule.rows) {
        const auto state = branch.at(std::clamp(row.at, branch.low(), branch.high()));
        if (!state) return state.error();
        const auto plant = LinearPlant::make(branch.linearised(*state));
        if (!plant) return plant.error();
        const double gain = plant->integrators() > 0 ? 1 / std::abs(row.Kp) : plant->low_frequency_gain();
        slowest = std::max(slowest, row.Ti / std::abs(gain * row.Kp));
    }
    return slowest;
}

ScheduledRun run_of(LinearisingResponse response, const NonlinearSystem& system, double target, double horizon,
                    int samples) {
    ScheduledRun run;
    run.limited = response.limited;
    run.ended = std::move(response.ended);
    const double step = horizon / (samples - 1);
    double before = 0;
    for (std::size_t k = 0; k < response.even.y.size(); ++k) {
        const double y = system.y_steady() + response.even.y[k], error = std::abs(target - y);
        run.t.push_back(step * double(k));
        run.target.push_back(target);
        run.y.push_back(y);
        run.u.push_back(system.u_nominal() + response.even.u[k]);
        run.at.push_back(y);
        run.largest_error = std::max(run.largest_error, error);
        if (k > 0) run.IAE += 0.5 * step * (before + error);
        before = error;
    }
    run.settled = run.ended.empty() && before <= kSettledStepShare * std::abs(target - system.y_steady());
    return run;
}

}  // namespace

Expected<LinearisingPassage> run_linearising(const SteadyBranch& branch, const Schedule& schedule,
                                             const Profile& profile, const RunOptions& options) {
    if (branch.range().along == Along::parameter)
        return none("A parameter changes, and the nonlinear controller knows it.");
    if (profile.size() != 2 || profile[0].t != 0 || profile[1].t != 0)
        return none("Only single steps of the set point are simulated with it.");
    const auto start = rest_at(branch, profile.front().value);
    if (!start) return start.error();
    const auto system = NonlinearSystem::make(branch.plant_at(*start));
    if (!system) return system.error();
    const auto degree = relative_degree(*system);
    if (!degree) return none(degree.error().message);
    if (!zero_dynamics(*system).stable)
        return none(
            "The plant's zero dynamics are unstable at the start: a controller that linearises it lets its "
            "states grow without bound.");
    const auto tau = slowest_loop(branch, schedule);
    if (!tau) return tau.error();
    const TargetResponse target =
        target_of_poles(std::vector<std::complex<double>>(std::size_t(*degree), -*degree / *tau));
    const RunControl control{.stop = options.stop, .progress = {}, .now_ms = {}};
    LinearisingResponse response =
        simulate_linearising(*system, target, profile.back().value - profile.front().value,
                             {.horizon = options.horizon, .samples = options.samples}, control);
    return LinearisingPassage{
        run_of(std::move(response), *system, profile.back().value, options.horizon, options.samples), *tau};
}

}  // namespace tunewright::range
