// The PIDs of the revised IMC design over lambda, each with its filter on its own model: the usable range, the figures
// in it, and the lambda for a wanted figure.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/loop/loop.h"
#include "engine/tuning/rimc/rimc_design.h"

namespace tunewright {

/// The relation of Fig. 2 of the source for one plant.
struct DisturbancePeakCurve {
    std::vector<double> lambda_over_tau, DP_over_kp, Ms;
};

/// Everything is computed in the scaled time t/tau and for kp = 1 (Eq. 27: Ms, DP/kp and d theta/tau depend only on
/// lambda/tau and theta/tau).
class RimcBranch {
public:
    /// T > 0, L >= 0, K != 0.
    RimcBranch(const Fopdt& model, const RimcFilter& filter);

    struct Range {
        double low = 0, high = 0;
    };
    /// The range with k_p k_c > 0 and Td >= 0 (and a filter of the linear fraction); low is 0 if every small lambda is
    /// admissible.
    Range admissible() const { return {scaled_admissible_.low * model_.T, scaled_admissible_.high * model_.T}; }
    /// The range of the solutions: from the stability limit (or the end of the admissible range) to the lambda with the
    /// least Ms. Empty: no lambda stabilises the model.
    std::optional<Range> branch() const;
    /// Below it the loop on the model is unstable; empty if every admissible lambda down to 1e-4 tau is stable.
    std::optional<double> stability_limit() const;
    double min_Ms() const { return min_Ms_; }

    /// Ms for one lambda; empty if it is not admissible or the loop is unstable.
    std::optional<double> Ms(double lambda) const;
    /// Largest deviation of y after a unit load step, with the sign of K.
    std::optional<double> disturbance_peak(double lambda) const;
    /// small_gain_dead_time of the loop; infinite if it tolerates every dead time.
    std::optional<double> dead_time_error(double lambda) const;

    /// dead_time_mismatch of the loop: Eq. 29 holds for this error if it is below 1.
    std::optional<double> dead_time_mismatch_at(double lambda, double error) const;

    /// The lambda with this Ms. Errors: no_feasible_controller with the reachable range.
    Expected<double> lambda_for_Ms(double Ms) const;
    /// The largest lambda of the branch with this peak (in magnitude).
    Expected<double> lambda_for_disturbance_peak(double peak) const;
    /// The smallest lambda above which Eq. 29 holds for this error up to the branch's end.
    Expected<double> lambda_for_dead_time_error(double error) const;

    /// At most `points` values of lambda, evenly spaced in ln lambda from a tenth above the stability limit to the end
    /// of the admissible range, as long as the loop is stable.
    DisturbancePeakCurve curve(int points) const;

private:
    using Figure = std::function<double(const Loop& loop, double x)>;
    struct Reach {
        std::optional<double> x = {};  ///< position at which the figure passes the target
        double best = 0;               ///< the closest value, if it never does
    };

    std::optional<IdealPid> pid(double x) const { return rimc_pid(scaled_, x, filter_); }
    std::optional<Loop> loop(double x) const;
    std::optional<Loop> stable_loop(double x) const;
    double nearest_approach(const IdealPid& pid) const;
    static double Ms_of(const Loop& loop);
    double peak_of(const Loop& loop, double x) const;
    void find_admissible();
    void find_min_Ms();
    void find_stability_limit();
    Reach descend(const Figure& figure, double target, bool rising, double step) const;
    Error no_branch(const char* option) const;

    Fopdt model_, scaled_;
    RimcFilter filter_;
    LinearPlant plant_;
    std::vector<double> omega_;
    std::vector<std::complex<double>> response_;  ///< response of the scaled model at omega_
    Range scaled_admissible_;
    std::optional<Range> scaled_branch_;
    bool has_stability_limit_ = false;
    double min_Ms_ = 0;
};

}  // namespace tunewright
