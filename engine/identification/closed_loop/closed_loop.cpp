#include "engine/identification/closed_loop/closed_loop.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/closed_loop/instrument_fit.h"
#include "engine/identification/closed_loop/loop_parts.h"
#include "engine/identification/fit/diagnosis.h"
#include "engine/identification/fit/model_answer.h"
#include "engine/identification/fit/model_search.h"
#include "engine/identification/record/record_kind.h"
#include "engine/identification/record/series.h"
#include "engine/number_text.h"
#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

constexpr int kMaxSeen = 20'000;    ///< rows
constexpr int kMaxFitted = 10'000;  ///< samples: an instrumental fit costs several times a plain one

/// Whether r is y, as many controllers write it in manual: of this row or the one before, and rounded, in some rows.
bool tracks(const std::vector<double>& r, const std::vector<double>& y) {
    constexpr double kSame = 1e-3, kFine = 0.1;       // of y's range; more is a level of r, not a figure's rounding
    constexpr double kMostMoves = 0.8, kOften = 0.1;  // of the moves of r; of the rows: a set point moves in fewer
    const double grid = quantisation_step(r), same = kSame + (grid < kFine ? 0.5 * grid : 0);
    int moves = 0, tracking = 0;
    for (std::size_t i = 1; i < r.size(); ++i) {
        if (r[i] == r[i - 1]) continue;
        ++moves;
        tracking += std::min(std::abs(r[i] - y[i]), std::abs(r[i] - y[i - 1])) < same ? 1 : 0;
    }
    return moves > kOften * static_cast<double>(r.size()) && tracking > kMostMoves * moves;
}

/// r at the record's samples, dimensionless as y; empty where the record has none, or it only tracks y.
std::vector<double> set_point_at_samples(const CleanRecord& clean, const Record& record) {
    std::vector<std::pair<double, double>> known;
    for (std::size_t i = 0; i < record.r.size(); ++i) {
        if (std::isfinite(record.t[i]) && std::isfinite(record.r[i])) known.emplace_back(record.t[i], record.r[i]);
    }
    if (known.empty()) return {};
    std::stable_sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const RecordScale& s = clean.scale;
    constexpr double kRounding = 1e-9;  // of the record's length
    std::vector<double> r;
    std::size_t next = 0;
    double now = known.front().second;
    for (int i = 0; i < clean.samples(); ++i) {
        const double t = s.t_origin + s.t_scale * (clean.t[i] + kRounding);
        for (; next < known.size() && known[next].first <= t; ++next) now = known[next].second;
        r.push_back((now - s.y_origin) / s.y_scale);
    }
    return tracks(r, clean.y) ? std::vector<double>{} : r;
}

/// Steps of a set point at the samples: changes below 2 % of its range are none, and a ramp is one.
int moves_of(const std::vector<double>& r) {
    constexpr double kJitter = 0.02;
    const auto [low, high] = std::ranges::minmax(r);
    int moves = 0;
    double last = 0;
    for (std::size_t i = 1; i < r.size(); ++i) {
        const double change = r[i] - r[i - 1];
        const bool moved = std::abs(change) > kJitter * (high - low);
        if (moved && change * last <= 0) ++moves;
        last = moved ? change : 0;
    }
    return moves;
}

/// Feedback shows from row to row: of a long record the beginning is looked at, and means over blocks are fitted.
CleanRecord beginning(const CleanRecord& record) {
    return record.samples() <= kMaxSeen ? record : first_part(record, record.t[static_cast<std::size_t>(kMaxSeen - 1)]);
}

/// A set point that is known only by its moves; `length` is that of the part of the record in which they were seen.
std::vector<double> steps_at_samples(const std::vector<OutsideMove>& moves, double length, const CleanRecord& record) {
    std::vector<double> w(static_cast<std::size_t>(record.samples()), 0.0);
    for (const OutsideMove& move : moves) {
        const auto from = std::lower_bound(record.t.begin(), record.t.end(), move.time * length) - record.t.begin();
        for (auto i = static_cast<std::size_t>(from); i < w.size(); ++i) w[i] += move.size;
    }
    return w;
}

std::string evidence_of(const std::optional<Feedback>& feedback, const SetPointPart* part, const RecordScale& scale) {
    if (feedback) {
        return "y, " + std::string(feedback->at_once ? "of the same and earlier rows" : "of earlier rows") +
               ", predicts the moves of u within " + text(feedback->by_y * scale.u_scale, 3) +
               " where u's own past leaves " + text(feedback->by_u * scale.u_scale, 3) + ".";
    }
    return "u follows the set point: its moves explain " + text(100 * part->share, 3) + " % of u's variance.";
}

