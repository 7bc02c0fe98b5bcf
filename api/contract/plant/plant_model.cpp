#include "api/contract/plant/nonlinear_plant.h"
#include "api/contract/plant/plant.h"

namespace tunewright::api {
namespace {

const Description<PlantSet>& plant_set() {
    constexpr std::size_t kMaxPlants = 50;
    static const auto description = [] {
        Description<PlantSet> d("PlantSet", "Plants that one controller must serve: limits hold on all of them.");
        d.tag("type", "set")
            .field("plants", &PlantSet::plants, list_of(one_of(plant_contract()), 1, kMaxPlants),
                   "Linear plants; the first is nominal: the objective and all figures are its own.",
                   {.required = true})
            .example({{"type", "set"},
                      {"plants", Json::array({Json{{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}},
                                              Json{{"type", "fopdt"}, {"K", 2.5}, {"T", 8}, {"L", 4}}})}});
        return d;
    }();
    return description;
}

// What belongs together in the points.
void check_points(const Json&, FrequencyResponse& points, Reader& reader) {
    if (const auto fault = points_fault(points)) reader.fault_below(fault->where, 1, fault->message);
}

const Description<FrequencyResponse>& frequency_response() {
    constexpr std::size_t kMin = 8, kMax = 10'000;
    constexpr int kMaxPoles = 20;
    static const auto description = [] {
        using F = FrequencyResponse;
        Description<F> d("FrequencyResponse",
                         "Measured points of P(j omega). Figures over time are null, and robust maximises Kp/Ti.");
        d.tag("type", "frequency_response")
            .field("omega", &F::omega, numbers(kMin, kMax),
                   "Angular frequencies, ascending; they must reach beyond the phase crossover.",
                   {.required = true, .unit = "rad/time"})
            .field("re", &F::re, numbers(kMin, kMax), "Real parts, one a frequency.", {.required = true, .unit = "y/u"})
            .field("im", &F::im, numbers(kMin, kMax), "Imaginary parts, one a frequency.",
                   {.required = true, .unit = "y/u"})
            .field("unstable_poles", &F::unstable_poles, integer(0, kMaxPoles),
                   "Poles of the plant in the open right half-plane, which the points cannot tell.")
            .field("integrators", &F::integrators, integer(0, kMaxPoles), "Poles of the plant at s = 0.")
            .check(check_points)
            .example(
                {{"type", "frequency_response"},
                 {"omega", {0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.7, 1, 1.5}},
                 {"re", {1.89655, 1.46248, 0.659816, -0.12158, -0.345674, -0.392635, -0.261892, -0.0475484, 0.127895}},
                 {"im",
                  {-0.499239, -1.03012, -1.25086, -0.886125, -0.529631, -0.184589, 0.106829, 0.193244, 0.0366325}}});
        return d;
    }();
    return description;
}

}  // namespace

const Union<PlantModel>& plant_model_contract() {
    static const auto contract = [] {
        Union<PlantModel> plant("PlantModel",
                                "One linear plant, several that one controller must serve, measured points of one, or "
                                "differential equations.",
                                "type");
        plant.include(plant_contract())
            .alternative(plant_set())
            .alternative(frequency_response())
            .alternative(nonlinear_plant_contract());
        return plant;
    }();
    return contract;
}

}  // namespace tunewright::api
