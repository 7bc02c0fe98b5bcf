#include "engine/identification/closed_loop/loop_record.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/closed_loop/loop_parts.h"
#include "engine/identification/closed_loop/recognised_law.h"
#include "engine/identification/record/record_kind.h"
#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr int kMaxSeen = 20'000;                             ///< rows
constexpr double kMinSetPointShare = 0.05, kMinFRatio = 10;  ///< share of u's variance; F ratio

std::string by_news(const Feedback& feedback, const RecordScale& scale) {
    return "y, " + std::string(feedback.at_once ? "of the same and earlier rows" : "of earlier rows") +
           ", predicts the moves of u within " + text(feedback.by_y * scale.u_scale, 3) +
           ", while u's own past predicts them within " + text(feedback.by_u * scale.u_scale, 3) + ".";
}

/// Number of steps of a set point at the samples: changes below 2 % of its range do not count, and a ramp counts as
/// one.
int moves_of(const std::vector<double>& r) {
    constexpr double kMaxJitter = 0.02;
    const auto [low, high] = std::ranges::minmax(r);
    int moves = 0;
    double last = 0;
    for (std::size_t i = 1; i < r.size(); ++i) {
        const double change = r[i] - r[i - 1];
        const bool moved = std::abs(change) > kMaxJitter * (high - low);
        if (moved && change * last <= 0) ++moves;
        last = moved ? change : 0;
    }
    return moves;
}

HeldColumn mode_of(const Record& record) {
    return held_column(record.t, {record.automatic.begin(), record.automatic.end()});
}

/// A law that explains u much better than u explains y.
struct PlainLaw {
    double gain = 0;
    std::string evidence;
};

std::optional<PlainLaw> plain_law(const CleanRecord& record, const Record& as_given, const SetPoint& set_point,
                                  const std::optional<double>& left_by_model) {
    constexpr double kOfFreePlant = 0.25, kOfModel = 0.5;
    const std::vector<double> u = input_at_samples(record);
    const std::optional<RecognisedLaw> law =
        recognised_law(record, u, set_point.at_samples, at_samples(mode_of(as_given), record));
    // u over y alone also looks like this for a plant that is fast compared with its input.
    if (!law || law->integral == 0) return std::nullopt;
    const double left_of_y = left_by_model ? *left_by_model : left_by_free_plant(record, u);
    if (!(law->left < (left_by_model ? kOfModel : kOfFreePlant) * left_of_y)) return std::nullopt;
    return PlainLaw{law->gain,
                    "the law of a controller, with y and its integral, leaves "
                    "only " +
                        text(100 * law->left, 2) + " % of u's variance unexplained, while u leaves " +
                        text(100 * left_of_y, 2) + " % of y's."};
}

std::string by_set_point(const SetPointPart& part) {
    return "u follows the set point: its moves explain " + text(100 * part.share, 3) + " % of u's variance.";
}

/// Converts kicks that were found in the beginning of the record, with length `length`, to the whole record.
std::vector<OutsideMove> of_whole_record(std::vector<OutsideMove> kicks, double length) {
    for (OutsideMove& kick : kicks) kick.time *= length;
    return kicks;
}

/// Chooses the first of the moves from outside that clearly explains u; else the one that explains most.
void choose_excitation(const CleanRecord& record, const SetPoint& set_point, const std::vector<OutsideMove>& kicks,
                       bool u0_given, LoopRecord& loop) {
    const std::vector<double> u = input_at_samples(record);
    double strongest = 0;
    for (const OutsideExcitation& outside : outside_excitations(record, set_point, kicks)) {
        std::optional<SetPointPart> part = set_point_part(u, outside.w, outside.before);
        if (!part || (loop.part && part->strength <= strongest)) continue;
        strongest = part->strength;
        loop.found.used = outside.kind;
        loop.found.share = part->share;
        loop.moved_at_first_row = outside.at_first_row;
        loop.part = std::move(part);
        loop.u_rest.reset();
        if (!u0_given) loop.u_rest = level_before_set_point(record, outside.w);
        if (loop.part->share > kMinSetPointShare && loop.part->strength > kMinFRatio) return;
    }
}

