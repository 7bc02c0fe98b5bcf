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
    if (replay->travel_ratio)
        draft.say(" and ")
            .number("travel_ratio", *replay->travel_ratio)
            .say(" times the travel of the controller output");
    return draft.say(".");
}

}  // namespace tunewright::verdict
