#include "engine/request/verdict/findings.h"

namespace tunewright::verdict {

OptionalFinding replayed(const VerdictInput& c) {
    const auto& replay = c.entry.replay;
    if (!replay || replay->refused || c.is_today()) return {};
    const Level level = replay->IAE_ratio_high < 1  ? Level::good
                        : replay->IAE_ratio_low > 1 ? Level::warning
                                                    : Level::note;
    FindingBuilder draft("replay", level);
    draft.say("Over the recorded time these settings would have given ")
        .number("IAE_ratio", replay->IAE_ratio)
        .say(" times the integrated absolute error of the record (between ")
        .number("IAE_ratio_low", replay->IAE_ratio_low)
        .say(" and ")
        .number("IAE_ratio_high", replay->IAE_ratio_high)
        .say(")");
    draft.say(".");
    // The model's u moves more than the recorded one even with today's settings: like is compared with like.
    const auto* today =
        c.today != nullptr && c.today->replay && !c.today->replay->refused ? &*c.today->replay : nullptr;
    if (today != nullptr && today->figures.travel > 0)
        draft.say(" The controller output would travel ")
            .number("travel_over_today", replay->figures.travel / today->figures.travel)
            .say(" times as far as in the replay of today's settings.");
    else if (replay->travel_ratio)
        draft.say(" The controller output would travel ")
            .number("travel_ratio", *replay->travel_ratio)
            .say(" times as far as in the record.");
    return draft;
}

}  // namespace tunewright::verdict
