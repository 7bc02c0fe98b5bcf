#include "engine/simulation/nonlinear/nonlinear_response.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/number_text.h"
#include "engine/numerics/ode_integrator.h"
#include "engine/numerics/sign_change.h"
#include "engine/simulation/linear/response_recorder.h"
#include "engine/simulation/nonlinear/nonlinear_loop.h"
#include "engine/simulation/nonlinear/plant_run.h"
#include "engine/simulation/run/delayed_input.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kCommandRounding = 1e-11;  // of the largest command: it must exceed a limit by this to have crossed it
constexpr double kMinLongStep = 4;          // in dead times: it is not worthwhile to iterate shorter steps
constexpr int kMaxPasses = 12;
constexpr double kPassTolerance = 0.1;     // of the tolerance: two iterations of a long step agree
constexpr double kLongStepPause = 50;      // dead times before long steps are tried again
constexpr int kMaxCrossings = 100;         // crossings without a whole step between them
constexpr double kMaxStillRatio = 100;     // if y and u have not moved since this fraction of the time, they stay
constexpr int kRestInterval = 32;          // steps between two searches for the loop's rest
constexpr double kMaxRestDistance = 0.05;  // of the largest deviation: the end is close enough to report the rest

/// One run: steps between borders, which are crossings of a limit, echoes of jumps, and the horizon.
class NonlinearRun {
public:
    NonlinearRun(const NonlinearSystem& system, const ParallelPid& controller, const StepInputs& in,
                 const NonlinearOptions& options)
        : options_(options),
          in_(in),
          loop_(system,
                PidLaw(controller, in.r, options.delta_r,
                       back_calculation_rate(system, controller, input_limits(system, options.actuator))),
                in, input_limits(system, options.actuator)),
          L_(system.dead_time()),
          integrator_(equations(), options.tolerance),
          recorder_(response_, options, in.r),
          z_(Index(loop_.order())),
          echoes_(passages_that_count(system, controller, options.tolerance)),
          stopping_(options.settled, L_) {}

    NonlinearResponse run() {
        if (begin()) {
            while (!over()) {
                if (!take_step()) break;
            }
        }
        return finish();
    }

private:
    // ---- equations ----------------------------------------------------------------------------------------------

    OdeSystem equations() {
        OdeSystem system{loop_.order(), [this](double t, std::span<const double> z, std::span<double> dz) {
                             return loop_.rates(region_, z, w_then(t), dz);
                         }};
        if (loop_.has_jacobian())
            system.jacobian = [this](double t, std::span<const double> z, std::span<double> J, std::span<double> ft) {
                const double slope = loop_.delayed() ? history_.slope(t - L_, at_step_end(t)) : 0;
                return loop_.jacobian(region_, z, w_then(t), slope, J, ft);
            };
        return system;
    }

    double slack() const { return 8 * kEpsilon * std::max(integrator_.t(), L_); }
    bool at_step_end(double t) const { return t >= step_end_ - slack(); }
    /// The plant's input, given L ago: before a jump for the step that ends there, after it for the one that begins.
    double w_then(double t) const { return loop_.delayed() ? history_.at(t - L_, at_step_end(t)) : 0; }

    // ---- one step -----------------------------------------------------------------------------------------------

    bool begin() {
        const auto& initial = options_.initial;
        const auto steady = loop_.system().x_steady();
        std::copy(steady.begin(), steady.end(), z_.begin());
        if (!initial.empty()) std::copy(initial.begin(), initial.end(), z_.begin());
        const double y0 = loop_.system().output(loop_.plant_states(z_)) - loop_.system().y_steady();
        loop_.law().rest(y0, std::span<double>(z_).subspan(Index(loop_.system().order())));
        largest_y_ = std::max(std::abs(in_.r), std::abs(y0));
        scale_y_ = std::max(largest_y_, size_of_effect(loop_.system(), in_.d));
        if (!std::isfinite(y0)) return fail(OdeStep::left_domain);
        region_ = loop_.region(z_, w_then(0));
        response_.limited = region_ != Region::inside;
        const auto out = loop_.output(region_, z_, w_then(0));
        largest_u_ = std::abs(out.u);
        largest_command_ = std::abs(out.command);
        update_sizes();
        if (!integrator_.start(0, z_)) return fail(OdeStep::left_domain);
        add_echo(0);
        if (!options_.horizon) look_for_rest();
        return true;
    }

