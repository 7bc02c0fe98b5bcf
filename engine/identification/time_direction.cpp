#include "engine/identification/time_direction.h"

#include <algorithm>
#include <string>
#include <utility>

#include "engine/identification/model_grade.h"
#include "engine/number_text.h"

namespace tunewright {
namespace {

std::string fits(const IdentifiedModel& a, const IdentifiedModel& b) {
    return "(fit " + text(a.fit_percent, 4) + " % against " + text(b.fit_percent, 4) + " %)";
}

void add(IdentifiedModel& model, const std::string& detail, WarningLevel level) {
    std::erase_if(model.warnings, [](const Warning& warning) { return warning.code == "reversed-time"; });
    model.warnings.insert(model.warnings.begin(), {"reversed-time", detail, level});
}

}  // namespace

Record counted_down(const Record& record) {
    Record out = record;
    for (double& t : out.t) t = -t;
    return out;
}

Expected<IdentifiedModel> model_in_time(Expected<IdentifiedModel> newest_first, Expected<IdentifiedModel> countdown,
                                        bool in_loop) {
    constexpr double kMaxShareOfOther = 0.5;  // relative to the residual of the other direction
    const std::string counted =
        "The times count down from row to row; the rows were used in their order, at the times "
        "-t: ";
    if (!countdown) return newest_first;
    const bool may_be_inverse = in_loop || countdown->data_quality.closed_loop;
    if (!newest_first) {
        if (may_be_inverse) return newest_first;
        add(*countdown, counted + "in reversed order, from the newest row to the oldest, no plant was found.",
            WarningLevel::warning);
        return countdown;
    }
    const double turned = share_left_by(*newest_first), as_they_stand = share_left_by(*countdown);
    if (turned < kMaxShareOfOther * as_they_stand) return newest_first;
    if (as_they_stand < kMaxShareOfOther * turned && !may_be_inverse) {
        add(*countdown,
            counted + "in this order y follows u, in reversed order it does not " + fits(*countdown, *newest_first) +
                ".",
            WarningLevel::warning);
        return countdown;
    }
    add(*newest_first,
        "The times fall from row to row, and y follows u in both directions " + fits(*newest_first, *countdown) +
            "; the rows were assumed to run from the newest to the oldest. If the times count down instead, the gain K "
            "and the lags are wrong: give ascending times.",
        WarningLevel::bad);
    return newest_first;
}

}  // namespace tunewright
