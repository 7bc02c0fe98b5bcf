#include "tests/api/verdict/verdict_claims.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <utility>

namespace tunewright::api {
namespace {

std::optional<double> at(const Json& value, const std::string& pointer) {
    const Json::json_pointer where(pointer);
    if (!value.contains(where) || !value[where].is_number()) return std::nullopt;
    return value[where].get<double>();
}

/// The steps of 1 for which u must exceed its limits in steady state, computed from the request alone, and whether the
/// request gives the size of one of them; the first plant of a set counts.
struct BeyondActuator {
    bool load = false, setpoint = false, named = false;
};

BeyondActuator beyond_actuator(const Json& request) {
    const Json::json_pointer place("/evaluate/actuator");
    if (!request.contains(place)) return {};
    const double low = request[place]["min"], high = request[place]["max"];
    const Json& plant = request["plant"]["type"] == "set" ? request["plant"]["plants"][0] : request["plant"];
    BeyondActuator beyond{.load = -1 < low};
    if (plant["type"] != "ipdt") {
        const double K = plant.contains("K") ? plant["K"].get<double>()
                                             : plant["num"].back().get<double>() / plant["den"].back().get<double>();
        beyond.setpoint = 1 / K < low || 1 / K > high;
    }
    beyond.named = (beyond.load && request["evaluate"].contains("load_step")) ||
                   (beyond.setpoint && request["evaluate"].contains("setpoint_step"));
    return beyond;
}

/// True if y settles by itself, whatever u is.
bool rests_alone(const Json& request) {
    const Json& plant = request["plant"]["type"] == "set" ? request["plant"]["plants"][0] : request["plant"];
    return plant["type"] != "ipdt" && !(plant["type"] == "fopdt" && plant["T"].get<double>() < 0);
}

bool null_at(const Json& value, const std::string& pointer) {
    const Json::json_pointer where(pointer);
    return value.contains(where) && value[where].is_null();
}

/// The places of a finding's figures in its entry. An entry's own places come first; any of them is sufficient.
const std::map<std::string, std::vector<std::string>>& places() {
    static const std::map<std::string, std::vector<std::string>> all = {
        {"Ms", {"/robustness/Ms", "/implemented/robustness/Ms", "/region/worst_Ms", "/implemented/region/worst_Ms"}},
        {"Mt", {"/robustness/Mt", "/implemented/robustness/Mt"}},
        {"Mks", {"/robustness/Mks", "/implemented/robustness/Mks"}},
        {"omega_Ms", {"/robustness/omega_Ms", "/implemented/robustness/omega_Ms"}},
        {"omega_Mt", {"/robustness/omega_Mt", "/implemented/robustness/omega_Mt"}},
        {"Ms_ideal", {"/robustness/Ms"}},
        {"load_IAE", {"/performance/load/IAE", "/implemented/performance/load/IAE"}},
        {"load_IAE_ideal", {"/performance/load/IAE"}},
        {"worst_Ms", {"/region/worst_Ms", "/implemented/region/worst_Ms"}},
        {"gain_low", {"/robustness/tolerates/gain/0", "/implemented/robustness/tolerates/gain/0"}},
        {"gain_high", {"/robustness/tolerates/gain/1", "/implemented/robustness/tolerates/gain/1"}},
        {"extra_dead_time",
         {"/robustness/tolerates/extra_dead_time", "/implemented/robustness/tolerates/extra_dead_time"}},
        {"overshoot_percent",
         {"/performance/setpoint/overshoot_percent", "/implemented/performance/setpoint/overshoot_percent"}},
        {"TV", {"/performance/setpoint/TV", "/implemented/performance/setpoint/TV"}},
        {"u_std", {"/performance/noise/u_std"}},
        {"longest_sample_time", {"/longest_sample_time"}},
        {"excess_percent", {"/optimum_at_Ms/excess_percent"}},
        {"gap", {"/certificate/gap"}},
        {"lower", {"/certificate/lower"}},
        {"asked_percent", {"/options/setpoint/overshoot"}},
        {"design_percent", {"/options/setpoint/overshoot"}},
        {"Tf", {"/controller/filter/Tf"}},
        {"region_cost", {"/region_cost"}},
        {"IAE_ratio", {"/replay/IAE_ratio"}},
        {"IAE_ratio_low", {"/replay/IAE_ratio_low"}},
        {"IAE_ratio_high", {"/replay/IAE_ratio_high"}},
        {"travel_ratio", {"/replay/travel_ratio"}},
        {"overshoot", {"/own_step/setpoint/overshoot"}},
        {"settling_time", {"/own_step/setpoint/settling_time"}},
        {"peak", {"/own_step/load/peak"}},
        {"recovery_time", {"/own_step/load/recovery_time"}},
        {"time_at_max", {"/own_step/time_at_max"}},
        {"time_at_min", {"/own_step/time_at_min"}},
        {"u_needed", {"/own_step/u_needed"}},
        {"y_final", {"/own_step/y_final"}},
        {"Ms_limit", {"/options/Ms", "/options/limit"}},
        {"Mt_limit", {"/options/Mt"}},
        {"Mks_limit", {"/options/Mks"}},
    };
    return all;
}

/// The path of the implemented loop, if it is known.
std::string runs(const Json& entry) { return entry.contains("implemented") ? "/implemented" : ""; }

void check_numbers(const Json& finding, std::vector<std::string>& faults) {
    const std::string text = finding["text"], code = finding["code"];
    if (code == "reason" || code == "large-errors") return;  // their sentences come from other parts
    for (const char* word : {"nan", "null", "inf ", "  "})
        if (text.find(word) != text.npos) faults.push_back(code + " says \"" + word + "\": " + text);
    static const std::regex number(R"((^|[^A-Za-z0-9_.])(-?\d+(\.\d+)?(e-?\d+)?))");
    for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it) {
        const double said = std::stod((*it)[2].str());
        bool known = false;
        for (const auto& [name, value] : finding["figures"].items())
            known = known || std::abs(said - value.get<double>()) <= 5.001e-3 * std::abs(value.get<double>());
        if (!known) faults.push_back(code + ": " + (*it)[2].str() + " is not among its figures: " + finding.dump());
    }
}

void check_figures(const Json& entry, const Json& finding, std::vector<std::string>& faults) {
    for (const auto& [name, value] : finding["figures"].items()) {
        const auto known = places().find(name);
        if (known == places().end()) continue;
        bool found = false;
        for (const std::string& place : known->second) found = found || at(entry, place) == value.get<double>();
        if (!found)
            faults.push_back(finding["code"].get<std::string>() + ": no figure of the entry is " + name + " = " +
                             value.dump());
    }
}

std::optional<double> limit(const Json& entry, const std::string& name) {
    const auto value = at(entry, "/options/" + name);
    return value && *value > (name == "Mks" ? 0 : 1) ? value : std::nullopt;
}

struct ClaimWords {
    const char* text;
    double low, high;
};

/// The tolerance of words for a ratio.
constexpr ClaimWords kWords[] = {
    {"about a tenth of", 0.085, 0.115},      {"about a fifth of", 0.17, 0.23},  {"about a quarter of", 0.21, 0.29},
    {"about a third of", 0.29, 0.38},        {"about half of", 0.45, 0.55},     {"about two thirds of", 0.62, 0.71},
    {"about three quarters of", 0.71, 0.79}, {"about the same as", 0.86, 1.16}, {"about twice", 1.88, 2.12},
    {"about three times", 2.8, 3.2}};

void check_against_today(const Json& entry, const Json& today, const Json& finding, std::vector<std::string>& faults) {
    const std::string text = finding["text"];
    const auto IAE = at(entry, runs(entry) + "/performance/load/IAE"),
               before = at(today, runs(today) + "/performance/load/IAE");
    const bool unstable = today[Json::json_pointer(runs(today) + "/robustness/stable")] == false;
    if ((text.find("today's settings are unstable") != text.npos) != unstable)
        faults.push_back("today's stability: " + text);
    if (unstable || !before || *before <= 0) return;
    const double ratio = *IAE / *before;
    for (const ClaimWords& words : kWords)
        if (text.find(words.text) != text.npos && !(ratio >= words.low && ratio <= words.high))
            faults.push_back("a ratio of " + std::to_string(ratio) + " is called " + words.text);
    if (at(finding, "/figures/ratio") && std::abs(*at(finding, "/figures/ratio") / ratio - 1) > 1e-9)
        faults.push_back("the ratio is " + std::to_string(ratio) + ": " + finding.dump());
    if ((finding["level"] == "good" && ratio > 0.9) || (finding["level"] == "warning" && ratio < 1.1))
        faults.push_back("a ratio of " + std::to_string(ratio) + " has level " + finding["level"].dump());
}

void check_active_limit(const Json& entry, const Json& finding, std::vector<std::string>& faults) {
    const std::string text = finding["text"];
    const bool on_worst = text.find("on the worst plant") != text.npos;
    int active = 0;
    for (const std::string name : {"Ms", "Mt", "Mks"}) {
        const auto value = at(finding, "/figures/" + name);
        const auto asked = limit(entry, name);
        if (text.find(name + " = ") != text.npos) {
            ++active;
            if (!value || !asked || std::abs(*value / *asked - 1) > 3e-3)
                faults.push_back(name + " is called the active limit: " + finding.dump());
        }
        if (text.find(name + " (") != text.npos && (!value || !asked || *value > 1.003 * *asked))
            faults.push_back(name + " is said to be within its limit: " + finding.dump());
        // A limit that is not named must not be the one that constrains the design.
        const auto runs_at = at(entry, runs(entry) + "/robustness/" + name);
        if (!on_worst && runs_at && asked && std::abs(*runs_at / *asked - 1) < 1e-3 &&
            text.find(name + " = ") == text.npos)
            faults.push_back(name + " is at its limit and not called active: " + text);
    }
    if (active == 0 || (active == 1) == (text.find("limits are") != text.npos))
        faults.push_back("count of limits: " + text);
}

void check_finding(const Json& entry, const Json* today, const Json& finding, const Json& request,
                   std::vector<std::string>& faults) {
    const std::string code = finding["code"], text = finding["text"];
    const Json& figures = finding["figures"];
    const auto fault = [&](bool wrong, const std::string& what) {
        if (wrong) faults.push_back(code + ": " + what + ": " + finding.dump());
    };
    check_numbers(finding, faults);
    check_figures(entry, finding, faults);
    if (code == "active-limit") check_active_limit(entry, finding, faults);
    if (code == "against-today") {
        fault(today == nullptr, "there is no today");
        if (today != nullptr) check_against_today(entry, *today, finding, faults);
    }
    if (code == "movement")
        fault(today == nullptr ||
                  std::abs(figures["TV"].get<double>() / *at(*today, runs(*today) + "/performance/setpoint/TV") /
                               figures["ratio"].get<double>() -
                           1) > 1e-9,
              "not the ratio of TV");
    if (code == "members") {
        const std::string region = runs(entry) + "/region";
        const bool all = at(entry, region + "/stable_fraction") == 1.0 && at(entry, region + "/worst_Ms");
        fault((text.find("Stable o") == 0 && text.find("% of") == text.npos) != all, "stability of all plants");
        if (!all)
            fault(figures["stable_percent"].get<double>() > 100 * *at(entry, region + "/stable_fraction") + 1e-9,
                  "share");
    }
    if (code == "sample-time")
        fault(!(request["implement"]["sample_time"].get<double>() > *at(entry, "/longest_sample_time")),
              "the sample time is short enough");
    if (code == "replay") {
        const double low = *at(entry, "/replay/IAE_ratio_low"), high = *at(entry, "/replay/IAE_ratio_high");
        fault(finding["level"] != (high < 1 ? "good" : low > 1 ? "warning" : "note"), "the band lies elsewhere");
        if (figures.contains("travel_over_today")) {
            const auto travel = [](const Json* one) { return one ? at(*one, "/replay/figures/travel") : std::nullopt; };
            const auto here = travel(&entry), before = travel(today);
            fault(!here || !before || std::abs(*here / *before / figures["travel_over_today"].get<double>() - 1) > 1e-9,
                  "not the ratio of travel");
        }
    }
    if (code == "own-step-saturates") {
        const auto spent = [&](const char* name) {
            const auto time = at(entry, std::string("/own_step/") + name);
            return !time || *time > 0;
        };
        fault(!spent("time_at_max") && !spent("time_at_min"), "u reaches no limit");
    }
    if (code == "own-step-out-of-reach") {
        const double needed = *at(entry, "/own_step/u_needed"), held = figures["u_limit"];
        fault((held == at(request, "/evaluate/own_step/u_max")) != (needed > held), "u_needed is within the limit");
    }
    if (code == "PI-as-good")
        fault(figures["PI_load_IAE"].get<double>() > 1.0501 * *at(entry, "/performance/load/IAE"), "PI is worse");
    if (code == "derivative-pays")
        fault(figures["PI_load_IAE"].get<double>() < 1.0499 * *at(entry, "/performance/load/IAE"), "PI is as good");
    if (code == "noise-gain")
        fault(!(*at(entry, "/robustness/Mks") > 19 * std::abs(at(entry, "/controller/Kp").value_or(0))),
              "the noise gain is usual");
    if (code == "no-filter") fault(!null_at(entry, "/robustness/Mks"), "Mks is finite");
    if (code == "margin-unknown")
        fault(!null_at(entry, "/robustness/Ms") && !null_at(entry, "/implemented/robustness/Ms"), "Ms is known");
    if (code == "dead-time-rules" && request.contains("plant") && request["plant"]["type"] == "fopdt")
        fault(*at(request, "/plant/L") < 1.999 * *at(request, "/plant/T"), "the dead time is short");
}

int rank(const Json& level) { return level == "good" ? 0 : level == "note" ? 1 : level == "warning" ? 2 : 3; }

void check_entry(const Json& entry, const Json* today, const Json& request, std::vector<std::string>& faults) {
    const Json& verdict = entry["verdict"];
    if (verdict.empty()) return faults.push_back("an entry without verdict");
    const Json& head = verdict[0];
    if (entry.contains("error")) {
        if (head["code"] != "no-controller" || head["level"] != "bad")
            faults.push_back("a failure is called " + head.dump());
        return;
    }
    const Facts facts = facts_of(entry, request);
    if (facts.bad != (head["level"] == "bad")) faults.push_back("level " + head.dump() + " with: " + facts.why);
    if ((facts.bad || facts.not_good) == (head["level"] == "good"))
        faults.push_back("level " + head.dump() + " with: " + facts.why);
    std::map<std::string, int> codes;
    for (const Json& finding : verdict) {
        if (++codes[finding["code"]] > 1) faults.push_back("twice: " + finding.dump());
        if (finding["level"] == "bad" && head["level"] != "bad") faults.push_back("bad behind " + head.dump());
        check_finding(entry, today, finding, request, faults);
    }
    const bool limited = head["text"].get<std::string>().find("limited by") != std::string::npos;
    if (head["code"] == "robust" && limited != (finding(verdict, "active-limit") != nullptr))
        faults.push_back("limited, without an active limit: " + verdict.dump());
}

void check_result(const Json& answer, std::vector<std::string>& faults) {
    if (!answer.contains("verdict") || answer["verdict"].empty()) return faults.push_back("an answer without verdict");
    const Json& head = answer["verdict"][0];
    const Json& entries = answer["controllers"];
    int best = 3;
    for (const Json& entry : entries)
        if (entry.value("method", "") != "baseline" && !entry.contains("error"))
            best = std::min(best, rank(entry["verdict"][0]["level"]));
    if (head["code"] == "none") {
        if (best < 3) faults.push_back("nothing to take, though one is usable");
        return;
    }
    const Json& chosen = entries[head["figures"]["entry"].get<std::size_t>()];
    const Json& own = chosen["verdict"][0]["level"];
    if (rank(own) == 3) faults.push_back("takes what is bad");
    const auto group = [&](const Json& entry) {
        bool held = !entry.contains("standing") || entry["standing"].value("why", "").empty(), valid = true;
        for (const Json& finding : entry["verdict"]) held = held && finding["code"] != "above-limit";
        for (const Json& warning : entry["warnings"]) valid = valid && warning["code"] != "outside-validity";
        return std::pair(!held, !valid);
    };
    const auto IAE = [](const Json& entry) {
        return at(entry, runs(entry) + "/performance/load/IAE").value_or(INFINITY);
    };
    for (const Json& entry : entries) {
        if (entry.value("method", "") == "baseline" || entry.contains("error")) continue;
        if (rank(entry["verdict"][0]["level"]) == 3) continue;
        if (group(entry) < group(chosen)) faults.push_back("takes what does not hold or is not valid");
        if (group(entry) == group(chosen) && 3.00001 * IAE(entry) < IAE(chosen))
            faults.push_back("takes what costs many times as much");
        if (group(entry) == group(chosen) && IAE(entry) <= IAE(chosen) &&
            rank(entry["verdict"][0]["level"]) < rank(own) && finding(chosen["verdict"], "little-margin") == nullptr)
            faults.push_back("takes " + own.dump() + " though a better one is there that costs less");
    }
    if (head["code"] == "take" && head["level"] != own)
        faults.push_back("the level is not the entry's: " + head.dump());
    if (head["code"] == "keep-today") {
        const Json& today = entries.back();
        if (today["method"] != "baseline" || rank(today["verdict"][0]["level"]) > rank(own))
            faults.push_back("keeps what is worse");
    }
}

}  // namespace

