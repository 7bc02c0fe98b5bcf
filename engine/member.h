// A described member of a struct: what descriptions of types are made of, those of methods' options
// (tuning/method/option_set.h) among them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tunewright {

/// What a number must keep: every limit that is given.
struct NumberRule {
    std::optional<double> minimum = {}, exclusive_minimum = {}, maximum = {}, exclusive_maximum = {};
    bool not_zero = false;
    std::string cure = {};  ///< a sentence that is added when the rule is broken

    /// Whether `value` lies between the limits.
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

/// Bytes from the start of `object` to a member: known by this distance, members of one type share their code whatever
/// struct they are in. `Owner` is T or what it extends.
template <class T, class M, class Owner>
std::ptrdiff_t offset_of(const T& object, M Owner::*member) {
    return reinterpret_cast<const char*>(&(object.*member)) - reinterpret_cast<const char*>(&object);
}

inline void* member_at(void* object, std::ptrdiff_t offset) { return static_cast<char*>(object) + offset; }
inline const void* member_at(const void* object, std::ptrdiff_t offset) {
    return static_cast<const char*>(object) + offset;
}

}  // namespace tunewright
