// Figures of settings over a whole range: curves of Ms, Mt and IAE relative to the own optimum's, and the worst points.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/range/schedule/point_evaluation.h"

namespace tunewright::range {

/// Figures at one point: the worst of the settings that may be in use there, on the worst of the point's plants; IAE on
/// the nominal plant.
struct PointFigures {
    double at = 0;
    Figure Ms, Mt, relative_IAE;  ///< empty: the loop is unstable there, or does not settle
};

enum class Quantity { Ms, Mt, relative_IAE };

/// The point at which a range comes nearest to a limit, or exceeds it most.
struct WorstPoint {
    Quantity quantity = Quantity::Ms;
    double at = 0;
    Figure value;      ///< verified: on an independent grid, against the point's own optimum; empty: unstable there
    double limit = 0;  ///< limit of Ms or Mt; 1 + allowance for the relative IAE
};

struct RangeCurve {
    std::vector<PointFigures> places;  ///< ascending, with both ends and every `extra` point
    std::vector<WorstPoint> worst;     ///< one for each quantity, also searched between the curve's points
};

/// The settings in use at a value of the scheduling variable.
using SettingsInUse = std::function<std::vector<IdealPid>(double at)>;

constexpr int kCurvePoints = 61;  ///< points of the curves in the answer

/// At `count` points evenly over the range and at the `extra` ones. The worst points are added to `places`, with their
/// own optima. Errors: those of PointDesigns::at.
Expected<RangeCurve> curve_over(PointDesigns& places, OwnOptima& own, const SettingsInUse& settings, int count,
                                const std::vector<double>& extra, double allowance);

/// Adds further points to an existing curve; points that it already has are skipped. Its worst points stay. Errors: the
/// model's.
std::optional<Error> add_places(RangeCurve& curve, const PointDesigns& places, const OwnOptima& own,
                                const SettingsInUse& settings, const std::vector<double>& at);

/// The largest relative IAE over a curve; infinite if some loop is unstable.
double largest_relative_IAE(const RangeCurve& curve);
/// The largest of Ms and Mt over its limit, minus 1; infinite if some loop is unstable.
double largest_excess(const RangeCurve& curve);

}  // namespace tunewright::range
