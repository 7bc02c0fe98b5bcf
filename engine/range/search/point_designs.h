// The searched points of a range, each with its own optimum.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "engine/expected.h"
#include "engine/range/model/range_model.h"
#include "engine/range/search/point_design.h"

namespace tunewright::range {

/// The rules that the options give for every point: the sign of Kp of the first point; the given filter, else none for
/// PI, Tf = 0.1 Td if any point has it by robust::filter_rule, else the shortest Tf that the rule gives at a point.
/// Errors: as robust::filter_rule, and unstable_plant for a zero at s = 0.
Expected<DesignRules> design_rules(const RangeModel& model, const RangeOptions& options);

/// Moves the place of a design's error to that of the filter in the request of a range.
Error placed_in_options(Error error);

class PointDesigns {
public:
    PointDesigns(const RangeModel& model, const Scheduling& scheduling, const DesignRules& rules,
                 const RunControl& control)
        : model_(model), scheduling_(scheduling), rules_(rules), control_(control) {}

    /// The point with its optimum, searched once: from known neighbours, else by the full search. Errors: those of the
    /// model and of PointDesign::find_optimum, with the place in the message; unbounded_optimum; cancelled.
    Expected<PointDesign*> at(double at);

    /// The same without using neighbours.
    Expected<PointDesign*> at_point(double at) { return find(at, false); }

    /// In ascending order.
    std::vector<PointDesign*> known() const;

    const RangeModel& model() const { return model_; }
    const DesignRules& rules() const { return rules_; }
    const RunControl& control() const { return control_; }
    /// "level = 12 cm".
    std::string named(double at) const;

private:
    Expected<PointDesign*> find(double at, bool from_neighbour);

    const RangeModel& model_;
    const Scheduling& scheduling_;
    DesignRules rules_;
    const RunControl& control_;
    std::map<double, std::unique_ptr<PointDesign>> places_;
};

}  // namespace tunewright::range
