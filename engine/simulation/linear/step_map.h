// A step of a linear run as one map: the states at its end, and the values stored in a node, are a linear combination
// of the states at its start and of the inputs.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/numerics/propagator.h"
#include "engine/simulation/linear/response_system.h"

namespace tunewright {

/// Inputs of a step: 1, then values and slopes of two signals, first the delayed one at the start.
constexpr std::size_t kStepInputs = 5;

/// The states of a run and, after them, y, y', u and u'.
class RunState {
public:
    explicit RunState(const ResponseSystem& system) : n_(static_cast<std::size_t>(system.n)), z_(n_ + 4, 0.0) {}

    std::span<double> states() { return {z_.data(), n_}; }
    std::span<double> all() { return z_; }
    ResponseNode node(double t) const {
        const double* y = z_.data() + n_;
        return {.t = t, .y = y[0], .y_slope = y[1], .u = y[2], .u_slope = y[3], .error_integral = -y[-1]};
    }

private:
    std::size_t n_;
    std::vector<double> z_;
};

class StepMap {
public:
    /// For steps up to the dead time, whose second signal is the delayed one at the end; or without dead time, where 1
    /// is the only input.
    StepMap(const ResponseSystem& system, const ExactStep& step);
    /// A map whose columns the caller fills: first the states' part of each, then `add_outputs` and `feed_through`.
    StepMap(const ResponseSystem& system, double h);

    double h() const { return h_; }

    /// Moves the state to the step's end. `inputs`: at most kStepInputs, the others are 0.
    void take(RunState& state, std::span<const double> inputs) const {
        map_columns(columns_.data(), n_, state.all(), inputs);
    }

    /// Column of the states at the end, for a state or, from n on, for input k - n.
    double* column(std::size_t k) { return columns_.data() + k * length_; }
    const double* column(std::size_t k) const { return columns_.data() + k * length_; }
    /// Adds the contribution of the states' part of each column to y, y', u and u'.
    void add_outputs(const ResponseSystem& system);
    /// Adds the contribution of the delayed signal at the end to column k, and that of r and d to the column of 1.
    void feed_through(const ResponseSystem& system, std::size_t k, Signal v);

private:
    std::size_t n_, length_;
    double h_;
    std::vector<double> columns_;  // n columns of the states and kStepInputs more; each of length_ = column_length(n +
                                   // 4)
};

}  // namespace tunewright
