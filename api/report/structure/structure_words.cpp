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

// The words of the page, web/src/words/structure.ts; a house test compares them.

constexpr Word kSeries[] = {{"single", "single loop"},
                            {"baseline", "today"},
                            {"none", "no feedforward"},
                            {"static", "gain alone"},
                            {"guzman_hagglund", "Guzmán and Hägglund"},
                            {"optimum", "least IAE"},
                            {"pid", "PID"},
                            {"program", "call by call, with limits"},
                            {"blt", "BLT"},
                            {"detuned", "detuned"},
                            {"no_decoupler", "without decoupler"},
                            {"static_decoupler", "static decoupler"},
                            {"simplified_decoupler", "simplified decoupler"}};

constexpr Word kInputs[] = {{"setpoint", "Set-point step"},
                            {"inner_load", "Load at the valve"},
                            {"outer_load", "Load on the outer plant"},
                            {"disturbance", "Step of the disturbance"},
                            {"inflow", "Largest step of the inflow"},
                            {"load", "Load at the plant input"}};

constexpr Word kLoops[] = {
    {"inner", "inner loop"}, {"outer", "outer loop"}, {"valve", "at the valve"}, {"mu", "mu of all loops"}};

/// Sentences with {names} of figures; {wrong%} is one in percent, and { y} a unit after a blank. A sentence with a
/// figure that is not known is replaced by the reason.
constexpr Word kConclusions[] = {
    {"unstable", "The loops are not stable together, so there are no other figures."},
    {"cascade-pays",
     "The cascade pays. A single loop has {gain_inner} times its IAE after a load at the valve, {gain_outer} times "
     "after a load on the outer plant, and {gain_setpoint} times after a set-point step."},
    {"cascade-gains-little",
     "The cascade gains little. A single loop has {gain_inner} times its IAE after a load at the valve, {gain_outer} "
     "times after a load on the outer plant, and {gain_setpoint} times after a set-point step."},
    {"inner-too-slow",
     "The inner loop is only {speed_ratio} times as fast as the outer one; it should be at least {at_least} times as "
     "fast."},
    {"inner-peak-above", "Ms of the inner loop is {Ms}, above its limit of {limit}."},
    {"outer-peak-above", "Ms of the outer loop is {Ms}, above its limit of {limit}."},
    {"valve-peak-above", "Ms at the valve is {Ms}, above its limit of {limit}."},
    {"near-lowest-rate",
     "The outflow moves about as slowly as it can. Its largest rate is {rate_over_bound} times the lowest that any "
     "controller can reach with this room for the level."},
    {"level-above-room", "The level rises by {highest}{ y}, above the allowed {allowed}{ y}."},
    {"flow-loop-too-slow",
     "The flow loop is slow for this level loop: with it Ms is {Ms}, above {limit}. Make it faster, or allow the level "
     "more room."},
    {"flow-loop-unstable", "With this flow loop the level is not stable."},
    {"feedforward-exact", "The compensator is exact: the disturbance does not move y."},
    {"feedforward-pays", "Feedforward pays. Without it the IAE after the disturbance is {gain} times as large."},
    {"feedforward-worse-than-none",
     "Feedforward does harm. Without it the IAE after the disturbance is {gain} times as large."},
    {"feedforward-gains-little",
     "Feedforward gains little. Without it the IAE after the disturbance is {gain} times as large."},
    {"gain-alone-worse-than-none",
     "A gain alone would be worse than no feedforward: its IAE is {IAE}, without feedforward {IAE_none}."},
    {"peak-unavoidable",
     "The valve acts later than the disturbance, so y reaches {peak_bound}{ y} with any compensator; without "
     "feedforward it reaches {peak}{ y}."},
    {"wrong-model-worse-than-none",
     "If a gain or dead time is wrong by {wrong%} %, the IAE can be {IAE}, above the {IAE_none} without feedforward."},
    {"pid-does-as-well",
     "A PID with the same Ms does as well. After a load its IAE is {IAE_pid}, that of the predictor {IAE}."},
    {"predictor-pays", "The predictor pays. After a load its IAE is {IAE}, that of a PID with the same Ms {IAE_pid}."},
    {"limited-by-dead-time-error", "The error that the dead time may have limits this design, not Ms, which is {Ms}."},
    {"narrow-dead-time-window",
     "The loop is stable only while the dead time is known to {window}{ time}; {at_least}{ time} are advisable."},
    {"controller-unstable",
     "The controller by itself is not stable. It must not run without its feedback, as with the valve at a limit."},
    {"pairing-impossible",
     "This pairing cannot be used with integral action. Its lowest relative gain is {relative_gain}. Its Niederlinski "
     "index is {niederlinski}."},
    {"other-pairing-better",
     "Another pairing is better: its lowest relative gain is {other}, that of this one {relative_gain}."},
    {"hardly-interacting",
     "The loops hardly disturb each other and can be tuned one by one: all relative gains are near 1."},
    {"mu-above", "The peak mu of all loops is {mu}, above its limit of {limit}."},
    {"subsets-unstable", "Some loops are not stable while others are in manual: {count} sets of them."},
    {"better-than-blt", "Luyben's BLT tuning has {gain} times the weighted IAE after loads."},
    {"decoupler-helps", "Without a decoupler the weighted IAE after loads is {gain} times as large at the same limit."},
    {"decoupler-worse-than-none",
     "The decoupler does harm after loads. Without it the weighted IAE is {gain} times as large at the same limit."},
    {"decoupler-fragile",
     "The decoupler needs an exact model: a gain of the plant that is wrong by {wrong%} % raises the peak mu much, or "
     "makes the loops unstable. The largest relative gain is {relative_gain}."}};