    double next_stop() const {
        const double t = integrator_.t();
        double stop = options_.horizon.value_or(kInfinity);
        if (const auto next = echoes_.next(); next && *next < stop + slack()) stop = std::min(stop, *next);
        if (loop_.delayed() && !long_step() && t + L_ < stop - slack()) stop = t + L_;
        return stop;
    }

    /// True if a step beyond the dead time is worthwhile, although it then depends on itself.
    bool long_step() const {
        return loop_.delayed() && !history_.empty() && integrator_.next_length() > kMinLongStep * L_ &&
               integrator_.t() >= no_long_steps_before_ && !loop_.law().pure_derivative();
    }

    bool take_step() {
        step_end_ = next_stop();
        if (long_step()) history_.suppose_line(integrator_.t());
        const OdeStep outcome = integrator_.step(step_end_);
        ++steps_;
        if (outcome != OdeStep::made) return fail(outcome);
        if (!read_signals()) return fail(OdeStep::left_domain);
        if (loop_.delayed() && y_.h > L_ + slack() && !agree_with_itself()) return false;
        if (const auto crossing = find_crossing()) {
            if (++crossings_in_a_row_ > kMaxCrossings) return crowded();
            const OdeStep again = integrator_.shorten(*crossing);
            if (again != OdeStep::made || !read_signals()) return fail(again);
            keep_step();
            return cross();
        }
        crossings_in_a_row_ = 0;
        keep_step();
        const auto passages = echoes_.pass(integrator_.t() + slack());
        return passages ? pass_echo(*passages) : true;
    }

    /// Iterates a step longer than the dead time until its assumed input equals the resulting one; if this fails, the
    /// step is shortened to the dead time.
    bool agree_with_itself() {
        for (int pass = 0; pass < kMaxPasses; ++pass) {
            const StepPolynomial w = plant_input();
            double gap = 0;
            for (const double s : kSixPoints)
                gap = std::max(gap, std::abs(w.at(s) - history_.at(w.t + s * w.h, s > 0)));
            history_.suppose(w);
            if (gap <= kPassTolerance * options_.tolerance * std::max(largest_u_, std::abs(in_.d))) return true;
            const OdeStep again = integrator_.shorten(integrator_.t());
            if (again != OdeStep::made || !read_signals()) break;
        }
        no_long_steps_before_ = integrator_.t_before() + kLongStepPause * L_;
        const OdeStep cut = integrator_.shorten(integrator_.t_before() + L_);
        return (cut == OdeStep::made && read_signals()) || fail(cut);
    }

    StepPolynomial plant_input() const {
        StepPolynomial w = u_;
        w.c[0] += in_.d;
        return w;
    }

    /// Reads the last step's signals as polynomials.
    bool read_signals() {
        const double from = integrator_.t_before(), h = integrator_.t() - from;
        std::array<double, 6> y{}, command{};
        for (Index k = 0; k < 6; ++k) {
            const double t = k == 5 ? integrator_.t() : from + kSixPoints[k] * h;
            integrator_.at(t, z_);
            const auto out = loop_.output(region_, z_, w_then(t));
            if (!out.exists) return false;
            y[k] = out.y;
            command[k] = out.command;
        }
        y_ = StepPolynomial::through(from, h, y);
        command_ = StepPolynomial::through(from, h, command);
        u_ = region_ == Region::inside ? command_ : StepPolynomial::constant(from, h, loop_.limit(region_));
        for (const double c : command) largest_command_ = std::max(largest_command_, std::abs(c));
        return true;
    }

    void keep_step() {
        recorder_.add(y_, u_);
        if (loop_.delayed()) history_.add(plant_input());
        for (const double s : kSixPoints) note(y_.t + s * y_.h, y_.at(s), u_.at(s));
        update_sizes();
        if (!options_.horizon && steps_ % kRestInterval == 0) look_for_rest();
    }

    void note(double t, double y, double u) {
        largest_y_ = std::max(largest_y_, std::abs(y));
        largest_u_ = std::max(largest_u_, std::abs(u));
        if (std::abs(y - still_y_) > options_.settled * largest_y_ ||
            std::abs(u - still_u_) > options_.settled * largest_u_) {
            still_since_ = t;
            still_y_ = y;
            still_u_ = u;
        }
        if (!rest_) return;
        const double dy = std::abs(y - rest_->y), du = std::abs(u - rest_->u);
        stopping_.note(t, dy, largest_y_, du, largest_u_);
    }

