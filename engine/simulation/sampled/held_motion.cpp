#include "engine/simulation/sampled/held_motion.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {
using Index = std::size_t;
}  // namespace

HeldMotion::HeldMotion(const LinearPlant& plant, double h) : plant_(&plant) {
    levels_.push_back(step(h));
    before_.resize(static_cast<Index>(plant.realisation().n) + 1);
    after_.resize(before_.size());
}

HeldMotion::Step HeldMotion::step(double h) const {
    // exp([A, 0, B; C, 0, D; 0, 0, 0] h).
    const Realisation& r = plant_->realisation();
    const Index n = static_cast<Index>(r.n), m = n + 1, size = n + 2;
    std::vector<double> block(size * size, 0.0);
    for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) block[i * size + j] = h * r.A[i * n + j];
        block[i * size + m] = h * r.B[i];
        block[n * size + i] = h * r.C[i];
    }
    block[n * size + m] = h * r.D;
    const std::vector<double> exponential = matrix_exponential(block, static_cast<int>(size));
    Step made{h, {}, {}};
    for (Index i = 0; i < m; ++i) {
        for (Index j = 0; j < m; ++j) made.Phi.push_back(exponential[i * size + j]);
        made.Gamma.push_back(exponential[i * size + m]);
    }
    return made;
}

void HeldMotion::advance(HeldState& state, double v, int level) {
    while (static_cast<int>(levels_.size()) <= level) levels_.push_back(step(0.5 * levels_.back().h));
    const Step& s = levels_[static_cast<Index>(level)];
    std::copy(state.x.begin(), state.x.end(), before_.begin());
    before_.back() = state.y_integral;
    multiply(s.Phi, before_, after_);
    for (Index i = 0; i < state.x.size(); ++i) state.x[i] = after_[i] + s.Gamma[i] * v;
    state.y_integral = after_.back() + s.Gamma.back() * v;
}

HeldReader::HeldReader(const LinearPlant& plant) : C_(plant.realisation().C), D_(plant.realisation().D) {
    const Realisation& r = plant.realisation();
    CA_ = r.n > 0 ? row_times(r.C, r.A) : std::vector<double>{};
    CB_ = dot(r.C, r.B);
}

HeldOutput HeldReader::at(const std::vector<double>& x, double v) const {
    return {dot(C_, x) + D_ * v, dot(CA_, x) + CB_ * v};
}

}  // namespace tunewright
