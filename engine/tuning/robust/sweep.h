// The constraints of a robust design over frequency: P is computed once, then thousands of controllers are judged on
// it.
//
// Every constraint is a logarithm that must not exceed 0: ln(|S|/Ms), ln(|T|/Mt), ln(|C S|/Mks), or ln(R/|L - C|) for
// the M-circle.
#pragma once

#include <array>
#include <complex>
#include <limits>
#include <vector>

#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

enum class ConstraintKind { S, T, CS, circle };

/// A local maximum of a constraint over frequency, with its exact gradient in the point's logarithms (envelope
/// theorem).
struct ActivePeak {
    ConstraintKind kind = ConstraintKind::S;
    std::size_t plant = 0;  ///< Problem::plant_at
    double omega = 0;
    double value = 0;  ///< <= 0 is allowed
    std::array<double, 3> gradient{};
};

/// Gains between which no frequency forbids anything; upper is infinite for the last gap.
struct GainGap {
    double lower = 0, upper = 0;
};

class Sweep {
public:
    /// `reference` is the frequency around which the loop will live (phase crossover or the like).
    Sweep(const DesignProblem& problem, double reference);

    /// All local maxima above `threshold` on every plant, and the limits at frequency infinity; the largest value
    /// first.
    std::vector<ActivePeak> peaks(const DesignPoint& x, double threshold) const;

    /// The gaps left by the union of all forbidden intervals of |Kp| for given Ti, Td (Garpinger and Hagglund 2008, Eq.
    /// 6, for every circle and every plant at once), in ascending order.
    std::vector<GainGap> gain_gaps(double Ti, double Td) const;

    /// The constraint's value on the nominal plant at one frequency, exactly.
    double value(ConstraintKind kind, const DesignPoint& x, double omega) const {
        return value(curves_.front(), kind, gains(x), omega);
    }

    const DesignProblem& problem() const { return problem_; }
    double reference() const { return reference_; }

private:
    struct Gains {
        double Kp, Ki, Kd, Tf;
    };
    /// One plant on its own grid.
    struct Curve {
        const LinearPlant* plant = nullptr;  // null: measured points
        std::size_t index = 0;
        double resolved_to = std::numeric_limits<double>::infinity();  // above it the dead time turns faster than the
                                                                       // grid: worst phase assumed
        std::size_t resolved = 0;                                      // index of the first such frequency
        std::vector<double> omega, P_re, P_im;
        std::vector<double> S, T, CS, circle;  // scratch: one sweep per thread of work
    };
    Curve curve_of(std::size_t index) const;
    Curve measured_curve() const;
    void complete(Curve& curve) const;  // what follows from its frequencies
    std::complex<double> plant_at(const Curve& curve, double omega) const;
    Gains gains(const DesignPoint& x) const;
    double value(const Curve& curve, ConstraintKind kind, const Gains& c, double omega) const;
    void fill_levels(Curve& curve, const Gains& c) const;
    void add_peaks(const Curve& curve, ConstraintKind kind, const std::vector<double>& level, const Gains& c,
                   double threshold, std::vector<ActivePeak>& found) const;
    void add_limits(const Curve& curve, const Gains& c, double threshold, std::vector<ActivePeak>& found) const;
    void forbid(const Curve& curve, const Gains& c, std::vector<GainGap>& forbidden) const;
    std::complex<double> worst_phase(const Curve& curve, std::complex<double> L, double omega) const;
    std::array<double, 3> gradient(const Curve& curve, ConstraintKind kind, const Gains& c, double omega) const;

    DesignProblem problem_;
    double reference_;
    double circle_centre_ = 0, circle_radius_ = 0;
    mutable std::vector<Curve> curves_;
};

}  // namespace tunewright::robust
