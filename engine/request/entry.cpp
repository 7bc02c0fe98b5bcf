#include "engine/request/entry.h"

#include "engine/evaluation/response_pair.h"

namespace tunewright {

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
