#include "engine/tuning/emulation/level_one.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/number_text.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/plant/plant.h"
#include "engine/simulation/experiment/nonlinear_experiments.h"
#include "engine/tuning/emulation/emulation.h"
#include "engine/tuning/emulation/emulation_problem.h"
#include "engine/tuning/model_based/imc.h"
#include "engine/tuning/registry.h"
#include "engine/tuning/ultimate/ziegler_nichols_ultimate.h"

namespace tunewright::emulation {
namespace {

constexpr double kTolerance = 1e-12;
constexpr int kMaxEvaluations = 600;
constexpr double kMinT = 1e-3;               // of the test's length: smallest T of the start
constexpr double kMinSumOfSquares = 1e-300;  // keeps the logarithm of an exact fit finite
constexpr double kFirstSteps = 0.1;          // in ln T, and of L relative to T

// K by least squares for a shape, and the remaining sum of squares.
struct Fit {
    double K = 0, left = 0;
};

Fit fit(const StepTest& test, double T, double L) {
    double ys = 0, ss = 0, yy = 0;
    for (std::size_t i = 0; i < test.t.size(); ++i) {
        const double s = test.t[i] > L ? -std::expm1(-(test.t[i] - L) / T) : 0;
        ys += s * test.y[i];
        ss += s * s;
        yy += test.y[i] * test.y[i];
    }
    return {ys / ss / test.du, std::max(0.0, yy - ys * ys / ss)};
}

double time_at(const StepTest& test, double share) {
    const double level = share * test.y.back();
    for (std::size_t i = 0; i < test.t.size(); ++i)
        if (std::abs(test.y[i]) >= std::abs(level)) return test.t[i];
    return test.t.back();
}

StepTest held_as_long_again(StepTest test) {
    const std::size_t rows = test.t.size();
    const double end = test.t.back();
    for (std::size_t i = 1; i < rows; ++i) {
        test.t.push_back(end + test.t[i]);
        test.y.push_back(test.y[rows - 1]);
    }
    return test;
}

// The first-order model with dead time of a simulated test, which has no noise and no offset: the least sum of squared
// differences over K, T > 0 and L >= 0; the test's last value is extended by the test's length. Error: unsupported for
// a test that has not settled.
Expected<Fopdt> first_order_model(const StepTest& recorded) {
    if (!recorded.settled || recorded.t.size() < 2)
        return Error{ErrorKind::unsupported, "plant",
                     "The simulated step test does not settle, so it has no first-order model: the plant integrates or "
                     "is unstable. Give methods for such plants (simc or lambda) in bounds_from, or give bounds."};
    const StepTest test = held_as_long_again(recorded);
    // Start: the two times of Smith's construction (28.3 % and 63.2 %).
    const double slow = time_at(test, 0.632), fast = time_at(test, 0.283);
    const double T0 = std::max(1.5 * (slow - fast), kMinT * test.t.back());
    const auto left = [&](const std::vector<double>& x, bool&) {
        const double T = T0 * std::exp(std::clamp(x[0], -7.0, 7.0)), L = T0 * std::max(0.0, x[1]);
        return std::log(fit(test, T, L).left + kMinSumOfSquares);
    };
    const auto found = find_local_minimum(LocalSearch::nelder_mead, left, {0, std::max(0.0, slow / T0 - 1)},
                                          {{kFirstSteps, kFirstSteps}, kTolerance, kMaxEvaluations});
    const double T = T0 * std::exp(std::clamp(found.x[0], -7.0, 7.0)), L = T0 * std::max(0.0, found.x[1]);
    return Fopdt{.K = fit(test, T, L).K, .T = T, .L = L};
}

constexpr double kMaxHysteresis = 3;    // relative to sqrt(a^2 - hysteresis^2), a the amplitude of y: a is then 1.05
                                        // times it
constexpr double kSlowIntegral = 4;     // Ti over the target's time, if the nonlinear controller gives Kp
constexpr double kMinAlphaOfTi = 1e-3;  // Ti = 0 is not allowed
constexpr double kHysteresis = 0.1;     // of the final change of y by the relay, for a plant without dead time

class FirstLevel {
public:
    FirstLevel(const EmulationProblem& problem, const RunControl& control)
        : problem_(problem), control_{control.stop, nullptr, nullptr} {}

