// What settings do over a whole range: curves of Ms, Mt and IAE over the own optimum's, and the worst place.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/range/schedule/point_evaluation.h"

namespace tunewright::range {

/// At one place the worst of the settings that may be in use there, on the worst of the place's plants; IAE on the
/// nominal plant.
struct PointFigures {
    double at = 0;
    Figure Ms, Mt, relative_IAE;  ///< empty: the loop is not stable there, or does not settle
};

enum class Quantity { Ms, Mt, relative_IAE };

/// Where a range comes nearest to a limit, or beyond it farthest.
struct WorstPoint {
    Quantity quantity = Quantity::Ms;
    double at = 0;
    Figure value;      ///< checked: on an independent grid, against the place's own optimum; empty: not stable there
    double limit = 0;  ///< of Ms or Mt; 1 + allowance for the relative IAE
};

struct RangeCurve {
    std::vector<PointFigures> places;  ///< ascending; both ends and every `extra` place included
    std::vector<WorstPoint> worst;     ///< one for each quantity, searched between the curve's places too
};

/// The settings in use at a place.
using SettingsInUse = std::function<std::vector<IdealPid>(double at)>;

constexpr int kCurvePoints = 61;  ///< of the curves that are answered

/// At `count` places evenly over the range and at `extra` ones. The worst places join those of `places`, with their own
/// optima. Errors: those of PointDesigns::at.
Expected<RangeCurve> curve_over(PointDesigns& places, OwnOptima& own, const SettingsInUse& settings, int count,
                                const std::vector<double>& extra, double allowance);

/// Takes further places into a curve that has some; those that it has already are passed over. Its worst places stay.
/// Errors: the model's.
std::optional<Error> add_places(RangeCurve& curve, const PointDesigns& places, const OwnOptima& own,
                                const SettingsInUse& settings, const std::vector<double>& at);

/// The largest relative IAE over a curve, infinite where some loop is not stable.
double largest_relative_IAE(const RangeCurve& curve);
/// The largest of Ms and Mt over its limit, less 1; infinite where some loop is not stable.
double largest_excess(const RangeCurve& curve);

}  // namespace tunewright::range
