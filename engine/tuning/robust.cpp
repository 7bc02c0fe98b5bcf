#include "engine/tuning/robust.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/tuning/amigo.h"
#include "engine/tuning/robust/family.h"
#include "engine/tuning/robust/fast_search.h"
#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/plane_search.h"
#include "engine/tuning/robust/scan.h"

namespace tunewright {
namespace {

using namespace robust;

constexpr int kMostRounds = 10;  // of adding the worst plant found inside a region
constexpr double kAllowedExcess =
    2e-5;  // relative, of Ms and Mt on the independent grid: above it nothing is returned as a success

std::string shown(double value) {
    std::ostringstream out;
    out.precision(4);
    out << value;
    return out.str();
}

Objective objective_named(const std::string& name) {
    if (name == "load_ie") return Objective::load_ie;
    if (name == "setpoint_iae") return Objective::setpoint_iae;
    if (name == "weighted") return Objective::weighted;
    return Objective::load_iae;
}

/// The contract's filter rule. Error: a plant with neither dead time nor lags has no natural filter time.
Expected<FilterRule> filter_rule(const TuningProblem& problem, const MethodOptions& options, bool pid) {
    if (const auto Tf = options.number("filter/Tf")) return FilterRule{.Tf = *Tf, .Tf_over_Td = std::nullopt};
    if (const auto ratio = options.number("filter/Tf_over_Td")) {
        if (!pid)
            return Error{ErrorKind::invalid_argument, "filter/Tf_over_Td",
                         "A PI controller has no Td; give the filter as Tf."};
        return FilterRule{.Tf = std::nullopt, .Tf_over_Td = *ratio};
    }
    if (!pid) return FilterRule{};
    const LinearPlant& plant = problem.linear;
    const bool dead_time = plant.dead_time() > problem.dead_time_std.value_or(0);
    if (dead_time || plant.has_right_half_plane_zero() || plant.pole_excess() >= 3)
        return FilterRule{.Tf = std::nullopt, .Tf_over_Td = 0.1};
    const double T_ar = plant.lag_sum();
    if (T_ar > 0) return FilterRule{.Tf = 0.05 * T_ar, .Tf_over_Td = std::nullopt};
    return Error{ErrorKind::unbounded_optimum, "filter",
                 "This plant has neither dead time nor lags, so nothing bounds the speed of a PID and nothing suggests "
                 "a filter time. "
                 "Give filter {\"Tf\": ...}, e.g. the sampling time or the time constant of the sensor."};
}

/// Low gain of the right sign must push the output towards the set point: K/T of the plant's first slope decides.
double first_sign(const LinearPlant& plant) {
    const double sign = plant.low_frequency_gain() < 0 ? -1 : 1;
    return plant.unstable_poles() % 2 == 0 ? sign : -sign;
}

Problem make_problem(const TuningProblem& tuning, const MethodOptions& options, const FilterRule& filter, bool pid) {
    Problem problem;
    problem.plant = &tuning.linear;
    problem.pid = pid;
    problem.sign = first_sign(tuning.linear);
    problem.filter = filter;
    problem.limits.Ms = options.number("Ms").value_or(1.4);
    problem.limits.Mt = options.number("Mt").value_or(1.4);
    problem.limits.Mks = options.number("Mks");
    problem.limits.m_circle = options.text("constraint").value_or("circles") == "m_circle";
    problem.objective = objective_named(options.text("objective").value_or("load_iae"));
    problem.rho = options.number("rho").value_or(0.5);
    return problem;
}

/// The largest relative excess over a limit, on a grid that the search never saw.
double measured_excess(const Problem& problem, const Point& x) {
    double worst = -1;
    for (std::size_t i = 0; i < problem.plants(); ++i)
        worst = std::max(worst, excess_on(problem.plant_at(i), problem, x, {.step = 0.06, .density = 53}));
    return worst;
}

Problem tightened(Problem problem, double relative) {
    problem.limits.Ms = 1 + (problem.limits.Ms - 1) * (1 - relative);
    problem.limits.Mt = 1 + (problem.limits.Mt - 1) * (1 - relative);
    if (problem.limits.Mks) *problem.limits.Mks *= 1 - relative;
    return problem;
}

class ProgressReport {
public:
    ProgressReport(const Problem& problem, const RunControl& control) : problem_(problem), control_(control) {}

