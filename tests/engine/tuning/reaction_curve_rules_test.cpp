// Cohen-Coon and Chien-Hrones-Reswick: the published tables, on plants from whose parameters they can be read.
#include "tests/engine/tuning/rule_support.h"

namespace tunewright {
namespace {

using test::expect_settings;
using test::Given;
using test::kP;
using test::kPI;
using test::tuned;
using test::word;

const double infinity = std::numeric_limits<double>::infinity();
const Fopdt kPlant{.K = 2, .T = 10, .L = 2};  // L/T = 0.2, a = K L/T = 0.4

TEST(CohenCoon, ReproducesThePublishedFormulas) {
    expect_settings(tuned("cohen_coon", kPlant, kP), 2.5 * (1 + 0.2 / 3), infinity, 0);
    expect_settings(tuned("cohen_coon", kPlant, kPI), 2.5 * (0.9 + 0.2 / 12), 2 * 30.6 / 13, 0);
    expect_settings(tuned("cohen_coon", kPlant), 2.5 * (4 / 3.0 + 0.05), 2 * 33.2 / 14.6, 8 / 11.4);
}

// A textbook example: K = 1.25, T = 4, L = 0.9.
TEST(CohenCoon, AgreesWithATextbookExample) {
    expect_settings(tuned("cohen_coon", Fopdt{.K = 1.25, .T = 4, .L = 0.9}, kPI), 3.2667, 2.045, 0, 5e-4);
}

struct Published {
    const char *controller, *mode, *overshoot;
    double a_Kp, Ti, Td;  // Ti and Td in units of the plant's time
};

TEST(ChienHronesReswick, ReproducesThePublishedTable) {
    const std::vector<Published> rows{
        {"P", "regulation", "0", 0.3, infinity, 0},  {"PI", "regulation", "0", 0.6, 8, 0},
        {"PID", "regulation", "0", 0.95, 4.8, 0.84}, {"P", "regulation", "20", 0.7, infinity, 0},
        {"PI", "regulation", "20", 0.7, 4.6, 0},     {"PID", "regulation", "20", 1.2, 4, 0.84},
        {"P", "servo", "0", 0.3, infinity, 0},       {"PI", "servo", "0", 0.35, 12, 0},
        {"PID", "servo", "0", 0.6, 10, 1},           {"P", "servo", "20", 0.7, infinity, 0},
        {"PI", "servo", "20", 0.6, 10, 0},           {"PID", "servo", "20", 0.95, 14, 0.94},
    };
    for (const auto& row : rows) {
        SCOPED_TRACE(std::string(row.controller) + " " + row.mode + " " + row.overshoot);
        const Given given{word("controller", row.controller), word("mode", row.mode), word("overshoot", row.overshoot)};
        expect_settings(tuned("chien_hrones_reswick", kPlant, given), row.a_Kp / 0.4, row.Ti, row.Td);
        // a = K L/T: only the slope matters if T does not occur.
        if (std::string(row.mode) == "regulation")
            expect_settings(tuned("chien_hrones_reswick", Ipdt{.K = 0.2, .L = 2}, given), row.a_Kp / 0.4, row.Ti,
                            row.Td);
    }
    expect_settings(tuned("chien_hrones_reswick", kPlant), 0.95 / 0.4, 4.8, 0.84);  // PID, regulation, 0 %
}

// Both take T from the reaction curve as static gain over steepest slope: for 1/(s + 1)^2, T = e, L = 3 - e.
TEST(ReactionCurveRules, UseTheSteepestSlope) {
    const double T = std::exp(1.0), L = 3 - T;
    const Sopdt plant{.K = 1, .T1 = 1, .T2 = 1};
    expect_settings(tuned("chien_hrones_reswick", plant, {word("mode", "servo")}), 0.6 * T / L, T, L / 2, 1e-7);
    expect_settings(tuned("cohen_coon", plant, kP), T / L * (1 + L / T / 3), infinity, 0, 1e-7);
}

}  // namespace
}  // namespace tunewright
