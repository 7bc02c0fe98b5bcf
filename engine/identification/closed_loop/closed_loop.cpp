#include "engine/identification/closed_loop/closed_loop.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/closed_loop/instrument_fit.h"
#include "engine/identification/closed_loop/recognised_law.h"
#include "engine/identification/further_inputs/further_inputs.h"
#include "engine/identification/model_grade.h"
#include "engine/identification/search/diagnosis.h"
#include "engine/identification/search/model_answer.h"
#include "engine/identification/search/model_search.h"
#include "engine/number_text.h"
#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

/// A search's structures fitted by instrumental variables, with the unexplained part of each.
struct Refined {
    ModelSearch search;
    std::vector<double> mismatch, gain_error;
    std::vector<double> left;  ///< share of the set point's effect on y that the model does not explain

    std::size_t chosen() const { return static_cast<std::size_t>(search.choice.index); }
};

constexpr double kMaxMismatch = 25;                ///< limit of InstrumentFit::mismatch: about 10 occur by chance
constexpr double kMinUnknownGainError = 0.5;       ///< standard error over the gain
constexpr double kMinGainError = 1e-5;             ///< a smaller standard error over the gain is not credible for a
                                                   ///< record of a loop
constexpr double kMinFitPercentOfSmallError = 99;  ///< per cent: with a better fit of the free run such a small error
                                                   ///< is possible
constexpr double kMinDivisor = 1e-300;             ///< keeps a division by a value near 0 finite

/// The part of the signal's sum of squares about its mean that filtered set points explain.
double by_set_point(const std::vector<double>& signal, const SetPointPart& part) {
    const auto n = static_cast<Eigen::Index>(signal.size());
    Eigen::MatrixXd columns(n, static_cast<Eigen::Index>(part.filtered.size()));
    for (std::size_t k = 0; k < part.filtered.size(); ++k)
        columns.col(static_cast<Eigen::Index>(k)) = Eigen::Map<const Eigen::VectorXd>(part.filtered[k].data(), n);
    columns.rowwise() -= columns.colwise().mean().eval();
    Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(signal.data(), n);
    values.array() -= values.mean();
    return (columns * least_squares(columns, values)).squaredNorm();
}

/// True if the recognised controller would destabilise this plant: positive static feedback.
bool driven_away(const LoopRecord& loop, const Fit& fit) {
    const double K = fit.linear[0] * (fit.form.structure == Structure::unstable ? -1 : 1);
    return K * loop.gain > 0;
}

std::optional<Refined> refined(ModelSearch search, const CleanRecord& record, const LoopRecord& loop,
                               const std::stop_token& stop) {
    const SetPointPart& part = *loop.part;
    if (search.choice.index < 0) return std::nullopt;
    std::vector<FurtherSteps> further = std::move(search.context.record.d);
    search.context.record = record;
    search.context.record.d = std::move(further);
    Refined out{std::move(search), {}, {}, {}};
    const double done = by_set_point(record.y, part);
    for (std::size_t i = 0; i < out.search.fits.size(); ++i) {
        Fit& fit = out.search.fits[i];
        out.mismatch.push_back(0), out.gain_error.push_back(1), out.left.push_back(1);
        if (!fit.determined) continue;
        std::optional<InstrumentFit> better = fit_by_instrument(out.search.context.record, part, fit, stop);
        fit.determined = better.has_value();
        if (!better) continue;
        fit = std::move(better->fit);
        out.search.percents[i] = fit_percent(record, fit);
        // A gain with a standard error of 0 means that the equations do not depend on it.
        const bool empty =
            (better->gain_error < kMinGainError && out.search.percents[i] < kMinFitPercentOfSmallError) ||
            driven_away(loop, fit);
        out.left[i] = by_set_point(fit.residual, part) / std::max(done, kMinDivisor);
        out.mismatch[i] = better->mismatch, out.gain_error[i] = empty ? 1 : better->gain_error;
    }
    return out;
}

