// Jin & Son (2019), Tables 4, 6 and 8: the linear rules' rows on the paper's own models.
#include <gtest/gtest.h>

#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"

namespace tunewright {
namespace {

struct Row {
    const char *process, *method;
    double Kp, Ti, Td;
};

Fopdt model_of(const std::string& process) {
    if (process == "I") return {.K = 1, .T = 10.002, .L = 3.06};
    if (process == "II") return {.K = 1.001, .T = 2.306, .L = 2.32};
    return {.K = 1.002, .T = 2.497, .L = 6.64};
}

TEST(JinSonLinearRules, TavakoliAndZieglerNicholsRowsFollowToTheirFourDecimals) {
    const std::vector<Row> rows{
        {"I", "ziegler_nichols_step", 3.9224, 6.12, 1.53},    {"I", "tavakoli_ise", 2.3650, 10.4032, 0.1111},
        {"I", "tavakoli_iae", 1.9765, 10.2422, 0.1111},       {"I", "tavakoli_itae", 1.9707, 10.92, 0.5307},
        {"II", "ziegler_nichols_step", 1.1916, 4.64, 1.16},   {"II", "tavakoli_ise", 0.9950, 3.96, 0.0256},
        {"II", "tavakoli_iae", 0.8283, 3.2081, 0.0256},       {"II", "tavakoli_itae", 0.7226, 3.002, 0.1331},
        {"III", "ziegler_nichols_step", 0.4504, 13.28, 3.32}, {"III", "tavakoli_ise", 0.5702, 5.2092, 0.0277},
        {"III", "tavakoli_iae", 0.3491, 4.8427, 0.0277},      {"III", "tavakoli_itae", 0.2894, 4.489, 0.1476},
    };
    for (const Row& row : rows) {
        SCOPED_TRACE(std::string(row.process) + " " + row.method);
        const Plant plant = model_of(row.process);
        MethodOptions pure;
        pure.set("filter/Tf_over_Td", 0.0);
        const auto answer = find_method(row.method)->tune({plant, *LinearPlant::make(plant), std::nullopt}, pure, {});
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_NEAR(answer->controller.Kp, row.Kp, 6e-5);
        EXPECT_NEAR(answer->controller.Ti, row.Ti, 6e-5);
        EXPECT_NEAR(answer->controller.Td, row.Td, 6e-5);
        EXPECT_EQ(answer->controller.filter.type, FilterType::none);
    }
}

// Recomputed from unrounded L/T.
TEST(JinSonLinearRules, OutputsAgreeWithTheReferenceToSixDigits) {
    struct Output {
        const char *process, *method;
        double Kp, Ti, Td;
    };
    for (const auto& row : {Output{"I", "tavakoli_ise", 2.364962, 10.40317, 0.1111333},
                            Output{"II", "tavakoli_iae", 0.8283102, 3.208101, 0.02562222},
                            Output{"III", "tavakoli_itae", 0.2893613, 4.489, 0.1475998}}) {
        const Plant plant = model_of(row.process);
        const auto answer = find_method(row.method)->tune({plant, *LinearPlant::make(plant), std::nullopt}, {}, {});
        ASSERT_TRUE(answer);
        EXPECT_NEAR(answer->controller.Kp, row.Kp, 1e-6 * row.Kp);
        EXPECT_NEAR(answer->controller.Ti, row.Ti, 1e-6 * row.Ti);
        EXPECT_NEAR(answer->controller.Td, row.Td, 1e-6 * row.Td);
        EXPECT_NEAR(answer->controller.filter.Tf, row.Td / 10, 1e-6 * row.Td);
    }
}

}  // namespace
}  // namespace tunewright
