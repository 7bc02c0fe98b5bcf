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

    /// For one b and one limit on the overshoot (percent), with filters of any T > 0.
    class Filtered {
    public:
        /// The largest y above the limit, in percent, among the times up to the last at which the unfiltered y exceeds
        /// it. From there on the filtered y falls or stays below the limit, so it keeps the limit if this is <= 0.
        double excess(double T) const;
        double IAE(double T) const;

    private:
        friend class SetpointResponses;
        /// y between two nodes: y + slope s + curve s^2 + twist s^3 over s in [0, h].
        struct Piece {
            double h, y, slope, curve, twist;
        };
        Filtered(std::vector<ResponseNode> nodes, std::optional<double> error_integral, double limit);
        /// T z' = y - z up to node `count`, exact for the cubic y between nodes: z = p - T p' + T^2 p'' - T^3 p''' plus
        /// an exponential. The integral of the error is that of 1 - y plus T z.
        std::vector<ResponseNode> behind(double T, std::size_t count) const;

        std::vector<ResponseNode> nodes_;
        std::vector<Piece> pieces_;  ///< that which ends with node i + 1; h = 0: a jump
        std::optional<double> error_integral_;
        double limit_;
        std::size_t exceeding_ = 0;  ///< nodes up to the end of the last piece that may exceed the limit
    };
    Filtered with(double b, double limit) const { return {weighted(b), error_integral(b), limit}; }

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
