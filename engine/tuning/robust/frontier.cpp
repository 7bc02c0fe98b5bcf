#include "engine/tuning/robust/frontier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/number_text.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/setpoint.h"
#include "engine/tuning/robust/pareto_front.h"

namespace tunewright {
namespace {

Expected<FrontierPoint> judged(const TuningProblem& tuning, double Ms, const IdealPid& controller) {
    EvaluateOptions figures;
    figures.points = 0;
    const auto evaluation = evaluate(PlantModel(tuning.plant), controller, figures);
    if (!evaluation) return evaluation.error();
    const Robustness& loop = evaluation->robustness;
    const Performance& does = evaluation->performance;
    return FrontierPoint{Ms,
                         controller,
                         does.load.IAE,
                         does.setpoint.IAE,
                         does.setpoint.overshoot_percent,
                         loop.Mks,
                         does.setpoint.TV,
                         loop.Ms,
                         loop.Mt};
}

std::optional<Error> unsuitable(const FrontierOptions& options) {
    if (options.Ms.from < options.Ms.to) return std::nullopt;
    return Error{ErrorKind::invalid_argument, "Ms/to",
                 "to is " + text(options.Ms.to) + " and from " + text(options.Ms.from) + "; to must be > from."};
}

}  // namespace

Expected<Frontier> frontier(const TuningProblem& tuning, const FrontierOptions& options, const RunControl& control) {
    if (auto error = unsuitable(options)) return *error;
    const auto now = [&] { return control.now_ms ? control.now_ms() : 0; };
    const double start = now();
    ParetoFront::FrontLimits terms{.options = {}, .Mt = options.Mt, .on_family = tuning.family.has_value()};
    terms.options.controller = options.controller;
    terms.options.filter = options.filter;
    ParetoFront front(tuning, terms);
    const RunControl inner{control.stop, nullptr, nullptr};
    Frontier answer;
    const int last = options.Ms.points - 1;
    // Downwards: a limit that cannot be met ends the curve, because no lower one can be met.
    for (int i = last; i >= 0; --i) {
        const double Ms = options.Ms.from + (options.Ms.to - options.Ms.from) * i / last;
        const auto design = front.at(Ms, inner);
        if (!design && (design.error().kind == ErrorKind::cancelled || answer.points.empty())) return design.error();
        if (!design) {
            answer.infeasible_below = answer.points.back().Ms;
            break;
        }
        IdealPid controller = design->controller;
        choose_setpoint(tuning.linear, {.overshoot = limits::kDefaultMaxOvershootPercent}, controller);
        auto point = judged(tuning, Ms, controller);
        if (!point) return point.error();
        answer.points.push_back(std::move(*point));
        if (control.progress)
            control.progress(
                {1 - static_cast<double>(i) / (last + 1), "tune", "Found the optimum at Ms " + text(Ms) + ".", {}});
    }
    std::ranges::reverse(answer.points);
    answer.compute_ms = now() - start;
    return answer;
}

Expected<Frontier> frontier(const AnalysedPlant& subject, const FrontierOptions& options, const RunControl& control) {
    if (subject.linear() == nullptr)
        return Error{ErrorKind::unsupported, "plant",
                     "Points of a frequency response have no response over time, so the load IAE is unknown. Give a "
                     "model, or tune with the method robust."};
    TuningProblem problem{*subject.nominal(), *subject.linear(), {}, {}};
    if (subject.family() != nullptr) problem.family = *subject.family();
    return frontier(problem, options, control);
}

namespace {

Expected<TunedController> tune_frontier(const TuningProblem& tuning, const FrontierOptions& options,
                                        const RunControl& control) {
    auto curve = frontier(tuning, options, control);
    if (!curve) return curve.error();
    const auto taken = std::ranges::min_element(
        curve->points, {}, [&](const FrontierPoint& point) { return std::abs(point.Ms - options.take); });
    TunedController result;
    result.controller = taken->controller;
    result.Ms_limit = taken->Ms;
    result.report = std::make_shared<Frontier>(std::move(*curve));
    return result;
}

}  // namespace

const OptionSet<FrontierOptions>& frontier_options() {
    static const auto options = [] {
        constexpr int kMaxPoints = 200;
        OptionSet<FrontierRange> range;
        range
            .field(&FrontierRange::from, "from", "Lowest limit on Ms.",
                   {.exclusive_minimum = 1, .maximum = limits::kMaxMs})
            .field(&FrontierRange::to, "to", "Highest limit on Ms.",
                   {.exclusive_minimum = 1, .maximum = limits::kMaxMs})
            .field(&FrontierRange::points, "points", "Number of limits, evenly spaced.",
                   {.minimum = 2, .maximum = kMaxPoints});
        using O = FrontierOptions;
        OptionSet<O> set;
        add_controller(set, {ControllerKind::PID, ControllerKind::PI});
        set.object(&O::Ms, "Ms", "The limits on Ms.", range)
            .number_or_word(&O::Mt, "Mt", "Limit on Mt at every point; tied: the same as on Ms.", "tied",
                            {.exclusive_minimum = 1, .maximum = limits::kMaxMs})
            .field(&O::take, "take", "The method's controller is the point whose limit is nearest to this value.",
                   {.exclusive_minimum = 1, .maximum = limits::kMaxMs})
            .object(&O::filter, "filter", "Second-order measurement filter, as in robust.", robust::filter_options(), 1)
            .main({"Ms", "Mt"});
        return set;
    }();
    return options;
}

TuningMethod frontier_method() {
    TuningMethod method;
    method.id = "frontier";
    method.title = "Front of robust optima";
    method.formula =
        "for each limit M: minimise the integral of |e| after a load step subject to max |S| <= M, max |T| <= Mt";
    method.source = "Garpinger and Hägglund (2008), A software tool for robust PID design, IFAC World Congress";
    method.needs = "any linear plant";
    method.validity = "as the method robust";
    method.bind(frontier_options(), tune_frontier);
    method.holds_family = true;
    method.compared = method.weighs_setpoint = false;
    return method;
}

}  // namespace tunewright
