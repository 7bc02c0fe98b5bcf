// A described member of a struct: the element of all descriptions of types, also of those of methods' options
// (tuning/method/option_set.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tunewright {

/// The limits that a number must keep, as far as they are given.
struct NumberRule {
    std::optional<double> minimum = {}, exclusive_minimum = {}, maximum = {}, exclusive_maximum = {};
    bool not_zero = false;
    std::string cure = {};  ///< a sentence that is added when the rule is broken

    /// True if `value` lies between the limits.
    bool between(double value) const {
        return !(minimum && value < *minimum) && !(exclusive_minimum && value <= *exclusive_minimum) &&
               !(maximum && value > *maximum) && !(exclusive_maximum && value >= *exclusive_maximum);
    }
};

/// The words of an enumeration, in the order in which they are listed.
template <class E>
using Words = std::vector<std::pair<std::string, E>>;

/// The first word of a value; "" where it has none.
template <class E>
std::string word_of(const Words<E>& words, const E& value) {
    for (const auto& [word, known] : words)
        if (known == value) return word;
    return {};
}

/// Bytes from the start of `object` to a member. Members of one type that are known by this distance share their code
/// in all structs. `Owner` is T or its base.
template <class T, class M, class Owner>
std::ptrdiff_t offset_of(const T& object, M Owner::*member) {
    return reinterpret_cast<const char*>(&(object.*member)) - reinterpret_cast<const char*>(&object);
}

inline void* member_at(void* object, std::ptrdiff_t offset) { return static_cast<char*>(object) + offset; }
inline const void* member_at(const void* object, std::ptrdiff_t offset) {
    return static_cast<const char*>(object) + offset;
}

}  // namespace tunewright
