#include "engine/check/cause.h"

namespace tunewright::check {

Cause cause_of(const CauseQuestion&, const std::stop_token&) {
    Cause cause;
    cause.why_open = "The record does not tell.";
    return cause;
}

Cause insufficient(const RecordQuality& quality) {
    Cause cause{.verdict = Verdict::insufficient_data};
    for (const Warning& remark : quality.remarks)
        if (remark.level == WarningLevel::bad && cause.why_open.empty()) cause.why_open = remark.detail;
    return cause;
}

}  // namespace tunewright::check