    bool operator()(const Point& x, double log_cost) {
        ++steps_;
        if (control_.progress) {
            Progress progress;
            progress.fraction = 1 - std::pow(0.9, steps_);
            progress.stage = "tune";
            progress.message = "robust design: " + std::to_string(steps_) + " improvements so far.";
            BestSoFar best{controller_at(problem_, x), std::exp(log_cost), problem_.limits.Ms, problem_.limits.Mt};
            if (problem_.objective != Objective::load_iae) best.load_IAE = std::exp(x[1] - x[0]);
            progress.best = best;
            control_.progress(progress);
        }
        return !control_.stop.stop_requested();
    }

private:
    const Problem& problem_;
    const RunControl& control_;
    int steps_ = 0;
};

/// Where the plane searches begin, as (Ti, Td).
using PlaneStart = std::optional<std::pair<double, double>>;

/// AMIGO's formulas on the reduced plant (the paper's section 4.2); empty where they do not apply.
PlaneStart amigo_start(const TuningProblem& tuning, bool pid) {
    MethodOptions options;
    options.set("controller", std::string(pid ? "PID" : "PI"));
    const auto tuned = amigo_method().tune(tuning, options, {});
    if (!tuned) return std::nullopt;
    return std::pair{tuned->controller.Ti, tuned->controller.Td};
}

std::optional<Found> search(const std::string& kind, const Sweep& sweep, const Problem& problem, PlaneStart start,
                            CostSurface* surface, const Report& report) {
    if (kind == "fast" && surface == nullptr) return fast_search(sweep, problem, report);
    if (!start || feasible_gains(sweep, start->first, start->second).empty()) {
        const auto points = scan(sweep);
        if (points.empty()) return std::nullopt;
        start = {std::exp(points.front().x[1]), problem.pid ? std::exp(points.front().x[2]) : 0};
    }
    if (kind == "nelder_mead") return nelder_mead_search(sweep, problem, start->first, start->second, report);
    auto gridded = grid_search(sweep, problem, start->first, start->second, surface, report);
    return kind == "grid" || (gridded && gridded->stopped) ? gridded : fast_search(sweep, problem, report);
}

/// The weighted objective measures each part against its own optimum. False: no controller meets the limits.
bool has_reference_optima(Problem& problem, const Sweep& sweep) {
    if (problem.objective != Objective::weighted) return true;
    for (const Objective part : {Objective::load_iae, Objective::setpoint_iae}) {
        Problem alone = problem;
        alone.objective = part;
        const auto found = fast_search(sweep, alone, {});
        if (!found) return false;
        (part == Objective::load_iae ? problem.load_optimum : problem.setpoint_optimum) = std::exp(found->log_cost);
    }
    return true;
}

/// Where the scan saw nothing: the feasible set may be a small one around the least peak, or belong to the other sign
/// of Kp.
std::optional<Found> search_from_least_peak(Problem& problem, const Report& report) {
    for (int attempt = 0; attempt < 2; ++attempt, problem.sign = -problem.sign) {
        const auto least = least_common_peak(problem);
        if (!least) continue;
        const Sweep sweep(problem, reference_frequency(problem));
        const auto start = feasible_near(sweep, least->x);
        if (!start) return std::nullopt;
        const SqpResult result = minimise(sweep, problem, *start, {}, report);
        if (std::isfinite(result.log_cost)) return Found{result.x, result.log_cost, false};
        return std::nullopt;
    }
    return std::nullopt;
}

/// From a design that was right for fewer plants; empty where it cannot be moved within the limits.
std::optional<Found> search_again(const Sweep& sweep, const Problem& problem, const Point& before,
                                  const Report& report) {
    const auto start = feasible_near(sweep, before);
    if (!start) return std::nullopt;
    bool stopped = false;
    const Report watch = [&](const Point& x, double cost) {
        stopped = report && !report(x, cost);
        return !stopped;
    };
    const SqpResult result = minimise(sweep, problem, *start, {}, watch);
    if (!std::isfinite(result.log_cost)) return std::nullopt;
    return Found{result.x, result.log_cost, stopped};
}

/// The smallest common limit at which a controller is really found, from 1 % above the least peak upward; empty if none
/// is.
std::optional<double> workable_limit(Problem problem, const LeastPeak& least) {
    for (double M = least.M * 1.01; M < 4 * least.M; M = 1 + (M - 1) * 1.1) {
        problem.limits.Ms = problem.limits.Mt = std::ceil(M * 1000) / 1000;
        if (feasible_near(Sweep(problem, reference_frequency(problem)), least.x)) return problem.limits.Ms;
    }
    return std::nullopt;
}

std::string on_plants(const Problem& problem) {
    return problem.others.empty() ? " on this plant"
                                  : " on all " + std::to_string(problem.plants()) + " plants looked at";
}

Error why_infeasible(const Problem& problem, const std::optional<LeastPeak>& least) {
    const std::string name = problem.pid ? "PID" : "PI";
    if (!least)
        return {ErrorKind::unstable_plant, "",
                "No " + name + " controller was found that stabilises " +
                    (problem.others.empty() ? "this plant" : "all of these plants") +
                    (problem.pid ? ". " : "; a PID might. ") +
                    "Check the signs and the unit of the dead time, or shorten the dead time."};
    const auto workable = workable_limit(problem, *least);
    if (problem.limits.Mks && (!workable || *workable <= std::min(problem.limits.Ms, problem.limits.Mt)))
        return {ErrorKind::no_feasible_controller, "Mks",
                "No " + name + " controller keeps Mks <= " + shown(*problem.limits.Mks) +
                    " together with the other limits. Raise Mks or leave it out."};
    if (workable && *workable <= std::min(problem.limits.Ms, problem.limits.Mt) && !problem.limits.m_circle)
        return {ErrorKind::numerical_failure, "",
                "Controllers within the limits exist, but none whose response could be computed. Check the units of "
                "the time constants and the dead time: "
                "they lie very far apart."};
    return {ErrorKind::no_feasible_controller, "",
            "No " + name + " controller keeps Ms <= " + shown(problem.limits.Ms) +
                " and Mt <= " + shown(problem.limits.Mt) + on_plants(problem) +
                (problem.limits.Mks ? " with Mks <= " + shown(*problem.limits.Mks) : std::string()) +
                ". The smallest common limit that works is Ms = Mt = " + shown(workable.value_or(least->M * 1.01)) +
                "; use that or more."};
}

/// Integral action makes C S = 1/P at omega = 0 on a plant without integrator.
std::optional<Error> check_Mks(const Problem& problem) {
    double least = 0;
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (problem.plant_at(i).integrators() == 0)
            least = std::max(least, 1 / std::abs(problem.plant_at(i).low_frequency_gain()));
    if (!problem.limits.Mks || *problem.limits.Mks > least) return std::nullopt;
    return Error{ErrorKind::no_feasible_controller, "Mks",
                 "Mks is " + shown(*problem.limits.Mks) +
                     ", but holding the output against a load takes |C S| = 1/|P(0)| = " + shown(least) +
                     " already at rest. Give a limit well above that."};
}

/// Searches, then holds the result against the independent grid; what exceeds a limit is searched again under tighter
/// ones. `before`: the design that some new plants have proved too bold.
Expected<Found> verified_search(const std::string& kind, Problem& problem, const PlaneStart& start,
                                CostSurface* surface, const RunControl& control, const Point* before) {
    const double reference = reference_frequency(problem);
    ProgressReport progress(problem, control);
    const Report report = [&](const Point& x, double cost) { return progress(x, cost); };
    const Sweep sweep(problem, reference);
    std::optional<Found> found;
    if (has_reference_optima(problem, sweep)) {
        if (before != nullptr) found = search_again(sweep, problem, *before, report);
        if (!found) found = search(kind, sweep, problem, start, surface, report);
    }
    if (control.stop.stop_requested() && !found)
        return Error{ErrorKind::cancelled, "", "The search was stopped before a feasible controller was found."};
    if (!found) found = search_from_least_peak(problem, report);
    if (!found.has_value()) return why_infeasible(problem, least_common_peak(problem));
    double tighter = 0;
    for (int round = 0; round < 4; ++round) {
        const double excess = measured_excess(problem, found->x);
        if (excess <= 0.5 * kAllowedExcess) return *found;
        if (!std::isfinite(excess) || round == 3) break;
        tighter += 1.5 * excess * problem.limits.Ms / (problem.limits.Ms - 1) + 1e-6;
        const Problem narrowed = tightened(problem, std::min(tighter, 0.5));
        const Sweep narrow_sweep(narrowed, reference);
        const auto again = minimise(narrow_sweep, narrowed, restore(narrow_sweep, found->x).value_or(found->x), {}, {});
        found->x = again.x;
        found->log_cost = again.log_cost;
    }
    return Error{ErrorKind::numerical_failure, "",
                 "The design found does not hold its limits on the independent frequency grid, so it is not returned. "
                 "Try another search or a filter with a longer Tf."};
}

Warning exceeded_inside(const std::vector<LinearPlant>& found, const Problem& problem, const Point& x) {
    double worst = 0;
    for (const auto& plant : found) worst = std::max(worst, excess_on(plant, problem, x, {}));
    return {"limit-exceeded-inside",
            "Between the plants on which the limits hold one was left on which a limit is "
            "exceeded by " +
                shown(100 * worst) + " %. Lower Ms and Mt a little, or narrow the ranges."};
}

void add_warnings(TunedController& result, const Problem& problem, const Point& x) {
    const double reference = reference_frequency(problem), Ti = std::exp(x[1]);
    if (Ti * reference < 1e-3 || (problem.pid && std::exp(x[2]) * reference > 1e3))
        result.warnings.push_back(
            {"degenerate-design", "The optimum tends to pure integral and derivative action (Ti " + shown(Ti) +
                                      "): a smaller Ms or a longer filter time gives an ordinary PID."});
}

Expected<TunedController> tune_robust(const TuningProblem& tuning, const MethodOptions& options,
                                      const RunControl& control) {
    const bool pid = options.text("controller").value_or("PID") == "PID";
    if (tuning.linear.integrators() < 0)
        return Error{ErrorKind::unstable_plant, "",
                     "The plant has a zero at s = 0: integral action cancels it and the loop cannot be stable. Use a "
                     "controller without integral action."};
    const auto filter = filter_rule(tuning, options, pid);
    if (!filter) return filter.error();
    Problem problem = make_problem(tuning, options, *filter, pid);
    auto others = other_members(tuning, first_sign);
    if (!others) return others.error();
    problem.others = *others;
    if (auto error = check_Mks(problem)) return *error;
    if (has_no_finite_optimum(problem))
        return Error{ErrorKind::unbounded_optimum, "filter",
                     "On this plant the gain can grow for ever within the limits, so there is no optimum: it has no "
                     "dead time to stop it. "
                     "Fix the filter with filter {\"Tf\": ...}, or limit the control activity with Mks."};
    CostSurface surface;
    const std::string kind = options.text("search").value_or("fast");
    const bool with_surface = options.boolean("surface").value_or(false);
    const PlaneStart start = kind == "fast" && !with_surface ? std::nullopt : amigo_start(tuning, pid);
    TunedController result;
    auto found = verified_search(kind, problem, start, with_surface ? &surface : nullptr, control, nullptr);
    for (int round = 0; found && !found->stopped && tuning.family; ++round) {
        const auto added = worst_inside(*tuning.family, problem, found->x, control.stop);
        if (added.empty()) break;
        if (round == kMostRounds) {
            result.warnings.push_back(exceeded_inside(added, problem, found->x));
            break;
        }
        others->insert(others->end(), added.begin(), added.end());
        problem.others = *others;
        const Point before = found->x;
        found = verified_search(kind, problem, start, nullptr, control, &before);
    }
    if (!found) return found.error();
    result.controller = controller_at(problem, found->x);
    result.partial = found->stopped;
    if (with_surface) result.surface = surface;
    add_warnings(result, problem, found->x);
    return result;
}

OptionDescription limit_option(const char* name, const char* sentence, std::optional<double> default_value) {
    OptionDescription option{.name = name, .type = OptionType::number, .sentence = sentence};
    if (default_value) option.default_value = *default_value;
    option.exclusive_minimum = default_value ? 1 : 0;
    if (default_value) option.maximum = 4;
    return option;
}

std::vector<OptionDescription> option_descriptions() {
    const auto choice = [](const char* name, const char* sentence, std::vector<std::string> choices) {
        OptionDescription option{.name = name, .type = OptionType::choice, .sentence = sentence};
        option.default_value = choices.front();
        option.choices = std::move(choices);
        return option;
    };
    OptionDescription Tf{
        .name = "Tf", .type = OptionType::number, .sentence = "Filter time constant, fixed.", .unit = "time"};
    Tf.exclusive_minimum = 0;
    OptionDescription ratio{
        .name = "Tf_over_Td", .type = OptionType::number, .sentence = "Filter time constant as a fraction of Td."};
    ratio.exclusive_minimum = 0;
    ratio.maximum = 10;
    OptionDescription filter{.name = "filter",
                             .type = OptionType::object,
                             .sentence =
                                 "Second-order measurement filter. PID default: Tf = 0.1 Td with a dead time, a "
                                 "right-half-plane zero or pole excess >= 3, else "
                                 "Tf = 0.05 times the sum of the lags minus the leads. PI default: none."};
    filter.fields = {Tf, ratio};
    filter.at_most_fields = 1;
    OptionDescription rho{.name = "rho",
                          .type = OptionType::number,
                          .sentence = "Weight of the load in the weighted objective; the set point has 1 - rho."};
    rho.default_value = 0.5;
    rho.minimum = 0;
    rho.maximum = 1;
    OptionDescription surface{.name = "surface",
                              .type = OptionType::boolean,
                              .sentence = "Also return the least cost over the (Ti, Td) plane."};
    surface.default_value = false;
    return {choice("controller", "PI or PID.", {"PID", "PI"}),
            limit_option("Ms", "Largest allowed sensitivity max |S|.", 1.4),
            limit_option("Mt", "Largest allowed complementary sensitivity max |T|.", 1.4),
            limit_option("Mks", "Largest allowed max |C S|: how strongly u may react.", std::nullopt),
            choice("constraint", "circles: the Ms and the Mt circle. m_circle: the smallest circle around both.",
                   {"circles", "m_circle"}),
            choice("objective", "What is minimised.", {"load_iae", "load_ie", "setpoint_iae", "weighted"}),
            rho,
            choice("search", "fast: scan and quadratic programming. nelder_mead, grid: the paper's searches.",
                   {"fast", "nelder_mead", "grid"}),
            surface,
            filter};
}

}  // namespace

TuningMethod robust_method() {
    TuningMethod method;
    method.id = "robust";
    method.title = "Robust optimum";
    method.formula =
        "minimise the integral of |e| after a load step subject to max |S| <= Ms, max |T| <= Mt and a stable loop";
    method.source = "Garpinger and Hagglund (2008), A software tool for robust PID design, IFAC World Congress";
    method.needs = "any linear plant";
    method.validity =
        "Ms, Mt in (1, 4]; a finite optimum needs a dead time, a right-half-plane zero, a fixed filter time or a limit "
        "on Mks";
    method.options = option_descriptions();
    method.tune = tune_robust;
    return method;
}

}  // namespace tunewright