    /// The law's states have the sizes of u and y.
    void update_sizes() {
        const int n = loop_.system().order();
        integrator_.set_least_size(n, std::max(largest_u_, largest_command_));
        for (int i = 1; i < loop_.law().order(); ++i) integrator_.set_least_size(n + i, largest_y_);
    }

    // ---- borders ------------------------------------------------------------------------------------------------

    std::optional<double> find_crossing() const {
        const ActuatorLimits& limits = loop_.limits();
        const double noise = kCommandRounding * largest_command_;
        const auto rise = [&](double limit, double sign) -> std::optional<double> {
            if (!std::isfinite(limit)) return std::nullopt;
            return first_crossing([&](double s) { return sign * (command_.at(s) - limit) - noise; }, 0, 1);
        };
        std::optional<double> up, down;
        if (region_ != Region::below) up = rise(limits.max, region_ == Region::inside ? 1 : -1);
        if (region_ != Region::above) down = rise(limits.min, region_ == Region::inside ? -1 : 1);
        if (!up && !down) return std::nullopt;
        const double s = std::min(up.value_or(2), down.value_or(2));
        return s < 1 ? command_.t + s * command_.h : integrator_.t();
    }

    bool cross() {
        response_.limited = true;
        if (region_ != Region::inside)
            region_ = Region::inside;
        else
            region_ = command_.at(1) > 0.5 * (loop_.limits().min + loop_.limits().max) ? Region::above : Region::below;
        if (!restart()) return false;
        add_echo(1);
        const auto passages = echoes_.pass(integrator_.t() + slack());
        return passages ? pass_echo(*passages) : true;
    }

    /// The plant's input jumps, and with a pure derivative the command jumps too.
    bool pass_echo(int passages) {
        step_end_ = kInfinity;
        const Region before = region_;
        if (loop_.law().pure_derivative()) region_ = loop_.region(integrator_.x(), w_then(integrator_.t()));
        response_.limited = response_.limited || region_ != Region::inside;
        add_echo(region_ == before ? passages + 1 : 0);
        return restart();
    }

    /// Adds the echo of a jump at the present time.
    void add_echo(int passages) {
        if (loop_.delayed()) echoes_.add(integrator_.t() + L_, passages, slack());
    }

    bool restart() {
        step_end_ = kInfinity;
        recorder_.border();
        z_.assign(integrator_.x().begin(), integrator_.x().end());
        return integrator_.start(integrator_.t(), z_) || fail(OdeStep::left_domain);
    }

    // ---- the end ------------------------------------------------------------------------------------------------

    void look_for_rest() {
        const auto x = loop_.plant_states(integrator_.x());
        std::vector<double> sizes;
        for (Index i = 0; i < x.size(); ++i) sizes.push_back(integrator_.size(int(i)));
        sizes.push_back(std::max(largest_u_, std::abs(in_.d)));
        auto rest = find_rest(loop_, in_, {x.begin(), x.end()},
                              std::clamp(u_.at(1), loop_.limits().min, loop_.limits().max), sizes);
        if (!rest) return;
        const bool same = rest_ && std::abs(rest->y - rest_->y) <= options_.settled * largest_y_ &&
                          std::abs(rest->u - rest_->u) <= options_.settled * largest_u_;
        if (!same) stopping_.start_again(integrator_.t());
        rest_ = std::move(rest);
    }

    bool over() {
        const double t = integrator_.t();
        if (options_.horizon && t >= *options_.horizon) return true;
        if (options_.stop.stop_requested()) {
            response_.ended = "The simulation was stopped.";
            return true;
        }
        if (!options_.horizon && settled()) {
            settled_ = true;
            return true;
        }
        if (t > 0 && std::abs(y_.at(1)) > kMaxResponseRatio * scale_y_) {
            response_.escaped = true;
            response_.ended =
                "At t = " + text(t) + " the output is unbounded: it is more than a million times the step's size.";
            return true;
        }
        if (!options_.horizon && t > kMaxStillRatio * (still_since_ + L_) && steps_ > kRestInterval) {
            response_.ended = "At t = " + text(t) + " y has stayed at " + text(y_.at(1)) +
                              " for 99 % of the time, although the control law would still move it.";
            return true;
        }
        if (steps_ >= options_.max_steps) {
            response_.ended = "At t = " + text(t) +
                              " the run has reached the limit "
                              "of " +
                              std::to_string(options_.max_steps) + " steps" +
                              (options_.horizon ? "." : ", and the loop is not at rest.");
            return true;
        }
        return false;
    }

