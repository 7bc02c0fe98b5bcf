// The places of a range that have been looked at, each with its own optimum.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "engine/expected.h"
#include "engine/range/model/range_model.h"
#include "engine/range/search/point_design.h"

namespace tunewright::range {

/// What the options ask at every place: the sign of Kp of the first point; the filter that is given, else none for PI,
/// Tf = 0.1 Td where any point has it by robust::filter_rule, else the shortest Tf that the rule
/// gives at a point. Errors: as robust::filter_rule, and unstable_plant for a zero at s = 0.
Expected<DesignRules> design_rules(const RangeModel& model, const RangeOptions& options);

/// An error of a design at one plant, with the place that its filter has in a range.
Error placed_in_options(Error error);

class PointDesigns {
public:
    PointDesigns(const RangeModel& model, const Scheduling& scheduling, const DesignRules& rules,
                 const RunControl& control)
        : model_(model), scheduling_(scheduling), rules_(rules), control_(control) {}

    /// The place with its optimum, found once; from the neighbours that are known already, else by the whole search.
    /// Errors: those of the model and of PointDesign::find_optimum, with the place in the sentence; unbounded_optimum;
    /// cancelled.
    Expected<PointDesign*> at(double at);

    /// The same without looking at neighbours.
    Expected<PointDesign*> at_point(double at) { return find(at, false); }

    /// Ascending.
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
