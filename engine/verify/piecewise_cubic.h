// A curve of cubics between the nodes of a response, in closed forms: its turning points divide it into monotone
// pieces, on which crossings are bisected and integrals are Gauss and Legendre's, exact for the cubics.
#pragma once

#include <optional>
#include <vector>

#include "engine/numerics/cubic.h"

namespace tunewright::verify {

class PiecewiseCubic {
public:
    /// `t` ascending; two equal times are the sides of a jump.
    PiecewiseCubic(const std::vector<double>& t, const std::vector<Signal>& values);

    double end() const { return pieces_.empty() ? 0 : pieces_.back().t + pieces_.back().h; }
    double at_start() const { return first_; }
    double last() const { return last_; }
    double max() const;
    double min() const;
    /// Total variation from the value 0 before the first node, jumps included.
    double variation() const;
    /// First time at which the curve reaches `level` on its way from 0.
    std::optional<double> first_reached(double level) const;
    /// Last time outside target +- band; 0: never; empty: at the end.
    std::optional<double> last_outside(double target, double band) const;

    struct ErrorIntegrals {
        double error = 0, absolute = 0, square = 0, time_absolute = 0;  ///< of e, |e|, e^2 and t |e|
    };
    /// Of e = target - curve up to the last node.
    ErrorIntegrals integrals(double target) const;

private:
    /// A monotone part of a cubic.
    struct Piece {
        double t, h, offset;  // `offset`: of t within the step of `cubic`
        Cubic cubic;
        double at(double s) const { return value_at(cubic, offset + s); }
        double start() const { return at(0); }
        double finish() const { return at(h); }
        /// Where it passes the level between its ends.
        double crossing(double level) const;
    };

    std::vector<Piece> pieces_;
    double first_ = 0, last_ = 0;
};

}  // namespace tunewright::verify
