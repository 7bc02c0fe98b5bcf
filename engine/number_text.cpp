#include "engine/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tunewright {

std::string text(double x, int digits) { return fmt::format("{:.{}g}", x, digits); }

std::string figure_text(double x, int digits) {
    constexpr double kSmallest = 1e-3, kLargest = 1e5;
    const std::string scientific = fmt::format("{:.{}e}", x, digits - 1);
    const double rounded = std::strtod(scientific.c_str(), nullptr);
    const double size = std::abs(rounded);
    if (size == 0) return "0";
    if (size >= kSmallest && size < kLargest)
        return fmt::format("{:.{}f}", rounded,
                           std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size)))));
    const std::size_t e = scientific.find('e');
    return scientific.substr(0, e + 1) + std::to_string(std::atoi(scientific.c_str() + e + 1));
}

std::string exact_text(double x) { return fmt::format("{}", x); }

std::string counted(int count, const std::string& one) {
    return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace tunewright
