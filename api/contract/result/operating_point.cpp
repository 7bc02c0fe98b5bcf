#include "api/contract/result/operating_point.h"

namespace tunewright::api {

const Description<OperatingPoint>& operating_point_contract() {
    static const auto description = [] {
        Description<OperatingPoint> d("OperatingPoint",
                                      "The true steady state nearest to the values given; absolute values.");
        d.field(
             "states", {},
             [](const OperatingPoint& point, Writer& out) {
                 out.begin_object();
                 for (const NamedValue& state : point.states) {
                     out.key(state.name);
                     out.number(state.value);
                 }
                 out.end_object();
             },
             [](SchemaBook&) {
                 return Json{{"type", "object"}, {"additionalProperties", {{"type", "number"}}}};
             },
             "By name.")
            .field("u", &OperatingPoint::u, only_answered(number()), "The nominal input.", {.unit = "u"})
            .field("y", &OperatingPoint::y, only_answered(number()), "The output.", {.unit = "y"});
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