Error nothing_outside(const CleanRecord& r, const LoopRecord& loop, const std::string& why) {
    const auto [low, high] = std::minmax_element(r.v_level.begin(), r.v_level.end());
    const double u_range = (std::max(*high, 0.0) - std::min(*low, 0.0)) * r.scale.u_scale;
    return {ErrorKind::not_identifiable, "record",
            "The record is of a closed loop (" + loop.found.evidence.substr(0, loop.found.evidence.size() - 1) + "), " +
                why +
                ": the plant cannot be distinguished from the controller. Put the controller in manual and step u by " +
                text(u_range, 2) + " or so, or step the set point by " + text(2 * r.scale.y_scale, 2) +
                " or so (twice what y moves here) and record it as column r."};
}

/// A search's structures by instrumental variables, with what each leaves.
struct Refined {
    ModelSearch search;
    std::vector<double> mismatch, gain_error;
    std::vector<double> left;  ///< of what the set point did to y, the share that the model leaves

    std::size_t chosen() const { return static_cast<std::size_t>(search.choice.index); }
};

constexpr double kMismatch = 25;      ///< of InstrumentFit::mismatch: some 10 are chance
constexpr double kUnknownGain = 0.5;  ///< standard error over the gain
constexpr double kNoError = 1e-5;     ///< standard error over the gain that no record of a loop can give
constexpr double kFits = 99;          ///< per cent: so good a free run may have so small an error
constexpr double kTiny = 1e-300;      ///< keeps a division by what may be 0 finite

/// The sum of squares of what filters of the set point explain of a signal about its mean.
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

/// Whether the recognised controller would drive this plant away: static feedback of the positive sign.
bool driven_away(const LoopRecord& loop, const Fit& fit) {
    const double K = fit.linear[0] * (fit.form.structure == Structure::unstable ? -1 : 1);
    return K * loop.gain > 0;
}

std::optional<Refined> refined(ModelSearch search, const CleanRecord& record, const LoopRecord& loop,
                               const std::stop_token& stop) {
    const SetPointPart& part = *loop.part;
    if (search.choice.index < 0) return std::nullopt;
    search.context.record = record;
    Refined out{std::move(search), {}, {}, {}};
    const double done = by_set_point(record.y, part);
    for (std::size_t i = 0; i < out.search.fits.size(); ++i) {
        Fit& fit = out.search.fits[i];
        out.mismatch.push_back(0), out.gain_error.push_back(1), out.left.push_back(1);
        if (!fit.determined) continue;
        std::optional<InstrumentFit> better = fit_by_instrument(record, part, fit, stop);
        fit.determined = better.has_value();
        if (!better) continue;
        fit = std::move(better->fit);
        out.search.percents[i] = fit_percent(record, fit);
        // A gain without any error is one that nothing in the equations depends on.
        const bool empty = (better->gain_error < kNoError && out.search.percents[i] < kFits) || driven_away(loop, fit);
        out.left[i] = by_set_point(fit.residual, part) / std::max(done, kTiny);
        out.mismatch[i] = better->mismatch, out.gain_error[i] = empty ? 1 : better->gain_error;
    }
    return out;
}

bool usable(const Refined& r, std::size_t i) {
    constexpr double kKnownGain = 0.3;                                     // standard error over the gain
    constexpr double kMaxLeft = 0.1, kBesideBest = 0.003, kTimesBest = 3;  // of what the set point did to y
    const double least = *std::ranges::min_element(r.left);
    return r.search.fits[i].determined && r.mismatch[i] < kMismatch && r.gain_error[i] < kKnownGain &&
           r.left[i] < std::min(kMaxLeft, kBesideBest + kTimesBest * least);
}

