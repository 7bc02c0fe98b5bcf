// What answers about a nonlinear plant tell of its operating point.
#pragma once

#include <functional>

#include "api/contract/plant/plant.h"
#include "engine/plant/nonlinear/linearisation.h"

namespace tunewright::api {

const Description<OperatingPoint>& operating_point_contract();

/// The fields operating_point and linear_model of an answer; left out where `of` gives null.
template <class Answer>
void add_operating_point(Description<Answer>& d, std::function<const OperatingPoint*(const Answer&)> of) {
    const auto none = [of](const Answer& answer) { return of(answer) == nullptr; };
    d.field(
         "operating_point", {},
         [of](const Answer& answer, Writer& out) { operating_point_contract().write(*of(answer), out); },
         [](SchemaBook& book) { return operating_point_contract().schema(book); },
         "Of a nonlinear plant: the steady state that everything is a deviation from.", {}, none)
        .field(
            "linear_model", {},
            [of](const Answer& answer, Writer& out) { plant_contract().write(of(answer)->linear_model, out); },
            [](SchemaBook& book) { return plant_contract().schema(book); },
            "Of a nonlinear plant: the linearisation there, on which methods and robustness rest.", {}, none);
}

}  // namespace tunewright::api
