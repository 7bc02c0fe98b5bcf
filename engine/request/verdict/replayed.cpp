#include <cmath>

#include "engine/request/verdict/findings.h"

namespace tunewright::verdict {

OptionalFinding replayed(const VerdictInput& c) {
    const auto& replay = c.entry.replay;
    if (!replay || replay->refused || c.is_today()) return {};
    const double above = 100 * (replay->IAE_ratio - 1);
    const bool apart = replay->IAE_ratio_low > 1 || replay->IAE_ratio_high < 1;
    FindingBuilder draft("replay", !apart ? Level::note : above < 0 ? Level::good : Level::warning);
    draft.say("Over the recorded time these settings would have given ")
        .number("IAE_percent", 100 * replay->IAE_ratio, "%")
        .say(" of the integrated absolute error (")
        .number("IAE_percent_low", 100 * replay->IAE_ratio_low)
        .say(" to ")
        .number("IAE_percent_high", 100 * replay->IAE_ratio_high)
        .say(" %)");
    if (replay->travel_ratio)
        draft.say(" with ").number("travel_percent", 100 * *replay->travel_ratio, "%").say(" of the output's travel");
    return draft.say(".");
}

}  // namespace tunewright::verdict
