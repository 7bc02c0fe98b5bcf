// Tags of a file with a line for each tag, numbered in the order in which they first appear.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tunewright::api {

/// The maximum number of tags of such a file; one with more is refused.
inline constexpr std::size_t kMaxLoopTags = 20'000;

class TagIndex {
public:
    /// The number of a tag. A new one gets the next number, unless there are kMaxLoopTags already: then empty.
    std::optional<std::size_t> find_or_add(std::string_view tag);

    const std::vector<std::string>& tags() const { return tags_; }

private:
    struct Hash {
        using is_transparent = void;
        std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
    };

    std::vector<std::string> tags_;
    std::vector<std::size_t> followers_;  ///< of each tag: the one that came after it last time
    std::size_t last_ = 0;
    std::unordered_map<std::string, std::size_t, Hash, std::equal_to<>> numbers_;
};

inline std::optional<std::size_t> TagIndex::find_or_add(std::string_view tag) {
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
