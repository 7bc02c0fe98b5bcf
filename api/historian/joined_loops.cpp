#include "api/historian/joined_loops.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/csv/cell.h"
#include "api/historian/values/value_cells.h"

namespace tunewright::api {
namespace {

std::size_t numbers_of(const TaggedLoop& loop) { return loop.t.size() + loop.y.size() + loop.u.size() + loop.r.size(); }

/// Appends a column of `to` rows; a column that one part does not have is filled with `none`.
template <class Value>
void append(std::vector<Value>& whole, std::size_t rows, const std::vector<Value>& part, std::size_t part_rows,
            Value none) {
    if (whole.empty() && part.empty()) return;
    whole.resize(rows, none);
    whole.insert(whole.end(), part.begin(), part.end());
    whole.resize(rows + part_rows, none);
}

/// Appends the modes, whose words may have other indices in the other part.
void append_modes(TaggedLoop& whole, const TaggedLoop& part) {
    std::vector<std::uint8_t> modes;
    for (const std::uint8_t mode : part.mode) {
        const std::string& word = part.mode_words[mode];
        if (whole.mode_words.empty()) whole.mode_words.emplace_back();
        auto found = std::ranges::find(whole.mode_words, word);
        if (found == whole.mode_words.end() && whole.mode_words.size() <= std::numeric_limits<std::uint8_t>::max())
            found = whole.mode_words.insert(found, word);
        const bool known = found != whole.mode_words.end();
        modes.push_back(known ? static_cast<std::uint8_t>(found - whole.mode_words.begin()) : std::uint8_t{0});
    }
    append(whole.mode, whole.t.size(), modes, part.t.size(), std::uint8_t{0});
}

}  // namespace

void JoinedLoops::add(const std::string& file, LoopsReader& reader) {
    TaggedLoop loop;
    while (reader.next(loop)) {
        numbers_ += numbers_of(loop);
        const auto [found, fresh] = parts_.try_emplace(lower_case(loop.tag));
        if (fresh)
            found->second = {file, std::move(loop)};
        else
            join(found->second, file, std::move(loop));
    }
}

void JoinedLoops::add_unreadable(const std::string& file, std::string reason) {
    TaggedLoop loop;
    loop.tag = file;
    loop.fault = std::move(reason);
    parts_.try_emplace(lower_case(file), Part{file, std::move(loop)});
}

void JoinedLoops::join(Part& part, const std::string& file, TaggedLoop loop) {
    TaggedLoop& whole = part.loop;
    if (whole.fault && !loop.fault)
        std::swap(whole, loop), whole.notes.push_back(part.file + " was left out: " + *loop.fault);
    else if (loop.fault && !whole.fault)
        whole.notes.push_back(file + " was left out: " + *loop.fault);
    if (whole.fault || loop.fault) return;
    if (!whole.epoch || !loop.epoch || !(seconds_ > 0))
        return set_fault(whole, whole.tag + " is in " + part.file + " and in " + file +
                                    ", and without dates in both the order is not known. Export with dates, or rename "
                                    "the tag in one of them.");
    const double later = (*loop.epoch - *whole.epoch) / seconds_;
    append_modes(whole, loop);
    append(whole.r, whole.t.size(), loop.r, loop.t.size(), kNoNumber);
    for (const double t : loop.t) whole.t.push_back(t + later);
    whole.y.insert(whole.y.end(), loop.y.begin(), loop.y.end());
    whole.u.insert(whole.u.end(), loop.u.begin(), loop.u.end());
    whole.bad += loop.bad;
    whole.notes.insert(whole.notes.end(), loop.notes.begin(), loop.notes.end());
    part.joined = true;
}

std::vector<TaggedLoop> JoinedLoops::take() {
    std::vector<TaggedLoop> out;
    out.reserve(parts_.size());
    for (auto& [key, part] : parts_) {
        if (part.joined) put_rows_in_order(part.loop), hold(part.loop.r);
        out.push_back(std::move(part.loop));
    }
    parts_.clear();
    return out;
}

}  // namespace tunewright::api
