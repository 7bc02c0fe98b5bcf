// A quantity, or the sentence that says why it has no value.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace tunewright {

/// Used like a std::optional. An empty one without a reason of its own has the reason that the figure's description
/// states.
template <class T>
struct OrReason {
    std::optional<T> value = {};
    std::string why = {};  ///< the reason, as a sentence, if there is no value

    OrReason() = default;
    OrReason(T content) : value(std::move(content)) {}                 // NOLINT(google-explicit-constructor)
    OrReason(std::optional<T> content) : value(std::move(content)) {}  // NOLINT(google-explicit-constructor)
    OrReason(std::optional<T> content, std::string reason) : value(std::move(content)) {
        if (!value) why = std::move(reason);
    }

    bool has_value() const { return value.has_value(); }
    explicit operator bool() const { return value.has_value(); }
    const T& operator*() const { return *value; }
    const T* operator->() const { return &*value; }
    T value_or(T fallback) const { return value.value_or(std::move(fallback)); }
    operator const std::optional<T>&() const { return value; }  // NOLINT(google-explicit-constructor)
};

using Figure = OrReason<double>;

inline Figure no_figure(std::string reason) { return {std::nullopt, std::move(reason)}; }

/// The value if it is finite, else the reason.
inline Figure finite_or(double value, std::string reason) {
    return std::isfinite(value) ? Figure(value) : no_figure(std::move(reason));
}

}  // namespace tunewright
