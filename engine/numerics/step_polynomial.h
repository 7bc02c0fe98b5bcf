// A signal over one step of an integrator: the quintic through six of its values. It gives values, slopes and
// integrals. A history of such steps serves signals that are read later.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace tunewright {

/// Positions of the six values as fractions of the step, both ends included (Chebyshev's extreme points).
extern const std::array<double, 6> kSixPoints;

struct StepPolynomial {
    double t = 0, h = 0;        ///< from t to t + h
    std::array<double, 6> c{};  ///< coefficients of powers of s = (time - t)/h

    static StepPolynomial through(double t, double h, const std::array<double, 6>& values);
    static StepPolynomial constant(double t, double h, double value) { return {t, h, {value}}; }

    double at(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5])))); }
    double slope(double s) const {
        return h > 0 ? (c[1] + s * (2 * c[2] + s * (3 * c[3] + s * (4 * c[4] + s * 5 * c[5])))) / h : 0;
    }
    /// Integral from t to t + s h.
    double integral(double s) const {
        return h * s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * (c[3] / 4 + s * (c[4] / 5 + s * c[5] / 6)))));
    }
    double end() const { return t + h; }
};

/// The signal is 0 before its first step.
class SignalHistory {
public:
    /// Adds a step, in place of a supposed one.
    void add(const StepPolynomial& step);
    bool empty() const { return steps_.empty(); }
    /// Uses this step from its beginning on, until the next step is added.
    void suppose(const StepPolynomial& step) { supposed_ = step; }
    /// Continues the signal from `time`, the end of the last step, with its slope there.
    void suppose_line(double time);
    /// Value and slope at `time`. At the border of two steps, those of the earlier (`before`) or the later one; beyond
    /// the last step, of its continuation.
    double at(double time, bool before) const;
    double slope(double time, bool before) const;

private:
    const StepPolynomial* find(double time, bool before) const;

    std::vector<StepPolynomial> steps_;
    std::optional<StepPolynomial> supposed_;
    mutable std::size_t cursor_ = 0;  // times are read in nearly ascending order
};

}  // namespace tunewright
