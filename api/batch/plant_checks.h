// The judgement of a batch of checks, from the results of its entries.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "engine/check/loop_check.h"

namespace tunewright::api {

/// One entry that has ended.
struct CheckEntry {
    std::int64_t index = 0;
    std::string_view id, name;
    std::string_view result, error;  ///< JSON; "" if none
};

class PlantChecks {
public:
    /// The parts of a loop that the answer has in addition to its figures.
    enum class Kept { trend, none };
    struct Source {
        std::int64_t index = 0;  ///< of the entry
        std::size_t place = 0;   ///< of the loop in the result of the entry
    };
    /// An entry without an answer.
    struct Failed {
        std::string name, reason;
    };

    explicit PlantChecks(Kept kept = Kept::trend) : kept_(kept) {}

    /// The loops are named by their place in what is added.
    void add(const CheckEntry& entry);

    std::size_t loops() const { return checks_.size(); }
    const Source& source(std::size_t loop) const { return sources_[loop]; }
    const std::vector<Failed>& failed() const { return failed_; }

    /// BatchCheck of the document. `before`: an earlier batch of the same loops, or null.
    std::string answer(bool complete, const PlantChecks* before) const;

private:
    Kept kept_;
    std::deque<check::LoopCheck> checks_;
    std::vector<std::string> texts_;  ///< of each loop, an object without its end, its cause and its action
    std::vector<Source> sources_;     ///< of each loop
    std::vector<Failed> failed_;
};

}  // namespace tunewright::api
