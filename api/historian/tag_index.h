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

}  // namespace tunewright::api
