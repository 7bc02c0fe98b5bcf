#include "api/historian/values/mode_track.h"

#include <algorithm>

#include "api/csv/cell.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxWords = 100, kMaxWordLength = 40;

}  // namespace

void ModeTrack::see(std::string_view cell) {
    if (cell == last_cell_ || is_missing(cell)) return;
    last_cell_ = std::string(cell);
    now_ = index_of(cell);
}

std::uint8_t ModeTrack::index_of(std::string_view cell) {
    double code = 0;
    const bool number = read_cell_number(cell, code);
    const auto level = number ? std::nullopt : switch_word(cell);
    const auto meaning = codes_.find(level.value_or(code));
    std::string word(cell);
    if ((number || (level && !mode_word(cell))) && meaning != codes_.end()) {
        word = meaning->second ? "AUTO" : "MAN";
    } else if (number) {
        if (unknown_code_.empty()) unknown_code_ = word;
        if (codes_.empty()) return 0;
        word.insert(0, "code ");
    }
    if (word.size() > kMaxWordLength) return 0;
    const auto found = std::ranges::find(words_, word);
    if (found != words_.end()) return static_cast<std::uint8_t>(found - words_.begin());
    if (words_.size() > kMaxWords) return 0;
    words_.push_back(std::move(word));
    return static_cast<std::uint8_t>(words_.size() - 1);
}

}  // namespace tunewright::api