    std::vector<LevelOneRow> rows() {
        for (const std::string& method : problem_.level_one.methods) {
            if (control_.stop.stop_requested()) break;
            if (method == kImc) {
                by_step_test();
                by_linear_model(method, imc(ImcExpansion::maclaurin));
            } else if (method == kZieglerNicholsUltimate) {
                by_oscillation();
            } else {
                by_linear_model(method, by_its_defaults(method));
            }
        }
        if (std::ranges::none_of(rows_, [](const LevelOneRow& row) { return row.controller.has_value(); }))
            by_linearising_law();
        return std::move(rows_);
    }

private:
    LevelOneRow& add(const std::string& method, const std::string& test, const std::string& how) {
        LevelOneRow row;
        row.method = method;
        row.test = test;
        row.title = find_method(method)->title + " (" + (problem_.with_derivative ? "PID, " : "PI, ") + how + ")";
        rows_.push_back(std::move(row));
        return rows_.back();
    }

    using Rule = std::function<Expected<TunedController>(const TuningProblem&)>;

    Rule imc(ImcExpansion expansion) const {
        ImcOptions options;
        options.lambda = problem_.level_one.lambda;
        options.filter_order = 1;
        // For a PI, the derivative is omitted from the PID: the first two terms of its series.
        options.expansion = problem_.with_derivative ? expansion : ImcExpansion::maclaurin;
        return [options](const TuningProblem& plant) { return tune_imc(plant, options); };
    }

    Rule ziegler_nichols(const UltimateOptions& point) const {
        ZieglerNicholsUltimateOptions options;
        options.controller = wanted();
        options.point = point;
        return [options](const TuningProblem& plant) { return tune_ziegler_nichols_ultimate(plant, options); };
    }

    /// Any method, for the wanted controller if it can be chosen.
    Rule by_its_defaults(const std::string& id) const {
        return [this, &method = *find_method(id)](const TuningProblem& plant) -> Expected<TunedController> {
            MethodOptions options;
            const std::string controller = wanted_word();
            if (named(method.options, kControllerOption) != nullptr) {
                if (const auto fault = misfit(method.options, kControllerOption, controller))
                    return Error{ErrorKind::unsupported, kControllerOption, *fault};
                options.set(kControllerOption, controller);
            }
            return method.tune(plant, options, control_);
        };
    }

    ControllerKind wanted() const { return problem_.with_derivative ? ControllerKind::PID : ControllerKind::PI; }
    std::string wanted_word() const { return word_of(words_of({wanted()}), wanted()); }

    /// Computes the settings that the rule gives on this plant.
    void settle(LevelOneRow& row, const Plant& plant, const LinearPlant& linear, const Rule& rule) const {
        const auto tuned = rule({plant, linear, std::nullopt, std::nullopt});
        if (!tuned) {
            row.error = tuned.error().message;
            return;
        }
        if (tuned->reduced_model) row.model = tuned->reduced_model;
        IdealPid pid = tuned->controller;
        if (tuned->nonlinear_integral || (!problem_.with_derivative && pid.Td > 0 && row.method != kImc)) {
            row.error = row.method + " has no linear " + wanted_word() + " controller.";
            return;
        }
        if (!problem_.with_derivative) pid = {.Kp = pid.Kp, .Ti = pid.Ti};
        row.controller = controller_at(problem_, {pid.Kp, pid.Ti, pid.Td, problem_.Tf});
    }

    void by_linear_model(const std::string& method, const Rule& rule) {
        LevelOneRow& row = add(method, "linear", "linearised model");
        settle(row, problem_.system->linearised(), *problem_.linear, rule);
    }

    void by_step_test() {
        LevelOneRow& row = add(kImc, "step", "step test");
        const auto test = simulate_step_test(*problem_.system, problem_.level_one.test_step, control_);
        if (!test) {
            row.error = test.error().message;
            return;
        }
        const auto model = first_order_model(*test);
        if (!model) {
            row.error = model.error().message;
            return;
        }
        row.model = *model;
        const auto linear = LinearPlant::make(*model);
        if (!linear) {
            row.error = linear.error().message;
            return;
        }
        settle(row, *model, *linear, imc(ImcExpansion::pade));
    }

    /// Uses the relay test, or the linearisation's ultimate point if the relay does not make the plant oscillate.
    void by_oscillation() {
        LevelOneRow& row = add(kZieglerNicholsUltimate, "relay", "relay test");
        const double amplitude = problem_.level_one.relay_amplitude;
        const double swing = amplitude * gain_size(*problem_.linear, plant_time(*problem_.linear));
        const double hysteresis =
            problem_.level_one.relay_hysteresis.value_or(problem_.system->dead_time() > 0 ? 0 : kHysteresis * swing);
        const auto test = simulate_relay_test(*problem_.system, amplitude, hysteresis, control_);
        if (!test) {
            row.error = test.error().message;
            by_linear_model(kZieglerNicholsUltimate, ziegler_nichols({}));
            return;
        }
        // The plant's own oscillation must exceed the hysteresis; otherwise the hysteresis determines the period.
        const double hysteresis_share = std::numbers::pi * test->Ku * hysteresis / (4 * amplitude);
        if (hysteresis_share > kMaxHysteresis) {
            row.error =
                "The plant does not oscillate by itself with a relay: y reverses as soon as the relay has switched.";
            by_linear_model(kZieglerNicholsUltimate, ziegler_nichols({}));
            return;
        }
        UltimateOptions point;
        point.Ku = test->reversed ? -test->Ku : test->Ku;
        point.Pu = test->Pu;
        settle(row, problem_.system->linearised(), *problem_.linear, ziegler_nichols(point));
    }

