#include "engine/tuning/arrieta/arrieta.h"

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <utility>
#include <vector>

#include "engine/expected.h"
#include "engine/number_text.h"
#include "engine/numerics/sign_change.h"
#include "engine/plant/plant.h"
#include "engine/tuning/arrieta/arrieta_rule.h"
#include "engine/tuning/arrieta/tradeoff.h"
#include "engine/tuning/arrieta/tradeoff_report.h"

namespace tunewright {

namespace {

constexpr int kPoints = 25;         // points of the scan, one every 0.025
constexpr double kAccuracy = 1e-9;  // accuracy of Ms that the header promises

struct Sample {
    double Ms = 0, Deg = 0;
};

class Branch {
public:
    Branch(const Fopdt& model, const ReferenceControllers& references)
        : model_(model), scale_(*LinearPlant::make(model), references) {}

    std::optional<double> degradation(double Ms) const {
        const IdealPid pid = arrieta_pid(arrieta_equation_9(Ms, ArrietaC3::refitted), model_);
        return pid.Td >= 0 ? scale_.degradation(to_parallel(pid)) : std::nullopt;
    }

private:
    Fopdt model_;
    TradeoffScale scale_;
};

// The Ms between two samples on either side of `target`, to kAccuracy.
double Ms_between(const Branch& branch, Sample a, Sample b, double target) {
    const auto surplus = [&](double Ms) {
        const auto Deg = branch.degradation(Ms);
        return Deg ? *Deg - target : 0;  // without a degradation the branch ends, and its end is the result
    };
    return root_between(surplus, a.Ms, b.Ms, a.Deg - target, b.Deg - target, kAccuracy);
}

Error out_of_reach(const std::vector<Sample>& samples, double degradation) {
    const auto [low, high] = std::ranges::minmax_element(samples, {}, &Sample::Deg);
    return {ErrorKind::unsupported, "degradation",
            "degradation is " + text(degradation) + ", but with Ms from 1.4 to 2 this rule has " + text(low->Deg) +
                " (Ms = " + text(low->Ms) + ") to " + text(high->Deg) + " (Ms = " + text(high->Ms) +
                ") on this model. Choose a value in that range, or 0 for the tuning without a limit on Ms."};
}

// The smallest Ms from 1.4 to 2 with which Eq. 9 (c3 refitted) has this degradation (tradeoff.h) on the model. Errors:
// unsupported if no Ms has it (the message has the range) or if the model has no optimum as a reference; cancelled.
Expected<double> Ms_of_degradation(const Fopdt& model, double degradation, const std::stop_token& stop) {
    const auto references = reference_controllers(model);
    if (!references) return references.error();
    if (!references->free)
        return Error{ErrorKind::unsupported, "plant",
                     "L/T is " + text(model.L / model.T) +
                         ", for which the tuning without a limit on Ms has Td < 0, so the degradation has no "
                         "reference. The rule holds for L/T from 0.1 to 2; use simc, amigo or robust."};
    const Branch branch(model, *references);
    std::vector<Sample> samples;
    for (int i = 0; i < kPoints; ++i) {
        if (stop.stop_requested())
            return Error{ErrorKind::cancelled, "", "The job was cancelled before a design was found."};
        const double Ms = std::lerp(kArrietaLowestMs, kArrietaHighestMs, i / (kPoints - 1.0));
        const auto Deg = branch.degradation(Ms);
        if (!Deg) continue;
        if (*Deg == degradation) return Ms;
        if (!samples.empty() && (samples.back().Deg > degradation) != (*Deg > degradation))
            return Ms_between(branch, samples.back(), {Ms, *Deg}, degradation);
        samples.push_back({Ms, *Deg});
    }
    if (samples.empty())
        return Error{ErrorKind::unsupported, "plant",
                     "The rule does not stabilise this model for any Ms from 1.4 to 2. Use amigo or robust."};
    return out_of_reach(samples, degradation);
}

constexpr double kLowestTau = 0.1, kHighestTau = 2;  // range of the source
constexpr const char* kSource =
    "Arrieta, Vilanova and Alfaro, Performance degradation driven PID controller design, IFAC PID'12 (2012), ";
constexpr const char* kCorrectedB3 = "b3 = 1.3870 M^2 - 4.7810 M + 4.9470 (0.3870 in print, a misprint)";
constexpr const char* kRefittedC3 = "c3 = 0.1331 M^2 - 0.4320 M + 0.3330 (the quadratic through Table 1)";

// The rule's model, or the error in its place.
Expected<ReducedModel> model_for(const TuningProblem& problem, const ReductionOptions& options) {
    auto model =
        rule_model(problem, options, {.order = ReducedOrder::first, .preferred = ReductionMethod::two_point_123c});
    if (!model) return model.error();
    if (model->integrators > 0)
        return degenerate("plant", "The rule is written for stable first-order models, and the plant integrates.",
                          "Use simc, lambda, amigo or robust.");
    if (model->L <= 0)
        return degenerate("plant/L", "The rule needs a dead time: Kp is unbounded as L/T goes to 0.",
                          "Give the true dead time of the loop, or use lambda, simc with tau_c, or robust.");
    if (model->T1 <= 0)
        return degenerate("plant/T", "The rule needs a lag, and the model is a pure dead time (T = 0).",
                          "Use amigo or robust.");
    return model;
}

Expected<TunedController> answer(const TuningProblem& problem, const ReducedModel& model,
                                 const ArrietaConstants& constants, ArrietaSettings report,
                                 std::vector<Warning> warnings) {
    const double tau = model.L / model.T1;
    const IdealPid pid = arrieta_pid(constants, report.model);
    if (pid.Td < 0 || pid.Ti <= 0 || pid.Kp * model.K <= 0)
        return degenerate("plant",
                          "The rule gives Kp = " + text(pid.Kp) + ", Ti = " + text(pid.Ti) + ", Td = " + text(pid.Td) +
                              " for L/T = " + text(tau) + ", far outside its range of 0.1 to 2.",
                          "Use simc, amigo or robust.");
    if (tau < kLowestTau || tau > kHighestTau)
        warnings.push_back(
            outside_validity("L/T is " + text(tau) +
                             ", outside the range 0.1 to 2 for which the rule was fitted: Ms and degradation may "
                             "differ much from the requested ones."));
    auto tuned = rule_answer(problem, model, pid, std::move(warnings));
    if (tuned) tuned->report = std::make_shared<TradeoffReport>(std::move(report));
    return tuned;
}

ArrietaSettings report_on(const ReducedModel& model, bool profile) {
    return {.model = {.K = model.K, .T = model.T1, .L = model.L},
            .constants = {},
            .Ms_design = {},
            .degradation = {},
            .profile = profile};
}

Expected<TunedController> settings_for_Ms(const TuningProblem& problem, const ArrietaMsOptions& options) {
    const auto model = model_for(problem, options.reduction);
    if (!model) return model.error();
    ArrietaSettings report = report_on(*model, options.profile);
    if (!options.Ms) {
        report.constants = "Table 1, column without a limit on Ms";
        return answer(problem, *model, arrieta_free(), report, {});
    }
    const double Ms = *options.Ms;
    if (!(Ms >= kArrietaLowestMs && Ms <= kArrietaHighestMs))
        return Error{ErrorKind::invalid_argument, "Ms",
                     "Ms is " + text(Ms) + "; this rule has settings only for 1.4 to 2 and for \"free\"."};
    report.Ms_design = Ms;
    if (const ArrietaConstants* column = arrieta_column(arrieta_Ms_levels(), Ms)) {
        report.constants = "Table 1, column Ms = " + text(Ms);
        return answer(problem, *model, *column, report, {});
    }
    const bool printed = options.c3 == ArrietaC3::printed;
    report.constants = "Eq. 9 at Ms = " + text(Ms) + ", with " + kCorrectedB3 + " and " +
                       (printed ? std::string("c3 as printed") : kRefittedC3);
    const auto constants = arrieta_equation_9(Ms, options.c3);
    return answer(problem, *model, constants, report, {});
}

Expected<TunedController> tune_by_Ms(const TuningProblem& problem, const ArrietaMsOptions& options) {
    auto tuned = settings_for_Ms(problem, options);
    if (tuned) tuned->Ms_limit = options.Ms;
    return tuned;
}

Expected<TunedController> tune_exactly(const TuningProblem& problem, const ReducedModel& model, double degradation,
                                       ArrietaSettings report, std::vector<Warning> warnings,
                                       const RunControl& control) {
    const auto Ms = Ms_of_degradation(report.model, degradation, control.stop);
    if (!Ms) return Ms.error();
    report.Ms_design = *Ms;
    report.constants = "Eq. 9 at Ms = " + text(*Ms) + ", with a degradation on the model of " + text(degradation) +
                       ", with " + kCorrectedB3 + " and " + kRefittedC3;
    return answer(problem, model, arrieta_equation_9(*Ms, ArrietaC3::refitted), report, std::move(warnings));
}

std::string listed_levels() {
    std::string levels;
    for (const ArrietaLevel& column : arrieta_degradation_levels())
        levels += (levels.empty() ? "" : ", ") + text(column.level);
    return levels;
}

Expected<TunedController> tune_by_degradation(const TuningProblem& problem, const ArrietaDegradationOptions& options,
                                              const RunControl& control) {
    const auto model = model_for(problem, options.reduction);
    if (!model) return model.error();
    ArrietaSettings report = report_on(*model, options.profile);
    const double degradation = options.degradation;
    const std::optional<bool>& exact = options.exact;
    const ArrietaConstants* column = arrieta_column(arrieta_degradation_levels(), degradation);
    if (column && (degradation == 0 || !exact.value_or(false))) {
        report.constants = "Table 2, column degradation = " + text(degradation);
        report.degradation = degradation;
        return answer(problem, *model, *column, report, {});
    }
    if (!column && exact.has_value() && !*exact)
        return Error{ErrorKind::invalid_argument, "degradation",
                     "degradation is " + text(degradation) + "; Table 2 has settings for " + listed_levels() +
                         ". Use one of these, or exact = true, which solves for any other value on the model."};
    std::vector<Warning> warnings;
    if (!exact)
        warnings.push_back({"exact-degradation", "Table 2 has settings for " + listed_levels() + "; those for " +
                                                     text(degradation) +
                                                     " were computed on the model, as with exact = true."});
    return tune_exactly(problem, *model, degradation, report, std::move(warnings), control);
}

template <class T>
void add_profile(OptionSet<T>& set) {
    set.field(
        &T::profile, "profile",
        "Also return the trade-off of this rule on the model over Ms from 1.4 to 2 and over the levels of Table 2.");
    set.draws("profile");
    add_reduction(set, "123c, as in the source; half_rule if it does not apply.");
}

OptionSet<ArrietaMsOptions> Ms_options() {
    OptionSet<ArrietaMsOptions> set;
    set.number_or_word(&ArrietaMsOptions::Ms, "Ms",
                       "Largest |S| of the loop on the model, from 1.4 (robust) to 2 (fast); free: no limit, the least "
                       "combined distance from both optima (Ms is then 2 to 2.9).",
                       "free", {.minimum = kArrietaLowestMs, .maximum = kArrietaHighestMs});
    set.main({"Ms"}).slider("Ms");
    set.choice(&ArrietaMsOptions::c3, "c3",
               "Constant c3 of Eq. 9, for Ms between the levels of Table 1. refitted: the quadratic through "
               "Table 1, within 0.006 of it; printed: the source's, off by 0.014 at Ms 1.4 and 2, so that Td jumps "
               "there.",
               Words<ArrietaC3>{{"refitted", ArrietaC3::refitted}, {"printed", ArrietaC3::printed}});
    add_profile(set);
    return set;
}

OptionSet<ArrietaDegradationOptions> degradation_options() {
    using O = ArrietaDegradationOptions;
    OptionSet<O> set;
    set.field(&O::degradation, "degradation",
              "Loss of combined performance that is allowed for robustness: 0 is the tuning without a limit on Ms, "
              "0.25 low, 0.35 medium-low, 0.45 medium-high, 0.55 high. Other values are computed on the model.",
              {.minimum = 0, .maximum = 1});
    set.slider("degradation");
    set.field(
        &O::exact, "exact",
        "true: solve on the model for the Ms from 1.4 to 2 with the requested degradation, also at the levels of Table "
        "2 (whose error is up to 0.02 for L/T up to 1.5 and 0.1 at 2); false: only the table. Default: the table at "
        "its levels, solved in between.");
    add_profile(set);
    return set;
}

constexpr const char* kFormula =
    "tau = L/T; Kp = (a1 tau^b1 + c1)/K, Ti = (a2 tau^b2 + c2) T, Td = (a3 tau^b3 + c3) T, Tf = Td/10; ";

}  // namespace

TuningMethod arrieta_ms_method() {
    TuningMethod method;
    method.id = "arrieta_ms";
    method.title = "Servo and regulation for an Ms (Arrieta et al.)";
    method.formula = std::string(kFormula) +
                     "a1 to c3 from Table 1 for Ms free, 2.0, 1.8, 1.6 and 1.4, in between from equation 9, quadratic "
                     "in Ms, with b3 and c3 corrected";
    method.source = std::string(kSource) + "Eqs. 7-9, Table 1";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 2, Ms from 1.4 to 2";
    const OptionSet<ArrietaMsOptions> options = Ms_options();
    for (const double Ms : {2.0, 1.6, 1.4})
        method.variants.push_back({"Ms " + text(Ms), options.given_for({.Ms = Ms}, {.Ms = {}})});
    method.bind(options, tune_by_Ms);
    return method;
}

TuningMethod arrieta_degradation_method() {
    TuningMethod method;
    method.id = "arrieta_degradation";
    method.title = "Servo and regulation with allowed degradation (Arrieta et al.)";
    method.formula =
        std::string(kFormula) +
        "a1 to c3 from Table 2 for degradation 0, 0.25, 0.35, 0.45 and 0.55; exact: from equation 9 with the Ms "
        "for which 1 - J_free/J_rd on the model equals the requested degradation, where J_free is J_rd of Ms free";
    method.source = std::string(kSource) + "Eqs. 5-11, Table 2";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 2, degradation up to 0.55";
    const OptionSet<ArrietaDegradationOptions> options = degradation_options();
    constexpr double kNoLevel = -1;  // every variant states its level, even the default
    for (const auto& [level, constants] : arrieta_degradation_levels())
        method.variants.push_back(
            {"degradation " + text(level), options.given_for({.degradation = level}, {.degradation = kNoLevel})});
    method.bind(options, tune_by_degradation);
    return method;
}

}  // namespace tunewright
