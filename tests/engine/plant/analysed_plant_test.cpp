// The subject of a request: every fault at once, each with its place; otherwise the data for the computation.
#include "engine/plant/analysed_plant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> places(const PlantModel& plant) {
    std::vector<std::string> places;
    const auto made = AnalysedPlant::make(plant);
    if (const auto* faults = std::get_if<std::vector<Error>>(&made))
        for (const Error& fault : *faults) places.push_back(fault.where);
    return places;
}

TEST(AnalysedPlant, NamesEveryFaultOfAPlantAtOnce) {
    EXPECT_THAT(places(Fopdt{.K = 0, .T = 1, .L = -1}), ElementsAre("plant/K", "plant/L"));
    EXPECT_THAT(places(OscillatorySopdt{.K = 0, .T = -1, .zeta = 0.5, .L = 1}), ElementsAre("plant/K", "plant/T"));
    EXPECT_THAT(places(TransferFunction{.num = {0, 0}, .den = {0}, .L = -2}),
                ElementsAre("plant/den", "plant/num", "plant/L"));
    EXPECT_THAT(places(StateSpace{.A = {{-1, 0}, {1}}, .B = {1}, .C = {1, 0, 0}}),
                ElementsAre("plant/A/1", "plant/B", "plant/C"));
    EXPECT_THAT(
        places(Fopdt{.K = 1, .T = 1, .L = 1, .uncertainty = {.K = FactorRange{1.1, 1.2}, .L = FactorRange{0, 1}}}),
        ElementsAre("plant/uncertainty/K", "plant/uncertainty/L/0"));
    EXPECT_THAT(places(Fopdt{.K = NAN, .T = INFINITY, .L = 1}), ElementsAre("plant/K", "plant/T"));
}

TEST(AnalysedPlant, PlacesTheFaultsOfASetAtItsMembers) {
    const PlantSet set{{Fopdt{.K = 1, .T = 1, .L = 1}, Fopdt{.K = 0, .T = 1, .L = 1}, Ipdt{.K = 1, .L = -1}}};
    EXPECT_THAT(places(set), ElementsAre("plant/plants/1/K", "plant/plants/2/L"));
    // A mode that input and output cannot reach, in the nominal plant and in another.
    const StateSpace hidden{.A = {{-1, 0}, {0, 2}}, .B = {1, 0}, .C = {1, 0}};
    EXPECT_THAT(places(PlantSet{{hidden, Fopdt{.K = 1, .T = 1, .L = 1}}}), ElementsAre("plant/plants/0/A"));
    EXPECT_THAT(places(PlantSet{{Fopdt{.K = 1, .T = 1, .L = 1}, hidden}}), ElementsAre("plant/plants/1/A"));
}

// Computed roots differ from their conjugates in the last digits.
TEST(AnalysedPlant, TakesConjugatesThatDifferByRounding) {
    const Zpk nearly{.K = 1, .zeros = {}, .poles = {{-1, 2}, {-1, -2.0000000000000004}}, .L = 1};
    const auto made = AnalysedPlant::make(Plant(nearly));
    ASSERT_TRUE(std::holds_alternative<AnalysedPlant>(made));
    const auto poles = std::get<AnalysedPlant>(made).linear()->poles();
    EXPECT_EQ(poles[0], std::conj(poles[1]));
    EXPECT_THAT(places(Zpk{.K = 1, .zeros = {}, .poles = {{-1, 2}, {-1, -2.001}}, .L = 1}),
                ElementsAre("plant/poles/0"));
}

TEST(AnalysedPlant, HasTheNominalPlantOfEveryKind) {
    const Fopdt plant{.K = 2, .T = 10, .L = 3};
    const auto single = std::get<AnalysedPlant>(AnalysedPlant::make(Plant(plant)));
    EXPECT_EQ(single.linear()->dead_time(), 3);
    EXPECT_EQ(single.family(), nullptr);
    const auto several =
        std::get<AnalysedPlant>(AnalysedPlant::make(PlantSet{{plant, Fopdt{.K = 3, .T = 10, .L = 3}}}));
    EXPECT_EQ(several.family()->regions.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<Fopdt>(*several.nominal()));
    const auto equations = std::get<AnalysedPlant>(AnalysedPlant::make(cstr("T")));
    EXPECT_EQ(equations.linear()->poles().size(), 2u);
    EXPECT_NE(equations.equations(), nullptr);
    FrequencyResponse points;
    for (double omega = 0.01; omega < 2; omega *= 1.3) {
        const auto P = single.linear()->at({0, omega});
        points.omega.push_back(omega);
        points.re.push_back(P.real());
        points.im.push_back(P.imag());
    }
    const auto measured = std::get<AnalysedPlant>(AnalysedPlant::make(points));
    EXPECT_NE(measured.measured(), nullptr);
    EXPECT_EQ(measured.linear(), nullptr);
    EXPECT_FALSE(measured.nominal());
}

}  // namespace
}  // namespace tunewright