    /// If no rule applies, as for many unstable plants: the gains of the nonlinear controller for y and y', with a
    /// comparatively slow integral.
    void by_linearising_law() {
        LieDerivatives at;
        const int r = problem_.relative_degree;
        if (!lie_derivatives(*problem_.system, r, problem_.system->x_steady(), at) || at.of_g == 0) return;
        LevelOneRow& row = add(kEmulation, "linear", "the nonlinear controller's own gains");
        const auto& beta = problem_.target.beta;
        row.controller = controller_at(problem_, {1 / (beta[static_cast<std::size_t>(r)] * at.of_g),
                                                  kSlowIntegral * beta[1], r > 1 ? beta[1] : 0, problem_.Tf});
    }

    const EmulationProblem& problem_;
    RunControl control_;
    std::vector<LevelOneRow> rows_;
};

// The magnitudes of one parameter in all rows.
std::vector<double> magnitudes(const std::vector<IdealPid>& settings, double IdealPid::*member) {
    std::vector<double> values;
    for (const IdealPid& pid : settings)
        if (const double value = std::abs(pid.*member); value > 0 && std::isfinite(value)) values.push_back(value);
    return values;
}

NumberRange widened(const std::vector<double>& values, NumberRange alpha) {
    const auto [min, max] = std::ranges::minmax(values);
    return {alpha.low * min, alpha.high * max};
}

Error nothing_to_start_from(const std::vector<LevelOneRow>& rows) {
    std::string reasons;
    for (const LevelOneRow& row : rows)
        reasons += " " + row.title + ": " + (row.error.empty() ? "no integral action." : row.error);
    return {ErrorKind::no_feasible_controller, "bounds_from",
            "The first level has no settings from which to derive bounds; give bounds of Kp, Ti and Td." + reasons};
}

}  // namespace

Expected<std::vector<LevelOneRow>> level_one(const EmulationProblem& problem, const RunControl& control) {
    auto rows = FirstLevel(problem, control).rows();
    if (control.stop.stop_requested())
        return Error{ErrorKind::cancelled, "", "The job was cancelled before a design was found."};
    return rows;
}

Expected<Bounds> search_bounds(const EmulationProblem& problem, const std::vector<LevelOneRow>& rows) {
    std::map<std::string, NumberRange> ranges = problem.bounds;
    double sign = 0;  // that of the first row, because an unstable plant's static gain does not show it
    std::vector<IdealPid> settings;
    for (const LevelOneRow& row : rows) {
        const IdealPid* pid = row.controller ? std::get_if<IdealPid>(&*row.controller) : nullptr;
        if (pid == nullptr) continue;
        if (sign == 0) sign = pid->Kp < 0 ? -1 : 1;
        if (sign * pid->Kp > 0) settings.push_back(*pid);
    }
    const bool complete =
        ranges.contains("Kp") && ranges.contains("Ti") && (!problem.with_derivative || ranges.contains("Td"));
    if (!complete && settings.empty()) return nothing_to_start_from(rows);
    const NumberRange alpha = problem.level_one.alpha;
    if (!ranges.contains("Kp")) {
        const NumberRange size = widened(magnitudes(settings, &IdealPid::Kp), alpha);
        ranges["Kp"] = sign > 0 ? size : NumberRange{-size.high, -size.low};
    }
    if (!ranges.contains("Ti")) {
        const auto times = magnitudes(settings, &IdealPid::Ti);
        if (times.empty()) return nothing_to_start_from(rows);
        ranges["Ti"] = widened(times, {std::max(alpha.low, kMinAlphaOfTi), alpha.high});
    }
    if (problem.with_derivative && !ranges.contains("Td")) {
        const auto times = magnitudes(settings, &IdealPid::Td);
        ranges["Td"] = times.empty() ? NumberRange{0, ranges["Ti"].high / 4} : widened(times, alpha);
    }
    Bounds bounds;
    for (const std::string& name : unknowns(problem)) {
        bounds.low.push_back(ranges[name].low);
        bounds.high.push_back(ranges[name].high);
    }
    return bounds;
}

}  // namespace tunewright::emulation
