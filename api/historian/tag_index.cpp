#include "api/historian/tag_index.h"

namespace tunewright::api {

std::optional<std::size_t> TagIndex::find_or_add(std::string_view tag) {
    // Most files repeat one order of tags, or one tag: these comparisons save the search.
    if (!tags_.empty()) {
        if (tags_[last_] == tag) return last_;
        if (tags_[followers_[last_]] == tag) return last_ = followers_[last_];
    }
    const auto known = numbers_.find(tag);
    std::size_t number = tags_.size();
    if (known != numbers_.end()) {
        number = known->second;
    } else {
        if (tags_.size() == kMaxLoopTags) return std::nullopt;
        numbers_.emplace(tag, number);
        tags_.emplace_back(tag);
        followers_.push_back(0);
    }
    followers_[last_] = number;
    return last_ = number;
}

}  // namespace tunewright::api
