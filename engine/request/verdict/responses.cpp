#include "engine/request/verdict/cures.h"
#include "engine/request/verdict/findings.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/setpoint.h"

#include <cmath>

namespace tunewright::verdict {
namespace {

struct RatioPhrase {
    double low, high;
    const char* words;
};

/// Ranges of a ratio that are put into words.
constexpr RatioPhrase kRatioPhrases[] = {{0.09, 0.11, "about a tenth of"},
                                         {0.18, 0.22, "about a fifth of"},
                                         {0.22, 0.285, "about a quarter of"},
                                         {0.3, 0.37, "about a third of"},
                                         {0.46, 0.54, "about half of"},
                                         {0.63, 0.7, "about two thirds of"},
                                         {0.72, 0.78, "about three quarters of"},
                                         {1 / kMaxNegligibleRatio, kMaxNegligibleRatio, "about the same as"},
                                         {1.9, 2.1, "about twice"},
                                         {2.85, 3.15, "about three times"}};

/// True: a note on the settings names the lag of the set point that the design has and the product does not.
bool lag_is_noted(const VerdictInput& c) {
    return c.on_device() && std::ranges::any_of(c.entry.on_device->fitted.notes,
                                                [](const auto& note) { return note.code == "setpoint-filter"; });
}

/// Says what keeps the overshoot within `percent`, as tried on the implemented loop; no second lag next to a note's.
void say_cure(FindingBuilder& draft, const VerdictInput& c, double percent) {
    if (lag_is_noted(c)) {
        if (const auto ramp = overshoot_ramp(c, percent))
            draft.say(" A ramp of the set point over ")
                .number("setpoint_ramp", *ramp, printed_unit(c.context.labels.time))
                .say(" keeps it within ")
                .number("kept_percent", percent, "%")
                .say(".");
        return;
    }
    const auto cure = overshoot_cure(c, percent);
    if (!cure) return;
    const std::string time = printed_unit(c.context.labels.time);
    const bool product = c.on_device() && c.entry.on_device->fitted.product != nullptr;
    const auto ramp = product && cure->lag > 0 ? overshoot_ramp(c, percent) : std::nullopt;
    if (cure->lag > 0)
        draft.say(" A first-order lag of ").number("setpoint_lag", cure->lag, time).say(" on the set point");
    else
        draft.say(" A set-point weight b of ").number("b", cure->b);
    if (ramp) draft.say(", or a ramp of it over ").number("setpoint_ramp", *ramp, time).say(",");
    draft.say(" keeps it within ").number("kept_percent", percent, "%").say(".");
    if (ramp)
        draft.say(" Where the controller has neither, change the set point in small steps over the time of the ramp.");
}

const Performance* todays_performance(const VerdictInput& c) {
    if (c.today == nullptr) return nullptr;
    return &performance_of(*c.today);
}

}  // namespace

std::optional<Level> overshoot_level(const VerdictInput& c) {
    const Figure& percent = c.performance().setpoint.overshoot_percent;
    if (!percent) return {};
    const auto asked = c.entry.asked_overshoot, limit = setpoint_options(c.entry.options).overshoot;
    if (asked ? *percent > *asked + kOvershootFarAbove : *percent > kLargeOvershootPercent) return Level::warning;
    if (limit ? *percent > *limit + kOvershootAbove : *percent >= kOvershootPercent) return Level::note;
    return {};
}

void say_ratio(FindingBuilder& draft, double ratio) {
    for (const RatioPhrase& share : kRatioPhrases)
        if (ratio >= share.low && ratio <= share.high) {
            draft.say(share.words).figure("ratio", ratio);
            return;
        }
    if (ratio < 1)
        draft.number("percent", 100 * ratio, "%").say(" of").figure("ratio", ratio);
    else
        draft.number("ratio", ratio).say(" times");
}

OptionalFinding load_error(const VerdictInput& c) {
    const Figure& IAE = c.performance().load.IAE;
    if (!IAE) return {};
    const Labels& labels = c.context.labels;
    FindingBuilder draft(c.today != nullptr ? "against-today" : "load-error", Level::note);
    draft.say("A load step gives an integrated absolute error of ")
        .number("load_IAE", *IAE, product_unit(labels.y, labels.time));
    const Performance* today = todays_performance(c);
    if (today == nullptr) return draft.say(".");
    const Robustness& runs = c.today->on_device ? c.today->on_device->loop.robustness : c.today->evaluation->robustness;
    if (!runs.stable) return draft.say("; today's settings are unstable.");
    if (!today->load.IAE || !(*today->load.IAE > 0)) return draft.say("; that of today's settings is infinite.");
    const double ratio = *IAE / *today->load.IAE;
    draft
        .level(ratio > kMaxNegligibleRatio       ? Level::warning
               : ratio < 1 / kMaxNegligibleRatio ? Level::good
                                                 : Level::note)
        .say(": ");
    say_ratio(draft, ratio);
    return draft.say(" today's ").number("load_IAE_today", *today->load.IAE).say(".");
}

OptionalFinding overshoot(const VerdictInput& c) {
    const Figure& percent = c.performance().setpoint.overshoot_percent;
    const auto level = overshoot_level(c);
    if (!level) return {};
    const auto asked = c.entry.asked_overshoot, limit = setpoint_options(c.entry.options).overshoot;
    FindingBuilder draft("overshoot", *level);
    draft.say("The response to a set-point step overshoots by ").number("overshoot_percent", *percent, "%");
    if (asked)
        draft.say(", more than the ").number("asked_percent", *asked, "%").say(" asked for");
    else if (limit)
        draft.say(", more than the ").number("design_percent", *limit, "%").say(" of the design");
    draft.say(".");
    say_cure(draft, c, limit.value_or(limits::kDefaultMaxOvershootPercent));
    return draft;
}

OptionalFinding movement(const VerdictInput& c) {
    const Performance* today = todays_performance(c);
    const Figure& TV = c.performance().setpoint.TV;
    if (today == nullptr || !TV || !today->setpoint.TV || !(*today->setpoint.TV > 0)) return {};
    const double ratio = *TV / *today->setpoint.TV;
    if (ratio < kMinRatioMovesMore) return {};
    const std::string unit = printed_unit(c.context.labels.u);
    FindingBuilder draft("movement", ratio > kMinRatioMovesMuchMore ? Level::warning : Level::note);
    draft.say("The controller output moves ")
        .number("ratio", ratio)
        .say(" times as much as today after a set-point step (TV ");
    return draft.number("TV", *TV, unit).say(" against ").number("TV_today", *today->setpoint.TV, unit).say(").");
}

}  // namespace tunewright::verdict