const Json* finding(const Json& verdict, const std::string& code) {
    for (const Json& one : verdict)
        if (one["code"] == code) return &one;
    return nullptr;
}

/// The limit on the overshoot in the request, not the method's own.
std::optional<double> asked_overshoot(const Json& entry, const Json& request) {
    if (!request.contains("tune")) return {};
    const Json tune = request["tune"].is_array() ? request["tune"] : Json::array({request["tune"]});
    const auto limit = at(entry, "/options/setpoint/overshoot");
    const bool asked = std::ranges::any_of(tune, [&](const Json& row) {
        return row["method"] == entry["method"] && at(row, "/setpoint/overshoot") == limit;
    });
    return asked ? limit : std::nullopt;
}

Facts facts_of(const Json& entry, const Json& request) {
    Facts facts;
    const auto bad = [&](bool is, const std::string& why) {
        if (is) facts.why += why + "; ";
        facts.bad = facts.bad || is;
    };
    const auto doubt = [&](bool is, const std::string& why) {
        if (is) facts.why += why + "; ";
        facts.not_good = facts.not_good || is;
    };
    const bool horizon =
        request.contains("/evaluate/horizon"_json_pointer) && request["evaluate"]["horizon"].is_number();
    const bool stable = entry["robustness"]["stable"];
    const bool integral = at(entry, "/equivalents/parallel/Ki").value_or(0) != 0;
    bad(!stable, "unstable");
    const BeyondActuator beyond = integral ? beyond_actuator(request) : BeyondActuator{};
    if (beyond.named && stable)
        rests_alone(request) ? doubt(true, "the actuator is too small") : bad(true, "the actuator is too small");
    const auto overshoot = at(entry, runs(entry) + "/performance/setpoint/overshoot_percent");
    const auto asked_percent = asked_overshoot(entry, request);
    doubt(overshoot.value_or(0) > (asked_percent ? *asked_percent + 2.00001 : 25.00001), "overshoot");
    for (const std::string place : {"", "/implemented"}) {
        if (place != "" && !entry.contains("implemented")) continue;
        const Json& robustness = entry[Json::json_pointer(place + "/robustness")];
        bad(robustness["stable"] == false, "unstable" + place);
        doubt(null_at(robustness, "/Ms"), "Ms is not known" + place);
        const bool at_rest = (at(entry, place + "/performance/setpoint/settling_time") || beyond.setpoint) &&
                             (at(entry, place + "/performance/load/recovery_time") || beyond.load);
        if (integral && !at_rest && stable)
            place.empty() && !horizon ? bad(true, "not at rest")
                                      : doubt(place.empty() || !horizon, "not at rest" + place);
    }
    const auto peak_that_runs = [&](const std::string& name) {
        const auto ideal = at(entry, "/robustness/" + name);
        const auto peak = at(entry, runs(entry) + "/robustness/" + name);
        return peak ? *peak : ideal.value_or(0);
    };
    for (const std::string name : {"Ms", "Mt"})
        if (const auto asked = limit(entry, name))
            doubt(peak_that_runs(name) > 1.003 * *asked, name + " above its limit");
    doubt(peak_that_runs("Mt") > 2.00001, "Mt above 2");
    double worst = peak_that_runs("Ms");
    const std::string region = runs(entry) + "/region";
    if (entry.contains(Json::json_pointer(region))) {
        bad(at(entry, region + "/stable_fraction").value_or(0) < 1 || null_at(entry, region + "/worst_Ms"),
            "unstable somewhere");
        const auto Ms = at(entry, region + "/worst_Ms");
        worst = std::max(worst, Ms.value_or(0));
        if (const auto asked = limit(entry, "Ms"))
            doubt(Ms.value_or(0) > 1.011 * *asked, "Ms above its limit at worst");
    }
    bad(worst > 2.00001, "Ms above 2");
    doubt(worst > 1.70001, "Ms above 1.7");
    doubt(!integral, "no integral action");
    const bool excused = beyond.load || beyond.setpoint;
    for (const Json& warning : entry["warnings"]) {
        bad(warning["code"] == "left-domain" ||
                (warning["code"] == "does-not-settle" && integral && !horizon && !excused),
            warning["code"]);
        doubt(warning["code"] == "not-as-built" || (warning["code"] == "does-not-settle" && !excused), warning["code"]);
    }
    return facts;
}

std::vector<std::string> contradictions(const Json& answer, const Json& request) {
    std::vector<std::string> faults;
    const Json* today = nullptr;
    for (const Json& entry : answer["controllers"])
        if (entry.value("method", "") == "baseline" && !entry.contains("error")) today = &entry;
    for (const Json& entry : answer["controllers"])
        check_entry(entry, &entry == today ? nullptr : today, request, faults);
    check_result(answer, faults);
    return faults;
}

}  // namespace tunewright::api
