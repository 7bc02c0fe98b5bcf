#include "engine/structure/search/nearby_stability.h"

#include <utility>

namespace tunewright::structure {
namespace {

constexpr double kMostChange = 0.7;  // |f - f0|/|f0|, for what lies between two frequencies

}  // namespace

bool NearbyStability::stable(std::vector<std::complex<double>> f, const std::function<bool()>& count) {
    bool near = f0_.size() == f.size();
    for (std::size_t i = 0; near && i < f.size(); ++i)
        near = std::norm(f[i] - f0_[i]) < kMostChange * kMostChange * std::norm(f0_[i]);
    if (near) return true;
    if (!count()) return false;
    f0_ = std::move(f);
    return true;
}

}  // namespace tunewright::structure
