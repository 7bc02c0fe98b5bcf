// A step of a linear run as one map: the states at its end, and what a node keeps of them, are a combination of the
// states at its start and of what comes in.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/numerics/propagator.h"
#include "engine/simulation/linear/response_system.h"

namespace tunewright {

/// Of a step beside the states: 1, then values and slopes of two signals, the delayed one at the start first.
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
    /// Up to the dead time, whose second signal is the delayed one at the end; or without dead time, where 1 alone
    /// comes in.
    StepMap(const ResponseSystem& system, const ExactStep& step);
    /// Of columns that are filled in from outside: first the states' part of each, then `add_outputs` and what is fed
    /// through.
    StepMap(const ResponseSystem& system, double h);

    double h() const { return h_; }

    /// To the step's end. `inputs`: the first of them, at most kStepInputs.
    void take(RunState& state, std::span<const double> inputs) const {
        map_columns(columns_.data(), n_, state.all(), inputs);
    }

    /// The states at the end by state or, from n on, input k.
    double* column(std::size_t k) { return columns_.data() + k * length_; }
    const double* column(std::size_t k) const { return columns_.data() + k * length_; }
    /// What the states' part of each column leaves of y, y', u and u'.
    void add_outputs(const ResponseSystem& system);
    /// The same of the delayed signal at the end that belongs to column k, and of r and d to that of 1.
    void feed_through(const ResponseSystem& system, std::size_t k, Signal v);

private:
    std::size_t n_, length_;
    double h_;
    std::vector<double> columns_;  // n of the states, kStepInputs more; each of length_ = column_length(n + 4)
};

}  // namespace tunewright
