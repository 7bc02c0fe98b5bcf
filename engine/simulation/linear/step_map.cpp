#include "engine/simulation/linear/step_map.h"

#include <algorithm>

namespace tunewright {

using Index = std::size_t;

StepMap::StepMap(const ResponseSystem& system, double h)
    : n_(Index(system.n)), length_(column_length(n_ + 4)), h_(h), columns_((n_ + kStepInputs) * length_, 0.0) {}

StepMap::StepMap(const ResponseSystem& system, const ExactStep& step) : StepMap(system, step.h) {
    std::vector<Signal> v(n_ + kStepInputs);
    const double* from = step.columns.data();
    const Index of_step = step.length();
    for (Index k = 0; k < n_; ++k) std::copy_n(from + k * of_step, n_, column(k));
    const double *moments = from + n_ * of_step, *constant = moments + 4 * of_step;
    std::copy_n(constant, n_, column(n_));
    if (!system.delayed) {
        v[n_] = {system.in.d, 0};
        add_outputs(system, v);
        return;
    }
    // The cubic through the delayed signal at both ends.
    v[n_ + 3] = {1, 0};
    v[n_ + 4] = {0, 1};
    const std::array<Cubic, 4> inputs = {hermite_taylor(h_, {1, 0}, {}), hermite_taylor(h_, {0, 1}, {}),
                                         hermite_taylor(h_, {}, {1, 0}), hermite_taylor(h_, {}, {0, 1})};
    for (Index k = 0; k < inputs.size(); ++k) {
        double* to = column(n_ + 1 + k);
        for (Index j = 0; j < 4; ++j)
            for (Index i = 0; i < n_; ++i) to[i] += moments[j * of_step + i] * inputs[k][j];
    }
    add_outputs(system, v);
}

void StepMap::add_outputs(const ResponseSystem& system, std::span<const Signal> v) {
    multiply_columns({.columns = system.outputs.data(),
                      .length = 4,
                      .n = n_,
                      .weights = columns_.data(),
                      .weights_apart = length_,
                      .count = n_ + kStepInputs,
                      .to = columns_.data() + n_,
                      .to_apart = length_});
    for (Index k = 0; k < v.size(); ++k) {
        if (k != n_ && v[k].value == 0 && v[k].slope == 0) continue;
        const auto fed_through = outputs_of(system, v[k], k == n_ ? 1 : 0);
        for (Index i = 0; i < 4; ++i) column(k)[n_ + i] += fed_through[i];
    }
}

}  // namespace tunewright