bool usable(const Refined& r, std::size_t i) {
    constexpr double kMaxKnownGainError = 0.3;                            // standard error over the gain
    constexpr double kMaxLeft = 0.1, kAboveBest = 0.003, kTimesBest = 3;  // of the set point's effect on y
    const double min = *std::ranges::min_element(r.left);
    return r.search.fits[i].determined && r.mismatch[i] < kMaxMismatch && r.gain_error[i] < kMaxKnownGainError &&
           r.left[i] < std::min(kMaxLeft, kAboveBest + kTimesBest * min);
}

/// Chooses the structure whose residual the set point explains least, if the one that least squares preferred is not
/// good enough or clearly worse. Its free run must not be much worse. An integrator with a slow disturbance gives as
/// white a residual as a lag, so its free run must be as good.
void choose_again(Refined& r) {
    constexpr double kMismatchPerParameter = 3,
                     kMinMismatchGain = 6;  // of mismatch: gain for an additional parameter, and for another choice
    constexpr double kMaxSseRatio = 5, kMaxSseRatioOfIntegrator = 1.2;  // ratios of sums of squares
    const auto cost = [&](std::size_t i) {
        return r.mismatch[i] + kMismatchPerParameter * r.search.fits[i].form.parameters();
    };
    const auto integrating = [&](std::size_t i) { return is_integrating(r.search.fits[i].form.structure); };
    const std::size_t preferred = r.chosen();
    const auto runs = [&](std::size_t i) {
        const double max = integrating(i) && !integrating(preferred) ? kMaxSseRatioOfIntegrator : kMaxSseRatio;
        return r.search.fits[i].sse <= max * r.search.fits[preferred].sse;
    };
    std::size_t best = preferred;
    for (std::size_t i = 0; i < r.search.fits.size(); ++i) {
        if (usable(r, i) && runs(i) && (!usable(r, best) || cost(i) < cost(best))) best = i;
    }
    if (best == r.chosen() || (usable(r, r.chosen()) && cost(r.chosen()) < cost(best) + kMinMismatchGain)) return;
    r.search.choice = {static_cast<int>(best),
                       std::string(name_of(r.search.fits[best].form.structure)) +
                           ": of the structures whose gain the moves of the set point determine, the one that explains "
                           "most of their effect."};
}

/// The gain's standard error over its size; 0 if it is unknown.
double gain_error(const IdentifiedModel& model) {
    const auto error = model.standard_errors.find("K");
    if (error == model.standard_errors.end()) return 0;
    const double K = std::visit(
        [](const auto& plant) {
            using P = std::decay_t<decltype(plant)>;
            if constexpr (std::is_same_v<P, TransferFunction>)
                return plant.num.empty() ? 0.0 : plant.num.back();
            else if constexpr (requires { plant.K; })
                return static_cast<double>(plant.K);
            else
                return 0.0;
        },
        model.plant);
    return error->second / std::max(std::abs(K), kMinDivisor);
}

/// True if the model responds at once, like the inverse of a proportional controller.
bool answers_at_once(const IdentifiedModel& model) {
    constexpr double kMaxLagInSpacings = 2;  // spacings of the samples
    return std::any_of(model.candidates.begin(), model.candidates.end(), [&](const Candidate& candidate) {
        const auto* lag = std::get_if<Fopdt>(&candidate.plant);
        return lag != nullptr && std::abs(lag->T) + lag->L < kMaxLagInSpacings * model.data_quality.sample_time;
    });
}

/// Standard deviation of u about a straight line over y, of the same row or the next.
double left_by_line(std::span<const double> y, std::span<const double> u) {
    return deviation(residuals(straight_line(y, u), y, u));
}

