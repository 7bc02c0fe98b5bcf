// The judgement of a batch of checks, from the results of its entries.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "engine/check/loop_check.h"

namespace tunewright::api {

class PlantChecks {
public:
    /// One entry that has ended; `result` "": it has no answer. The loops are named by their place in what is added.
    void add(std::int64_t index, std::string_view id, std::string_view result);

    std::size_t loops() const { return checks_.size(); }

    /// BatchCheck of the document. `before`: an earlier batch of the same loops, or null.
    std::string answer(bool complete, const PlantChecks* before) const;

private:
    std::deque<check::LoopCheck> checks_;
    std::vector<std::string> texts_;  ///< of each loop, an object without its end, its cause and its action
    int failed_ = 0;
};

}  // namespace tunewright::api