/// The structure whose residual the set point explains least, where the one that least squares preferred does not do,
/// or leaves plainly more. A free run that is far worse is no model, and an integrator beside a slow disturbance
/// whitens as well as a lag does: it must run as well.
void choose_again(Refined& r) {
    constexpr double kPrice = 3, kPlainly = 6;      // of mismatch: for a parameter; for another choice
    constexpr double kFarWorse = 5, kAsWell = 1.2;  // ratios of sums of squares
    const auto cost = [&](std::size_t i) { return r.mismatch[i] + kPrice * r.search.fits[i].form.parameters(); };
    const auto integrating = [&](std::size_t i) { return is_integrating(r.search.fits[i].form.structure); };
    const std::size_t preferred = r.chosen();
    const auto runs = [&](std::size_t i) {
        const double most = integrating(i) && !integrating(preferred) ? kAsWell : kFarWorse;
        return r.search.fits[i].sse <= most * r.search.fits[preferred].sse;
    };
    std::size_t best = preferred;
    for (std::size_t i = 0; i < r.search.fits.size(); ++i) {
        if (usable(r, i) && runs(i) && (!usable(r, best) || cost(i) < cost(best))) best = i;
    }
    if (best == r.chosen() || (usable(r, r.chosen()) && cost(r.chosen()) < cost(best) + kPlainly)) return;
    r.search.choice = {static_cast<int>(best),
                       std::string(name_of(r.search.fits[best].form.structure)) +
                           ": of the structures whose gain the set point's moves tell, the one that leaves least of "
                           "what they did."};
}

/// The gain's standard error over its size; 0 where it is not known.
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
    return error->second / std::max(std::abs(K), kTiny);
}

/// As the inverse of a proportional controller does.
bool answers_at_once(const IdentifiedModel& model) {
    constexpr double kRows = 2;  // spacings of the samples
    return std::any_of(model.candidates.begin(), model.candidates.end(), [&](const Candidate& candidate) {
        const auto* lag = std::get_if<Fopdt>(&candidate.plant);
        return lag != nullptr && std::abs(lag->T) + lag->L < kRows * model.data_quality.sample_time;
    });
}

}  // namespace

Expected<std::optional<LoopRecord>> find_loop(const CleanRecord& full, const Record& as_given) {
    constexpr double kFollows = 0.05, kPlain = 10;  // share of u's variance; F ratio
    if (!as_given.r.empty() && as_given.r.size() != as_given.t.size()) {
        return Error{ErrorKind::invalid_argument, "record/r",
                     "r has " + std::to_string(as_given.r.size()) + " values and t " +
                         std::to_string(as_given.t.size()) + "; give columns of equal length."};
    }
    const RecordKind kind = full.kind == RecordKind::automatic ? found_kind(full) : full.kind;
    if (kind == RecordKind::relay) return std::optional<LoopRecord>{};
    const CleanRecord seen = beginning(full), record = condensed(full, kMaxFitted);
    const std::optional<Feedback> feedback = find_feedback(seen);
    const std::vector<double> r = set_point_at_samples(record, as_given);
    LoopRecord loop;
    std::vector<double> moves = r;
    if (!r.empty()) {
        loop.found.used = LoopExcitation::set_point;
        loop.found.set_point_moves = moves_of(r);
    } else if (feedback && !feedback->outside.empty()) {
        moves = steps_at_samples(feedback->outside, seen.scale.t_scale / full.scale.t_scale, record);
        loop.found.used = LoopExcitation::outside_moves;
    }
    if (!moves.empty()) loop.part = set_point_part(input_at_samples(record), moves);
    const bool follows = loop.part && loop.part->share > kFollows && loop.part->strength > kPlain;
    if (!feedback && !follows) return std::optional<LoopRecord>{};
    loop.found.evidence = evidence_of(feedback, loop.part ? &*loop.part : nullptr, record.scale);
    if (loop.part) loop.found.share = loop.part->share;
    if (!loop.part) loop.found.used = LoopExcitation::none;
    if (feedback) loop.gain = feedback->gain;
    if (loop.part && !full.u0_given) loop.u_rest = level_before_set_point(record, moves);
    return std::optional<LoopRecord>(std::move(loop));
}