template <std::size_t N>
std::string word_for(const Word (&words)[N], std::string_view code) {
    const auto* found = std::ranges::find(words, code, &Word::first);
    if (found != std::end(words)) return found->second;
    std::string out(code);
    std::ranges::replace(out, '_', ' ');
    return out;
}

/// A sentence with its figures and units in their places.
std::string filled(std::string_view form, const Json& figures, const StructureUnits& units) {
    std::string out;
    for (std::size_t at = 0; at < form.size();) {
        const std::size_t begin = form.find('{', at), end = form.find('}', begin);
        out += form.substr(at, begin - at);
        if (end == form.npos) break;
        std::string name(form.substr(begin + 1, end - begin - 1));
        at = end + 1;
        if (name.starts_with(' ')) {
            const std::string& unit = name == " y" ? units.y : units.time;
            out += unit.empty() ? "" : " " + unit;
            continue;
        }
        const bool percent = name.ends_with('%');
        if (percent) name.pop_back();
        const Json value = figures.value(name, Json());
        out += value.is_number() ? number_text((percent ? 100 : 1) * value.get<double>(), 3) : "unknown";
    }
    return out;
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
                                 {"the same with a single loop", "/single/performance/inner_load/IAE", "y time"},
                                 {"IAE after a load on the outer plant", "/performance/outer_load/IAE", "y time"},
                                 {"the same with a single loop", "/single/performance/outer_load/IAE", "y time"},
                                 {"IAE after a set-point step", "/performance/setpoint/IAE", "y time"},
                                 {"the same with a single loop", "/single/performance/setpoint/IAE", "y time"},
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

std::string conclusion_sentence(const Json& conclusion, const StructureUnits& units) {
    const Json figures = conclusion.value("figures", Json::object());
    const Json reasons = figures.value("why_null", Json::object());
    const std::string all = word_for(kConclusions, conclusion.value("code", ""));
    std::vector<std::string> parts;
    for (std::size_t at = 0; at < all.size();) {
        const std::size_t next = std::min(all.find(". ", at), all.size() - 1);
        std::string part = all.substr(at, next + 1 - at);
        at = next + 2;
        std::string why;
        for (const auto& [name, reason] : reasons.items())
            if (why.empty() && part.find("{" + name + "}") != part.npos) why = reason.get<std::string>();
        part = why.empty() ? filled(part, figures, units) : why;
        if (std::ranges::find(parts, part) == parts.end()) parts.push_back(std::move(part));
    }
    std::string out;
    for (const std::string& part : parts) out += (out.empty() ? "" : " ") + part;
    return out;
}

std::vector<StructureController> structure_controllers(const Json& result) {
    const std::string structure = structure_of(result);
    if (structure == "cascade")
        return {{"Inner controller", "/inner/controller"}, {"Outer controller", "/outer/controller"}};
    if (structure == "feedforward") return {{"Feedback controller", "/feedback"}};
    if (structure == "predictor") return {{"PID for comparison", "/pid"}};
    std::vector<StructureController> out;
    const std::size_t inputs = length_at(result, "/pairing");
    for (std::size_t i = 0; structure == "interaction" && i < length_at(result, "/controllers"); ++i) {
        const std::string number = std::to_string(i + 1);
        const std::string pair = i < inputs ? ": y" + number + " by u" + result["pairing"][i].dump() : "";
        out.push_back({"Controller " + number + pair, "/controllers/" + std::to_string(i)});
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

std::string loop_title(std::string_view loop) { return word_for(kLoops, loop); }

std::string input_title(std::string_view input) {
    const std::size_t number = input.find_first_of("123456789");
    if (number == input.npos || number == 0) return word_for(kInputs, input);
    return word_for(kInputs, input.substr(0, number - 1)) + " " + std::string(input.substr(number));
}

}  // namespace tunewright::api
