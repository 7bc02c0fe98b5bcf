#include "engine/request/verdict/findings.h"

#include <cmath>

namespace tunewright::verdict {
namespace {

constexpr double kSame = 1.15;      // ratios between its inverse and itself are no difference
constexpr double kMovesMore = 1.5;  // times the movement of u today
constexpr double kMovesMuchMore = 3;
constexpr double kOvershootPercent = 15;  // worth a word

struct Share {
    double low, high;
    const char* words;
};

/// Ranges of a ratio that plain words are right for.
constexpr Share kShares[] = {{0.09, 0.11, "about a tenth of"},
                             {0.18, 0.22, "about a fifth of"},
                             {0.22, 0.285, "about a quarter of"},
                             {0.3, 0.37, "about a third of"},
                             {0.46, 0.54, "about half of"},
                             {0.63, 0.7, "about two thirds of"},
                             {0.72, 0.78, "about three quarters of"},
                             {1 / kSame, kSame, "about the same as"},
                             {1.9, 2.1, "about twice"},
                             {2.85, 3.15, "about three times"}};

const Performance* todays_performance(const Case& c) {
    if (c.today == nullptr) return nullptr;
    return &performance_of(*c.today);
}

}  // namespace

void say_ratio(Draft& draft, double ratio) {
    for (const Share& share : kShares)
        if (ratio >= share.low && ratio <= share.high) {
            draft.say(share.words).figure("ratio", ratio);
            return;
        }
    if (ratio < 1)
        draft.number("percent", 100 * ratio, "%").say(" of").figure("ratio", ratio);
    else
        draft.number("ratio", ratio).say(" times");
}

Found load_error(const Case& c) {
    const Figure& IAE = c.performance().load.IAE;
    if (!IAE) return {};
    const Labels& labels = c.context.labels;
    Draft draft(c.today != nullptr ? "against-today" : "load-error", Level::note);
    draft.say("A load step gives an integrated absolute error of ")
        .number("load_IAE", *IAE, product_unit(labels.y, labels.time));
    const Performance* today = todays_performance(c);
    if (today == nullptr) return draft.say(".");
    const Robustness& runs = c.today->as_built ? c.today->as_built->loop.robustness : c.today->evaluation->robustness;
    if (!runs.stable) return draft.say("; today's settings are unstable.");
    if (!today->load.IAE || !(*today->load.IAE > 0)) return draft.say("; today's settings have none that is finite.");
    const double ratio = *IAE / *today->load.IAE;
    draft.level(ratio > kSame ? Level::warning : ratio < 1 / kSame ? Level::good : Level::note).say(": ");
    say_ratio(draft, ratio);
    return draft.say(" today's ").number("load_IAE_today", *today->load.IAE).say(".");
}

Found overshoot(const Case& c) {
    const Figure& percent = c.performance().setpoint.overshoot_percent;
    if (!percent || *percent < kOvershootPercent) return {};
    Draft draft("overshoot", Level::note);
    draft.say("A set-point step overshoots by ").number("overshoot_percent", *percent, "%");
    const auto pid = to_ideal(c.evaluation.controller);
    if (std::holds_alternative<Npid>(c.evaluation.controller) || !pid) return draft.say(".");
    return draft.say(pid->b > 0 ? "; a lower set-point weight b or a filtered set point avoids it."
                                : "; a filtered set point avoids it.");
}

Found movement(const Case& c) {
    const Performance* today = todays_performance(c);
    const Figure& TV = c.performance().setpoint.TV;
    if (today == nullptr || !TV || !today->setpoint.TV || !(*today->setpoint.TV > 0)) return {};
    const double ratio = *TV / *today->setpoint.TV;
    if (ratio < kMovesMore) return {};
    const std::string unit = printed_unit(c.context.labels.u);
    Draft draft("movement", ratio > kMovesMuchMore ? Level::warning : Level::note);
    draft.say("The controller output moves ")
        .number("ratio", ratio)
        .say(" times as much as today on a set-point step (TV ");
    return draft.number("TV", *TV, unit)
        .say(" against ")
        .number("TV_today", *today->setpoint.TV, unit)
        .say("). If that wears the actuator, ask for a lower Ms or raise Tf.");
}

Found at_its_limits(const Case& c) {
    if (!c.warned_of("actuator-limited")) return {};
    return Draft("at-limits", Level::warning)
        .say(
            "The controller output reaches its limit on these steps; Ms and the margins hold only between the limits.");
}

}  // namespace tunewright::verdict
