// Every alternative of the variant Plant, by the example of its description: a new type that lacks its description, its
// formula, its text, the numbers between which a range interpolates, or a parameter by name fails here.
#include <algorithm>
#include <cmath>
#include <complex>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "api/contract/plant/mathml.h"
#include "api/contract/plant/plant.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/plant_family.h"
#include "engine/plant/typed/typed_plant.h"
#include "engine/range/model/parameters.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

struct DescribedPlant {
    Json json;
    Plant plant;
};

std::vector<DescribedPlant> plant_of_each_type() {
    SchemaBook book;
    plant_contract().schema(book);
    std::vector<DescribedPlant> plants;
    for (const Json& choice : book.components.at("Plant").at("oneOf")) {
        const auto name = choice.at("$ref").get<std::string>();
        Json json = book.components.at(name.substr(name.rfind('/') + 1)).at("examples").at(0);
        const auto decoded = decode<Plant>(plant_contract(), json.dump());
        EXPECT_TRUE(decoded.faults.empty()) << json << detail_at(decoded.faults, "none");
        plants.push_back({std::move(json), decoded.value});
    }
    return plants;
}

/// Numbers in a plant's JSON, at any depth.
std::size_t count_of_numbers(const Json& json) {
    if (!json.is_structured()) return json.is_number() ? 1 : 0;
    std::size_t sum = 0;
    for (const Json& member : json) sum += count_of_numbers(member);
    return sum;
}

/// max |P1 - P2|/|P1| at 20 frequencies from 0.01 to 100.
double relative_distance(const Plant& one, const Plant& other) {
    const auto p = LinearPlant::make(one), q = LinearPlant::make(other);
    if (!p || !q) return INFINITY;
    double worst = 0;
    for (int i = 0; i < 20; ++i) {
        const std::complex<double> s(0, 0.01 * std::pow(10, i * 4.0 / 19)), a = p->at(s), b = q->at(s);
        worst = std::max(worst, std::abs(a - b) / std::abs(a));
    }
    return worst;
}

TEST(PlantTypes, EachHasADescriptionAndIsWrittenAsItIsRead) {
    std::set<std::size_t> described;
    for (const auto& [json, plant] : plant_of_each_type()) {
        described.insert(plant.index());
        const std::string written = encode(plant_contract(), plant);
        const auto back = decode<Plant>(plant_contract(), written);
        EXPECT_TRUE(back.faults.empty()) << written;
        EXPECT_EQ(back.value.index(), plant.index()) << written;
        EXPECT_EQ(encode(plant_contract(), back.value), written);
        for (const auto& [name, value] : json.items()) EXPECT_EQ(Json::parse(written).at(name), value) << json;
        EXPECT_EQ(schema_faults(Json::parse(written), "Plant"), std::vector<std::string>{}) << written;
    }
    EXPECT_EQ(described.size(), std::variant_size_v<Plant>);
}

TEST(PlantTypes, EachIsShownAsAFormulaAndReadBackFromItsText) {
    for (const auto& [json, plant] : plant_of_each_type()) {
        EXPECT_EQ(mathml(plant).rfind("<math", 0), 0U) << json;
        const auto formula = typed::formula_of(plant);
        EXPECT_EQ(formula.has_value(), !std::holds_alternative<StateSpace>(plant)) << json;
        if (formula) {
            const auto shown = typed::plant_of(*formula);
            ASSERT_TRUE(shown) << json;
            EXPECT_LT(relative_distance(plant, *shown), 1e-9) << json;
        }
        const std::string text = plant_text(plant);
        const auto typed = read_plant(text);
        ASSERT_TRUE(typed) << text;
        EXPECT_LT(relative_distance(plant, typed->plant), 1e-9) << text;
    }
}

TEST(PlantTypes, ARangeInterpolatesEveryNumberOfAllButZerosAndPolesAndStateSpaces) {
    for (const auto& [json, plant] : plant_of_each_type()) {
        const bool none = std::holds_alternative<Zpk>(plant) || std::holds_alternative<StateSpace>(plant);
        EXPECT_EQ(range::same_structure(plant, plant), !none) << json;
        const Json written = Json::parse(encode(plant_contract(), plant));
        EXPECT_EQ(range::structure_numbers(plant).size(), none ? 0 : count_of_numbers(written)) << written;
        if (none) continue;
        EXPECT_LT(relative_distance(plant, range::plant_between(plant, plant, 0.5)), 1e-12) << json;
    }
}

TEST(PlantTypes, EveryParameterIsReadAndSetByItsName) {
    for (const auto& [json, plant] : plant_of_each_type()) {
        const Json written = Json::parse(encode(plant_contract(), plant));
        for (const auto& [name, value] : written.items()) {
            // A state space is moved by its gain, and D is a part of it.
            if (!value.is_number() || name == "D") continue;
            EXPECT_EQ(parameter(plant, name), value.get<double>()) << json << name;
            Plant moved = plant;
            set_parameter(moved, name, value.get<double>() + 0.25);
            EXPECT_EQ(Json::parse(encode(plant_contract(), moved)).at(name), value.get<double>() + 0.25)
                << name << json;
        }
    }
}

}  // namespace
}  // namespace tunewright::api
