// The constraints of a robust design over frequency: P is computed once, then thousands of controllers are evaluated
// with it.
//
// Every constraint is a logarithm that must not exceed 0: ln(|S|/Ms), ln(|T|/Mt), ln(|C S|/Mks), or ln(R/|L - C|) for
// the M-circle.
#pragma once

#include <array>
#include <complex>
#include <limits>
#include <optional>
#include <vector>

#include "engine/tuning/robust/design.h"
#include "engine/tuning/robust/sweep/sweep_loops.h"

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

/// Gains that no frequency forbids; upper is infinite for the last gap.
struct GainGap {
    double lower = 0, upper = 0;
    /// True if the loop is stable inside on every plant, inferred from the encirclements of -1 on the grid. Empty: the
    /// grid does not show it.
    std::optional<bool> stable = std::nullopt;
    /// true: the loop is certainly stable: a stable plant at low gain
    bool verified = false;

    /// A gain inside; only for finite gaps.
    double middle() const;
};

class Sweep {
public:
    /// `reference` is a characteristic frequency of the loop, such as the phase crossover.
    Sweep(const DesignProblem& problem, double reference);

    /// All local maxima above `threshold` on every plant, and the limits at infinite frequency; the largest value
    /// first.
    std::vector<ActivePeak> peaks(const DesignPoint& x, double threshold) const;

    /// The gaps left by the union of all forbidden intervals of |Kp| for given Ti, Td (Garpinger and Hägglund 2008, Eq.
    /// 6, for every circle and every plant at once), in ascending order.
    std::vector<GainGap> gain_gaps(double Ti, double Td) const;

    /// True if the loop at `to` is stable because that at `from` is: at every frequency L changes by less than the
    /// distance of L(from) from -1 (Rouche's theorem), with a margin for frequencies between those of the grid. False:
    /// it may be stable or not.
    bool stays_stable(const DesignPoint& from, const DesignPoint& to) const;

    /// The exact value of the constraint on the nominal plant at one frequency.
    double value(ConstraintKind kind, const DesignPoint& x, double omega) const {
        return value(curves_.front(), kind, gains(x), omega);
    }

    const DesignProblem& problem() const { return problem_; }
    double reference() const { return reference_; }

private:
    /// One plant on its own grid.
    struct Curve {
        const LinearPlant* plant = nullptr;  // null: measured points
        std::size_t index = 0;
        double resolved_to = std::numeric_limits<double>::infinity();  // above it the dead time turns faster than the
                                                                       // grid resolves: the worst phase is assumed
        std::size_t resolved = 0;                                      // index of the first such frequency
        std::vector<double> omega, log_omega, P_re, P_im;
        std::optional<double> phase_at_low;  // phase of P, followed from frequency 0
        int unstable_poles = 0;
        std::vector<double> S, T, CS, circle;  // scratch memory: each thread needs its own sweep
        std::vector<double> L_re, L_im, lower, upper, other_lower, other_upper;

        CurveGrid grid() const { return {omega, P_re, P_im}; }
        CurveGrid followed() const { return grid().part(0, resolved); }
        CurveGrid turning() const { return grid().part(resolved, omega.size()); }
    };
    Curve curve_of(std::size_t index) const;
    Curve measured_curve() const;
    void complete(Curve& curve) const;  // sets the members that follow from its frequencies
    std::complex<double> plant_at(const Curve& curve, double omega) const;
    LoopGains gains(const DesignPoint& x) const;
    double value(const Curve& curve, ConstraintKind kind, const LoopGains& c, double omega) const;
    void fill_levels(Curve& curve, const LoopGains& c) const;
    struct Top {
        double log_omega = 0, value = 0;
    };
    std::optional<Top> top_near(const Curve& curve, std::size_t i, const std::vector<double>& level,
                                ConstraintKind kind, const LoopGains& c, double threshold) const;
    void add_peaks(const Curve& curve, ConstraintKind kind, const std::vector<double>& level, const LoopGains& c,
                   double threshold, std::vector<ActivePeak>& found) const;
    void add_limits(const Curve& curve, const LoopGains& c, double threshold, std::vector<ActivePeak>& found) const;
    void fill_open_loop(Curve& curve, const LoopGains& c) const;
    void forbid(Curve& curve, std::vector<GainGap>& forbidden) const;
    void forbid_activity(const Curve& curve, const LoopGains& c, std::vector<GainGap>& forbidden) const;
    struct Entrance {
        bool from_left = false;
        double phase = 0;  // rad
        double size = 0;   // |L| there with gain 1
    };
    Entrance entrance(const Curve& curve, const LoopGains& c) const;
    static std::optional<int> crossed_below(const Entrance& in, double k);
    void forbid_below(const Curve& curve, const LoopGains& c, std::vector<GainGap>& forbidden) const;
    struct GainCourse;
    bool stable_at_low_gain() const;
    void find_stability(const LoopGains& c, std::vector<GainGap>& gaps) const;
    std::complex<double> worst_phase(const Curve& curve, std::complex<double> L, double omega) const;
    std::array<double, 3> gradient(const Curve& curve, ConstraintKind kind, const LoopGains& c, double omega) const;

    DesignProblem problem_;
    double reference_;
    Circle circle_{};  // the smallest circle around both
    mutable std::vector<Curve> curves_;
    mutable std::vector<std::size_t> tops_;
};

}  // namespace tunewright::robust