double u_span(const CleanRecord& r) {
    const auto [low, high] = std::ranges::minmax(r.v_level);
    return (std::max(high, 0.0) - std::min(low, 0.0)) * r.scale.u_scale;
}

}  // namespace

IdentifiedLoop identified_loop(CleanRecord clean, SetPoint set_point, const Record& record) {
    const bool none = set_point.at_samples.empty();
    return {.clean = std::move(clean),
            .set_point = none ? HeldColumn{} : std::move(set_point.column),
            .automatic = mode_of(record),
            .switched_on = set_point.on.has_value()};
}

CleanRecord looked_at_for_feedback(const CleanRecord& record) {
    return record.samples() <= kMaxSeen ? record : first_part(record, record.t[static_cast<std::size_t>(kMaxSeen - 1)]);
}

Expected<std::optional<LoopRecord>> find_loop(const CleanRecord& full, const Record& as_given,
                                              std::optional<double> left_by_model) {
    for (const auto& [name, size] : {std::pair{"r", as_given.r.size()}, {"mode", as_given.automatic.size()}}) {
        if (size == 0 || size == as_given.t.size()) continue;
        return Error{ErrorKind::invalid_argument, std::string("record/") + name,
                     std::string(name) + " has " + std::to_string(size) + " values and t " +
                         std::to_string(as_given.t.size()) + "; give columns of equal length."};
    }
    const RecordKind kind = full.kind == RecordKind::automatic ? found_kind(full) : full.kind;
    if (kind == RecordKind::relay) return std::optional<LoopRecord>{};
    const CleanRecord seen = looked_at_for_feedback(full), record = condensed(full, kMaxLoopSamples);
    const std::optional<Feedback> feedback = find_feedback(seen);
    LoopRecord loop;
    loop.set_point = set_point_of(record, as_given);
    const SetPoint& set_point = loop.set_point;
    if (!set_point.at_samples.empty()) loop.found.set_point_moves = moves_of(set_point.at_samples);
    std::vector<OutsideMove> kicks;
    if (feedback) kicks = of_whole_record(feedback->outside, seen.scale.t_scale / full.scale.t_scale);
    choose_excitation(record, set_point, kicks, full.u0_given, loop);
    const bool follows = set_point.moves && loop.found.used == LoopExcitation::set_point && loop.part &&
                         loop.part->share > kMinSetPointShare && loop.part->strength > kMinFRatio;
    if (feedback) {
        loop.found.evidence = by_news(*feedback, record.scale);
        loop.gain = feedback->gain;
    } else if (follows) {
        loop.found.evidence = by_set_point(*loop.part);
    } else if (may_be_controlled(seen)) {
        const std::optional<PlainLaw> law = plain_law(record, as_given, set_point, left_by_model);
        if (!law) return std::optional<LoopRecord>{};
        loop.found.evidence = law->evidence;
        loop.gain = law->gain;
    } else {
        return std::optional<LoopRecord>{};
    }
    return std::optional<LoopRecord>(std::move(loop));
}

Error no_plant_in_loop(const CleanRecord& r, const LoopRecord& loop, const std::string& why) {
    const double y_span = r.scale.y_scale;
    const std::string cure = "Put the controller in manual and step u by up to " + text(u_span(r), 2) +
                             " (the range of u in this record), or step the set point up and down by up "
                             "to " +
                             text(y_span, 2) + " (the range of y in this record) and record it as column r.";
    return {ErrorKind::not_identifiable, "record",
            "The record is of a closed loop (" + loop.found.evidence.substr(0, loop.found.evidence.size() - 1) + "), " +
                why + ", so the plant cannot be distinguished from the controller. " + cure};
}

}  // namespace tunewright