/// True if the model is like the inverse of a proportional controller that u follows.
bool is_inverse_of_law(const CleanRecord& record, const IdentifiedModel& model) {
    constexpr double kMaxGainProductError = 0.1;
    if (!may_be_controlled(record) || !answers_at_once(model)) return false;
    const std::vector<double> u = input_at_samples(record);
    const std::span all_u(u), all_y(record.y);
    // A plant that is fast compared with the sampling shows u one row later.
    if (left_by_line(all_y.last(u.size() - 1), all_u.first(u.size() - 1)) < left_by_line(all_y, all_u)) return false;
    const std::optional<RecognisedLaw> law = recognised_law(record, u, {});
    const auto* lag = std::get_if<Fopdt>(&model.plant);
    const double unit = record.scale.y_scale / record.scale.u_scale;
    return law && lag != nullptr && std::abs(law->gain * lag->K / unit - 1) < kMaxGainProductError;
}

/// A load that the controller answers leaves y at another level with the same u. Where the model rests on the moves of
/// the set point such a load counts as noise in its standard errors. On 82 simulated loops with loads half of the
/// models had the warning, and replays of the record with them were as accurate as with the others.
void expect_loads(IdentifiedModel& model) {
    for (Warning& warning : model.warnings) {
        if (warning.code != "contradictory-levels") continue;
        warning.level = WarningLevel::warning;
        warning.detail +=
            " The model rests on the moves of the set point, so a load that the controller answered only "
            "makes it less certain.";
    }
}

}  // namespace

Expected<IdentifiedModel> identify_in_loop(const CleanRecord& full, const LoopRecord& loop, ModelChoice model,
                                           const RunControl& control) {
    constexpr double kMinFRatio = 4, kMinMismatchDifference = 10;  // F ratio; difference of mismatch
    if (!loop.part) return no_plant_in_loop(full, loop, "and only feedback moves u");
    if (loop.part->strength < kMinFRatio)
        return no_plant_in_loop(
            full, loop,
            "and moves of the set point explain too little of u (" + text(100 * loop.part->share, 2) + " %)");
    CleanRecord record = condensed(full, kMaxLoopSamples);
    record.moved_at_first_row = loop.moved_at_first_row && !full.u0_given;
    const auto cancelled = [] { return Error{ErrorKind::cancelled, "", "The identification was cancelled."}; };
    auto direct = refined(search_with_further(record, model, false, control), record, loop, control.stop);
    if (control.stop.stop_requested()) return cancelled();
    auto two_stage =
        refined(search_with_further(driven_by(*loop.part, record), model, false, control), record, loop, control.stop);
    if (control.stop.stop_requested()) return cancelled();
    for (std::optional<Refined>* one : {&direct, &two_stage}) {
        if (*one) choose_again(**one);
    }
    const auto better = [&](const Refined& a, const Refined& b) {
        if (usable(a, a.chosen()) != usable(b, b.chosen())) return usable(a, a.chosen());
        return a.mismatch[a.chosen()] + kMinMismatchDifference < b.mismatch[b.chosen()];
    };
    std::optional<Refined>& best = two_stage && (!direct || better(*two_stage, *direct)) ? two_stage : direct;
    const bool follows = best && best->search.chosen().determined &&
                         (best->mismatch[best->chosen()] < kMaxMismatch || responds(full, best->search.chosen()));
    if (!follows) return no_plant_in_loop(full, loop, "and y does not clearly follow the moves from outside the loop");
    if (driven_away(loop, best->search.chosen()))
        return no_plant_in_loop(full, loop,
                                "and with the gain that follows from the moves from outside the loop, this controller "
                                "would have been unstable");
    constexpr double kMaxUnexplainedShare = 0.5;  // of the set point's effect on y
    if (best->left[best->chosen()] > kMaxUnexplainedShare)
        return no_plant_in_loop(full, loop,
                                "and no structure explains the effect of the moves from outside the loop "
                                "on y");
    const double error = best->gain_error[best->chosen()];
    if (!(error < kMinUnknownGainError)) {
        return no_plant_in_loop(full, loop,
                                "and the moves from outside the loop do not determine the gain (its standard error "
                                "is " +
                                    text(100 * error, 2) + " % of it)");
    }
    if (loop.found.used == LoopExcitation::switched_on) {
        // A single move cannot be compared with others: slow parts of the residual may belong to the plant.
        for (Fit& fit : best->search.fits) fit.as_open_as_least_squares = true;
    }
    IdentifiedModel answer = searched_model(std::move(best->search), full);
    if (loop.found.used == LoopExcitation::switched_on && !(gain_error(answer) < kMinUnknownGainError)) {
        return no_plant_in_loop(full, loop,
                                "and its start does not determine the gain (its standard error is " +
                                    text(100 * gain_error(answer), 2) + " % of it)");
    }
    return answer;
}

