// What a response's end leaves of its error's integrals.
#pragma once

#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Integrals of |e| and t |e| so far, by trapezoids: what is left is judged by them.
class ErrorTail {
public:
    /// The piece between neighbouring nodes; e = r - y.
    void add(const ResponseNode& a, const ResponseNode& b, double r);

    double absolute_error() const { return absolute_error_; }

    /// Whether less than `fraction` of the integral of t |e| is left at time t, where the error is e and its integral
    /// from there on `rest`: the tail is taken as one exponential.
    bool little_is_left(double rest, double e, double t, double fraction) const;

private:
    double absolute_error_ = 0, first_moment_ = 0, largest_ = 0;  // the last: of |y|
};

}  // namespace tunewright