Expected<IdentifiedModel> identify_in_loop(const CleanRecord& full, const LoopRecord& loop, ModelChoice model,
                                           const RunControl& control) {
    constexpr double kWeak = 4, kPlainlyLess = 10;  // F ratio; difference of mismatch
    if (!loop.part) return nothing_outside(full, loop, "and nothing but feedback moves u");
    if (loop.part->strength < kWeak)
        return nothing_outside(
            full, loop,
            "and moves of the set point explain too little of u (" + text(100 * loop.part->share, 2) + " %)");
    const CleanRecord record = condensed(full, kMaxFitted);
    const auto cancelled = [] { return Error{ErrorKind::cancelled, "", "The identification was cancelled."}; };
    auto direct = refined(search_models(record, model, false, control), record, loop, control.stop);
    if (control.stop.stop_requested()) return cancelled();
    auto two_stage =
        refined(search_models(driven_by(*loop.part, record), model, false, control), record, loop, control.stop);
    if (control.stop.stop_requested()) return cancelled();
    for (std::optional<Refined>* one : {&direct, &two_stage}) {
        if (*one) choose_again(**one);
    }
    const auto better = [&](const Refined& a, const Refined& b) {
        if (usable(a, a.chosen()) != usable(b, b.chosen())) return usable(a, a.chosen());
        return a.mismatch[a.chosen()] + kPlainlyLess < b.mismatch[b.chosen()];
    };
    std::optional<Refined>& best = two_stage && (!direct || better(*two_stage, *direct)) ? two_stage : direct;
    const bool follows = best && best->search.chosen().determined &&
                         (best->mismatch[best->chosen()] < kMismatch || responds(full, best->search.chosen()));
    if (!follows) return nothing_outside(full, loop, "and y does not plainly follow the moves from outside the loop");
    if (driven_away(loop, best->search.chosen()))
        return nothing_outside(full, loop,
                               "and the gain that the moves from outside the loop give has the sign with which this "
                               "controller would have driven y away");
    constexpr double kHalf = 0.5;  // of what the set point did to y
    if (best->left[best->chosen()] > kHalf)
        return nothing_outside(full, loop, "and no structure explains what the moves from outside the loop did to y");
    const double error = best->gain_error[best->chosen()];
    if (!(error < kUnknownGain)) {
        return nothing_outside(full, loop,
                               "and the moves from outside the loop leave the gain unknown (its standard error is " +
                                   text(100 * error, 2) + " % of it)");
    }
    return searched_model(std::move(best->search), full);
}

void doubt_open_loop(const CleanRecord& full, IdentifiedModel& model) {
    constexpr double kHardly = 0.005, kSomewhat = 0.05, kPlainly = 0.15;  // restlessness
    constexpr double kUnknown = 0.33;                                     // standard error over the gain
    constexpr double kLess = 0.8, kNearly = 0.95;  // what the law leaves of u over what the model leaves of y
    const double restless = restlessness(beginning(full));
    if (restless < kHardly) return;
    const CleanRecord record = condensed(full, kMaxFitted);
    const std::optional<SetPointPart> law = set_point_part(input_at_samples(record), record.y);
    const double left = 1 - model.fit_percent / 100, unexplained = left * left;
    if (!law) return;
    const double by_law = (1 - law->share) / unexplained, error = gain_error(model);
    const bool at_once = by_law < kNearly && restless > kSomewhat && answers_at_once(model);
    const bool in_doubt = (error > kUnknown && by_law < kLess) || (restless > kPlainly && by_law < 1) || at_once;
    if (!in_doubt) return;
    LoopRecord loop;
    loop.found.evidence = "u moves restlessly, and filters of y explain " + text(100 * law->share, 3) +
                          " % of its variance, where the model explains " +
                          text(100 * std::max(0.0, 1 - unexplained), 3) + " % of y's.";
    model.data_quality.closed_loop = loop.found;
    model.warnings.insert(model.warnings.begin(),
                          {"closed-loop",
                           "A controller seems to move u in answer to y: " + loop.found.evidence +
                               " Then the model may be the controller's inverse in place of the plant: "
                               "step u in manual, or step the set point and record it as column r.",
                           WarningLevel::bad});
}

void report_loop(const LoopRecord& loop, IdentifiedModel& model) {
    std::string detail = "A controller moves u in answer to y: " + loop.found.evidence;
    switch (loop.found.used) {
        case LoopExcitation::set_point:
            detail +=
                " The model rests on what the moves of the set point did alone; disturbances that the controller "
                "answered count as noise in its standard errors.";
            break;
        case LoopExcitation::outside_moves:
            detail +=
                " The model rests on the moves of u that y does not explain, taken for moves of the set point. Record "
                "the set point as column r.";
            break;
        case LoopExcitation::none:
            detail +=
                " The formula asked for does not know of feedback: its figures may be the controller's in place of the "
                "plant's.";
            break;
    }
    model.data_quality.closed_loop = loop.found;
    model.warnings.insert(model.warnings.begin(), {"closed-loop", detail});
}

}  // namespace tunewright
