#include "api/services/verify/verify_entry.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "api/certificate/write_certificate.h"
#include "api/contract/controller.h"
#include "api/contract/plant/plant.h"
#include "api/contract/result/evaluation.h"
#include "api/services/verify/figure_comparison.h"
#include "engine/evaluation/evaluate.h"
#include "engine/verify/second_figures.h"

namespace tunewright::api {
namespace {

using verify::SecondFigures;

/// Members of an entry that a second computation does not reach, with the reason.
constexpr std::array<std::pair<std::string_view, const char*>, 12> kNoSecondWay = {{
    {"implemented", "The figures of the sampled program have no second computation here."},
    {"longest_sample_time", "It is the result of a search over sampled loops."},
    {"optimum_at_Ms", "It belongs to another design, found by a search."},
    {"standing", "It restates the figures of the entry, or of another design."},
    {"own_step", "The response to the user's own step has no second computation here."},
    {"replay", "The replay of a record has no second computation here."},
    {"emulation", "The nonlinear comparison of the method has no second computation here."},
    {"rimc", "The report of the method has no second computation here."},
    {"tradeoff", "The report of the method has no second computation here."},
    {"reduced_model", "The reduction of the plant has no second computation here."},
    {"nonlinear", "The criteria of the nonlinear PID have no second computation here."},
    {"frontier", "Its points are other designs, without settings of their own."},
}};

template <class T, class Contract>
std::optional<T> read_as(const Contract& contract, const Json& value) {
    T target{};
    Reader reader;
    contract.read(value, target, reader);
    if (reader.problem()) return std::nullopt;
    return target;
}

std::optional<Controller> read_controller(Json value) {
    if (value.is_object()) value.erase("action");
    return read_as<Controller>(controller_contract(), value);
}

}  // namespace

std::optional<LinearPlant> decode_plant(const Json& value) {
    const auto plant = read_as<Plant>(plant_contract(), value);
    if (!plant) return std::nullopt;
    auto linear = LinearPlant::make(*plant);
    return linear ? std::optional(std::move(*linear)) : std::nullopt;
}

namespace {

std::optional<double> number_at(const Json& value, const char* name) {
    const auto found = value.find(name);
    return found != value.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

IndexErrors stated_errors(const Json& entry, const char* of) {
    const Json verification = entry.value("verification", Json::object());
    const Json errors = verification.value(of, Json::object());
    return {number_at(errors, "IAE"), number_at(errors, "ISE"), number_at(errors, "ITAE"), number_at(errors, "TV")};
}

void add_unverified(VerifyAnswer& answer, const std::string& where, const SecondFigures& second,
                    std::string_view part) {
    for (const verify::Unverified& one : second.unverified)
        if (one.part.starts_with(part)) answer.not_verified.push_back({where + "/" + one.part, one.why});
}

void compare_performance(VerifyAnswer& answer, const std::string& where, const Json& given, const Json& entry,
                         const SecondFigures& second) {
    const Json found = json_of(performance_contract(), second.performance);
    for (const auto& [name, errors] : {std::pair{"setpoint", "setpoint_errors"}, {"load", "load_errors"}})
        if (given.contains(name) && !second.lacks(std::string("performance/") + name))
            compare_figures(answer, where + "/" + name, given.at(name), found.value(name, Json()),
                            stated_errors(entry, errors));
    if (!given.contains("noise") || second.lacks("performance/noise")) return;
    for (const auto& [name, figure] : {std::pair{"u_std", "u_std"}, {"gain", "noise_gain"}})
        compare_value(answer, where + "/noise/" + name, figure, given.at("noise").at(name), found.at("noise").at(name),
                      {});
}

void verify_certificate(VerifyAnswer& answer, const std::string& where, const Json& given) {
    const CertificateProblem problem = read_problem(given.at("problem"));
    const auto plant = decode_plant({{"type", "transfer_function"},
                                     {"num", problem.plant.num},
                                     {"den", problem.plant.den},
                                     {"L", problem.plant.L}});
    if (!plant) return;
    const bool tied = problem.structure == CertifiedStructure::pid_tied;
    const auto& [k, ki, third] = problem.design;
    ParallelPid pid{.Kp = k, .Ki = ki, .Kd = tied ? k * third : third};
    const double Tf = tied ? third / 10 : problem.Tf;
    if (Tf > 0) pid.filter = {FilterType::measurement_second_order, Tf};
    const SecondFigures second = verify::second_figures(*plant, pid, {});
    const Figure& IAE = second.performance.load.IAE;
    compare_value(answer, where + "/problem/upper", "searched_IAE", given.at("problem").at("upper"),
                  IAE ? Json(*IAE) : Json(), {});
    const bool in_order = given.at("lower").get<double>() <= problem.upper;
    answer.figures.push_back({.where = where + "/lower",
                              .figure = "lower",
                              .given = given.at("lower"),
                              .found = given.at("problem").at("upper"),
                              .difference = {},
                              .agrees = in_order});
    answer.not_verified.push_back(
        {where + "/lower", "Only lower <= upper is checked; tools/check_certificate.py checks the proof itself."});
}

void verify_region(VerifyAnswer& answer, const std::string& where, const Json& given, const ParallelPid& pid) {
    const auto worst = decode_plant(given.value("worst_plant", Json()));
    if (worst && given.value("worst_Ms", Json()).is_number()) {
        const SecondFigures second = verify::second_figures(*worst, pid, {});
        const Figure& Ms = second.robustness.Ms;
        if (!second.lacks("robustness"))
            compare_value(answer, where + "/worst_Ms", "worst_Ms", given.at("worst_Ms"), Ms ? Json(*Ms) : Json(), {});
    }
    answer.not_verified.push_back(
        {where, "Ms of worst_plant is verified; that no plant of the region is worse, and stable_fraction, are not."});
}

void verify_loop(VerifyAnswer& answer, const std::string& where, const Json& entry, const Controller& controller,
                 const VerifiedSubject& subject) {
    const ParallelPid pid = gains(controller);
    const Json& given = entry.at("robustness");
    const SecondFigures second = verify::second_figures(*subject.plant, pid, subject.options,
                                                        {number_at(given, "omega_Ms"), number_at(given, "omega_Mt")});
    add_unverified(answer, where, second, "robustness");
    if (!second.lacks("robustness"))
        compare_figures(answer, where + "/robustness", given, json_of(robustness_contract(), second.robustness), {});
    if (!second.robustness.stable) return;
    if (std::holds_alternative<Npid>(controller)) {
        answer.not_verified.push_back(
            {where + "/performance", "The responses of the nonlinear PID have no second computation here."});
        return;
    }
    if (!subject.nonlinear) {
        add_unverified(answer, where, second, "performance");
        compare_performance(answer, where + "/performance", entry.at("performance"), entry, second);
        return;
    }
    answer.not_verified.push_back({where + "/performance",
                                   "The responses of a plant given by equations have no second computation here; those "
                                   "of its linearisation have."});
    if (!entry.contains("linear")) return;
    add_unverified(answer, where + "/linear", second, "performance");
    compare_performance(answer, where + "/linear/performance", entry.at("linear").at("performance"), entry, second);
}

}  // namespace

void verify_entry(VerifyAnswer& answer, const std::string& where, const Json& entry, const VerifiedSubject& subject) {
    if (!entry.contains("robustness")) return;
    const auto controller = read_controller(entry.at("controller"));
    if (!controller || subject.plant == nullptr) {
        answer.not_verified.push_back({where, subject.plant == nullptr
                                                  ? "There is no linear plant, so the loop has no second computation."
                                                  : "The controller is not one of the forms that requests have."});
        return;
    }
    verify_loop(answer, where, entry, *controller, subject);
    if (entry.contains("region")) verify_region(answer, where + "/region", entry.at("region"), gains(*controller));
    if (entry.contains("certificate")) verify_certificate(answer, where + "/certificate", entry.at("certificate"));
    for (const auto& [name, why] : kNoSecondWay)
        if (entry.contains(name)) answer.not_verified.push_back({where + "/" + std::string(name), why});
}

namespace {

/// Adds the IAE after a unit load step, a member of `given` by its name, and with_peaks its Ms and Mt: of this plant
/// with this controller.
void verify_point(VerifyAnswer& answer, const std::string& where, const Json& given, const Json& plant,
                  const Json& controller, const std::string& name_of_IAE, bool with_peaks) {
    const auto linear = decode_plant(plant);
    const auto law = read_controller(controller);
    if (!linear || !law) {
        answer.not_verified.push_back({where, "The point has no linear plant of its own in the answer."});
        return;
    }
    const SecondFigures second = verify::second_figures(*linear, gains(*law), {});
    const auto compare = [&](const std::string& name, const std::string& figure, const Figure& found) {
        if (given.contains(name))
            compare_value(answer, where + "/" + name, figure, given.at(name), found ? Json(*found) : Json(), {});
    };
    if (!second.lacks("performance/load")) compare(name_of_IAE, "searched_IAE", second.performance.load.IAE);
    if (!with_peaks || second.lacks("robustness")) return;
    compare("Ms", "Ms", second.robustness.Ms);
    compare("Mt", "Mt", second.robustness.Mt);
}

}  // namespace

void verify_range(VerifyAnswer& answer, const Json& range) {
    const Json points = range.value("points", Json::array());
    const Json one = range.value("one", Json::object());
    const Json of_one = one.value("points", Json::array());
    for (std::size_t k = 0; k < of_one.size() && k < points.size(); ++k) {
        const std::string where = "/range/one/points/" + std::to_string(k);
        const Json plant = points[k].value("plant", Json());
        verify_point(answer, where, of_one[k], plant, one.value("controller", Json()), "IAE", true);
        if (of_one[k].contains("own"))
            verify_point(answer, where, of_one[k], plant, of_one[k].at("own"), "own_IAE", false);
    }
    for (const char* part : {"schedule", "curves", "worst", "runs"})
        if (range.contains(part))
            answer.not_verified.push_back({std::string("/range/") + part,
                                           "Figures between the points and of the schedule have no second computation "
                                           "here."});
}

}  // namespace tunewright::api
