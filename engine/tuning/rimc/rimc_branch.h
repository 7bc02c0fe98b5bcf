// The PIDs of the revised IMC design over lambda, each with its filter on its own model: where they are usable, what
// they give there, and which lambda gives a wanted figure.
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

/// Everything is computed in the scaled time t/tau and for kp = 1 (Eq. 27: Ms, DP/kp and d theta/tau depend on
/// lambda/tau and theta/tau alone).
class RimcBranch {
public:
    /// T > 0, L >= 0, K != 0.
    RimcBranch(const Fopdt& model, const RimcFilter& filter);

    struct Range {
        double low = 0, high = 0;
    };
    /// Where k_p k_c > 0 and Td >= 0 (and the linear fraction has its filter); low 0 where every small lambda does.
    Range admissible() const { return {scaled_admissible_.low * model_.T, scaled_admissible_.high * model_.T}; }
    /// Where solutions are looked for: from the stability limit (or the end of what is admissible) to the least Ms.
    /// Empty: no lambda stabilises the model.
    std::optional<Range> branch() const;
    /// Below it the loop on the model is unstable; empty where every admissible lambda down to 1e-4 tau is stable.
    std::optional<double> stability_limit() const;
    double min_Ms() const { return min_Ms_; }

    /// Of one lambda; empty where it is not admissible or the loop is unstable.
    std::optional<double> Ms(double lambda) const;
    /// Largest deviation of y after a unit load step, with the sign of K.
    std::optional<double> disturbance_peak(double lambda) const;
    /// small_gain_dead_time of the loop; infinite where every dead time is tolerated.
    std::optional<double> dead_time_error(double lambda) const;

    /// dead_time_mismatch of the loop: Eq. 29 holds for this error where it is below 1.
    std::optional<double> dead_time_mismatch_at(double lambda, double error) const;

    /// The lambda whose Ms is this. Errors: no_feasible_controller with the reachable range.
    Expected<double> lambda_for_Ms(double Ms) const;
    /// The largest lambda of the branch whose peak is this (in magnitude).
    Expected<double> lambda_for_disturbance_peak(double peak) const;
    /// The smallest lambda above which Eq. 29 holds for this error up to the branch's end.
    Expected<double> lambda_for_dead_time_error(double error) const;

    /// At most `points` lambdas, evenly spaced in ln lambda from a tenth above the stability limit to the end of what
    /// is admissible, as far as the loop is stable there.
    DisturbancePeakCurve curve(int points) const;

private:
    using Figure = std::function<double(const Loop& loop, double x)>;
    struct Reach {
        std::optional<double> x = {};  ///< where the figure passes the target
        double best = 0;               ///< what comes closest to it, where it never does
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
    std::vector<std::complex<double>> response_;  ///< of the scaled model at omega_
    Range scaled_admissible_;
    std::optional<Range> scaled_branch_;
    bool has_stability_limit_ = false;
    double min_Ms_ = 0;
};

}  // namespace tunewright
