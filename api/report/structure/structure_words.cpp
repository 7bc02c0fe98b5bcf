#include "api/report/structure/structure_words.h"

#include <algorithm>
#include <utility>

#include "api/contract/structure/structure_name.h"
#include "api/report/figures.h"

namespace tunewright::api {
namespace {

using Word = std::pair<std::string_view, const char*>;

constexpr Word kStructures[] = {{"cascade", "Cascade"},
                                {"level", "Level that smooths flows"},
                                {"feedforward", "Feedforward"},
                                {"interaction", "Interacting loops"},
                                {"predictor", "Predictor"}};

constexpr Word kSeries[] = {{"design", "Design"},
                            {"single", "One loop"},
                            {"baseline", "Today"},
                            {"none", "Feedback alone"},
                            {"static", "Static"},
                            {"inverse", "Inverse"},
                            {"guzman_hagglund", "Rule of 2011"},
                            {"optimum", "Optimum"},
                            {"given", "Given"},
                            {"pid", "PID"},
                            {"blt", "BLT"},
                            {"detuned", "Detuned"},
                            {"no_decoupler", "Without decoupler"},
                            {"static_decoupler", "Static decoupler"},
                            {"simplified_decoupler", "Simplified decoupler"}};

constexpr Word kInputs[] = {{"setpoint", "Set point"},        {"inner_load", "Load at the valve"},
                            {"outer_load", "Outer load"},     {"disturbance", "Disturbance"},
                            {"inflow", "Step of the inflow"}, {"load", "Load"}};

/// Sentences with {names} of figures, and {time} for the unit after one.
constexpr Word kConclusions[] = {
    {"unstable", "The loops are not stable together."},
    {"cascade-pays",
     "The cascade pays: after a load at the valve the IAE is {gain_inner} times less than with one loop."},
    {"cascade-gains-little",
     "The cascade gains little: after a load at the valve the IAE is {gain_inner} times less than with one loop."},
    {"inner-too-slow",
     "The inner loop is only {speed_ratio} times as fast as the outer one; {at_least} times is the least for a "
     "cascade."},
    {"inner-peak-above", "Ms of the inner loop is {Ms}, above its limit {limit}."},
    {"outer-peak-above", "Ms of the outer loop is {Ms}, above its limit {limit}."},
    {"valve-peak-above", "Ms at the valve is {Ms}, above its limit {limit}."},
    {"near-lowest-rate",
     "The outflow's largest rate is {rate_over_bound} times the least that any controller reaches."},
    {"level-above-room", "The level rises to {highest}, above the allowed {allowed}."},
    {"flow-loop-unstable", "With this flow loop the level is not stable."},
    {"flow-loop-too-slow",
     "With the flow loop Ms is {Ms}, above {limit}: make the flow loop faster or allow more room."},
    {"feedforward-exact", "With the exact model the disturbance does not move the measurement."},
    {"feedforward-pays", "Feedforward pays: the IAE is {gain} times less than with feedback alone."},
    {"feedforward-gains-little", "Feedforward gains little: the IAE is {gain} times less than with feedback alone."},
    {"feedforward-worse-than-none", "Feedforward does harm: without it the IAE is {gain} times as large."},
    {"gain-alone-worse-than-none", "A gain alone is worse than no feedforward: IAE {IAE}, without it {IAE_none}."},
    {"peak-unavoidable",
     "The valve acts later than the disturbance: no feedforward keeps the error below {peak_bound}; without one it "
     "reaches {peak}."},
    {"wrong-model-worse-than-none",
     "If a gain or a dead time is wrong by the share {wrong}, the IAE is {IAE}, more than {IAE_none} without "
     "feedforward."},
    {"pid-does-as-well", "A PID of the same Ms does as well: IAE {IAE_pid}, with the predictor {IAE}."},
    {"predictor-pays", "The predictor pays: IAE {IAE}, with a PID of the same Ms {IAE_pid}."},
    {"limited-by-dead-time-error", "The allowed error of the dead time, not Ms, limits the design."},
    {"narrow-dead-time-window",
     "An error of the dead time of {window}{time} makes the loop unstable; below {at_least}{time} it is hardly "
     "usable."},
    {"controller-unstable", "The controller by itself is not stable: it must not run without its feedback."},
    {"pairing-impossible", "This pairing cannot be stable with integral action and one loop in manual."},
    {"other-pairing-better", "Another pairing interacts less."},
    {"hardly-interacting", "The loops hardly interact: tune them one by one."},
    {"mu-above", "The structured peak mu is {mu}, above its limit {limit}."},
    {"subsets-unstable", "{count} sets of loops are not stable while the others are in manual."},
    {"better-than-blt", "The cost is {gain} times less than with Luyben's tuning (BLT)."},
    {"decoupler-helps", "Without a decoupler the cost is {gain} times as large at the same limit."},
    {"decoupler-worse-than-none",
     "The decoupler does harm after loads: without it the cost is {gain} times as large at the same limit."},
    {"decoupler-fragile",
     "The decoupler needs an exact model: a gain of the plant that is wrong by the share {wrong} raises mu much, or "
     "makes the loops unstable. The largest relative gain is {relative_gain}."}};

template <std::size_t N>
std::string word_for(const Word (&words)[N], std::string_view code) {
    const auto* found = std::ranges::find(words, code, &Word::first);
    return found == std::end(words) ? std::string(code) : found->second;
}

std::size_t length_at(const Json& result, const char* pointer) {
    const Json::json_pointer place(pointer);
    return result.contains(place) && result.at(place).is_array() ? result.at(place).size() : 0;
}

/// The place of the controllers' pairing among `pairings`.
std::size_t chosen_pairing(const Json& result) {
    std::size_t i = 0;
    const std::size_t count = length_at(result, "/pairings");
    while (i < count && result["pairings"][i].value("inputs", Json()) != result.value("pairing", Json())) ++i;
    return i;
}

using Figures = std::vector<StructureFigure>;

const Figures& cascade_figures() {
    static const Figures figures{{"Ms of the inner loop", "/inner/robustness/Ms", ""},
                                 {"Ms of the outer loop", "/outer/robustness/Ms", ""},
                                 {"Ms at the valve", "/outer/robustness/Ms_valve", ""},
                                 {"Limit of Ms at the valve", "/Ms_valve_limit", ""},
                                 {"The dead time may rise by", "/outer/robustness/dead_time_up", "time"},
                                 {"IAE after a load at the valve", "/performance/inner_load/IAE", "y time"},
                                 {"the same with one loop", "/single/performance/inner_load/IAE", "y time"},
                                 {"IAE after an outer load", "/performance/outer_load/IAE", "y time"},
                                 {"the same with one loop", "/single/performance/outer_load/IAE", "y time"},
                                 {"IAE after a set-point step", "/performance/setpoint/IAE", "y time"},
                                 {"the same with one loop", "/single/performance/setpoint/IAE", "y time"},
                                 {"Speed of the inner over the outer loop", "/speed_ratio", ""}};
    return figures;
}

const Figures& level_figures() {
    static const Figures figures{{"Highest level", "/design/highest", "y"},
                                 {"Time of it", "/design/time_of_highest", "time"},
                                 {"Gap in which the controller rests", "/gap", "y"},
                                 {"Largest rate of the outflow", "/design/largest_rate", "u/time"},
                                 {"Least rate of any controller", "/bound", "u/time"},
                                 {"Overshoot of the outflow, %", "/design/overshoot_percent", ""},
                                 {"Ms with the flow loop", "/robustness/Ms", ""}};
    return figures;
}

const Figures& predictor_figures() {
    static const Figures figures{{"Ms", "/robustness/Ms", ""},
                                 {"Mt", "/robustness/Mt", ""},
                                 {"The dead time may rise by", "/robustness/dead_time_up", "time"},
                                 {"The dead time may fall by", "/robustness/dead_time_down", "time"},
                                 {"IAE after a load", "/load/IAE", "y time"},
                                 {"the same with the PID", "/pid_IAE", "y time"},
                                 {"IAE after a set-point step", "/setpoint/IAE", "y time"}};
    return figures;
}

Figures feedforward_figures(const Json& result) {
    Figures out{{"Valve later than the disturbance by", "/late", "time"},
                {"Error that no feedforward avoids", "/peak_bound", "y"}};
    for (std::size_t i = 0; i < length_at(result, "/variants"); ++i) {
        const Json& variant = result["variants"][i];
        out.push_back(
            {"IAE: " + series_title(variant.value("kind", "")), "/variants/" + std::to_string(i) + "/IAE", "y time"});
    }
    return out;
}

/// Gain, lead, lag and delay of each element, and what the decoupler does.
void add_decoupler(const Json& result, Figures& out) {
    const std::string elements = "/decoupling/D/";
    for (std::size_t i = 0; i < length_at(result, "/decoupling/D"); ++i)
        for (std::size_t j = 0; j < result["decoupling"]["D"][i].size(); ++j) {
            const Json& element = result["decoupling"]["D"][i][j];
            const std::string place = elements + std::to_string(i) + "/" + std::to_string(j) + "/",
                              of = " of the decoupler from loop " + std::to_string(j + 1) + " to loop " +
                                   std::to_string(i + 1);
            if (!element.is_object()) continue;
            out.push_back({"Kf" + of, place + "Kf", ""});
            for (const char* time : {"Tz", "Tp", "Lf"})
                if (element.value(time, 0.0) != 0) out.push_back({time + of, place + time, "time"});
        }
    out.push_back({"Cost without the decoupler over the cost with it", "/decoupling/gain", ""});
    out.push_back({"Mu if a gain of the plant is wrong by 20 %", "/decoupling/wrong_gains/mu", ""});
}

Figures interaction_figures(const Json& result) {
    Figures out{{"Structured peak mu", "/mu", ""}, {"Cost: weighted sum of the IAE after loads", "/cost", ""}};
    const std::string gains = "/pairings/" + std::to_string(chosen_pairing(result)) + "/relative_gains/";
    for (std::size_t i = 0; i < length_at(result, "/controllers"); ++i) {
        const std::string place = std::to_string(i), loop = std::to_string(i + 1);
        out.push_back({"Relative gain of loop " + loop, gains + place, ""});
        out.push_back({"Ms of loop " + loop + ", others in manual", "/Ms_alone/" + place, ""});
        out.push_back({"Ms of loop " + loop + ", others in automatic", "/Ms_others_closed/" + place, ""});
    }
    if (result.contains("decoupling")) add_decoupler(result, out);
    for (std::size_t i = 0; i < length_at(result, "/compared"); ++i)
        out.push_back({"Cost: " + series_title(result["compared"][i].value("name", "")),
                       "/compared/" + std::to_string(i) + "/cost", ""});
    return out;
}

}  // namespace

std::string structure_title(std::string_view structure) { return word_for(kStructures, structure); }

std::string conclusion_sentence(const Json& conclusion, const std::string& time) {
    std::string out = word_for(kConclusions, conclusion.value("code", ""));
    const auto put = [&](const std::string& name, const std::string& text) {
        const std::string place = "{" + name + "}";
        for (std::size_t at = out.find(place); at != out.npos; at = out.find(place))
            out.replace(at, place.size(), text);
    };
    const Json figures = conclusion.value("figures", Json::object());
    for (const auto& [name, value] : figures.items())
        put(name, value.is_number() ? number_text(value.get<double>(), 3) : "unknown");
    put("time", time.empty() ? "" : " " + time);
    return out;
}

std::vector<StructureController> structure_controllers(const Json& result) {
    const std::string structure = structure_of(result);
    if (structure == "cascade") return {{"Inner", "/inner/controller"}, {"Outer", "/outer/controller"}};
    if (structure == "feedforward") return {{"Feedback", "/feedback"}};
    if (structure == "predictor") return {{"PID in its place", "/pid"}};
    std::vector<StructureController> out;
    const std::size_t inputs = length_at(result, "/pairing");
    for (std::size_t i = 0; structure == "interaction" && i < length_at(result, "/controllers"); ++i) {
        const std::string number = std::to_string(i + 1);
        const std::string pair = i < inputs ? ": y" + number + " by u" + result["pairing"][i].dump() : "";
        out.push_back({"Loop " + number + pair, "/controllers/" + std::to_string(i)});
    }
    return out;
}

std::vector<StructureFigure> structure_figures(const Json& result) {
    const std::string structure = structure_of(result);
    if (structure == "cascade") return cascade_figures();
    if (structure == "level") return level_figures();
    if (structure == "predictor") return predictor_figures();
    if (structure == "feedforward") return feedforward_figures(result);
    return interaction_figures(result);
}

std::string series_title(std::string_view of) { return word_for(kSeries, of); }

std::string input_title(std::string_view input) {
    const std::size_t number = input.find_first_of("123456789");
    if (number == input.npos || number == 0) return word_for(kInputs, input);
    return word_for(kInputs, input.substr(0, number - 1)) + " " + std::string(input.substr(number));
}

}  // namespace tunewright::api
