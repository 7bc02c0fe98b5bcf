#include "engine/request/entry.h"

#include "engine/evaluation/response_pair.h"
#include "engine/tuning/limits.h"

namespace tunewright {
namespace {

std::optional<PlacedPeak> running(const Figure& ideal, const Figure* on_device) {
    if (on_device != nullptr && *on_device) return PlacedPeak{**on_device, PeakLoop::on_device};
    if (ideal) return PlacedPeak{*ideal};
    return {};
}

}  // namespace

bool PlacedPeak::exceeds(double limit) const {
    return value >
           limit * (1 + (on_worst_plant() ? limits::kMaxRelativeExcessShownOfWorst : limits::kMaxRelativeExcessShown));
}

const std::optional<RegionFigures>& region_of(const TuningEntry& entry) {
    return entry.on_device ? entry.on_device->loop.region : entry.evaluation->region;
}

std::optional<PlacedPeak> worst_Ms(const TuningEntry& entry) {
    auto largest =
        running(entry.evaluation->robustness.Ms, entry.on_device ? &entry.on_device->loop.robustness.Ms : nullptr);
    const auto& region = region_of(entry);
    if (region && region->worst_Ms && (!largest || *region->worst_Ms > largest->value))
        largest = {*region->worst_Ms, PeakLoop::worst_plant};
    return largest;
}

std::optional<PlacedPeak> worst_Mt(const TuningEntry& entry) {
    return running(entry.evaluation->robustness.Mt, entry.on_device ? &entry.on_device->loop.robustness.Mt : nullptr);
}

void draw_together(std::vector<TuningEntry>& entries) {
    std::vector<Responses*> all;
    const auto add = [&](std::optional<Responses>& responses) {
        if (responses) all.push_back(&*responses);
    };
    for (TuningEntry& entry : entries) {
        if (entry.evaluation) {
            add(entry.evaluation->responses);
            if (entry.evaluation->linear) add(entry.evaluation->linear->responses);
        }
        if (entry.on_device) add(entry.on_device->loop.responses);
    }
    draw_together(all);
}

}  // namespace tunewright
