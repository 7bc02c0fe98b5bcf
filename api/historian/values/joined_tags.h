// Tags of one loop that each have times of their own, joined to rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "api/historian/tagged_loop.h"

namespace tunewright::api {

/// Values of one tag at its own times; NaN: bad or missing.
struct TagValues {
    std::vector<double> t, value;
};

/// Modes of one loop at their own times, as indices in TaggedLoop::mode_words.
struct TagModes {
    std::vector<double> t;
    std::vector<std::uint8_t> mode;
};

/// Sorts by time if necessary. Of several values at one time the first is kept.
void put_in_order(TagValues& tag);
void put_in_order(TagModes& tag);

/// The reason why the tags of y and u, with these names, are no loop: the times of u begin after those of y. "" if they
/// do not.
std::string apart_sentence(const TagValues& y, const std::string& y_name, const TagValues& u,
                           const std::string& u_name);

/// The rows of a loop from tags in the order of time, in three steps.
///
/// 1. The rows are the times of y.
/// 2. If the times of y are irregular or fewer than 20, y was stored only when it changed: where it is silent for more
///    than 2.5 of its usual spacings (of those of u if y is so short), the times of u become rows too, and y holds its
///    value there. If they are regular, such a silence is a gap.
/// 3. u, r and the mode hold their last value.
void join_tags(const TagValues& y, const TagValues& u, const TagValues& r, const TagModes& mode, TaggedLoop& loop);

}  // namespace tunewright::api
