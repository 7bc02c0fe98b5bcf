// Stability of loops, known from settings nearby.
//
// f: the characteristic function with fixed poles, such as 1 + C P. Where |f - f0| < |f0| on the whole imaginary axis,
// f and f0 have equally many zeros in the right half-plane (Rouché): if f0 belongs to stable loops, so does f. A grid
// of frequencies takes the place of the axis: what a search ends with is counted.
#pragma once

#include <complex>
#include <functional>
#include <utility>
#include <vector>

namespace tunewright::structure {

class NearbyStability {
public:
    /// `f`: of the settings in question, at the frequencies of every call; `count`: the exact answer, asked for where f
    /// differs too much from that of the last stable settings.
    bool stable(std::vector<std::complex<double>> f, const std::function<bool()>& count) {
        bool near = f0_.size() == f.size();
        for (std::size_t i = 0; near && i < f.size(); ++i)
            near = std::norm(f[i] - f0_[i]) < kMostChange * kMostChange * std::norm(f0_[i]);
        if (near) return true;
        if (!count()) return false;
        f0_ = std::move(f);
        return true;
    }

private:
    static constexpr double kMostChange = 0.7;  // |f - f0|/|f0|, for what lies between two frequencies

    std::vector<std::complex<double>> f0_;
};

}  // namespace tunewright::structure
