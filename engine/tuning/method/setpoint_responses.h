// The response to a set-point step as a function of the set-point weight b and of a first-order set-point filter:
// affine in b, filtered by a lag, so two simulations are enough for all.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// The responses y(t; b, T) to a unit step of the set point without limits of u: y_0 + b (y_1 - y_0) after the filter
/// 1/(1 + T s). Needs integral action and a stable loop; times in the plant's unit.
class SetpointResponses {
public:
    SetpointResponses(const LinearPlant& plant, const IdealPid& pid);

    /// False: the responses do not settle in the allowed number of steps; then no other member may be used.
    bool usable() const { return usable_; }

    /// The largest y minus 1, in percent; negative if y stays below the set point.
    double overshoot(double b) const { return percent_above(weighted(b)); }
    double IAE(double b) const;

    /// For one b, with filters of any T > 0.
    class Filtered {
    public:
        double overshoot(double T) const { return percent_above(behind(T)); }
        double IAE(double T) const;

    private:
        friend class SetpointResponses;
        Filtered(std::vector<ResponseNode> nodes, std::optional<double> error_integral)
            : nodes_(std::move(nodes)), error_integral_(error_integral) {}
        /// T z' = y - z, exact for the cubic y between nodes: z = p - T p' + T^2 p'' - T^3 p''' plus an exponential.
        /// The integral of the error is that of 1 - y plus T z.
        std::vector<ResponseNode> behind(double T) const;

        std::vector<ResponseNode> nodes_;
        std::optional<double> error_integral_;
    };
    Filtered with(double b) const { return {weighted(b), error_integral(b)}; }

    /// The size of the integral of the error with b = 0: a characteristic time of the loop.
    double time() const;

private:
    static double percent_above(const std::vector<ResponseNode>& nodes);
    std::vector<ResponseNode> weighted(double b) const;
    std::optional<double> error_integral(double b) const;

    StepResponse zero_;
    std::vector<ResponseNode> added_;
    std::optional<double> IE_of_one_;
    bool usable_ = false;
};

}  // namespace tunewright
