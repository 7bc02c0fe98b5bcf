// A text wherever a plant is expected, and the service's interpretation of one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>

#include "api/json/json.h"
#include "api/service.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

Json asked(const Json& question, int status = 200) {
    const Answer answer = parse_plant_call(question.dump());
    EXPECT_EQ(answer.status, status) << answer.body;
    return Json::parse(answer.body);
}

Json prepared(const Json& request) {
    const auto job = prepare_job(request.dump());
    if (const auto* problem = std::get_if<Problem>(&job)) return Json::parse(to_json(*problem));
    return Json::parse(std::get<PreparedJob>(job).request_json);
}

/// The formula without its markup.
std::string plain(const std::string& mathml) {
    std::string out;
    bool inside = false;
    for (const char c : mathml) {
        inside = inside || c == '<';
        if (!inside) out += c;
        inside = inside && c != '>';
    }
    return out;
}

TEST(TypedPlants, ATextIsAPlantItsFormulaAndItsText) {
    const Json answer = asked({{"text", "2 e^(-3s)/((10s+1)(2s+1))"}});
    EXPECT_EQ(answer["plant"], (Json{{"type", "sopdt"}, {"K", 2.0}, {"T1", 10.0}, {"T2", 2.0}, {"L", 3.0}}));
    EXPECT_EQ(answer["text"], "2 e^(-3 s)/((10 s + 1)(2 s + 1))");
    EXPECT_EQ(answer["formula"],
              "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\"><mrow><mi>P</mi><mrow><mo>(</mo>"
              "<mi>s</mi><mo>)</mo></mrow><mo>=</mo><mfrac><mrow><mn>2</mn><msup><mi>e</mi><mrow><mo>−</mo><mn>3</mn>"
              "<mi>s</mi></mrow></msup></mrow><mrow><mrow><mo>(</mo><mn>10</mn><mi>s</mi><mo>+</mo><mn>1</mn><mo>)</mo>"
              "</mrow><mrow><mo>(</mo><mn>2</mn><mi>s</mi><mo>+</mo><mn>1</mn><mo>)</mo></mrow></mrow></mfrac></mrow>"
              "</math>");
    EXPECT_EQ(asked({{"text", "K=2 T=10 min L=3 min"}, {"units", {{"time", "min"}}}})["plant"],
              (Json{{"type", "fopdt"}, {"K", 2.0}, {"T", 10.0}, {"L", 3.0}}));
}

// The formulas for each kind of plant, as an earlier version of the page drew them.
TEST(TypedPlants, EveryKindOfPlantHasItsFormula) {
    const auto formula = [](const Json& plant) {
        return plain(asked({{"plant", plant}})["formula"].get<std::string>());
    };
    EXPECT_EQ(formula({{"type", "fopdt"}, {"K", 1}, {"T", 10}, {"L", 1}}), "P(s)=e−s10s+1");
    EXPECT_EQ(formula({{"type", "fopdt"}, {"K", -2}, {"T", -4}, {"L", 0}}), "P(s)=−2−4s+1");
    EXPECT_EQ(formula({{"type", "fopdt"}, {"K", 1}, {"T", 0}, {"L", 0}}), "P(s)=1");
    EXPECT_EQ(formula({{"type", "sopdt"}, {"K", 1}, {"T", 2}, {"zeta", 0.5}, {"L", 0}}), "P(s)=14s2+2s+1");
    EXPECT_EQ(formula({{"type", "ipdt"}, {"K", 0.05}, {"L", 4}, {"T", 3}}), "P(s)=0.05e−4ss(3s+1)");
    EXPECT_EQ(formula({{"type", "transfer_function"}, {"num", {2, 1}}, {"den", {1, 3, 3, 1}}, {"L", 0.5}}),
              "P(s)=(2s+1)e−0.5ss3+3s2+3s+1");
    EXPECT_EQ(formula({{"type", "zpk"}, {"K", 6}, {"zeros", {-1}}, {"poles", {-3, {-1, 2}, {-1, -2}}}}),
              "P(s)=6(s+1)(s+3)(s2+2s+5)");
    EXPECT_EQ(formula("1/(s+1)^8"), "P(s)=1(s+1)8");
    EXPECT_EQ(formula({{"type", "transfer_function"}, {"num", {1e-7}}, {"den", {1, 1}}}), "P(s)=1·10−7s+1");
    EXPECT_EQ(formula({{"type", "state_space"}, {"A", {{-1, 0}, {1, -2}}}, {"B", {1, 0}}, {"C", {0, 1}}, {"D", 0.5}}),
              "P(s)=([01](sI−[−101−2])−1[10]+0.5)");
    const Json space = asked({{"plant", {{"type", "state_space"}, {"A", {{-1}}}, {"B", {1}}, {"C", {1}}}}});
    EXPECT_EQ(space["text"], "ss([-1], [1], [1], 0)");
}

