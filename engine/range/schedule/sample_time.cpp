#include "engine/range/schedule/design_schedule.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/evaluation/longest_sample_time.h"
#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/range/schedule/look.h"

namespace tunewright::range {
namespace {

std::optional<double> longest_of(const LinearPlant& plant, const IdealPid& pid, const std::stop_token& stop) {
    const auto loop = Loop::make(plant, to_parallel(pid));
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    const Peak S = find_sensitivity_peak(*loop, make_peak_grid(*loop));
    if (!(S.omega > 0) || !std::isfinite(S.omega)) return std::nullopt;
    return tunewright::longest_sample_time(plant, to_parallel(pid), S.value, S.omega, kMsAsSampled, stop).value;
}

}  // namespace

Expected<std::optional<double>> longest_sample_time(const RangeModel& model, const Schedule& schedule,
                                                    const std::stop_token& stop) {
    std::vector<double> places = model.points();
    for (const ScheduleRow& row : schedule.rows)
        if (row.at > model.low() && row.at < model.high()) places.push_back(row.at);
    std::optional<double> least;
    for (const double at : places) {
        const auto place = model.at(at);
        if (!place) return place.error();
        if (!place->nominal) continue;
        for (const IdealPid& pid : in_use(schedule, at))
            if (const auto longest = longest_of(*place->nominal, pid, stop))
                least = std::min(least.value_or(*longest), *longest);
    }
    return least;
}

}  // namespace tunewright::range
