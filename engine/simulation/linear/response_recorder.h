// The stored part of a numerically integrated response: nodes close enough for cubics, and values at equal distances.
#pragma once

#include <optional>
#include <vector>

#include "engine/numerics/step_polynomial.h"
#include "engine/simulation/nonlinear/nonlinear_response.h"

namespace tunewright {

class ResponseRecorder {
public:
    ResponseRecorder(NonlinearResponse& response, const NonlinearOptions& options, double r);

    /// u or the slopes jump before the next step.
    void border() { at_border_ = true; }
    void add(const StepPolynomial& y, const StepPolynomial& u);
    /// Adds the sample at the end itself.
    void finish(double t, double y, double u);

    double error_integral() const { return error_integral_; }

private:
    void push_node(const StepPolynomial& y, const StepPolynomial& u, double s);
    int pieces(const StepPolynomial& y, const StepPolynomial& u) const;

    NonlinearResponse& response_;
    bool keeps_nodes_;
    int samples_;
    double horizon_, r_;
    bool at_border_ = true;
    double error_integral_ = 0;
    double largest_y_ = 0, largest_u_ = 0;
};

}  // namespace tunewright
