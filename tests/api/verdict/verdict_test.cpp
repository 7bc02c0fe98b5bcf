// No figure of an answer contradicts its verdict. Checked on random plants, sets, products and baselines, with limits
// that hold and limits that do not.
#include <gtest/gtest.h>

#include <random>

#include "tests/api/support.h"
#include "tests/api/verdict/verdict_claims.h"
#include "tests/long_or_quick.h"

namespace tunewright::api {
namespace {

class Dice {
public:
    explicit Dice(unsigned seed) : random_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
    double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    bool one_in(int n) { return std::uniform_int_distribution<>(1, n)(random_) == 1; }
    int below(int n) { return std::uniform_int_distribution<>(0, n - 1)(random_); }

private:
    std::mt19937 random_;
};

Json linear_plant(Dice& dice) {
    const double K = dice.log_between(0.1, 10) * (dice.one_in(4) ? -1 : 1), T = dice.log_between(0.2, 50);
    const double L = T * dice.log_between(0.02, 6);
    switch (dice.below(7)) {
        case 0: return {{"type", "sopdt"}, {"K", K}, {"T1", T}, {"T2", T * dice.between(0.1, 1)}, {"L", L}};
        case 1: return {{"type", "sopdt"}, {"K", K}, {"T", T}, {"zeta", dice.between(0.2, 1)}, {"L", L}};
        case 2: return {{"type", "ipdt"}, {"K", K}, {"L", L}};
        case 3: return {{"type", "fopdt"}, {"K", -K}, {"T", -T}, {"L", T * dice.between(0.05, 0.6)}};
        case 4:
            return {{"type", "transfer_function"},
                    {"num", {K * (dice.one_in(2) ? -0.3 : 0.2) * T, K}},
                    {"den", {T * T * T, 3 * T * T, 3 * T, 1}},
                    {"L", dice.one_in(2) ? 0 : L}};
        default: return {{"type", "fopdt"}, {"K", K}, {"T", T}, {"L", L}};
    }
}

Json plant(Dice& dice) {
    Json nominal = linear_plant(dice);
    if (dice.one_in(5)) {
        Json other = nominal;
        other["K"] = nominal.value("K", 1.0) * dice.between(0.6, 1.6);
        if (nominal["type"] != "transfer_function") return {{"type", "set"}, {"plants", {nominal, other}}};
    }
    if (dice.one_in(6) && nominal["type"] == "fopdt")
        nominal["uncertainty"] = {{"K", {dice.between(0.6, 1), dice.between(1, 1.6)}},
                                  {"L", {0.8, dice.between(1, 2)}}};
    return nominal;
}

Json controller(Dice& dice, double K, double T) {
    Json pid = {{"Kp", dice.log_between(0.05, 8) / K}, {"Ti", T * dice.log_between(0.1, 10)}};
    if (dice.one_in(8)) pid.erase("Ti");
    if (dice.one_in(2)) {
        pid["Td"] = T * dice.between(0.02, 1);
        if (!dice.one_in(4))
            pid["filter"] = {{"type", dice.one_in(2) ? "derivative" : "measurement_second_order"},
                             {"Tf", T * dice.log_between(1e-3, 1)}};
    }
    return pid;
}

double gain_of(const Json& plant) {
    const Json& nominal = plant["type"] == "set" ? plant["plants"][0] : plant;
    const double K = nominal.contains("K") ? nominal["K"].get<double>() : nominal["num"].back().get<double>();
    return nominal["type"] == "fopdt" && nominal["T"].get<double>() < 0 ? -K : K;
}

double time_of(const Json& plant) {
    const Json& nominal = plant["type"] == "set" ? plant["plants"][0] : plant;
    for (const char* name : {"T", "T1", "L"})
        if (nominal.contains(name) && nominal[name].get<double>() != 0) return std::abs(nominal[name].get<double>());
    return 1;
}

void add_questions(Json& request, Dice& dice, double T) {
    if (dice.one_in(3)) request["units"] = {{"time", "min"}, {"u", "%"}, {"y", "degC"}};
    Json evaluate = {{"points", 0}};
    if (dice.one_in(6)) {
        evaluate["actuator"] = {{"min", -dice.between(0.2, 3)}, {"max", dice.between(0.2, 3)}};
        if (dice.one_in(2)) evaluate["load_step"] = 1;
        if (dice.one_in(2)) evaluate["setpoint_step"] = 1;
    }
    if (dice.one_in(6)) evaluate["noise"] = {{"std", 0.1}, {"sample_time", 0.05 * T}};
    if (dice.one_in(10)) evaluate["horizon"] = T * dice.log_between(1, 100);
    request["evaluate"] = evaluate;
    if (dice.one_in(5)) request["implement"] = {{"sample_time", T * dice.log_between(0.01, 1)}};
}

Json job(Dice& dice) {
    static const std::vector<std::string> rules = {"simc",       "lambda",       "amigo", "ziegler_nichols_step",
                                                   "cohen_coon", "tavakoli_iae", "rimc"};
    Json request = {{"plant", plant(dice)}};
    const double K = gain_of(request["plant"]), T = time_of(request["plant"]);
    add_questions(request, dice, T);
    Json tune = Json::array();
    if (!dice.one_in(3)) {
        Json robust = {{"method", "robust"}};
        if (dice.one_in(2)) robust["Ms"] = robust["Mt"] = dice.between(1.15, 2.6);
        if (dice.one_in(5)) robust["Mt"] = dice.between(1.05, 2);
        if (dice.one_in(6)) robust["Mks"] = dice.log_between(0.5, 20) / std::abs(K);
        if (dice.one_in(4)) robust["controller"] = "PI";
        if (dice.one_in(4)) robust["setpoint"]["overshoot"] = dice.between(0, 20);
        tune.push_back(robust);
    }
    while (tune.empty() || dice.one_in(2))
        tune.push_back({{"method", rules[static_cast<std::size_t>(dice.below(static_cast<int>(rules.size())))]}});
    request["tune"] = tune;
    if (dice.one_in(2)) request["baseline"] = controller(dice, K, T);
    return request;
}

void expect_no_contradiction(const Json& answer, const Json& request) {
    for (const std::string& fault : contradictions(answer, request)) ADD_FAILURE() << fault << "\n" << request.dump();
}

TEST(Verdict, IsContradictedByNoFigureOfARandomJob) {
    const int wanted = long_or_quick(500, 150);
    int answers = 0, failed = 0;
    for (unsigned seed = 0; answers < wanted && seed < 900; ++seed) {
        Dice dice(seed);
        const Json request = job(dice);
        const auto prepared = prepare_job(request.dump());
        if (!std::holds_alternative<PreparedJob>(prepared)) continue;
        const auto outcome = run_job(std::get<PreparedJob>(prepared), {});
        if (outcome.status != JobOutcome::Status::succeeded) {
            ++failed;
            continue;
        }
        ++answers;
        expect_no_contradiction(Json::parse(outcome.result_json), request);
        if (HasFailure()) return;
    }
    EXPECT_EQ(answers, wanted);
    EXPECT_LT(failed, 2 * wanted / 5);
}

TEST(Verdict, IsContradictedByNoFigureOfControllersThatWereSent) {
    const int wanted = long_or_quick(1500, 450);
    int entries = 0;
    for (unsigned seed = 0; entries < wanted && seed < 1000; ++seed) {
        Dice dice(10'000 + seed);
        Json request = {{"plant", plant(dice)}};
        const double K = gain_of(request["plant"]), T = time_of(request["plant"]);
        add_questions(request, dice, T);
        for (int i = 0; i < 3; ++i) request["controllers"].push_back(controller(dice, K, T));
        const Answer answer = evaluate_call(request.dump(), {});
        if (answer.status != 200) continue;
        entries += 3;
        expect_no_contradiction(Json::parse(answer.body), request);
        if (HasFailure()) return;
    }
    EXPECT_GE(entries, wanted);
}

/// The implemented loop is designed: its ideal form may exceed the limit, and is not used.
TEST(Verdict, OfADesignForAControllerIsThatOfTheLoopAsItIsBuilt) {
    const Json request = {{"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}}},
                          {"tune", {{{"method", "robust"}, {"Ms", 1.6}, {"setpoint", {{"overshoot", 20}}}}}},
                          {"implement", {{"product", "simulink_pid_parallel"}, {"sample_time", 0.5}}},
                          {"evaluate", {{"points", 0}}}};
    const auto outcome = run_job(std::get<PreparedJob>(prepare_job(request.dump())), {});
    const Json entry = Json::parse(outcome.result_json)["controllers"][0];
    ASSERT_NEAR(entry["implemented"]["robustness"]["Ms"], 1.6, 2e-3);
    ASSERT_GT(entry["robustness"]["Ms"], 1.62);
    EXPECT_EQ(entry["verdict"][0]["code"], "robust") << entry["verdict"].dump();
    EXPECT_EQ(entry["verdict"][0]["text"], "Robust, limited by the requested margin.");
}

/// Otherwise a check that finds nothing would pass too.
TEST(Verdict, ContradictionsAreSeen) {
    const Json request = Json::parse(request_with(R"("baseline": {"Kp": 0.4, "Ti": 12}, "evaluate": {"points": 0})"));
    const auto outcome = run_job(std::get<PreparedJob>(prepare_job(request.dump())), {});
    const Json answer = Json::parse(outcome.result_json);
    ASSERT_TRUE(contradictions(answer, request).empty()) << contradictions(answer, request).front();
    const auto seen = [&](auto change) {
        Json changed = answer;
        change(changed["controllers"][0]);
        return !contradictions(changed, request).empty();
    };
    EXPECT_TRUE(seen([](Json& e) { e["region"] = {{"stable_fraction", 1}, {"worst_Ms", 8.19}}; }));
    EXPECT_TRUE(seen([](Json& e) { e["robustness"]["stable"] = false; }));
    EXPECT_TRUE(seen([](Json& e) { e["robustness"]["Ms"] = 1.8; }));
    EXPECT_TRUE(seen([](Json& e) { e["robustness"]["Mt"] = 1.9; }));
    EXPECT_TRUE(seen([](Json& e) { e["performance"]["load"]["IAE"] = 99; }));
    EXPECT_TRUE(seen([](Json& e) { e["performance"]["setpoint"]["settling_time"] = nullptr; }));
    EXPECT_TRUE(seen([](Json& e) { e["verdict"][0]["text"] = "Robust: Ms 1.23."; }));
    EXPECT_TRUE(seen([](Json& e) { e["robustness"]["tolerates"]["extra_dead_time"] = 0.1; }));
    EXPECT_TRUE(seen([](Json& e) { e["verdict"][0]["level"] = "warning"; }));
}

}  // namespace
}  // namespace tunewright::api
