#include "engine/tuning/robust/robust.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "engine/loop/worst_case.h"
#include "engine/number_text.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/setpoint.h"
#include "engine/tuning/reaction_curve/amigo.h"
#include "engine/tuning/robust/degenerate_design.h"
#include "engine/tuning/robust/family.h"
#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/filter_rule.h"
#include "engine/tuning/robust/verified_search.h"

namespace tunewright {
namespace {

using namespace robust;

constexpr int kMaxRounds = 10;  // rounds in which the worst plant found inside a region is added

bool pid_wanted(const RobustOptions& options) { return options.controller == ControllerKind::PID; }

/// The problem without the plant and the sign of Kp.
DesignProblem make_problem(const RobustOptions& options, const FilterRule& filter) {
    DesignProblem problem;
    problem.pid = pid_wanted(options);
    problem.filter = filter;
    problem.limits.Ms = options.Ms;
    problem.limits.Mt = options.Mt;
    problem.limits.Mks = options.Mks;
    problem.limits.m_circle = options.constraint == Constraint::m_circle;
    problem.objective = options.objective;
    problem.rho = options.rho;
    return problem;
}

/// AMIGO's formulas on the reduced plant (the paper's section 4.2); empty if they do not apply.
PlaneStart amigo_start(const TuningProblem& tuning, ControllerKind controller) {
    const auto tuned = tune_amigo(tuning, {.controller = controller});
    if (!tuned) return std::nullopt;
    return std::pair{tuned->controller.Ti, tuned->controller.Td};
}

/// Integral action makes C S = 1/P at omega = 0 on a plant without integrator.
std::optional<Error> check_Mks(const DesignProblem& problem) {
    double min = 0;
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (problem.plant_at(i).integrators() == 0)
            min = std::max(min, 1 / std::abs(problem.plant_at(i).low_frequency_gain()));
    if (!problem.limits.Mks || *problem.limits.Mks > min) return std::nullopt;
    return Error{ErrorKind::no_feasible_controller, "Mks",
                 "Mks is " + text(*problem.limits.Mks) + ", but rejecting a load needs |C S| = 1/|P(0)| = " +
                     text(min) + " in steady state. Give a limit well above that."};
}

Warning exceeded_inside(const std::vector<LinearPlant>& found, const DesignProblem& problem, const DesignPoint& x) {
    double worst = 0;
    for (const auto& plant : found) worst = std::max(worst, excess_on(plant, problem, x, {}));
    return {"limit-exceeded-inside",
            "The limits hold on the plants of the design, but on a plant between them a limit is exceeded by " +
                text(100 * worst) + " %. Lower Ms and Mt slightly, or narrow the ranges."};
}

void add_warnings(TunedController& result, const DesignProblem& problem, const DesignPoint& x) {
    const double Td = problem.pid ? std::exp(x[2]) : 0;
    if (auto degenerate = degenerate_design(reference_frequency(problem), std::exp(x[1]), Td))
        result.warnings.push_back(std::move(*degenerate));
    if (problem.pid && !std::isfinite(x[2]))
        result.warnings.push_back(
            {"no-derivative", "No derivative time was found with which a PID is better than this PI: Td is 0."});
}

}  // namespace

namespace robust {

Expected<DesignProblem> nominal_problem(const TuningProblem& tuning, const RobustOptions& options) {
    if (tuning.linear.integrators() < 0)
        return Error{ErrorKind::unstable_plant, "",
                     "The plant has a zero at s = 0: integral action cancels it and the loop cannot be stable. Use a "
                     "controller without integral action."};
    const auto filter = filter_rule(tuning, options.filter, pid_wanted(options));
    if (!filter) return filter.error();
    DesignProblem problem = make_problem(options, *filter);
    problem.plant = &tuning.linear;
    problem.sign = first_sign(tuning.linear);
    return problem;
}

std::optional<Error> without_optimum(const DesignProblem& problem) {
    if (auto error = check_Mks(problem)) return error;
    if (!has_no_finite_optimum(problem)) return std::nullopt;
    return Error{
        ErrorKind::unbounded_optimum, "filter",
        "On this plant the gain is unbounded within the limits, because there is no dead time, so there is no optimum. "
        "Fix the filter time constant Tf, or give the plant its dead time; a single design may limit Mks instead."};
}

OptionSet<CertifyWish> certify_options() {
    OptionSet<CertifyWish> set;
    set.field(&CertifyWish::gap, "gap",
              "The proof is complete when no controller of the root box has a load IAE lower by more than this share.",
              {.minimum = 0.0005, .maximum = 0.5});
    return set;
}

OptionSet<RobustFilterOptions> filter_options() {
    using O = RobustFilterOptions;
    OptionSet<O> set;
    set.field(&O::Tf, "Tf", "Filter time constant, fixed.", {.unit = "time", .exclusive_minimum = 0});
    set.field(&O::Tf_over_Td, "Tf_over_Td", "Filter time constant as a fraction of Td.",
              {.exclusive_minimum = 0, .maximum = 10});
    return set;
}

Expected<DesignResult> search_everywhere(SearchKind kind, const TuningProblem& tuning, DesignProblem& problem,
                                         std::vector<LinearPlant>& others, const PlaneStart& start,
                                         CostSurface* surface, const RunControl& control, const DesignResult* before,
                                         std::vector<Warning>& warnings) {
    problem.others = others;
    auto found = verified_search(kind, problem, start, surface, control, before);
    for (int round = 0; found && !found->stopped && tuning.family; ++round) {
        const auto added = worst_inside(*tuning.family, problem, found->x, control.stop);
        if (added.empty()) break;
        if (round == kMaxRounds) {
            warnings.push_back(exceeded_inside(added, problem, found->x));
            break;
        }
        others.insert(others.end(), added.begin(), added.end());
        problem.others = others;
        const DesignResult last = *found;
        found = verified_search(kind, problem, start, nullptr, control, &last);
    }
    return found;
}

namespace {

Warning not_certified(std::string why) { return {"not-certified", std::move(why)}; }

/// Why there is no certificate; "" if there can be one.
std::string why_not(const DesignProblem& problem, const RobustOptions& options) {
    if (problem.measured != nullptr) return "The plant is known by points of its frequency response alone.";
    if (!problem.others.empty()) return "The limits hold on several plants, and a certificate is about one.";
    if (options.objective != Objective::load_iae) return "A certificate is about the load IAE. Leave out objective.";
    if (options.constraint != Constraint::circles)
        return "A certificate needs the circles of Ms and Mt. Leave out constraint.";
    if (options.Mks) return "A certificate has no limit on max |C S|. Leave out Mks.";
    return {};
}

}  // namespace

static void add_certificate(const DesignProblem& problem, const RobustOptions& options, double upper,
                            const RunControl& control, TunedController& result) {
    if (!options.certify.gap || result.partial) return;
    const auto refuse = [&](std::string why) { result.warnings.push_back(not_certified(std::move(why))); };
    if (std::string why = why_not(problem, options); !why.empty()) return refuse(std::move(why));
    const auto design = to_ideal(result.controller);
    if (!design) return refuse(design.error().message);
    const auto posed = certificate_problem(*problem.plant, *design, options.Ms, options.Mt, upper, pid_wanted(options));
    if (!posed) return refuse(posed.error().message);
    const double start = control.now_ms ? control.now_ms() : 0;
    auto proof = certify(*posed, {.gap = *options.certify.gap, .reach = {}}, control);
    if (!proof) return refuse(proof.error().message);
    auto report = std::make_shared<CertificateReport>();
    report->certificate = std::move(*proof);
    if (control.now_ms) report->seconds = (control.now_ms() - start) / 1000;
    result.report = std::move(report);
}

}  // namespace robust

Expected<TunedController> tune_robust(const TuningProblem& tuning, const RobustOptions& options,
                                      const RunControl& control) {
    auto posed = nominal_problem(tuning, options);
    if (!posed) return posed.error();
    DesignProblem problem = *posed;
    auto others = other_members(tuning, first_sign);
    if (!others) return others.error();
    problem.others = *others;
    if (auto error = without_optimum(problem)) return *error;
    CostSurface surface;
    const SearchKind kind = options.search;
    const bool with_surface = options.surface;
    const PlaneStart start =
        kind == SearchKind::fast && !with_surface ? std::nullopt : amigo_start(tuning, options.controller);
    TunedController result;
    const auto found = search_everywhere(kind, tuning, problem, *others, start, with_surface ? &surface : nullptr,
                                         control, nullptr, result.warnings);
    if (!found) return found.error();
    result.controller = controller_at(problem, found->x);
    result.Ms_limit = options.Ms;
    result.partial = found->stopped;
    if (with_surface) result.report = std::make_shared<CostSurface>(surface);
    add_warnings(result, problem, found->x);
    add_certificate(problem, options, std::exp(found->log_cost), control, result);
    return result;
}

namespace {

/// Points have no response over time, so the integrated error Ti/Kp replaces the integral of |e|.
Expected<TunedController> tune_on_points(const MeasuredPlant& plant, const RobustOptions& options,
                                         const RunControl& control) {
    if (!plant.phase_crossover())
        return Error{ErrorKind::unsupported, "plant/omega",
                     "The measured band ends at omega " + text(plant.high()) +
                         ", before the plant's phase has fallen through -180 degrees, so the gain is unbounded. "
                         "Measure higher frequencies."};
    const auto filter = explicit_filter(options.filter, pid_wanted(options));
    if (!filter) return filter.error();
    const FilterRule tied{.Tf = std::nullopt, .Tf_over_Td = limits::kDefaultTf_over_Td};
    DesignProblem problem = make_problem(options, filter->value_or(pid_wanted(options) ? tied : FilterRule{}));
    problem.measured = &plant;
    problem.sign = plant.gain_sign();
    problem.objective = Objective::load_ie;
    CostSurface surface;
    const bool with_surface = options.surface;
    const auto found =
        verified_search(options.search, problem, std::nullopt, with_surface ? &surface : nullptr, control, nullptr);
    if (!found) return found.error();
    TunedController result;
    result.controller = controller_at(problem, found->x);
    result.Ms_limit = options.Ms;
    result.partial = found->stopped;
    if (with_surface) result.report = std::make_shared<CostSurface>(surface);
    if (options.objective != Objective::load_ie)
        result.warnings.push_back({"objective-replaced",
                                   "A frequency response has no response over time: Kp/Ti is maximised instead of the "
                                   "requested objective."});
    add_warnings(result, problem, found->x);
    if (options.certify.gap) result.warnings.push_back(not_certified(why_not(problem, options)));
    return result;
}

void add_sliders(OptionSet<RobustOptions>& set) {
    OptionSlider limit{.from = 1.1, .to = 2.5, .step = 0.01, .label = "Robustness Ms", .low = "calm", .high = "sharp"};
    set.slider("Ms", limit);
    limit.label = "Robustness Mt";
    limit.moves_with = "Ms";
    set.slider("Mt", limit);
    set.slider("Mks", {.from = 0.2,
                       .to = 2,
                       .relative = true,
                       .logarithmic = true,
                       .label = "Noise limit Mks",
                       .low = "less noise",
                       .high = "more noise",
                       .reached = DesignFigure::Mks});
    OptionSlider filter = slider_about_value();
    filter.label = "Noise filter Tf";
    filter.low = "more noise", filter.high = "less noise";
    filter.group = "noise";
    filter.value_of = filter.reached = DesignFigure::Tf;
    set.slider("filter/Tf", filter);
    filter.label = "Noise filter Tf/Td";
    filter.from = 0.02, filter.to = 1;
    filter.relative = false;
    filter.value_of = filter.reached = DesignFigure::Tf_over_Td;
    set.slider("filter/Tf_over_Td", filter);
}

OptionSet<RobustOptions> described_options(const RobustOptions& defaults) {
    using O = RobustOptions;
    using enum Objective;
    OptionSet<O> set(defaults);
    add_controller(set, {ControllerKind::PID, ControllerKind::PI});
    set.field(&O::Ms, "Ms", "Largest allowed sensitivity max |S|.",
              {.exclusive_minimum = 1, .maximum = limits::kMaxMs});
    set.field(&O::Mt, "Mt", "Largest allowed complementary sensitivity max |T|.",
              {.exclusive_minimum = 1, .maximum = limits::kMaxMt});
    set.field(&O::Mks, "Mks",
              "Largest allowed max |C S|, the gain from measurement noise to "
              "u.",
              {.unit = "u/y", .exclusive_minimum = 0});
    set.choice(&O::constraint, "constraint",
               "circles: the Ms and the Mt circle. m_circle: the smallest circle around both.",
               Words<Constraint>{{"circles", Constraint::circles}, {"m_circle", Constraint::m_circle}});
    set.choice(
        &O::objective, "objective",
        "The cost to be minimised. For a plant known by points of its frequency response, which has no response over "
        "time, it is load_ie.",
        Words<Objective>{
            {"load_iae", load_iae}, {"load_ie", load_ie}, {"setpoint_iae", setpoint_iae}, {"weighted", weighted}});
    set.field(&O::rho, "rho", "Weight of the load in the weighted objective; the set point has 1 - rho.",
              {.minimum = 0, .maximum = 1});
    set.choice(&O::search, "search", "fast: scan and quadratic programming. nelder_mead, grid: the paper's searches.",
               Words<SearchKind>{
                   {"fast", SearchKind::fast}, {"nelder_mead", SearchKind::nelder_mead}, {"grid", SearchKind::grid}});
    set.field(&O::surface, "surface", "Also return the least cost over the (Ti, Td) plane.");
    set.object(&O::filter, "filter",
               "Second-order measurement filter. PID default: Tf = " + text(limits::kDefaultTf_over_Td) +
                   " Td with a dead time, a right-half-plane zero or "
                   "pole excess >= 3, else Tf = 0.05 times the sum of the lags minus the leads. PI default: none.",
               filter_options(), 1);
    set.object(&O::certify, "certify",
               "Also prove how much better any controller within the limits could be: the answer has a certificate.",
               certify_options());
    add_sliders(set.main({"Ms", "Mt", "Mks"}));
    return set;
}

}  // namespace

TuningMethod robust_method() {
    TuningMethod method;
    method.id = "robust";
    method.title = "Robust optimum";
    method.formula =
        "minimise the integral of |e| after a load step subject to max |S| <= Ms, max |T| <= Mt and a stable loop";
    method.source = "Garpinger and Hägglund (2008), A software tool for robust PID design, IFAC World Congress";
    method.needs = "any linear plant";
    method.validity = "Ms, Mt in (1, " + text(limits::kMaxMs) +
                      "]; a finite optimum needs a dead time, a right-half-plane zero, a fixed filter time or a limit "
                      "on Mks";
    method.bind(described_options({}), tune_robust);
    method.bind_for_device(described_options({}), tune_robust_for_device);
    method.holds_family = true;
    // An optimum for set points is designed for b = 1.
    method.overshoot = [](const MethodOptions& options) {
        const auto objective = options.text("objective");
        const bool sees_setpoint = objective == "setpoint_iae" || objective == "weighted";
        return sees_setpoint ? std::nullopt : std::optional(limits::kDefaultMaxOvershootPercent);
    };
    RobustOptions on_points;
    on_points.objective = Objective::load_ie;
    method.serve_on_points(described_options(on_points), tune_on_points);
    return method;
}

namespace {

constexpr int kMaxBuiltRounds = 5;           // rounds in which the worst plants found inside the regions are added
constexpr int kSamples = 48;                 // points of a region that are evaluated before the search from the worst
constexpr double kHoldDelayInSamples = 0.5;  // in samples: the mean delay of the hold

/// The plant with the additional delay of sampling: half a sample and the computation delay. The search starts from an
/// ideal design for it, which has a finite optimum with any sampling.
Expected<TuningProblem> delayed(const TuningProblem& tuning, const device::DeviceModel& device) {
    TuningProblem later = tuning;
    later.family.reset();
    const double extra = kHoldDelayInSamples * device.Ts + device.computation_delay;
    std::visit([&](auto& plant) { plant.L += extra; }, later.plant);
    auto linear = LinearPlant::make(later.plant);
    if (!linear) return linear.error();
    later.linear = std::move(*linear);
    if (later.dead_time_std) *later.dead_time_std = std::min(*later.dead_time_std, extra / 2);
    return later;
}

/// The product's filter if the request has none: the firmware's own if it is compiled in, and none shorter than a
/// sample time if forward differences would make it oscillate or unstable.
struct OwnFilter {
    std::optional<double> fixed = {};
    double shortest = 0;
};

OwnFilter filter_of(const device::DeviceModel& device) {
    if (device.product == nullptr) return {};
    const double unit = device.context.seconds_per_time;
    OwnFilter own;
    if (const auto Tf = product::compiled_filter_time(*device.product, device.context)) own.fixed = *Tf / unit;
    if (device.product->algorithm.derivative == DerivativeRule::filtered_forward) own.shortest = device.Ts;
    return own;
}

std::function<double(double)> filter_time(const TuningProblem& tuning, const RobustOptions& options,
                                          const device::DeviceModel& device) {
    const bool sampled = device.sampled();
    const auto given = explicit_filter(options.filter, options.controller == ControllerKind::PID);
    const OwnFilter own = given && *given ? OwnFilter{} : filter_of(device);
    if (own.fixed) return [Tf = *own.fixed](double) { return Tf; };
    const auto rule = filter_rule(tuning, options.filter, options.controller == ControllerKind::PID);
    if (!rule && !sampled) return {};
    const FilterRule held = rule ? *rule : FilterRule{.Tf = {}, .Tf_over_Td = limits::kDefaultTf_over_Td};
    if (held.Tf) return [Tf = std::max(*held.Tf, own.shortest)](double) { return Tf; };
    if (held.Tf_over_Td)
        return [ratio = *held.Tf_over_Td, min = own.shortest](double Td) { return std::max(ratio * Td, min); };
    return {};
}

/// For each region, the plant inside on which the implemented loop exceeds a limit most, if it does.
std::vector<LinearPlant> worst_on_device(const PlantFamily& family, const device::Law& law, const PeakLimits& limits,
                                         const RunControl& control) {
    const PlantCost excess = [&](const LinearPlant& plant) { return device::excess_on(plant, law, limits); };
    std::vector<LinearPlant> found;
    for (const PlantRegion& region : family.regions) {
        if (region.dimension() == 0) continue;
        auto starts = region.spread(kSamples);
        const auto ends = region.ends();
        starts.insert(starts.end(), ends.begin(), ends.end());
        const WorstCase worst = find_worst_case(region, excess, starts, control.stop);
        if (!(worst.cost > limits::kMaxRelativeExcessJudged)) continue;
        if (auto plant = LinearPlant::make(region.at(worst.z))) found.push_back(std::move(*plant));
    }
    return found;
}

}  // namespace

Expected<DeviceDesign> tune_robust_for_device(const TuningProblem& tuning, const RobustOptions& options,
                                              const device::DeviceModel& device, const RunControl& control) {
    if (const auto error = device::refuse_sampling(device, tuning.linear)) return *error;
    const auto start_problem = device.sampled() ? delayed(tuning, device) : Expected<TuningProblem>(tuning);
    if (!start_problem) return start_problem.error();
    RobustOptions ideal = options;
    ideal.objective = Objective::load_iae;
    ideal.search = SearchKind::fast;
    ideal.surface = false;
    ideal.certify = {};
    auto start = tune_robust(*start_problem, ideal, control);
    if (!start) return start.error();
    auto others = other_members(tuning, first_sign);
    if (!others) return others.error();
    std::vector<const LinearPlant*> plants{&tuning.linear};
    std::deque<LinearPlant> inside;  // found between the members; a deque, because their addresses must not change
    for (const LinearPlant& other : *others) plants.push_back(&other);

    device::Wish wish;
    wish.limits = {options.Ms, options.Mt, options.Mks};
    wish.pid = options.controller == ControllerKind::PID;
    wish.sign = start->controller.Kp < 0 ? -1 : 1;
    wish.filter_time = filter_time(tuning, options, device);
    wish.filter = wish.filter_time ? FilterType::measurement_second_order : FilterType::none;
    wish.start = start->controller;
    auto fitted = device::design(device, plants, wish, control);
    for (int round = 0; fitted && tuning.family && round < kMaxBuiltRounds; ++round) {
        auto added = worst_on_device(*tuning.family, fitted->law, wish.limits, control);
        if (added.empty()) break;
        for (LinearPlant& plant : added) plants.push_back(&inside.emplace_back(std::move(plant)));
        wish.start = fitted->controller;
        fitted = device::design(device, plants, wish, control);
    }
    if (!fitted) return fitted.error();
    DeviceDesign design{std::move(*start), std::move(*fitted)};
    design.tuned.controller = device::continuous(design.fitted.controller);
    design.tuned.warnings.clear();
    design.tuned.Ms_limit = options.Ms;
    if (options.objective != Objective::load_iae || options.constraint != Constraint::circles)
        design.tuned.warnings.push_back({"objective-replaced",
                                         "A design for an implemented controller minimises the load IAE with the "
                                         "circles of Ms and Mt, instead of the requested objective."});
    if (options.certify.gap)
        design.tuned.warnings.push_back(robust::not_certified(
            "A certificate is about the ideal law, and these settings are designed on the product's own. Leave out "
            "implement."));
    return design;
}

}  // namespace tunewright
