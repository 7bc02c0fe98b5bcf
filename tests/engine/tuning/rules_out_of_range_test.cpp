// Every rule warns outside its range, and refuses where it does not apply, with a sentence that gives the reason.
#include "tests/engine/tuning/rule_support.h"

namespace tunewright {
namespace {

using test::Given;
using test::kP;
using test::kPI;
using test::tuned;
using test::word;

struct Case {
    std::string id;
    Given given;
    Plant plant;
    std::string says;  // part of the warning's detail
};

const Fopdt kLittleDeadTime{.K = 1, .T = 100, .L = 1}, kMuchDeadTime{.K = 1, .T = 1, .L = 8},
    kNoDeadTime{.K = 1, .T = 5, .L = 0}, kNoLag{.K = 1, .T = 0, .L = 5}, kUnstable{.K = -1, .T = -4, .L = 1},
    kUsual{.K = 1, .T = 2, .L = 1};
const Ipdt kIntegrating{.K = 0.5, .L = 2}, kBareIntegrator{.K = 1, .L = 0};
const TransferFunction kDoubleIntegrator{.num = {1}, .den = {1, 0, 0}, .L = 1};
const Zpk kHopeless{.K = -1, .zeros = {}, .poles = {1.0, 2.0, 3.0}};

const std::vector<Case> kWarns{
    {"amigo", {}, kLittleDeadTime, "below 0.3"},
    {"simc", {{"tau_c", 0.5}}, kUsual, "below the effective dead time"},
    {"simc", {}, Sopdt{.K = 1, .T1 = 5, .T2 = 1, .L = 2}, "The second lag T2 = 1 is below"},
    {"lambda", {{"lambda", 0.1}}, kUsual, "the smallest that the source recommends"},
    {"lambda", {{"lambda", 1.0}}, kIntegrating, "below the dead time"},
    {"ziegler_nichols_step", {}, kLittleDeadTime, "outside the usual range 0.1 to 1"},
    {"ziegler_nichols_step", {}, kMuchDeadTime, "sluggish"},
    {"ziegler_nichols_ultimate", {}, kMuchDeadTime, "outside the usual range 2.25 to 15"},
    {"ziegler_nichols_ultimate", {}, kLittleDeadTime, "very high gains"},
    {"ziegler_nichols_ultimate", {}, kUnstable, "The plant is unstable"},
    {"tyreus_luyben", {}, kMuchDeadTime, "above 0.5: the dead time is large"},
    {"tyreus_luyben", {}, kUnstable, "also needs a minimal gain"},
    {"amigo_ultimate", {}, kIntegrating, "below 0.1"},
    {"cohen_coon",
     {},
     kLittleDeadTime,
     "L/T is 0.01, outside 0.1 to 1, the range of L/T for which Cohen-Coon was made"},
    {"cohen_coon", kPI, kMuchDeadTime, "L/T is 8, outside 0.1 to 1"},
    {"chien_hrones_reswick", {}, kLittleDeadTime, "Chien-Hrones-Reswick was made"},
    {"chien_hrones_reswick", {word("mode", "servo")}, kMuchDeadTime, "for set points was made"},
    {"tavakoli_ise", {}, kMuchDeadTime, "outside 0.1 to 2"},
    {"tavakoli_iae", {}, kLittleDeadTime, "Tavakoli was made"},
    {"tavakoli_itae", {}, kMuchDeadTime, "Tavakoli was made"},
    {"lopez", {}, kLittleDeadTime, "the range of L/T for which Lopez was made"},
    {"lopez", kP, kMuchDeadTime, "outside 0.1 to 1"},
    {"rovira", {}, kLittleDeadTime, "Rovira was made"},
    {"zhuang_atherton", {}, Fopdt{.K = 1, .T = 1, .L = 3}, "outside 0.1 to 2"},
    {"wang_juang_chan", {}, kMuchDeadTime, "outside 0.05 to 6"},
    {"wang_juang_chan", {}, kLittleDeadTime, "L/T is 0.01"},
    {"improved_simc", {{"tau_c", 0.2}}, kUsual, "below 0.5, the smallest"},
    {"improved_simc", {{"tau_c", 0.7}, word("controller", "PI")}, kUsual, "below 1, the smallest"},
    {"kappa_tau", {}, Fopdt{.K = 1, .T = 4, .L = 1}, "outside 0.4 to 4"},
    {"kappa_tau", kPI, kMuchDeadTime, "outside 0.1 to 4"},
    {"haalman", kPI, kLittleDeadTime, "response to loads slow"},
    {"haalman", {}, kUsual, "no second lag"},
    {"gain_phase_margin", {}, kUsual, "no second lag"},
    {"arrieta_ms", {}, Fopdt{.K = 1, .T = 1, .L = 3}, "L/T is 3, outside the range 0.1 to 2"},
    {"arrieta_degradation", {}, Fopdt{.K = 1, .T = 10, .L = 0.9}, "L/T is 0.09, outside the range 0.1 to 2"},
    {"arrieta_degradation", {{"degradation", 0.4}}, kUsual, "those for 0.4 were computed on the model"},
    {"npid_ise", {}, kMuchDeadTime, "outside the range 0.01 to 3 for which the rule was fitted"},
    {"npid_iae", {}, Fopdt{.K = 1, .T = 100, .L = 0.9}, "L/T is 0.009"},
    {"npid_itae", {}, Fopdt{.K = 1, .T = 1, .L = 0.95}, "Between 0.9 and 1"},
};

TEST(RulesOutOfRange, AreAnsweredWithAWarningThatNamesTheFigure) {
    for (const auto& [id, given, plant, says] : kWarns) {
        SCOPED_TRACE(id + ": " + says);
        const auto answer = tuned(id, plant, given);
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_TRUE(std::ranges::any_of(answer->warnings, [&](const Warning& w) {
            return w.detail.find(says) != std::string::npos;
        })) << (answer->warnings.empty() ? "no warning" : answer->warnings.front().detail);
    }
}

TEST(RulesOutOfRange, AreSilentWithin) {
    for (const std::string id : {"ziegler_nichols_step", "ziegler_nichols_ultimate", "tyreus_luyben", "amigo_ultimate",
                                 "cohen_coon", "chien_hrones_reswick", "tavakoli_ise", "tavakoli_iae", "tavakoli_itae",
                                 "lopez", "rovira", "zhuang_atherton", "wang_juang_chan", "improved_simc", "kappa_tau"})
        EXPECT_TRUE(tuned(id, kUsual)->warnings.empty()) << id;
}

const std::vector<Case> kRefuses{
    {"arrieta_ms", {}, kIntegrating, "plant: The rule is written for stable first-order models"},
    {"arrieta_ms", {}, kNoDeadTime, "dead time"},
    {"arrieta_degradation", {}, kNoLag, "T = 0"},
    {"npid_iae", {}, kIntegrating, "plant: The rule is written for a stable first-order lag"},
    {"npid_ise", {}, kNoDeadTime, "plant/L: The rule raises L/T to a negative power"},
    {"npid_itae", {}, kNoLag, "plant/T: The rule divides by the lag T"},
    {"rimc", {}, kUnstable, "plant"},
    {"cohen_coon", {}, kNoDeadTime, "plant/L: Cohen-Coon divides by the dead time, but that of the model is 0. Give"},
    {"chien_hrones_reswick", {}, kNoDeadTime, "plant/L: Chien-Hrones-Reswick divides by the dead time"},
    {"lopez", {}, kNoDeadTime, "plant/L: Lopez divides by the dead time"},
    {"rovira", {}, kNoLag, "plant/T: Rovira needs a lag, but the model is a pure dead time (T = 0). Use amigo"},
    {"rovira", {}, Fopdt{.K = 1, .T = 1, .L = 6}, "plant: Rovira gives a negative integral time for L/T = 6"},
    {"zhuang_atherton", {}, kMuchDeadTime, "plant: Zhuang-Atherton gives a negative integral time for L/T = 8"},
    {"tavakoli_iae", {}, kNoLag, "plant/T: Tavakoli needs a lag"},
    {"zhuang_atherton", {}, kIntegrating, "plant: Zhuang-Atherton has no formulas for integrating plants. Use simc"},
    {"wang_juang_chan", {}, kIntegrating, "plant: Wang-Juang-Chan has no formulas for integrating plants"},
    {"cohen_coon", {}, kIntegrating, "plant: Cohen-Coon has no formulas for integrating plants"},
    {"chien_hrones_reswick", {word("mode", "servo")}, kIntegrating, "Chien-Hrones-Reswick for set points has no form"},
    {"kappa_tau", {}, kIntegrating, "has no formulas for integrating plants"},
    {"haalman", {}, kIntegrating, "Haalman's rule has no formulas for integrating plants"},
    {"haalman", {}, kDoubleIntegrator, "Haalman's rule has no formulas for integrating plants"},
    {"haalman", {}, kNoDeadTime, "plant/L: Haalman's rule divides by the dead time"},
    {"haalman", {}, kNoLag, "plant/T: Haalman's rule needs a lag"},
    {"gain_phase_margin", {}, kIntegrating, "Ho, Hang and Cao's rule has no formulas for integrating plants"},
    {"gain_phase_margin", {}, kNoDeadTime, "plant/L: Ho, Hang and Cao's rule divides by the dead time"},
    {"gain_phase_margin", {}, kNoLag, "plant/T: Ho, Hang and Cao's rule needs a lag"},
    {"improved_simc", {}, kNoDeadTime, "plant/L: The improvement over SIMC depends on the dead time"},
    {"visioli_integrating", {}, kUsual, "plant: Visioli's rule is for integrating plants, but this one has no"},
    {"visioli_integrating", {}, kBareIntegrator, "plant/L: Visioli's rule divides by the dead time"},
    {"ziegler_nichols_ultimate", {}, kNoDeadTime, "plant: No proportional gain makes this plant oscillate"},
    {"ziegler_nichols_ultimate", {}, Sopdt{.K = 1, .T1 = 2, .T2 = 1}, "its phase does not reach -180 degrees"},
    {"ziegler_nichols_ultimate", {}, kHopeless, "The plant is unstable, and no proportional gain stabilises it"},
    {"ziegler_nichols_ultimate",
     {word("controller", "PI"), word("variant", "pessen")},
     kUsual,
     "variant: variant is pessen, which exists only for PID"},
    {"ziegler_nichols_ultimate", {word("ultimate", "relay")}, kUsual, "ultimate: ultimate is relay, but there is no"},
    {"tyreus_luyben", {}, kBareIntegrator, "It has no ultimate point"},
    {"tyreus_luyben", {{"Ku", 2.0}}, kUsual, "Pu: Ku is given without Pu"},
    {"tyreus_luyben",
     {{"Ku", 2.0}, {"Pu", 1.0}},
     TransferFunction{.num = {1, 0}, .den = {1, 2, 1}, .L = 1},
     "plant: The plant has a zero at s = 0"},
    {"amigo_ultimate", {}, kUnstable, "plant: The rule needs a stable or integrating plant"},
    {"amigo_ultimate", {}, kNoDeadTime, "No proportional gain makes this plant oscillate"},
    {"lopez", {}, kUnstable, "plant: The plant is unstable (a pole at 0.25)"},
    {"kappa_tau", {}, kDoubleIntegrator, "plant: The plant has 2 integrators; the model can have at most 1"},
    {"tavakoli_ise",
     {{"reduction/horizon", 10.0}},
     Sopdt{.K = 1, .T1 = 2, .T2 = 1, .L = 1},
     "reduction/horizon: horizon is given, but the reduction auto has none"},
    {"cohen_coon",
     {word("reduction/method", "123c")},
     TransferFunction{.num = {7, 1}, .den = {1, 10.1, 1}},
     "reduction/method: 123c does not apply: the step response passes 25 %"},
};

TEST(RulesOutOfRange, RefuseWhatTheyDoNotApplyToWithPlaceReasonAndCure) {
    for (const auto& [id, given, plant, says] : kRefuses) {
        SCOPED_TRACE(id + ": " + says);
        const auto answer = tuned(id, plant, given);
        ASSERT_FALSE(answer);
        EXPECT_THAT(answer.error().where + ": " + answer.error().message, testing::HasSubstr(says));
    }
}

}  // namespace
}  // namespace tunewright