    bool settled() const {
        if (!rest_) return false;
        if (!stopping_.has_settled(integrator_.t())) return false;
        const auto remaining = remaining_error_integral();
        if (!remaining) return true;
        return stopping_.tail_may_end(*remaining, in_.r - y_.at(1),
                                      std::abs(recorder_.error_integral()) + std::abs(*remaining));
    }

    /// Once the loop stays within its limits: the remaining change of the integral until rest.
    std::optional<double> remaining_error_integral() const {
        if (!rest_ || !rest_->within || !loop_.law().integrates() || region_ != Region::inside) return std::nullopt;
        return loop_.law().error_integral_to_rest(loop_.law_states(integrator_.x()),
                                                  loop_.law().integral_at_rest(rest_->u));
    }

    bool crowded() {
        response_.ended = "At t = " + text(integrator_.t()) +
                          " the command crosses the input's limit infinitely often: with this derivative action the "
                          "loop has no solution there. Give the derivative a filter.";
        return false;
    }

    bool fail(OdeStep outcome) {
        const double t = integrator_.t();
        if (outcome == OdeStep::stalled) {
            response_.ended =
                "At t = " + text(t) + " the required steps are too short to continue: the states change too fast.";
            return false;
        }
        response_.escaped = true;
        const double u = loop_.system().u_nominal() + (loop_.delayed() ? w_then(t) : u_.at(1) + in_.d);
        response_.ended = "At t = " + text(t) + " the states leave the model's domain. " +
                          fault_ahead(loop_.system(), loop_.plant_states(integrator_.x()),
                                      loop_.plant_states(integrator_.dx()), u, t);
        return false;
    }

    NonlinearResponse finish() {
        const double t = integrator_.t();
        response_.t_end = t;
        response_.loop.settles = options_.horizon ? t >= *options_.horizon : settled_;
        recorder_.finish(t, y_.at(1), u_.at(1));
        response_.loop.y_final = y_.at(1);
        response_.loop.u_final = u_.at(1);
        if (!options_.nodes || !response_.ended.empty() || t <= 0) return std::move(response_);
        look_for_rest();
        if (rest_ && std::abs(rest_->y - y_.at(1)) <= kMaxRestDistance * largest_y_ &&
            std::abs(rest_->u - u_.at(1)) <= kMaxRestDistance * largest_u_) {
            response_.loop.y_final = rest_->within && loop_.law().integrates() ? in_.r : rest_->y;
            response_.loop.u_final = rest_->u;
            if (const auto remaining = remaining_error_integral())
                response_.loop.error_integral_final = recorder_.error_integral() + *remaining;
        }
        return std::move(response_);
    }

    const NonlinearOptions& options_;
    StepInputs in_;
    NonlinearLoop loop_;
    double L_;
    Region region_ = Region::inside;
    SignalHistory history_;
    double step_end_ = kInfinity;
    OdeIntegrator integrator_;
    NonlinearResponse response_;
    ResponseRecorder recorder_;
    std::vector<double> z_;
    Echoes echoes_;
    double no_long_steps_before_ = 0;
    int crossings_in_a_row_ = 0;
    double still_since_ = 0, still_y_ = 0, still_u_ = 0;
    int steps_ = 0;
    StepPolynomial y_, u_, command_;
    std::optional<NonlinearRest> rest_;
    bool settled_ = false;
    double largest_y_ = 0, largest_u_ = 0, largest_command_ = 0, scale_y_ = 0;
    StoppingRule stopping_;
};

}  // namespace

NonlinearResponse simulate_nonlinear(const NonlinearSystem& system, const ParallelPid& controller,
                                     const StepInputs& inputs, const NonlinearOptions& options) {
    return NonlinearRun(system, controller, inputs, options).run();
}

}  // namespace tunewright
