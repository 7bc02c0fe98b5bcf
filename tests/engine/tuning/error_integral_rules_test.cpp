// Rules fitted to optima of error integrals: the published constants, and a check that their settings are near the
// claimed optimum.
#include "engine/loop/loop.h"
#include "engine/loop/stability.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "tests/engine/tuning/rule_support.h"

namespace tunewright {
namespace {

using test::expect_settings;
using test::Given;
using test::kP;
using test::kPI;
using test::kPID;
using test::tuned;
using test::word;

const double infinity = std::numeric_limits<double>::infinity();

struct Row {
    const char *criterion, *controller;
    double a1, b1, a2, b2, a3, b3;
};

Given given(const Row& row, const std::string& mode = "") {
    Given options{word("controller", row.controller), word("criterion", row.criterion)};
    if (!mode.empty()) options.push_back(word("mode", mode));
    return options;
}

void expect_power_laws(const std::string& id, const Row& row, const std::string& mode, double q) {
    SCOPED_TRACE(id + " " + row.controller + " " + row.criterion + " at L/T = " + std::to_string(q));
    const double T = 5, K = -2;
    const auto answer = tuned(id, Fopdt{.K = K, .T = T, .L = q * T}, given(row, mode));
    const double Ti = row.a2 == 0 ? infinity : T / row.a2 * std::pow(q, row.b2);
    expect_settings(answer, row.a1 * std::pow(q, row.b1) / K, Ti, row.a3 * T * std::pow(q, row.b3));
}

void expect_line(const std::string& id, const Row& row, const std::string& mode, double q) {
    SCOPED_TRACE(id + " " + row.controller + " " + row.criterion + " at L/T = " + std::to_string(q));
    const double T = 5, K = -2;
    const auto answer = tuned(id, Fopdt{.K = K, .T = T, .L = q * T}, given(row, mode));
    expect_settings(answer, row.a1 * std::pow(q, row.b1) / K, T / (row.a2 + row.b2 * q),
                    row.a3 * T * std::pow(q, row.b3));
}

const std::vector<Row> kLopez{
    {"ise", "P", 1.411, -0.917, 0, 0, 0, 0},
    {"iae", "P", 0.902, -0.985, 0, 0, 0, 0},
    {"itae", "P", 0.490, -1.084, 0, 0, 0, 0},
    {"ise", "PI", 1.305, -0.959, 0.492, 0.739, 0, 0},
    {"iae", "PI", 0.984, -0.986, 0.608, 0.707, 0, 0},
    {"itae", "PI", 0.859, -0.977, 0.674, 0.680, 0, 0},
    {"ise", "PID", 1.495, -0.945, 1.101, 0.771, 0.560, 1.006},
    {"iae", "PID", 1.435, -0.921, 0.878, 0.749, 0.482, 1.137},
    {"itae", "PID", 1.357, -0.947, 0.842, 0.738, 0.381, 0.995},
};

const std::vector<Row> kRovira{
    {"iae", "PI", 0.758, -0.861, 1.020, -0.323, 0, 0},
    {"itae", "PI", 0.586, -0.916, 1.030, -0.165, 0, 0},
    {"iae", "PID", 1.086, -0.869, 0.740, -0.130, 0.348, 0.914},
    {"itae", "PID", 0.965, -0.850, 0.796, -0.1465, 0.308, 0.929},
};

const std::vector<Row> kZhuangAthertonServo{
    {"ise", "PI", 0.980, -0.892, 0.690, -0.155, 0, 0},
    {"iste", "PI", 0.712, -0.921, 0.968, -0.247, 0, 0},
    {"ise", "PID", 1.048, -0.897, 1.195, -0.368, 0.489, 0.888},
    {"iste", "PID", 1.042, -0.897, 0.987, -0.238, 0.385, 0.906},
};

const std::vector<Row> kZhuangAthertonServoAbove1{
    {"ise", "PI", 1.072, -0.560, 0.648, -0.114, 0, 0},
    {"iste", "PI", 0.786, -0.559, 0.883, -0.158, 0, 0},
    {"ise", "PID", 1.154, -0.567, 1.047, -0.220, 0.490, 0.708},
    {"iste", "PID", 1.142, -0.579, 0.919, -0.172, 0.384, 0.839},
};

const std::vector<Row> kZhuangAthertonRegulation{
    {"ise", "PI", 1.279, -0.945, 0.535, 0.586, 0, 0},
    {"iste", "PI", 1.015, -0.957, 0.667, 0.552, 0, 0},
    {"ise", "PID", 1.473, -0.970, 1.115, 0.753, 0.550, 0.948},
    {"iste", "PID", 1.468, -0.970, 0.942, 0.725, 0.443, 0.939},
};

const std::vector<Row> kZhuangAthertonRegulationAbove1{
    {"ise", "PI", 1.346, -0.675, 0.552, 0.438, 0, 0},
    {"iste", "PI", 1.065, -0.673, 0.687, 0.427, 0, 0},
    {"ise", "PID", 1.524, -0.735, 1.130, 0.641, 0.552, 0.851},
    {"iste", "PID", 1.515, -0.730, 0.957, 0.598, 0.444, 0.847},
};

TEST(ErrorIntegralRules, ReproduceThePublishedConstants) {
    for (const double q : {0.1, 0.4, 1.0}) {
        for (const auto& row : kLopez) expect_power_laws("lopez", row, "", q);
        for (const auto& row : kRovira) expect_line("rovira", row, "", q);
        for (const auto& row : kZhuangAthertonServo) expect_line("zhuang_atherton", row, "servo", q);
        for (const auto& row : kZhuangAthertonRegulation) expect_power_laws("zhuang_atherton", row, "regulation", q);
    }
    for (const double q : {1.1, 2.0}) {
        for (const auto& row : kZhuangAthertonServoAbove1) expect_line("zhuang_atherton", row, "servo", q);
        for (const auto& row : kZhuangAthertonRegulationAbove1)
            expect_power_laws("zhuang_atherton", row, "regulation", q);
    }
}

TEST(WangJuangChan, FollowsItsFormula) {
    const auto answer = tuned("wang_juang_chan", Fopdt{.K = 2, .T = 10, .L = 4});
    expect_settings(answer, (0.7303 + 0.5307 * 2.5) * 12 / (2 * 14), 12, 20 / 12.0);
}

TEST(VisioliIntegrating, ReproducesThePublishedTable) {
    const auto criterion = [](const std::string& name) {
        return tuned("visioli_integrating", Ipdt{.K = 0.5, .L = 4}, {word("criterion", name)});
    };
    expect_settings(criterion("ise"), 1.37 / 2, 1.49 * 4, 0.59 * 4);
    expect_settings(criterion("itse"), 1.36 / 2, 1.66 * 4, 0.53 * 4);
    expect_settings(criterion("istse"), 1.34 / 2, 1.83 * 4, 0.49 * 4);
}

// The integral of t^n |e|^p after a unit step, on the interpolated response.
struct Criterion {
    double n, p;
};

Criterion criterion_of(const std::string& name) {
    if (name == "iae") return {0, 1};
    if (name == "itae") return {1, 1};
    if (name == "ise") return {0, 2};
    if (name == "itse") return {1, 2};
    return {2, 2};  // iste, istse
}

double integral(const std::vector<ResponseNode>& nodes, double target, const Criterion& criterion) {
    double sum = 0;
    for (size_t i = 1; i < nodes.size(); ++i) {
        const ResponseNode &a = nodes[i - 1], &b = nodes[i];
        const double h = b.t - a.t;
        constexpr int kParts = 4;
        for (int k = 0; k < kParts && h > 0; ++k) {
            const double s = (k + 0.5) / kParts, r = 1 - s;
            const double y = r * r * (1 + 2 * s) * a.y + s * r * r * h * a.y_slope + s * s * (3 - 2 * s) * b.y -
                             s * s * r * h * b.y_slope;
            sum += h / kParts * std::pow(a.t + s * h, criterion.n) * std::pow(std::abs(target - y), criterion.p);
        }
    }
    return sum;
}

struct Claim {
    std::string id;
    Given given;
    std::string criterion;
    bool servo;
    double c;  // weight of the set point in the derivative part, as in the source
};

double cost(const LinearPlant& plant, IdealPid pid, const Claim& claim) {
    pid.c = claim.c;
    pid.filter = pid.Td > 0 ? Filter{FilterType::derivative, 0.02 * pid.Td} : Filter{};
    const ParallelPid gains = to_parallel(pid);
    const auto loop = Loop::make(plant, gains);
    if (!loop || !count_unstable_poles(*loop).stable()) return 1e9;
    const StepInputs step{.r = claim.servo ? 1.0 : 0.0, .d = claim.servo ? 0.0 : 1.0};
    return integral(simulate_linear(plant, gains, step, {}).nodes, step.r, criterion_of(claim.criterion));
}

double min_cost(const LinearPlant& plant, const IdealPid& start, const Claim& claim) {
    const bool has_D = start.Td > 0;
    std::vector<double> x{std::log(start.Kp), std::log(start.Ti)};
    if (has_D) x.push_back(std::log(start.Td));
    const auto f = [&](const std::vector<double>& at, bool&) {
        return cost(plant, {.Kp = std::exp(at[0]), .Ti = std::exp(at[1]), .Td = has_D ? std::exp(at[2]) : 0}, claim);
    };
    const LocalOptions options{std::vector<double>(x.size(), 0.1), 1e-4, 80};
    return find_local_minimum(LocalSearch::nelder_mead, f, x, options).value;
}

// Wrong signs, columns or tables would be visible here: the fits are within 5 % of the optimum at L/T = 0.5.
TEST(ErrorIntegralRules, AreNearTheOptimumThatTheyClaim) {
    std::vector<Claim> claims;
    for (const auto& row : kLopez)
        if (row.a2 != 0) claims.push_back({"lopez", given(row), row.criterion, false, 0});
    for (const auto& row : kRovira) claims.push_back({"rovira", given(row), row.criterion, true, 0});
    for (const auto& row : kZhuangAthertonServo)
        claims.push_back({"zhuang_atherton", given(row, "servo"), row.criterion, true, 1});
    for (const auto& row : kZhuangAthertonRegulation)
        claims.push_back({"zhuang_atherton", given(row, "regulation"), row.criterion, false, 0});
    for (const std::string name : {"ise", "itse", "istse"})
        claims.push_back({"visioli_integrating", {word("criterion", name)}, name, false, 0});
    for (const auto& claim : claims) {
        SCOPED_TRACE(claim.id + " " + claim.criterion);
        const Plant given_plant =
            claim.id == "visioli_integrating" ? Plant(Ipdt{.K = 1, .L = 1}) : Plant(Fopdt{.K = 1, .T = 1, .L = 0.5});
        const LinearPlant plant = *LinearPlant::make(given_plant);
        const auto answer = tuned(claim.id, given_plant, claim.given);
        ASSERT_TRUE(answer);
        const double ratio = cost(plant, answer->controller, claim) / min_cost(plant, answer->controller, claim);
        EXPECT_LT(ratio, 1.05);
    }
}

}  // namespace
}  // namespace tunewright
