#include "engine/tuning/options.h"

namespace tunewright {
namespace {

template <class T>
std::optional<T> find(const std::map<std::string, OptionValue>& values, const std::string& path) {
    const auto at = values.find(path);
    if (at == values.end() || !std::holds_alternative<T>(at->second)) return std::nullopt;
    return std::get<T>(at->second);
}

}  // namespace

std::optional<double> MethodOptions::number(const std::string& path) const { return find<double>(values_, path); }
std::optional<bool> MethodOptions::boolean(const std::string& path) const { return find<bool>(values_, path); }
std::optional<std::string> MethodOptions::text(const std::string& path) const {
    return find<std::string>(values_, path);
}

}  // namespace tunewright
