#include "engine/identification/closed_loop.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/identification/diagnosis.h"
#include "engine/identification/feedback.h"
#include "engine/identification/instrument_fit.h"
#include "engine/identification/model_answer.h"
#include "engine/identification/model_search.h"
#include "engine/identification/record_kind.h"
#include "engine/identification/wording.h"

namespace tunewright {
namespace {

constexpr int kMostFitted = 20'000;

/// r at the record's samples, dimensionless as y; empty where the record has none, or it only tracks y.
std::vector<double> set_point_at_samples(const CleanRecord& clean, const Record& record) {
    std::vector<std::pair<double, double>> known;
    for (std::size_t i = 0; i < record.r.size(); ++i) {
        if (std::isfinite(record.t[i]) && std::isfinite(record.r[i])) known.emplace_back(record.t[i], record.r[i]);
    }
    if (known.empty()) return {};
    std::stable_sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const RecordScale& s = clean.scale;
    constexpr double kRounding = 1e-9, kSame = 1e-3;
    std::vector<double> r;
    std::size_t next = 0;
    double now = known.front().second;
    int tracking = 0;
    for (int i = 0; i < clean.samples(); ++i) {
        const double t = s.t_origin + s.t_scale * (clean.t[i] + kRounding);
        for (; next < known.size() && known[next].first <= t; ++next) now = known[next].second;
        r.push_back((now - s.y_origin) / s.y_scale);
        const bool moved = i > 0 && r[i] != r[i - 1];
        tracking += moved && std::abs(r.back() - clean.y[i]) < kSame ? 1 : 0;
    }
    return 2 * tracking > clean.samples() ? std::vector<double>{} : r;
}

/// A set point of which only the moves are known.
std::vector<double> steps_at_samples(const std::vector<OutsideMove>& moves, int samples) {
    std::vector<double> w(static_cast<std::size_t>(samples), 0.0);
    for (const OutsideMove& move : moves) {
        for (int i = move.row; i < samples; ++i) w[static_cast<std::size_t>(i)] += move.size;
    }
    return w;
}

std::string evidence_of(const std::optional<Feedback>& feedback, const SetPointPart* part, const RecordScale& scale) {
    if (feedback) {
        return "y, " + std::string(feedback->at_once ? "of the same and earlier rows" : "of earlier rows") +
               ", predicts the moves of u within " + number_text(feedback->by_y * scale.u_scale, 3) +
               " where u's own past leaves " + number_text(feedback->by_u * scale.u_scale, 3) + ".";
    }
    return "u follows the set point: its moves explain " + number_text(100 * part->share, 3) + " % of u's variance.";
}

Error nothing_outside(const CleanRecord& r, const LoopRecord& loop, const std::string& why) {
    const auto [low, high] = std::minmax_element(r.v_level.begin(), r.v_level.end());
    const double u_range = (std::max(*high, 0.0) - std::min(*low, 0.0)) * r.scale.u_scale;
    return {ErrorKind::not_identifiable, "record",
            "The record is of a closed loop (" + loop.told.evidence.substr(0, loop.told.evidence.size() - 1) + "), " +
                why + ": the plant cannot be told from the controller. Put the controller in manual and step u by " +
                number_text(u_range, 2) + " or so, or step the set point by " + number_text(2 * r.scale.y_scale, 2) +
                " or so (twice what y moves here) and record it as column r."};
}

/// The search's structures by instrumental variables; the chosen one's mismatch.
struct Refined {
    Search search;
    double mismatch = 0, gain_error = 0;
};

std::optional<Refined> refined(Search search, const CleanRecord& record, const SetPointPart& part,
                                        std::stop_token stop) {
    if (search.choice.index < 0 || !responds(search.context.record, search.chosen())) return std::nullopt;
    search.context.record = record;
    Refined out{std::move(search), 0, 0};
    for (std::size_t i = 0; i < out.search.fits.size(); ++i) {
        Fit& fit = out.search.fits[i];
        const bool chosen = static_cast<int>(i) == out.search.choice.index;
        if (!fit.determined) continue;
        std::optional<InstrumentFit> better = fit_by_instrument(record, part, fit, stop);
        if (!better && chosen) return std::nullopt;
        fit.determined = better.has_value();
        if (!better) continue;
        fit = std::move(better->fit);
        out.search.percents[i] = fit_percent(record, fit);
        if (chosen) out.mismatch = better->mismatch, out.gain_error = better->gain_error;
    }
    return out;
}

}  // namespace

Expected<std::optional<LoopRecord>> find_loop(const CleanRecord& record, const Record& as_given) {
    constexpr double kFollows = 0.05, kPlain = 10;
    if (!as_given.r.empty() && as_given.r.size() != as_given.t.size()) {
        return Error{ErrorKind::invalid_argument, "record/r",
                     "r has " + std::to_string(as_given.r.size()) + " values and t " +
                         std::to_string(as_given.t.size()) + "; give columns of equal length."};
    }
    const RecordKind kind = record.kind == RecordKind::automatic ? found_kind(record) : record.kind;
    if (kind == RecordKind::relay) return std::optional<LoopRecord>{};
    const std::optional<Feedback> feedback = find_feedback(record);
    const std::vector<double> r = set_point_at_samples(record, as_given);
    LoopRecord loop;
    if (!r.empty()) {
        loop.part = set_point_part(input_at_samples(record), r);
        loop.told.used = LoopExcitation::set_point;
    } else if (feedback && !feedback->outside.empty()) {
        loop.part = set_point_part(input_at_samples(record), steps_at_samples(feedback->outside, record.samples()));
        loop.told.used = LoopExcitation::outside_moves;
    }
    const bool follows = loop.part && loop.part->share > kFollows && loop.part->strength > kPlain;
    if (!feedback && !follows) return std::optional<LoopRecord>{};
    loop.told.evidence = evidence_of(feedback, loop.part ? &*loop.part : nullptr, record.scale);
    if (loop.part) loop.told.share = loop.part->share;
    if (!loop.part) loop.told.used = LoopExcitation::none;
    return std::optional<LoopRecord>(std::move(loop));
}

Expected<IdentifiedModel> identify_in_loop(const CleanRecord& full, const LoopRecord& loop, ModelChoice model,
                                           const RunControl& control) {
    constexpr double kWeak = 4, kUnknown = 0.5, kPlainlyLess = 10;
    if (!loop.part) return nothing_outside(full, loop, "and nothing but feedback moves u");
    if (loop.part->strength < kWeak)
        return nothing_outside(full, loop, "and moves of the set point explain too little of u (" +
                                               number_text(100 * loop.part->share, 2) + " %)");
    const CleanRecord& record = full;
    const auto cancelled = [] { return Error{ErrorKind::cancelled, "", "The identification was cancelled."}; };
    auto direct = refined(search_models(record, model, false, control), record, *loop.part, control.stop);
    if (control.stop.stop_requested()) return cancelled();
    auto two_stage =
        refined(search_models(driven_by(*loop.part, record), model, false, control), record, *loop.part, control.stop);
    if (control.stop.stop_requested()) return cancelled();
    const bool second = two_stage && (!direct || two_stage->mismatch + kPlainlyLess < direct->mismatch);
    std::optional<Refined>& best = second ? two_stage : direct;
    if (!best) return nothing_outside(full, loop, "and y does not plainly follow the moves from outside the loop");
    if (!(best->gain_error < kUnknown)) {
        return nothing_outside(full, loop,
                               "and the moves from outside the loop leave the gain unknown (its standard error is " +
                                   number_text(100 * best->gain_error, 2) + " % of it)");
    }
    return searched_model(std::move(best->search), full);
}

void tell_loop(const LoopRecord& loop, IdentifiedModel& model) {
    std::string detail = "A controller moves u in answer to y: " + loop.told.evidence;
    switch (loop.told.used) {
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
    model.data_quality.closed_loop = loop.told;
    model.warnings.insert(model.warnings.begin(), {"closed-loop", detail});
}

}  // namespace tunewright
