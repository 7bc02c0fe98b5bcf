#include "engine/structure/decoupling/decoupler_blocks.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace tunewright::structure {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

Complex response_of(const Feedforward& one, Complex s) {
    return one.Kf * (one.Tz * s + 1.0) / (one.Tp * s + 1.0) * std::exp(-one.Lf * s);
}

LinearPlant block_of(const Feedforward& one) {
    return std::move(
        *LinearPlant::make(Plant(TransferFunction{.num = {one.Kf * one.Tz, one.Kf}, .den = {one.Tp, 1}, .L = one.Lf})));
}

bool is_gain(const Feedforward& one) { return one.Tz == 0 && one.Tp == 0 && one.Lf == 0; }

}  // namespace

bool has_gains_alone(const Decoupling& elements) {
    return std::ranges::all_of(elements, [](const auto& row) {
        return std::ranges::all_of(row, [](const auto& one) { return !one || is_gain(*one); });
    });
}

LoopMatrix decoupler_response(const Decoupling& elements, Complex s) {
    const auto n = Index(elements.size());
    LoopMatrix A = LoopMatrix::Identity(n, n);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j)
            if (const auto& one = elements[std::size_t(i)][std::size_t(j)]) A(i, j) -= response_of(*one, s);
    return A.inverse();
}

void add_decoupler(BlockDiagram& blocks, const Decoupling& elements, unsigned closed, const std::vector<int>& from,
                   const std::vector<int>& to) {
    Decoupling left = elements;
    for (std::size_t i = 0; i < left.size(); ++i)
        for (std::size_t j = 0; j < left.size(); ++j)
            if (((closed >> i) & (closed >> j) & 1u) == 0) left[i][j].reset();
    const bool of_gains = has_gains_alone(left);
    const LoopMatrix D = of_gains ? decoupler_response(left, 0)
                                  : LoopMatrix(LoopMatrix::Identity(Index(left.size()), Index(left.size())));
    for (std::size_t i = 0; i < left.size(); ++i)
        for (std::size_t j = 0; j < left.size(); ++j) {
            if (D(Index(i), Index(j)) != 0.0) blocks.add(from[j], to[i], D(Index(i), Index(j)).real());
            if (!of_gains && left[i][j]) blocks.add(to[j], to[i], block_of(*left[i][j]));
        }
}

}  // namespace tunewright::structure
