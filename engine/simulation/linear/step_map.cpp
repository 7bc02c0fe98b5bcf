#include "engine/simulation/linear/step_map.h"

#include <algorithm>

namespace tunewright {

using Index = std::size_t;

StepMap::StepMap(const ResponseSystem& system, double h)
    : n_(Index(system.n)), length_(column_length(n_ + 4)), h_(h), columns_((n_ + kStepInputs) * length_, 0.0) {}

StepMap::StepMap(const ResponseSystem& system, const ExactStep& step) : StepMap(system, step.h) {
    const double* from = step.columns.data();
    const Index of_step = step.length();
    for (Index k = 0; k < n_; ++k) std::copy_n(from + k * of_step, n_, column(k));
    const double *moments = from + n_ * of_step, *constant = moments + 4 * of_step;
    std::copy_n(constant, n_, column(n_));
    if (!system.delayed) {
        add_outputs(system);
        feed_through(system, n_, {system.in.d, 0});
        return;
    }
    // The cubic through the delayed signal at both ends.
    const std::array<Cubic, 4> inputs = {hermite_taylor(h_, {1, 0}, {}), hermite_taylor(h_, {0, 1}, {}),
                                         hermite_taylor(h_, {}, {1, 0}), hermite_taylor(h_, {}, {0, 1})};
    multiply_columns({.columns = moments,
                      .length = of_step,
                      .n = 4,
                      .weights = inputs.front().data(),
                      .weights_apart = 4,
                      .count = inputs.size(),
                      .to = column(n_ + 1),
                      .to_apart = length_});
    add_outputs(system);
    feed_through(system, n_, {});
    feed_through(system, n_ + 3, {1, 0});
    feed_through(system, n_ + 4, {0, 1});
}

void StepMap::add_outputs(const ResponseSystem& system) {
    multiply_columns({.columns = system.outputs.data(),
                      .length = 4,
                      .n = n_,
                      .weights = columns_.data(),
                      .weights_apart = length_,
                      .count = n_ + kStepInputs,
                      .to = columns_.data() + n_,
                      .to_apart = length_});
}

void StepMap::feed_through(const ResponseSystem& system, Index k, Signal v) {
    const auto outputs = outputs_of(system, v, k == n_ ? 1 : 0);
    for (Index i = 0; i < outputs.size(); ++i) column(k)[n_ + i] += outputs[i];
}

}  // namespace tunewright
