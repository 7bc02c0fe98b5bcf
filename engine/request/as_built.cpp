#include "engine/request/as_built.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/number_text.h"
#include "engine/tuning/robust/degenerate_design.h"

namespace tunewright {
namespace {

constexpr double kMaxUnsaidDifference = 2;  // percent; of the overshoot in percent of the step

constexpr const char* kNotIdeal = "The ideal loop has no such figure.";
constexpr const char* kNotBuilt = "The loop as built has no such figure.";

Figure percent_above(const Figure& built, const Figure& ideal) {
    if (built && ideal && *ideal != 0) return 100 * (*built / *ideal - 1);
    return no_figure(built ? kNotIdeal : kNotBuilt);
}

Figure points_above(const Figure& built, const Figure& ideal) {
    if (built && ideal) return *built - *ideal;
    return no_figure(built ? kNotIdeal : kNotBuilt);
}

Expected<BuiltLoop> loop_of(const Subject& subject, const built::Build& build, const built::Fitted& fitted,
                            const EvaluateOptions& options) {
    if (build.sampled()) return evaluate_sampled(subject, fitted.law, build.program, options);
    auto evaluation = evaluate(subject, built::continuous(fitted.controller), options);
    if (!evaluation) return evaluation.error();
    return BuiltLoop{evaluation->robustness, evaluation->performance, evaluation->responses, {}};
}

// The settings nearest in what counts: as robust as the ideal loop, and as quick as that allows.
Expected<built::Fitted> nearest(const Subject& subject, const built::Build& build, const IdealPid& pid,
                                const Evaluation& ideal, const Error& why, const RunControl& control) {
    const LinearPlant* plant = subject.linear();
    const Robustness& r = ideal.robustness;
    if (plant == nullptr || !r.stable || !r.Ms || !r.Mt || !pid.has_integral()) return why;
    built::Wish wish;
    constexpr double kLeast = 1.001;  // a peak of T that is 1 limits nothing
    wish.limits = {std::max(*r.Ms, kLeast), std::max(*r.Mt, kLeast), {}};
    wish.pid = pid.Td > 0;
    wish.sign = pid.Kp < 0 ? -1 : 1;
    wish.b = pid.b;
    if (pid.filter.type != FilterType::none && pid.Td > 0)
        wish.filter_time = [ratio = pid.filter.Tf / pid.Td](double Td) { return ratio * Td; };
    wish.start = pid;
    auto fitted = built::design(build, {plant}, wish, control);
    if (!fitted) return why;
    fitted->notes.insert(fitted->notes.begin(),
                         {"nearest-settings", std::string(build.product->name) +
                                                  " cannot be the method's controller. These settings have the least "
                                                  "load IAE that it reaches within the ideal loop's own Ms and Mt."});
    return fitted;
}

}  // namespace

Expected<AsBuilt> judge_as_built(const Subject& subject, const built::Build& build, built::Fitted fitted,
                                 const EvaluateOptions& options, const Evaluation& ideal) {
    auto loop = loop_of(subject, build, fitted, options);
    if (!loop) return loop.error();
    AsBuilt built{std::move(fitted), std::move(*loop), {}, {}, {}};
    built.Ms_percent = percent_above(built.loop.robustness.Ms, ideal.robustness.Ms);
    built.load_IAE_percent = percent_above(built.loop.performance.load.IAE, ideal.performance.load.IAE);
    built.overshoot_points =
        points_above(built.loop.performance.setpoint.overshoot_percent, ideal.performance.setpoint.overshoot_percent);
    for (const auto& [name, difference] : {std::pair{DifferingFigure::Ms, &built.Ms_percent},
                                           {DifferingFigure::load_IAE, &built.load_IAE_percent},
                                           {DifferingFigure::overshoot, &built.overshoot_points}})
        if (built.loop.robustness.stable && *difference && std::abs(**difference) > kMaxUnsaidDifference)
            built.differs.push_back(name);
    return built;
}

Expected<AsBuilt> built_from(const Subject& subject, const built::Build& build, const EvaluateOptions& options,
                             const Evaluation& ideal, const RunControl& control) {
    if (std::holds_alternative<Npid>(ideal.controller))
        return Error{ErrorKind::unsupported, "",
                     "The nonlinear integral of this controller is in no product and in no sampled law here; only the "
                     "ideal loop is judged."};
    const auto pid = to_ideal(ideal.controller);
    if (!pid) return pid.error();
    auto fitted = built::fit(build, *pid);
    if (!fitted && fitted.error().kind == ErrorKind::not_representable)
        fitted = nearest(subject, build, *pid, ideal, fitted.error(), control);
    if (!fitted) return fitted.error();
    return judge_as_built(subject, build, std::move(*fitted), options, ideal);
}

namespace {

void warn_of_difference(Evaluation& evaluation, const AsBuilt& built) {
    if (!built.loop.robustness.stable) {
        evaluation.warnings.push_back(
            {"unstable-as-built",
             "On the controller as it is built the loop is unstable: sample faster, or design for "
             "the controller with the method robust."});
        return;
    }
    std::string moved;
    const auto note = [&](DifferingFigure which, const Figure& percent, const char* what) {
        if (std::ranges::find(built.differs, which) == built.differs.end()) return;
        moved += (moved.empty() ? "" : " and ") + std::string(what) + " by " + text(*percent, 3) + " %";
    };
    note(DifferingFigure::Ms, built.Ms_percent, "Ms");
    note(DifferingFigure::load_IAE, built.load_IAE_percent, "the load IAE");
    if (moved.empty()) return;
    evaluation.warnings.push_back(
        {"differs-as-built", "The controller as it is built, its rounding and its sampling included, moves " + moved +
                                 " from the ideal loop; the figures in implemented are what it does."});
}

}  // namespace

void take_as_built(Expected<AsBuilt> built, Evaluation& evaluation, std::optional<AsBuilt>& beside) {
    if (!built) {
        evaluation.warnings.push_back({"not-as-built", built.error().message});
        return;
    }
    warn_of_difference(evaluation, *built);
    if (const Robustness& r = built->loop.robustness; r.stable && r.omega_Ms)
        if (auto degenerate =
                robust::degenerate_design(*r.omega_Ms, built->fitted.controller.Ti, built->fitted.controller.Td))
            evaluation.warnings.push_back(std::move(*degenerate));
    beside = std::move(*built);
}

}  // namespace tunewright