void doubt_open_loop(const CleanRecord& full, IdentifiedModel& model) {
    constexpr double kMinRestlessness = 0.005, kMinRestlessnessAtOnce = 0.05,
                     kMinRestlessnessOfLaw = 0.15;  // restlessness
    constexpr double kMinGainErrorOfLaw = 0.33;     // standard error over the gain
    constexpr double kMaxLawShareUnknownGain = 0.8,
                     kMaxLawShareAtOnce = 0.95;  // standard deviation of u from the law over that of y from the model
    const double restless = restlessness(looked_at_for_feedback(full));
    const CleanRecord record = condensed(full, kMaxLoopSamples);
    const bool inverse = is_inverse_of_law(record, model);
    if (restless < kMinRestlessness && !inverse) return;
    const std::optional<SetPointPart> law = set_point_part(input_at_samples(record), record.y, record.y.front());
    const double left = share_left_by(model), unexplained = left * left;
    if (!law) return;
    const double by_law = (1 - law->share) / unexplained, error = gain_error(model);
    const bool at_once = by_law < kMaxLawShareAtOnce && restless > kMinRestlessnessAtOnce && answers_at_once(model);
    const bool in_doubt = (error > kMinGainErrorOfLaw && by_law < kMaxLawShareUnknownGain) ||
                          (restless > kMinRestlessnessOfLaw && by_law < 1) || at_once || inverse;
    if (!in_doubt) return;
    LoopRecord loop;
    loop.found.evidence = "u moves irregularly, and filters of y explain " + text(100 * law->share, 3) +
                          " % of its variance, but the model explains only " +
                          text(100 * std::max(0.0, 1 - unexplained), 3) + " % of y's.";
    model.data_quality.closed_loop = loop.found;
    model.warnings.insert(model.warnings.begin(),
                          {"closed-loop",
                           "A controller seems to move u in response to y: " + loop.found.evidence +
                               " Then the model may be the controller's inverse in place of the plant: "
                               "step u in manual, or step the set point and record it as column r.",
                           WarningLevel::bad});
}

void report_loop(const LoopRecord& loop, IdentifiedModel& model) {
    if (loop.found.used == LoopExcitation::set_point) expect_loads(model);
    std::string detail = "A controller moves u in response to y: " + loop.found.evidence;
    switch (loop.found.used) {
        case LoopExcitation::set_point:
            detail +=
                " The model is based only on the effect of the set point's moves; disturbances to which the controller "
                "responded count as noise in its standard errors.";
            break;
        case LoopExcitation::switched_on:
            detail +=
                " The model is based on the effect of switching the controller on, or of the set point's move before "
                "the first row; disturbances to which the controller responded count as noise in its standard errors.";
            break;
        case LoopExcitation::outside_moves:
            detail +=
                " The model is based on the moves of u that y does not explain, which were assumed to be moves of the "
                "set point. Record the set point as column r.";
            break;
        case LoopExcitation::none:
            detail +=
                " The requested formula does not consider feedback: its figures may describe the controller instead of "
                "the plant.";
            break;
    }
    model.data_quality.closed_loop = loop.found;
    model.warnings.insert(model.warnings.begin(), {"closed-loop", detail});
}

}  // namespace tunewright
