#include "engine/numerics/log_maximum.h"

#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>

namespace tunewright {
namespace {

constexpr int kBits = 26;  // of ln x: half a double's, beyond which the value no longer changes
constexpr std::uintmax_t kMaxIterations = 60;

}  // namespace

Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right) {
    // ln (x/known.x) is near 0 at the maximum: its relative precision counts there.
    auto iterations = kMaxIterations;
    const auto [s, least] =
        boost::math::tools::brent_find_minima([&](double at) { return -f(known.x * std::exp(at)); },
                                              std::log(left / known.x), std::log(right / known.x), kBits, iterations);
    return -least > known.value ? Maximum{known.x * std::exp(s), -least} : known;
}

}  // namespace tunewright