TEST(TypedPlants, AFaultStandsAtItsField) {
    Json problem = asked({{"text", "2e^-3s/(10s+1"}}, 422);
    EXPECT_EQ(problem["errors"][0]["pointer"], "/text");
    EXPECT_EQ(problem["detail"], "A bracket is not closed; it opens at position 8; close it.");
    problem = prepared({{"plant", "2/(10s+1))"}});
    EXPECT_EQ(problem["errors"][0]["pointer"], "/plant");
    EXPECT_EQ(problem["detail"], "Position 10: this closing bracket has no opening one.");
    problem = prepared({{"plant", {{"type", "set"}, {"plants", {"1/(s+1)", "s/"}}}}});
    EXPECT_EQ(problem["errors"][0]["pointer"], "/plant/plants/1");
    EXPECT_THAT(asked({{"text", "K=1 T=3 min"}, {"units", {{"time", "samples"}}}}, 422)["detail"].get<std::string>(),
                HasSubstr("units.time"));
    EXPECT_EQ(asked({{"text", "2/(10s+"}, {"unfinished", true}}),
              (Json{{"fault", "A bracket is not closed; it opens at position 3; close it."}}));
    asked(Json::object(), 422);
    asked({{"text", "1/s"}, {"plant", "1/s"}}, 422);
    asked({{"text", 3}}, 422);
}

TEST(TypedPlants, AJobKeepsThePlantThatWasMeant) {
    const Json plant{{"type", "fopdt"}, {"K", 2.0}, {"T", 10.0}, {"L", 3.0}};
    const Json request = prepared({{"name", "TIC-101"}, {"plant", "2 e^(-3s)/(10s+1)"}});
    EXPECT_EQ(request, (Json{{"name", "TIC-101"}, {"plant", plant}}));
    const Json several = prepared({{"plant", {{"type", "set"}, {"plants", {"K=2 T=10 L=3", "2/(10s+1)"}}}}});
    EXPECT_EQ(several["plant"]["plants"][0], plant);

    const auto hash = [](const Json& one) { return std::get<PreparedJob>(prepare_job(one.dump())).request_hash; };
    EXPECT_EQ(hash({{"plant", "K=2 T=10 L=3"}}), hash({{"plant", "2*exp(-3*s)/(10*s+1)"}}));
    EXPECT_EQ(hash({{"plant", "K=2 T=10 L=3"}}), hash({{"plant", plant}}));
    EXPECT_NE(hash({{"plant", "K=2 T=10 L=3"}}), hash({{"plant", "K=2 T=10 L=4"}}));
}

TEST(TypedPlants, EveryCallThatTakesAPlantTakesAText) {
    const Json controller{{"form", "ideal"}, {"Kp", 1}, {"Ti", 10}};
    EXPECT_EQ(evaluate_call(Json{{"plant", "2 e^(-3s)/(10s+1)"}, {"controllers", {controller}}}.dump(), {}).status,
              200);
    const Json relay{{"u_plus", 1}, {"u_minus", -1}};
    EXPECT_EQ(relay_call(Json{{"plant", "2 e^(-3s)/(10s+1)"}, {"relay", relay}}.dump(), {}).status, 200);
    const auto entry = prepare_entry(Json{{"plant", "K=2 T=10 L=3"}, {"tune", {{{"method", "simc"}}}}}.dump());
    ASSERT_TRUE(std::holds_alternative<PreparedJob>(entry));
    const auto job = prepare_job(Json{{"plant", "K=2 T=10 L=3"}}.dump());
    const auto outcome = run_job(std::get<PreparedJob>(job), {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
}

}  // namespace
}  // namespace tunewright::api
