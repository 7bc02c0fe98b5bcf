// Parts that the requests and answers of the calls for cascade, level, feedforward, interaction and predictor share.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/contract/request.h"
#include "engine/structure/conclusions.h"
#include "engine/structure/loop_design.h"
#include "engine/structure/step_figures.h"

namespace tunewright::api {

/// The labels of a request.
struct LabelledRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
};

/// One linear plant, as its object or a text, ready for computing. Uncertainty is refused.
Codec<std::optional<LinearPlant>> linear_plant();

/// A controller in any linear form, as its ideal form.
Codec<std::optional<IdealPid>> linear_controller();

/// For answers only: in the ideal form.
Codec<IdealPid> ideal_controller();

/// {"method": "robust", "controller": "PI", "Ms": 1.4, "Mt": 1.4}.
const Description<structure::LoopDesign>& loop_design_contract();

/// Figures of y after a unit step.
struct StepView {
    Figure IAE, IE, peak, TV;

    StepView() = default;
    /// `why` not empty: none is known, for this reason.
    StepView(double IAE, double IE, double peak, double TV, const std::string& why);
};
const Description<StepView>& step_view_contract();

/// The value, or `why` if that is not empty.
Figure known_unless(double value, const std::string& why);

/// An object of figures, with the reasons of those that are not known, and its schema.
void write_figures(Writer& out, std::initializer_list<std::pair<const char*, Figure>> figures);
Json figures_schema(std::initializer_list<const char*> names);

/// {"code", "figures"}.
const Description<structure::Conclusion>& conclusion_contract();

}  // namespace tunewright::api
